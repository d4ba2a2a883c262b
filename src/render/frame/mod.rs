//! What a frame does: its dispatches, what they cost, and the points that its coordinates are relative to.

pub mod cost_model;
pub mod plan;
