//! The field contract, for every shape, every operator and random trees of both: the sign and the zero set are right,
//! the value is a safe step, it is finite, and bounds enclose. The tests iterate over the enums, so a new variant is
//! covered without a line here, except for its surface in `surfaces`.

mod blends;
mod bricks;
mod drawn;
pub mod modifiers;
mod operators;
mod profiles;
mod rules;
pub mod samples;
mod shapes;
mod surfaces;
mod tightness;
mod tracing;
pub mod trees;
