// Motions of copies. Counterpart of `src/field/copies/dynamics.rs`.

#include "copy/instancer.wgsl"
#include "copy/noise.wgsl"
#include "copy/quaternion.wgsl"

struct CopyMotion {
    translation: vec3f,
    scale: f32,
    // Quaternion.
    rotation: vec4f,
    hue: f32,
    emission: f32,
}

// In the order of `DynamicKind`.
const DYNAMIC_WIND: u32 = 0u;
const DYNAMIC_SWAY: u32 = 1u;
const DYNAMIC_BOB: u32 = 2u;
const DYNAMIC_ORBIT: u32 = 3u;
const DYNAMIC_PULSE: u32 = 4u;
const DYNAMIC_SPIN: u32 = 5u;
const DYNAMIC_FLICKER: u32 = 6u;
const DYNAMIC_COLOR_CYCLE: u32 = 7u;
const DYNAMIC_RANDOM_WALK: u32 = 8u;
const DYNAMIC_BROWNIAN: u32 = 9u;
const DYNAMIC_CURL: u32 = 10u;

// Wind is still over this part of a gust around the source that it blows away from.
const DYNAMIC_CALM: f32 = 0.1;
// Values of noise over which gusts differ around a source.
const DYNAMIC_SECTORS: f32 = 3.0;
const DYNAMIC_CURL_SCALE: f32 = 0.4;
const DYNAMIC_TURN: f32 = 6.2831853;

// The sine of a number of turns.
fn dynamic_sine(turns: f32) -> f32 {
    return sin(DYNAMIC_TURN * (turns - round(turns)));
}

fn dynamic_cosine(turns: f32) -> f32 {
    return cos(DYNAMIC_TURN * (turns - round(turns)));
}

// The time of one copy: each has a stretch of the noise of its own.
fn dynamic_own_time(dynamic: CopyDynamic, random: f32) -> NoiseCoordinate {
    return NoiseCoordinate(dynamic.whole + i32(random * 16777216.0) * 1021, dynamic.fraction);
}

// Noise over time along each axis, in layers.
fn dynamic_walk(dynamic: CopyDynamic, randoms: vec3f, octaves: u32) -> vec3f {
    var sum = vec3f(0.0);
    var weight = 1.0;
    var whole = 0.0;
    for (var octave = 0u; octave < octaves; octave += 1u) {
        let times = f32(1u << octave);
        var noise = vec3f(0.0);
        for (var axis = 0u; axis < 3u; axis += 1u) {
            let own = dynamic_own_time(dynamic, randoms[axis]);
            let fraction = own.fraction * times;
            let at = NoiseCoordinate((own.whole << octave) + i32(floor(fraction)), fract(fraction));
            noise[axis] = copy_noise_1(dynamic.key + octave * 3u + axis, at);
        }
        sum += weight * noise;
        whole += weight;
        weight *= 0.5;
    }
    return sum / whole;
}

// Noise coordinate of a position, relative to the anchor's place, along one axis of the noise.
fn dynamic_coordinate(dynamic: CopyDynamic, axis: u32, row: vec4f, position: vec3f) -> NoiseCoordinate {
    return noise_moved(NoiseCoordinate(dynamic.place_whole[axis], dynamic.place[axis]), dot(row.xyz, position));
}

// A tilt with the wind about the copy's root, and a quiver.
fn dynamic_wind(dynamic: CopyDynamic, randoms: vec3f, position: vec3f) -> vec4f {
    let radial = dynamic.row_x.w;
    let core = dynamic.row_y.w;
    let gusts = dynamic.row_z.w;
    let off = position - dynamic.row_z.xyz;
    let way = length(off.xz);
    let outward = vec3f(off.x, 0.0, off.z) / length(vec2f(way, DYNAMIC_CALM / gusts));
    let along = vec3f(dynamic.a.x, 0.0, dynamic.a.z) * (1.0 - radial) + outward * radial;
    let across = vec3f(-along.z, 0.0, along.x);
    let straight = dynamic_coordinate(dynamic, 0u, dynamic.row_x, position);
    let beside = dynamic_coordinate(dynamic, 1u, dynamic.row_y, position);
    let s = noise_moved(straight, radial * way * gusts);
    let t = noise_moved(beside, radial * DYNAMIC_SECTORS * outward.x);
    // From 0 to 1: a gust never turns the wind around.
    let gust = copy_noise_2(dynamic.key, s, t);
    var strength = dynamic.b.x + (1.0 - dynamic.b.x) * gust;
    if dynamic.b.w > 0.0 {
        let beyond = max(length(off) / dynamic.b.w - core, 0.0) / (1.0 - core);
        let near = max(1.0 - beyond * beyond, 0.0);
        strength *= near * near;
    }
    strength *= 1.0 - (1.0 - dynamic.b.y) * randoms.y;
    let turns = dynamic.fraction + randoms.x;
    let quiver = vec2f(dynamic_sine(turns), dynamic_sine(turns + randoms.z)) * (dynamic.b.z * strength);
    let tilt = along * (dynamic.a.w * strength + quiver.x) + across * quiver.y;
    let size = length(tilt);
    let axis = vec3f(tilt.z, 0.0, -tilt.x) / max(size, 1e-20);
    return quaternion_about(axis, min(size, 1.5707963));
}

