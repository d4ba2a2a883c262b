//! A glTF file whose solid is a shape: its name in the scene, and the bricks that were made of it.

use std::sync::Arc;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::params::{ParamField, ParamValue};
use super::{NodeKind, Scene, Shape};
use isolith_bricks::{Bricks, placeholder};

/// A .gltf or .glb file, relative to the scene's folder, with forward slashes; empty for none. A document holds the name
/// only: [`Scene::with_bricks`] adds what was made of the file.
#[derive(Clone, Debug, Default, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct ModelFile {
    /// The name.
    pub path: String,
    #[serde(skip)]
    made: Option<Arc<Bricks>>,
}

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
}

impl PartialEq for ModelFile {
    fn eq(&self, other: &Self) -> bool {
        let made = |file: &Self| file.made.as_ref().map(Arc::as_ptr);
        self.path == other.path && made(self) == made(other)
    }
}

impl ModelFile {
    /// A file of this name.
    pub fn new(path: impl Into<String>) -> Self {
        Self { path: path.into(), made: None }
    }

    /// The bricks; those of a placeholder if none were made.
    pub fn bricks(&self) -> Arc<Bricks> {
        self.made.clone().unwrap_or_else(placeholder)
    }

    /// Whether bricks were made of it.
    pub fn is_made(&self) -> bool {
        self.made.is_some()
    }
}

impl ParamField for ModelFile {
    const ANIMATABLE: bool = false;

    fn to_value(&self) -> Option<ParamValue> {
        Some(ParamValue::Text(self.path.clone()))
    }

    fn from_value(value: ParamValue) -> Option<Self> {
        if let ParamValue::Text(path) = value { Some(Self::new(path)) } else { None }
    }
}

impl Shape {
    /// What it is made of, if it is a model.
    pub fn model_request(&self) -> Option<ModelRequest> {
        match self {
            Self::MeshField { file, clip, clip_time, resolution, voxel_size } if !file.path.is_empty() => {
                Some(ModelRequest {
                    path: file.path.clone(),
                    clip: clip.clone(),
                    clip_time: *clip_time,
                    resolution: *resolution,
                    voxel_size: *voxel_size,
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
    pub fn with_bricks(&self, made: &dyn Fn(&ModelRequest) -> Option<Arc<Bricks>>) -> Self {
        let mut out = self.clone();
        for node in &mut out.nodes {
            let NodeKind::Object(object) = &node.kind else { continue };
            let Some(bricks) = object.shape.model_request().and_then(|request| made(&request)) else { continue };
            if let NodeKind::Object(object) = &mut Arc::make_mut(node).kind
                && let Shape::MeshField { file, .. } = &mut object.shape
            {
                file.made = Some(bricks);
            }
        }
        out
    }
}
