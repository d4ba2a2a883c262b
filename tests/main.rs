//! One test binary: modules share its build and its helpers.

mod accuracy;
mod agreement;
mod branching;
mod broken_files;
mod cases;
mod cli;
mod contract;
mod counts;
mod debug_view;
mod documents;
mod drag;
mod editor;
mod files;
mod golden;
mod gpu;
mod meshes;
mod overlay;
mod random_scene;
mod renderer;
mod saving;
mod shaders;
mod strategies;
mod stress;
mod tidy;
mod unflattened;
mod versions;
