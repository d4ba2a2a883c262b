// Pass `surface`: once per hit pixel of a component, the normal, the material and the leaf.

#include "common/view.wgsl"
#include "common/depth.wgsl"
#include "common/work.wgsl"
#include "common/tiles.wgsl"
#include "generated/surface.wgsl"

@group(2) @binding(0) var depth_target: texture_2d<f32>;
@group(2) @binding(1) var owner_target: texture_2d<u32>;
@group(2) @binding(2) var normal_target: texture_storage_2d<rgba32float, write>;
@group(2) @binding(3) var diffuse_target: texture_storage_2d<rgba16float, write>;
@group(2) @binding(4) var emission_target: texture_storage_2d<rgba16float, write>;
@group(2) @binding(5) var leaf_target: texture_storage_2d<r32uint, write>;
@group(2) @binding(6) var<storage, read> tiles: array<Tile>;

// Half the span of the differences, in footprints: wide enough for f32, narrow enough for a curve of a
// few pixels' radius.
const DIFFERENCE: f32 = 0.1;
// The same relative to the coordinates, where f32 is coarser than the footprint.
const DIFFERENCE_LEAST: f32 = 1.2e-4;

@compute @workgroup_size(8, 8)
fn surface_pass(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    let pixel = tile_pixel(tiles[work.first_tile + group.x]) + local.xy;
    if !view_contains(pixel) || textureLoad(owner_target, pixel, 0).x != work.component {
        return;
    }
    let component = components[work.component];
    surface_begin(component);
    let direction = view_direction(pixel);
    let t = textureLoad(depth_target, pixel, 0).x;
    let p = component.eye + direction * t;
    let reach = max(max(abs(p.x), abs(p.y)), abs(p.z));
    let h = max(DIFFERENCE * view.footprint * t, DIFFERENCE_LEAST * reach);
    // The gradient from central differences, right to the second order (a tetrahedron saves two
    // evaluations and is right to the first only), the surface itself last: the field is called from one
    // place, so it is compiled once.
    var gradient = vec3f(0.0);
    var center = Surface(0.0, 0u, vec3f(0.0), 0.0, vec3f(0.0), 1.0);
    for (var i = 0u; i < 7u; i += 1u) {
        let axis = select(vec3f(0.0), vec3f(1.0), vec3u(i >> 1u) == vec3u(0u, 1u, 2u));
        let offset = select(axis, -axis, (i & 1u) == 1u);
        center = surface(p + offset * h);
        gradient += offset * center.distance;
    }
    let size = length(gradient);
    let normal = select(-direction, gradient / max(size, 1e-30), size > 0.0);
    textureStore(normal_target, pixel, vec4f(normal, 0.0));
    textureStore(diffuse_target, pixel, vec4f(center.albedo, center.specular));
    textureStore(emission_target, pixel, vec4f(center.emission, center.shininess));
    textureStore(leaf_target, pixel, vec4u(center.leaf));
}
