// How a copy changes the material of its type. Counterpart of `src/field/copies/look.rs`.

#include "common/view.wgsl"
#include "copy/copied.wgsl"

@group(3) @binding(6) var<storage, read> copied: array<vec4i>;

// `copied_material` in `copy/material.wgsl` packs it.
struct CopyLook {
    // Material instead of those of the type; LOOK_KEPT for none.
    replaced: u32,
    roughness: f32,
    hue: f32,
    saturation: f32,
    value: f32,
    emission: f32,
}

const LOOK_KEPT: u32 = 0xffffu;

// The look of the copy that a pixel shows; one that changes nothing if it shows no copy.
fn look_of_pixel(pixel: vec2u, visibility: u32) -> CopyLook {
    let place = copied_place(pixel);
    let words = bitcast<vec4u>(copied[place + 1u]);
    if copied[place].w != bitcast<i32>(visibility + 1u) {
        return CopyLook(LOOK_KEPT, 0.0, 0.0, 1.0, 1.0, 1.0);
    }
    let factors = unpack2x16float(words.z);
    return CopyLook(words.x & 0xffffu, unpack2x16float(words.x).y, bitcast<f32>(words.y), factors.x, factors.y, bitcast<f32>(words.w));
}

// The mixture of a copy: all of one material, if that replaces those of the type.
fn look_mixture(look: CopyLook, encoded: vec4u) -> vec4u {
    return select(encoded, vec4u(look.replaced | 0xffff0000u, 0u, 0u, 0u), look.replaced != LOOK_KEPT);
}

// The material as the copy shows it.
fn look_varied(material: FlatMaterial, look: CopyLook) -> FlatMaterial {
    var varied = material;
    varied.base_color = look_color(material.base_color, look.hue, look.saturation, look.value);
    varied.roughness = clamp(material.roughness + look.roughness, 0.0, 1.0);
    varied.emission = material.emission * look.emission;
    return varied;
}

// A color with its hue turned and its saturation and value scaled (hexcone: Smith, "Color Gamut
// Transform Pairs", 1978).
fn look_color(color: vec3f, hue: f32, saturation: f32, value: f32) -> vec3f {
    let most = max(color.r, max(color.g, color.b));
    let chroma = most - min(color.r, min(color.g, color.b));
    let by = 1.0 / max(chroma, 1e-30);
    var sextant = 4.0 + (color.r - color.g) * by;
    sextant = select(sextant, 2.0 + (color.b - color.r) * by, color.g == most);
    sextant = select(sextant, (color.g - color.b) * by, color.r == most);
    let turned = 6.0 * fract(select(0.0, sextant, chroma > 0.0) / 6.0 + hue);
    let full = clamp(chroma / max(most, 1e-30) * saturation, 0.0, 1.0);
    let k = (vec3f(5.0, 3.0, 1.0) + turned) % 6.0;
    return clamp(most * value, 0.0, 1.0) * (1.0 - full * clamp(min(k, 4.0 - k), vec3f(0.0), vec3f(1.0)));
}
