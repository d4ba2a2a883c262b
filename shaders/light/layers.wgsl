// The layers of OpenPBR 1.1: a coat over a base that is a mixture of a dielectric over a diffuse surface, and a metal.
// Counterpart of `src/field/light/layers.rs`, which names the sources of the formulas.
// Needs `light/material.wgsl`.

#include "light/albedo.wgsl"

// Width of GGX for a roughness of 0: a highlight of a light without size.
const LEAST_ALPHA: f32 = 0.002;
// Cosine to the eye at the outline.
const LEAST_COSINE: f32 = 0.01;
// Reflectance below which a dielectric reflects less than everything at grazing angles.
const LEAST_REFLECTANCE: f32 = 0.02;
// 1/2 - 2/(3 pi), and 2/3 - 28/(15 pi).
const FACING_LOSS: f32 = 0.28779341;
const MEAN_LOSS: f32 = 0.07248821;

// What a material reflects toward the eye, without what depends on the light.
struct Layers {
    // Diffuse reflection: once, and again between the facets, without the factors of the direction of light.
    diffuse: vec3f,
    diffuse_again: vec3f,
    diffuse_roughness: f32,
    // Reflectance of the base's microfacets at the cosine c: facing + grazing (1 - c)^5 - tinted c (1 - c)^6.
    facing: vec3f,
    grazing: vec3f,
    tinted: vec3f,
    alpha: f32,
    // The same of the coat.
    coat_facing: f32,
    coat_grazing: f32,
    coat_alpha: f32,
    // Albedo of each part under light from everywhere.
    diffuse_albedo: vec3f,
    specular_albedo: vec3f,
    coat_albedo: f32,
}

fn layers_alpha(roughness: f32) -> f32 {
    return max(roughness * roughness, LEAST_ALPHA);
}

// Reflectance of a face between media whose indices of refraction have this ratio, seen from the front.
fn layers_reflectance(ratio: f32) -> f32 {
    let r = (ratio - 1.0) / (ratio + 1.0);
    return r * r;
}

// The layers of a material that the eye sees at this angle.
fn layers_of(material: FlatMaterial, cosine: f32) -> Layers {
    let mu = clamp(cosine, LEAST_COSINE, 1.0);
    let coat = material.coat_weight;
    let metal = material.metalness;
    let color = clamp(material.base_color, vec3f(0.0), vec3f(1.0));
    var layers = Layers();

    // A rough coat blurs what is below it.
    let rough = material.roughness * material.roughness;
    let coat_rough = material.coat_roughness * material.coat_roughness;
    let blurred = sqrt(sqrt(min(rough * rough + 2.0 * coat_rough * coat_rough, 1.0)));
    layers.alpha = layers_alpha(mix(material.roughness, blurred, coat));
    let albedo = albedo_specular(mu, layers.alpha);
    let again = (1.0 - albedo.whole) / albedo.whole;

    let below = material.ior / mix(1.0, material.coat_ior, coat);
    let facing = min(material.specular_weight * layers_reflectance(below), 1.0);
    let grazing = min(facing / LEAST_REFLECTANCE, 1.0) - facing;
    let gain = 1.0 + facing * again;
    let gloss = gain * (facing * albedo.whole + grazing * albedo.grazing);

    // F82: specular_color is the tint at a cosine of 1/7.
    let metal_gain = min(material.specular_weight, 1.0) * (1.0 + color * again);
    let tint = (color + (1.0 - color) * 0.46266436) * (1.0 - material.specular_color) * 17.651252;
    let metal_facing = metal_gain * color;
    let metal_grazing = metal_gain * (1.0 - color);
    let metal_tinted = metal_gain * tint;

    let dielectric = (1.0 - metal) * gain * material.specular_color;
    layers.facing = dielectric * facing + metal * metal_facing;
    layers.grazing = dielectric * grazing + metal * metal_grazing;
    layers.tinted = metal * metal_tinted;
    layers.specular_albedo = max(
        layers.facing * albedo.whole + layers.grazing * albedo.grazing - layers.tinted * albedo.tinted,
        vec3f(0.0),
    );
    layers_add_diffuse(&layers, color, material.diffuse_roughness, (1.0 - metal) * (1.0 - gloss), mu);
    layers_add_coat(&layers, material, mu);
    return layers;
}

// Energy-preserving Oren-Nayar; `share` is the light that reaches it.
fn layers_add_diffuse(layers: ptr<function, Layers>, color: vec3f, roughness: f32, share: f32, mu: f32) {
    let scale = 1.0 / (1.0 + FACING_LOSS * roughness);
    let mean = scale * (1.0 + MEAN_LOSS * roughness);
    let loss = max(FACING_LOSS - layers_oren_nayar(mu), 0.0);
    let again = color * color * mean / (1.0 - color * (1.0 - mean));
    (*layers).diffuse_roughness = roughness;
    (*layers).diffuse = color * (scale * share);
    (*layers).diffuse_again = again * (share * scale * roughness * loss / (FACING_LOSS - MEAN_LOSS));
    let once = 1.0 - scale * roughness * loss;
    (*layers).diffuse_albedo = share * (color * once + again * (1.0 - once));
}