// Two unit vectors at right angles to a unit axis and to each other (Duff et al., "Building an
// Orthonormal Basis, Revisited", 2017).
fn copy_basis(axis: vec3f) -> mat2x3f {
    let side = select(1.0, -1.0, axis.z < 0.0);
    let a = -1.0 / (side + axis.z);
    let b = axis.x * axis.y * a;
    return mat2x3f(
        vec3f(1.0 + side * axis.x * axis.x * a, side * b, -side * axis.x),
        vec3f(b, side + axis.y * axis.y * a, -axis.y),
    );
}

// The motion by all dynamics, in order, of the copy of an absolute cell.
fn copy_motion(cell: vec3i, position: vec3f) -> CopyMotion {
    var motion = CopyMotion(vec3f(0.0), 1.0, vec4f(0.0, 0.0, 0.0, 1.0), 0.0, 1.0);
    let dynamics = instancer_count(instancer.dynamic_count, position.x);
    for (var i = 0u; i < dynamics; i += 1u) {
        let dynamic = instancer.dynamics[i];
        let randoms = copy_randoms(instancer.seed, cell, dynamic.channel);
        let turns = dynamic.fraction + dynamic.b.x * randoms.x;
        let axis = dynamic.a.xyz;
        switch dynamic.kind {
            case DYNAMIC_WIND: {
                motion.rotation = quaternion_product(dynamic_wind(dynamic, randoms, position), motion.rotation);
            }
            case DYNAMIC_SWAY: {
                let swing = quaternion_about(axis, dynamic.a.w * dynamic_sine(turns));
                motion.rotation = quaternion_product(swing, motion.rotation);
            }
            case DYNAMIC_BOB: {
                motion.translation += axis * dynamic_sine(turns);
            }
            case DYNAMIC_ORBIT: {
                let basis = copy_basis(axis);
                motion.translation += (basis[0] * dynamic_cosine(turns) + basis[1] * dynamic_sine(turns)) * dynamic.a.w;
            }
            case DYNAMIC_PULSE: {
                motion.scale *= 1.0 + dynamic.a.w * dynamic_sine(turns);
            }
            case DYNAMIC_SPIN: {
                let turn = quaternion_about(axis, DYNAMIC_TURN * (turns - round(turns)));
                motion.rotation = quaternion_product(turn, motion.rotation);
            }
            case DYNAMIC_FLICKER: {
                let noise = copy_noise_1(dynamic.key, dynamic_own_time(dynamic, randoms.x));
                motion.emission *= 1.0 - dynamic.a.w * (0.5 + 0.5 * noise);
            }
            case DYNAMIC_COLOR_CYCLE: {
                motion.hue += turns;
            }
            case DYNAMIC_RANDOM_WALK: {
                motion.translation += axis * dynamic_walk(dynamic, randoms, 1u);
            }
            case DYNAMIC_BROWNIAN: {
                motion.translation += axis * dynamic_walk(dynamic, randoms, u32(dynamic.b.y));
            }
            default: {
                let s = dynamic_coordinate(dynamic, 0u, dynamic.row_x, position);
                let t = dynamic_coordinate(dynamic, 1u, dynamic.row_y, position);
                let u = dynamic_coordinate(dynamic, 2u, dynamic.row_z, position);
                let whole = vec3i(s.whole, t.whole, u.whole);
                let at = vec3f(s.fraction, t.fraction, u.fraction);
                let flow = copy_curl(dynamic.key, whole, at, dynamic.fraction) * DYNAMIC_CURL_SCALE;
                motion.translation += axis * flow * inverseSqrt(1.0 + dot(flow, flow));
            }
        }
    }
    return motion;
}
