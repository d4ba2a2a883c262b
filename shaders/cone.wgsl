// Pass `cone`: one invocation per tile. Marches a cone that encloses all rays of the tile through
// the component: no ray of the tile needs to look at a stretch that the cone passes without
// touching anything. Drops tiles whose cone touches nothing, or only hidden parts. Tests the four
// subtiles of the other tiles in the same way, and lists those that remain with a safe start.

#include "common/view.wgsl"
#include "common/depth.wgsl"
#include "common/dispatch.wgsl"
#include "common/subtiles.wgsl"
#include "common/lookahead.wgsl"
#include "generated/value.wgsl"
#include "common/bounds.wgsl"
#include "common/counts.wgsl"
#include "common/cone_list.wgsl"

// See `common/counts.wgsl`.
@group(2) @binding(3) var<storage, read_write> march_counts: array<atomic<u32>>;

// Maximum steps of a cone; the rays do the rest.
const CONE_STEPS: u32 = 48u;
// A cone stops where the surface may be nearer to its border than this, in footprints.
const CONE_CLEARANCE: f32 = select(0.25, 0.1, VERIFIED_OVERSTEP);

struct Cone {
    axis: Ray,
    // Tangent and cosine of the angle to the farthest ray.
    spread: f32,
    cosine: f32,
}

// The cone around the rays through the centers of `side` by `side` pixels. Computes angles from the
// distances between the rays in the picture: the cosine of a small angle rounds to 1.
fn cone_around(component: Component, pixel: vec2u, side: u32) -> Cone {
    let middle = view_offset(vec2f(pixel) + 0.5 * f32(side));
    let right = view.right * (f32(side - 1u) / f32(view.width));
    let down = view.up * (f32(side - 1u) / -f32(view.height));
    let a = right + down;
    let b = right - down;
    let forward = middle + view.forward;
    let lengths = vec4f(length(forward + a), length(forward - a), length(forward + b), length(forward - b));
    // The sum of the four unit directions passes through the mean of their places, weighted by
    // 1 / length.
    let weights = 1.0 / lengths;
    let moved = (a * (weights.x - weights.y) + b * (weights.z - weights.w)) / dot(weights, vec4f(1.0));
    let axis = forward + moved;
    let ways = array<vec3f, 4>(a - moved, -a - moved, b - moved, -b - moved);
    let along = dot(axis, axis) + vec4f(dot(axis, ways[0]), dot(axis, ways[1]), dot(axis, ways[2]), dot(axis, ways[3]));
    let across = vec4f(
        length(cross(axis, ways[0])),
        length(cross(axis, ways[1])),
        length(cross(axis, ways[2])),
        length(cross(axis, ways[3])),
    );
    let tangents = across / along;
    let cosines = along / (length(axis) * lengths);
    return Cone(
        ray_toward(component, middle + moved),
        max(max(tangents.x, tangents.y), max(tangents.z, tangents.w)) * 1.0001,
        min(min(cosines.x, cosines.y), min(cosines.z, cosines.w)),
    );
}

// Smallest `t` at which a ray of the tile may enter the component's half space.
fn cone_half_space_entry(component: Component, pixel: vec2u) -> f32 {
    let far = pixel + TILE - 1u;
    return min(
        min(
            bounds_half_space_entry(component, ray_through(component, pixel)),
            bounds_half_space_entry(component, ray_through(component, far)),
        ),
        min(
            bounds_half_space_entry(component, ray_through(component, vec2u(pixel.x, far.y))),
            bounds_half_space_entry(component, ray_through(component, vec2u(far.x, pixel.y))),
        ),
    );
}

// Interval of `t` in which a ray of the tile may be within the component, clipped to near and far.
fn cone_interval(component: Component, cone: Cone, place: vec2u) -> vec2f {
    // The box, grown by the cone's radius at its far end.
    let far_corner = max(abs(component.low - component.eye), abs(component.high - component.eye));
    let reached = min(length(far_corner) + cone.axis.skipped, 1e9);
    let interval = bounds_interval(component, cone.axis, cone.spread * reached);
    let entry = cone_half_space_entry(component, place * TILE);
    return vec2f(max(max(interval.x, dispatch.near), entry), min(interval.y, dispatch.far));
}

