//! Instancers to begin with: where copies stand, how they differ and how they move, in proportion to their size. All
//! numbers are chosen by eye.

use super::instancer::{Lattice, Mask, Snap, Variation};
use super::{Dynamic, DynamicKind, DynamicSlot, Instancer, MaskSlot, MaterialVariation, Node, NodeKind};

/// A ready-made setting of an instancer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum InstancerPreset {
    /// Grass and flowers without end.
    Meadow,
    /// Trees without end.
    Forest,
    /// People on a place.
    Crowd,
    /// Fish in a ball.
    Shoal,
    /// Rocks in rings.
    AsteroidBelt,
    /// Buildings in blocks without end.
    CityGrid,
}

impl InstancerPreset {
    /// Every preset, in the order of the menu.
    pub const ALL: [Self; 6] =
        [Self::Meadow, Self::Forest, Self::Crowd, Self::Shoal, Self::AsteroidBelt, Self::CityGrid];

    /// Display name.
    pub fn label(self) -> &'static str {
        match self {
            Self::Meadow => "Meadow",
            Self::Forest => "Forest",
            Self::Crowd => "Crowd",
            Self::Shoal => "Shoal",
            Self::AsteroidBelt => "Asteroid belt",
            Self::CityGrid => "City grid",
        }
    }

    /// The help text.
    pub fn help(self) -> &'static str {
        match self {
            Self::Meadow => "Dense, loose and without end, with bare patches, in the wind",
            Self::Forest => "Loose and without end, with clearings, on slopes that are not too steep, in a light wind",
            Self::Crowd => "Loose rows that face one way, with gaps; they step from foot to foot",
            Self::Shoal => "A ball of swimmers that drift with the water",
            Self::AsteroidBelt => "Rings of tumbling rocks of all sizes",
            Self::CityGrid => "Blocks of different heights without end, with open places",
        }
    }

    /// Sets the lattice, the variation, the masks and the dynamics of an instancer whose types are `size` meters wide.
    /// The target, the palette, the seed and everything else stay. Does nothing to other nodes.
    pub fn apply(self, node: &mut Node, size: f64) {
        let NodeKind::Instancer(instancer) = &mut node.kind else { return };
        let size = if size.is_finite() { size.clamp(1e-2, 1e3) } else { 1.0 };
        (instancer.probability, instancer.snap, instancer.align) = (1.0, Snap::Off, 0.0);
        (instancer.variation, instancer.material) = (Variation::default(), MaterialVariation::default());
        let (masks, dynamics) = match self {
            Self::Meadow => meadow(instancer, size),
            Self::Forest => forest(instancer, size),
            Self::Crowd => crowd(instancer, size),
            Self::Shoal => shoal(instancer, size),
            Self::AsteroidBelt => asteroid_belt(instancer, size),
            Self::CityGrid => city_grid(instancer, size),
        };
        instancer.masks = masks.into_iter().map(MaskSlot::from).collect();
        node.dynamics = dynamics.into_iter().map(DynamicSlot::from).collect();
    }
}

type Lists = (Vec<Mask>, Vec<Dynamic>);

/// Copies stand on the target, if there is one.
fn on_target(instancer: &mut Instancer, align: f64) {
    if instancer.target.is_some() {
        (instancer.snap, instancer.align) = (Snap::Down, align);
    }
}

fn noise(size: f64, threshold: f64, softness: f64) -> Mask {
    Mask::Noise { size, threshold, softness, seed: 1 }
}

/// Wind that bends by these angles, with gusts of this size.
fn wind(most: f64, quiver: f64, size: f64) -> Dynamic {
    let mut wind = DynamicKind::Wind.default_dynamic();
    if let Dynamic::Wind { angle, flutter, gust_size, speed, .. } = &mut wind {
        (*angle, *flutter, *gust_size, *speed) = (most, quiver, size, 0.5 * size);
    }
    wind
}

fn meadow(instancer: &mut Instancer, size: f64) -> Lists {
    instancer.lattice = Lattice::Grid { counts: [0, 1, 0], spacing: [0.6 * size, size, 0.6 * size] };
    instancer.variation = Variation {
        looseness: 1.0,
        rotation_min: [-8.0, -180.0, -8.0],
        rotation_max: [8.0, 180.0, 8.0],
        scale_min: [0.6; 3],
        scale_max: [1.3; 3],
        ..Variation::default()
    };
    instancer.material = MaterialVariation { hue: 0.03, value: 0.2, ..MaterialVariation::default() };
    on_target(instancer, 0.5);
    (vec![noise(12.0 * size, 0.35, 0.3)], vec![wind(22.0, 2.0, 20.0 * size)])
}

fn forest(instancer: &mut Instancer, size: f64) -> Lists {
    instancer.lattice = Lattice::Hexagonal { counts: [0, 1, 0], spacing: 1.6 * size, height: size };
    instancer.variation = Variation {
        looseness: 0.8,
        rotation_min: [-3.0, -180.0, -3.0],
        rotation_max: [3.0, 180.0, 3.0],
        scale_min: [0.7; 3],
        scale_max: [1.4; 3],
        ..Variation::default()
    };
    instancer.material = MaterialVariation { hue: 0.02, value: 0.15, ..MaterialVariation::default() };
    on_target(instancer, 0.0);
    let slope = Mask::Slope { from: 25.0, to: 40.0 };
    (vec![slope, noise(20.0 * size, 0.4, 0.15)], vec![wind(4.0, 0.5, 12.0 * size)])
}

