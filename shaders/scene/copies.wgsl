// Copies in the way of cones: the walk through an instancer, and the space of the copy that a cone is
// in. Counterpart of `CopyRay` in `src/field/copies/trace.rs`. Only in scenes with instancers.

#include "copy/around.wgsl"

// What a cone, or a point, has found among the copies of an instancer.
struct SceneCopies {
    // Whether a point is among the copies of an instancer; for cones their state tells it.
    is_in: bool,
    // Whether the walk has begun. If not, w tells whether and how it goes on, see `copy_walk_go_on`.
    walks: bool,
    left_at: vec4i,
    // Gradient of the height above the tangent plane of the receiver, in the instancer's space; 0 if
    // what is below counts, too.
    above: vec3f,
    // Of the copy: the component of its type, and directions there from those of the world.
    component: u32,
    space: mat3x3f,
    // A point there, and its distance from the beginning of the cone, there.
    origin: vec3f,
    skipped: f32,
    // Factors on lengths: at right angles to a surface that is parallel to the receiver.
    factor: f32,
}

// A cone that is more than this times as wide along one axis as along another is widened for proofs.
const COPIES_ROUND: f32 = 1.0001;
// The most that the radius of a widened cone grows by per distance: as an angle, sine and tangent.
const COPIES_WIDEST: f32 = 0.99;
// Copies that leave less of a light count as leaving nothing: half of what a byte resolves.
const COPIES_LEAST_SHARE: f32 = 0.002;

fn copies_begin() -> SceneCopies {
    return SceneCopies(false, false, vec4i(0), vec3f(0.0), 0u, mat3x3f(), vec3f(0.0), 0.0, 1.0);
}

// The gradient in the instancer's space of a height in the world whose gradient is `g`.
fn copies_gradient(g: vec3f) -> vec3f {
    let x = instancer.local_x.xyz;
    let y = instancer.local_y.xyz;
    let z = instancer.local_z.xyz;
    let side = cross(y, z);
    return vec3f(dot(side, g), dot(cross(z, x), g), dot(cross(x, y), g)) / dot(x, side);
}

// Enters the space of a copy. False if nothing of it is above the tangent plane through `base`, a
// point of the instancer's space, or if there is no component.
fn copies_enter(copies: ptr<function, SceneCopies>, copy: Copy, base: vec3f) -> bool {
    let sphere = copy_sphere(copy);
    let above = (*copies).above;
    (*copies).component = instancer.components[copy.kind / 4u][copy.kind % 4u];
    let x = copy_local_direction(copy, vec3f(instancer.local_x.x, instancer.local_y.x, instancer.local_z.x));
    let y = copy_local_direction(copy, vec3f(instancer.local_x.y, instancer.local_y.y, instancer.local_z.y));
    let z = copy_local_direction(copy, vec3f(instancer.local_x.z, instancer.local_y.z, instancer.local_z.z));
    (*copies).space = mat3x3f(x, y, z);
    let across = copy.scale * quaternion_rotated(vec4f(-copy.rotation.xyz, copy.rotation.w), above);
    (*copies).factor = inverseSqrt(max(dot(across, across), 1e-30));
    return dot(above, sphere.xyz - base) + length(above) * sphere.w >= 0.0 && (*copies).component != NO_COMPONENT;
}

// Cells that the invocation may still look at; at least one, so that each dispatch gets on.
fn copies_budget() -> u32 {
    return (max(scene_limits.max_visits, scene_visits) - scene_visits) / instancer.cell_visits + 1u;
}

// Counts the cells that a walk has looked at, and ends the invocation with an exhausted walk.
fn copies_count(walk: ptr<function, CopyWalk>, budget: u32) {
    scene_visits += (budget - (*walk).budget + 1u) * instancer.cell_visits;
    if (*walk).exhausted {
        scene_visits = max(scene_visits, scene_limits.max_visits);
    }
}

// Leaves a cone to the next dispatch.
fn copies_leave(march: ptr<function, ConeMarch>, copies: ptr<function, SceneCopies>, walk: ptr<function, CopyWalk>) {
    let is_between = ((*march).state & (CONE_COPIES | CONE_ACTIVE)) == CONE_COPIES && (*copies).walks;
    if is_between && copy_walk_is_over(walk) {
        (*march).state &= ~CONE_COPIES;
    } else if is_between {
        (*copies).left_at = copy_walk_left(walk);
    }
}

