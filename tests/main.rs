//! One test binary: modules share its build and its helpers.

mod accuracy;
mod agreement;
mod cli;
mod contract;
mod documents;
mod editor;
mod files;
mod golden;
mod gpu;
mod meshes;
mod shaders;
mod tidy;
