//! Logarithmic axes with ticks at round numbers, and the plane between them.

use std::ops::Range;

use plotters::chart::ChartBuilder;
use plotters::coord::cartesian::Cartesian2d;
use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};
use plotters::drawing::DrawingArea;
use plotters::style::{Color, RGBColor};

use super::canvas::{ChartCanvas, FINE, Failed, ImageBackend, letters};

/// The color of important text.
pub(super) const INK: RGBColor = RGBColor(0x22, 0x22, 0x22);
/// The color of secondary text.
pub(super) const SOFT_INK: RGBColor = RGBColor(0x50, 0x50, 0x50);
const AXIS: RGBColor = RGBColor(0x80, 0x80, 0x80);
const GRID: RGBColor = RGBColor(0xd8, 0xd8, 0xd8);
const FINE_GRID: RGBColor = RGBColor(0xf0, 0xf0, 0xf0);
const TICK_EM: f64 = 15.0;
const NAME_EM: f64 = 17.0;

/// A range of a logarithmic axis, as logarithms to base ten.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LogAxis {
    /// Start of the range.
    pub low: f64,
    /// End of the range.
    pub high: f64,
}

impl LogAxis {
    /// An axis that covers all logarithms with a margin; 1 to 100 if there are none. It spans at least half a decade,
    /// so that almost equal values look equal.
    pub fn around(logs: impl Iterator<Item = f64>) -> Self {
        let (low, high) = logs.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        if low > high {
            return Self { low: 0.0, high: 2.0 };
        }
        let half = ((high - low) * 0.57).max(0.25);
        let middle = (low + high) / 2.0;
        Self { low: middle - half, high: middle + half }
    }

    /// The multiples of powers of ten at which ticks stand: as many as stay readable.
    fn multiples(&self) -> &'static [f64] {
        match self.high - self.low {
            ..0.9 => &[1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0],
            ..2.2 => &[1.0, 2.0, 5.0],
            _ => &[1.0],
        }
    }

    /// The number of decades from one tick to the next; more than one on a long axis.
    fn stride(&self) -> i32 {
        ((self.high - self.low) / 10.0).ceil().max(1.0) as i32
    }

    /// The logarithms of the labeled ticks.
    pub fn ticks(&self) -> Vec<f64> {
        let stride = self.stride();
        self.marks(self.multiples()).filter(|(decade, _)| decade.rem_euclid(stride) == 0).map(|(_, log)| log).collect()
    }

    /// The logarithms that get a thin grid line.
    fn thin(&self) -> Vec<f64> {
        if self.high - self.low > 6.0 {
            return Vec::new();
        }
        self.marks(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0]).map(|(_, log)| log).collect()
    }

    fn marks(&self, multiples: &[f64]) -> impl Iterator<Item = (i32, f64)> {
        let decades = self.low.floor() as i32..=self.high.ceil() as i32;
        decades
            .flat_map(move |decade| multiples.iter().map(move |m| (decade, f64::from(decade) + m.log10())))
            .filter(|(_, log)| (self.low..=self.high).contains(log))
    }
}

impl Ranged for LogAxis {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, log: &f64, (from, to): (i32, i32)) -> i32 {
        from + ((log - self.low) / (self.high - self.low) * f64::from(to - from)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        if hint.weight().allow_light_points() { self.thin() } else { self.ticks() }
    }

    fn range(&self) -> Range<f64> {
        self.low..self.high
    }
}

impl ValueFormatter<f64> for LogAxis {
    fn format_ext(&self, log: &f64) -> String {
        tick_text(*log)
    }
}

/// The number with this logarithm, written in full. It must be one of the ticks.
pub(super) fn tick_text(log: f64) -> String {
    let decade = (log + 1e-9).floor();
    let first_digit = 10_f64.powf(log - decade);
    let digits_behind = if (first_digit - first_digit.round()).abs() < 1e-6 { -decade } else { 1.0 - decade };
    let decimals = digits_behind.max(0.0) as usize;
    let digits = format!("{:.decimals$}", 10_f64.powf(log));
    if digits.len() < 5 || decimals > 0 {
        return digits;
    }
    // A space separates thousands, as everywhere in Isolith.
    let ends = digits.char_indices().map(|(i, c)| {
        let gap = if i > 0 && (digits.len() - i).is_multiple_of(3) { "\u{a0}" } else { "" };
        format!("{gap}{c}")
    });
    ends.collect()
}

