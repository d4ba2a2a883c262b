// Layout of the buffer of counts: per component at its beginning; in counting pipelines also per
// pixel at its end, and behind that per tile, for the cones. Counterpart of `PixelCounts` on the
// CPU.

#include "common/view.wgsl"
#include "common/dispatch.wgsl"
#include "common/walked.wgsl"

// Words of a component: rays unfinished after the last relaunch, evaluations by rays, rays started;
// then cells and tape entries that rays and cones have read.
const COMPONENT_COUNTS: u32 = 5u;
// Words of a pixel: evaluations by its rays, rays started, cells, tape entries. Words of a tile:
// the same for its cones, without rays.
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
