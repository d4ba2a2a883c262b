// The field of a component by pruned lists. Twin of `flat::prune::pruned_field`.

#include "field/leaf.wgsl"
#include "field/pruned.wgsl"

var<private> value_stack: array<f32, STACK_SIZE>;

// Chooses the component. Before any call of `field`.
fn field_begin(component: Component) {
    pruned_component = component;
}

// The field at `p`, relative to the component's origin; a bound of it in cells where no surface is.
fn field(p: vec3f) -> f32 {
    pruned_find(pruned_own_grid(), p);
    var so_far = pruned_bound;
    var depth = 0u;
    for (var at = pruned_list.x; at < pruned_list.y; at += 1u) {
        let token = pruned_word(at);
        let op = (token.x >> 8u) & 3u;
        var join = (token.x >> 10u) & 15u;
        let kernel = (token.x >> 14u) & 7u;
        let row = pruned_component.numbers + token.y;
        let joint = scene_row(row);
        var before = so_far;
        if op == TOKEN_LEAF {
            so_far = leaf_distance(token.x & 0xffu, row, joint, p);
        }
        if op == TOKEN_BEGIN {
            value_stack[depth] = so_far;
            depth += 1u;
            join = JOIN_FIRST;
        }
        if op == TOKEN_END {
            depth -= 1u;
            before = value_stack[depth];
        }
        if op == TOKEN_NEGATE {
            so_far = -so_far;
            join = JOIN_FIRST;
        }
        so_far = select(op_join(join, before, so_far, joint, kernel).x, so_far, join == JOIN_FIRST);
    }
    return so_far;
}
