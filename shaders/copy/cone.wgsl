// The pass `cone` for the type of an instancer: one invocation per tile. Lists the subtiles from
// which the bounds of all copies are seen, without an evaluation.

#include "common/view.wgsl"
#include "common/scene.wgsl"
#include "common/cone_list.wgsl"
#include "copy/walk.wgsl"

@compute @workgroup_size(64)
fn cone(@builtin(global_invocation_id) id: vec3u) {
    let columns = (dispatch.end.x - dispatch.origin.x + TILE - 1u) / TILE;
    let rows = (dispatch.end.y - dispatch.origin.y + TILE - 1u) / TILE;
    let place = dispatch.origin / TILE + vec2u(id.x % columns, id.x / columns);
    let origin = instancer_local_point(vec3f(0.0));
    let axis = normalize(view_offset(vec2f(place * TILE) + 0.5 * f32(TILE)) + view.forward);
    let direction = instancer_local_direction(axis);
    // Upper bound of the factor on lengths, then of the angle to the farthest ray.
    let rows_of = mat3x3f(instancer.local_x.xyz, instancer.local_y.xyz, instancer.local_z.xyz);
    let factor = sqrt(dot(rows_of[0], rows_of[0]) + dot(rows_of[1], rows_of[1]) + dot(rows_of[2], rows_of[2]));
    let spread = 0.75 * f32(TILE) * view.footprint * factor;
    let corner = max(abs(instancer.bounds_low - origin), abs(instancer.bounds_high - origin));
    let far = min(dispatch.far, 1.01 * length(min(corner, vec3f(1e15))) / length(direction) + 1.0);
    let walk = copy_walk_begin(COPY_OF_ANY, origin, direction, dispatch.near, far, spread, 0u);
    let is_met = id.x < columns * rows && (walk.left > 0 || walk.open > 0u);
    // Slightly early, for the rays beside the axis.
    let entry = max(walk.near * 0.99, dispatch.near);
    let hiz = vec4f(cone_hiz(place, 0u), cone_hiz(place, 1u), cone_hiz(place, 2u), cone_hiz(place, 3u));
    let starts = select(vec4f(CONE_PASSED), vec4f(entry), vec4<bool>(is_met) & (vec4f(entry) <= hiz));
    var start = array<f32, 4>(starts.x, starts.y, starts.z, starts.w);
    var descents = array<f32, 4>();
    cone_list(place, &start, &descents);
}
