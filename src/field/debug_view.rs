//! View modes of a picture besides shading: counts, distances, normals, slopes of the field, ids. The color maps are
//! the counterparts of those in `shaders/debug_view.wgsl`; colors are sRGB from 0 to 1.

use std::str::FromStr;

use glam::{DVec3, Vec3};

use isolith_geometry::Aabb;

/// What a picture shows. The shader uses the same numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum ViewMode {
    /// Light and materials.
    #[default]
    Shaded = 0,
    /// Evaluations of fields by each pixel's rays.
    Steps = 1,
    /// The same plus the pixel's share of the evaluations by its tile's cones.
    Evaluations = 2,
    /// Tape cells looked up for the pixel.
    Cells = 3,
    /// Tape entries read for the pixel.
    Entries = 4,
    /// Distance along the ray, with lines.
    Distance = 5,
    /// World normals.
    Normals = 6,
    /// Length of the field's gradient at the surface.
    Slope = 7,
    /// A color for each node.
    Nodes = 8,
    /// A color for each component.
    Components = 9,
}

/// The range of distances that colors tell apart, in meters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthRange {
    /// End of the first color.
    pub bottom: f64,
    /// Start of the last color.
    pub top: f64,
    /// Distance between two lines.
    pub spacing: f64,
}

/// The legend of a view mode.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Legend {
    /// Meaning of the numbers.
    pub unit: String,
    /// Colors of the bar from left to right; empty if there is no bar.
    pub bar: Vec<Vec3>,
    /// Numbers below the bar, each with its position from 0 to 1.
    pub ticks: Vec<(f32, String)>,
    /// Single colors with their meaning.
    pub swatches: Vec<(Vec3, &'static str)>,
}

/// Colors in the bar of a legend.
const BAR: u16 = 96;
/// Color of pixels without a surface.
pub const DEBUG_VIEW_NOTHING: Vec3 = Vec3::new(0.1, 0.11, 0.13);
/// Color of meshes in modes that show fields only.
const DEBUG_VIEW_MESH: Vec3 = Vec3::new(0.3, 0.31, 0.34);
/// Deviations of a gradient's length from 1 up to this are rounding.
const DEBUG_VIEW_ROUNDING: f32 = 1e-3;

impl ViewMode {
    /// All view modes, in the order of the menu.
    pub const ALL: [Self; 10] = [
        Self::Shaded,
        Self::Steps,
        Self::Evaluations,
        Self::Cells,
        Self::Entries,
        Self::Distance,
        Self::Normals,
        Self::Slope,
        Self::Nodes,
        Self::Components,
    ];

