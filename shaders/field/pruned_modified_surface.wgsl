// The field by pruned lists where a component holds modifiers, with what the surface is made of: the same fold as
// `pruned_modified_value.wgsl`.

#include "field/joined_surface.wgsl"
#include "field/pruned.wgsl"
#include "generated/modifiers.wgsl"
#include "generated/modifier_gradients.wgsl"
#include "field/modified_surface.wgsl"

// Of groups and modifiers under way, see `pruned_modified_value.wgsl`.
var<private> surface_stack: array<Surface, STACK_SIZE>;
var<private> surface_token: array<vec2u, STACK_SIZE>;
var<private> surface_list: array<vec2u, STACK_SIZE>;
var<private> surface_outside: array<vec3f, STACK_SIZE>;
var<private> surface_local: array<vec3f, STACK_SIZE>;
var<private> surface_copy: array<u32, STACK_SIZE>;
var<private> surface_least: array<Surface, STACK_SIZE>;

// Chooses the component. Before any call of `surface`.
fn surface_begin(component: Component) {
    pruned_component = component;
}

fn surface_joined(token: vec2u, before: Surface, so_far: Surface) -> Surface {
    let joint = scene_row(pruned_component.numbers + (token.y & 0xffffffu));
    return joined_surface((token.x >> 10u) & 15u, (token.x >> 14u) & 7u, joint, before, so_far);
}

fn surface_at(distance: f32) -> Surface {
    return Surface(distance, pruned_component.first, vec3f(0.0), vec4f(0.0), vec4f(0.0));
}

fn surface(p: vec3f) -> Surface {
    var q = p;
    var grid = pruned_own_grid();
    var list = vec2u(0u);
    var so_far = surface_at(0.0);
    var depth = 0u;
    var is_new = true;
    loop {
        if is_new {
            pruned_find(grid, q);
            list = pruned_list;
            so_far = surface_at(pruned_bound);
            is_new = false;
        }
        while list.x < list.y {
            let token = pruned_word(list.x);
            list.x += 1u;
            let op = (token.x >> 8u) & 3u;
            let shape = token.x & 0xffu;
            let row = pruned_component.numbers + (token.y & 0xffffffu);
            let is_modified = op == TOKEN_LEAF && shape >= MODIFIED;
            if op == TOKEN_LEAF && !is_modified {
                let entry = pruned_component.first + (token.x >> 17u);
                so_far = joined_surface_leaf(entry, shape, (token.x >> 10u) & 15u, (token.x >> 14u) & 7u, row, so_far, q);
            }
            if is_modified {
                let kind = MODIFIER + shape - MODIFIED;
                let local = leaf_place(row + 2u, q);
                let least = modifier_start(kind, local, row + MODIFIER_ROWS);
                let copy = modifier_next(kind, local, 0u, least, row + MODIFIER_ROWS);
                surface_token[depth] = token;
                surface_list[depth] = list;
                surface_outside[depth] = q;
                surface_local[depth] = local;
                surface_copy[depth] = copy;
                surface_least[depth] = surface_at(least);
                is_new = copy < NO_COPY;
                if is_new {
                    q = modifier_point(kind, local, copy, row + MODIFIER_ROWS);
                    grid = pruned_content_grid(token.y >> 24u);
                }
                list = vec2u(0u);
            }
            if op == TOKEN_BEGIN || is_modified {
                surface_stack[depth] = so_far;
                depth += 1u;
            }
            if op == TOKEN_END {
                depth -= 1u;
                so_far = surface_joined(token, surface_stack[depth], so_far);
            }
            if op == TOKEN_NEGATE {
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
        // What a modifier holds has been evaluated at one point.
        let token = surface_token[depth - 1u];
        let kind = MODIFIER + (token.x & 0xffu) - MODIFIED;
        let row = pruned_component.numbers + (token.y & 0xffffffu);
        let local = surface_local[depth - 1u];
        var copy = surface_copy[depth - 1u];
        var least = surface_least[depth - 1u];
        if copy < NO_COPY {
            let seen = surface_of_copy(kind, copy, local, row + MODIFIER_ROWS, so_far);
            if seen.distance < least.distance {
                least = seen;
            }
            copy = modifier_next(kind, local, copy + 1u, least.distance, row + MODIFIER_ROWS);
        }
        is_new = copy < NO_COPY;
        if is_new {
            surface_least[depth - 1u] = least;
            surface_copy[depth - 1u] = copy;
            q = modifier_point(kind, local, copy, row + MODIFIER_ROWS);
            grid = pruned_content_grid(token.y >> 24u);
            continue;
        }
        depth -= 1u;
        so_far = surface_joined(token, surface_stack[depth], surface_modified(kind, row, local, least));
        q = surface_outside[depth];
        list = surface_list[depth];
    }
    return so_far;
}
