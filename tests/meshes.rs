//! glTF files: what is read from good ones, and how bad ones are refused. The shipped scenes.

mod asset;
mod broken;
mod escapes;
mod gallery;
mod hostile;
mod mutated;
mod poses;
mod rays;
mod reading;
mod surfaces;
pub mod tiny;
mod watching;
