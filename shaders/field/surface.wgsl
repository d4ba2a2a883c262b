// The field with what the surface is made of: the same fold as `field/value.wgsl`, carrying the
// materials mixed by the joints' weights, and the leaf that weighs most. Twin of `flat::twin::surface`.

#include "field/leaf.wgsl"

struct Surface {
    distance: f32,
    leaf: u32,
    albedo: vec3f,
    specular: f32,
    emission: vec3f,
    shininess: f32,
}

var<private> surface_stack: array<Surface, STACK_SIZE>;
var<private> surface_group: array<u32, STACK_SIZE>;

fn join_surface(node: FlatNode, support: f32, so_far: Surface, operand: Surface) -> Surface {
    let join = (node.code >> 16u) & 0xffu;
    if join == JOIN_FIRST {
        return operand;
    }
    let joined = op_join(join, so_far.distance, operand.distance, support, node.code >> 24u);
    let w = joined.y;
    return Surface(
        joined.x,
        select(so_far.leaf, operand.leaf, w > 0.5),
        mix(so_far.albedo, operand.albedo, w),
        mix(so_far.specular, operand.specular, w),
        mix(so_far.emission, operand.emission, w),
        mix(so_far.shininess, operand.shininess, w),
    );
}

fn surface(first: u32, end: u32, p: vec3f) -> Surface {
    var so_far = Surface(0.0, first, vec3f(0.0), 0.0, vec3f(0.0), 1.0);
    var depth = 0u;
    var at = first;
    while at < end {
        let node = nodes[at];
        let joint = numbers[node.numbers];
        if (node.code & 0xffffu) == GROUP {
            if !group_is_out_of_reach(node, joint, so_far.distance, p) {
                surface_stack[depth] = so_far;
                surface_group[depth] = at;
                depth += 1u;
                at += 1u;
                continue;
            }
            at += node.extent;
        } else {
            let m = materials[node.material];
            let operand = Surface(leaf_distance(node, joint, p), at, m.albedo, m.specular, m.emission, m.shininess);
            so_far = join_surface(node, joint.x, so_far, operand);
            at += 1u;
        }
        while depth > 0u {
            let group = nodes[surface_group[depth - 1u]];
            if surface_group[depth - 1u] + group.extent != at {
                break;
            }
            depth -= 1u;
            so_far = join_surface(group, numbers[group.numbers].x, surface_stack[depth], so_far);
        }
    }
    return so_far;
}
