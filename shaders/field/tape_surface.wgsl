// The field and the attributes of the surface, by tapes: the same fold as `tape_value.wgsl`.

#include "field/joined_surface.wgsl"
#include "field/tape.wgsl"

var<private> surface_stack: array<Surface, STACK_SIZE>;

// Selects the component. Call it before `surface`.
fn surface_begin(component: Component) {
    tape_component = component;
}

fn surface(p: vec3f) -> Surface {
    tape_find(tape_own_grid(), p);
    var so_far = Surface(tape_bound, tape_component.first, vec3f(0.0), mixture_none());
    var depth = 0u;
    for (var at = tape_range.x; at < tape_range.y; at += 1u) {
        let tape_entry = tape_word(at);
        let op = (tape_entry.x >> 8u) & 3u;
        let join = (tape_entry.x >> 10u) & 15u;
        let kernel = (tape_entry.x >> 14u) & 7u;
        let row = tape_component.params + tape_entry.y;
        if op == TAPE_LEAF {
            let entry = tape_component.first + (tape_entry.x >> 17u);
            so_far = joined_surface_leaf(entry, tape_entry.x & 0xffu, join, kernel, row, so_far, p);
        }
        if op == TAPE_BEGIN {
            surface_stack[depth] = so_far;
            depth += 1u;
        }
        if op == TAPE_END {
            depth -= 1u;
            so_far = joined_surface(join, kernel, scene_row(row), surface_stack[depth], so_far);
        }
        if op == TAPE_NEGATE {
            so_far.distance = -so_far.distance;
            so_far.gradient = -so_far.gradient;
        }
    }
    return so_far;
}
