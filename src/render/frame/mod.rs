//! The frame: its plan of dispatches, and their cost.

pub mod copies_cost;
pub mod cost_model;
pub mod light_tiles;
pub mod plan;
pub mod rect;
