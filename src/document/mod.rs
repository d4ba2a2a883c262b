//! The scene over time.
