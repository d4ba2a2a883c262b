//! Run time against error: measures every scene by every method and reports JSON lines, tables and charts.
//!
//! | file | what it does |
//! |---|---|
//! | `measure` | one scene by one method: times, counts, errors |
//! | `baseline` | the methods |
//! | `row`, `table` | measurements as JSON, CSV and Markdown |
//! | `chart`, `growth`, `frontier` | run time against error, run time against nodes |
//! | `stress` | shapes, operators and modifiers under numerically difficult circumstances |
//! | `canvas`, `axes`, `legend`, `labels`, `marks` | the elements of charts |

mod axes;
mod baseline;
mod canvas;
mod chart;
mod frontier;
mod growth;
mod labels;
mod legend;
mod marks;
mod measure;
mod row;
#[cfg(test)]
mod samples;
mod stress;
mod table;

pub use baseline::Baseline;
pub use chart::time_against_error;
pub use frontier::frontier;
pub use growth::growth;
pub use measure::{Bench, BenchError, BenchScene, ReferenceCache, cpu_time};
pub use row::{BenchRow, NotFinite};
pub use stress::{Allowed, Metrics, StressCase, cases, first_of_each, stress_sheet, stress_table, worst_first};
pub use table::{csv, markdown, noise};
