//! Views that a scene keeps, to come back to.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The number of views that a scene keeps.
pub const MAX_BOOKMARKS: usize = 4;
/// Least and greatest distance from the target to the eye, in meters.
const DISTANCES: [f64; 2] = [1e-4, 1e7];
/// Greatest distance of the target from the origin along an axis, in meters.
const FARTHEST: f64 = 1e9;
/// How far from 1 the length of the rotation may be.
const UNIT_TOLERANCE: f64 = 1e-3;

/// A view.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a view in braces")]
pub struct Bookmark {
    /// The center of the orbit.
    pub target: [f64; 3],
    /// From the target to the eye, in meters.
    pub distance: f64,
    /// From the space of the camera to the world: a unit quaternion x, y, z, w.
    pub rotation: [f64; 4],
    /// Full vertical angle of view; degrees in files, radians here.
    #[serde(with = "degrees")]
    #[schemars(with = "f64")]
    pub fov_y: f64,
    /// Whether parallel lines stay parallel.
    #[serde(default)]
    pub orthographic: bool,
}

mod degrees {
    use serde::{Deserialize, Deserializer, Serializer};

    pub fn serialize<S: Serializer>(radians: &f64, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_f64(radians.to_degrees())
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
        f64::deserialize(deserializer).map(f64::to_radians)
    }
}

impl Bookmark {
    /// What is wrong with it, for the user.
    pub fn check(&self) -> Result<(), String> {
        if !self.target.iter().all(|v| v.abs() <= FARTHEST) {
            return Err(format!("its target must be within {FARTHEST:e} m"));
        }
        if !(DISTANCES[0]..=DISTANCES[1]).contains(&self.distance) {
            return Err(format!("its distance must be between {:e} and {:e} m", DISTANCES[0], DISTANCES[1]));
        }
        let length = self.rotation.iter().map(|v| v * v).sum::<f64>().sqrt();
        if !length.is_finite() || (length - 1.0).abs() > UNIT_TOLERANCE {
            return Err("its rotation must be a unit quaternion".into());
        }
        let is_angle = self.fov_y > 0.0 && self.fov_y < std::f64::consts::PI;
        if is_angle { Ok(()) } else { Err("its angle of view must be between 0 and 180 degrees".into()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_view_is_written_in_degrees_and_checked() {
        let rotation = [0.0, 0.0, 0.0, 1.0];
        let good = Bookmark { target: [1.0, 2.0, 3.0], distance: 4.0, rotation, fov_y: 1.0, orthographic: true };
        let text = serde_json::to_string(&good).unwrap();
        assert!(text.contains("57.29"), "{text}");
        let again: Bookmark = serde_json::from_str(&text).unwrap();
        assert!((again.fov_y - 1.0).abs() < 1e-12 && Bookmark { fov_y: 1.0, ..again } == good);
        assert_eq!(good.check(), Ok(()));
        for bad in [
            Bookmark { target: [f64::NAN, 0.0, 0.0], ..good },
            Bookmark { distance: 0.0, ..good },
            Bookmark { distance: f64::INFINITY, ..good },
            Bookmark { rotation: [0.0; 4], ..good },
            Bookmark { fov_y: 4.0, ..good },
        ] {
            assert!(bad.check().is_err(), "{bad:?}");
        }
    }
}
