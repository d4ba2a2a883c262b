// The components that may occlude a point.

#include "scene/hierarchy.wgsl"

// Leaf at or behind the node `after` that a sphere of this radius meets and that is not below the
// tangent plane: nothing there occludes. The number of all nodes if there is none.
fn scene_occluder(p: vec3f, normal: vec3f, radius: f32, after: u32) -> u32 {
    var depth = select(0u, 1u, after < scene_limits.tree_nodes);
    hierarchy_stack[0] = 0u;
    while depth > 0u && scene_visits < scene_limits.max_visits {
        depth -= 1u;
        let index = hierarchy_stack[depth];
        let node = hierarchy[index];
        scene_visits += 1u;
        let height = dot(0.5 * (node.low + node.high) - p, normal) + dot(0.5 * (node.high - node.low), abs(normal));
        let is_leaf = node.axis == HIERARCHY_LEAF;
        if height <= 0.0 || hierarchy_distance(node, p) > radius || (is_leaf && index < after) {
            continue;
        }
        if is_leaf {
            return index;
        }
        hierarchy_stack[depth] = node.link;
        hierarchy_stack[depth + 1u] = index + 1u;
        depth += select(1u, 2u, after < node.link);
    }
    return max(after, scene_limits.tree_nodes);
}
