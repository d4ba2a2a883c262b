//! The pipelines that evaluate components: keys, cache, and prewarming.

pub mod cache;
pub mod evaluators;
pub mod field;
pub mod field_buffers;
pub mod key;
pub mod prewarm;
pub mod shadow;
pub mod strategy;
pub mod veiled;
