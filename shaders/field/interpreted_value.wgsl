// The field of a component: the fold over its range of the subtree-extent array.
// Twin of `flat::twin::field`.

#include "field/leaf.wgsl"

var<private> value_first: u32;
var<private> value_end: u32;
var<private> value_stack: array<f32, STACK_SIZE>;
var<private> value_group: array<u32, STACK_SIZE>;

fn join_value(node: FlatNode, support: f32, so_far: f32, value: f32) -> f32 {
    let join = (node.code >> 16u) & 0xffu;
    if join == JOIN_FIRST {
        return value;
    }
    return op_join(join, so_far, value, support, node.code >> 24u).x;
}

// Chooses the component. Before any call of `field`.
fn field_begin(component: Component) {
    value_first = component.first;
    value_end = component.end;
}

// The field at `p`, relative to the component's origin.
fn field(p: vec3f) -> f32 {
    var so_far = 0.0;
    var depth = 0u;
    var at = value_first;
    while at < value_end {
        let node = nodes[at];
        let joint = scene_row(node.numbers);
        let kind = node.code & 0xffffu;
        if kind >= RUN {
            if !field_group_is_out_of_reach(node, joint, so_far, p) {
                if kind == GROUP {
                    value_stack[depth] = so_far;
                    value_group[depth] = at;
                    depth += 1u;
                }
                at += 1u;
                continue;
            }
            at += node.extent;
        } else {
            so_far = join_value(node, joint.x, so_far, leaf_distance(kind, node.numbers, joint, p));
            at += 1u;
        }
        // Every group that ends here joins what stood before it.
        while depth > 0u {
            let group = nodes[value_group[depth - 1u]];
            if value_group[depth - 1u] + group.extent != at {
                break;
            }
            depth -= 1u;
            so_far = join_value(group, scene_row(group.numbers).x, value_stack[depth], so_far);
        }
    }
    return so_far;
}
