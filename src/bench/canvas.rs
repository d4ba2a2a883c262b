//! The canvas of charts. plotters draws lines and areas on an image three times as large as the chart, and shrinking it
//! smooths the edges. Text is set here: plotters ignores the side bearing of each letter, so its letter spacing is
//! uneven.

use std::convert::Infallible;
use std::sync::LazyLock;

use ab_glyph::{Font, FontRef, Glyph, Point, PxScale, ScaleFont, point};
use image::{Rgb, RgbImage, imageops};
use plotters::coord::Shift;
use plotters::drawing::{DrawingArea, DrawingAreaErrorKind, IntoDrawingArea};
use plotters::element::{Circle, PathElement, Polygon, Text};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, FontFamily, IntoFont, RGBColor, ShapeStyle, TextStyle};
use plotters_backend::{BackendColor, BackendCoord, BackendTextStyle, DrawingBackend, DrawingErrorKind};

/// Fine pixels per pixel of the chart, along each side.
pub(super) const FINE: i32 = 3;
/// The exponent applied to the coverage of a pixel by a letter. Below one, the thin strokes of the editor's font stay
/// readable at small sizes.
const WEIGHT: f64 = 0.7;
/// The background color.
pub(super) const PAPER: RGBColor = RGBColor(255, 255, 255);

/// A drawing error. It never occurs, because drawing only writes to memory.
pub(super) type Failed = DrawingAreaErrorKind<Infallible>;

/// An image as a drawing backend of plotters.
pub(super) struct ImageBackend<'a> {
    image: &'a mut RgbImage,
}

/// A chart under construction. All lengths are in pixels of the finished chart.
pub(super) struct ChartCanvas<'a> {
    /// The whole chart, in fine pixels.
    pub area: DrawingArea<ImageBackend<'a>, Shift>,
}

/// A chart of this size, drawn by `draw` on an empty background.
pub(super) fn canvas(size: (u32, u32), draw: impl FnOnce(&ChartCanvas<'_>) -> Result<(), Failed>) -> RgbImage {
    let fine = FINE.unsigned_abs();
    let mut image = RgbImage::from_pixel(size.0 * fine, size.1 * fine, Rgb([PAPER.0, PAPER.1, PAPER.2]));
    let canvas = ChartCanvas { area: ImageBackend { image: &mut image }.into_drawing_area() };
    draw(&canvas).expect("an image in memory can always be drawn on");
    drop(canvas);
    imageops::thumbnail(&image, size.0, size.1)
}

/// The nearest fine pixel.
fn fine((x, y): (f64, f64)) -> (i32, i32) {
    ((x * f64::from(FINE)).round() as i32, (y * f64::from(FINE)).round() as i32)
}

impl ChartCanvas<'_> {
    /// Draws a line through all points.
    pub fn line(&self, points: &[(f64, f64)], color: RGBColor, width: f64) -> Result<(), Failed> {
        let mut path: Vec<(i32, i32)> = points.iter().copied().map(fine).collect();
        // A segment of zero length has no direction, and plotters would invent one.
        path.dedup();
        if path.len() < 2 {
            return Ok(());
        }
        self.area.draw(&PathElement::new(path, stroke(color, width)))
    }

    /// Draws a straight dashed line.
    pub fn dashed(&self, ends: [(f64, f64); 2], color: RGBColor, width: f64, dash: [f64; 2]) -> Result<(), Failed> {
        let [(ax, ay), (bx, by)] = ends;
        let length = (bx - ax).hypot(by - ay);
        let at = |d: f64| (ax + (bx - ax) * d / length, ay + (by - ay) * d / length);
        let mut start = 0.0;
        while start < length {
            self.line(&[at(start), at((start + dash[0]).min(length))], color, width)?;
            start += dash[0] + dash[1];
        }
        Ok(())
    }

    /// Draws a filled disc.
    pub fn disc(&self, center: (f64, f64), radius: f64, color: RGBColor) -> Result<(), Failed> {
        self.area.draw(&Circle::new(fine(center), (radius * f64::from(FINE)).round() as i32, color.filled()))
    }

    /// Draws a ring of this width inside the radius.
    pub fn circle(&self, center: (f64, f64), radius: f64, color: RGBColor, width: f64) -> Result<(), Failed> {
        let radius = ((radius - width / 2.0) * f64::from(FINE)).round() as i32;
        self.area.draw(&Circle::new(fine(center), radius, stroke(color, width)))
    }

    /// Draws a filled polygon.
    pub fn polygon(&self, corners: &[(f64, f64)], color: RGBColor) -> Result<(), Failed> {
        let corners: Vec<(i32, i32)> = corners.iter().copied().map(fine).collect();
        self.area.draw(&Polygon::new(corners, color.filled()))
    }

    /// Draws a filled rectangle with these left, upper, right and lower edges.
    pub fn rectangle(&self, [left, top, right, bottom]: [f64; 4], color: RGBColor) -> Result<(), Failed> {
        self.polygon(&[(left, top), (right, top), (right, bottom), (left, bottom)], color)
    }

    /// Draws one line of text. `anchor` is the part of it that lies at `at`; `em` is the font size.
    pub fn text(&self, text: &str, at: (f64, f64), em: f64, color: RGBColor, anchor: Pos) -> Result<(), Failed> {
        self.area.draw(&Text::new(text, fine(at), letters(em, color).pos(anchor)))
    }
}

