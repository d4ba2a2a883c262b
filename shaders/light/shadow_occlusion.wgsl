// The second entry point of the pass `shadow`: occlusion by six cones, through one component after
// the other. Counterpart of `scene_occlusion` in `src/field/light/occlusion.rs`.

// See the CPU's constants of these names.
const OCCLUSION_NEAR: f32 = 0.0833333;
const OCCLUSION_FAR: f32 = 0.76;
const OCCLUSION_GROWTH: f32 = 3.0;
const OCCLUSION_SINE: f32 = 0.5;
// Most spheres of a cone.
const OCCLUSION_SPHERES: u32 = 3u;

// A point above a surface, and the distances of the evaluations in a cone.
struct OcclusionPoint {
    p: vec3f,
    near: f32,
    normal: vec3f,
    far: f32,
}

// Where a cone evaluates a component, relative to the point, and the radius of the sphere there.
struct OcclusionSample {
    along: vec3f,
    size: f32,
    q: vec3f,
}

fn occlusion_point(point: ShadowPoint) -> OcclusionPoint {
    let footprint = view.footprint * point.depth;
    let p = scene_surface_ray(point.position, point.normal, point.normal, point.depth).origin;
    let near = max(OCCLUSION_NEAR * settings.occlusion_radius, 2.0 * footprint);
    return OcclusionPoint(p, near, point.normal, OCCLUSION_FAR * settings.occlusion_radius);
}

// No sphere of any cone reaches farther.
fn occlusion_reach(at: OcclusionPoint) -> f32 {
    return at.far * (1.0 + OCCLUSION_SINE);
}

// Moves on to the next component. Unchanged if the limit of visits is reached.
fn occlusion_next(at: OcclusionPoint, march: ptr<function, OcclusionMarch>) {
    let found = scene_occluder(at.p, at.normal, occlusion_reach(at), march.after);
    let is_valid = scene_visits < scene_limits.max_visits;
    march.after = select(march.after, found + 1u, is_valid);
    march.ended = is_valid && found >= scene_limits.all_nodes;
    march.cone = select(march.cone, 0u, is_valid);
    march.t = at.near;
}

fn occlusion_sample(at: OcclusionPoint, march: OcclusionMarch) -> OcclusionSample {
    scene_visits += 1u;
    let along = occlusion_cone(at.normal, march.cone).xyz * march.t;
    return OcclusionSample(along, OCCLUSION_SINE * march.t, at.p + along);
}

// Whether the bounds of the component meet the sphere.
fn occlusion_meets(component: Component, sample: OcclusionSample) -> bool {
#if VEILS
    cone_veil = component.translucency;
#end
    let plane = dot(component.half_space.xyz, sample.q) + component.half_space.w;
    let away = length(max(max(component.low - sample.q, sample.q - component.high), vec3f(0.0)));
    return max(away, plane) < sample.size * 0.999;
}

// Passes a distance, if nothing is to be evaluated there: where the bounds are outside of the sphere, so
// is the component. At the same distances for all: steps by the field would show the bounds.
fn occlusion_pass(at: OcclusionPoint, march: ptr<function, OcclusionMarch>, is_found: bool) {
    let next = select(march.t * OCCLUSION_GROWTH, march.t, is_found);
    let is_over = next > at.far;
    march.cone += select(0u, 1u, is_over);
    march.t = select(next, at.near, is_over);
}

fn occlusion_lower(march: ptr<function, OcclusionMarch>, cone: u32, ratio: f32) {
    march.low = select(march.low, min(march.low, vec3f(ratio)), vec3u(0u, 1u, 2u) == vec3u(cone));
    march.high = select(march.high, min(march.high, vec3f(ratio)), vec3u(3u, 4u, 5u) == vec3u(cone));
}

fn occlusion_begin(at: OcclusionPoint, is_empty: bool) -> OcclusionMarch {
    var march = OcclusionMarch(vec3f(1.0), vec3f(1.0), 0u, OCCLUSION_CONES, at.near, is_empty, OCCLUSION_CONES);
#if MESH_RAYS
    march.meshes = select(0u, OCCLUSION_CONES, is_empty);
#end
    return march;
}

