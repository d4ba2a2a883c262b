//! The points that the GPU gets the parameters of components relative to, so that f32 is fine enough for the view.
//! The renderer gets them with the arrays, since it evaluates no field itself.

use std::borrow::Cow;

use glam::DVec3;

use super::arrays::{Component, FlatScene, ParamRow};
use super::eval::field;
use super::moved::move_params;
use isolith_geometry::{Aabb, Camera};

/// The placement of a component relative to the eye.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Standpoint {
    /// See `shaders/common/ray.wgsl`.
    pub ray_origin_depth: f64,
    /// The point that the component's parameters are relative to, from its origin: 0, or near the eye.
    pub shift: DVec3,
    /// The point `ray_origin_depth` in front of the eye, relative to that point.
    pub eye: DVec3,
    /// Most that rounding may move if `shift` is not 0, in meters; 0 otherwise.
    pub most_moved: f64,
}

/// f32 rounds a number by at most this fraction of itself.
const ROUNDING: f64 = 0.5 * f32::EPSILON as f64;
/// Most that rounding may move, in footprints of a pixel.
const MOST_MOVED: f64 = 1.0 / 64.0;
/// If the eye is within the bounds of a component whose field takes more leaves than this, about a millisecond, the
/// component counts as being as near as the near limit allows.
const MOST_EVALUATED: u64 = 1 << 14;
/// Narrower pixels, in radians, are at most 64 roundings of a direction apart.
pub const NARROW: f64 = 64.0 * ROUNDING;

impl Standpoint {
    /// The standpoint for what `camera` sees of the component in a picture of `size` pixels.
    pub fn new(flat: &FlatScene, component: &Component, camera: &Camera, size: [u32; 2]) -> Self {
        if component.instanced.is_some() {
            // Numbers of a copy are relative to the copy, wherever the eye is; rays count from the copy's origin.
            return Self { eye: -component.origin, ..Self::default() };
        }
        let from = camera.position - component.origin;
        let footprint = camera.footprint(size[1].into());
        let ray_origin_depth = if component.bounds.is_finite() {
            ray_origin_depth(&component.bounds.translated(-from), camera, size)
        } else {
            component.half_space.map_or(0.0, |plane| ray_origin_depth_of_plane(plane, from, camera, size))
        };
        let eye = from + camera.rotation * DVec3::NEG_Z * ray_origin_depth;
        let rounding = ROUNDING * eye.length();
        let allowed = |distance: f64| MOST_MOVED * footprint * distance;
        let least = camera.near.max(ray_origin_depth);
        let unmoved = Self { ray_origin_depth, eye, ..Self::default() };
        if rounding <= allowed(least) {
            return unmoved;
        }
        let way = component.bounds.distance(from);
        // Within the bounds, the field is a lower bound of the distance to the surface.
        let is_cheap = u64::from(component.count) * u64::from(component.copies) <= MOST_EVALUATED;
        let way = if way > 0.0 || !is_cheap { way } else { field(flat, component, from) };
        let allowed = allowed(way.max(least));
        if rounding <= allowed {
            return unmoved;
        }
        // On a grid, so that small movements of the eye upload nothing.
        let grid = (allowed / ROUNDING).log2().floor().exp2();
        let shift = (eye / grid).round() * grid;
        Self { ray_origin_depth, shift, eye: eye - shift, most_moved: allowed }
    }

    /// The standpoint of an eye at the component's origin.
    pub fn at_origin() -> Self {
        Self::default()
    }
}

/// Depth of the plane in front of the eye that positions on rays through `bounds` count from; `bounds` are relative
/// to the eye. 0 in pictures that are not narrow.
pub fn ray_origin_depth(bounds: &Aabb, camera: &Camera, size: [u32; 2]) -> f64 {
    if camera.footprint(size[1].into()) >= NARROW {
        return 0.0;
    }
    let forward = camera.rotation * DVec3::NEG_Z;
    settled(bounds.corners().into_iter().map(|corner| corner.dot(forward)).fold(f64::INFINITY, f64::min))
}

/// The same for a component below a plane, see [`Component::half_space`], with the eye at `from`.
fn ray_origin_depth_of_plane([x, y, z, d]: [f64; 4], from: DVec3, camera: &Camera, size: [u32; 2]) -> f64 {
    if camera.footprint(size[1].into()) >= NARROW {
        return 0.0;
    }
    let normal = DVec3::new(x, y, z);
    let height = normal.dot(from) + d;
    let up = camera.tan_half_fov();
    let right = up * f64::from(size[0]) / f64::from(size[1]);
    // Of all rays of the picture one in a corner meets the plane at the least depth.
    let depth = |(x, y): (f64, f64)| {
        let climb = normal.dot(camera.rotation * DVec3::new(x, y, -1.0));
        if climb < 0.0 { -height / climb } else { f64::INFINITY }
    };
    let corners = [(-right, -up), (right, -up), (-right, up), (right, up)];
    settled(corners.into_iter().map(depth).fold(f64::INFINITY, f64::min))
}

/// Slightly less than the least depth, so that no surface is in front of the plane. 0 if there is none.
fn settled(depth: f64) -> f64 {
    if depth > 0.0 && depth.is_finite() { f64::from((depth * (1.0 - 1e-6)) as f32) } else { 0.0 }
}

/// The standpoints of all components, and the parameters relative to them.
#[derive(Debug)]
pub struct Standpoints<'a> {
    /// Parallel to the components.
    pub all: Vec<Standpoint>,
    /// The parameters of the scene, rewritten for components with a standpoint near the eye.
    pub params: Cow<'a, [ParamRow]>,
}

impl<'a> Standpoints<'a> {
    /// The standpoints for a picture of `size` pixels by `camera`.
    pub fn new(flat: &'a FlatScene, camera: &Camera, size: [u32; 2]) -> Self {
        let all: Vec<_> = flat.components.iter().map(|c| Standpoint::new(flat, c, camera, size)).collect();
        let mut params = Cow::Borrowed(&flat.params[..]);
        for (component, at) in flat.components.iter().zip(&all) {
            if at.shift != DVec3::ZERO {
                move_params(flat, component, at.shift, params.to_mut());
            }
        }
        Self { all, params }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flatten;
    use isolith_gallery as gallery;

    #[test]
    fn scenes_that_do_not_need_it_are_given_as_they_are() {
        for (name, scene) in gallery::all() {
            let flat = flatten(&scene, 0.0).unwrap_or_else(|error| panic!("{name}: {error}"));
            let camera = flat.default_camera(&vec![None; flat.meshes.len()], 1.0);
            let found = Standpoints::new(&flat, &camera, [1024, 1024]);
            assert!(matches!(found.params, Cow::Borrowed(_)), "{name}");
            for (component, at) in flat.components.iter().zip(&found.all) {
                // Numbers of a copy are relative to the copy.
                let eye = if component.instanced.is_some() { DVec3::ZERO } else { camera.position };
                assert_eq!(*at, Standpoint { eye: eye - component.origin, ..Standpoint::default() }, "{name}");
            }
        }
    }
}
