//! Run time against error: every scene by every method, measured and drawn.

pub mod measure;
