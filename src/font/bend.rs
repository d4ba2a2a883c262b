//! Conversion of font curves to arcs.

use glam::DVec3;
use skrifa::outline::OutlinePen;

use super::limits::MAX_TEXT_ARCS;
use isolith_geometry::{ArcPiece, biarc};

/// The tolerance of arcs against the curves of the font, in em.
pub const TOLERANCE: f64 = 5e-4;
/// The limit on halvings of a curve; the remaining error is far below the tolerance.
const MOST_HALVINGS: u32 = 6;

/// Converts the outline of a glyph to arcs, in em.
pub struct ArcPen {
    em: f64,
    start: DVec3,
    at: DVec3,
    arcs: Vec<ArcPiece>,
}

impl ArcPen {
    /// A pen for a font with `em` units per em.
    pub fn new(em: f64) -> Self {
        Self { em, start: DVec3::ZERO, at: DVec3::ZERO, arcs: Vec::new() }
    }

    /// The arcs; `None` if there are too many.
    pub fn finish(mut self) -> Option<Vec<ArcPiece>> {
        self.close();
        (!self.is_full()).then_some(self.arcs)
    }

    /// A full pen ignores further segments.
    fn is_full(&self) -> bool {
        self.arcs.len() > MAX_TEXT_ARCS
    }

    fn place(&self, x: f32, y: f32) -> DVec3 {
        DVec3::new(x.into(), y.into(), 0.0) / self.em
    }

    fn curve(&mut self, b: DVec3, c: DVec3, d: DVec3) {
        if !self.is_full() {
            let mut arcs = Vec::new();
            bent([self.at, b, c, d], MOST_HALVINGS, &mut arcs);
            self.arcs.extend(arcs.into_iter().filter(|arc| arc.reach > 0.0));
        }
        self.at = d;
    }
}

impl OutlinePen for ArcPen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.close();
        self.at = self.place(x, y);
        self.start = self.at;
    }

    fn line_to(&mut self, x: f32, y: f32) {
        let to = self.place(x, y);
        if to != self.at && !self.is_full() {
            self.arcs.push(ArcPiece::straight(self.at, to));
        }
        self.at = to;
    }

    fn quad_to(&mut self, cx: f32, cy: f32, x: f32, y: f32) {
        let [a, b, c] = [self.at, self.place(cx, cy), self.place(x, y)];
        self.curve(a.lerp(b, 2.0 / 3.0), c.lerp(b, 2.0 / 3.0), c);
    }

    fn curve_to(&mut self, cx0: f32, cy0: f32, cx1: f32, cy1: f32, x: f32, y: f32) {
        let [b, c, d] = [self.place(cx0, cy0), self.place(cx1, cy1), self.place(x, y)];
        self.curve(b, c, d);
    }

    fn close(&mut self) {
        if self.at != self.start && !self.is_full() {
            self.arcs.push(ArcPiece::straight(self.at, self.start));
        }
        self.at = self.start;
    }
}

/// Converts a cubic Bézier curve to pairs of arcs, halving it where they would leave it by more than [`TOLERANCE`].
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

/// The distance of a point from the circle or line of an arc.
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

    #[test]
    fn a_pen_closes_what_is_open_and_stops_when_it_is_full() {
        let mut pen = ArcPen::new(100.0);
        pen.move_to(0.0, 0.0);
        pen.line_to(100.0, 0.0);
        pen.line_to(0.0, 100.0);
        assert_eq!(pen.finish().unwrap().len(), 3);
        let mut pen = ArcPen::new(100.0);
        for i in 0..2 * MAX_TEXT_ARCS {
            pen.line_to((i % 100) as f32, 100.0);
        }
        assert_eq!(pen.arcs.len(), MAX_TEXT_ARCS + 1);
        assert!(pen.finish().is_none());
    }
}
