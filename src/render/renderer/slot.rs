//! The two pictures that a renderer keeps.

/// Selects a picture: the editor keeps a coarse one for quick response beside the full one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Slot {
    /// The picture at full size.
    Full,
    /// The coarse picture.
    Preview,
}
