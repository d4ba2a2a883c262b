// The field with what the surface is made of: the same fold as `interpreted_value.wgsl`.
// Twin of `flat::twin::surface`.

#include "field/leaf.wgsl"
#include "field/joined_surface.wgsl"

var<private> surface_first: u32;
var<private> surface_end: u32;
var<private> surface_stack: array<Surface, STACK_SIZE>;
var<private> surface_group: array<u32, STACK_SIZE>;

// Chooses the component. Before any call of `surface`.
fn surface_begin(component: Component) {
    surface_first = component.first;
    surface_end = component.end;
}

fn surface(p: vec3f) -> Surface {
    var so_far = Surface(0.0, surface_first, vec3f(0.0), vec4f(0.0), vec4f(0.0));
    var depth = 0u;
    var at = surface_first;
    while at < surface_end {
        let node = nodes[at];
        let joint = scene_row(node.numbers);
        let kind = node.code & 0xffffu;
        if kind >= RUN {
            if !field_group_is_out_of_reach(node, joint, so_far.distance, p) {
                if kind == GROUP {
                    surface_stack[depth] = so_far;
                    surface_group[depth] = at;
                    depth += 1u;
                }
                at += 1u;
                continue;
            }
            at += node.extent;
        } else {
            so_far = joined_surface_leaf(at, node.code & 0xffffu, (node.code >> 16u) & 0xffu, node.code >> 24u, node.numbers, so_far, p);
            at += 1u;
        }
        while depth > 0u {
            let group = nodes[surface_group[depth - 1u]];
            if surface_group[depth - 1u] + group.extent != at {
                break;
            }
            depth -= 1u;
            so_far = joined_surface((group.code >> 16u) & 0xffu, group.code >> 24u, scene_row(group.numbers).x, surface_stack[depth], so_far);
        }
    }
    return so_far;
}
