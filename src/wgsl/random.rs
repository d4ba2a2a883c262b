//! Pseudorandom numbers for tests.

/// The generator's state.
pub struct Random(pub u64);

impl Random {
    /// A number from 0 to 1.
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A point with coordinates between `-reach` and `reach`.
    pub fn point(&mut self, reach: f64) -> [f64; 3] {
        std::array::from_fn(|_| (2.0 * self.next() - 1.0) * reach)
    }
}
