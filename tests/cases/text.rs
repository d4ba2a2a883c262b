//! Letters: shaping, direction, kerning, hostile fonts.
