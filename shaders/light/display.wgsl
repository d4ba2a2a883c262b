// Linear light to the colors of a screen. Counterpart of `src/field/light/display.rs`, where the
// sources of the formulas are named.

// Encodes linear light as sRGB (IEC 61966-2-1), clamped to 0..1.
fn display_encode(linear: vec3f) -> vec3f {
    let c = clamp(linear, vec3f(0.0), vec3f(1.0));
    return select(1.055 * pow(c, vec3f(1.0 / 2.4)) - 0.055, 12.92 * c, c <= vec3f(0.0031308));
}

// AgX. The result is linear light of a screen.
fn display_agx(scene: vec3f) -> vec3f {
    let inset = vec3f(
        dot(vec3f(0.842479062, 0.0784336, 0.0792237451), scene),
        dot(vec3f(0.0423282423, 0.878468636, 0.0791661275), scene),
        dot(vec3f(0.0423756549, 0.0784336, 0.879142974), scene),
    );
    let stops = log2(max(inset, vec3f(1e-10)));
    let curved = display_agx_curve(clamp((stops + 12.47393) / 16.5, vec3f(0.0), vec3f(1.0)));
    let outset = vec3f(
        dot(vec3f(1.19687901, -0.0980208811, -0.0990297441), curved),
        dot(vec3f(-0.0528968518, 1.15190313, -0.0989611768), curved),
        dot(vec3f(-0.0529716355, -0.0980434501, 1.15107367), curved),
    );
    return pow(max(outset, vec3f(0.0)), vec3f(2.2));
}

// The contrast curve of AgX over a range of 16.5 stops.
fn display_agx_curve(x: vec3f) -> vec3f {
    return ((((((15.5 * x - 40.14) * x + 31.96) * x - 6.868) * x + 0.4298) * x) + 0.1191) * x - 0.00232;
}

// Compression of PBR Neutral starts here, and is lifted by the reflection of a dielectric.
const DISPLAY_NEUTRAL_START: f32 = 0.76;
const DISPLAY_NEUTRAL_LIFT: f32 = 0.04;
const DISPLAY_NEUTRAL_DESATURATION: f32 = 0.15;

// Khronos PBR Neutral. The result is linear light of a screen.
fn display_neutral(scene: vec3f) -> vec3f {
    let least = min(scene.r, min(scene.g, scene.b));
    let color = scene - select(DISPLAY_NEUTRAL_LIFT, least - 6.25 * least * least, least < 2.0 * DISPLAY_NEUTRAL_LIFT);
    let peak = max(color.r, max(color.g, color.b));
    let room = 1.0 - DISPLAY_NEUTRAL_START;
    let compressed = 1.0 - room * room / (max(peak, DISPLAY_NEUTRAL_START) + room - DISPLAY_NEUTRAL_START);
    let white = 1.0 - 1.0 / (DISPLAY_NEUTRAL_DESATURATION * (peak - compressed) + 1.0);
    let bright = mix(color * (compressed / max(peak, DISPLAY_NEUTRAL_START)), vec3f(compressed), white);
    return select(bright, color, peak < DISPLAY_NEUTRAL_START);
}
