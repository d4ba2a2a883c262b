//! The two pictures that a renderer keeps.

/// Which picture a frame makes: the editor keeps a coarse one for quick answers beside the full one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Slot {
    /// The picture at full size.
    Full,
    /// The coarse picture.
    Preview,
}
