//! The pipelines that evaluate components: keys, cache, and prewarming.

pub mod cache;
pub mod evaluators;
pub mod field;
pub mod key;
pub mod prewarm;
pub mod strategy;
