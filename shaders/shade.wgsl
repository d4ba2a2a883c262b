// Pass `shade`: lights the hits of the previous passes and draws the background. A draw, not a
// dispatch: lavapipe takes some 16 ns for each texel that a pipeline stores, and less when it
// draws.

#include "common/view.wgsl"
#include "common/depth.wgsl"
#include "common/screen.wgsl"
#include "common/light.wgsl"
#include "common/mesh_look.wgsl"

@group(1) @binding(0) var<storage, read> lights: array<Light>;
@group(1) @binding(1) var<storage, read> materials: array<FlatMaterial>;
// Materials of the meshes, without what their textures change.
@group(1) @binding(2) var<storage, read> mesh_materials: array<FlatMaterial>;
// The environment, unless it is a gradient.
@group(1) @binding(3) var<storage, read> environment_map: array<u32>;
@group(2) @binding(0) var depth_target: texture_2d<f32>;
@group(2) @binding(1) var normal_target: texture_2d<f32>;
// Of meshes.
@group(2) @binding(2) var base_color_target: texture_2d<f32>;
// Of fields: mixtures. Of meshes: see `common/mesh_look.wgsl`.
@group(2) @binding(3) var material_target: texture_2d<u32>;
@group(2) @binding(4) var visibility_target: texture_2d<u32>;

#if TEXTURES
@group(3) @binding(1) var<storage, read> placed_textures: array<GpuPlacedTextures>;
@group(3) @binding(2) var<storage, read> texture_sets: array<TextureSet>;
@group(3) @binding(3) var texels: texture_storage_2d<r32uint, read>;
#end
#if LOOKS
@group(3) @binding(7) var bricks: texture_storage_2d<rgba32uint, read>;
#end

#if LIGHT_TILES
// Of the pass `lights`.
@group(3) @binding(10) var<storage, read> light_tiles: array<u32>;
#include "light/light_tiles.wgsl"
#end

#include "light/material.wgsl"
#if COPIES
#include "copy/look.wgsl"
#end
#include "generated/shares.wgsl"
#include "light/lighting.wgsl"
#include "light/display.wgsl"

// A picture of a single sample is encoded at once, by one entry point for each view transform.
@fragment
fn shade_fragment(@builtin(position) at: vec4f) -> @location(0) vec4f {
    return vec4f(display_encode(shade_pixel(vec2u(at.xy)).rgb * view.exposure), 1.0);
}

@fragment
fn shade_agx_fragment(@builtin(position) at: vec4f) -> @location(0) vec4f {
    return vec4f(display_encode(display_agx(shade_pixel(vec2u(at.xy)).rgb * view.exposure)), 1.0);
}

@fragment
fn shade_neutral_fragment(@builtin(position) at: vec4f) -> @location(0) vec4f {
    return vec4f(display_encode(display_neutral(shade_pixel(vec2u(at.xy)).rgb * view.exposure)), 1.0);
}

// Sum of the samples so far.
@group(3) @binding(0) var sum_target: texture_2d<f32>;

// One of several samples: adds linear light and coverage to the sum. Pass `display` shows their mean.
@fragment
fn shade_sample_fragment(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let pixel = vec2u(at.xy);
    let sum = textureLoad(sum_target, pixel, 0);
    return shade_pixel(pixel) + select(sum, vec4f(0.0), view.sample_index == 0u);
}

// Linear light of a pixel, and its coverage.
fn shade_pixel(pixel: vec2u) -> vec4f {
    let direction = view_direction(pixel);
    let depth = textureLoad(depth_target, pixel, 0).x;
    let visibility = textureLoad(visibility_target, pixel, 0).x;
    var color = environment_background(direction, view.sky, view.horizon);
    if depth < BACKGROUND {
        let is_mesh = (visibility & MESH_BIT) != 0u;
        let surface_normal = textureLoad(normal_target, pixel, 0).xyz;
#if TEXTURES
        mixture_point = textured_point(direction, depth, surface_normal, view.footprint);
        mixture_bend = vec3f(0.0);
        mixture_pixel = pixel;
#end
        let stored = textureLoad(material_target, pixel, 0);
        var mixture = select(stored, vec4u(0u), is_mesh);
#if COPIES
        let look = look_of_pixel(pixel, visibility);
        mixture = look_mixture(look, mixture);
#end
        var material = mixture_material(mixture);
#if COPIES
        material = look_varied(material, look);
#end
        var open = 1.0;
        if is_mesh {
            let surface = mesh_encoded_surface(stored);
            material = mesh_materials[stored.x];
            material.base_color = textureLoad(base_color_target, pixel, 0).rgb;
            material.metalness = surface.x;
            material.roughness = surface.y;
            material.emission = mesh_encoded_emission(stored);
            open = surface.z;
        }
        var normal = surface_normal;
#if TEXTURES
        normal = textured_normal(normal, mixture_bend);
#end
        var to_eye = -direction;
#if VEILS
        // Rays that pass surfaces meet others from within, and see the light of the side without.
        let is_within = !is_mesh && dot(surface_normal, direction) > 0.0;
        to_eye = select(to_eye, to_eye - 2.0 * dot(to_eye, surface_normal) * surface_normal, is_within);
#end
#if SPARSE_SHARES
        shares_find(pixel, depth, surface_normal);
#end
        let point = brdf_point(material, direction * depth, normal, to_eye);
        // Depends on the pixel as well: otherwise lavapipe recompiles the loop for each buffer that
        // holds the count.
        let light_count = select(view.light_count, 0u, depth >= BACKGROUND);
        color = lighting_surface(point, pixel, view.ambient, open, light_count);
    }
    let is_empty = view.transparent == 1u && depth >= BACKGROUND;
    return select(vec4f(color, 1.0), vec4f(0.0), is_empty);
}
