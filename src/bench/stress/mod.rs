//! Numerical stress: every shape, operator and modifier where numbers get difficult, against the reference.
//!
//! | file | what it does |
//! |---|---|
//! | `node` | what is stressed, as a scene |
//! | `cases` | nodes by circumstances |
//! | `place` | where the eye is |
//! | `metrics` | a picture against its reference |
//! | `allowed` | how much of it may be wrong |
//! | `strip` | both and their difference as one picture |
//! | `sheet` | the worst cases as pictures |

mod allowed;
mod cases;
mod metrics;
mod node;
mod place;
mod sheet;
mod strip;

pub use allowed::Allowed;
pub use cases::{StressCase, cases};
pub use metrics::{Metrics, first_of_each, stress_table, worst_first};
pub use sheet::stress_sheet;
