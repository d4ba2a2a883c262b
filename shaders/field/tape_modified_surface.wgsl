// The field and the attributes of the surface of a component with modifiers, by tapes: the same
// fold as `tape_modified_value.wgsl`.

#include "field/joined_surface.wgsl"
#include "field/tape.wgsl"
#include "generated/modifiers.wgsl"
#include "generated/modifier_gradients.wgsl"
#include "field/modified_surface.wgsl"

// State of the active groups and modifiers, see `tape_modified_value.wgsl`.
var<private> surface_stack: array<Surface, STACK_SIZE>;
var<private> surface_tape_entry: array<vec2u, STACK_SIZE>;
var<private> surface_tape: array<vec2u, STACK_SIZE>;
var<private> surface_outside: array<vec3f, STACK_SIZE>;
var<private> surface_local: array<vec3f, STACK_SIZE>;
var<private> surface_copy: array<u32, STACK_SIZE>;
var<private> surface_least: array<Surface, STACK_SIZE>;

// A modifier during the evaluation of its copies, see `ModifiedValue`.
struct ModifiedSurface {
    kind: u32,
    row: u32,
    local: vec3f,
    copy: u32,
    least: Surface,
}

// Selects the component. Call it before `surface`.
fn surface_begin(component: Component) {
    tape_component = component;
}

fn surface_joined(tape_entry: vec2u, before: Surface, so_far: Surface) -> Surface {
    let blend_params = scene_row(tape_component.params + (tape_entry.y & 0xffffffu));
    return joined_surface((tape_entry.x >> 10u) & 15u, (tape_entry.x >> 14u) & 7u, blend_params, before, so_far);
}

fn surface_at(distance: f32) -> Surface {
    return Surface(distance, tape_component.first, vec3f(0.0), mixture_none());
}

// The modifier of a tape entry, at its first copy.
fn modified_surface_begin(tape_entry: vec2u, q: vec3f) -> ModifiedSurface {
    let kind = MODIFIER + (tape_entry.x & 0xffu) - MODIFIED;
    let row = tape_component.params + (tape_entry.y & 0xffffffu);
    let local = leaf_place(row + 2u, q);
    let least = modifier_start(kind, local, row + MODIFIER_ROWS);
    let copy = modifier_next(kind, local, 0u, least, row + MODIFIER_ROWS);
    return ModifiedSurface(kind, row, local, copy, surface_at(least));
}

// Pushes the modifier with the rest of the tape around it and the point outside.
fn modified_surface_push(depth: u32, modified: ModifiedSurface, tape_entry: vec2u, tape: vec2u, q: vec3f) {
    surface_tape_entry[depth] = tape_entry;
    surface_tape[depth] = tape;
    surface_outside[depth] = q;
    surface_local[depth] = modified.local;
    surface_copy[depth] = modified.copy;
    surface_least[depth] = modified.least;
}

// Moves the modifier on the stack to its next copy; `so_far` is the value of the current one.
fn modified_surface_next(at: u32, tape_entry: vec2u, so_far: Surface) -> ModifiedSurface {
    let kind = MODIFIER + (tape_entry.x & 0xffu) - MODIFIED;
    let row = tape_component.params + (tape_entry.y & 0xffffffu);
    let local = surface_local[at];
    var copy = surface_copy[at];
    var least = surface_least[at];
    if copy < NO_COPY {
        let seen = surface_of_copy(kind, copy, local, row + MODIFIER_ROWS, so_far);
        if seen.distance < least.distance {
            least = seen;
        }
        copy = modifier_next(kind, local, copy + 1u, least.distance, row + MODIFIER_ROWS);
    }
    return ModifiedSurface(kind, row, local, copy, least);
}

// The point in the space of the next copy.
fn modified_surface_point(modified: ModifiedSurface) -> vec3f {
    return modifier_point(modified.kind, modified.local, modified.copy, modified.row + MODIFIER_ROWS);
}

fn surface(p: vec3f) -> Surface {
    var q = p;
    var grid = tape_own_grid();
    var tape = vec2u(0u);
    var so_far = surface_at(0.0);
    var depth = 0u;
    var is_new = true;
    loop {
        if is_new {
            tape_find(grid, q);
            tape = tape_range;
            so_far = surface_at(tape_bound);
            is_new = false;
        }
        while tape.x < tape.y {
            let tape_entry = tape_word(tape.x);
            tape.x += 1u;
            let op = (tape_entry.x >> 8u) & 3u;
            let shape = tape_entry.x & 0xffu;
            let row = tape_component.params + (tape_entry.y & 0xffffffu);
            let is_modified = op == TAPE_LEAF && shape >= MODIFIED;
            if op == TAPE_LEAF && !is_modified {
                let entry = tape_component.first + (tape_entry.x >> 17u);
                so_far = joined_surface_leaf(entry, shape, (tape_entry.x >> 10u) & 15u, (tape_entry.x >> 14u) & 7u, row, so_far, q);
            }
            if is_modified {
                let modified = modified_surface_begin(tape_entry, q);
                modified_surface_push(depth, modified, tape_entry, tape, q);
                is_new = modified.copy < NO_COPY;
                if is_new {
                    q = modified_surface_point(modified);
                    grid = tape_modifier_grid(tape_entry.y >> 24u);
                }
                tape = vec2u(0u);
            }
            if op == TAPE_BEGIN || is_modified {
                surface_stack[depth] = so_far;
                depth += 1u;
            }
            if op == TAPE_END {
                depth -= 1u;
                so_far = surface_joined(tape_entry, surface_stack[depth], so_far);
            }
            if op == TAPE_NEGATE {
                so_far.distance = -so_far.distance;
                so_far.gradient = -so_far.gradient;
            }
        }
        if is_new {
            continue;
        }
        if depth == 0u {
            break;
        }
        // A copy of a modifier's content has been evaluated.
        let tape_entry = surface_tape_entry[depth - 1u];
        let modified = modified_surface_next(depth - 1u, tape_entry, so_far);
        is_new = modified.copy < NO_COPY;
        if is_new {
            surface_least[depth - 1u] = modified.least;
            surface_copy[depth - 1u] = modified.copy;
            q = modified_surface_point(modified);
            grid = tape_modifier_grid(tape_entry.y >> 24u);
            continue;
        }
        depth -= 1u;
        so_far = surface_joined(tape_entry, surface_stack[depth], surface_modified(modified.kind, modified.row, modified.local, modified.least));
        q = surface_outside[depth];
        tape = surface_tape[depth];
    }
    return so_far;
}
