//! Joins editor and renderer in one window.
