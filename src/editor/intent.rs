//! Orders that replace the document or end the program.

use std::path::PathBuf;

/// An order that replaces the document or ends the program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Intent {
    /// Start a new scene.
    New,
    /// Ask which file to open.
    Choose,
    /// Open this file.
    Open(PathBuf),
    /// Open the example of this index.
    Example(usize),
    /// Start with the template of this index.
    Template(usize),
    /// Close the window.
    Quit,
}
