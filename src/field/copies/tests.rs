//! Dynamics far from the start of time and from the origin, and bounds that hold.

use glam::{DAffine3, DVec3};

use super::build::{CopyType, flat_instancer};
use super::dynamics::{copy_envelope, copy_motion};
use super::instancer::FlatDynamic;
use super::variation::copy_of_cell;
use super::walk::copy_sphere;
use isolith_geometry::Aabb;
use isolith_scene::{DynamicKind, Instancer, Node, NodeKind, Variation};

const TIMES: [f64; 6] = [0.0, 0.37, 1e6, -1e6, 1e6 + 0.5, -0.25];

#[test]
fn motions_are_continuous_at_any_time_and_place() {
    // Steps of 2⁻²⁰ s, which the numbers of seconds above hold exactly.
    let step = 1.0 / f64::from(1 << 20);
    for kind in DynamicKind::ALL {
        for time in TIMES {
            for i in 0..200 {
                let (cell, at) = ([i, -3 * i, 1_000_000 - i], DVec3::new(1e6, 3.0, -0.7 * f64::from(i)));
                let motion = |time: f64| {
                    let dynamic = FlatDynamic::new(&kind.default_dynamic(), time, 0, 5);
                    copy_motion(&[dynamic], 5, cell, at)
                };
                let [a, b] = [motion(time), motion(time + step)];
                let label = kind.label();
                assert!(a.translation.is_finite() && a.rotation.is_finite() && a.scale.is_finite(), "{label}");
                // Nothing moves faster than some ten meters or turns per second.
                assert!(a.translation.distance(b.translation) < 40.0 * step, "{label} jumps at {time}");
                assert!(a.rotation.dot(b.rotation).abs() > 1.0 - (40.0 * step).powi(2), "{label} turns at {time}");
                assert!((a.scale - b.scale).abs() < 40.0 * step, "{label} grows at {time}");
                assert!((a.emission - b.emission).abs() < 40.0 * step, "{label} flashes at {time}");
            }
        }
    }
}

#[test]
fn motions_stay_within_their_envelopes() {
    for kind in DynamicKind::ALL {
        let mut most = [0.0_f64; 3];
        for i in 0..4_000 {
            let dynamic = FlatDynamic::new(&kind.default_dynamic(), 0.173 * f64::from(i), 0, 5);
            let motion = copy_motion(&[dynamic], 5, [i, 0, 7], DVec3::new(0.31 * f64::from(i), 0.0, 2.0));
            let tilt = (motion.rotation * DVec3::Y).angle_between(DVec3::Y);
            most = [most[0].max(motion.translation.length()), most[1].max(motion.scale), most[2].max(tilt)];
        }
        let envelope = copy_envelope(&[FlatDynamic::new(&kind.default_dynamic(), 0.0, 0, 5)]);
        let bounds = [envelope.displacement, envelope.scale, envelope.tilt];
        for (most, bound) in most.into_iter().zip(bounds) {
            assert!(most <= bound + 1e-9, "{kind:?}: {most} beyond {bound}");
            // An envelope without need costs time.
            assert!(bound == 0.0 || most > 0.4 * bound, "{kind:?}: {most} of {bound}");
        }
    }
}

#[test]
fn copies_stay_within_the_reach_of_their_cells() {
    let types =
        [CopyType { weight: 1.0, bounds: Aabb { min: DVec3::new(-0.3, -0.1, -0.2), max: DVec3::new(0.4, 3.0, 0.3) } }];
    for kind in DynamicKind::ALL {
        let variation = Variation {
            looseness: 1.0,
            offset_min: [-0.3, 0.0, 0.0],
            rotation_min: [-5.0, -180.0, 0.0],
            rotation_max: [5.0, 180.0, 3.0],
            scale_max: [1.5, 2.0, 1.5],
            uniform: false,
            ..Variation::default()
        };
        let instancer = Instancer { variation, ..Instancer::grid([0, 1, 0], [2.0; 3]) };
        let node = Node::new("Copies", NodeKind::Instancer(Box::new(instancer.clone()))).moving(kind.default_dynamic());
        for time in TIMES {
            let flat = flat_instancer(&node, &instancer, DAffine3::IDENTITY, time, &types, Vec::new(), Vec::new());
            for i in 0..400 {
                let cell = [i, 0, -2 * i];
                let Some(copy) = copy_of_cell(&flat, cell) else { continue };
                let place = DVec3::from_array(cell.map(f64::from)) * 2.0;
                let corners =
                    types[0].bounds.corners().map(|corner| copy.instancer_from_copy().transform_point3(corner));
                for corner in corners {
                    let off = (corner - place).abs();
                    assert!((off - flat.reach).max_element() < 1e-9, "{kind:?}: {off} beyond {}", flat.reach);
                }
                let (center, radius) = copy_sphere(&flat, &copy);
                assert!(corners.iter().all(|corner| corner.distance(center) <= radius + 1e-9), "{kind:?}");
            }
        }
    }
}