// Compares the cones with the meshes, one after the other, as long as the invocation may search; once all
// components are done. Behind the first triangle on the axis, distances count as those within a solid.
fn occlusion_meshes(at: OcclusionPoint, march: ptr<function, OcclusionMarch>) {
#if MESH_RAYS
    while march.ended && march.meshes < OCCLUSION_CONES && scene_has_mesh_visits() {
        let axis = occlusion_cone(at.normal, march.meshes).xyz;
        let stop = mesh_rays_hit(Ray(at.p, 0.0, axis), 0.0, at.far);
        var ratio = 1.0;
        var t = at.near;
        for (var i = 0u; i < OCCLUSION_SPHERES; i += 1u) {
            let away = mesh_near_distance(at.p + axis * t, OCCLUSION_SINE * t) / (OCCLUSION_SINE * t);
            let signed = select(away, -away, stop.mesh != NO_MESH && t > stop.t);
            ratio = select(ratio, min(ratio, signed), t <= at.far);
            t *= OCCLUSION_GROWTH;
        }
        occlusion_lower(march, march.meshes, ratio);
        march.meshes += 1u;
    }
#end
}

// Takes the ratio of field and radius into account.
fn occlusion_take(at: OcclusionPoint, march: ptr<function, OcclusionMarch>, found: f32) {
    var ratio = found;
#if VEILS
    ratio = mix(max(found, -1.0), 1.0, cone_veil);
#end
    occlusion_lower(march, march.cone, ratio);
    let next = march.t * OCCLUSION_GROWTH;
    let is_over = next > at.far || ratio <= -1.0;
    march.cone += select(0u, 1u, is_over);
    march.t = select(next, at.near, is_over);
}

// Each round finds the next evaluation first: invocations that run together then evaluate together. A pixel
// is open unless it has ended in another dispatch, which has stored its shares.
@compute @workgroup_size(8, 8)
fn shadow_occlusion(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let pixel = dispatch.origin + shadow_invocation(group, lane) * settings.cone_spacing;
    var is_open = all(pixel < dispatch.end);
    let own = shadow_place(shadow_invocation(group, lane), 1u);
    let point = shadow_point(pixel);
    let at = occlusion_point(point);
    var march = occlusion_begin(at, point.depth >= BACKGROUND);
#if SCENE_COPIES
    var copies = copies_begin();
    var walk: CopyWalk;
#end
    if is_open && dispatch.relaunch == 1u {
        march = shadow_load_occlusion(own);
        is_open = !shadow_occlusion_ended(march);
#if SCENE_COPIES
        copies = shadow_load_copies(own);
#end
    }
    while !march.ended && scene_evaluations < scene_limits.max_evaluations && scene_visits < scene_limits.max_visits {
        var component: Component;
        var sample: OcclusionSample;
        var is_found = false;
        while !is_found && !march.ended && scene_visits < scene_limits.max_visits {
            var seeks = march.cone == OCCLUSION_CONES;
#if SCENE_COPIES
            if copies.is_in && (seeks || !copies.walks) {
                let is_met = copies_next_around(at, march.after, &copies, &walk);
                // In the copy in which another dispatch has left them, cones go on.
                let resumes = is_met && !seeks;
                march.t = select(at.near, march.t, resumes);
                march.cone = select(select(OCCLUSION_CONES, 0u, is_met), march.cone, resumes);
                seeks = false;
            }
#end
            if seeks {
                occlusion_next(at, &march);
#if SCENE_COPIES
                if march.cone == 0u && !march.ended && hierarchy[march.after - 1u].link >= COPIES_LINK {
                    copies = copies_begin();
                    copies.is_in = true;
                    march.cone = OCCLUSION_CONES;
                }
#end
            }
            if !march.ended && march.cone < OCCLUSION_CONES {
                var index = hierarchy[march.after - 1u].link;
                sample = occlusion_sample(at, march);
#if SCENE_COPIES
                if copies.is_in {
                    index = copies.component;
                    sample.q = copies.origin + copies.space * sample.along;
                    sample.size *= copies.factor;
                }
#end
                component = scene_components[index];
                sample.q += component.eye;
                is_found = occlusion_meets(component, sample) && march.t <= at.far;
                occlusion_pass(at, &march, is_found);
            }
        }
        if is_found {
            scene_evaluations += 1u;
            field_begin(component);
            let f = field(sample.q);
            var size = OCCLUSION_SINE * march.t;
#if SCENE_COPIES
            size *= select(1.0, copies.factor, copies.is_in);
#end
            occlusion_take(at, &march, (f + select(0.0, field_slack(), f > 0.0)) / size);
        }
    }
    occlusion_meshes(at, &march);
    if is_open {
#if SCENE_COPIES
        copies_leave_around(&copies, &walk, march.cone < OCCLUSION_CONES);
        shadow_save_copies(own, copies.left_at, copies.is_in);
#end
        shadow_leave_occlusion(own, march, (pixel.y * view.width + pixel.x) * settings.stride);
    }
}
