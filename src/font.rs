//! Letters as outlines made of arcs, from the fonts that come with the program (those of the editor) or from a file.

use std::collections::HashMap;
use std::sync::{Arc, LazyLock, Mutex, PoisonError};

use ab_glyph::{Font, FontRef, FontVec, OutlineCurve, Point};
use glam::DVec3;

use crate::geometry::{ArcPiece, biarc};

/// How far arcs may leave the curves of the font, in heights of the font (em).
pub const TOLERANCE: f64 = 5e-4;
/// From line to line, in heights of the font.
const LINE: f64 = 1.2;
/// Half the height of a capital letter: what lies half-way between base line and top, in heights of the font.
const MIDDLE: f64 = 0.347;
/// A curve is halved no more often than this; what is left then is off by far less than the tolerance.
const MOST_HALVINGS: u32 = 6;

/// A letter: how far the next one stands from it, and its outlines.
struct Letter {
    advance: f64,
    arcs: Vec<ArcPiece>,
}

/// The second font knows more letters.
static FONTS: LazyLock<[FontRef<'static>; 2]> = LazyLock::new(|| {
    [epaint_default_fonts::UBUNTU_LIGHT, epaint_default_fonts::HACK_REGULAR]
        .map(|bytes| FontRef::try_from_slice(bytes).expect("a font that comes with a library is whole"))
});

/// A font of one's own. Letters are made once.
pub struct Face {
    font: FontVec,
    letters: Mutex<HashMap<char, Option<Arc<Letter>>>>,
}

impl Face {
    /// The font of a TrueType or OpenType file; or why it cannot be read.
    pub fn new(file: Vec<u8>) -> Result<Self, String> {
        let font = FontVec::try_from_vec(file).map_err(|_| "it is damaged or of another kind")?;
        if !font.codepoint_ids().any(|(id, _)| font.outline(id).is_some()) {
            return Err("it has no outlines of letters".to_owned());
        }
        Ok(Self { font, letters: Mutex::default() })
    }

    /// A letter, if the font has it.
    fn letter(&self, of: char) -> Option<Arc<Letter>> {
        let mut letters = self.letters.lock().unwrap_or_else(PoisonError::into_inner);
        let made = || (self.font.glyph_id(of).0 != 0).then(|| Arc::new(made(&self.font, of)));
        letters.entry(of).or_insert_with(made).clone()
    }
}

/// The outlines of a text in the XY plane, for a font of height 1, its middle at the origin; lines are centred. Closed
/// curves that go around what is solid; empty for a text without ink. Letters that the font does not have are those of
/// the fonts that come with the program.
pub fn text_curve(text: &str, face: Option<&Face>) -> Vec<ArcPiece> {
    let lines: Vec<&str> = text.split('\n').collect();
    let top = 0.5 * LINE * (lines.len() - 1) as f64 - MIDDLE;
    let own = |of: char| face.and_then(|face| face.letter(of)).unwrap_or_else(|| letter(of));
    let mut out = Vec::new();
    for (i, line) in lines.iter().enumerate() {
        let letters: Vec<Arc<Letter>> = line.chars().map(own).collect();
        let mut x = -0.5 * letters.iter().map(|l| l.advance).sum::<f64>();
        for letter in letters {
            let by = DVec3::new(x, top - LINE * i as f64, 0.0);
            out.extend(letter.arcs.iter().map(|arc| ArcPiece { middle: arc.middle + by, ..*arc }));
            x += letter.advance;
        }
    }
    out
}

/// A letter of the program's own fonts, made once.
fn letter(of: char) -> Arc<Letter> {
    static KNOWN: LazyLock<Mutex<HashMap<char, Arc<Letter>>>> = LazyLock::new(Mutex::default);
    let [first, second] = &*FONTS;
    let font = if first.glyph_id(of).0 == 0 && second.glyph_id(of).0 != 0 { second } else { first };
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    known.entry(of).or_insert_with(|| Arc::new(made(font, of))).clone()
}

