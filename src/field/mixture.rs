//! The materials of a surface point: up to four, each with its weight. Counterpart of `shaders/common/mixture.wgsl`,
//! which says what happens to further materials.

use glam::DVec3;

use crate::FlatMaterial;
use isolith_scene::limits::MAX_MATERIALS;

/// Most materials of one mixture.
pub const MIXED: usize = 4;

/// The id beside a weight of 0.
const NO_MATERIAL: u32 = 0xffff;
const _: () = assert!(MAX_MATERIALS <= NO_MATERIAL as usize);

/// The weight 1 as stored in 16 bits.
const WHOLE: f64 = 65_535.0;

/// Up to four materials with their weights, see the module.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mixture {
    /// Indices into the materials.
    pub ids: [u32; MIXED],
    /// 0 for an unused place. The sum is 1, or less if a material was left out.
    pub weights: [f64; MIXED],
}

/// A mixture of one material.
pub fn mixture_of(id: u32) -> Mixture {
    let mut mixture = Mixture { ids: [NO_MATERIAL; MIXED], weights: [0.0; MIXED] };
    (mixture.ids[0], mixture.weights[0]) = (id, 1.0);
    mixture
}

/// Adds `weight` of a material. A new one takes the place of the lightest, if it weighs more.
pub fn mixture_add(mut mixture: Mixture, id: u32, weight: f64) -> Mixture {
    if let Some(same) = mixture.ids.iter().position(|held| *held == id) {
        mixture.weights[same] += weight;
        return mixture;
    }
    let least = mixture.weights.into_iter().fold(f64::INFINITY, f64::min);
    let lightest = mixture.weights.iter().position(|held| *held == least);
    if let Some(at) = lightest.filter(|_| weight > least) {
        (mixture.ids[at], mixture.weights[at]) = (id, weight);
    }
    mixture
}

/// Mixes `joins` into `before` with this weight.
pub fn mixture_joined(before: Mixture, joins: Mixture, weight: f64) -> Mixture {
    let left = Mixture { weights: before.weights.map(|held| held * (1.0 - weight)), ..before };
    let added = joins.ids.into_iter().zip(joins.weights);
    added.fold(left, |mixed, (id, held)| mixture_add(mixed, id, held * weight))
}

/// The material that a mixture results in.
pub fn mixture_material(mixture: &Mixture, materials: &[FlatMaterial]) -> SurfaceMaterial {
    let sum: f64 = mixture.weights.iter().sum();
    let mut mixed = SurfaceMaterial::default();
    for (id, weight) in mixture.ids.into_iter().zip(mixture.weights).filter(|(_, weight)| *weight > 0.0) {
        mixed.add(&SurfaceMaterial::from(&materials[id as usize]), weight / sum);
    }
    mixed
}

/// A mixture as the GPU stores it: 16 bits of weight above 16 bits of index.
pub fn mixture_decoded(encoded: [u32; MIXED]) -> Mixture {
    Mixture { ids: encoded.map(|word| word & 0xffff), weights: encoded.map(|word| f64::from(word >> 16) / WHOLE) }
}

