//! Regression tests for faulty inputs. `tests/cases/README.md` gives the right result for each; the tests are in one
//! module per kind.

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
