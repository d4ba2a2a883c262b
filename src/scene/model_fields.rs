//! The shapes of a scene that are made of models: what they ask for, and what they get.

use std::sync::Arc;

use super::{NodeKind, Scene, Shape};
use isolith_bricks::BrickLevels;

/// What a shape of a model is made of.
#[derive(Clone, Debug, PartialEq)]
pub struct ModelRequest {
    /// The file.
    pub path: String,
    /// The clip that poses it; empty for the rest pose.
    pub clip: String,
    /// The moment of the clip, in seconds.
    pub clip_time: f64,
    /// Voxels along the longest side; 0 leaves it to the model.
    pub resolution: f64,
    /// Size of a voxel in meters, instead; 0 for none.
    pub voxel_size: f64,
    /// With the materials of the file.
    pub file_materials: bool,
}

impl Shape {
    /// What it is made of, if it is a model.
    pub fn model_request(&self) -> Option<ModelRequest> {
        match self {
            Self::MeshField { file, clip, clip_time, resolution, voxel_size, file_materials }
                if !file.path.is_empty() =>
            {
                Some(ModelRequest {
                    path: file.path.clone(),
                    clip: clip.clone(),
                    clip_time: *clip_time,
                    resolution: *resolution,
                    voxel_size: *voxel_size,
                    file_materials: *file_materials,
                })
            }
            _ => None,
        }
    }
}

impl Scene {
    /// What its shapes of models are made of, hidden ones included.
    pub fn model_requests(&self) -> Vec<ModelRequest> {
        let mut all = Vec::new();
        for node in self.nodes() {
            if let NodeKind::Object(object) = &node.kind
                && let Some(request) = object.shape.model_request()
                && !all.contains(&request)
            {
                all.push(request);
            }
        }
        all
    }

    /// The same scene with bricks in the shapes of models, where `made` has them.
    pub fn with_bricks(&self, made: &dyn Fn(&ModelRequest) -> Option<Arc<BrickLevels>>) -> Self {
        let mut out = self.clone();
        for node in &mut out.nodes {
            let NodeKind::Object(object) = &node.kind else { continue };
            let Some(bricks) = object.shape.model_request().and_then(|request| made(&request)) else { continue };
            if let NodeKind::Object(object) = &mut Arc::make_mut(node).kind
                && let Shape::MeshField { file, .. } = &mut object.shape
            {
                *file = file.with_bricks(bricks);
            }
        }
        out
    }
}
