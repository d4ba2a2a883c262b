//! What a picture needs of the pass `shade`. Each combination has a source and pipelines of its own, built when a
//! picture first needs it, so that a scene pays for nothing that it does not use.

use crate::recipe::Pass;
use isolith_field::{FlatMaterial, FlatScene};
use isolith_scene::ViewTransform;
use isolith_wgsl::{Evaluator, OpSet, Options, ShaderError, assemble};

/// What a scene needs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct ShadeFeatures {
    /// The layers of OpenPBR: not every material is by Blinn and Phong.
    pub layers: bool,
}

impl ShadeFeatures {
    /// What a scene with these materials of its meshes needs.
    pub fn new(flat: &FlatScene, of_meshes: &[FlatMaterial]) -> Self {
        let layers = flat.materials.iter().chain(of_meshes).any(|material| material.phong_weight < 1.0);
        Self { layers }
    }

    /// The source of the pass.
    ///
    /// # Errors
    /// A shader file is missing.
    pub fn source(self) -> Result<String, ShaderError> {
        let options = Options { layers: self.layers, ..Options::default() };
        assemble(Pass::Shade.file(), &Evaluator::Interpreter(OpSet::none()), options)
    }
}

/// What the pass writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ShadeOutput {
    /// The picture of a single sample, encoded for the screen.
    Picture(ViewTransform),
    /// The sum of several samples.
    Sum,
}

impl ShadeOutput {
    /// The entry point.
    pub fn entry_point(self) -> &'static str {
        match self {
            Self::Picture(ViewTransform::None) => "shade_fragment",
            Self::Picture(ViewTransform::Agx) => "shade_agx_fragment",
            Self::Picture(ViewTransform::PbrNeutral) => "shade_neutral_fragment",
            Self::Sum => "shade_sample_fragment",
        }
    }
}
