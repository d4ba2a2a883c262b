// What sets a copy apart. Counterpart of `src/field/copies/variation.rs`.

#include "copy/dynamics.wgsl"
#include "copy/masks.wgsl"

struct Copy {
    // Absolute cell, or the id of the place.
    cell: vec3i,
    kind: u32,
    // Where its origin is, in the instancer's space, relative to the anchor's place.
    position: vec3f,
    hue: f32,
    // Quaternion.
    rotation: vec4f,
    // Size along its own axes.
    scale: vec3f,
    emission: f32,
    // Cell relative to the anchor, or the index of the place: see `copy_at`.
    place: vec3i,
}

// Kind of a copy that does not exist.
const COPY_ABSENT: u32 = 0xffffffffu;
// Asks for copies of all kinds.
const COPY_OF_ANY: u32 = 0xfffffffeu;
// A copy whose scale is less than this along an axis is not there.
const COPY_LEAST_SCALE: f32 = 1e-6;

// In the order of `Channel`.
const CHANNEL_CHOICE: u32 = 0u;
const CHANNEL_PLACE: u32 = 1u;
const CHANNEL_OFFSET: u32 = 2u;
const CHANNEL_ROTATION: u32 = 3u;
const CHANNEL_SCALE: u32 = 4u;
const CHANNEL_COLOR: u32 = 5u;
const CHANNEL_SURFACE: u32 = 6u;

// The type of the copy of an absolute cell that stands at `base`; COPY_ABSENT if there is none. Also the
// numbers of the instancer, of its masks and of its types.
fn copy_kind(cell: vec3i, base: vec3f, seed: u32, probability: f32, masks: u32, types: u32) -> u32 {
    let randoms = copy_randoms(seed, cell, CHANNEL_CHOICE);
    if randoms.x >= probability * copy_masks(base, masks) {
        return COPY_ABSENT;
    }
    var kind = 0u;
    while kind + 1u < types && randoms.y >= instancer.shares[kind / 4u][kind % 4u] {
        kind += 1u;
    }
    return kind;
}

// A copy before its size, its rotation and its motion are known.
struct CopyAtRest {
    cell: vec3i,
    kind: u32,
    // Where it stands when it does not move.
    place: vec3f,
    turned: vec4f,
}

// A copy that exists, off its base.
fn copy_placed(cell: vec3i, kind: u32, base: vec3f, turned: vec4f, jitter: vec3f) -> CopyAtRest {
    let seed = instancer.seed;
    let loose = (copy_randoms(seed, cell, CHANNEL_PLACE) - 0.5) * jitter;
    let offset = mix(instancer.offset_min, instancer.offset_max, copy_randoms(seed, cell, CHANNEL_OFFSET));
    return CopyAtRest(cell, kind, base + loose + quaternion_rotated(turned, offset), turned);
}

// The copy in its size, turned and moved. One whose size is none is absent.
fn copy_moved(at: vec3i, at_rest: CopyAtRest) -> Copy {
    let seed = instancer.seed;
    let cell = at_rest.cell;
    let place = at_rest.place;
    let angles = mix(instancer.rotation_min, instancer.rotation_max, copy_randoms(seed, cell, CHANNEL_ROTATION));
    let sines = sin(0.5 * angles);
    let cosines = cos(0.5 * angles);
    let about_y = vec4f(0.0, sines.y, 0.0, cosines.y);
    let about_x = vec4f(sines.x, 0.0, 0.0, cosines.x);
    let about_z = vec4f(0.0, 0.0, sines.z, cosines.z);
    let own = quaternion_product(quaternion_product(about_y, about_x), about_z);
    let random = copy_randoms(seed, cell, CHANNEL_SCALE);
    let sizes = select(random, random.xxx, instancer.uniform_scale == 1u);
    let motion = copy_motion(cell, place);
    let scale = mix(instancer.scale_min, instancer.scale_max, sizes) * motion.scale;
    let is_there = min(scale.x, min(scale.y, scale.z)) >= COPY_LEAST_SCALE;
    return Copy(
        cell,
        select(COPY_ABSENT, at_rest.kind, is_there),
        place + motion.translation,
        motion.hue,
        quaternion_product(motion.rotation, quaternion_product(at_rest.turned, own)),
        scale,
        motion.emission,
        at,
    );
}

const QUATERNION_NONE: vec4f = vec4f(0.0, 0.0, 0.0, 1.0);

// A copy that does not exist.
fn copy_none() -> Copy {
    return Copy(vec3i(0), COPY_ABSENT, vec3f(0.0), 0.0, QUATERNION_NONE, vec3f(1.0), 1.0, vec3i(0));
}

// Place of a cell, both relative to the anchor.
fn copy_cell_place(relative: vec3i) -> vec3f {
    var place = vec3f(relative) * instancer.spacing;
    // The anchor's own shift is in its place.
    let shifted = (relative.z & 1) * select(1, -1, (instancer.anchor.z & 1) == 1);
    place.x += 2.0 * instancer.stagger * f32(shifted);
    return place;
}

// The copy of a cell relative to the anchor, or at the place `at.x` of the list, if it is of this
// type; else one of kind COPY_ABSENT.
fn copy_at(at: vec3i, kind: u32) -> Copy {
    let at_rest = copy_at_rest(at, kind);
    if at_rest.kind == COPY_ABSENT {
        return copy_none();
    }
    return copy_moved(at, at_rest);
}

// The same before it moves.
fn copy_at_rest(at: vec3i, kind: u32) -> CopyAtRest {
    var cell = at + instancer.anchor;
    var base = copy_cell_place(at);
    var turned = QUATERNION_NONE;
    var jitter = instancer.jitter;
    var own = COPY_ABSENT;
    let seed = instancer.seed;
    let probability = instancer.probability;
    let masks = instancer_count(instancer.mask_count, base.x);
    let types = instancer_count(instancer.type_count, base.x);
    if instancer_count(instancer.tree_count, base.x) > 0u {
        let row = instancer.first_place + 3u * u32(at.x);
        let id = bitcast<vec4u>(places[row + 2u]);
        cell = vec3i(id.xyz);
        // Only places where a copy stands are in the list.
        own = id.w;
        base = places[row].xyz;
        turned = places[row + 1u];
        jitter = vec3f(0.0);
    } else {
        own = copy_kind(cell, base, seed, probability, masks, types);
    }
    if own == COPY_ABSENT || (own != kind && kind != COPY_OF_ANY) {
        return CopyAtRest(cell, COPY_ABSENT, base, turned);
    }
    return copy_placed(cell, own, base, turned, jitter);
}

fn copy_of_cell(relative: vec3i, kind: u32) -> Copy {
    return copy_at(relative, kind);
}

fn copy_of_place(place: u32, kind: u32) -> Copy {
    return copy_at(vec3i(i32(place), 0, 0), kind);
}

// Bounding sphere of a copy: center, relative to the anchor's place, and radius.
fn copy_sphere(copy: Copy) -> vec4f {
    let sphere = instancer.spheres[copy.kind];
    let center = copy.position + quaternion_rotated(copy.rotation, copy.scale * sphere.xyz);
    return vec4f(center, sphere.w * max(copy.scale.x, max(copy.scale.y, copy.scale.z)));
}
