//! FLIP: how different two pictures look when they alternate (Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström and
//! Fairchild, "FLIP: A Difference Evaluator for Alternating Images", 2020). For pictures with colors from 0 to 1, after
//! the formulas and constants of the paper.

use std::f64::consts::PI;

use glam::{DMat3, DVec2, DVec3};

/// Pixels per degree of the eye: a screen of 3840 pixels and 0.7 m, seen from 0.7 m.
pub(super) const PIXELS_PER_DEGREE: f64 = 67.020_643;

/// White of the standard illuminant D65.
const WHITE: DVec3 = DVec3::new(0.950_428_545, 1.0, 1.088_900_371);

/// A picture of linear Rec. 709 colors, row after row.
#[derive(Clone, Debug)]
pub(super) struct Picture {
    pub width: usize,
    pub colors: Vec<DVec3>,
}

impl Picture {
    fn map(&self, of: impl Fn(DVec3) -> DVec3) -> Self {
        Self { width: self.width, colors: self.colors.iter().map(|color| of(*color)).collect() }
    }

    /// The color of a pixel; beyond the edges that of the nearest.
    fn at(&self, x: i64, y: i64) -> DVec3 {
        let height = self.colors.len() / self.width;
        let [x, y] = [(x, self.width), (y, height)].map(|(at, size)| at.clamp(0, size as i64 - 1) as usize);
        self.colors[y * self.width + x]
    }

    /// The sum over the neighbors of each pixel, with the weights of `kernel` up to `radius`.
    fn filtered<T: std::iter::Sum<T>>(&self, radius: i64, kernel: impl Fn(DVec2, DVec3) -> T) -> Vec<T> {
        let around = |i: usize| {
            let [x, y] = [i % self.width, i / self.width].map(|at| at as i64);
            let offsets = (-radius..=radius).flat_map(|dy| (-radius..=radius).map(move |dx| [dx, dy]));
            offsets.map(|[dx, dy]| kernel(DVec2::new(dx as f64, dy as f64), self.at(x + dx, y + dy))).sum()
        };
        (0..self.colors.len()).map(around).collect()
    }
}

fn xyz_from_linear() -> DMat3 {
    DMat3::from_cols(
        DVec3::new(10_135_552.0 / 24_577_794.0, 2_613_072.0 / 12_288_897.0, 1_425_312.0 / 73_733_382.0),
        DVec3::new(8_788_810.0 / 24_577_794.0, 8_788_810.0 / 12_288_897.0, 8_788_810.0 / 73_733_382.0),
        DVec3::new(4_435_075.0 / 24_577_794.0, 887_015.0 / 12_288_897.0, 70_074_185.0 / 73_733_382.0),
    )
}

/// Opponent colors: lightness, red against green, yellow against blue.
fn opponent(linear: DVec3) -> DVec3 {
    let DVec3 { x, y, z } = xyz_from_linear() * linear / WHITE;
    DVec3::new(116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z))
}

fn linear_from_opponent(color: DVec3) -> DVec3 {
    let y = (color.x + 16.0) / 116.0;
    let xyz = DVec3::new(y + color.y / 500.0, y, y - color.z / 200.0) * WHITE;
    xyz_from_linear().inverse() * xyz
}

/// CIELAB, with chroma by lightness after Hunt.
fn lab(linear: DVec3) -> DVec3 {
    let root =
        |t: f64| if t > (6.0_f64 / 29.0).powi(3) { t.cbrt() } else { t * (29.0_f64 / 6.0).powi(2) / 3.0 + 4.0 / 29.0 };
    let DVec3 { x, y, z } = (xyz_from_linear() * linear / WHITE).map(root);
    let lightness = 116.0 * y - 16.0;
    DVec3::new(lightness, 0.01 * lightness * 500.0 * (x - y), 0.01 * lightness * 200.0 * (y - z))
}

/// The distance of colors by Abasi, Amani Tehran and Fairchild.
fn hyab(a: DVec3, b: DVec3) -> f64 {
    let off = a - b;
    off.x.abs() + off.y.hypot(off.z)
}

/// What the eye resolves of the colors: a filter by the sensitivity to contrast of each channel.
fn seen(picture: &Picture, per_degree: f64) -> Picture {
    let gauss = |[a, b]: [f64; 2], r: f64| a * (PI / b).sqrt() * (-(PI * r).powi(2) / b).exp();
    let channel = |first: [f64; 2], second: [f64; 2], r: f64| gauss(first, r) + gauss(second, r);
    let none = [0.0, 1e-5];
    let weights = |offset: DVec2| {
        let r = offset.length() / per_degree;
        DVec3::new(
            channel([1.0, 0.0047], none, r),
            channel([1.0, 0.0053], none, r),
            channel([34.1, 0.04], [13.5, 0.025], r),
        )
    };
    let radius = (3.0 * (0.04 / (2.0 * PI * PI)).sqrt() * per_degree).ceil() as i64;
    let whole = Picture { width: 1, colors: vec![DVec3::ONE] }.filtered(radius, |offset, one| weights(offset) * one)[0];
    let colors = picture.map(opponent).filtered(radius, |offset, color| weights(offset) * color / whole);
    let shown = Picture { width: picture.width, colors };
    shown.map(|color| lab(linear_from_opponent(color).clamp(DVec3::ZERO, DVec3::ONE)))
}

