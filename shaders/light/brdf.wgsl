// The light that a surface reflects toward the eye. Counterpart of `src/field/light/brdf.rs`.
// Needs `light/material.wgsl`, and `LAYERS`: whether a material may have the layers of OpenPBR.

#include "light/layers.wgsl"

// A point of a surface that is lit; `brdf_point` makes it.
struct ShadingPoint {
    material: FlatMaterial,
    // Relative to the eye.
    position: vec3f,
    // Of unit length, as is `to_eye`.
    normal: vec3f,
    to_eye: vec3f,
    // For `LAYERS` only.
    layers: Layers,
}

// Factors on the light of the environment.
struct EnvironmentShares {
    // On the light that arrives from all around.
    diffuse: vec3f,
    // How much more of it comes from the side of the eye: added to the mean direction.
    lean: vec3f,
    // On the light from about `dominant`, blurred by `roughness`.
    specular: vec3f,
    roughness: f32,
    // Between the mirrored ray and the normal: most of what a rough surface reflects comes from there.
    dominant: vec3f,
    // Of the mirrored ray.
    direction: vec3f,
    // On the light from there, blurred by the roughness of the coat.
    coat: f32,
    coat_roughness: f32,
}

fn brdf_point(material: FlatMaterial, position: vec3f, normal: vec3f, to_eye: vec3f) -> ShadingPoint {
    var point = ShadingPoint(material, position, normal, to_eye, Layers());
    if LAYERS {
        point.layers = layers_of(material, dot(normal, to_eye));
    }
    return point;
}

// The share of the light from the unit direction `to_light` that the surface reflects toward the
// eye: the BRDF times the cosine of the angle of incidence times pi. A white Lambert surface that
// faces the light gives 1.
fn brdf_direct(point: ShadingPoint, to_light: vec3f) -> vec3f {
    let toward = to_light + point.to_eye;
    let scale = max(length(toward), 1e-6);
    let phong = brdf_phong(point, to_light, max(dot(point.normal, toward), 0.0) / scale);
    if LAYERS {
        let layers = layers_direct(point.layers, point.normal, point.to_eye, to_light, toward / scale);
        return phong + (1.0 - point.material.phong_weight) * layers;
    }
    return phong;
}

// The part by Blinn and Phong; `alignment` is the cosine between normal and halfway direction. A
// mixture holds the highlight and its exponent times the weight.
fn brdf_phong(point: ShadingPoint, to_light: vec3f, alignment: f32) -> vec3f {
    let material = point.material;
    let facing = max(dot(point.normal, to_light), 0.0);
    let exponent = max(material.phong_shininess / max(material.phong_weight, 1e-4), 1.0);
    let highlight = material.phong_specular * pow(alignment, exponent);
    return (material.base_color * material.phong_weight + highlight) * facing;
}

// The share of light that comes equally from everywhere.
fn brdf_ambient(point: ShadingPoint) -> vec3f {
    let shares = brdf_environment(point);
    return shares.diffuse + shares.specular + shares.coat;
}

// See the CPU's constant of this name.
const LEAN: f32 = 0.5;

// The shares of the light of the environment: a split sum. The dominant direction is that of Lagarde
// and de Rousiers, "Moving Frostbite to Physically Based Rendering" (2014).
fn brdf_environment(point: ShadingPoint) -> EnvironmentShares {
    var shares = EnvironmentShares();
    shares.diffuse = point.material.base_color * point.material.phong_weight;
    shares.direction = reflect(-point.to_eye, point.normal);
    shares.dominant = shares.direction;
    if LAYERS {
        let weight = 1.0 - point.material.phong_weight;
        shares.diffuse += weight * point.layers.diffuse_albedo;
        shares.specular = weight * point.layers.specular_albedo;
        shares.roughness = sqrt(point.layers.alpha);
        let smoothness = 1.0 - point.layers.alpha;
        let mirrored = smoothness * (sqrt(smoothness) + point.layers.alpha);
        shares.dominant = normalize(mix(point.normal, shares.direction, mirrored));
        let side = point.to_eye - point.normal * dot(point.normal, point.to_eye);
        shares.lean = side * (LEAN * weight * point.layers.diffuse_roughness);
        shares.coat = weight * point.layers.coat_albedo;
        shares.coat_roughness = sqrt(point.layers.coat_alpha);
    }
    return shares;
}
