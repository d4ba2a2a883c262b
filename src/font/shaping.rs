//! From letters to placed glyphs. HarfBuzz's algorithm shapes runs of one direction and script: it composes, joins,
//! replaces, reorders and kerns letters as the font defines. The next font shapes the letters that a font lacks.

use std::collections::HashSet;
use std::ops::Range;

use harfrust::{BufferFlags, Direction, Script, ShapeOptions, UnicodeBuffer, script};
use skrifa::GlyphId;
use unicode_bidi::BidiInfo;

use super::face::Face;

/// A placed glyph.
#[derive(Clone, Copy, Debug)]
pub struct Placed {
    /// The index of its font.
    pub face: usize,
    /// Its index in the font.
    pub glyph: GlyphId,
    /// The position of its origin, in em from the start of the line on the base line.
    pub at: [f64; 2],
    /// The position in the line of the first letter that it represents.
    pub letter: usize,
}

/// A line of glyphs.
#[derive(Debug, Default)]
pub struct Line {
    /// From left to right, unless they overlap.
    pub glyphs: Vec<Placed>,
    /// The width, in em.
    pub width: f64,
}

/// The glyphs of a line of text. `faces` are tried in order; a letter that none of them has appears as the box for
/// unknown letters of the last font but one.
pub fn line(text: &str, faces: &[&Face]) -> Line {
    let bidi = BidiInfo::new(text, None);
    let mut shaping = Shaping { text, faces, line: Line::default() };
    for paragraph in &bidi.paragraphs {
        let (levels, runs) = bidi.visual_runs(paragraph, paragraph.range.clone());
        for run in runs {
            let is_rtl = levels[run.start].is_rtl();
            let mut parts = scripts(text, run);
            if is_rtl {
                parts.reverse();
            }
            for (range, script) in parts {
                shaping.shape(range, is_rtl, script, 0);
            }
        }
    }
    shaping.line
}

/// The script of a letter; `None` for letters common to all scripts.
fn script_of(letter: char) -> Option<Script> {
    let mut buffer = UnicodeBuffer::new();
    buffer.add(letter, 0);
    buffer.guess_segment_properties();
    Some(buffer.script()).filter(|found| *found != script::UNKNOWN)
}

/// The parts of a run, each of one script. Common letters belong to the part before them, at the start of the run to
/// the part after them.
fn scripts(text: &str, run: Range<usize>) -> Vec<(Range<usize>, Option<Script>)> {
    let mut parts: Vec<(Range<usize>, Option<Script>)> = Vec::new();
    for (i, letter) in text[run.clone()].char_indices() {
        let (at, end) = (run.start + i, run.start + i + letter.len_utf8());
        let script = script_of(letter);
        match parts.last_mut() {
            Some((part, of)) if script.is_none() || of.is_none() || script == *of => {
                part.end = end;
                *of = of.or(script);
            }
            _ => parts.push((at..end, script)),
        }
    }
    parts
}

struct Shaping<'a> {
    text: &'a str,
    faces: &'a [&'a Face],
    line: Line,
}

impl Shaping<'_> {
    /// Adds the glyphs of a part of one direction and script. Letters that the font `first` lacks come from the fonts
    /// after it.
    fn shape(&mut self, range: Range<usize>, is_rtl: bool, script: Option<Script>, first: usize) {
        let face = self.faces[first];
        let shaped = face.with_shaper(|shaper| {
            let buffer = self.buffer(&range, is_rtl, script);
            shaper.shape(buffer, ShapeOptions::new())
        });
        let (infos, places) = (shaped.glyph_infos(), shaped.glyph_positions());
        let is_last = first + 1 == self.faces.len();
        // Letters that the font draws with the same glyphs belong together: if one is missing, all come from the next
        // font.
        let mut starts: Vec<usize> = infos.iter().map(|info| info.cluster as usize).collect();
        starts.sort_unstable();
        starts.dedup();
        let lacking = infos.iter().filter(|info| info.glyph_id == 0 && !is_last);
        let missing: HashSet<u32> = lacking.map(|info| info.cluster).collect();
        let mut i = 0;
        while i < infos.len() {
            let count = infos[i..].iter().take_while(|info| missing.contains(&info.cluster)).count();
            if count > 0 {
                let clusters = || infos[i..i + count].iter().map(|info| info.cluster as usize);
                let (low, high) = (clusters().min().unwrap_or(range.start), clusters().max().unwrap_or(range.start));
                let end = starts.get(starts.partition_point(|start| *start <= high)).copied().unwrap_or(range.end);
                self.shape(low..end, is_rtl, script, first + 1);
                i += count;
                continue;
            }
            let letter = infos[i].cluster as usize;
            if infos[i].glyph_id == 0 {
                self.unknown(letter);
            } else {
                let em = face.em();
                let [x, y, advance] =
                    [places[i].x_offset, places[i].y_offset, places[i].x_advance].map(|v| f64::from(v) / em);
                let (glyph, at) = (GlyphId::new(infos[i].glyph_id), [self.line.width + x, y]);
                self.line.glyphs.push(Placed { face: first, glyph, at, letter });
                self.line.width += advance;
            }
            i += 1;
        }
    }

    fn buffer(&self, range: &Range<usize>, is_rtl: bool, script: Option<Script>) -> UnicodeBuffer {
        let mut buffer = UnicodeBuffer::new();
        for (i, letter) in self.text[range.clone()].char_indices() {
            buffer.add(letter, (range.start + i) as u32);
        }
        // The letters around the part affect joining, too.
        buffer.set_pre_context(&self.text[..range.start]);
        buffer.set_post_context(&self.text[range.end..]);
        buffer.set_direction(if is_rtl { Direction::RightToLeft } else { Direction::LeftToRight });
        if let Some(script) = script {
            buffer.set_script(script);
        }
        let mut flags = BufferFlags::REMOVE_DEFAULT_IGNORABLES;
        flags.set(BufferFlags::BEGINNING_OF_TEXT, range.start == 0);
        flags.set(BufferFlags::END_OF_TEXT, range.end == self.text.len());
        buffer.set_flags(flags);
        buffer
    }

    /// A box for a letter that no font has; the same box whatever the first font is.
    fn unknown(&mut self, letter: usize) {
        let face = self.faces.len().saturating_sub(2);
        self.line.glyphs.push(Placed { face, glyph: GlyphId::NOTDEF, at: [self.line.width, 0.0], letter });
        self.line.width += self.faces[face].advance(GlyphId::NOTDEF);
    }
}
