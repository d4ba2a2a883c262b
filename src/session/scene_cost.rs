//! What a picture takes, as measured.

use std::path::PathBuf;

use isolith_field::Shading;
use isolith_geometry::Camera;
use isolith_scene::{NodeId, Scene};

/// What is measured.
#[derive(Clone, Debug)]
pub struct MeasuredView {
    /// The scene, at rest.
    pub scene: Scene,
    /// The folder of its models.
    pub folder: Option<PathBuf>,
    /// The moment, in seconds.
    pub time: f64,
    /// The view.
    pub camera: Camera,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// How it is lit.
    pub shading: Shading,
}

/// What the nodes take that are evaluated together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NodeCost {
    /// The innermost node that holds all of them, or the first of several that were put together because they are small.
    pub node: NodeId,
    /// Number of further nodes, in that case.
    pub others: usize,
    /// How often their field is evaluated, by rays and cones.
    pub evaluations: u64,
    /// Shapes, modifiers and groups that these evaluations read.
    pub entries: u64,
}

/// What a pass of the renderer takes.
#[derive(Clone, Debug, PartialEq)]
pub struct PassCost {
    /// Its name, that of its shader.
    pub name: &'static str,
    /// Time on the device, in seconds.
    pub seconds: f64,
}

/// What a picture takes, see the module.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneCost {
    /// Width and height of the picture in pixels.
    pub size: [u32; 2],
    /// Time for one picture of one sample, in seconds.
    pub seconds: f64,
    /// The nodes, those that read most first.
    pub nodes: Vec<NodeCost>,
    /// The passes, in the order of a frame; empty if the device has no clock.
    pub passes: Vec<PassCost>,
    /// The adapter.
    pub adapter: String,
}

impl SceneCost {
    /// Share of a node in all that is read, 0 to 1.
    pub fn share(&self, of: &NodeCost) -> f64 {
        let all: u64 = self.nodes.iter().map(|node| node.entries).sum();
        of.entries as f64 / all.max(1) as f64
    }

    /// Evaluations per pixel of a node.
    pub fn per_pixel(&self, of: &NodeCost) -> f64 {
        let [width, height] = self.size.map(f64::from);
        of.evaluations as f64 / (width * height)
    }
}
