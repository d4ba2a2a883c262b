// An instancer. Counterpart of `GpuInstancer` in `src/field/copies/gpu.rs`. Passes over one type at a
// time bind the instancer of the dispatch as `instancer`. Those over the whole scene bind all of
// them, and the assembler makes `instancers[instancer_at]` of that name.
//
// Cells are relative to the anchor, the cell nearest to the eye, and positions to its place: so they
// are as exact far from the instancer's origin as near it.

struct CopyMask {
    kind: u32,
    inverted: u32,
    key: u32,
    join: u32,
    params: vec4f,
    // Noise coordinates of the anchor's place. Of an image: its first row among `places` and how it
    // lies; the anchor's place in pixels.
    whole: vec2i,
    fraction: vec2f,
    // Greatest slope of the curve, -1 without one; it is 0 up to the second number and from the
    // third one on; its first row among `places`.
    curve: vec4f,
}

struct CopyDynamic {
    kind: u32,
    key: u32,
    // Periods since the start.
    whole: i32,
    fraction: f32,
    a: vec4f,
    b: vec4f,
    // Noise coordinates of the anchor's place, and their change with the position.
    place_whole: vec3i,
    channel: u32,
    place: vec3f,
    padding: u32,
    // Wind: the third one is its source, relative to the anchor's place. The last numbers are how far
    // it blows outward, the share of the radius without falloff, and gusts per meter.
    row_x: vec4f,
    row_y: vec4f,
    row_z: vec4f,
}

struct Instancer {
    // Instancer's space, relative to the anchor's place, from positions relative to the eye.
    local_x: vec4f,
    local_y: vec4f,
    local_z: vec4f,
    // Limits of the cells, relative to the anchor; those of endless axes are far beyond any walk.
    low: vec3i,
    seed: u32,
    high: vec3i,
    probability: f32,
    // Absolute cell of the anchor.
    anchor: vec3i,
    mask_count: u32,
    spacing: vec3f,
    // Most that lengths of the world grow by in the instancer's space.
    most_factor: f32,
    // Absolute place of the anchor.
    anchor_place: vec3f,
    stagger: f32,
    // Size of the part of a cell in which a copy may stand.
    jitter: vec3f,
    dynamic_count: u32,
    offset_min: vec3f,
    type_count: u32,
    offset_max: vec3f,
    palette_count: u32,
    // In radians.
    rotation_min: vec3f,
    uniform_scale: u32,
    rotation_max: vec3f,
    // Nodes of the tree over places; 0 for a lattice.
    tree_count: u32,
    scale_min: vec3f,
    roughness: f32,
    scale_max: vec3f,
    emission: f32,
    hue: f32,
    saturation: f32,
    value: f32,
    // First row of the places, after the tree.
    first_place: u32,
    // Bounds of all copies, relative to the anchor's place.
    bounds_low: vec3f,
    first_row: u32,
    bounds_high: vec3f,
    // Visits that a cell counts as; only of queries.
    cell_visits: u32,
    // How far the content of a copy may reach from its place along each axis.
    reach: vec3f,
    // How far it may reach from where the copy stands at rest, with its looseness and its offset.
    reach_at_rest: f32,
    // Sums of the shares of the types, four per row.
    shares: array<vec4f, 8>,
    // Bounding spheres of the types.
    spheres: array<vec4f, 32>,
    // Four per row.
    palette: array<vec4u, 16>,
    masks: array<CopyMask, 8>,
    dynamics: array<CopyDynamic, 8>,
    // The nodes at which the trees of the types begin, four per row; WALK_NOWHERE for none.
    roots: array<vec4u, 8>,
    // The components of the types, four per row; only of queries.
    components: array<vec4u, 8>,
}

// Beside it `places`, the lists of places. Per instancer: a tree of boxes, two rows per node, lower
// and upper corner, with the link and the axis as bits in w; then three rows per place: position
// with the cosine of the slope of the ground, rotation, id with the type. Per lattice: images and curves of
// its masks, four pixels or samples per row.
#include "generated/instancer.wgsl"

// A number of the instancer that ends a loop or decides. lavapipe compiles a pipeline anew for each
// value of such a uniform, and writes beyond its memory if there are several. It leaves those alone
// that depend on an invocation's own data, here `x`, which is never this.
const INSTANCER_NOWHERE: f32 = 3.3e38;

fn instancer_count(count: u32, x: f32) -> u32 {
    return select(count, 0u, x == INSTANCER_NOWHERE);
}

// A point of the instancer's space, relative to the anchor's place, from one relative to the eye.
fn instancer_local_point(p: vec3f) -> vec3f {
    let q = vec4f(p, 1.0);
    return vec3f(dot(instancer.local_x, q), dot(instancer.local_y, q), dot(instancer.local_z, q));
}

fn instancer_local_direction(d: vec3f) -> vec3f {
    return vec3f(dot(instancer.local_x.xyz, d), dot(instancer.local_y.xyz, d), dot(instancer.local_z.xyz, d));
}
