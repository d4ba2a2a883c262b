//! Limits on the size of a text. `work` limits the cost of one glyph.

/// The limit on glyphs of a text: a font can turn one letter into many.
pub const MAX_GLYPHS: usize = 1_024;
/// The limit on arcs of a text's outlines.
pub const MAX_TEXT_ARCS: usize = 32_768;
