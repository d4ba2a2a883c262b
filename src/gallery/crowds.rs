//! Crowds for measurements: many leaves joined by one operator, with or without a blend.

use glam::DVec3;

use super::random_groups::{SplitMix, overview};
use super::scene_builder::{SceneBuilder, blended, cuboid, group, object, sphere, torus};
use isolith_scene::{BlendKernel, Operator, Scene};

/// `leaves` spheres, rounded boxes and tori in one union, in a box that grows with their number: blended, or hard.
pub fn crowd(leaves: usize, is_blended: bool, seed: u64) -> Scene {
    let mut random = SplitMix(seed);
    let mut builder = SceneBuilder::new([0.02, 0.03, 0.055], [0.05, 0.055, 0.075], [0.27, 0.28, 0.32]);
    let clay = builder.phong("Clay", [0.80, 0.42, 0.22], 0.3, 50.0);
    let union = if is_blended {
        blended("Crowd", Operator::Union, BlendKernel::Quadratic, 0.1)
    } else {
        group("Crowd", Operator::Union)
    };
    let parent = builder.add(None, union);
    let reach = 0.36 * (leaves as f64).cbrt();
    for _ in 0..leaves {
        let (name, shape) = match random.below(3) {
            0 => ("Sphere", sphere(random.between(0.14, 0.32))),
            1 => (
                "Box",
                cuboid(random.between(0.22, 0.62), random.between(0.22, 0.62), random.between(0.22, 0.62), 0.04),
            ),
            _ => ("Torus", torus(random.between(0.18, 0.34), random.between(0.05, 0.12))),
        };
        let place = DVec3::from([0; 3].map(|_| random.between(-reach, reach)));
        builder.add(parent, object(name, shape, clay).at(place).rotated(random.rotation()));
    }
    overview(&mut builder, DVec3::splat(reach + 0.4));
    builder.finish()
}

/// `boxes` overlapping rounded boxes in a blended union of radius 0.05.
pub fn boxes(boxes: usize, seed: u64) -> Scene {
    let mut random = SplitMix(seed);
    let mut builder = SceneBuilder::new([0.02, 0.03, 0.055], [0.05, 0.055, 0.075], [0.27, 0.28, 0.32]);
    let clay = builder.phong("Clay", [0.24, 0.40, 0.62], 0.3, 50.0);
    let parent = builder.add(None, blended("Boxes", Operator::Union, BlendKernel::Quadratic, 0.05));
    for _ in 0..boxes {
        let [x, y, z] = [0; 3].map(|_| random.between(0.3, 0.9));
        let place = DVec3::from([0; 3].map(|_| random.between(-1.5, 1.5)));
        builder.add(parent, object("Box", cuboid(x, y, z, 0.05), clay).at(place).rotated(random.rotation()));
    }
    overview(&mut builder, DVec3::splat(1.9));
    builder.finish()
}

/// 1 001 spheres that touch their neighbors on a lattice, in a blended union. Their order is random, since an artist
/// would hardly place them row by row.
pub fn spheres(seed: u64) -> Scene {
    let mut random = SplitMix(seed);
    let mut builder = SceneBuilder::new([0.02, 0.03, 0.055], [0.05, 0.055, 0.075], [0.27, 0.28, 0.32]);
    let clay = builder.phong("Clay", [0.62, 0.30, 0.40], 0.3, 50.0);
    let parent = builder.add(None, blended("Spheres", Operator::Union, BlendKernel::Quadratic, 0.05));
    let mut places: Vec<[usize; 3]> = (0..1001).map(|i| [i % 13, i / 13 % 11, i / 143]).collect();
    for i in (1..places.len()).rev() {
        places.swap(i, random.below(i + 1));
    }
    for [x, y, z] in places {
        let place = (DVec3::new(x as f64, y as f64, z as f64) - DVec3::new(6.0, 5.0, 3.0)) * 0.4;
        builder.add(parent, object("Sphere", sphere(0.2), clay).at(place));
    }
    overview(&mut builder, DVec3::new(2.6, 2.2, 1.4));
    builder.finish()
}
