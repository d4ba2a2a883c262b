// One leaf of the subtree-extent array. The choice of the shape is generated: it holds only the shapes
// that the scene uses.

#include "common/scene.wgsl"
#include "sdf/op.wgsl"
#include "generated/shapes.wgsl"

// Distance from `p` (relative to the component's origin) to the leaf, safe to step by.
fn leaf_distance(node: FlatNode, joint: vec4f, p: vec3f) -> f32 {
    let x = numbers[node.numbers + 1u];
    let y = numbers[node.numbers + 2u];
    let z = numbers[node.numbers + 3u];
    let local = vec3f(dot(x.xyz, p) + x.w, dot(y.xyz, p) + y.w, dot(z.xyz, p) + z.w);
    let a = numbers[node.numbers + LEAF_ROWS];
    let b = numbers[node.numbers + LEAF_ROWS + 1u];
    return shape_distance(node.code & 0xffffu, local, a, b) * joint.y;
}

// Whether the group or run at `node` cannot change the value `so_far`: its field is at least slope times the
// distance to its bounds, so beyond that the joint is exactly its first operand.
fn field_group_is_out_of_reach(node: FlatNode, joint: vec4f, so_far: f32, p: vec3f) -> bool {
    let center = numbers[node.numbers + 1u].xyz;
    let half = numbers[node.numbers + 2u].xyz;
    let least = joint.y * length(max(abs(p - center) - half, vec3f(0.0)));
    let kind = (node.code >> 16u) & 0xffu;
    let out = (kind == JOIN_UNION && least >= so_far + joint.x)
        || (kind == JOIN_DIFFERENCE && least >= joint.x - so_far);
    // Within its bounds nothing is known of the group's field: it may be far below 0.
    return out && least > 0.0;
}
