//! The animations of a glTF file's JSON.

use super::whole::Whole;

#[derive(Debug, serde::Deserialize)]
pub(super) struct Animation {
    pub name: Option<String>,
    #[serde(default)]
    pub channels: Vec<Channel>,
    #[serde(default)]
    pub samplers: Vec<ClipSampler>,
}

#[derive(Debug, serde::Deserialize)]
pub(super) struct Channel {
    pub sampler: Whole,
    pub target: Target,
}

#[derive(Debug, serde::Deserialize)]
pub(super) struct Target {
    pub node: Option<Whole>,
    pub path: String,
}

#[derive(Debug, serde::Deserialize)]
pub(super) struct ClipSampler {
    pub input: Whole,
    pub output: Whole,
    pub interpolation: Option<String>,
}
