//! Rays through the copies of one type.

use std::ops::ControlFlow;

use glam::{DMat3, DVec3};

use super::eval::world_from_copy;
use super::variation::Copy;
use super::walk::{CopyCone, copies_along};
use crate::ray_limits::RayLimits;
use crate::{Component, FlatScene};
use isolith_geometry::Ray;

/// A ray in the space of a copy, with the factor from lengths of the world to lengths there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CopyRay {
    /// The ray, its direction of unit length.
    pub ray: Ray,
    /// Length there per length in the world.
    pub stretch: f64,
    /// Directions there from those of the world.
    space: DMat3,
    /// Upper bound of the factor on any length, per stretch.
    most: f64,
}

/// A cone that is more than this times as wide along one axis as along another is widened for proofs.
const ROUND: f64 = 1.0001;
/// The most that the radius of a widened cone grows by per distance: as an angle, sine and tangent.
const WIDEST: f64 = 0.99;

/// The same numbers are in `copies_cone` and `copies_enter` of `shaders/scene/copies.wgsl`.
impl CopyRay {
    /// Radius per distance of a round cone around the ray that holds the image of one with the radius `spread` per
    /// distance in the world.
    pub fn widened(&self, spread: f64) -> f64 {
        if self.most <= ROUND {
            return spread;
        }
        let sine = (spread * self.most).min(WIDEST);
        sine / (1.0 - sine * sine).sqrt()
    }

    /// Factor on the radius per distance of a cone in the world for the disc of the area of its section there.
    pub fn mean_size(&self) -> f64 {
        if self.most <= ROUND { 1.0 } else { (self.space.determinant().abs() / self.stretch).sqrt() / self.stretch }
    }

    /// Length there, per length in the world, at right angles to a plane of this unit normal.
    pub fn across(&self, normal: DVec3) -> f64 {
        (self.space.inverse().transpose() * normal).length().recip()
    }
}

/// The ray in the space of a copy.
pub fn copy_ray(flat: &FlatScene, component: &Component, copy: &Copy, ray: &Ray) -> CopyRay {
    let instancer = component.instanced.map(|of| &flat.instancers[of.instancer as usize]);
    let instancer = instancer.expect("the component has copies");
    let copy_from_world = world_from_copy(instancer, copy).inverse();
    let direction = copy_from_world.transform_vector3(ray.direction);
    let stretch = direction.length();
    CopyRay {
        ray: Ray { origin: copy_from_world.transform_point3(ray.origin), direction: direction / stretch },
        stretch,
        space: copy_from_world.matrix3,
        most: (instancer.least_scale() * copy.scale.min_element() * stretch).recip(),
    }
}

/// Visits the copies of `component`'s type that a cone around a ray of the world may meet, with the stretch of the ray.
/// `visit` returns the new end of the range, or breaks off.
pub fn visit_copies(
    flat: &FlatScene,
    component: &Component,
    ray: &Ray,
    limits: RayLimits,
    spread: f64,
    visit: &mut dyn FnMut(&Copy, RayLimits) -> ControlFlow<(), f64>,
) {
    let Some(of) = component.instanced else { return };
    let instancer = &flat.instancers[of.instancer as usize];
    let local_from_world = instancer.world_from_local.inverse();
    let direction: DVec3 = local_from_world.transform_vector3(ray.direction);
    let axis = Ray { origin: local_from_world.transform_point3(ray.origin), direction };
    let cone = CopyCone { axis, limits, spread: spread / instancer.least_scale() };
    copies_along(instancer, cone, &mut |met, limits| {
        if met.copy.kind != of.kind {
            return ControlFlow::Continue(());
        }
        limits.far = limits.far.min(visit(&met.copy, RayLimits { near: met.entry, far: met.exit })?);
        ControlFlow::Continue(())
    });
}
