//! What of the lights and of the environment arrives at a point of a surface. Counterpart of `shaders/shadow.wgsl` and
//! `shaders/light/shares.wgsl`.

use glam::DVec3;

use super::occlusion::{AmbientRay, OCCLUSION_RAYS, Occlusion, occlusion_shares, occlusion_trust};
use super::shadow::{
    ShadowCone, ShadowProof, around_sample, cone_fineness, light_extent, light_passed, light_sample, light_toward,
    shadow_share,
};
use crate::lights::GpuLight;
use crate::mesh_rays::{Meshes, mesh_rays_blocked};
use crate::reference::trace::TraceError;
use crate::scene_eval::{RayLimits, SceneEvaluator, surface_ray};
use isolith_geometry::Ray;

/// Least distance of an evaluation for occlusion, in footprints.
const OCCLUSION_FOOTPRINTS: f64 = 2.0;

/// The shares of lights and environment that arrive.
#[derive(Clone, Debug, PartialEq)]
pub struct Arriving {
    /// The visible share of each light; those beyond the end arrive whole.
    pub shares: Vec<f64>,
    /// Mean free direction.
    pub bent: DVec3,
    /// Visible share of the environment.
    pub visibility: f64,
}

/// A point of a surface that a pixel shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeenPoint {
    /// The eye, in the world.
    pub eye: DVec3,
    /// Relative to the eye.
    pub position: DVec3,
    /// Unit normal.
    pub normal: DVec3,
    /// Width of a pixel there.
    pub footprint: f64,
    /// The pixel.
    pub pixel: [u32; 2],
    /// 0: cones alone. Else the number of the sample: where a cone proves nothing, one ray decides.
    pub sample: u32,
}

impl Arriving {
    /// All light arrives.
    pub fn all(normal: DVec3) -> Self {
        Self { shares: Vec::new(), bent: normal, visibility: 1.0 }
    }

    /// What arrives at a point by the scene's settings.
    ///
    /// # Errors
    /// A ray could not be followed to its end.
    pub fn at(
        evaluator: &mut SceneEvaluator<'_>,
        meshes: &Meshes,
        lights: &[GpuLight],
        point: &SeenPoint,
    ) -> Result<Self, TraceError> {
        let shadowing = evaluator.flat().environment.shadowing;
        let mut arriving = Self::all(point.normal);
        if shadowing.shadows {
            let fineness = cone_fineness(shadowing.shadow_quality);
            for (index, light) in (0..).zip(lights).take_while(|(_, light)| light.cast_shadows == 1) {
                arriving.shares.push(light_share(evaluator, meshes, (light, index), point, fineness)?);
            }
        }
        let shadowed = arriving.shares.len() as u32;
        if shadowing.occlusion {
            let origin = start(point, point.normal);
            let least = OCCLUSION_FOOTPRINTS * point.footprint;
            let radius = shadowing.occlusion_radius;
            let shares = occlusion_shares(evaluator, meshes, origin, point.normal, [radius, least]);
            let Occlusion { bent, visibility } = Occlusion::of_shares(point.normal, &shares);
            arriving.bent =
                point.normal.lerp(bent * visibility, shadowing.occlusion_strength).normalize_or(point.normal);
            let mut visible = visibility;
            if point.sample > 0 {
                let mut of_rays = 0.0;
                for ray in 0..OCCLUSION_RAYS {
                    let unit = around_sample(point.pixel, shadowed, OCCLUSION_RAYS * point.sample + ray);
                    let AmbientRay { direction, shares } = AmbientRay::new(point.normal, &shares, unit);
                    let ray = Ray { origin: start(point, direction), direction };
                    let is_free = evaluator.passed(&ray, RayLimits { near: 0.0, far: radius })? > 0.5
                        && !mesh_rays_blocked(evaluator.flat(), meshes, &ray, 0.0, radius);
                    of_rays += shares[usize::from(is_free)] / f64::from(OCCLUSION_RAYS);
                }
                visible += (of_rays - visible) * occlusion_trust(point.sample);
            }
            arriving.visibility = 1.0 + (visible - 1.0) * shadowing.occlusion_strength;
        }
        Ok(arriving)
    }

    /// The visible share of a light.
    pub fn shadow_share(&self, light: usize) -> f64 {
        self.shares.get(light).copied().unwrap_or(1.0)
    }
}

/// The visible share of a light; 1 if it does not reach the surface anyway.
fn light_share(
    evaluator: &mut SceneEvaluator<'_>,
    meshes: &Meshes,
    (light, index): (&GpuLight, u32),
    point: &SeenPoint,
    fineness: f64,
) -> Result<f64, TraceError> {
    let Some((to_light, distance)) = light_toward(light, point.position) else { return Ok(1.0) };
    if point.normal.dot(to_light) <= 0.0 {
        return Ok(1.0);
    }
    let cone = ShadowCone::new(start(point, to_light), to_light, distance, light_extent(light), point.footprint);
    let cone = ShadowCone { fineness, ..cone };
    // A sample takes a ray to a point of the light; without samples, the meshes are asked along the middle.
    let place = if point.sample == 0 { [0.0; 2] } else { light_sample(point.pixel, index, point.sample) };
    let found = shadow_share(evaluator, &cone);
    let share = if found.proof != ShadowProof::None || point.sample == 0 {
        found.share
    } else {
        light_passed(evaluator, &cone, place)?
    };
    let is_blocked = share > 0.0 && mesh_rays_blocked(evaluator.flat(), meshes, &cone.ray_to(place), 0.0, cone.far);
    Ok(if is_blocked { 0.0 } else { share })
}

fn start(point: &SeenPoint, direction: DVec3) -> DVec3 {
    surface_ray(point.eye + point.position, point.normal, direction, point.footprint).origin
}
