//! The picture as arrays.
