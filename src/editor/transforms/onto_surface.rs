//! Moving onto the surface under the pointer, as it is or turned to its normal.

use glam::{DQuat, DVec3};

use super::starts::SelectionMotion;
use crate::steps::rounded_point;
use isolith_geometry::Aabb;

/// Whether a move goes onto the surface under the pointer; F changes it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SurfaceSnap {
    /// It follows the pointer.
    #[default]
    Off,
    /// It rests on the surface.
    On,
    /// It rests on the surface, with its Y axis along the normal.
    Aligned,
}

impl SurfaceSnap {
    /// The next one.
    pub fn next(self) -> Self {
        match self {
            Self::Off => Self::On,
            Self::On => Self::Aligned,
            Self::Aligned => Self::Off,
        }
    }

    /// What it does, for the tag beside the pointer.
    pub fn text(self) -> Option<&'static str> {
        match self {
            Self::Off => None,
            Self::On => Some("onto the surface"),
            Self::Aligned => Some("onto the surface, along its normal"),
        }
    }
}

/// A surface is level if it is no steeper than this: cosine of 18 degrees.
const LEVEL: f64 = 0.95;

/// What the selection stands on: its bounds and its direction at the start.
#[derive(Clone, Copy, Debug)]
pub struct Standing {
    /// Its bounds in the world.
    pub bounds: Aabb,
    /// The Y axis of the active node, a unit vector.
    pub up: DVec3,
}

impl Default for Standing {
    fn default() -> Self {
        Self { bounds: Aabb::EMPTY, up: DVec3::Y }
    }
}

impl Standing {
    /// The motion onto a surface with this point and normal: the selection touches it rather than sinks in.
    pub fn motion(
        &self,
        pivot: DVec3,
        [point, normal]: [DVec3; 2],
        snap: SurfaceSnap,
        finest: f64,
    ) -> Option<SelectionMotion> {
        let [center, half] = match self.bounds.is_finite() && !self.bounds.is_empty() {
            true => [self.bounds.center(), self.bounds.half()],
            false => [pivot, DVec3::ZERO],
        };
        let turn = match snap {
            SurfaceSnap::Aligned => DQuat::from_rotation_arc(self.up, normal),
            _ => DQuat::IDENTITY,
        };
        // The direction in which it stands, before the turn.
        let up = match snap {
            SurfaceSnap::Aligned => self.up,
            _ if normal.y > LEVEL => DVec3::Y,
            _ => normal,
        };
        // Exact along an axis; else as far as the ellipsoid within the bounds reaches.
        let base = center - up * (half * up).length();
        let target = rounded_point(point, finest * 1e-3);
        let offset = target - (pivot + turn * (base - pivot));
        offset.is_finite().then_some(SelectionMotion::Onto(turn, offset))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_touches_the_surface_and_follows_its_normal() {
        let standing = Standing {
            bounds: Aabb::from_center_half(DVec3::new(1.0, 2.0, 0.0), DVec3::new(0.5, 1.0, 0.5)),
            up: DVec3::Y,
        };
        let pivot = DVec3::new(1.0, 2.0, 0.0);
        let on = [DVec3::new(4.0, 0.0, -3.0), DVec3::Y];
        let flat = standing.motion(pivot, on, SurfaceSnap::On, 1e-6);
        let wanted = DVec3::new(3.0, -1.0, -3.0);
        assert!(matches!(flat, Some(SelectionMotion::Onto(turn, way))
            if turn == DQuat::IDENTITY && (way - wanted).length() < 1e-9));
        // On a wall its foot touches it.
        let wall = [DVec3::ZERO, DVec3::X];
        let Some(SelectionMotion::Onto(turn, way)) = standing.motion(pivot, wall, SurfaceSnap::Aligned, 1e-6) else {
            panic!("a motion")
        };
        assert!((turn * DVec3::Y - DVec3::X).length() < 1e-9);
        let foot = pivot + turn * (DVec3::new(1.0, 1.0, 0.0) - pivot) + way;
        assert!(foot.length() < 1e-9, "{foot}");
        // As it is, its side touches it.
        let Some(SelectionMotion::Onto(_, way)) = standing.motion(pivot, wall, SurfaceSnap::On, 1e-6) else {
            panic!("a motion")
        };
        assert!((pivot + way).distance(DVec3::X * 0.5) < 1e-9);
        assert_eq!(SurfaceSnap::Off.next().next().next(), SurfaceSnap::Off);
    }
}
