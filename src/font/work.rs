//! Counts the cost of fonts before drawing. A file of a few hundred bytes can describe a letter of a billion points:
//! glyphs consist of other glyphs, programs call programs, and tables share what they refer to.

use std::cell::Cell;
use std::collections::HashMap;

use skrifa::raw::ps::cff::CffFontRef;
use skrifa::raw::ps::cff::blend::BlendState;
use skrifa::raw::ps::cff::index::Index;
use skrifa::raw::ps::cs::{CharstringContext, CharstringKind, CommandSink, evaluate};
use skrifa::raw::ps::error::Error;
use skrifa::raw::tables::glyf::Glyph;
use skrifa::raw::types::Fixed;
use skrifa::raw::{FontRef, TableProvider};
use skrifa::{GlyphId, Tag};

/// The limit on points and parts of a TrueType glyph, each part counted with all of its own parts.
pub const MAX_GLYPH_POINTS: usize = 32_768;
/// The limit on the nesting of parts in a TrueType glyph.
const MAX_PARTS_DEPTH: usize = 16;
/// The limit on bytes of the programs that draw a PostScript glyph, each call counted.
pub const MAX_GLYPH_PROGRAM: usize = 1 << 18;
/// The limit on entries of the tables that define joining and kerning of letters, with shared entries counted each
/// time. Of 570 fonts of Debian the largest has 150 620.
pub const MAX_LAYOUT_ENTRIES: usize = 1_000_000;

/// Checks that a TrueType glyph is small enough to be drawn; the error is the reason.
pub fn of_parts(font: &FontRef<'_>, glyph: GlyphId) -> Result<(), String> {
    Parts { font, known: HashMap::new(), steps: 0 }.points(glyph, 0).map(drop)
}

struct Parts<'a, 'f> {
    font: &'a FontRef<'f>,
    /// The point counts of known glyphs; `None` while the count is in progress.
    known: HashMap<GlyphId, Option<usize>>,
    steps: usize,
}

impl Parts<'_, '_> {
    fn points(&mut self, glyph: GlyphId, depth: usize) -> Result<usize, String> {
        let id = glyph.to_u32();
        match self.known.get(&glyph) {
            Some(Some(points)) => return Ok(*points),
            Some(None) => return Err(format!("its glyph {id} is a part of itself")),
            None => {}
        }
        if depth > MAX_PARTS_DEPTH {
            return Err(format!("its glyph {id} is a part of a part, more than {MAX_PARTS_DEPTH} deep"));
        }
        self.known.insert(glyph, None);
        let (Ok(loca), Ok(glyf)) = (self.font.loca(None), self.font.glyf()) else { return Ok(0) };
        let mut points = match loca.get_glyf(glyph, &glyf) {
            Ok(Some(Glyph::Simple(simple))) => simple.num_points(),
            Ok(Some(Glyph::Composite(whole))) => {
                let mut sum: usize = 0;
                for (part, _) in whole.component_glyphs_and_flags() {
                    self.steps += 1;
                    sum = sum.saturating_add(1 + self.points(part.into(), depth + 1)?);
                    if self.steps > MAX_GLYPH_POINTS || sum > MAX_GLYPH_POINTS {
                        break;
                    }
                }
                sum
            }
            _ => 0,
        };
        if self.steps > MAX_GLYPH_POINTS {
            points = usize::MAX;
        }
        if points > MAX_GLYPH_POINTS {
            return Err(format!("its glyph {id} is made of more than {MAX_GLYPH_POINTS} points"));
        }
        self.known.insert(glyph, Some(points));
        Ok(points)
    }
}