fn made(font: &impl Font, of: char) -> Letter {
    let (id, em) = (font.glyph_id(of), f64::from(font.units_per_em().unwrap_or(1000.0)));
    let place = |p: Point| DVec3::new(p.x.into(), p.y.into(), 0.0) / em;
    let mut arcs = Vec::new();
    for curve in font.outline(id).map(|outline| outline.curves).unwrap_or_default() {
        match curve {
            OutlineCurve::Line(a, b) => arcs.push(ArcPiece::straight(place(a), place(b))),
            OutlineCurve::Quad(a, b, c) => {
                let [a, b, c] = [a, b, c].map(place);
                bent([a, a.lerp(b, 2.0 / 3.0), c.lerp(b, 2.0 / 3.0), c], MOST_HALVINGS, &mut arcs);
            }
            OutlineCurve::Cubic(a, b, c, d) => bent([a, b, c, d].map(place), MOST_HALVINGS, &mut arcs),
        }
    }
    arcs.retain(|arc| arc.reach > 0.0);
    Letter { advance: f64::from(font.h_advance_unscaled(id)) / em, arcs }
}

/// A cubic Bézier curve as pairs of arcs, halved where they would leave it by more than [`TOLERANCE`].
fn bent(curve: [DVec3; 4], halvings: u32, out: &mut Vec<ArcPiece>) {
    let [a, b, c, d] = curve;
    let toward = |from: DVec3, first: DVec3, second: DVec3| {
        (first - from).try_normalize().or((second - from).try_normalize()).unwrap_or(DVec3::X)
    };
    let arcs = biarc(a, toward(a, b, c), d, -toward(d, c, b));
    let at = |t: f64| {
        let s = 1.0 - t;
        a * (s * s * s) + b * (3.0 * s * s * t) + c * (3.0 * s * t * t) + d * (t * t * t)
    };
    let off = |p: DVec3| arcs.iter().map(|arc| aside(arc, p)).fold(f64::INFINITY, f64::min);
    if halvings == 0 || (1..8).all(|i| off(at(f64::from(i) / 8.0)) < TOLERANCE) {
        out.extend(arcs);
        return;
    }
    let (ab, bc, cd) = (a.midpoint(b), b.midpoint(c), c.midpoint(d));
    let (abc, bcd) = (ab.midpoint(bc), bc.midpoint(cd));
    let middle = abc.midpoint(bcd);
    bent([a, ab, abc, middle], halvings - 1, out);
    bent([middle, bcd, cd, d], halvings - 1, out);
}

/// How far a point is from the circle or line of an arc.
fn aside(arc: &ArcPiece, p: DVec3) -> f64 {
    let square = arc.bend.length_squared();
    if square < 1e-18 {
        let w = p - arc.middle;
        return (w - arc.tangent * w.dot(arc.tangent)).length();
    }
    (p.distance(arc.middle + arc.bend / square) - 1.0 / square.sqrt()).abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outlines_are_closed_and_stand_around_the_origin() {
        let arcs = text_curve("Isolith\n&ä", None);
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
        assert!(text_curve(" \n", None).is_empty());
    }

    #[test]
    fn a_font_of_ones_own_draws_its_letters_and_leaves_others_to_the_programs_fonts() {
        let face = Face::new(epaint_default_fonts::HACK_REGULAR.to_vec()).unwrap();
        assert!(Face::new(vec![0; 100]).is_err());
        // Hack's letters are all as wide, those of the first font are not.
        let width = |text: &str, face: Option<&Face>| {
            let arcs = text_curve(text, face);
            arcs.iter().map(|arc| arc.middle.x).fold(f64::MIN, f64::max)
        };
        assert!((width("lil", Some(&face)) - width("lil", None)).abs() > 0.1);
        // No font has this letter, so all draw the same box for it.
        assert_eq!(width("\u{e000}", Some(&face)), width("\u{e000}", None));
    }

    #[test]
    fn arcs_stay_as_near_to_the_curve_as_promised() {
        let curve = [DVec3::ZERO, DVec3::new(0.0, 0.6, 0.0), DVec3::new(0.4, 0.7, 0.0), DVec3::X];
        let mut arcs = Vec::new();
        bent(curve, MOST_HALVINGS, &mut arcs);
        for i in 0..=200 {
            let (t, s) = (f64::from(i) / 200.0, 1.0 - f64::from(i) / 200.0);
            let [a, b, c, d] = curve;
            let p = a * (s * s * s) + b * (3.0 * s * s * t) + c * (3.0 * s * t * t) + d * (t * t * t);
            let near = arcs.iter().map(|arc| aside(arc, p)).fold(f64::INFINITY, f64::min);
            assert!(near < 1.2 * TOLERANCE, "{near} at {t}");
        }
    }
}
