//! Light and matter in f64, with the same parameters and formulas as `shaders/light/`.
//!
//! | module | what it does |
//! |---|---|
//! | `brdf` | the light that a surface reflects toward the eye |
//! | `lighting` | the sum over all lights |
//! | `environment` | light from everywhere, and the background |
//! | `display` | linear light to the colors of a screen |
//! | `material_ball` | thumbnails of materials; has no counterpart |

pub mod brdf;
pub mod display;
pub mod environment;
pub mod lighting;
pub mod material_ball;