fn stroke(color: RGBColor, width: f64) -> ShapeStyle {
    color.stroke_width((width * f64::from(FINE)).round() as u32)
}

/// A plotters font of `em` pixels of the finished chart.
pub(super) fn letters(em: f64, color: RGBColor) -> TextStyle<'static> {
    (FontFamily::SansSerif, em * f64::from(FINE)).into_font().color(&color)
}

/// The anchor at the left edge, at half the height of the text.
pub(super) const LEFT: Pos = Pos { h_pos: HPos::Left, v_pos: VPos::Center };

/// The width of a text, in the unit of `em`.
pub(super) fn text_width(text: &str, em: f64) -> f64 {
    f64::from(set(text, em as f32).1)
}

/// The text truncated to `width`, with an ellipsis in place of the rest.
pub(super) fn fitting(text: &str, em: f64, width: f64) -> String {
    if text_width(text, em) <= width {
        return text.into();
    }
    let mut short: Vec<char> = text.chars().collect();
    while short.pop().is_some() {
        let shorter = short.iter().collect::<String>() + "…";
        if text_width(&shorter, em) <= width {
            return shorter;
        }
    }
    String::new()
}

/// The fonts of the editor. The second one covers more characters.
static FONTS: LazyLock<[FontRef<'static>; 2]> = LazyLock::new(|| {
    [epaint_default_fonts::UBUNTU_LIGHT, epaint_default_fonts::HACK_REGULAR]
        .map(|bytes| FontRef::try_from_slice(bytes).expect("a font that comes with a library is whole"))
});

