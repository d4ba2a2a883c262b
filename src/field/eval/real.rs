//! The number types that evaluate a field.

use std::ops::{Add, Div, Mul, Neg, Sub};

use glam::DVec3;

/// A number: a plain f64, or one that carries its derivatives. Comparisons use the value only.
pub trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
{
    /// The value without derivatives.
    fn value(self) -> f64;
    /// A constant.
    fn constant(v: f64) -> Self;
    /// A number whose derivatives are known: `v` with the gradient `d` at `p`. `d` is asked for only if it is needed.
    fn known(v: f64, p: [Self; 3], d: impl FnOnce() -> DVec3) -> Self;
    /// The dot product with `row`, plus `shift`: one coordinate of an affine map of `p`, the variable of
    /// differentiation.
    fn coordinate(row: DVec3, shift: f64, p: DVec3) -> Self;
    /// The square root; its derivative at 0 is taken to be 0.
    fn sqrt(self) -> Self;
    /// The sine.
    fn sin(self) -> Self;
    /// The cosine.
    fn cos(self) -> Self;
    /// The angle of the vector (`x`, `self`) from the x axis; its derivative at 0 is taken to be 0.
    fn atan2(self, x: Self) -> Self;

    /// The absolute value.
    fn abs(self) -> Self {
        if self.value() < 0.0 { -self } else { self }
    }

    /// The lesser; `self` where they are equal.
    fn min(self, other: Self) -> Self {
        if other.value() < self.value() { other } else { self }
    }

    /// The greater; `self` where they are equal.
    fn max(self, other: Self) -> Self {
        if other.value() > self.value() { other } else { self }
    }

    /// Itself, or 0 where it is negative.
    fn positive(self) -> Self {
        if self.value() > 0.0 { self } else { Self::constant(0.0) }
    }

    /// Its square.
    fn squared(self) -> Self {
        self * self
    }
}

impl Real for f64 {
    fn value(self) -> f64 {
        self
    }
    fn constant(v: f64) -> Self {
        v
    }
    fn known(v: f64, _: [Self; 3], _: impl FnOnce() -> DVec3) -> Self {
        v
    }
    fn coordinate(row: DVec3, shift: f64, p: DVec3) -> Self {
        row.dot(p) + shift
    }
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    fn sin(self) -> Self {
        f64::sin(self)
    }
    fn cos(self) -> Self {
        f64::cos(self)
    }
    fn atan2(self, x: Self) -> Self {
        f64::atan2(self, x)
    }
}

/// A value with its gradient (forward differentiation).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual {
    /// The value.
    pub v: f64,
    /// Its partial derivatives.
    pub d: DVec3,
}

impl Real for Dual {
    fn value(self) -> f64 {
        self.v
    }
    fn constant(v: f64) -> Self {
        Self { v, d: DVec3::ZERO }
    }
    fn known(v: f64, p: [Self; 3], d: impl FnOnce() -> DVec3) -> Self {
        let d = d();
        Self { v, d: p[0].d * d.x + p[1].d * d.y + p[2].d * d.z }
    }
    fn coordinate(row: DVec3, shift: f64, p: DVec3) -> Self {
        Self { v: row.dot(p) + shift, d: row }
    }
    fn sqrt(self) -> Self {
        let root = self.v.sqrt();
        Self { v: root, d: if root > 0.0 { self.d / (2.0 * root) } else { DVec3::ZERO } }
    }
    fn sin(self) -> Self {
        Self { v: self.v.sin(), d: self.d * self.v.cos() }
    }
    fn cos(self) -> Self {
        Self { v: self.v.cos(), d: self.d * -self.v.sin() }
    }
    fn atan2(self, x: Self) -> Self {
        let square = self.v * self.v + x.v * x.v;
        let d = if square > 0.0 { (self.d * x.v - x.d * self.v) / square } else { DVec3::ZERO };
        Self { v: self.v.atan2(x.v), d }
    }
}

impl Add for Dual {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self { v: self.v + o.v, d: self.d + o.d }
    }
}

impl Sub for Dual {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        Self { v: self.v - o.v, d: self.d - o.d }
    }
}

impl Mul for Dual {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        Self { v: self.v * o.v, d: self.d * o.v + o.d * self.v }
    }
}

impl Div for Dual {
    type Output = Self;
    fn div(self, o: Self) -> Self {
        let v = self.v / o.v;
        Self { v, d: (self.d - o.d * v) / o.v }
    }
}

impl Neg for Dual {
    type Output = Self;
    fn neg(self) -> Self {
        Self { v: -self.v, d: -self.d }
    }
}

impl Add<f64> for Dual {
    type Output = Self;
    fn add(self, o: f64) -> Self {
        Self { v: self.v + o, d: self.d }
    }
}

impl Sub<f64> for Dual {
    type Output = Self;
    fn sub(self, o: f64) -> Self {
        Self { v: self.v - o, d: self.d }
    }
}

impl Mul<f64> for Dual {
    type Output = Self;
    fn mul(self, o: f64) -> Self {
        Self { v: self.v * o, d: self.d * o }
    }
}