// Moves a cone on to the next copy, or into the one in which another dispatch has left it. `inner` is
// the cone in its space.
fn copies_next(cone: SceneCone, march: ptr<function, ConeMarch>, copies: ptr<function, SceneCopies>, walk: ptr<function, CopyWalk>, inner: ptr<function, SceneCone>) {
    instancer_at = (*march).visit.component & ~COPIES_LINK;
    let resumes = (*march).state & CONE_ACTIVE;
    if !(*copies).walks {
        let origin = instancer_local_point(cone.origin);
        let direction = instancer_local_direction(cone.direction);
        *walk = copy_walk_begin(origin, direction, cone.near, cone.far, cone.spread * instancer.most_factor, 0u);
        if (*copies).left_at.w != 0 {
            copy_walk_go_on(walk, (*copies).left_at, cone.far);
        }
        (*copies).walks = true;
        (*copies).above = copies_gradient(cone.above);
    }
    let budget = copies_budget();
    (*walk).budget = budget;
    (*walk).exhausted = false;
    var found: CopyVisit;
    let is_met = (*march).share >= COPIES_LEAST_SHARE && copy_walk_next(walk, COPY_OF_ANY, cone.far, &found);
    copies_count(walk, budget);
    (*march).state &= ~CONE_ACTIVE;
    if !is_met {
        let ends = select(0u, CONE_ENDED, (*march).share < COPIES_LEAST_SHARE);
        let left = select(CONE_COPIES, 0u, (*walk).exhausted);
        (*march).state = ((*march).state & ~left) | ends;
        if !(*walk).exhausted {
            *copies = copies_begin();
        }
        return;
    }
    let is_same = resumes != 0u && all(found.copy.place == (*copies).left_at.xyz);
    (*copies).left_at = vec4i(found.copy.place, WALK_AT_CELL);
    if !copies_enter(copies, found.copy, (*walk).origin) {
        return;
    }
    let along = (*copies).space * cone.direction;
    let stretch = length(along);
    (*copies).origin = copy_local_point(found.copy, (*walk).origin + (*walk).direction * found.entry);
    (*copies).skipped = found.entry * stretch;
    *inner = copies_cone(cone, copies, found.copy, along / stretch, stretch);
    (*march).visit.entry = found.entry * stretch;
    (*march).visit.exit = found.exit * stretch;
    (*march).state |= CONE_ACTIVE;
    if !is_same {
        cone_enter(march);
    }
}

// A cone in the space of a copy, which may be stretched there: then it is as wide as its section is
// on average, and for proofs so wide that it holds that section.
fn copies_cone(cone: SceneCone, copies: ptr<function, SceneCopies>, copy: Copy, along: vec3f, stretch: f32) -> SceneCone {
    let most = instancer.most_factor / (min(copy.scale.x, min(copy.scale.y, copy.scale.z)) * stretch);
    let sine = min(cone.spread * most, COPIES_WIDEST);
    let widened = sine * inverseSqrt(1.0 - sine * sine);
    let mean = sqrt(abs(determinant((*copies).space)) / stretch) / stretch;
    let spread = select(cone.spread, widened, most > COPIES_ROUND);
    let size = select(cone.size, cone.size * mean, most > COPIES_ROUND);
    return SceneCone((*copies).origin, 0.0, along, cone.far * stretch, spread, size, cone.least_step * stretch, cone.fineness, vec3f(0.0));
}

// Moves on to the next copy around a point, or into the one in which another dispatch has left it;
// false if it is none of the instancer of the leaf before `after`, or if the limit of visits is reached.
fn copies_next_around(at: OcclusionPoint, after: u32, copies: ptr<function, SceneCopies>, walk: ptr<function, CopyWalk>) -> bool {
    instancer_at = hierarchy[after - 1u].link & ~COPIES_LINK;
    if !(*copies).walks {
        *walk = copy_around_begin(instancer_local_point(at.p), occlusion_reach(at) * instancer.most_factor);
        if (*copies).left_at.w != 0 {
            copy_around_go_on(walk, (*copies).left_at.xyz);
        }
        (*copies).walks = true;
        (*copies).above = copies_gradient(at.normal);
    }
    let budget = copies_budget();
    (*walk).budget = budget;
    (*walk).exhausted = false;
    var copy: Copy;
    let is_met = copy_around_next(walk, &copy);
    copies_count(walk, budget);
    if !is_met {
        (*copies).is_in = (*walk).exhausted;
        return false;
    }
    (*copies).left_at = vec4i(copy.place, WALK_AT_CELL);
    (*copies).origin = copy_local_point(copy, (*walk).origin);
    return copies_enter(copies, copy, (*walk).origin);
}

// Leaves a point to the next dispatch; `is_in_copy`: within the last copy.
fn copies_leave_around(copies: ptr<function, SceneCopies>, walk: ptr<function, CopyWalk>, is_in_copy: bool) {
    if (*copies).is_in && (*copies).walks && !is_in_copy {
        (*copies).is_in = !copy_walk_is_over(walk);
        if (*copies).is_in {
            (*copies).left_at = copy_walk_left(walk);
        }
    }
}
