// Which copy each pixel shows: two entries of a buffer. The first holds the place of the copy, see
// `copy_at`, and 1 + the component; 0 if no copy was ever nearest there. The second holds at first
// where an unfinished march goes on, then how the copy's material differs.

#include "common/view.wgsl"

// The first entry of a pixel.
fn copied_place(pixel: vec2u) -> u32 {
    return 2u * (pixel.y * view.width + pixel.x);
}
