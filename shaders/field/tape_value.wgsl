// The field of a component, by tapes. Counterpart of `tape_field` in `src/field/tape/field.rs`.

#include "field/leaf.wgsl"
#include "field/tape.wgsl"

var<private> value_stack: array<f32, STACK_SIZE>;

// Selects the component. Call it before `field`.
fn field_begin(component: Component) {
    tape_component = component;
}

// The field at `p`, relative to the component's origin; in cells without a surface, a bound of it.
fn field(p: vec3f) -> f32 {
    tape_find(tape_own_grid(), p);
    var so_far = tape_bound;
    var depth = 0u;
    for (var at = tape_range.x; at < tape_range.y; at += 1u) {
        let tape_entry = tape_word(at);
        let op = (tape_entry.x >> 8u) & 3u;
        var join = (tape_entry.x >> 10u) & 15u;
        let kernel = (tape_entry.x >> 14u) & 7u;
        let row = tape_component.params + tape_entry.y;
        let blend_params = scene_row(row);
        var before = so_far;
        if op == TAPE_LEAF {
            so_far = leaf_distance(tape_entry.x & 0xffu, row, blend_params, p);
        }
        if op == TAPE_BEGIN {
            value_stack[depth] = so_far;
            depth += 1u;
            join = JOIN_FIRST;
        }
        if op == TAPE_END {
            depth -= 1u;
            before = value_stack[depth];
        }
        if op == TAPE_NEGATE {
            so_far = -so_far;
            join = JOIN_FIRST;
        }
        so_far = select(op_join(join, before, so_far, blend_params, kernel).x, so_far, join == JOIN_FIRST);
    }
    return so_far;
}
