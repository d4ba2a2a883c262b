//! Light and matter in f64, with the same parameters and formulas as `shaders/light/`.
//!
//! | module | what it does |
//! |---|---|
//! | `brdf` | the light that a surface reflects toward the eye |
//! | `lighting` | the sum over all lights |
//! | `arriving` | what of the lights and the environment arrives at a point |
//! | `environment` | light from everywhere, and the background |
//! | `shadow` | the visible share of a light, by a signed cone and by rays |
//! | `occlusion` | the visible share of the surroundings, by six cones and by rays |
//! | `display` | linear light to the colors of a screen |

pub mod arriving;
pub mod brdf;
pub mod display;
pub mod environment;
pub mod lighting;
pub mod occlusion;
pub mod shadow;
