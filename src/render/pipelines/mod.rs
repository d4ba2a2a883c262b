//! The pipelines that evaluate components: which component shares one, those that are built, and compiling ahead of use.

pub mod cache;
pub mod evaluators;
pub mod field;
pub mod key;
pub mod prewarm;
pub mod strategy;
