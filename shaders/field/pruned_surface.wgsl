// The field by pruned lists, with what the surface is made of: the same fold as `pruned_value.wgsl`.

#include "field/joined_surface.wgsl"
#include "field/pruned.wgsl"

var<private> surface_stack: array<Surface, STACK_SIZE>;

// Chooses the component. Before any call of `surface`.
fn surface_begin(component: Component) {
    pruned_component = component;
}

fn surface(p: vec3f) -> Surface {
    pruned_find(pruned_own_grid(), p);
    var so_far = Surface(pruned_bound, pruned_component.first, vec3f(0.0), vec4f(0.0), vec4f(0.0));
    var depth = 0u;
    for (var at = pruned_list.x; at < pruned_list.y; at += 1u) {
        let token = pruned_word(at);
        let op = (token.x >> 8u) & 3u;
        let join = (token.x >> 10u) & 15u;
        let kernel = (token.x >> 14u) & 7u;
        let row = pruned_component.numbers + token.y;
        if op == TOKEN_LEAF {
            let entry = pruned_component.first + (token.x >> 17u);
            so_far = joined_surface_leaf(entry, token.x & 0xffu, join, kernel, row, so_far, p);
        }
        if op == TOKEN_BEGIN {
            surface_stack[depth] = so_far;
            depth += 1u;
        }
        if op == TOKEN_END {
            depth -= 1u;
            so_far = joined_surface(join, kernel, scene_row(row), surface_stack[depth], so_far);
        }
        if op == TOKEN_NEGATE {
            so_far.distance = -so_far.distance;
            so_far.gradient = -so_far.gradient;
        }
    }
    return so_far;
}
