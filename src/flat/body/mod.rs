//! Shapes as evaluators see them: numbers, and rows of data behind them.
//!
//! | file | what it makes |
//! |---|---|
//! | `tube` | arcs of a curve with radii |
//! | `outline` | arcs of an outline, cut so that each only rises |
//! | `relief` | layers of noise, waves, heights of an image |

mod outline;
mod relief;
mod tube;

use glam::DVec3;
pub(super) use relief::spline;

use crate::geometry::Aabb;
use crate::scene::{Heights, SHAPE_FLOATS, Shape, ShapeKind, text_outline};

/// A shape, ready to be evaluated.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// Which function evaluates it.
    pub kind: ShapeKind,
    /// Its parameters; of a shape with data what was made of them.
    pub parameters: [f64; SHAPE_FLOATS],
    /// Its data, with a ball around the shape first (centre, radius); nothing for a shape without.
    pub rows: Vec<[f64; 4]>,
    /// A box around the surface, in local space.
    pub bounds: Aabb,
}

impl Body {
    /// What a shape is evaluated with.
    pub fn new(shape: &Shape) -> Self {
        let (kind, bounds) = (shape.kind(), shape.bounds());
        let Numbers { parameters, rows } = match shape {
            Shape::Tube { points, radius, closed } => tube::tube(points, *radius, *closed),
            Shape::Extrusion { corners, smooth, depth, rounding } => {
                outline::extrusion(corners, *smooth, *depth, *rounding)
            }
            Shape::Text { text, font, size, depth, rounding } => {
                outline::text(&text_outline(text, font, *size), *depth, *rounding)
            }
            Shape::Heightmap { image, size, height } => relief::heightmap(Heights::of(image), *size, *height),
            Shape::Revolution { corners, smooth, offset } => outline::revolution(corners, *smooth, *offset),
            Shape::Terrain { size, amplitude, wavelength, octaves, roughness, seed } => {
                relief::terrain(*size, *amplitude, *wavelength, *octaves, *roughness, *seed)
            }
            Shape::Ocean { size, amplitude, wavelength, waves, direction, spread, sharpness, phase } => {
                let run = [*direction, *spread, *phase].map(f64::to_radians);
                relief::ocean(*size, *amplitude, *wavelength, *waves, run, *sharpness)
            }
            _ => Numbers { parameters: shape.packed(), rows: Vec::new() },
        };
        let mut rows = rows;
        if kind.has_data() {
            let ball = ball(bounds.center(), bounds.half().length());
            rows.insert(0, ball);
        }
        Self { kind, parameters, rows, bounds }
    }
}

/// Parameters and data of a body.
struct Numbers {
    parameters: [f64; SHAPE_FLOATS],
    rows: Vec<[f64; 4]>,
}

impl Numbers {
    /// The parameters as they stand in their first rows.
    fn new(first: [f64; 4], second: [f64; 4], rows: Vec<[f64; 4]>) -> Self {
        let mut parameters = [0.0; SHAPE_FLOATS];
        parameters[..4].copy_from_slice(&first);
        parameters[4..8].copy_from_slice(&second);
        Self { parameters, rows }
    }
}

/// A row with a ball, a little larger so that f32 may round.
fn ball(center: DVec3, radius: f64) -> [f64; 4] {
    let room = 1e-6 * (radius + center.abs().max_element());
    [center.x, center.y, center.z, radius + room]
}
