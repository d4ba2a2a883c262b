// One leaf of the subtree-extent array. The choice of the shape is generated: it holds only the shapes
// that the scene uses.

#include "common/scene.wgsl"
#include "sdf/op.wgsl"
#include "generated/shapes.wgsl"

// Where `p` (relative to the component's origin) stands in the leaf's own space; its rows begin at `row`.
fn leaf_place(row: u32, p: vec3f) -> vec3f {
    let x = scene_row(row + 1u);
    let y = scene_row(row + 2u);
    let z = scene_row(row + 3u);
    return vec3f(dot(x.xyz, p) + x.w, dot(y.xyz, p) + y.w, dot(z.xyz, p) + z.w);
}

// Distance from `p` to the leaf, safe to step by. `joint` is the first of its rows.
fn leaf_distance(shape: u32, row: u32, joint: vec4f, p: vec3f) -> f32 {
    return shape_distance(shape, leaf_place(row, p), row + LEAF_ROWS) * joint.y;
}

// Whether the group or run at `node` cannot change the value `so_far`: its field is at least slope times the
// distance to its bounds, so beyond that the joint is exactly its first operand.
fn field_group_is_out_of_reach(node: FlatNode, joint: vec4f, so_far: f32, p: vec3f) -> bool {
    let center = scene_row(node.numbers + 1u).xyz;
    let half = scene_row(node.numbers + 2u).xyz;
    let least = joint.y * length(max(abs(p - center) - half, vec3f(0.0)));
    let kind = (node.code >> 16u) & 0xffu;
    let out = (kind == JOIN_UNION && least >= so_far + joint.x)
        || (kind == JOIN_DIFFERENCE && least >= joint.x - so_far);
    // Within its bounds nothing is known of the group's field: it may be far below 0.
    return SKIPPING && out && least > 0.0;
}
