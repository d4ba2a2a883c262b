// Signed cones against the whole scene: soft shadows and occlusion. Counterpart of
// `src/field/light/shadow.rs`, which explains them.
//
// Distances count from the beginning of the cone, not from the eye.

#include "generated/value.wgsl"
#include "generated/slack.wgsl"
#include "scene/hierarchy.wgsl"

struct SceneCone {
    origin: vec3f,
    // Distance of the first evaluation, and of the end.
    near: f32,
    // Of unit length.
    direction: vec3f,
    far: f32,
    // Radius at distance 1, and the one by which the field is measured: the same but in copies.
    spread: f32,
    size: f32,
    // Least step, in meters and in radii.
    least_step: f32,
    fineness: f32,
    // Of the surface that it leaves, if the whole cone is above the tangent plane; else 0. Nothing
    // below that plane is in the way.
    above: vec3f,
}

// The march of a cone through one component after the other, in the order of the hierarchy.
struct ConeMarch {
    // The component, with entry and exit.
    visit: SceneVisit,
    // The node of the hierarchy behind that of the component.
    after: u32,
    // Next evaluation.
    t: f32,
    // Last evaluation, and the field there.
    last: vec2f,
    // Least ratio of field and radius in the component.
    ratio: f32,
    // Share of the cone that the components so far leave.
    share: f32,
    // CONE_… bits.
    state: u32,
}

// A component is being marched.
const CONE_ACTIVE: u32 = 1u;
// The spheres in it so far hold the cone.
const CONE_LIT: u32 = 2u;
// The step to `t` is longer than the field vouches for.
const CONE_WIDE: u32 = 4u;
// Nothing is certain.
const CONE_UNPROVEN: u32 = 8u;
const CONE_ENDED: u32 = 16u;
// The cone is a single ray.
const CONE_RAY: u32 = 32u;
// The component is an instancer, whose copies are marched one after the other.
const CONE_COPIES: u32 = 64u;
const CONE_KEPT: u32 = 104u;

// See the CPU's constants of these names.
const WIDE_SPREAD: f32 = 0.105;
const LEAST_RADIUS: f32 = 1e-12;
const LEAST_CLIMB: f32 = 0.2;
const MOST_CLIMB: f32 = 0.8;
const WIDE_STEP: f32 = 0.9;

fn cone_march_begin() -> ConeMarch {
    return ConeMarch(SceneVisit(0.0, 0.0, 0u), 0u, 0.0, vec2f(0.0), 0.0, 1.0, 0u);
}

// The ratio of field and radius once a cone is wholly within a solid; others are at least -1.
const PROVEN_DARK: f32 = -2.0;

// The visible share of a disc if a straight edge cuts it at `ratio` radii from its middle.
fn cone_share(ratio: f32) -> f32 {
    let s = clamp(ratio, -1.0, 1.0);
    return 0.5 + (s * sqrt(max(1.0 - s * s, 0.0)) + asin(s)) / 3.14159265;
}

// Whether two spheres around points of the axis hold the cone between these points. x: the point,
// y: the radius of the sphere.
fn cone_spheres_hold(a: vec2f, b: vec2f, spread: f32) -> bool {
    let step = b.x - a.x;
    let meet = (step * step + (a.y - b.y) * (a.y + b.y)) / max(2.0 * step, LEAST_RADIUS);
    let radius = spread * (a.x + meet);
    return a.y == NEVER || meet <= 0.0 || meet >= step || a.y * a.y - meet * meet >= radius * radius;
}

// Whether the whole cone stays outside of the half space that holds the component.
fn cone_passes_half_space(component: Component, cone: SceneCone, exit: f32) -> bool {
    let plane = component.half_space;
    let height = dot(plane.xyz, cone.origin + component.eye) + plane.w;
    let climb = dot(plane.xyz, cone.direction);
    let lowest = climb - cone.spread * sqrt(max(1.0 - climb * climb, 0.0));
    let is_known = any(plane.xyz != vec3f(0.0));
    return is_known && height >= 0.0 && (lowest >= -1e-6 || height + lowest * exit >= 0.0);
}

// The first leaf at or behind the node `after` whose bounds the cone meets, with entry and exit; the
// number of all nodes if there is none. Invalid once `scene_visits` has reached its limit. What
// order components are taken in does not matter: in that of the nodes, most of the tree is passed.
fn cone_leaf(cone: SceneCone, after: u32, interval: ptr<function, vec2f>) -> u32 {
    let ray = Ray(cone.origin, 0.0, cone.direction);
    var depth = select(0u, 1u, after < scene_limits.tree_nodes);
    hierarchy_stack[0] = 0u;
    while depth > 0u && scene_visits < scene_limits.max_visits {
        depth -= 1u;
        let index = hierarchy_stack[depth];
        let node = hierarchy[index];
        scene_visits += 1u;
        let met = hierarchy_interval(node, ray, cone.far, cone.spread);
        let range = vec2f(max(met.x, cone.near), min(met.y, cone.far));
        let half = 0.5 * (node.high - node.low);
        let height = dot(node.low + half - cone.origin, cone.above) + dot(half, abs(cone.above));
        let is_leaf = node.axis == HIERARCHY_LEAF;
        if height < 0.0 || range.x > range.y || (is_leaf && index < after) {
            continue;
        }
        if is_leaf {
            *interval = range;
            return index;
        }
        // The left child, which follows its parent, on top.
        hierarchy_stack[depth] = node.link;
        hierarchy_stack[depth + 1u] = index + 1u;
        depth += select(1u, 2u, after < node.link);
    }
    *interval = vec2f(cone.near, cone.far);
    return max(after, scene_limits.tree_nodes);
}

