//! Light from everywhere, and the background. Counterpart of `shaders/light/environment.wgsl`.

use glam::DVec3;

/// Ambient light: full from above, half from below.
pub fn environment_ambient(normal_y: f64, ambient: DVec3) -> DVec3 {
    ambient * (0.75 + 0.25 * normal_y)
}

/// Color of a ray without a hit; `direction_y` is the height of its unit direction.
pub fn environment_background(direction_y: f64, sky: DVec3, horizon: DVec3) -> DVec3 {
    let height = direction_y.clamp(0.0, 1.0);
    horizon.lerp(sky, height * (2.0 - height))
}
