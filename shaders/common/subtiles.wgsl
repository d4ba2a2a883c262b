// Quarters of tiles, for the passes after the cone pass: a workgroup takes four of a list, from anywhere.

struct Subtile {
    // Column and row, 16 bits each.
    place: u32,
    // Nothing of the component is nearer than this along any of its rays; of pipelines that overstep far, along the middle ray:
    // along the others it may be as much nearer as they are apart there.
    start: f32,
    // By how much the field falls there per distance along the middle ray; 0 where that is not known.
    descent: f32,
}

// Pixels along a side.
const SUBTILE: u32 = 4u;
// Words of a list of subtiles: the arguments of an indirect dispatch (groups of four subtiles, 1, 1), evaluations by the cones
// that wrote it, subtiles.
const SUBTILE_COUNTS: u32 = 5u;
// Words of a list of what its rays leave: groups of 64 rays that have not ended, 1, 1; groups of four subtiles with hits, 1, 1,
// these subtiles.
const RAY_COUNTS: u32 = 7u;

// Column and row as one word, and back.
fn subtile_pack(place: vec2u) -> u32 {
    return place.x | (place.y << 16u);
}

fn subtile_unpack(place: u32) -> vec2u {
    return vec2u(place & 0xffffu, place >> 16u);
}

// Upper left pixel of a subtile.
fn subtile_pixel(place: u32) -> vec2u {
    return subtile_unpack(place) * SUBTILE;
}

// Which of the workgroup's subtiles an invocation is in.
fn subtile_of(lane: u32) -> u32 {
    return lane / 16u;
}

// Of pipelines that overstep far: nothing of the component is nearer along the ray of the invocation. Rays are apart by a footprint
// for each pixel, or less; a thousandth more is for the middle ray, which is that of no pixel, and for rounding.
fn subtile_start(subtile: Subtile, lane: u32) -> f32 {
    let from_middle = vec2f(subtile_place(lane)) - 0.5 * f32(SUBTILE - 1u);
    return subtile.start * (1.0 - 1.001 * length(from_middle) * view.footprint);
}

// Invocations that run together (eight on lavapipe, 32 or more on graphics cards) lie close together: halves of a subtile are
// blocks of 4 by 2 pixels.
fn subtile_place(lane: u32) -> vec2u {
    return vec2u(lane & 3u, lane >> 2u & 3u);
}
