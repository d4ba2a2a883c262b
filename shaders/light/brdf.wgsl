// The light that a surface reflects toward the eye. Counterpart of `src/field/light/brdf.rs`.
// Needs `light/material.wgsl`.

// A point of a surface that is lit.
struct ShadingPoint {
    material: FlatMaterial,
    // Relative to the eye.
    position: vec3f,
    // Of unit length, as is `to_eye`.
    normal: vec3f,
    to_eye: vec3f,
}

// The share of the light from the unit direction `to_light` that the surface reflects toward the
// eye: the BRDF times the cosine of the angle of incidence times pi. A white Lambert surface that
// faces the light gives 1.
fn brdf_direct(point: ShadingPoint, to_light: vec3f) -> vec3f {
    let facing = max(dot(point.normal, to_light), 0.0);
    let halfway = to_light + point.to_eye;
    let alignment = max(dot(point.normal, halfway), 0.0) / max(length(halfway), 1e-6);
    let highlight = point.material.phong_specular * pow(alignment, point.material.phong_shininess);
    return (point.material.base_color + highlight) * facing;
}

// The share of the ambient light that the surface reflects toward the eye.
fn brdf_ambient(point: ShadingPoint) -> vec3f {
    return point.material.base_color;
}

// Factors on the light of the environment.
struct EnvironmentShares {
    // On the light that arrives from all around.
    diffuse: vec3f,
    // On the light from about `direction`, blurred by `roughness`.
    specular: vec3f,
    roughness: f32,
    direction: vec3f,
    // The same of the coat.
    coat: f32,
    coat_roughness: f32,
}

// The shares of the light of the environment: a split sum, with the fit of Karis, "Physically based
// shading on mobile" (2014).
fn brdf_environment(point: ShadingPoint) -> EnvironmentShares {
    let material = point.material;
    let layered = 1.0 - material.phong_weight;
    let dielectric = pow((material.ior - 1.0) / (material.ior + 1.0), 2.0) * material.specular_weight;
    let facing = mix(material.specular_color * dielectric, material.base_color, material.metalness);
    let cosine = max(dot(point.normal, point.to_eye), 0.0);
    let r = material.roughness;
    let smoothness = 1.0 - r;
    let a = min(smoothness * smoothness, exp2(-9.28 * cosine)) * smoothness + 0.0425 - 0.0275 * r;
    let scale = 1.04 - 0.572 * r - 1.04 * a;
    let bias = 1.04 * a + 0.022 * r - 0.04;
    let diffuse = material.base_color * (1.0 - material.metalness * layered);
    let specular = max(facing * scale + bias, vec3f(0.0)) * layered;
    return EnvironmentShares(diffuse, specular, r, reflect(-point.to_eye, point.normal), 0.0, 0.0);
}
