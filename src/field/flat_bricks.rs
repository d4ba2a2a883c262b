//! The distance bricks of a scene: each once, one behind the other, however many shapes show them.

use std::sync::Arc;

use isolith_bricks::BrickLevels;

/// All bricks, in the order of first use.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FlatBricks {
    all: Vec<Arc<BrickLevels>>,
}

impl FlatBricks {
    /// The first texel of these bricks, which are added if they are new.
    pub fn place(&mut self, bricks: &Arc<BrickLevels>) -> u32 {
        let mut first = 0;
        for held in &self.all {
            if Arc::ptr_eq(held, bricks) {
                return first;
            }
            first += held.texels() as u32;
        }
        self.all.push(bricks.clone());
        first
    }

    /// The bricks.
    pub fn all(&self) -> &[Arc<BrickLevels>] {
        &self.all
    }

    /// The texel at an index; zero behind the last.
    pub fn texel(&self, index: usize) -> [u32; 4] {
        let mut at = index;
        for run in self.all.iter().flat_map(|levels| levels.runs()) {
            if let Some(texel) = run.get(at) {
                return *texel;
            }
            at -= run.len();
        }
        [0; 4]
    }

    /// The number of texels.
    pub fn texels(&self) -> usize {
        self.all.iter().map(|levels| levels.texels()).sum()
    }
}
