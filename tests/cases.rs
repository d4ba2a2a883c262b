//! Inputs that once went wrong. `tests/cases/README.md` says what is right about each; a module for each kind holds
//! the tests.

mod camera;
mod commands;
mod compiles;
mod editing;
mod files;
mod flattening;
mod images;
mod march;
mod meshes;
mod reference;
mod text;
