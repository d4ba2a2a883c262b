//! Numerical stress: every shape, operator and modifier where numbers get difficult, against the truth.
//!
//! | file | what it does |
//! |---|---|
//! | `subject` | what is stressed, as a scene |
//! | `cases` | subjects by circumstances |
//! | `place` | where the eye is |
//! | `figures` | a picture against its truth |
//! | `sheet` | the worst cases as pictures |

mod cases;
mod figures;
mod place;
mod sheet;
mod subject;

pub use cases::{Case, cases};
pub use figures::{Allowed, Figures, first_of_each, stress_table, worst_first};
pub use sheet::stress_sheet;