/// Strength of edges and of points at each pixel.
fn features(picture: &Picture, per_degree: f64) -> Vec<DVec2> {
    let deviation = 0.5 * 0.082 * per_degree;
    let radius = (3.0 * deviation).ceil() as i64;
    let bell = |offset: DVec2| (-offset.length_squared() / (2.0 * deviation * deviation)).exp();
    let edge = |along: f64, offset: DVec2| -along * bell(offset);
    let point = |along: f64, offset: DVec2| (along * along / (deviation * deviation) - 1.0) * bell(offset);
    // Positive and negative weights each sum to 1.
    let one = Picture { width: 1, colors: vec![DVec3::ONE] };
    let sums = |weight: &dyn Fn(f64, DVec2) -> f64| {
        let of = |sign: f64| one.filtered(radius, |offset, _| (sign * weight(offset.x, offset)).max(0.0))[0];
        [of(1.0), of(-1.0)]
    };
    let [of_edges, of_points] = [sums(&edge), sums(&point)];
    let unit = |weight: f64, [positive, negative]: [f64; 2]| weight / if weight > 0.0 { positive } else { negative };
    let gray = picture.map(|color| DVec3::splat((opponent(color).x + 16.0) / 116.0));
    let along = |axis: usize| {
        gray.filtered(radius, |offset, color| {
            let at = offset[axis];
            DVec2::new(unit(edge(at, offset), of_edges), unit(point(at, offset), of_points)) * color.x
        })
    };
    let length = |(x, y): (DVec2, DVec2)| DVec2::new(x.x.hypot(y.x), x.y.hypot(y.y));
    along(0).into_iter().zip(along(1)).map(length).collect()
}

/// The difference of each pixel, from 0 to 1.
pub(super) fn flip(a: &Picture, b: &Picture, per_degree: f64) -> Vec<f64> {
    assert!(a.width == b.width && a.colors.len() == b.colors.len(), "pictures of one size");
    let (power, share, target) = (0.7, 0.4, 0.95);
    let most = hyab(lab(DVec3::Y), lab(DVec3::Z)).powf(power);
    let of_color = |(a, b): (&DVec3, &DVec3)| {
        let off = hyab(*a, *b).powf(power);
        let knee = share * most;
        if off < knee { off * target / knee } else { target + (off - knee) / (most - knee) * (1.0 - target) }
    };
    let [shown_a, shown_b] = [a, b].map(|picture| seen(picture, per_degree));
    let [features_a, features_b] = [a, b].map(|picture| features(picture, per_degree));
    let colors = shown_a.colors.iter().zip(&shown_b.colors).map(of_color);
    let of_features = |(a, b): (DVec2, DVec2)| ((a - b).abs().max_element() / 2.0_f64.sqrt()).sqrt();
    let features = features_a.into_iter().zip(features_b).map(of_features);
    colors.zip(features).map(|(color, feature)| color.powf(1.0 - feature)).collect()
}

#[test]
fn it_is_0_for_equal_pictures_and_1_for_opposite_colors() {
    let of = |color: DVec3| Picture { width: 8, colors: vec![color; 64] };
    let mean = |a: &Picture, b: &Picture| flip(a, b, PIXELS_PER_DEGREE).iter().sum::<f64>() / 64.0;
    let gray = of(DVec3::splat(0.3));
    assert_eq!(mean(&gray, &gray), 0.0);
    // Green and blue are the farthest apart, by definition.
    assert!((mean(&of(DVec3::Y), &of(DVec3::Z)) - 1.0).abs() < 1e-9);
    let steps: Vec<f64> = [0.31, 0.4, 0.8].map(|v| mean(&gray, &of(DVec3::splat(v)))).to_vec();
    assert!(steps[0] > 0.0 && steps[0] < 0.1 && steps[0] < steps[1] && steps[1] < steps[2], "{steps:?}");
}

#[test]
fn an_edge_counts_for_more_than_its_color() {
    let flat = Picture { width: 32, colors: vec![DVec3::splat(0.3); 1024] };
    let line = |x: usize| DVec3::splat(if x == 16 { 0.6 } else { 0.3 });
    let lined = Picture { width: 32, colors: (0..1024).map(|i| line(i % 32)).collect() };
    let found = flip(&flat, &lined, PIXELS_PER_DEGREE);
    let on = found[16 * 32 + 16];
    assert!(on > found[16 * 32 + 2] && on > 0.1, "{on}");
    let round_trip = DVec3::new(0.2, 0.7, 0.4);
    assert!((linear_from_opponent(opponent(round_trip)) - round_trip).length() < 1e-9);
}
