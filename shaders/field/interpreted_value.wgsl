// The field of a component, by the interpreter: the fold over its range of the subtree-extent
// array. Counterpart of `field` in `src/field/eval/component.rs`.

#include "field/leaf.wgsl"
#if MODIFIERS
#include "generated/modifiers.wgsl"
#end

var<private> value_first: u32;
var<private> value_end: u32;
var<private> value_stack: array<f32, STACK_SIZE>;
var<private> value_group: array<u32, STACK_SIZE>;
#if MODIFIERS
// State of the active modifiers: the point outside, the point in the modifier's space, the current
// copy, the least value so far.
var<private> value_outside: array<vec3f, STACK_SIZE>;
var<private> value_local: array<vec3f, STACK_SIZE>;
var<private> value_copy: array<u32, STACK_SIZE>;
var<private> value_least: array<f32, STACK_SIZE>;
#end

fn join_value(node: FlatNode, blend_params: vec4f, so_far: f32, value: f32) -> f32 {
    let join = (node.code >> 16u) & 0xffu;
    if join == JOIN_FIRST {
        return value;
    }
    return op_join(join, so_far, value, blend_params, node.code >> 24u).x;
}

// Selects the component. Call it before `field`.
fn field_begin(component: Component) {
    value_first = component.first;
    // Adds 0, which no compiler can know: lavapipe recompiles a pipeline for each value of a
    // uniform that ends a loop.
    value_end = component.end + (nodes[component.first].extent >> 31u);
}

// The field at `p`, relative to the component's origin.
fn field(p: vec3f) -> f32 {
    var q = p;
    var so_far = 0.0;
    var depth = 0u;
    var at = value_first;
    while at < value_end {
        let node = nodes[at];
        let blend_params = scene_row(node.params);
        let kind = node.code & 0xffffu;
        if kind >= MODIFIER {
            var has_content = !field_group_is_out_of_reach(node, blend_params, so_far, q);
            if has_content && kind != RUN {
                value_stack[depth] = so_far;
                value_group[depth] = at;
#if MODIFIERS
                if kind < RUN {
                    let local = leaf_place(node.params + 2u, q);
                    let row = node.params + MODIFIER_ROWS;
                    let least = modifier_start(kind, local, row);
                    let copy = modifier_next(kind, local, 0u, least, row);
                    value_outside[depth] = q;
                    value_local[depth] = local;
                    value_least[depth] = least;
                    value_copy[depth] = copy;
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
            so_far = join_value(node, blend_params, so_far, leaf_distance(kind, node.params, blend_params, q));
            at += 1u;
        }
        // Every group that ends here joins the result before it.
        while depth > 0u {
            let group = nodes[value_group[depth - 1u]];
            if value_group[depth - 1u] + group.extent != at {
                break;
            }
#if MODIFIERS
            let modifier = group.code & 0xffffu;
            if modifier < RUN {
                let local = value_local[depth - 1u];
                let row = group.params + MODIFIER_ROWS;
                var copy = value_copy[depth - 1u];
                var least = value_least[depth - 1u];
                if copy < NO_COPY {
                    least = min(least, so_far * modifier_scale(modifier, copy, row));
                    copy = modifier_next(modifier, local, copy + 1u, least, row);
                }
                if copy < NO_COPY {
                    // Evaluate the content again, at another point.
                    value_least[depth - 1u] = least;
                    value_copy[depth - 1u] = copy;
                    q = modifier_point(modifier, local, copy, row);
                    at = value_group[depth - 1u] + 1u;
                    break;
                }
                so_far = modifier_value(modifier, least, local, row) * scene_row(group.params + 1u).w;
                q = value_outside[depth - 1u];
            }
#end
            depth -= 1u;
            so_far = join_value(group, scene_row(group.params), value_stack[depth], so_far);
        }
    }
    return so_far;
}
