//! Scene → arrays.
