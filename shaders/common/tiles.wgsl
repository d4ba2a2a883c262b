// Tiles that the cone pass has left for the passes after it.

struct Tile {
    // Column and row, 16 bits each.
    place: u32,
    // Nothing of the component is nearer than this along any ray of the tile.
    start: f32,
}

fn tile_pixel(tile: Tile) -> vec2u {
    return vec2u(tile.place & 0xffffu, tile.place >> 16u) * TILE;
}
