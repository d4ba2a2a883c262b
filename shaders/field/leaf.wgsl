// One leaf of the subtree-extent array. The switch over the shapes is generated: it holds only the
// shapes of the scene.

#include "common/scene.wgsl"
#include "sdf/op.wgsl"
#include "generated/shapes.wgsl"

// `p`, relative to the component's origin, in the leaf's own space; the leaf's rows begin at `row`.
fn leaf_place(row: u32, p: vec3f) -> vec3f {
    let x = scene_row(row + 1u);
    let y = scene_row(row + 2u);
    let z = scene_row(row + 3u);
    return vec3f(dot(x.xyz, p) + x.w, dot(y.xyz, p) + y.w, dot(z.xyz, p) + z.w);
}

// Distance from `p` to the leaf, safe to step by. `blend_params` is the first of its rows.
fn leaf_distance(shape: u32, row: u32, blend_params: vec4f, p: vec3f) -> f32 {
    return shape_distance(shape, leaf_place(row, p), row + LEAF_ROWS) * blend_params.y;
}

// Whether the group or run at `node` cannot change the value `so_far`: its field is at least slope times the
// distance to its bounds, so beyond that the blend is exactly its first operand.
fn field_group_is_out_of_reach(node: FlatNode, blend_params: vec4f, so_far: f32, p: vec3f) -> bool {
    let center = scene_row(node.params + 1u).xyz;
    let half = scene_row(node.params + 2u).xyz;
    let least = blend_params.y * length(max(abs(p - center) - half, vec3f(0.0)));
    let kind = (node.code >> 16u) & 0xffu;
    let out = (kind == JOIN_UNION && least >= so_far + blend_params.x)
        || (kind == JOIN_DIFFERENCE && least >= blend_params.x - so_far);
    // Within its bounds the field of the group is unknown: it may be far below 0.
    return SKIPPING && out && least > 0.0;
}
