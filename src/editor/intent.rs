//! What replaces the document or ends the program, as it is ordered.

use std::path::PathBuf;

/// Something that replaces the document or ends the program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Intent {
    /// A new scene.
    New,
    /// Ask which file to open.
    Choose,
    /// Open this file.
    Open(PathBuf),
    /// Open the example of this number.
    Example(usize),
    /// Close the window.
    Quit,
}
