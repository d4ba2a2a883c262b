//! Reproducible random numbers, points and parameters.

use std::io::Cursor;
use std::num::NonZeroUsize;
use std::sync::LazyLock;

use glam::DVec3;
use image::{DynamicImage, ImageBuffer, ImageFormat, Luma};
use isolith::field::PreparedShape;
use isolith::field::eval::{Real, shape_distance};
use isolith::scene::limits::UNIT;
use isolith::scene::{Attached, Limits, ParamValue, Shape, ShapeKind};

/// A small random number generator (Steele, Lea and Flood, "SplitMix", 2014).
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x5851_f42d_4c95_7f2d)
    }

    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in `low..high`.
    pub fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn index(&mut self, count: usize) -> usize {
        (self.bits() % count as u64) as usize
    }

    pub fn chance(&mut self, share: f64) -> bool {
        self.range(0.0, 1.0) < share
    }

    pub fn pick<T: Copy>(&mut self, from: &[T]) -> T {
        from[self.index(from.len())]
    }

    /// Uniform in the cube with this half size.
    pub fn point(&mut self, half: f64) -> DVec3 {
        DVec3::new(self.range(-half, half), self.range(-half, half), self.range(-half, half))
    }

    /// Uniform on the unit sphere.
    pub fn direction(&mut self) -> DVec3 {
        loop {
            let p = self.point(1.0);
            if p.length() < 1.0 && p.length() > 1e-3 {
                return p.normalize();
            }
        }
    }
}

/// `count` times the factor in `ISOLITH_TIMES`, which `make nightly` sets for more samples.
pub fn many(count: usize) -> usize {
    static TIMES: LazyLock<NonZeroUsize> = LazyLock::new(|| match std::env::var("ISOLITH_TIMES") {
        Ok(times) => times.parse().unwrap_or_else(|error| panic!("ISOLITH_TIMES: {error}")),
        Err(_) => NonZeroUsize::MIN,
    });
    count * TIMES.get()
}

/// A shape with all its parameters from `number`, which receives their limits.
pub fn shape_with(kind: ShapeKind, mut number: impl FnMut(&Limits) -> f64) -> Shape {
    let mut shape = kind.default_shape();
    for (i, value) in shape.values().into_iter().enumerate() {
        let limits = kind.params()[i].limits;
        let mut within = |limits: &Limits| number(limits).clamp(limits.hard[0], limits.hard[1]);
        let mut next = || within(&limits);
        let value = match value {
            ParamValue::Scalar(_) => ParamValue::Scalar(next()),
            ParamValue::Vector(_) => ParamValue::Vector(DVec3::new(next(), next(), next())),
            ParamValue::Flag(_) => ParamValue::Flag(next() > 0.5),
            // The file of a model, and its clip.
            ParamValue::Text(text) if kind == ShapeKind::MeshField => ParamValue::Text(text),
            ParamValue::Text(_) => {
                // Up to three letters: an empty text, one profile, profiles with holes.
                let count = within(&Limits::new([0.0, 3.9], [0.0, 3.0], "")) as usize;
                ParamValue::Text("oi8".chars().take(count).collect())
            }
            ParamValue::File(file) => {
                let mut pixel = || (within(&UNIT) * f64::from(u16::MAX)) as u16;
                ParamValue::File(if file.endings().contains(&"png") { image(&file, &mut pixel) } else { file })
            }
            ParamValue::List(mut list) => {
                let more = within(&Limits::new([0.0, 2.9], [0.0, 2.0], "")) as usize;
                let limits: Vec<Limits> = (0..list.columns.len()).map(|c| list.limits(c, &limits)).collect();
                let mut row = || std::array::from_fn(|c| limits.get(c).map_or(0.0, &mut within));
                list.rows = (0..list.count[0] + more).map(|_| row()).collect();
                ParamValue::List(list)
            }
            other => unreachable!("no shape has {other:?}"),
        };
        assert!(shape.set_value(i, value));
    }
    shape
}

/// An image of a few pixels.
pub fn image(instead_of: &Attached, pixel: &mut dyn FnMut() -> u16) -> Attached {
    let pixels = ImageBuffer::from_fn(4, 3, |_, _| Luma([pixel()]));
    let mut bytes = Cursor::new(Vec::new());
    DynamicImage::ImageLuma16(pixels).write_to(&mut bytes, ImageFormat::Png).unwrap();
    instead_of.with("random.png", bytes.into_inner()).unwrap()
}

/// A value in the soft range; lengths up to `longest` meters.
pub fn usual(random: &mut Random, limits: &Limits, longest: f64) -> f64 {
    let [low, high] = limits.soft;
    if limits.unit == "m" { random.range(low.max(-longest), high.min(longest)) } else { random.range(low, high) }
}

/// Ordinary shapes: the default, all zeros, random, and random with zeros.
pub fn ordinary(kind: ShapeKind, count: usize) -> Vec<Shape> {
    let mut random = Random::new(kind as u64);
    let mut shapes = vec![kind.default_shape(), shape_with(kind, |_| 0.0)];
    for i in 0..count {
        let zeros = if i % 3 == 2 { 0.4 } else { 0.0 };
        shapes
            .push(shape_with(kind, |limits| if random.chance(zeros) { 0.0 } else { usual(&mut random, limits, 2.0) }));
    }
    shapes
}

/// Shapes at the limits: mixtures of zeros, tiny and huge values.
pub fn extreme(kind: ShapeKind, count: usize) -> Vec<Shape> {
    let mut random = Random::new(1_000 + kind as u64);
    (0..count).map(|_| shape_with(kind, |_| random.pick(&[0.0, 1e-30, 1e-9, 1e-3, 1.0, 1.0, 1e3, 1e6, 1e9]))).collect()
}

/// The field of a shape.
pub fn evaluate<T: Real>(prepared: &PreparedShape, p: [T; 3]) -> T {
    shape_distance(prepared.kind, p, &prepared.parameters, prepared)
}

/// The size of a shape: the largest of its parameters, or of its bounds if it has a payload.
pub fn size(shape: &Shape) -> f64 {
    if shape.kind().has_data() {
        let bounds = shape.bounds();
        return bounds.min.abs().max(bounds.max.abs()).max_element();
    }
    shape.packed().iter().fold(0.0, |m: f64, v| m.max(v.abs()))
}

/// Points at which formulas break: the center, the axes, planes of symmetry, edges, far away.
pub fn special_points(shape: &Shape) -> Vec<DVec3> {
    let q = if shape.kind().has_data() {
        [shape.bounds().max.to_array(), [0.0; 3]].concat()
    } else {
        shape.packed().to_vec()
    };
    let mut coordinates = vec![0.0, 1e-30, 1e-9, 0.25, 1.0, -1.0, 1e6, -1e9];
    coordinates.extend(q[..3].iter().flat_map(|v| [*v, 0.5 * v, -0.5 * v]));
    let mut points = Vec::new();
    for &x in &coordinates {
        for &y in &coordinates {
            points.extend([DVec3::new(x, y, 0.0), DVec3::new(x, 0.0, y), DVec3::new(0.0, x, y), DVec3::new(x, y, x)]);
        }
    }
    points
}
