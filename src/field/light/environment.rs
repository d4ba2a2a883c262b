//! Light from everywhere, and the background. Counterpart of `shaders/light/environment.wgsl`.

use glam::DVec3;

use super::brdf::{ShadingPoint, brdf_ambient, brdf_environment};
use super::environment_map::PlacedMap;
use crate::FlatScene;

/// The environment of a scene.
#[derive(Clone, Copy, Debug, Default)]
pub struct EnvironmentLight<'a> {
    /// Colors of sky, horizon and ambient light of a gradient.
    pub gradient: [DVec3; 3],
    /// The light of other kinds.
    pub map: Option<&'a PlacedMap>,
}

impl<'a> EnvironmentLight<'a> {
    /// That of the scene.
    pub fn of(flat: &'a FlatScene) -> Self {
        Self { gradient: flat.environment.gradient().map(DVec3::from), map: flat.environment_map.as_ref() }
    }
}

/// Ambient light of a gradient: full from above, half from below.
pub fn environment_ambient(normal_y: f64, ambient: DVec3) -> DVec3 {
    ambient * (0.75 + 0.25 * normal_y)
}

/// The background in a direction.
pub fn environment_background(direction: DVec3, environment: &EnvironmentLight<'_>) -> DVec3 {
    if let Some(placed) = environment.map {
        return placed.map.levels[0].radiance(placed.map_from_world(direction)) * placed.strength;
    }
    let [sky, horizon, _] = environment.gradient;
    let height = direction.y.clamp(0.0, 1.0);
    horizon.lerp(sky, height * (2.0 - height))
}

/// The light of the environment that a surface reflects toward the eye; `free` is the mean direction from which it
/// arrives.
pub fn environment_on(point: &ShadingPoint, environment: &EnvironmentLight<'_>, free: DVec3) -> DVec3 {
    let Some(placed) = environment.map else {
        return brdf_ambient(point) * environment_ambient(free.y, environment.gradient[2]);
    };
    let shares = brdf_environment(point);
    let mirrored = placed.map_from_world(shares.direction);
    let around = (free + shares.lean).normalize();
    let diffuse = shares.diffuse * placed.map.irradiance(placed.map_from_world(around));
    let specular = shares.specular * placed.map.reflected(placed.map_from_world(shares.dominant), shares.roughness);
    let coat = placed.map.reflected(mirrored, shares.coat_roughness) * shares.coat;
    (diffuse + specular + coat) * placed.strength
}
