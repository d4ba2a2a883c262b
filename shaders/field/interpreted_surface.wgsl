// The field with what the surface is made of: the same fold as `interpreted_value.wgsl`.
// Twin of `flat::twin::surface`.

#include "field/leaf.wgsl"
#include "field/surface.wgsl"
#include "generated/gradients.wgsl"

var<private> surface_first: u32;
var<private> surface_end: u32;
var<private> surface_stack: array<Surface, STACK_SIZE>;
var<private> surface_group: array<u32, STACK_SIZE>;

// Joins a group that has ended; `so_far` is its own value.
fn join_surface(node: FlatNode, support: f32, before: Surface, so_far: Surface) -> Surface {
    let join = (node.code >> 16u) & 0xffu;
    if join == JOIN_FIRST {
        return so_far;
    }
    let joined = op_join(join, before.distance, so_far.distance, support, node.code >> 24u);
    let w = joined.y;
    return Surface(
        joined.x,
        select(before.leaf, so_far.leaf, w > 0.5),
        before.gradient * (1.0 - w) + so_far.gradient * select(w, -w, join == JOIN_DIFFERENCE),
        mix(before.diffuse, so_far.diffuse, w),
        mix(before.emission, so_far.emission, w),
    );
}

// Joins the leaf `at`. Gradient and material are looked up only where the surface follows the leaf.
fn join_surface_leaf(at: u32, node: FlatNode, joint: vec4f, before: Surface, p: vec3f) -> Surface {
    let join = (node.code >> 16u) & 0xffu;
    let distance = leaf_distance(node, joint, p);
    var joined = vec2f(distance, 1.0);
    if join != JOIN_FIRST {
        joined = op_join(join, before.distance, distance, joint.x, node.code >> 24u);
    }
    let w = joined.y;
    var so_far = before;
    so_far.distance = joined.x;
    so_far.leaf = select(before.leaf, at, w > 0.5);
    // A loop of at most one round: lavapipe executes the body of every `if`.
    var follows = w > 0.0;
    while follows {
        let m = materials[node.material];
        let gradient = leaf_gradient(node, joint, p) * select(w, -w, join == JOIN_DIFFERENCE);
        so_far.gradient = before.gradient * (1.0 - w) + gradient;
        so_far.diffuse = mix(before.diffuse, vec4f(m.albedo, m.specular), w);
        so_far.emission = mix(before.emission, vec4f(m.emission, m.shininess), w);
        follows = so_far.distance < -1e37;
    }
    return so_far;
}

// The derivatives of a leaf's distance along the component's axes.
fn leaf_gradient(node: FlatNode, joint: vec4f, p: vec3f) -> vec3f {
    let x = numbers[node.numbers + 1u];
    let y = numbers[node.numbers + 2u];
    let z = numbers[node.numbers + 3u];
    let local = vec3f(dot(x.xyz, p) + x.w, dot(y.xyz, p) + y.w, dot(z.xyz, p) + z.w);
    let a = numbers[node.numbers + LEAF_ROWS];
    let b = numbers[node.numbers + LEAF_ROWS + 1u];
    let d = shape_gradient(node.code & 0xffffu, local, a, b) * joint.y;
    return x.xyz * d.x + y.xyz * d.y + z.xyz * d.z;
}

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
        let joint = numbers[node.numbers];
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
            so_far = join_surface_leaf(at, node, joint, so_far, p);
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