/// The glyphs of a text on a baseline through (0, 0), each with its font, and their total width.
fn set(text: &str, em: f32) -> (Vec<(&'static FontRef<'static>, Glyph)>, f32) {
    let [first, second] = &*FONTS;
    let mut glyphs: Vec<(&FontRef<'_>, Glyph)> = Vec::new();
    let mut x = 0.0;
    for letter in text.chars() {
        let font = if first.glyph_id(letter).0 == 0 && second.glyph_id(letter).0 != 0 { second } else { first };
        let scale = PxScale::from(em * font.height_unscaled() / font.units_per_em().unwrap_or(1000.0));
        let scaled = font.as_scaled(scale);
        let id = font.glyph_id(letter);
        if let Some((before, glyph)) = glyphs.last().filter(|(before, _)| std::ptr::eq(*before, font)) {
            x += before.as_scaled(scale).kern(glyph.id, id);
        }
        glyphs.push((font, id.with_scale_and_position(scale, point(x, 0.0))));
        x += scaled.h_advance(id);
    }
    (glyphs, x)
}

/// The start of the baseline relative to the anchor, without rotation. The heights, in em, are those of capitals and
/// descenders.
fn start(anchor: Pos, width: f32, em: f32) -> Point {
    let x = match anchor.h_pos {
        HPos::Left => 0.0,
        HPos::Center => -width / 2.0,
        HPos::Right => -width,
    };
    let y = match anchor.v_pos {
        VPos::Top => 0.76,
        VPos::Center => 0.34,
        VPos::Bottom => -0.2,
    };
    point(x, y * em)
}

impl DrawingBackend for ImageBackend<'_> {
    type ErrorType = Infallible;

    fn get_size(&self) -> (u32, u32) {
        self.image.dimensions()
    }

    fn ensure_prepared(&mut self) -> Result<(), DrawingErrorKind<Infallible>> {
        Ok(())
    }

    fn present(&mut self) -> Result<(), DrawingErrorKind<Infallible>> {
        Ok(())
    }

    fn draw_pixel(&mut self, (x, y): BackendCoord, color: BackendColor) -> Result<(), DrawingErrorKind<Infallible>> {
        let inside = (u32::try_from(x).ok()).zip(u32::try_from(y).ok());
        if let Some(pixel) = inside.and_then(|(x, y)| self.image.get_pixel_mut_checked(x, y)) {
            let (r, g, b) = color.rgb;
            for (old, new) in pixel.0.iter_mut().zip([r, g, b]) {
                *old = (f64::from(*old) + (f64::from(new) - f64::from(*old)) * color.alpha).round() as u8;
            }
        }
        Ok(())
    }

    fn draw_text<S: BackendTextStyle>(
        &mut self,
        text: &str,
        style: &S,
        pos: BackendCoord,
    ) -> Result<(), DrawingErrorKind<Infallible>> {
        let em = style.size() as f32;
        let (glyphs, width) = set(text, em);
        let start = start(style.anchor(), width, em);
        let color = style.color();
        for (font, mut glyph) in glyphs {
            glyph.position += start;
            let Some(outline) = font.outline_glyph(glyph) else { continue };
            let corner = outline.px_bounds().min;
            let mut dots = Vec::new();
            outline.draw(|x, y, cover| dots.push((corner.x as i32 + x as i32, corner.y as i32 + y as i32, cover)));
            for (x, y, cover) in dots {
                let (x, y) = style.transform().transform(x, y);
                let color = BackendColor { alpha: color.alpha * f64::from(cover.min(1.0)).powf(WEIGHT), ..color };
                self.draw_pixel((pos.0 + x, pos.1 + y), color)?;
            }
        }
        Ok(())
    }

    fn estimate_text_size<S: BackendTextStyle>(
        &self,
        text: &str,
        style: &S,
    ) -> Result<(u32, u32), DrawingErrorKind<Infallible>> {
        let em = style.size() as f32;
        Ok((set(text, em).1.ceil() as u32, em.ceil() as u32))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BLACK: RGBColor = RGBColor(0, 0, 0);

    /// The first and the last column with ink.
    fn ink(image: &RgbImage) -> (u32, u32) {
        let dark: Vec<u32> = image.enumerate_pixels().filter(|(_, _, p)| p.0[0] < 128).map(|(x, _, _)| x).collect();
        (dark.iter().copied().min().unwrap(), dark.iter().copied().max().unwrap())
    }

    #[test]
    fn text_is_as_wide_as_said_and_ends_at_its_anchor() {
        let right = Pos { h_pos: HPos::Right, v_pos: VPos::Center };
        let image = canvas((300, 40), |canvas| canvas.text("Hamburgefons", (280.0, 20.0), 20.0, BLACK, right));
        let (first, last) = ink(&image);
        let width = text_width("Hamburgefons", 20.0);
        assert!((f64::from(last) - 279.0).abs() <= 2.0, "ends at {last}");
        assert!((f64::from(last - first) - width).abs() <= 4.0, "{first} to {last}, and {width} was said");
    }

    #[test]
    fn nothing_breaks_at_the_edge_or_without_length() {
        canvas((20, 20), |canvas| {
            canvas.text("far out", (-30.0, 500.0), 20.0, BLACK, LEFT)?;
            canvas.line(&[(5.0, 5.0), (5.0, 5.0)], BLACK, 2.0)?;
            canvas.line(&[], BLACK, 2.0)?;
            canvas.dashed([(5.0, 5.0), (5.0, 5.0)], BLACK, 2.0, [3.0, 3.0])?;
            canvas.disc((19.0, 19.0), 8.0, BLACK)
        });
    }

    #[test]
    fn long_texts_are_cut() {
        assert_eq!(fitting("short", 14.0, 200.0), "short");
        let cut = fitting(&"long ".repeat(50), 14.0, 200.0);
        assert!(cut.ends_with('…') && text_width(&cut, 14.0) <= 200.0);
        assert_eq!(fitting("none", 14.0, 0.0), "");
    }
}