// Puts the coat over the base.
fn layers_add_coat(layers: ptr<function, Layers>, material: FlatMaterial, mu: f32) {
    let ior = max(material.coat_ior, 1.0);
    (*layers).coat_alpha = layers_alpha(material.coat_roughness);
    let albedo = albedo_specular(mu, (*layers).coat_alpha);
    let facing = layers_reflectance(ior);
    let grazing = min(facing / LEAST_REFLECTANCE, 1.0) - facing;
    let gain = material.coat_weight * (1.0 + facing * (1.0 - albedo.whole) / albedo.whole);
    (*layers).coat_facing = gain * facing;
    (*layers).coat_grazing = gain * grazing;
    (*layers).coat_albedo = gain * (facing * albedo.whole + grazing * albedo.grazing);

    // Light that the coat reflects back onto the base darkens it.
    let base = clamp((*layers).diffuse_albedo + (*layers).specular_albedo, vec3f(0.0), vec3f(1.0));
    let bounded = clamp(ior, 1.0, 3.0);
    let mean = log((10893.0 * bounded - 1438.2) / (-774.4 * bounded * bounded + 10212.0 * bounded + 1.0));
    let fresnel = facing + grazing * pow(1.0 - mu, 5.0);
    let inside = mix(1.0 - (1.0 - mean) / (bounded * bounded), fresnel, material.metalness * (1.0 - material.roughness));
    let darkening = (1.0 - inside) / (1.0 - base * inside);
    let path = inverseSqrt(1.0 - (1.0 - mu * mu) / (ior * ior + 1e-4));
    let tint = pow(max(material.coat_color, vec3f(1e-6)), vec3f(path));
    let darkened = mix(vec3f(1.0), darkening, material.coat_darkening);
    let passes = (1.0 - (*layers).coat_albedo / max(material.coat_weight, 1e-6)) * darkened * tint;
    let under = mix(vec3f(1.0), passes, material.coat_weight);
    (*layers).diffuse *= under;
    (*layers).diffuse_again *= under;
    (*layers).facing *= under;
    (*layers).grazing *= under;
    (*layers).tinted *= under;
    (*layers).diffuse_albedo *= under;
    (*layers).specular_albedo *= under;
}

// Of Oren and Nayar's albedo: what grows with roughness and with the angle.
fn layers_oren_nayar(cosine: f32) -> f32 {
    let x = 1.0 - cosine;
    return x * (0.0571085289 + x * (0.491881867 + x * (-0.332181442 + 0.0714429953 * x)));
}

// GGX with the height-correlated shadowing of Smith, times pi; `incident` and `mu` are the cosines to light and eye.
fn layers_spread(alpha: f32, normal: vec3f, halfway: vec3f, incident: f32, mu: f32) -> f32 {
    let along = dot(normal, halfway);
    let across = cross(normal, halfway);
    let a2 = alpha * alpha;
    let d = a2 * along * along + dot(across, across);
    let shadow = incident * sqrt(mu * mu * (1.0 - a2) + a2) + mu * sqrt(incident * incident * (1.0 - a2) + a2);
    return a2 / (d * d) * 0.5 / max(shadow, 1e-6);
}

// The share of the light from `to_light` that is reflected, as `brdf_direct` gives it; `halfway` is of unit length.
fn layers_direct(layers: Layers, normal: vec3f, to_eye: vec3f, to_light: vec3f, halfway: vec3f) -> vec3f {
    let incident = max(dot(normal, to_light), 0.0);
    let mu = clamp(dot(normal, to_eye), LEAST_COSINE, 1.0);
    let c = clamp(dot(halfway, to_light), 0.0, 1.0);
    let r = 1.0 - c;
    let r5 = r * r * r * r * r;
    let base = layers.facing + layers.grazing * r5 - layers.tinted * (c * r * r5);
    let coat = layers.coat_facing + layers.coat_grazing * r5;
    let specular = max(base, vec3f(0.0)) * layers_spread(layers.alpha, normal, halfway, incident, mu)
        + coat * layers_spread(layers.coat_alpha, normal, halfway, incident, mu);
    let s = dot(to_light, to_eye) - incident * mu;
    let t = select(s, s / max(max(incident, mu), LEAST_COSINE), s > 0.0);
    let once = layers.diffuse * (1.0 + layers.diffuse_roughness * t);
    let again = layers.diffuse_again * max(FACING_LOSS - layers_oren_nayar(incident), 0.0);
    return (once + again + specular) * incident;
}
