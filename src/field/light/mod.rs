//! Light and matter in f64, with the same parameters and formulas as `shaders/light/`.
//!
//! | module | what it does |
//! |---|---|
//! | `brdf` | the light that a surface reflects toward the eye |
//! | `layers` | the layers of OpenPBR |
//! | `albedo` | the light that a GGX lobe reflects in all |
//! | `lighting` | the sum over all lights |
//! | `area` | lights with a size |
//! | `arriving` | what of the lights and the environment arrives at a point |
//! | `shadow` | the visible share of a light, by a signed cone and by rays |
//! | `occlusion` | the visible share of the environment, by six cones and by rays |
//! | `environment` | light from everywhere, and the background |
//! | `environment_map` | images of it, prepared for lighting |
//! | `texture` | colors and values that vary over a surface |
//! | `display` | linear light to the colors of a screen |
//! | `material_ball` | thumbnails of materials; has no counterpart |

pub mod albedo;
pub mod area;
pub mod arriving;
pub mod brdf;
pub mod display;
#[cfg(test)]
mod energy;
pub mod environment;
pub mod environment_map;
#[cfg(test)]
mod flip;
pub mod layers;
pub mod lighting;
#[cfg(test)]
mod lobes;
pub mod material_ball;
pub mod model_look;
pub mod occlusion;
pub mod shadow;
#[cfg(test)]
mod sphere;
pub mod texture;
#[cfg(test)]
mod walk;
