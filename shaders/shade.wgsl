// Pass `shade`: light on what the passes before have found, and the background.

#include "common/view.wgsl"
#include "common/depth.wgsl"
#include "common/work.wgsl"
#include "common/light.wgsl"

@group(1) @binding(0) var<storage, read> lights: array<Light>;
// Emission and shininess of each mesh.
@group(1) @binding(1) var<storage, read> mesh_emissions: array<vec4f>;
@group(2) @binding(0) var depth_target: texture_2d<f32>;
@group(2) @binding(1) var normal_target: texture_2d<f32>;
@group(2) @binding(2) var diffuse_target: texture_2d<f32>;
@group(2) @binding(3) var emission_target: texture_2d<f32>;
@group(2) @binding(4) var color_target: texture_storage_2d<rgba8unorm, write>;
@group(2) @binding(5) var owner_target: texture_2d<u32>;
@group(2) @binding(6) var leaf_target: texture_storage_2d<r32uint, write>;

#include "light/shade.wgsl"

@compute @workgroup_size(8, 8)
fn shade(@builtin(global_invocation_id) id: vec3u) {
    let pixel = work.origin + id.xy;
    if pixel.x >= work.end.x || pixel.y >= work.end.y {
        return;
    }
    let direction = view_direction(pixel);
    let depth = textureLoad(depth_target, pixel, 0).x;
    let owner = textureLoad(owner_target, pixel, 0).x;
    let is_field = (owner & MESH_BIT) == 0u;
    if !is_field {
        textureStore(leaf_target, pixel, vec4u(owner));
    }
    var color = shade_background(direction.y, view.sky, view.horizon);
    if depth < BACKGROUND {
        let diffuse = textureLoad(diffuse_target, pixel, 0);
        var emission = textureLoad(emission_target, pixel, 0);
        if !is_field {
            emission = mesh_emissions[owner & ~MESH_BIT];
        }
        color = shade_surface(
            diffuse.rgb,
            diffuse.a,
            emission.rgb,
            emission.a,
            direction * depth,
            textureLoad(normal_target, pixel, 0).xyz,
            -direction,
            view.ambient,
            view.light_count,
        );
    }
    textureStore(color_target, pixel, vec4f(shade_encode(color), 1.0));
}
