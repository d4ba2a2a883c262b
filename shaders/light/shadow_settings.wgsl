// Settings of shadows and occlusion, and the layout of their shares: per pixel one byte for each
// light, in whole words, then one for each cone of occlusion, and two for the ray of a
// sample.

struct ShadowSettings {
    // Lights with shadows: the first ones.
    lights: u32,
    // Words per pixel.
    stride: u32,
    // 6, or 0 without occlusion.
    cones: u32,
    // 0: cones alone. Else the number of the sample: where a cone proves nothing, one ray decides.
    sample: u32,
    // Least step of a cone in radii.
    fineness: f32,
    occlusion_radius: f32,
    occlusion_strength: f32,
    // Pixels from one with shares of lights to the next, along each axis: 1, or more while something moves.
    spacing: u32,
    // The same for the cones of occlusion.
    cone_spacing: u32,
}

// Words of the state of an unfinished pixel: of its shadows, and again of its occlusion. The last
// ones, those for copies, exist only in scenes with instancers.
const SHADOW_WORDS: u32 = 12u;
const SHADOW_COPIES_WORDS: u32 = 5u;
