//! Dynamics far from the start of time and from the origin, and bounds that hold; those of masks.

use glam::{DAffine3, DVec3};

use super::build::{CopyType, flat_instancer};
use super::dynamics::{copy_envelope, copy_motion};
use super::instancer::{FlatDynamic, FlatInstancer, FlatMask};
use super::masks::{copy_masks, copy_masks_most};
use super::variation::copy_of_cell;
use super::walk::copy_sphere;
use isolith_geometry::Aabb;
use isolith_scene::{
    Attachment, CurvePreset, Dynamic, DynamicKind, Instancer, Mask, MaskJoin, MaskSlot, Node, NodeKind, TextureImage,
    Variation,
};

/// A lattice without end of one type.
fn plain_instancer() -> FlatInstancer {
    let instancer = Instancer::grid([0, 1, 0], [1.0; 3]);
    let node = Node::new("Copies", NodeKind::Instancer(Box::new(instancer.clone())));
    let types = [CopyType { weight: 1.0, bounds: Aabb::from_center_half(DVec3::ZERO, DVec3::ONE) }];
    flat_instancer(&node, &instancer, DAffine3::IDENTITY, 0.0, &types, Vec::new(), Vec::new())
}

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

#[test]
fn joins_and_curves_act_in_order_and_their_bounds_hold() {
    let noise = |seed| Mask::Noise { size: 3.0, threshold: 0.5, softness: 0.8, seed };
    let image = Attachment::<TextureImage>::painted("x.png", [4, 2], |x, y| [(64 * x + 30 * y) as u8; 3]);
    let image = MaskSlot::from(Mask::Image { image, width: 8.0, length: 4.0, offset: [1.0, 7.0, -2.0], tiled: false });
    let mut least_bound = 1.0_f64;
    for join in [MaskJoin::Multiply, MaskJoin::Add, MaskJoin::Subtract, MaskJoin::Minimum, MaskJoin::Maximum] {
        for preset in CurvePreset::ALL {
            let first = MaskSlot { curve: preset.curve(), ..noise(1).into() };
            let radius = Mask::Radius { inner: 2.0, outer: 9.0 };
            let second = MaskSlot { join, inverted: preset == CurvePreset::Peak, ..radius.into() };
            let slots = [first, second, MaskSlot { join, ..image.clone() }];
            let masks: Vec<FlatMask> = slots.iter().map(|slot| FlatMask::new(slot, [0; 2])).collect();
            let flat = FlatInstancer { masks, ..plain_instancer() };
            for i in 0..400 {
                let center = DVec3::new(0.37 * f64::from(i % 61) - 11.0, 0.0, 0.53 * f64::from(i % 47) - 12.0);
                let half = DVec3::new(0.02, 0.0, 0.05) * f64::from(1 + i % 9);
                let most = copy_masks_most(&flat, center, half);
                least_bound = least_bound.min(most);
                for k in 0..8 {
                    let off = DVec3::new(f64::from(k % 3) - 1.0, 0.0, f64::from(k / 3) - 1.0);
                    let share = copy_masks(&flat.masks, center + off * half, 1.0);
                    assert!((0.0..=1.0).contains(&share) && share <= most + 1e-9, "{join:?}, {preset:?}: {share}");
                }
            }
        }
    }
    assert_eq!(least_bound, 0.0, "no block is ever empty");
}

/// A placed source, by whether it blows along its direction or outward.
fn placed_wind(radial: f64) -> Dynamic {
    Dynamic::Wind {
        direction: [0.3, 0.0, 1.0],
        angle: 30.0,
        steady: 0.4,
        gust_size: 3.0,
        speed: 5.0,
        softness: 1.0,
        flutter: 3.0,
        frequency: 1.5,
        radius: 8.0,
        source: [4.0, 1.0, -2.0],
        core: 0.25,
        radial,
    }
}

#[test]
fn a_placed_source_blows_within_its_radius_and_outward_if_it_is_radial() {
    let source = DVec3::new(4.0, 1.0, -2.0);
    for radial in [0.0, 0.5, 1.0] {
        let envelope = copy_envelope(&[FlatDynamic::new(&placed_wind(radial), 0.0, 0, 5)]);
        let mut most = 0.0_f64;
        for i in 0..6_000 {
            let [turn, far] = [f64::from(i) * 0.618_034, f64::from(i % 97) * 0.1];
            let way = DVec3::new(turn.sin(), 0.0, turn.cos());
            let dynamic = FlatDynamic::new(&placed_wind(radial), 0.173 * f64::from(i), 0, 5);
            let tilt = |at: DVec3| copy_motion(&[dynamic], 5, [i, 0, 7], at).rotation * DVec3::Y;
            let at = source + way * far;
            let now = tilt(at);
            most = most.max(now.angle_between(DVec3::Y));
            assert!(far < 8.05 || now == DVec3::Y, "wind at {far} m from a source of 8 m");
            // Near the source as well it changes little over a millimeter.
            assert!(now.distance(tilt(at + DVec3::new(1e-3, 0.0, 1e-3))) < 5e-3, "a jump at {far} m");
            let is_outward = now.dot(way) > 0.0 || now.angle_between(DVec3::Y) < 8.0_f64.to_radians();
            assert!(radial < 1.0 || is_outward, "{now} at {way}");
        }
        assert!(most <= envelope.tilt + 1e-9 && most > 0.5 * envelope.tilt, "{most} of {}", envelope.tilt);
    }
}

#[test]
fn gusts_of_a_radial_source_travel_outward() {
    let tilt = |time: f64, far: f64| {
        let mut wind = placed_wind(1.0);
        if let Dynamic::Wind { radius, flutter, .. } = &mut wind {
            (*radius, *flutter) = (0.0, 0.0);
        }
        let at = DVec3::new(4.0 + far, 1.0, -2.0);
        (copy_motion(&[FlatDynamic::new(&wind, time, 0, 5)], 5, [0; 3], at).rotation * DVec3::Y).angle_between(DVec3::Y)
    };
    // Far from the source, where its calm middle does not matter, the same gust arrives later by the way it took.
    for i in 0..100 {
        let time = 0.1 * f64::from(i);
        assert!((tilt(time, 40.0) - tilt(time + 1.0, 45.0)).abs() < 1e-4, "at {time}");
    }
}