@compute @workgroup_size(64)
fn cone(@builtin(global_invocation_id) id: vec3u) {
    let columns = (dispatch.end.x - dispatch.origin.x + TILE - 1u) / TILE;
    let rows = (dispatch.end.y - dispatch.origin.y + TILE - 1u) / TILE;
    let place = dispatch.origin / TILE + vec2u(id.x % columns, id.x / columns);
    let component = subject;
    field_begin(component);

    var cone = cone_around(component, place * TILE, TILE);
    let interval = cone_interval(component, cone, place);
    let limit = interval.y;
    var exit = min(limit, cone_hiz_of_tile(place));
    // A distance along the axis is that along a ray times the cosine, or more.
    var t = interval.x * cone.cosine;
    let enters = id.x < columns * rows && t <= exit;
    // First the cone around the tile, then, from where that stopped, the cones around its subtiles:
    // one loop, so that the source has one call of the field.
    var start = array<f32, 4>(CONE_PASSED, CONE_PASSED, CONE_PASSED, CONE_PASSED);
    var descents = array<f32, 4>();
    if !CONES && enters {
        start = array<f32, 4>(t, t, t, t);
    }
    var whole = t;
    var quarter = select(4u, 0u, CONES && enters);
    var of_tile = true;
    var steps = 0u;
    var evaluations = 0u;
    // `t` of the last evaluation on this cone's axis.
    var last = NEVER;
    // The field there, and its descent since the previous evaluation. A subtile that stops at its
    // first evaluation has the descent of the tile.
    var before = 0.0;
    var descent = 0.0;
    let reach = length(component.eye);
    while quarter < 4u {
        lookahead_begin(t - last, LOOKAHEAD_WINDOW * max(t - last, 0.0), 2.0 * SPACING * (t + reach));
        let f = field(ray_at(cone.axis, t));
        descent = select(descent, (before - f) / (t - last), t > last);
        last = t;
        before = f;
        steps += 1u;
        evaluations += 1u;
        let clear = f - cone.spread * t;
        let stopped = clear < CONE_CLEARANCE * view.footprint * t || steps >= min(CONE_STEPS, dispatch.max_steps / 5u + 1u);
        let next = t + max(min(clear / (lookahead_slope(f) + cone.spread), lookahead_window), clear / (1.0 + cone.spread));
        if !stopped && next <= exit {
            t = next;
            continue;
        }
        if of_tile {
            if !stopped {
                break;
            }
            of_tile = false;
            whole = t * cone.cosine;
        } else {
            if stopped && t * cone.cosine <= exit {
                let free_interval = f - 2.0 * SPACING * (t + reach);
                start[quarter] = select(t * cone.cosine, t + free_interval, VERIFIED_OVERSTEP && free_interval > cone.spread * t);
                descents[quarter] = descent;
            }
            quarter += 1u;
        }
        if quarter < 4u {
            cone = cone_around(component, cone_subtile(place, quarter) * SUBTILE, SUBTILE);
            exit = min(limit, cone_hiz(place, quarter));
            t = whole;
            last = NEVER;
            steps = 0u;
        }
    }
    if COUNTING && enters {
        cone_count(place, evaluations);
    }
    cone_list(place, &start, &descents);
}

// Adds the cost of a tile's cones to the counts of the list, the tile and the component.
fn cone_count(place: vec2u, evaluations: u32) {
    atomicAdd(&subtile_counts[dispatch.list * SUBTILE_COUNTS + 3u], evaluations);
    let of_tile = counts_of_tile(arrayLength(&march_counts), place);
    atomicAdd(&march_counts[of_tile], evaluations);
    atomicAdd(&march_counts[of_tile + 2u], walked.x);
    atomicAdd(&march_counts[of_tile + 3u], walked.y);
    atomicAdd(&march_counts[dispatch.component * COMPONENT_COUNTS + 3u], walked.x);
    atomicAdd(&march_counts[dispatch.component * COMPONENT_COUNTS + 4u], walked.y);
}