// Moves on to the next component. Unchanged if the limit of visits is reached.
fn cone_next(cone: SceneCone, march: ptr<function, ConeMarch>) {
    var interval: vec2f;
    let found = cone_leaf(cone, march.after, &interval);
    if scene_visits >= scene_limits.max_visits {
        return;
    }
    march.after = found + 1u;
    if found >= scene_limits.all_nodes {
        march.state |= CONE_ENDED;
        return;
    }
    march.visit = SceneVisit(interval.x, interval.y, hierarchy[found].link);
#if SCENE_COPIES
    if march.visit.component >= COPIES_LINK {
        march.state = (march.state & CONE_KEPT) | CONE_COPIES;
        return;
    }
#end
    cone_enter(march);
    if cone_passes_half_space(scene_components[march.visit.component], cone, march.visit.exit) {
        march.state &= CONE_KEPT;
    }
}

// Begins the march through what is to be visited.
fn cone_enter(march: ptr<function, ConeMarch>) {
    march.t = march.visit.entry;
    march.last = vec2f(march.t, NEVER);
    march.ratio = NEVER;
    march.state = (march.state & CONE_KEPT) | CONE_ACTIVE | CONE_LIT;
}

fn cone_plain_step(cone: SceneCone, t: f32, f: f32) -> f32 {
    return max(max(abs(f), cone.least_step), cone.fineness * cone.size * t);
}

// Takes the field at `t` into account, and moves on. `slack`: how much the field likely exceeds `f`.
fn cone_step(cone: SceneCone, march: ptr<function, ConeMarch>, f: f32, slack: f32) {
    let t = march.t;
    let last = march.last;
    let exit = march.visit.exit;
    let ratio = (f + select(0.0, slack, f > 0.0)) / max(cone.size * t, LEAST_RADIUS);
    march.ratio = max(min(march.ratio, ratio), -1.0);
    // In a stretched copy the size is that of the section on average, and the spread holds all of it.
    if f <= -max(max(cone.size, cone.spread) * t, LEAST_RADIUS) {
        march.ratio = PROVEN_DARK;
        march.state &= ~CONE_LIT;
        cone_leave(cone, march);
        return;
    }
    let holds = cone_spheres_hold(last, vec2f(t, f), cone.spread);
    if (march.state & CONE_WIDE) != 0u && !holds {
        march.state &= ~CONE_WIDE;
        march.t = min(last.x + cone_plain_step(cone, last.x, last.y), exit);
        return;
    }
    if f < cone.spread * t || !holds {
        march.state &= ~CONE_LIT;
    }
    let left = exit - t;
    let end = cone.spread * exit;
    let is_past = f > 0.0 && f * f >= left * left + end * end;
    if left <= 0.0 || is_past {
        cone_leave(cone, march);
        return;
    }
    let plain = cone_plain_step(cone, t, f);
    let climb = select(0.0, (f - last.y) / max(t - last.x, LEAST_RADIUS), t > last.x);
    let wide = WIDE_STEP * 2.0 * f / (1.0 - min(climb, MOST_CLIMB));
    let is_wide = f > 0.0 && climb > LEAST_CLIMB && wide > plain;
    march.state = (march.state & ~CONE_WIDE) | select(0u, CONE_WIDE, is_wide);
    march.last = vec2f(t, f);
    march.t = min(t + select(plain, wide, is_wide), exit);
}

#if VEILS
// Share of the light that what is being marched lets pass.
var<private> cone_veil: f32;

#end
// Ends the march through a component.
fn cone_leave(cone: SceneCone, march: ptr<function, ConeMarch>) {
    let is_lit = (march.state & CONE_LIT) != 0u;
    var is_dark = march.ratio == PROVEN_DARK;
    var share = select(cone_share(march.ratio), 1.0, is_lit);
#if VEILS
    is_dark = is_dark && cone_veil == 0.0;
    share = mix(share, 1.0, cone_veil);
#end
    let all = select(min(march.share, share), march.share * share, cone.size < WIDE_SPREAD);
    march.share = select(all, 0.0, is_dark);
    let open = (march.state & CONE_KEPT) | select(CONE_UNPROVEN, 0u, is_lit);
    march.state = select(open, CONE_ENDED | (march.state & CONE_RAY), is_dark);
}

// The share of a cone's middle ray that meshes leave.
fn scene_mesh_share(cone: SceneCone) -> f32 {
    var share = 1.0;
#if MESH_RAYS
    if mesh_rays_blocked(Ray(cone.origin, 0.0, cone.direction), cone.near, cone.far) {
        share = 0.0;
    }
#end
    return share;
}

// Whether the invocation may search the meshes once more.
fn scene_has_mesh_visits() -> bool {
    var has_room = true;
#if MESH_RAYS
    has_room = mesh_visits < MAX_MESH_VISITS / 2u;
#end
    return has_room;
}
