// How the material of a copy differs from that of its type. Counterpart of `copy_material` in
// `src/field/copies/variation.rs`.

#include "copy/variation.wgsl"

struct CopyMaterial {
    // Index of the material instead of that of the type; COPY_ABSENT for none.
    replaced: u32,
    // Added to the hue, in rounds.
    hue: f32,
    // Factors.
    saturation: f32,
    value: f32,
    // Added to the roughness.
    roughness: f32,
    // Factor.
    emission: f32,
}

// The four words of a pixel for `shade`.
fn copied_material(material: CopyMaterial) -> vec4u {
    return vec4u(
        (material.replaced & 0xffffu) | (pack2x16float(vec2f(0.0, material.roughness)) & 0xffff0000u),
        bitcast<u32>(material.hue),
        pack2x16float(vec2f(material.saturation, material.value)),
        bitcast<u32>(material.emission),
    );
}

fn copy_material(copy: Copy) -> CopyMaterial {
    let color = 2.0 * copy_randoms(instancer.seed, copy.cell, CHANNEL_COLOR) - 1.0;
    let surface = copy_randoms(instancer.seed, copy.cell, CHANNEL_SURFACE);
    let choice = copy_randoms(instancer.seed, copy.cell, CHANNEL_CHOICE).z;
    let entry = u32(choice * f32(instancer.palette_count));
    return CopyMaterial(
        select(COPY_ABSENT, instancer.palette[entry / 4u][entry % 4u], instancer.palette_count > 0u),
        instancer.hue * color.x + copy.hue,
        1.0 + instancer.saturation * color.y,
        1.0 + instancer.value * color.z,
        instancer.roughness * (2.0 * surface.x - 1.0),
        (1.0 - instancer.emission * surface.y) * copy.emission,
    );
}
