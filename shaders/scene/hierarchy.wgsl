// The hierarchy over the bounds of all components: finds those near a point or ray. Counterpart of
// `src/field/hierarchy.rs`; `src/render/resources/hierarchy.rs` binds it.
//
// Positions in `shaders/scene` are relative to the origin of the query, a point that the CPU
// chooses. Here a component's `eye` is that origin in the component's space: `p + component.eye` is
// the position of a point in the component.

#include "common/bounds.wgsl"

struct HierarchyNode {
    low: vec3f,
    // Leaf: the component, or an instancer with COPIES_LINK. Inner node: its right child; the left one follows it.
    link: u32,
    high: vec3f,
    // Axis that separates its children, the left one lower; HIERARCHY_LEAF for a leaf.
    axis: u32,
}

struct SceneLimits {
    // Nodes of the tree. Leaves for components without bounds follow them.
    tree_nodes: u32,
    all_nodes: u32,
    // Limits of one invocation in a dispatch: evaluations of fields, and visits of nodes.
    max_evaluations: u32,
    max_visits: u32,
}

const HIERARCHY_LEAF: u32 = 3u;
// In the link of a leaf for all copies of an instancer. Only passes with SCENE_COPIES meet such leaves.
const COPIES_LINK: u32 = 0x80000000u;
const NO_COMPONENT: u32 = 0xffffffffu;
// `MAX_HIERARCHY_DEPTH` on the CPU plus two.
const HIERARCHY_STACK: u32 = 32u;

@group(3) @binding(0) var<storage, read> hierarchy: array<HierarchyNode>;
@group(3) @binding(1) var<storage, read> scene_components: array<Component>;
@group(3) @binding(2) var<uniform> scene_limits: SceneLimits;

// Work of this invocation. Never reset: the loop limit of lavapipe counts over a whole invocation.
var<private> scene_evaluations: u32;
var<private> scene_visits: u32;
var<private> hierarchy_stack: array<u32, HIERARCHY_STACK>;

// Distance from a point to the node's box; 0 inside.
fn hierarchy_distance(node: HierarchyNode, p: vec3f) -> f32 {
    return length(max(max(node.low - p, p - node.high), vec3f(0.0)));
}

// Entry and exit of the cone around the ray through the node's box, up to `far`. The cone has the
// radius `spread` at distance 1; 0 for the ray alone.
fn hierarchy_interval(node: HierarchyNode, ray: Ray, far: f32, spread: f32) -> vec2f {
    // A zero component of the direction would yield 0 times infinity.
    let d = select(ray.direction, vec3f(1e-9), abs(ray.direction) < vec3f(1e-9));
    // Nothing of the box is farther along the ray than `reach`.
    let center = 0.5 * (node.low + node.high) - ray.origin;
    let reach = dot(center, ray.direction) + dot(0.5 * (node.high - node.low), abs(ray.direction));
    let by = spread * clamp(reach, 0.0, far - ray.skipped);
    let a = (node.low - by - ray.origin) / d;
    let b = (node.high + by - ray.origin) / d;
    let near = min(a, b);
    let exit = max(a, b);
    return vec2f(max(max(near.x, near.y), near.z), min(min(exit.x, exit.y), exit.z)) + ray.skipped;
}

// A component, with entry and exit of a ray through its bounds.
struct SceneVisit {
    entry: f32,
    exit: f32,
    component: u32,
}

// The component after `after` whose bounds the ray enters first, between `near` and `far`: in the
// order of entry, then of index. Its index is NO_COMPONENT if there is none. Repeated calls, each
// with the last result, name all components with bounds on a ray one by one, without further state.
// Invalid once `scene_visits` has reached its limit.
fn scene_next(ray: Ray, near: f32, far: f32, after: SceneVisit) -> SceneVisit {
    var first = SceneVisit(far, far, NO_COMPONENT);
    var depth = select(0u, 1u, scene_limits.tree_nodes > 0u);
    hierarchy_stack[0] = 0u;
    while depth > 0u && scene_visits < scene_limits.max_visits {
        depth -= 1u;
        let index = hierarchy_stack[depth];
        let node = hierarchy[index];
        scene_visits += 1u;
        let interval = hierarchy_interval(node, ray, far, 0.0);
        let entry = max(interval.x, near);
        let exit = min(interval.y, far);
        // The entry of a leaf is no later than its exit.
        if entry > exit || entry > first.entry || exit < after.entry {
            continue;
        }
        if node.axis == HIERARCHY_LEAF {
            let is_after = entry > after.entry || (entry == after.entry && node.link > after.component);
            let is_before = entry < first.entry || (entry == first.entry && node.link < first.component);
            if is_after && is_before {
                first = SceneVisit(entry, exit, node.link);
            }
            continue;
        }
        // The nearer child on top.
        let climb = select(ray.direction.z, ray.direction.y, node.axis == 1u);
        let is_left_first = select(climb, ray.direction.x, node.axis == 0u) >= 0.0;
        hierarchy_stack[depth] = select(index + 1u, node.link, is_left_first);
        hierarchy_stack[depth + 1u] = select(node.link, index + 1u, is_left_first);
        depth += 2u;
    }
    return first;
}
