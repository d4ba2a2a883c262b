//! A font: its glyphs and their outlines.

use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use harfrust::{Shaper, ShaperData};
use skrifa::instance::Size;
use skrifa::outline::{DrawSettings, OutlineGlyphCollection, OutlineGlyphFormat};
use skrifa::raw::ps::cff::CffFontRef;
use skrifa::raw::{FontRef, TableProvider};
use skrifa::{GlyphId, Tag};

use super::bend::ArcPen;
use super::limits::MAX_TEXT_ARCS;
use super::work;
use isolith_geometry::ArcPiece;

/// The number of texts whose outlines each font caches; the cache is cleared when it is full.
const KEPT_TEXTS: usize = 256;
/// The units per em that the format allows.
const EM: std::ops::RangeInclusive<i32> = 16..=16_384;

/// Outlines of a text, or the reason why there are none.
pub type Outlines = Result<Arc<[ArcPiece]>, String>;

/// Outlines of a glyph, or the reason why it is not drawn.
type Made = Result<Arc<[ArcPiece]>, String>;

/// A font with caches of its glyphs and texts.
pub struct Face {
    bytes: Cow<'static, [u8]>,
    shaping: ShaperData,
    format: OutlineGlyphFormat,
    em: f64,
    glyphs: Mutex<HashMap<GlyphId, Made>>,
    texts: Mutex<HashMap<String, Outlines>>,
}

impl Face {
    /// Loads the font of a TrueType or OpenType file, or the first font of a collection; the error is the reason.
    pub fn new(file: Vec<u8>) -> Result<Self, String> {
        Self::of(Cow::Owned(file))
    }

    /// Loads a built-in font.
    pub(super) fn built_in(file: &'static [u8]) -> Result<Self, String> {
        Self::of(Cow::Borrowed(file))
    }

    fn of(bytes: Cow<'static, [u8]>) -> Result<Self, String> {
        let font = FontRef::from_index(&bytes, 0).map_err(|_| "it is damaged or of another kind")?;
        let (Ok(head), Ok(_)) = (font.head(), font.maxp()) else { return Err("it is damaged".to_owned()) };
        let em = i32::from(head.units_per_em());
        if !EM.contains(&em) {
            return Err(format!("its height must be {} to {} units, not {em}", EM.start(), EM.end()));
        }
        let formats = [OutlineGlyphFormat::Glyf, OutlineGlyphFormat::Cff, OutlineGlyphFormat::Cff2];
        let format = formats
            .into_iter()
            .find(|format| OutlineGlyphCollection::with_format(&font, *format).is_some())
            .ok_or("it has no outlines of letters")?;
        if font.cmap().is_err() {
            return Err("it does not say which letters it has".to_owned());
        }
        work::of_layout(&font)?;
        let shaping = ShaperData::new(&font);
        let (glyphs, texts) = (Mutex::default(), Mutex::default());
        Ok(Self { shaping, format, em: em.into(), glyphs, texts, bytes })
    }

    fn font(&self) -> FontRef<'_> {
        FontRef::from_index(&self.bytes, 0).expect("it was read before")
    }

    /// Calls `shape` with the shaper of the font.
    pub(super) fn with_shaper<T>(&self, shape: impl FnOnce(&Shaper<'_>) -> T) -> T {
        shape(&self.shaping.shaper(&self.font()).build())
    }

    /// Units per em.
    pub(super) fn em(&self) -> f64 {
        self.em
    }

    /// The advance width of a glyph, in em.
    pub(super) fn advance(&self, glyph: GlyphId) -> f64 {
        let width = self.font().hmtx().ok().and_then(|widths| widths.advance(glyph));
        f64::from(width.unwrap_or(0)) / self.em
    }

    /// The outlines of a glyph, in em; or the reason why it is not drawn.
    pub(super) fn glyph(&self, glyph: GlyphId) -> Made {
        let known = self.glyphs.lock().unwrap_or_else(PoisonError::into_inner).get(&glyph).cloned();
        if let Some(known) = known {
            return known;
        }
        let made = self.made(glyph).map(Arc::from);
        self.glyphs.lock().unwrap_or_else(PoisonError::into_inner).insert(glyph, made.clone());
        made
    }

    fn made(&self, glyph: GlyphId) -> Result<Vec<ArcPiece>, String> {
        let font = self.font();
        let programs = match self.format {
            OutlineGlyphFormat::Cff => font.data_for_tag(Tag::new(b"CFF ")),
            OutlineGlyphFormat::Cff2 => font.data_for_tag(Tag::new(b"CFF2")),
            _ => {
                work::of_parts(&font, glyph)?;
                None
            }
        };
        if let Some(cff) = programs.and_then(|data| CffFontRef::new(data.as_bytes(), 0, None).ok()) {
            work::of_programs(&cff, glyph)?;
        }
        let mut pen = ArcPen::new(self.em);
        let drawn = OutlineGlyphCollection::with_format(&font, self.format).and_then(|all| all.get(glyph)).is_some_and(
            |outline| {
                let settings = DrawSettings::unhinted(Size::unscaled(), skrifa::instance::LocationRef::default());
                outline.draw(settings, &mut pen).is_ok()
            },
        );
        if !drawn && glyph != GlyphId::NOTDEF {
            // A damaged glyph appears as a missing glyph.
            return self.glyph(GlyphId::NOTDEF).map(|arcs| arcs.to_vec());
        }
        let id = glyph.to_u32();
        pen.finish().ok_or_else(|| format!("the outlines of its glyph {id} take more than {} arcs", MAX_TEXT_ARCS))
    }

    /// The outlines of a text; `make` computes them if they are not cached.
    pub(super) fn remember(&self, text: &str, make: impl FnOnce() -> Outlines) -> Outlines {
        let known = self.texts.lock().unwrap_or_else(PoisonError::into_inner).get(text).cloned();
        if let Some(known) = known {
            return known;
        }
        let made = make();
        let mut texts = self.texts.lock().unwrap_or_else(PoisonError::into_inner);
        if texts.len() >= KEPT_TEXTS {
            texts.clear();
        }
        texts.insert(text.to_owned(), made.clone());
        made
    }
}
