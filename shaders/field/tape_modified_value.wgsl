// The field of a component with modifiers, by tapes: the content of a modifier has tapes in its own
// space. Counterpart of `tape_field` in `src/field/tape/field.rs`.

#include "field/leaf.wgsl"
#include "field/tape.wgsl"
#include "generated/modifiers.wgsl"

// Results before the active groups and modifiers.
var<private> value_stack: array<f32, STACK_SIZE>;
// State of the active modifiers: the tape entry, the rest of the tape around it, the point outside,
// the point in the modifier's space, the current copy, the least value so far.
var<private> value_tape_entry: array<vec2u, STACK_SIZE>;
var<private> value_tape: array<vec2u, STACK_SIZE>;
var<private> value_outside: array<vec3f, STACK_SIZE>;
var<private> value_local: array<vec3f, STACK_SIZE>;
var<private> value_copy: array<u32, STACK_SIZE>;
var<private> value_least: array<f32, STACK_SIZE>;

// A modifier during the evaluation of its copies: its rows, the point in its own space, the current
// copy, the least value of the previous copies.
struct ModifiedValue {
    kind: u32,
    row: u32,
    local: vec3f,
    copy: u32,
    least: f32,
}

// Selects the component. Call it before `field`.
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

// The modifier of a tape entry, at its first copy.
fn modified_value_begin(tape_entry: vec2u, q: vec3f) -> ModifiedValue {
    let kind = MODIFIER + (tape_entry.x & 0xffu) - MODIFIED;
    let row = tape_component.params + (tape_entry.y & 0xffffffu);
    let local = leaf_place(row + 2u, q);
    let least = modifier_start(kind, local, row + MODIFIER_ROWS);
    let copy = modifier_next(kind, local, 0u, least, row + MODIFIER_ROWS);
    return ModifiedValue(kind, row, local, copy, least);
}

// Pushes the modifier with the rest of the tape around it and the point outside.
fn modified_value_push(depth: u32, modified: ModifiedValue, tape_entry: vec2u, tape: vec2u, q: vec3f) {
    value_tape_entry[depth] = tape_entry;
    value_tape[depth] = tape;
    value_outside[depth] = q;
    value_local[depth] = modified.local;
    value_copy[depth] = modified.copy;
    value_least[depth] = modified.least;
}

// Moves the modifier on the stack to its next copy; `so_far` is the value of the current one.
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

// The point in the space of the next copy.
fn modified_value_point(modified: ModifiedValue) -> vec3f {
    return modifier_point(modified.kind, modified.local, modified.copy, modified.row + MODIFIER_ROWS);
}

// The field at `p`, relative to the component's origin; in cells without a surface, a bound of it.
fn field(p: vec3f) -> f32 {
    var q = p;
    var grid = tape_own_grid();
    var tape = vec2u(0u);
    var so_far = 0.0;
    var depth = 0u;
    // Whether the tape for `q` in `grid` is not yet looked up.
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
        // A copy of a modifier's content has been evaluated.
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
