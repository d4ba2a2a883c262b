//! Random scenes for measurements: groups of eight blended leaves, scattered in a box.

use glam::{DQuat, DVec3};

use super::scene_builder::{SceneBuilder, blended, cuboid, group, object, sphere, torus};
use isolith_scene::{BlendKernel, Operator, Scene};

/// Leaves per group.
const GROUP_LEAVES: usize = 8;
/// Distance between the positions of neighboring groups, in meters.
const SPACING: f64 = 1.5;

/// A scene of `leaves / 8` groups, each of eight shapes (sphere, rounded box, torus) in a blended union; with the group
/// around all, 9/8 leaves + 1 nodes. The same arguments give the same scene on every machine.
pub fn random(leaves: usize, seed: u64) -> Scene {
    let mut random = SplitMix(seed);
    let mut builder = SceneBuilder::new([0.02, 0.03, 0.055], [0.05, 0.055, 0.075], [0.27, 0.28, 0.32]);
    let palette = [
        ("Coral", [0.80, 0.16, 0.085]),
        ("Amber", [0.84, 0.42, 0.045]),
        ("Cream", [0.83, 0.73, 0.55]),
        ("Moss", [0.24, 0.40, 0.085]),
        ("Teal", [0.030, 0.32, 0.32]),
        ("Sky", [0.20, 0.48, 0.80]),
        ("Indigo", [0.070, 0.085, 0.42]),
        ("Plum", [0.34, 0.055, 0.25]),
    ];
    let materials = palette.map(|(name, albedo)| builder.phong(name, albedo, 0.3, 50.0));
    let groups = leaves.div_ceil(GROUP_LEAVES);
    let cells = cells(groups);
    let all = builder.add(None, group("All", Operator::Union));
    for index in 0..groups {
        let cell = [index % cells[0], index / cells[0] % cells[1], index / cells[0] / cells[1]];
        let place: [f64; 3] = std::array::from_fn(|axis| {
            let middle = (cells[axis] as f64 - 1.0) * 0.5;
            (cell[axis] as f64 - middle + random.between(-0.22, 0.22)) * SPACING
        });
        let kernels = [BlendKernel::Circular, BlendKernel::Quadratic, BlendKernel::Cubic];
        let kernel = kernels[random.below(kernels.len())];
        let radius = random.between(0.08, 0.22);
        let node = blended(&format!("Group {}", index + 1), Operator::Union, kernel, radius);
        let id = builder.add(all, node.at(place.into()));
        let tints = [random.below(palette.len()), random.below(palette.len())];
        for _ in 0..GROUP_LEAVES.min(leaves - index * GROUP_LEAVES) {
            let (name, shape) = match random.below(3) {
                0 => ("Sphere", sphere(random.between(0.14, 0.32))),
                1 => {
                    let [x, y, z] = [0; 3].map(|_| random.between(0.22, 0.62));
                    ("Box", cuboid(x, y, z, random.between(0.02, 0.09)))
                }
                _ => ("Torus", torus(random.between(0.18, 0.34), random.between(0.05, 0.12))),
            };
            let material = materials[tints[random.below(2)]];
            let place = DVec3::from([0; 3].map(|_| random.between(-0.44, 0.44)));
            builder.add(id, object(name, shape, material).at(place).rotated(random.rotation()));
        }
    }
    light_and_frame(&mut builder, cells);
    builder.finish()
}

/// Number of positions along each axis: as even as powers of two allow, widest along X.
fn cells(groups: usize) -> [usize; 3] {
    let mut cells = [1, 1, 1];
    for axis in [0, 1, 0, 2, 1, 2].into_iter().cycle() {
        if cells.iter().product::<usize>() >= groups {
            break;
        }
        cells[axis] *= 2;
    }
    cells
}

fn light_and_frame(builder: &mut SceneBuilder, cells: [usize; 3]) {
    overview(builder, DVec3::from(cells.map(|c| (c as f64 - 1.0) * 0.5 * SPACING + 0.85)));
}

/// Three lights, and a camera that sees a box of this half extent around the origin.
pub(super) fn overview(builder: &mut SceneBuilder, half: DVec3) {
    builder.sun("Key", [-0.6, 0.8, 0.8], [1.0, 0.95, 0.88], 1.0);
    builder.sun("Fill", [1.0, 0.2, 0.4], [0.65, 0.80, 1.0], 0.32);
    builder.sun("Rim", [0.3, 0.5, -1.0], [1.0, 0.9, 0.8], 0.6);
    let direction = DVec3::new(-0.42, 0.38, 1.0).normalize();
    let position = direction * half.length() * 2.55;
    builder.camera(position.to_array(), [0.0; 3], 36.0);
}

/// SplitMix64 (Steele, Lea and Flood, "Fast splittable pseudorandom number generators", 2014).
pub(super) struct SplitMix(pub(super) u64);

impl SplitMix {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in [0, 1).
    pub(super) fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Uniform between the two, rounded to three decimals, so that the file stays readable.
    pub(super) fn between(&mut self, low: f64, high: f64) -> f64 {
        ((low + (high - low) * self.unit()) * 1e3).round() / 1e3
    }

    pub(super) fn below(&mut self, count: usize) -> usize {
        ((self.unit() * count as f64) as usize).min(count - 1)
    }

    /// A rotation with every orientation equally likely: a random direction of four numbers from the unit ball.
    pub(super) fn rotation(&mut self) -> DQuat {
        loop {
            let q = [0; 4].map(|_| self.between(-1.0, 1.0));
            let length_squared: f64 = q.iter().map(|c| c * c).sum();
            if (0.01..=1.0).contains(&length_squared) {
                return DQuat::from_array(q).normalize();
            }
        }
    }
}
