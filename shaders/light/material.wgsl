// Materials and their mixtures. Needs `materials: array<FlatMaterial>`.

// `src/field/arrays.rs` holds this struct's counterpart; a test compares the layouts.
struct FlatMaterial {
    albedo: vec3f,
    specular: f32,
    emission: vec3f,
    shininess: f32,
}

// The material of a mixture as `common/mixture.wgsl` encodes it.
fn mixture_material(encoded: vec4u) -> FlatMaterial {
    var mixed = FlatMaterial(vec3f(0.0), 0.0, vec3f(0.0), 0.0);
    var left = encoded;
    while left.x > 0u {
        let weight = f32(left.x >> 16u) / 65535.0;
        let material = materials[left.x & 0xffffu];
        mixed.albedo += material.albedo * weight;
        mixed.specular += material.specular * weight;
        mixed.emission += material.emission * weight;
        mixed.shininess += material.shininess * weight;
        left = vec4u(left.yzw, 0u);
    }
    return mixed;
}
