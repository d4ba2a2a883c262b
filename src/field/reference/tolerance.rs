//! The differences between an image and the reference that rounding explains.

/// The depth error, in pixel footprints, from which a pixel is wrong.
pub const WRONG_DEPTH: f64 = 1.0;
/// Two nodes meet in a pixel if both have the same depth there, within this many footprints.
pub const MEETING: f64 = 0.05;
/// The angle by which rounding turns a ray, in radians: eye, direction, their product and their sum are each rounded
/// to 24 bits.
pub const GRAZING_ANGLE: f64 = 4.0 * f32::EPSILON as f64;
