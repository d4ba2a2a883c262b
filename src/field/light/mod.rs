//! Light and matter in f64, with the same parameters and formulas as `shaders/light/`.
//!
//! | module | what it does |
//! |---|---|
//! | `brdf` | the light that a surface reflects toward the eye |
//! | `lighting` | the sum over all lights |
//! | `area` | lights with a size |
//! | `environment` | light from everywhere, and the background |
//! | `environment_map` | images of it, prepared for lighting |
//! | `display` | linear light to the colors of a screen |

pub mod area;
pub mod brdf;
pub mod display;
pub mod environment;
pub mod environment_map;
pub mod lighting;
