// The field and the attributes of the surface, by the interpreter: the same fold as
// `interpreted_value.wgsl`. Counterpart of `surface` in `src/field/eval/component.rs`.

#include "field/leaf.wgsl"
#include "field/joined_surface.wgsl"
#if MODIFIERS
#include "generated/modifiers.wgsl"
#include "generated/modifier_gradients.wgsl"
#include "field/modified_surface.wgsl"
#end

var<private> surface_first: u32;
var<private> surface_end: u32;
var<private> surface_stack: array<Surface, STACK_SIZE>;
var<private> surface_group: array<u32, STACK_SIZE>;
#if MODIFIERS
// State of the active modifiers, see `interpreted_value.wgsl`.
var<private> surface_outside: array<vec3f, STACK_SIZE>;
var<private> surface_local: array<vec3f, STACK_SIZE>;
var<private> surface_copy: array<u32, STACK_SIZE>;
var<private> surface_least: array<Surface, STACK_SIZE>;
#end

// Selects the component. Call it before `surface`.
fn surface_begin(component: Component) {
    surface_first = component.first;
    // Adds 0, which no compiler can know: lavapipe recompiles a pipeline for each value of a
    // uniform that ends a loop.
    surface_end = component.end + (nodes[component.first].extent >> 31u);
}

fn surface(p: vec3f) -> Surface {
    var q = p;
    var so_far = Surface(0.0, surface_first, vec3f(0.0), mixture_none());
    var depth = 0u;
    var at = surface_first;
    while at < surface_end {
        let node = nodes[at];
        let blend_params = scene_row(node.params);
        let kind = node.code & 0xffffu;
        if kind >= MODIFIER {
            var has_content = !field_group_is_out_of_reach(node, blend_params, so_far.distance, q);
            if has_content && kind != RUN {
                surface_stack[depth] = so_far;
                surface_group[depth] = at;
#if MODIFIERS
                if kind < RUN {
                    let local = leaf_place(node.params + 2u, q);
                    let row = node.params + MODIFIER_ROWS;
                    let least = modifier_start(kind, local, row);
                    let copy = modifier_next(kind, local, 0u, least, row);
                    surface_outside[depth] = q;
                    surface_local[depth] = local;
                    surface_least[depth] = Surface(least, at, vec3f(0.0), mixture_none());
                    surface_copy[depth] = copy;
                    has_content = copy < NO_COPY;
                    if has_content {
                        q = modifier_point(kind, local, copy, row);
                    }
                }
#end
                depth += 1u;
            }
            if has_content {
                at += 1u;
                continue;
            }
            at += node.extent;
        } else {
            so_far = joined_surface_leaf(at, kind, (node.code >> 16u) & 0xffu, node.code >> 24u, node.params, so_far, q);
            at += 1u;
        }
        while depth > 0u {
            let group = nodes[surface_group[depth - 1u]];
            if surface_group[depth - 1u] + group.extent != at {
                break;
            }
#if MODIFIERS
            let modifier = group.code & 0xffffu;
            if modifier < RUN {
                let local = surface_local[depth - 1u];
                let row = group.params + MODIFIER_ROWS;
                var copy = surface_copy[depth - 1u];
                var least = surface_least[depth - 1u];
                if copy < NO_COPY {
                    let seen = surface_of_copy(modifier, copy, local, row, so_far);
                    if seen.distance < least.distance {
                        least = seen;
                    }
                    copy = modifier_next(modifier, local, copy + 1u, least.distance, row);
                }
                if copy < NO_COPY {
                    // Evaluate the content again, at another point.
                    surface_least[depth - 1u] = least;
                    surface_copy[depth - 1u] = copy;
                    q = modifier_point(modifier, local, copy, row);
                    at = surface_group[depth - 1u] + 1u;
                    break;
                }
                so_far = surface_modified(modifier, group.params, local, least);
                q = surface_outside[depth - 1u];
            }
#end
            depth -= 1u;
            so_far = joined_surface((group.code >> 16u) & 0xffu, group.code >> 24u, scene_row(group.params), surface_stack[depth], so_far);
        }
    }
    return so_far;
}