/// Declares [`SurfaceMaterial`] with the properties of [`FlatMaterial`]: a mixture adds each by its weight.
macro_rules! surface_material {
    ($($(#[$doc:meta])* $field:ident: $type:ty,)*) => {
        /// A material at a point of a surface; see [`FlatMaterial`].
        #[derive(Clone, Copy, Debug, Default, PartialEq)]
        pub struct SurfaceMaterial {
            $($(#[$doc])* pub $field: $type,)*
        }

        impl SurfaceMaterial {
            /// Adds another material, times `weight`.
            pub fn add(&mut self, other: &Self, weight: f64) {
                $(self.$field += other.$field * weight;)*
            }
        }

        impl From<&FlatMaterial> for SurfaceMaterial {
            fn from(material: &FlatMaterial) -> Self {
                Self { $($field: widened(material.$field),)* }
            }
        }
    };
}

surface_material! {
    /// Base color times its weight.
    base_color: DVec3,
    /// 0 for a dielectric, 1 for a metal.
    metalness: f64,
    /// Tint of the specular reflection.
    specular_color: DVec3,
    /// Strength of the specular reflection.
    specular_weight: f64,
    /// Emitted color times its luminance.
    emission: DVec3,
    /// How much the coat darkens what is below.
    coat_darkening: f64,
    /// Tint of the coat.
    coat_color: DVec3,
    /// Share of the surface under the coat.
    coat_weight: f64,
    /// Roughness of the specular reflection.
    roughness: f64,
    /// Index of refraction.
    ior: f64,
    /// Roughness of the coat.
    coat_roughness: f64,
    /// Index of refraction of the coat.
    coat_ior: f64,
    /// Roughness of the diffuse reflection.
    diffuse_roughness: f64,
    /// Share of the material that is by Blinn and Phong.
    phong_weight: f64,
    /// Strength of the highlight by Blinn and Phong.
    phong_specular: f64,
    /// Its exponent.
    phong_shininess: f64,
}

/// A property in f64.
fn widened<T: Widened>(value: T) -> T::Wide {
    value.wide()
}

/// A property of f32 numbers.
trait Widened {
    /// The same in f64.
    type Wide;

    fn wide(self) -> Self::Wide;
}

impl Widened for f32 {
    type Wide = f64;

    fn wide(self) -> f64 {
        self.into()
    }
}

impl Widened for [f32; 3] {
    type Wide = DVec3;

    fn wide(self) -> DVec3 {
        DVec3::from(self.map(f64::from))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bytemuck::Zeroable as _;

    /// Materials with reflectances of 0 or 1, by the bits of their index.
    fn materials() -> Vec<FlatMaterial> {
        let of = |i: u32| FlatMaterial {
            base_color: [0, 1, 2].map(|bit| (i >> bit & 1) as f32),
            metalness: (i % 2) as f32,
            phong_shininess: 8.0 * i as f32,
            ..FlatMaterial::zeroed()
        };
        (0..8).map(of).collect()
    }

    fn sum(mixture: &Mixture) -> f64 {
        mixture.weights.iter().sum()
    }

    #[test]
    fn one_material_is_itself_and_equal_ones_are_one() {
        let materials = materials();
        for id in 0..8 {
            let joined = mixture_joined(mixture_of(id), mixture_of(id), 0.3);
            for mixture in [mixture_of(id), joined, mixture_joined(mixture_of(7 - id), mixture_of(id), 1.0)] {
                assert_eq!(mixture_material(&mixture, &materials), SurfaceMaterial::from(&materials[id as usize]));
            }
        }
    }

    #[test]
    fn up_to_four_are_mixed_by_their_weights() {
        let materials = materials();
        let four = [1, 2, 4].into_iter().fold(mixture_of(7), |mixed, id| mixture_joined(mixed, mixture_of(id), 0.25));
        assert!((sum(&four) - 1.0).abs() < 1e-15);
        let weight = |id: u32| four.weights[four.ids.iter().position(|held| *held == id).expect("it is held")];
        for (id, meant) in [(4, 0.25), (2, 0.1875), (1, 0.140_625), (7, 0.421_875)] {
            assert!((weight(id) - meant).abs() < 1e-15, "{four:?}");
        }
        let found = mixture_material(&four, &materials).base_color;
        assert!((found - DVec3::new(0.5625, 0.609_375, 0.671_875)).length() < 1e-14, "{found}");
    }

    /// The error that `shaders/common/mixture.wgsl` states.
    #[test]
    fn of_more_than_four_the_lightest_is_left_out_and_no_property_is_off_by_more_than_its_weight() {
        let materials = materials();
        for lightest in [0.01, 0.05, 0.1, 0.19] {
            let other = (1.0 - lightest) / 4.0;
            for place in 0..5 {
                let exact: Vec<f64> = (0..5).map(|i| if i == place { lightest } else { other }).collect();
                // Each joins with the weight that gives its exact weight at the end.
                let mut mixed = mixture_of(1);
                for id in 1..5 {
                    let before: f64 = exact[..=id].iter().sum();
                    mixed = mixture_joined(mixed, mixture_of(id as u32 + 1), exact[id] / before);
                }
                assert!(!mixed.ids.contains(&(place as u32 + 1)), "{place}: {mixed:?}");
                assert!((sum(&mixed) - (1.0 - lightest)).abs() < 1e-12, "{mixed:?}");
                let meant: DVec3 = (0..5).map(|i| SurfaceMaterial::from(&materials[i + 1]).base_color * exact[i]).sum();
                let off = (mixture_material(&mixed, &materials).base_color - meant).abs().max_element();
                assert!(off <= lightest && off > 0.0, "{off} of {lightest}");
            }
        }
    }

    #[test]
    fn what_is_stored_is_read() {
        let stored = mixture_decoded([0x8000_0003, 0x4000_0001, 0x3fff_ffff, 0]);
        assert_eq!(stored.ids, [3, 1, 0xffff, 0]);
        assert!((sum(&stored) - 1.0).abs() < 1e-15 && stored.weights[3] == 0.0, "{stored:?}");
    }
}
