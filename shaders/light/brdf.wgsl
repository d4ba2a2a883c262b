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
