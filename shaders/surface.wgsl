// Pass `surface`: normal, materials and leaf, once per hit pixel of a component.

#include "common/view.wgsl"
#include "common/depth.wgsl"
#include "common/dispatch.wgsl"
#include "common/subtiles.wgsl"
#include "common/ray.wgsl"
#include "generated/surface.wgsl"
#include "generated/surface_seen.wgsl"

@group(2) @binding(0) var depth_target: texture_2d<f32>;
@group(2) @binding(1) var visibility_target: texture_2d<u32>;
@group(2) @binding(2) var normal_target: texture_storage_2d<rgba32float, write>;
@group(2) @binding(3) var material_target: texture_storage_2d<rgba32uint, write>;
@group(2) @binding(4) var leaf_target: texture_storage_2d<r32uint, write>;
// Subtiles with hits begin at `dispatch.hits`.
@group(2) @binding(5) var<storage, read> subtiles: array<Subtile>;
// RAY_COUNTS words per list.
@group(2) @binding(6) var<storage, read> ray_counts: array<u32>;

// The surface that a pixel shows.
struct SeenSurface {
    surface: Surface,
    // Gradient in the world, of any length.
    gradient: vec3f,
    // Length of the field's own gradient.
    size: f32,
}

@compute @workgroup_size(8, 8)
fn surface_pass(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let component = subject;
    surface_begin(component);
    let slot = group.x * 4u + subtile_of(lane);
    let is_listed = slot < ray_counts[dispatch.list * RAY_COUNTS + 6u];
    let pixel = subtile_pixel(subtiles[dispatch.hits + dispatch.first_subtile + slot].place) + subtile_place(lane);
    let seen = is_listed && view_contains(pixel) && textureLoad(visibility_target, pixel, 0).x == dispatch.component;
    if RETURNS_EARLY && !seen {
        return;
    }
    let found = surface_seen(component, pixel, textureLoad(depth_target, pixel, 0).x, seen);
    let size = length(found.gradient);
    let normal = select(-view_direction(pixel), found.gradient / max(size, 1e-30), size > 0.0);
    if seen {
        textureStore(normal_target, pixel, vec4f(normal, found.size));
        textureStore(material_target, pixel, mixture_encoded(found.surface.materials));
        textureStore(leaf_target, pixel, vec4u(found.surface.leaf));
    }
}

// If the normal of a hit points away from the eye, the search for the entry point starts this far
// before the hit, in footprints: more than twice the accepted error. The trace may have hit a part
// of this thickness at its far side.
const ENTRY: f32 = select(2.5e-3, 1e-2, VERIFIED_OVERSTEP) * FINENESS;
// While that point is inside, the search moves back by this factor, at most ENTRY_LOOKS times:
// beyond the longest overstep.
const ENTRY_GROWTH: f32 = 8.0;
const ENTRY_LOOKS: u32 = 4u;
// Newton steps from a point outside to the surface.
const ENTRY_STEPS: u32 = 2u;

// The surface at `t`, or, if the ray leaves the solid there, the surface where it entered. `seen`:
// whether the pixel needs the result.
fn surface_entered(ray: Ray, t: f32, seen: bool) -> Surface {
    var found: Surface;
    var at = t;
    var back = ENTRY * dispatch.footprint * t;
    var looks = 0u;
    var steps = 0u;
    loop {
        let here = surface(ray_at(ray, at));
        let descent = -dot(here.gradient, ray.direction);
        let is_first = looks == 0u;
        if is_first || descent > 0.0 {
            found = here;
        }
        if !seen || steps == ENTRY_STEPS || (is_first && descent >= 0.0) {
            break;
        }
        if descent > 0.0 {
            at = min(at + here.distance / descent, t);
            steps += 1u;
        } else if looks == ENTRY_LOOKS || steps > 0u || (!is_first && here.distance >= 0.0) {
            break;
        } else {
            at = t - back;
            back *= ENTRY_GROWTH;
            looks += 1u;
        }
    }
    return found;
}
