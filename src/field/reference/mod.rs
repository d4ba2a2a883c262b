//! The reference renderer: traces an image on the CPU in f64, and measures the error of another image against it.
//!
//! | file | content |
//! |---|---|
//! | `trace` | ray tracing by the CPU evaluator, with certainty instead of a step limit |
//! | `shade` | lighting of surfaces, counterpart of `shaders/light` |
//! | `image` | the whole image, by `eval`, `trace` and `shade` |
//! | `accuracy` | the error of an image against the reference |
//! | `tolerance` | the differences that rounding explains |

pub mod accuracy;
pub mod image;
pub mod tolerance;
pub mod trace;
