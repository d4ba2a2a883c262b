// The view. Positions in every pass are relative to the eye or to a component's origin: world
// coordinates never reach the GPU.

struct View {
    // Half the picture's width at distance 1, to the right.
    right: vec3f,
    near: f32,
    // Half the picture's height at distance 1, upward.
    up: vec3f,
    far: f32,
    // Unit direction of view.
    forward: vec3f,
    // Width of a pixel at distance 1.
    footprint: f32,
    sky: vec3f,
    light_count: u32,
    horizon: vec3f,
    width: u32,
    ambient: vec3f,
    height: u32,
    // Offset from pixel centers to the place of this sample, in pixels; zero for the first sample.
    jitter: vec2f,
    // Factor of the exposure.
    exposure: f32,
    // Of accumulated samples.
    sample_index: u32,
    // 1: the background is without color and coverage.
    transparent: u32,
    // 1: whatever has any opacity covers all samples.
    first_surfaces: u32,
    padding_1: u32,
    padding_2: u32,
}

@group(0) @binding(0) var<uniform> view: View;

// Offset from the picture's center, on the plane at distance 1 before the eye, of a place in the
// picture in pixels. The jitter moves the picture as a whole: what holds for pixel centers holds for
// the rays of every sample.
fn view_offset(place: vec2f) -> vec3f {
    let size = vec2f(f32(view.width), f32(view.height));
    let at = (place + view.jitter) / size * 2.0 - 1.0;
    return view.right * at.x - view.up * at.y;
}

// Unit direction of the ray through the center of a pixel.
fn view_direction(pixel: vec2u) -> vec3f {
    return normalize(view_offset(vec2f(pixel) + 0.5) + view.forward);
}

fn view_contains(pixel: vec2u) -> bool {
    return pixel.x < view.width && pixel.y < view.height;
}
