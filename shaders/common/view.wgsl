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
}

@group(0) @binding(0) var<uniform> view: View;

// Offset from the picture's center, on the plane at distance 1 before the eye, of a place in the
// picture in pixels.
fn view_offset(place: vec2f) -> vec3f {
    let size = vec2f(f32(view.width), f32(view.height));
    let at = place / size * 2.0 - 1.0;
    return view.right * at.x - view.up * at.y;
}

// Unit direction of the ray through the center of a pixel.
fn view_direction(pixel: vec2u) -> vec3f {
    return normalize(view_offset(vec2f(pixel) + 0.5) + view.forward);
}

fn view_contains(pixel: vec2u) -> bool {
    return pixel.x < view.width && pixel.y < view.height;
}
