//! The reference renderer: a picture traced on the processor in f64, and how wrong another picture is against it.
//!
//! | file | what it does |
//! |---|---|
//! | `trace` | rays against the CPU evaluator, with certainty instead of a step limit |
//! | `shade` | light on surfaces, counterpart of `shaders/light` |
//! | `image` | the whole picture by `eval`, `trace` and `shade` |
//! | `accuracy` | how wrong a picture is, against the reference |
//! | `tolerance` | which differences are left to rounding |

pub mod accuracy;
pub mod image;
pub mod shade;
pub mod tolerance;
pub mod trace;
