//! stub

use std::sync::Arc;

use glam::DVec3;

use super::{Component, FlatScene};

/// stub
#[derive(Clone, Debug, PartialEq)]
pub struct CellTree {
    /// stub
    pub low: DVec3,
    /// stub
    pub side: f64,
    /// stub
    pub counts: [u32; 3],
    /// stub
    pub words: Vec<[u32; 2]>,
}

impl CellTree {
    /// stub
    pub fn build(_: &FlatScene, _: &Component) -> Self {
        Self { low: DVec3::ZERO, side: 1.0, counts: [1; 3], words: vec![] }
    }
    /// stub
    pub fn mean_length(&self) -> f64 {
        1.0
    }
    /// stub
    pub fn longest(&self) -> u32 {
        1
    }
}

/// stub
#[derive(Debug, Default)]
pub struct Pruner {}

impl Pruner {
    /// stub
    pub fn trees(&mut self, flat: &FlatScene, _: &[bool]) -> Vec<Option<Arc<CellTree>>> {
        vec![None; flat.components.len()]
    }
}