    /// Its name, as menus and the command line write it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Shaded => "shaded",
            Self::Steps => "steps",
            Self::Evaluations => "evaluations",
            Self::Cells => "cells",
            Self::Entries => "entries",
            Self::Distance => "distance",
            Self::Normals => "normals",
            Self::Slope => "slope",
            Self::Nodes => "nodes",
            Self::Components => "components",
        }
    }

    /// One sentence about what it shows.
    pub fn help(self) -> &'static str {
        match self {
            Self::Shaded => "The scene, lit",
            Self::Steps => "How often the rays of a pixel evaluate a field",
            Self::Evaluations => "The same, with the pixel's share of what the cone around its tile evaluates",
            Self::Cells => "How many cells of tapes are looked up for a pixel",
            Self::Entries => "How many entries of tapes are read for a pixel",
            Self::Distance => "How far away the surface is, with lines of equal distance",
            Self::Normals => "Where the surface faces: X, Y and Z as red, green and blue",
            Self::Slope => "How long the field's gradient is; above 1 a field breaks its promise, and rays may miss it",
            Self::Nodes => "Which node the surface follows, a color for each",
            Self::Components => "What is drawn on its own, a color for each",
        }
    }

    /// Whether it needs kernels that count.
    pub fn counts(self) -> bool {
        matches!(self, Self::Steps | Self::Evaluations | Self::Cells | Self::Entries)
    }

    /// The count of the last color of the bar; larger counts are white. It is constant, so that pictures can be
    /// compared.
    pub fn top(self) -> f32 {
        match self {
            Self::Cells => 1024.0,
            Self::Entries => 4096.0,
            _ => 256.0,
        }
    }

    /// The legend of its colors; distances use `depth_range`.
    pub fn legend(self, depth_range: &DepthRange) -> Legend {
        let bar = |color: &dyn Fn(f32) -> Vec3| (0..BAR).map(|i| color(f32::from(i) / f32::from(BAR - 1))).collect();
        let with_unit = |unit: &str| Legend { unit: unit.to_owned(), ..Legend::default() };
        match self {
            Self::Shaded => Legend::default(),
            Self::Steps | Self::Evaluations | Self::Cells | Self::Entries => Legend {
                bar: bar(&debug_view_ramp),
                ticks: count_ticks(self.top()),
                swatches: vec![(Vec3::ONE, "more")],
                ..with_unit(match self {
                    Self::Steps => "evaluations by rays, per pixel",
                    Self::Evaluations => "evaluations by rays and cones, per pixel",
                    Self::Cells => "cells looked up, per pixel",
                    _ => "tape entries read, per pixel",
                })
            },
            Self::Distance => Legend {
                bar: bar(&debug_view_distance),
                ticks: depth_range.ticks(),
                ..with_unit(&format!("meters, a line every {}", trimmed(depth_range.spacing)))
            },
            Self::Normals => Legend {
                swatches: [(Vec3::X, "X"), (Vec3::Y, "Y"), (Vec3::Z, "Z"), (-Vec3::X, "−X"), (-Vec3::Y, "−Y")]
                    .map(|(normal, name)| (debug_view_normal(normal), name))
                    .to_vec(),
                ..with_unit("direction in the world")
            },
            Self::Slope => Legend {
                bar: bar(&|share| debug_view_slope(share * 2.0)),
                ticks: [0.0, 0.5, 1.0, 1.5, 2.0].map(|v| (v / 2.0, trimmed(f64::from(v)))).to_vec(),
                swatches: vec![
                    (debug_view_slope(1.0), "1"),
                    (DEBUG_VIEW_MESH, "mesh"),
                    (debug_view_slope(f32::NAN), "no number"),
                ],
                ..with_unit("length of the gradient, 1 at most")
            },
            Self::Nodes => with_unit("a color for each node"),
            Self::Components => with_unit("a color for each component"),
        }
    }

    /// Its legend in one line, for readers of a picture; empty for [`ViewMode::Shaded`].
    pub fn note(self, depth_range: &DepthRange) -> String {
        let Legend { unit, ticks, swatches, .. } = self.legend(depth_range);
        let ticks: Vec<_> = ticks.into_iter().map(|(_, number)| number).collect();
        let more = if swatches.iter().any(|(_, name)| *name == "more") { ", white is more" } else { "" };
        match (unit.is_empty(), ticks.is_empty()) {
            (true, _) => String::new(),
            (false, true) => format!(" ({unit})"),
            (false, false) => format!(" ({unit}: {}{more})", ticks.join(" ")),
        }
    }
}

impl FromStr for ViewMode {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let names = || Self::ALL.map(Self::name).join(", ");
        Self::ALL
            .into_iter()
            .find(|view_mode| view_mode.name() == name)
            .ok_or_else(|| format!("it is none of {}", names()))
    }
}

impl DepthRange {
    /// The range of the world box `content` as seen from `eye`; both ends are multiples of the spacing.
    pub fn of(content: &Aabb, eye: DVec3) -> Self {
        let far = content.corners().iter().map(|corner| corner.distance(eye)).fold(1e-6, f64::max);
        let near = content.distance(eye).min(far);
        let spacing = round_step((far - near).max(far * 1e-6) / 12.0);
        let bottom = (near / spacing).floor() * spacing;
        Self { bottom, top: ((far / spacing).ceil() * spacing).max(bottom + spacing), spacing }
    }

    /// About four ticks, all of them at lines.
    fn ticks(&self) -> Vec<(f32, String)> {
        let lines = ((self.top - self.bottom) / self.spacing).round();
        let every = (lines / 4.0).ceil().max(1.0);
        let line = |i: u32| f64::from(i) * every;
        (0..=(lines / every) as u32)
            .map(|i| ((line(i) / lines) as f32, trimmed(self.bottom + line(i) * self.spacing)))
            .collect()
    }
}

