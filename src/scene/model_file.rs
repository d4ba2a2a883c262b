//! A glTF file whose solid is a shape: its name in the scene, and the bricks that were made of it.

use std::sync::Arc;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::params::{ParamField, ParamValue};
use isolith_bricks::{BrickLevels, placeholder};

/// A .gltf or .glb file, relative to the scene's folder, with forward slashes; empty for none. A document holds the name
/// only: [`super::Scene::with_bricks`] adds what was made of the file.
#[derive(Clone, Debug, Default, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct ModelFile {
    /// The name.
    pub path: String,
    #[serde(skip)]
    made: Option<Arc<BrickLevels>>,
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
    pub fn bricks(&self) -> Arc<BrickLevels> {
        self.made.clone().unwrap_or_else(placeholder)
    }

    /// The same file with these bricks.
    pub fn with_bricks(&self, made: Arc<BrickLevels>) -> Self {
        Self { path: self.path.clone(), made: Some(made) }
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
