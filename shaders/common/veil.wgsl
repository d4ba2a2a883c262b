// What a ray may pass: surfaces that are blended, or cut out. Counterpart of `src/field/veil.rs`,
// which explains it. Included by the marches of components that have such surfaces.

#include "common/coverage.wgsl"
#include "common/mixture.wgsl"

@group(2) @binding(10) var<storage, read> materials: array<FlatMaterial>;
#if TEXTURES
@group(2) @binding(11) var<storage, read> placed_textures: array<GpuPlacedTextures>;
@group(2) @binding(12) var<storage, read> texture_sets: array<TextureSet>;
@group(2) @binding(13) var texels: texture_storage_2d<r32uint, read>;
#end

#include "light/material.wgsl"
#if TEXTURES
#include "light/textured_opacity.wgsl"
#end

// Surfaces that a ray passes in one dispatch; the next one continues it.
const VEILS_AT_ONCE: u32 = 64u;
// Distance behind a surface at which a ray that passes it continues, in footprints: more than the
// accepted error of a hit.
const VEIL_STEP: f32 = 0.1;
// See the CPU's constant of this name.
const CUT_FOOTPRINT: f32 = 0.25;

#if TEXTURES
// The surface as the eye sees it, and in the space of the copy that shows it.
var<private> veil_seen: TexturedPoint;
var<private> veil_there: TexturedPoint;

// The surface at `t`; `gradient`, in the world, may have any length.
fn veil_point(direction: vec3f, t: f32, gradient: vec3f) -> TexturedPoint {
    let steep = length(gradient);
    let normal = select(-direction, gradient / max(steep, 1e-30), steep > 0.0);
    return textured_point(direction, t, normal, view.footprint);
}

#end
// Where a ray continues behind a surface at `t`.
fn veil_behind(t: f32, reach: f32) -> f32 {
    return t + max(VEIL_STEP * view.footprint * t, 8.0 * SPACING * (t + reach));
}

// The opacity of a surface with these materials, at `veil_seen` if they have textures.
fn veil_opacity(mixture: Mixture) -> f32 {
    var sum = 0.0;
    var whole = 0.0;
    for (var i = 0u; i < 4u; i += 1u) {
        let weight = mixture.weights[i];
        if weight <= 0.0 {
            continue;
        }
        let material = materials[mixture.ids[i]];
        let is_cut = material.opacity_threshold > 0.0;
        var opacity = material.opacity;
#if TEXTURES
        opacity = textured_opacity(opacity, mixture.ids[i], select(1.0, CUT_FOOTPRINT, is_cut));
#end
        opacity = select(opacity, select(0.0, 1.0, opacity >= material.opacity_threshold), is_cut);
        sum += opacity * weight;
        whole += weight;
    }
    return sum / max(whole, 1e-30);
}

// Whether a surface of this opacity covers the sample of the pixel. `layer`: which of the surfaces of
// the component it is.
fn veil_covers(opacity: f32, pixel: vec2u, layer: u32) -> bool {
    let threshold = coverage_threshold(pixel, view.sample_index, coverage_hash(dispatch.component) + layer);
    return opacity > select(threshold, 0.0, view.first_surfaces == 1u);
}
