// The field of a component by tapes where it holds modifiers: what a modifier holds has tapes in its own space.
// Counterpart of `flat::tape::tape_field`.

#include "field/leaf.wgsl"
#include "field/tape.wgsl"
#include "generated/modifiers.wgsl"

// Of groups and modifiers under way: what stood before.
var<private> value_stack: array<f32, STACK_SIZE>;
// Of modifiers: the tape entry, the rest of the tape that it stands in, the point outside, the point in its own space, the copy
// that is evaluated, the least so far.
var<private> value_tape_entry: array<vec2u, STACK_SIZE>;
var<private> value_tape: array<vec2u, STACK_SIZE>;
var<private> value_outside: array<vec3f, STACK_SIZE>;
var<private> value_local: array<vec3f, STACK_SIZE>;
var<private> value_copy: array<u32, STACK_SIZE>;
var<private> value_least: array<f32, STACK_SIZE>;

// A modifier while its copies are evaluated: its rows, the point in its own space, the copy, the least of those before.
struct ModifiedValue {
    kind: u32,
    row: u32,
    local: vec3f,
    copy: u32,
    least: f32,
}

// Chooses the component. Before any call of `field`.
fn field_begin(component: Component) {
    tape_component = component;
}

fn joined_value(tape_entry: vec2u, before: f32, value: f32) -> f32 {
    let join = (tape_entry.x >> 10u) & 15u;
    if join == JOIN_FIRST {
        return value;
    }
    let blend_params = scene_row(tape_component.params + (tape_entry.y & 0xffffffu));
    return op_join(join, before, value, blend_params, (tape_entry.x >> 14u) & 7u).x;
}

// The modifier that a tape entry stands for, at its first copy.
fn modified_value_begin(tape_entry: vec2u, q: vec3f) -> ModifiedValue {
    let kind = MODIFIER + (tape_entry.x & 0xffu) - MODIFIED;
    let row = tape_component.params + (tape_entry.y & 0xffffffu);
    let local = leaf_place(row + 2u, q);
    let least = modifier_start(kind, local, row + MODIFIER_ROWS);
    let copy = modifier_next(kind, local, 0u, least, row + MODIFIER_ROWS);
    return ModifiedValue(kind, row, local, copy, least);
}

// Puts it on the stack, with the rest of the tape that it stands in and the point outside.
fn modified_value_push(depth: u32, modified: ModifiedValue, tape_entry: vec2u, tape: vec2u, q: vec3f) {
    value_tape_entry[depth] = tape_entry;
    value_tape[depth] = tape;
    value_outside[depth] = q;
    value_local[depth] = modified.local;
    value_copy[depth] = modified.copy;
    value_least[depth] = modified.least;
}

// The modifier on the stack at its next copy, after the one under way has been evaluated to `so_far`.
fn modified_value_next(at: u32, tape_entry: vec2u, so_far: f32) -> ModifiedValue {
    let kind = MODIFIER + (tape_entry.x & 0xffu) - MODIFIED;
    let row = tape_component.params + (tape_entry.y & 0xffffffu);
    let local = value_local[at];
    var copy = value_copy[at];
    var least = value_least[at];
    if copy < NO_COPY {
        least = min(least, so_far * modifier_scale(kind, copy, row + MODIFIER_ROWS));
        copy = modifier_next(kind, local, copy + 1u, least, row + MODIFIER_ROWS);
    }
    return ModifiedValue(kind, row, local, copy, least);
}

// The point in the copy that is evaluated next.
fn modified_value_point(modified: ModifiedValue) -> vec3f {
    return modifier_point(modified.kind, modified.local, modified.copy, modified.row + MODIFIER_ROWS);
}

// The field at `p`, relative to the component's origin; a bound of it in cells where no surface is.
fn field(p: vec3f) -> f32 {
    var q = p;
    var grid = tape_own_grid();
    var tape = vec2u(0u);
    var so_far = 0.0;
    var depth = 0u;
    // Whether the tape for `q` in `grid` is still to be found.
    var is_new = true;
    loop {
        if is_new {
            tape_find(grid, q);
            tape = tape_range;
            so_far = tape_bound;
            is_new = false;
        }
        while tape.x < tape.y {
            let tape_entry = tape_word(tape.x);
            tape.x += 1u;
            let op = (tape_entry.x >> 8u) & 3u;
            let shape = tape_entry.x & 0xffu;
            let row = tape_component.params + (tape_entry.y & 0xffffffu);
            var before = so_far;
            let is_modified = op == TAPE_LEAF && shape >= MODIFIED;
            var joins = op == TAPE_LEAF || op == TAPE_END;
            if op == TAPE_LEAF && !is_modified {
                so_far = leaf_distance(shape, row, scene_row(row), q);
            }
            if is_modified {
                let modified = modified_value_begin(tape_entry, q);
                modified_value_push(depth, modified, tape_entry, tape, q);
                is_new = modified.copy < NO_COPY;
                if is_new {
                    q = modified_value_point(modified);
                    grid = tape_modifier_grid(tape_entry.y >> 24u);
                }
                tape = vec2u(0u);
                joins = false;
            }
            if op == TAPE_BEGIN || is_modified {
                value_stack[depth] = so_far;
                depth += 1u;
            }
            if op == TAPE_END {
                depth -= 1u;
                before = value_stack[depth];
            }
            if op == TAPE_NEGATE {
                so_far = -so_far;
            }
            so_far = select(so_far, joined_value(tape_entry, before, so_far), joins);
        }
        if is_new {
            continue;
        }
        if depth == 0u {
            break;
        }
        // What a modifier holds has been evaluated at one point.
        let tape_entry = value_tape_entry[depth - 1u];
        let modified = modified_value_next(depth - 1u, tape_entry, so_far);
        is_new = modified.copy < NO_COPY;
        if is_new {
            value_least[depth - 1u] = modified.least;
            value_copy[depth - 1u] = modified.copy;
            q = modified_value_point(modified);
            grid = tape_modifier_grid(tape_entry.y >> 24u);
            continue;
        }
        depth -= 1u;
        let row = modified.row;
        let value = modifier_value(modified.kind, modified.least, modified.local, row + MODIFIER_ROWS) * scene_row(row + 1u).w;
        so_far = joined_value(tape_entry, value_stack[depth], value);
        q = value_outside[depth];
        tape = value_tape[depth];
    }
    return so_far;
}
