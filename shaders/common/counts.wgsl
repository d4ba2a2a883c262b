// Where counts stand in the buffer of counts: what each component took at its beginning; where pipelines count, what
// each pixel took at its end, and what the cones of each tile took behind that. `PixelCounts` on the CPU is its counterpart.

#include "common/view.wgsl"
#include "common/dispatch.wgsl"
#include "common/walked.wgsl"

// Words of a component: rays that had not ended after the last relaunch, evaluations by rays, rays started; then, by
// rays and cones, cells and tape entries read.
const COMPONENT_COUNTS: u32 = 5u;
// Words of a pixel: evaluations by its rays, rays started, cells, tape entries. Of a tile the same by its cones, and no rays.
const PIXEL_COUNTS: u32 = 4u;

fn counts_tiles_across() -> u32 {
    return (view.width + TILE - 1u) / TILE;
}

// The first word of a pixel in a buffer of `words`.
fn counts_of_pixel(words: u32, pixel: vec2u) -> u32 {
    let tiles = counts_tiles_across() * ((view.height + TILE - 1u) / TILE);
    let first = words - (tiles + view.width * view.height) * PIXEL_COUNTS;
    return first + (pixel.y * view.width + pixel.x) * PIXEL_COUNTS;
}

// The first word of a tile in a buffer of `words`.
fn counts_of_tile(words: u32, place: vec2u) -> u32 {
    let tiles = counts_tiles_across() * ((view.height + TILE - 1u) / TILE);
    return words - (tiles - place.y * counts_tiles_across() - place.x) * PIXEL_COUNTS;
}
