//! glTF files: the content read from good ones, the refusal of bad ones, and the shipped scenes.

mod asset;
mod broken;
mod clips;
mod escapes;
mod gallery;
mod gpu_rays;
mod hostile;
mod mutated;
mod poses;
mod rays;
mod reading;
mod surfaces;
pub mod tiny;
mod watching;
