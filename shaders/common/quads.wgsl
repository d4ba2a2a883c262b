// Quarters of tiles, for the passes after the cone pass: a workgroup takes four of a list, from anywhere.

struct Quad {
    // Column and row, 16 bits each.
    place: u32,
    // Nothing of the component is nearer than this along any of its rays; of kernels that leap far, along the middle ray:
    // along the others it may be as much nearer as they are apart there.
    start: f32,
    // By how much the field falls there per distance along the middle ray; 0 where that is not known.
    fall: f32,
}

// Pixels along a side.
const QUAD: u32 = 4u;
// Words of a list of quads: the arguments of an indirect dispatch (groups of four quads, 1, 1), evaluations by the cones
// that wrote it, quads.
const QUAD_COUNTS: u32 = 5u;
// Words of a list of what its rays leave: groups of 64 rays that have not ended, 1, 1; groups of four quads with hits, 1, 1,
// these quads.
const RAY_COUNTS: u32 = 7u;

// Column and row as one word, and back.
fn quad_packed(place: vec2u) -> u32 {
    return place.x | (place.y << 16u);
}

fn quad_unpacked(place: u32) -> vec2u {
    return vec2u(place & 0xffffu, place >> 16u);
}

// Upper left pixel of a quad.
fn quad_pixel(place: u32) -> vec2u {
    return quad_unpacked(place) * QUAD;
}

// Which of the workgroup's quads an invocation is in.
fn quad_of(lane: u32) -> u32 {
    return lane / 16u;
}

// Of kernels that leap far: nothing of the component is nearer along the ray of the invocation. Rays are apart by a footprint
// for each pixel, or less; a thousandth more is for the middle ray, which is that of no pixel, and for rounding.
fn quad_start(quad: Quad, lane: u32) -> f32 {
    let from_middle = vec2f(quad_place(lane)) - 0.5 * f32(QUAD - 1u);
    return quad.start * (1.0 - 1.001 * length(from_middle) * view.footprint);
}

// Invocations that run together (eight on lavapipe, 32 or more on graphics cards) lie close together: halves of a quad are
// blocks of 4 by 2 pixels.
fn quad_place(lane: u32) -> vec2u {
    return vec2u(lane & 3u, lane >> 2u & 3u);
}
