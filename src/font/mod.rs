//! Letters as outlines made of arcs, from the built-in fonts (those of the editor) or from a file.
//!
//! | file | content |
//! |---|---|
//! | `face` | a font: its glyphs and their outlines |
//! | `work` | counts the cost of a glyph before drawing |
//! | `shaping` | from letters to placed glyphs: direction, joining, kerning, fallback fonts |
//! | `bend` | conversion of font curves to arcs |
//! | `limits` | limits on the size of a text |

mod bend;
mod face;
mod limits;
mod shaping;
mod work;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::LazyLock;

use glam::DVec3;

use isolith_geometry::{ArcPiece, arc_union};

pub use bend::TOLERANCE;
pub use face::{Face, Outlines};
pub use limits::{MAX_GLYPHS, MAX_TEXT_ARCS};

/// The distance between lines, in em.
const LINE: f64 = 1.2;
/// Half the height of a capital letter, in em: the vertical middle of a line.
const MIDDLE: f64 = 0.347;
/// Ends of outlines that are nearer to each other than this are unified, in em: less than a hundredth of the finest
/// grid of fonts.
const SNAP: f64 = 1e-6;

/// The built-in fonts. The second one has more letters.
static FONTS: LazyLock<[Face; 2]> = LazyLock::new(|| {
    [epaint_default_fonts::UBUNTU_LIGHT, epaint_default_fonts::HACK_REGULAR]
        .map(|bytes| Face::built_in(bytes).expect("a font that comes with a library is whole"))
});

/// The outlines of a text in the XY plane, for a font of height 1, with its middle at the origin; lines are centered.
/// Closed curves around the solid that do not cross each other; empty for a text without ink. The built-in fonts
/// supply letters that the font lacks. Each text is computed once.
pub fn text_curve(text: &str, face: Option<&Face>) -> Outlines {
    let make = || {
        // Parsers of foreign files have bugs: a panic counts as a broken font.
        let made = catch_unwind(AssertUnwindSafe(|| outlines(text, face)));
        made.unwrap_or_else(|_| Err("drawing it failed".to_owned()))
    };
    face.unwrap_or(&FONTS[0]).remember(text, make)
}

fn outlines(text: &str, face: Option<&Face>) -> Outlines {
    let faces: Vec<&Face> = face.into_iter().chain(&*FONTS).collect();
    // Line and paragraph separators are not control characters and may occur in a text.
    let lines: Vec<&str> = text.split(['\n', '\u{2028}', '\u{2029}']).collect();
    let top = 0.5 * LINE * (lines.len() - 1) as f64 - MIDDLE;
    let mut count = 0;
    let mut arcs: Vec<ArcPiece> = Vec::new();
    for (i, line) in lines.iter().enumerate() {
        let shaped = shaping::line(line, &faces);
        count += shaped.glyphs.len();
        if count > MAX_GLYPHS {
            return Err(format!("makes more than {MAX_GLYPHS} glyphs of {} letters", text.chars().count()));
        }
        for placed in &shaped.glyphs {
            let glyph = faces[placed.face].glyph(placed.glyph).map_err(|reason| {
                let letter = line[placed.letter..].chars().next().unwrap_or_default();
                format!("{reason}, to draw {letter:?}")
            })?;
            if arcs.len() + glyph.len() > MAX_TEXT_ARCS {
                return Err(format!("takes more than {MAX_TEXT_ARCS} arcs"));
            }
            let by = DVec3::new(placed.at[0] - 0.5 * shaped.width, top - LINE * i as f64 + placed.at[1], 0.0);
            arcs.extend(glyph.iter().map(|arc| ArcPiece { middle: arc.middle + by, ..*arc }));
        }
    }
    let united = arc_union(&arcs, SNAP).map_err(|_| "has outlines that cross each other too often".to_owned())?;
    Ok(united.unwrap_or(arcs).into())
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;

    fn curve(text: &str, face: Option<&Face>) -> Arc<[ArcPiece]> {
        text_curve(text, face).unwrap()
    }

    #[test]
    fn outlines_are_closed_and_stand_around_the_origin() {
        let arcs = curve("Isolith\n&ä", None);
        assert!(arcs.len() > 100);
        let mut first = arcs[0].start();
        for (i, arc) in arcs.iter().enumerate() {
            let next = arcs.get(i + 1).map_or(first, ArcPiece::start);
            if arc.end().distance(next) > 1e-9 {
                assert!(arc.end().distance(first) < 1e-9, "an outline is open behind arc {i}");
                first = next;
            }
            assert!(arc.middle.x.abs() < 2.0 && arc.middle.y.abs() < 1.5 && arc.middle.z == 0.0);
        }
        assert!(curve(" \n", None).is_empty() && curve("", None).is_empty());
        // The cache keeps the outlines.
        assert!(Arc::ptr_eq(&arcs, &curve("Isolith\n&ä", None)));
    }

    #[test]
    fn a_font_of_ones_own_draws_its_letters_and_leaves_others_to_the_programs_fonts() {
        let face = Face::new(epaint_default_fonts::HACK_REGULAR.to_vec()).unwrap();
        assert!(Face::new(vec![0; 100]).is_err());
        // Hack's letters all have the same width, those of the first font do not.
        let width = |text: &str, face: Option<&Face>| {
            let arcs = curve(text, face);
            arcs.iter().map(|arc| arc.middle.x).fold(f64::MIN, f64::max)
        };
        assert!((width("lil", Some(&face)) - width("lil", None)).abs() > 0.1);
        // No font has this letter, so all draw the same box.
        assert!(width("\u{e000}", None) > 0.1);
        assert_eq!(width("\u{e000}", Some(&face)), width("\u{e000}", None));
    }

    #[test]
    fn letters_that_mean_nothing_by_themselves_take_no_room() {
        for unseen in ['\u{200d}', '\u{fe0f}', '\u{200b}', '\u{200e}', '\u{ad}', '\u{2060}', '\u{feff}', '\u{e0041}'] {
            assert_eq!(curve(&format!("A{unseen}B"), None), curve("AB", None), "U+{:04X}", u32::from(unseen));
        }
        // U+2028 separates lines.
        assert_eq!(curve("A\u{2028}B", None), curve("A\nB", None));
    }
}