fn crowd(instancer: &mut Instancer, size: f64) -> Lists {
    instancer.lattice = Lattice::Grid { counts: [20, 1, 20], spacing: [1.5 * size, size, 1.5 * size] };
    instancer.variation = Variation {
        looseness: 0.5,
        rotation_min: [0.0, -25.0, 0.0],
        rotation_max: [0.0, 25.0, 0.0],
        scale_min: [0.92; 3],
        scale_max: [1.08; 3],
        ..Variation::default()
    };
    instancer.probability = 0.85;
    instancer.material = MaterialVariation { hue: 0.5, saturation: 0.2, value: 0.2, ..MaterialVariation::default() };
    on_target(instancer, 0.0);
    let bob = Dynamic::Bob { amplitude: [0.0, 0.04 * size, 0.0], frequency: 1.2, phase: 0.0, spread: 1.0 };
    let sway = Dynamic::Sway { axis: [0.0, 0.0, 1.0], angle: 3.0, frequency: 0.6, phase: 0.0, spread: 1.0 };
    (Vec::new(), vec![bob, sway])
}

fn shoal(instancer: &mut Instancer, size: f64) -> Lists {
    let spacing = 1.5 * size;
    instancer.lattice = Lattice::Grid { counts: [12, 6, 12], spacing: [spacing; 3] };
    instancer.variation = Variation {
        looseness: 0.9,
        rotation_min: [-10.0; 3],
        rotation_max: [10.0; 3],
        scale_min: [0.7; 3],
        scale_max: [1.2; 3],
        ..Variation::default()
    };
    let mask = Mask::Radius { inner: 3.0 * spacing, outer: 6.0 * spacing };
    let drift = Dynamic::CurlNoise { amplitude: [0.5 * size; 3], size: 8.0 * size, frequency: 0.2 };
    let swim = Dynamic::Sway { axis: [0.0, 1.0, 0.0], angle: 12.0, frequency: 1.5, phase: 0.0, spread: 1.0 };
    (vec![mask], vec![drift, swim])
}

fn asteroid_belt(instancer: &mut Instancer, size: f64) -> Lists {
    instancer.lattice = Lattice::Polar { count: 48, rings: 6, radius: 20.0 * size, spacing: 2.5 * size };
    instancer.variation = Variation {
        offset_min: [-size, -1.5 * size, -size],
        offset_max: [size, 1.5 * size, size],
        rotation_min: [-180.0; 3],
        rotation_max: [180.0; 3],
        scale_min: [0.2; 3],
        scale_max: [1.5; 3],
        ..Variation::default()
    };
    instancer.probability = 0.7;
    instancer.material = MaterialVariation { value: 0.3, roughness: 0.1, ..MaterialVariation::default() };
    (Vec::new(), vec![Dynamic::Spin { axis: [0.3, 1.0, 0.2], frequency: 0.05, phase: 0.0, spread: 1.0 }])
}

fn city_grid(instancer: &mut Instancer, size: f64) -> Lists {
    instancer.lattice = Lattice::Grid { counts: [0, 1, 0], spacing: [1.5 * size, size, 1.5 * size] };
    instancer.variation =
        Variation { scale_min: [0.7, 0.5, 0.7], scale_max: [1.0, 3.0, 1.0], uniform: false, ..Variation::default() };
    instancer.material = MaterialVariation { value: 0.25, ..MaterialVariation::default() };
    on_target(instancer, 0.0);
    (vec![noise(8.0 * size, 0.25, 0.05)], Vec::new())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Group, MaterialId, NodeId, check};

    #[test]
    fn every_preset_is_valid_for_types_of_any_size_and_keeps_the_rest() {
        for preset in InstancerPreset::ALL {
            for size in [0.0, 0.01, 1.0, 1e9, f64::INFINITY] {
                for target in [None, Some(NodeId(7))] {
                    let instancer = Instancer { target, seed: 9, palette: vec![MaterialId(1)], ..Instancer::default() };
                    let mut node = Node::new("x", NodeKind::Instancer(Box::new(instancer)));
                    preset.apply(&mut node, size);
                    assert_eq!(check::node(&node), Ok(()), "{preset:?} of {size}");
                    let NodeKind::Instancer(instancer) = &node.kind else { panic!() };
                    assert_eq!((instancer.target, instancer.seed, instancer.palette.len()), (target, 9, 1));
                    assert!(!(instancer.masks.is_empty() && node.dynamics.is_empty()), "{preset:?}");
                }
            }
        }
    }

    #[test]
    fn a_preset_replaces_what_another_one_has_set_and_leaves_other_nodes_alone() {
        let fresh = || Node::new("x", NodeKind::Instancer(Box::default()));
        for last in InstancerPreset::ALL {
            let mut alone = fresh();
            last.apply(&mut alone, 2.0);
            for first in InstancerPreset::ALL {
                let mut both = fresh();
                first.apply(&mut both, 1.0);
                last.apply(&mut both, 2.0);
                assert_eq!(both, alone, "{first:?} then {last:?}");
            }
        }
        let mut group = Node::new("x", NodeKind::Group(Group::UNION));
        InstancerPreset::Meadow.apply(&mut group, 1.0);
        assert_eq!(group, Node::new("x", NodeKind::Group(Group::UNION)));
    }
}