/// The text around the plane of a chart.
pub(super) struct Words<'a> {
    /// Below the x axis.
    pub x: &'a str,
    /// Beside the y axis.
    pub y: &'a str,
    /// A logarithm on the x axis and the text that replaces its number; ticks left of it get no number.
    pub floor: Option<(f64, &'a str)>,
}

/// The area of a chart between its axes.
pub(super) struct Plane<'a> {
    area: DrawingArea<ImageBackend<'a>, Cartesian2d<LogAxis, LogAxis>>,
}

impl<'a> Plane<'a> {
    /// Draws the axes. `margins` are the upper and the right margin, in pixels of the chart.
    pub fn draw(
        canvas: &ChartCanvas<'a>,
        (x, y): (LogAxis, LogAxis),
        margins: [u32; 2],
        words: &Words<'_>,
    ) -> Result<Self, Failed> {
        let fine = FINE.unsigned_abs();
        let mut chart = ChartBuilder::on(&canvas.area)
            .margin_top(margins[0] * fine)
            .margin_right(margins[1] * fine)
            .margin_left(14 * fine)
            .margin_bottom(14 * fine)
            .x_label_area_size(58 * fine)
            .y_label_area_size(84 * fine)
            .build_cartesian_2d(x, y)?;
        let x_text = |log: &f64| match words.floor {
            Some((floor, text)) if (log - floor).abs() < 1e-6 => text.to_string(),
            Some((floor, _)) if *log < floor => String::new(),
            _ => tick_text(*log),
        };
        chart
            .configure_mesh()
            .bold_line_style(GRID.stroke_width(fine))
            .light_line_style(FINE_GRID.stroke_width(fine))
            .axis_style(AXIS.stroke_width(fine))
            .set_all_tick_mark_size(5 * fine)
            .label_style(letters(TICK_EM, SOFT_INK))
            .axis_desc_style(letters(NAME_EM, INK))
            .x_label_formatter(&x_text)
            .x_desc(words.x)
            .y_desc(words.y)
            .draw()?;
        Ok(Self { area: chart.plotting_area().clone() })
    }

    /// The position of the point with these logarithms on the canvas.
    pub fn at(&self, x: f64, y: f64) -> (f64, f64) {
        let (x, y) = self.area.map_coordinate(&(x, y));
        (f64::from(x) / f64::from(FINE), f64::from(y) / f64::from(FINE))
    }

    /// The left, upper, right and lower edge on the canvas.
    pub fn edges(&self) -> [f64; 4] {
        let (x, y) = self.area.get_pixel_range();
        [x.start, y.start, x.end, y.end].map(|fine| f64::from(fine) / f64::from(FINE))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(low: f64, high: f64) -> Vec<String> {
        LogAxis { low, high }.ticks().into_iter().map(tick_text).collect()
    }

    #[test]
    fn ticks_are_round_numbers() {
        assert_eq!(texts(-0.1, 3.1), ["1", "10", "100", "1000"]);
        assert_eq!(texts(-6.0, -2.9), ["0.000001", "0.00001", "0.0001", "0.001"]);
        assert_eq!(texts(1.0, 2.0), ["10", "20", "50", "100"]);
        assert_eq!(texts(-1.4, -0.3), ["0.05", "0.1", "0.2", "0.5"]);
        assert_eq!(texts(-1.1, -0.6), ["0.1", "0.15", "0.2"]);
        assert_eq!(texts(0.9, 1.4), ["10", "15", "20"]);
        assert_eq!(texts(-0.1, 0.3), ["1", "1.5"]);
        assert_eq!(texts(3.8, 6.1), ["10\u{a0}000", "100\u{a0}000", "1\u{a0}000\u{a0}000"]);
    }

    #[test]
    fn there_are_neither_too_few_nor_too_many() {
        for span in 1..80 {
            for shift in 0..10 {
                let low = f64::from(shift) * 0.1 - 3.0;
                let count = LogAxis { low, high: low + f64::from(span) * 0.5 }.ticks().len();
                assert!((2..=12).contains(&count), "{count} ticks from {low}");
            }
        }
    }

    #[test]
    fn an_axis_has_room_for_nothing_and_for_one_value() {
        assert_eq!(LogAxis::around(std::iter::empty()), LogAxis { low: 0.0, high: 2.0 });
        let one = LogAxis::around(std::iter::once(1.0));
        assert!(one.low < 0.8 && one.high > 1.2);
        let many = LogAxis::around([0.0, 1.0, 3.0].into_iter());
        assert!(many.low < -0.1 && many.high > 3.1);
    }
}
