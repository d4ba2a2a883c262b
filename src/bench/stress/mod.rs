//! Numerical stress: every shape, operator and modifier under numerically difficult circumstances, against the
//! reference.
//!
//! | file | what it does |
//! |---|---|
//! | `node` | the node of a case as a scene |
//! | `cases` | nodes by circumstances |
//! | `place` | the view |
//! | `metrics` | a picture against its reference |
//! | `allowed` | how much of a picture may be wrong |
//! | `strip` | picture, reference and difference side by side |
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
