// Pass `surface`: once per hit pixel of a component, the normal, the material and the leaf.

#include "common/view.wgsl"
#include "common/depth.wgsl"
#include "common/work.wgsl"
#include "common/quads.wgsl"
#include "common/ray.wgsl"
#include "generated/surface.wgsl"

@group(2) @binding(0) var depth_target: texture_2d<f32>;
@group(2) @binding(1) var owner_target: texture_2d<u32>;
@group(2) @binding(2) var normal_target: texture_storage_2d<rgba32float, write>;
@group(2) @binding(3) var diffuse_target: texture_storage_2d<rgba16float, write>;
@group(2) @binding(4) var emission_target: texture_storage_2d<rgba16float, write>;
@group(2) @binding(5) var leaf_target: texture_storage_2d<r32uint, write>;
// Those in which something was hit begin at `work.hits`.
@group(2) @binding(6) var<storage, read> quads: array<Quad>;
// RAY_COUNTS for each list.
@group(2) @binding(7) var<storage, read> ray_counts: array<u32>;

@compute @workgroup_size(8, 8)
fn surface_pass(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let component = subject;
    surface_begin(component);
    let slot = group.x * 4u + quad_of(lane);
    let is_listed = slot < ray_counts[work.list * RAY_COUNTS + 6u];
    let pixel = quad_pixel(quads[work.hits + work.first_quad + slot].place) + quad_place(lane);
    let seen = is_listed && view_contains(pixel) && textureLoad(owner_target, pixel, 0).x == work.component;
    if RETURNS_EARLY && !seen {
        return;
    }
    let ray = ray_through(component, pixel);
    let t = textureLoad(depth_target, pixel, 0).x;
    let surface = surface(ray_at(ray, t));
    let size = length(surface.gradient);
    let normal = select(-ray.direction, surface.gradient / max(size, 1e-30), size > 0.0);
    if seen {
        textureStore(normal_target, pixel, vec4f(normal, size));
        textureStore(diffuse_target, pixel, surface.diffuse);
        textureStore(emission_target, pixel, surface.emission);
        textureStore(leaf_target, pixel, vec4u(surface.leaf));
    }
}