/// Checks that the programs of a PostScript glyph are short enough to be run; the error is the reason. Damaged
/// programs are left to the code that draws them.
pub fn of_programs(cff: &CffFontRef<'_>, glyph: GlyphId) -> Result<(), String> {
    let counted = || -> Result<usize, Error> {
        let subfont = cff.subfont(cff.subfont_index(glyph).unwrap_or(0), &[])?;
        let is_cff2 = cff.version() == 2;
        let subrs = match subfont.subrs_offset() {
            0 => Index::Empty,
            offset => Index::new(cff.data().get(offset as usize..).unwrap_or_default(), is_cff2)?,
        };
        let blend = cff.var_store().and_then(|store| BlendState::new(store.clone(), &[], subfont.vs_index()).ok());
        let program = cff.charstrings().get(glyph.to_u32() as usize)?;
        let spent = Cell::new(program.len());
        let font = (cff.data(), cff.charstrings(), cff.global_subrs(), &subrs);
        let programs = Programs { font, spent: &spent };
        if program.len() <= MAX_GLYPH_PROGRAM {
            // An error means the end of the budget, or of the program.
            let _ = evaluate(&programs, blend, program, &mut Nothing);
        }
        Ok(spent.get())
    };
    match counted() {
        Ok(spent) if spent > MAX_GLYPH_PROGRAM => {
            let id = glyph.to_u32();
            Err(format!("the programs of its glyph {id} run over more than {} KiB", MAX_GLYPH_PROGRAM >> 10))
        }
        _ => Ok(()),
    }
}

/// Hands out programs until the budget is spent.
struct Programs<'a> {
    /// The file, its glyphs, its global and its local subroutines.
    font: (&'a [u8], &'a Index<'a>, &'a Index<'a>, &'a Index<'a>),
    spent: &'a Cell<usize>,
}

impl Programs<'_> {
    fn paid<'p>(&self, program: &'p [u8]) -> Result<&'p [u8], Error> {
        // Every call costs at least one, however short it is.
        self.spent.set(self.spent.get() + program.len() + 1);
        if self.spent.get() > MAX_GLYPH_PROGRAM { Err(Error::CharstringNestingDepthLimitExceeded) } else { Ok(program) }
    }
}

impl CharstringContext for Programs<'_> {
    fn kind(&self) -> CharstringKind {
        CharstringKind::Type2
    }

    fn seac_components(&self, base_code: i32, accent_code: i32) -> Result<[&[u8]; 2], Error> {
        let [base, accent] = self.font.seac_components(base_code, accent_code)?;
        Ok([self.paid(base)?, self.paid(accent)?])
    }

    fn global_subr(&self, index: i32) -> Result<&[u8], Error> {
        self.paid(self.font.2.get(index.saturating_add(self.font.2.subr_bias()) as usize)?)
    }

    fn subr(&self, index: i32) -> Result<&[u8], Error> {
        self.paid(self.font.3.get(index.saturating_add(self.font.3.subr_bias()) as usize)?)
    }
}

struct Nothing;

impl CommandSink for Nothing {
    fn move_to(&mut self, _: Fixed, _: Fixed) {}
    fn line_to(&mut self, _: Fixed, _: Fixed) {}
    fn curve_to(&mut self, _: Fixed, _: Fixed, _: Fixed, _: Fixed, _: Fixed, _: Fixed) {}
    fn close(&mut self) {}
}

/// The type numbers of lookups that hold sets of rules, and of the extension lookup.
struct Kinds {
    ligature: Option<usize>,
    context: usize,
    chain: usize,
    extension: usize,
}

const SUBSTITUTIONS: Kinds = Kinds { ligature: Some(4), context: 5, chain: 6, extension: 7 };
const POSITIONS: Kinds = Kinds { ligature: None, context: 7, chain: 8, extension: 9 };

/// Checks that the tables that define joining, replacement and kerning of letters are small enough to traverse; the
/// error is the reason. Offsets lead to lookups, their parts and the lists of these, and all may lead to the same
/// place.
pub fn of_layout(font: &FontRef<'_>) -> Result<(), String> {
    for (tag, kinds) in [(b"GSUB", &SUBSTITUTIONS), (b"GPOS", &POSITIONS)] {
        let Some(data) = font.data_for_tag(Tag::new(tag)) else { continue };
        let table = Table(data.as_bytes());
        if table.entries(kinds).is_none_or(|entries| entries > MAX_LAYOUT_ENTRIES) {
            let name = String::from_utf8_lossy(tag);
            return Err(format!(
                "its table {name} has more than {MAX_LAYOUT_ENTRIES} entries, counted as often as they are used"
            ));
        }
    }
    Ok(())
}

