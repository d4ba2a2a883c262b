//! The example scenes, made by code.
