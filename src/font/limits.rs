//! How much a text may become. What one glyph costs is limited in `work`.

/// Most glyphs that a text may become: fonts can make many of one letter.
pub const MAX_GLYPHS: usize = 1_024;
/// Most arcs that the outlines of a text may take.
pub const MAX_TEXT_ARCS: usize = 32_768;
