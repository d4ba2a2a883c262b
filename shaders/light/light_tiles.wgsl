// Where the bits of a tile's lights stand. `src/render/frame/light_tiles.rs` has the same numbers.

// Side of a tile, in pixels.
const LIGHT_TILE: u32 = 8u;

fn light_tile_words(lights: u32) -> u32 {
    return (lights + 31u) / 32u;
}

fn light_tile_first(tile: vec2u, width: u32, words: u32) -> u32 {
    return (tile.y * ((width + LIGHT_TILE - 1u) / LIGHT_TILE) + tile.x) * words;
}