/// A layout table; values beyond its end are 0.
struct Table<'a>(&'a [u8]);

impl Table<'_> {
    fn number(&self, at: usize) -> usize {
        self.0.get(at..at + 2).map_or(0, |bytes| usize::from(u16::from_be_bytes([bytes[0], bytes[1]])))
    }

    /// The number of entries; `None` as soon as they are too many.
    fn entries(&self, kinds: &Kinds) -> Option<usize> {
        let mut sum = 0;
        let list = self.number(8);
        for i in 0..self.number(list) {
            let lookup = list + self.number(list + 2 + 2 * i);
            let kind = self.number(lookup);
            for k in 0..self.number(lookup + 4) {
                let mut part = lookup + self.number(lookup + 6 + 2 * k);
                let mut kind = kind;
                if kind == kinds.extension {
                    kind = self.number(part + 2);
                    part += (self.number(part + 4) << 16) + self.number(part + 6);
                }
                sum += 1 + self.part(part, kind, kinds);
                if sum > MAX_LAYOUT_ENTRIES {
                    return None;
                }
            }
        }
        Some(sum)
    }

    /// The entries of a part of a lookup: those of its coverage, and of its sets of rules if it has any.
    fn part(&self, at: usize, kind: usize, kinds: &Kinds) -> usize {
        let format = self.number(at);
        let (is_context, is_chain) = (kind == kinds.context, kind == kinds.chain);
        if format == 3 && (is_context || is_chain) {
            // The only rule has a coverage for each letter.
            return self.number(at + 2);
        }
        let mut sum = self.number(at + self.number(at + 2) + 2);
        // Sets of rules follow the coverage, and the classes of letters if the rules use these.
        let sets = match format {
            1 if is_context || is_chain || Some(kind) == kinds.ligature => at + 4,
            2 if is_context => at + 6,
            2 if is_chain => at + 10,
            _ => return sum,
        };
        for i in 0..self.number(sets) {
            let set = self.number(sets + 2 + 2 * i);
            sum += 1 + if set == 0 { 0 } else { self.number(at + set) };
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layout_tables_are_counted_as_often_as_they_are_used() {
        // A list of `lookups` references to the same lookup, which has `parts` references to the same part, which
        // covers `covered` glyphs.
        let table = |lookups: u16, parts: u16, covered: u16| {
            let mut words: Vec<u16> = vec![1, 0, 0, 0, 10, lookups];
            words.extend(vec![2 + 2 * lookups; usize::from(lookups)]);
            words.extend([1, 0, parts]);
            words.extend(vec![6 + 2 * parts; usize::from(parts)]);
            words.extend([1, 6, 0, 1, covered]);
            words.iter().flat_map(|word| word.to_be_bytes()).collect::<Vec<u8>>()
        };
        let entries = |bytes: Vec<u8>| Table(&bytes).entries(&SUBSTITUTIONS);
        assert_eq!(entries(table(3, 5, 7)), Some(3 * 5 * 8));
        assert_eq!(entries(table(1, 1, 60_000)), Some(60_001));
        assert_eq!(entries(table(10_000, 10_000, 1)), None);
        assert_eq!(entries(table(100, 1_000, 60_000)), None);
        assert_eq!(entries(Vec::new()), Some(0));
        // A chain of classes: the values before its sets of rules are offsets of tables, however large they are.
        let chain: Vec<u16> = vec![1, 0, 0, 0, 10, 1, 4, 6, 0, 1, 8, 2, 16, 60_000, 60_000, 60_000, 2, 0, 20, 1, 1, 7];
        let mut bytes: Vec<u8> = chain.iter().flat_map(|word| word.to_be_bytes()).collect();
        bytes.extend([0, 9]);
        assert_eq!(entries(bytes), Some(1 + 1 + 2 + 7));
    }
}
