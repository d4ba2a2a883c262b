// Not a pass: reflection of given materials, for the tests that compare it with the CPU's.

struct BrdfQuery {
    material: FlatMaterial,
    normal: vec3f,
    padding_0: f32,
    to_eye: vec3f,
    padding_1: f32,
    to_light: vec3f,
    padding_2: f32,
}

struct BrdfAnswer {
    direct: vec3f,
    coat: f32,
    diffuse: vec3f,
    coat_roughness: f32,
    specular: vec3f,
    roughness: f32,
}

@group(0) @binding(0) var<storage, read> queries: array<BrdfQuery>;
@group(0) @binding(1) var<storage, read_write> answers: array<BrdfAnswer>;
@group(0) @binding(2) var<storage, read> materials: array<FlatMaterial>;

#include "light/material.wgsl"
#include "light/brdf.wgsl"

@compute @workgroup_size(64)
fn probe_brdf(@builtin(global_invocation_id) id: vec3u) {
    if id.x < arrayLength(&queries) {
        let query = queries[id.x];
        let point = brdf_point(query.material, vec3f(0.0), query.normal, query.to_eye);
        let shares = brdf_environment(point);
        let direct = brdf_direct(point, query.to_light);
        let specular = vec4f(shares.specular, shares.roughness);
        answers[id.x] =
            BrdfAnswer(direct, shares.coat, shares.diffuse, shares.coat_roughness, specular.xyz, specular.w);
    }
}

// Mixtures in their encoding; the material of each.
@group(0) @binding(3) var<storage, read> mixtures: array<vec4u>;
@group(0) @binding(4) var<storage, read_write> mixed: array<FlatMaterial>;

@compute @workgroup_size(64)
fn probe_mixture(@builtin(global_invocation_id) id: vec3u) {
    if id.x < arrayLength(&mixtures) {
        mixed[id.x] = mixture_material(mixtures[id.x]);
    }
}
