// Tiles that the cone pass has left for the passes after it.

struct Tile {
    // Column and row, 16 bits each.
    place: u32,
    // For each quarter of the tile: nothing of the component is nearer than this along any of its rays.
    start: array<f32, 4>,
}

// Upper left pixel of a tile.
fn tile_pixel(tile: Tile) -> vec2u {
    return vec2u(tile.place & 0xffffu, tile.place >> 16u) * TILE;
}

// Invocations that run together (eight on lavapipe, 32 or more on graphics cards) lie close together:
// blocks of 4 by 2 pixels, two of them a quarter of the tile.
fn tile_place(lane: u32) -> vec2u {
    let block = lane / 8u;
    return vec2u((block / 2u & 1u) * 4u + (lane & 3u), (block / 4u) * 4u + (block & 1u) * 2u + (lane >> 2u & 1u));
}

// Which quarter of its tile an invocation is in.
fn tile_quad(lane: u32) -> u32 {
    return lane / 16u;
}