/// The smallest of 1, 2, 5, 10, 20 … that is at least `least`.
fn round_step(least: f64) -> f64 {
    let power = 10.0_f64.powf(least.log10().floor());
    [1.0, 2.0, 5.0].map(|digit| digit * power).into_iter().find(|step| *step >= least).unwrap_or(10.0 * power)
}

/// Formats a number with at most six significant digits.
fn trimmed(value: f64) -> String {
    let decimals = (5.0 - value.abs().max(1e-6).log10().floor()).clamp(0.0, 9.0) as usize;
    let text = format!("{value:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').into() } else { text }
}

/// Powers of 4 up to `top`, or of 16 if those are too many.
fn count_ticks(top: f32) -> Vec<(f32, String)> {
    let base: u32 = if top > 1024.0 { 16 } else { 4 };
    let powers = (0..).map(|i| base.pow(i)).take_while(|power| *power as f32 <= top);
    [0].into_iter().chain(powers).map(|count| (count_share(count as f32, top), count.to_string())).collect()
}

fn count_share(count: f32, top: f32) -> f32 {
    (1.0 + count).log2() / (1.0 + top).log2()
}

/// The color of an id: the same for the same id, and very different for neighbors.
pub fn id_color(id: u64) -> [u8; 3] {
    // Multiples of the golden ratio spread over the circle of hues; saturation and value tell near hues apart.
    let hue = (id as f64 * 0.618_033_988_749_895).fract() * 6.0;
    let saturation = 0.5 + 0.12 * (id % 3) as f64;
    let value = 0.95 - 0.09 * (id / 3 % 3) as f64;
    // From hue, saturation and value: each channel falls off from its own hue to both sides.
    [0.0, 2.0, 4.0].map(|own: f64| {
        let away = (hue - own).rem_euclid(6.0);
        let strength = (2.0 - away.min(6.0 - away)).clamp(0.0, 1.0);
        (value * (1.0 - saturation * (1.0 - strength)) * 255.0).round() as u8
    })
}

/// From dark blue through green and yellow to red.
pub fn debug_view_ramp(share: f32) -> Vec3 {
    let at = share.clamp(0.0, 1.0) * 5.0;
    let mut color = Vec3::new(0.06, 0.07, 0.14);
    let stops = [[0.16, 0.24, 0.58], [0.1, 0.54, 0.62], [0.44, 0.76, 0.36], [0.97, 0.84, 0.3], [0.9, 0.28, 0.16]];
    for (i, stop) in stops.into_iter().enumerate() {
        color = color.lerp(Vec3::from(stop), (at - i as f32).clamp(0.0, 1.0));
    }
    color
}

/// The color of a count, on a logarithmic scale; white beyond the top.
pub fn debug_view_count(count: f32, top: f32) -> Vec3 {
    if count > top { Vec3::ONE } else { debug_view_ramp(count_share(count, top)) }
}

/// The color of a distance: near is light, far is dark.
pub fn debug_view_distance(share: f32) -> Vec3 {
    let at = share.clamp(0.0, 1.0) * 2.0;
    let nearer = Vec3::new(0.98, 0.93, 0.78).lerp(Vec3::new(0.27, 0.58, 0.64), at.min(1.0));
    nearer.lerp(Vec3::new(0.1, 0.13, 0.27), (at - 1.0).max(0.0))
}

/// The color of a normal: X, Y and Z as red, green and blue.
pub fn debug_view_normal(normal: Vec3) -> Vec3 {
    normal * 0.5 + 0.5
}

/// The color of a gradient's length: blue below 1, gray at 1, orange to red above, magenta if not finite.
pub fn debug_view_slope(slope: f32) -> Vec3 {
    if !slope.is_finite() {
        Vec3::new(1.0, 0.0, 1.0)
    } else if slope > 1.0 + DEBUG_VIEW_ROUNDING {
        Vec3::new(1.0, 0.68, 0.2).lerp(Vec3::new(0.78, 0.06, 0.1), (slope - 1.0).clamp(0.0, 1.0))
    } else if slope < 1.0 - DEBUG_VIEW_ROUNDING {
        Vec3::new(0.08, 0.12, 0.5).lerp(Vec3::new(0.45, 0.68, 0.95), slope.max(0.0))
    } else {
        Vec3::new(0.86, 0.87, 0.85)
    }
}

/// Darkens a color slightly where the surface turns away from the eye, which shows its form.
pub fn debug_view_lit(color: Vec3, facing: f32) -> Vec3 {
    color * (0.6 + 0.4 * facing)
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;

    #[test]
    fn numbers_and_names_are_those_of_the_list() {
        for (number, view_mode) in ViewMode::ALL.into_iter().enumerate() {
            assert_eq!(view_mode as usize, number);
            assert_eq!(view_mode.name().parse(), Ok(view_mode));
        }
        assert!("depth".parse::<ViewMode>().unwrap_err().contains("shaded, steps"));
    }

    #[test]
    fn more_is_another_color_up_to_the_top_and_white_beyond() {
        let top = ViewMode::Steps.top();
        let colors: HashSet<_> =
            (0..=256).map(|n| debug_view_count(n as f32, top).to_array().map(f32::to_bits)).collect();
        assert_eq!(colors.len(), 257);
        assert_eq!(debug_view_count(top + 1.0, top), Vec3::ONE);
        assert_eq!(debug_view_count(0.0, top), debug_view_ramp(0.0));
    }

    #[test]
    fn a_slope_below_at_and_above_one_is_told_apart() {
        let [below, at, above] = [0.99, 1.0005, 1.01].map(debug_view_slope);
        assert!(below.z > below.x + 0.3, "blue: {below}");
        assert!(at.max_element() - at.min_element() < 0.05, "gray: {at}");
        assert!(above.x > above.z + 0.5, "orange: {above}");
        assert_eq!(debug_view_slope(f32::NAN), debug_view_slope(f32::INFINITY));
    }

    #[test]
    fn a_depth_range_holds_what_is_seen_and_its_ticks_are_lines() {
        let content = Aabb::from_center_half(DVec3::ZERO, DVec3::ONE);
        let depth_range = DepthRange::of(&content, DVec3::new(0.0, 0.0, 10.0));
        assert_eq!((depth_range.spacing, depth_range.bottom), (0.2, 9.0));
        assert!(depth_range.top >= 11.0 && depth_range.top < 11.4, "{depth_range:?}");
        let ticks = depth_range.ticks();
        assert_eq!(ticks[0], (0.0, "9".into()));
        assert!((3..=6).contains(&ticks.len()) && ticks.iter().all(|(at, _)| (0.0..=1.0).contains(at)), "{ticks:?}");
        for (half, eye) in [(DVec3::ZERO, DVec3::ZERO), (DVec3::splat(1e6), DVec3::splat(3e6))] {
            let DepthRange { bottom, top, spacing } = DepthRange::of(&Aabb::from_center_half(DVec3::ZERO, half), eye);
            assert!(bottom < top && spacing > 0.0 && (top - bottom) / spacing < 30.0, "{bottom} {top} {spacing}");
        }
    }

    #[test]
    fn neighboring_ids_have_colors_that_differ() {
        for id in 0..100 {
            let [a, b] = [id, id + 1].map(|id| id_color(id).map(i32::from));
            let apart: i32 = (0..3).map(|i| (a[i] - b[i]).abs()).sum();
            assert!(apart > 60, "{id}: {a:?} {b:?}");
        }
    }

    #[test]
    fn every_view_mode_but_the_lit_one_is_explained() {
        let depth_range = DepthRange { bottom: 2.0, top: 4.0, spacing: 0.5 };
        for view_mode in ViewMode::ALL.into_iter().skip(1) {
            let legend = view_mode.legend(&depth_range);
            assert!(!legend.unit.is_empty() && !view_mode.note(&depth_range).is_empty());
            assert_eq!(legend.bar.is_empty(), legend.ticks.is_empty(), "{}", view_mode.name());
        }
        assert_eq!(
            ViewMode::Steps.note(&depth_range),
            " (evaluations by rays, per pixel: 0 1 4 16 64 256, white is more)"
        );
        assert_eq!(ViewMode::Shaded.note(&depth_range), "");
    }
}
