// Light from everywhere, and the background. Counterpart of `src/field/light/environment.rs`.

// Ambient light: full from above, half from below.
fn environment_ambient(normal_y: f32, ambient: vec3f) -> vec3f {
    return ambient * (0.75 + 0.25 * normal_y);
}

// Background color of a ray; `direction_y` is the height of its unit direction.
fn environment_background(direction_y: f32, sky: vec3f, horizon: vec3f) -> vec3f {
    let height = clamp(direction_y, 0.0, 1.0);
    return mix(horizon, sky, height * (2.0 - height));
}
