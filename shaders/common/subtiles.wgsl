// Subtiles, the quarters of tiles, for the passes after the cone pass. A workgroup takes four
// subtiles of a list, from any place in the picture.

struct Subtile {
    // Column and row, 16 bits each.
    place: u32,
    // Nothing of the component is nearer than this along any ray of the subtile. With verified
    // oversteps this holds along the middle ray; along the others the component may be nearer by as
    // much as the rays are apart there.
    start: f32,
    // Descent of the field there per distance along the middle ray; 0 if unknown.
    descent: f32,
}

// Pixels along a side.
const SUBTILE: u32 = 4u;
// Words of a list of subtiles: the arguments of an indirect dispatch (groups of four subtiles, 1,
// 1), evaluations by the cones that wrote it, number of subtiles.
const SUBTILE_COUNTS: u32 = 5u;
// Words of a list for its rays: groups of 64 unfinished rays, 1, 1; groups of four subtiles with
// hits, 1, 1, number of these subtiles.
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

// Index of an invocation's subtile in its workgroup.
fn subtile_of(lane: u32) -> u32 {
    return lane / 16u;
}

// With verified oversteps: nothing of the component is nearer along the ray of the invocation. Rays
// are at most a footprint apart per pixel; a thousandth more covers rounding and the middle ray,
// which belongs to no pixel.
fn subtile_start(subtile: Subtile, lane: u32) -> f32 {
    let from_middle = vec2f(subtile_place(lane)) - 0.5 * f32(SUBTILE - 1u);
    return subtile.start * (1.0 - 1.001 * length(from_middle) * view.footprint);
}

// Pixel of an invocation in its subtile. Invocations that run together (eight on lavapipe, 32 or
// more on graphics cards) lie close together: halves of a subtile are blocks of 4 by 2 pixels.
fn subtile_place(lane: u32) -> vec2u {
    return vec2u(lane & 3u, lane >> 2u & 3u);
}
