// The value of the scene at a point. Counterpart of `SceneEvaluator::distance` in
// `src/field/scene_eval.rs`.

#include "generated/value.wgsl"
#include "scene/hierarchy.wgsl"

struct SceneValue {
    // Never more than the distance to the nearest surface; negative inside.
    value: f32,
    // NO_COMPONENT for an empty scene.
    component: u32,
    // Whether the limits of the invocation sufficed. If not, the value is still a lower bound
    // outside.
    complete: bool,
}

// Lower bound of the distance from a point in the component's space to the half space that holds
// the component; 0 if unknown.
fn scene_half_space_bound(component: Component, p: vec3f) -> f32 {
    let plane = component.half_space;
    return max(dot(plane.xyz, p) + plane.w - 4.0 * SPACING * (length(p) + abs(plane.w)), 0.0);
}

// The value at `p`. If it is at least `within`, any lower bound that is also at least `within` may
// replace it: then the fields of farther components need no evaluation. The source has one call of
// the field.
fn scene_value(p: vec3f, within: f32) -> SceneValue {
    var nearest = SceneValue(NEVER, NO_COMPONENT, true);
    var depth = select(0u, 1u, scene_limits.tree_nodes > 0u);
    hierarchy_stack[0] = 0u;
    var unbounded = scene_limits.tree_nodes;
    while depth > 0u || unbounded < scene_limits.all_nodes {
        var index = unbounded;
        let is_in_tree = depth > 0u;
        if is_in_tree {
            depth -= 1u;
            index = hierarchy_stack[depth];
        } else {
            unbounded += 1u;
        }
        let node = hierarchy[index];
        scene_visits += 1u;
        if scene_visits >= scene_limits.max_visits {
            return SceneValue(min(nearest.value, 0.0), nearest.component, false);
        }
        var bound = select(0.0, hierarchy_distance(node, p), is_in_tree);
        if bound > 0.0 && bound >= nearest.value {
            continue;
        }
        if node.axis != HIERARCHY_LEAF {
            let left = hierarchy_distance(hierarchy[index + 1u], p);
            let right = hierarchy_distance(hierarchy[node.link], p);
            hierarchy_stack[depth] = select(index + 1u, node.link, left <= right);
            hierarchy_stack[depth + 1u] = select(node.link, index + 1u, left <= right);
            depth += 2u;
            continue;
        }
        let component = scene_components[node.link];
        let q = p + component.eye;
        bound = max(bound, scene_half_space_bound(component, q));
        if bound > 0.0 && bound >= nearest.value {
            continue;
        }
        var value = bound;
        if bound == 0.0 || bound < within {
            if scene_evaluations < scene_limits.max_evaluations {
                scene_evaluations += 1u;
                field_begin(component);
                let f = field(q);
                value = select(f, max(f, bound), bound > 0.0);
            } else {
                nearest.complete = false;
            }
        }
        if value < nearest.value {
            nearest.value = value;
            nearest.component = node.link;
        }
    }
    return nearest;
}
