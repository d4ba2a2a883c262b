//! Which differences between a picture and the reference are left to rounding.

/// An error of the depth, in pixel footprints, from which on a pixel is wrong.
pub const WRONG_DEPTH: f64 = 1.0;
/// Two nodes meet in a pixel where both are seen at the same depth, within so many footprints.
pub const MEETING: f64 = 0.05;
/// By how much rounding turns a ray, in radians: the eye, the direction, their product and their sum are each rounded to 24
/// bits.
pub const GRAZING_ANGLE: f64 = 4.0 * f32::EPSILON as f64;
