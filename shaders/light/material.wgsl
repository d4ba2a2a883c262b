// Materials and their mixtures. Needs `materials: array<FlatMaterial>`.

// `src/field/flat_material.rs` holds this struct's counterpart; a test compares the layouts.
struct FlatMaterial {
    base_color: vec3f,
    metalness: f32,
    specular_color: vec3f,
    specular_weight: f32,
    emission: vec3f,
    coat_darkening: f32,
    coat_color: vec3f,
    coat_weight: f32,
    roughness: f32,
    ior: f32,
    coat_roughness: f32,
    coat_ior: f32,
    diffuse_roughness: f32,
    phong_weight: f32,
    phong_specular: f32,
    phong_shininess: f32,
    opacity: f32,
    // Less opacity is cut out, and the rest is opaque; 0 for blended opacity.
    opacity_threshold: f32,
    padding_0: f32,
    padding_1: f32,
}

#if TEXTURES
#include "light/textured.wgsl"

// The point whose mixture is asked for, and by how much its textures bend the normal there.
var<private> mixture_point: TexturedPoint;
var<private> mixture_bend: vec3f;
var<private> mixture_pixel: vec2u;

#end
// The material of a mixture as `common/mixture.wgsl` encodes it.
fn mixture_material(encoded: vec4u) -> FlatMaterial {
    var mixed = FlatMaterial();
    var left = encoded;
    while left.x > 0u {
        let weight = f32(left.x >> 16u) / 65535.0;
        var material = materials[left.x & 0xffffu];
#if TEXTURES
        let textured = textured_material(material, left.x & 0xffffu, mixture_point);
        material = textured.material;
        mixture_bend += weight * textured.bend;
#end
        mixed.base_color += material.base_color * weight;
        mixed.metalness += material.metalness * weight;
        mixed.specular_color += material.specular_color * weight;
        mixed.specular_weight += material.specular_weight * weight;
        mixed.emission += material.emission * weight;
        mixed.coat_darkening += material.coat_darkening * weight;
        mixed.coat_color += material.coat_color * weight;
        mixed.coat_weight += material.coat_weight * weight;
        mixed.roughness += material.roughness * weight;
        mixed.ior += material.ior * weight;
        mixed.coat_roughness += material.coat_roughness * weight;
        mixed.coat_ior += material.coat_ior * weight;
        mixed.diffuse_roughness += material.diffuse_roughness * weight;
        mixed.phong_weight += material.phong_weight * weight;
        mixed.phong_specular += material.phong_specular * weight;
        mixed.phong_shininess += material.phong_shininess * weight;
        left = vec4u(left.yzw, 0u);
    }
    return mixed;
}
