//! Shapes in the form that evaluators read: parameters, and payload rows after them.
//!
//! | file | output |
//! |---|---|
//! | `tube` | arcs of a curve with radii |
//! | `profile` | arcs of a profile, cut so that each only rises |
//! | `heightfield` | layers of noise, waves, heights of an image |
//! | `mesh_field` | where the bricks of a model lie |
//! | `prepared_params` | the parameters of each of them |

mod heightfield;
mod mesh_field;
mod prepared_params;
mod profile;
mod tube;

pub(super) use heightfield::spline;
pub(super) use mesh_field::first_texels;
use prepared_params::{PreparedParams, bounding_sphere};

use std::sync::Arc;

use super::eval::Payload;
use isolith_bricks::BrickLevels;
use isolith_geometry::Aabb;
use isolith_scene::{Heights, SHAPE_FLOATS, Shape, ShapeKind, text_profile};

/// A shape, ready for evaluation.
#[derive(Clone, Debug, PartialEq)]
pub struct PreparedShape {
    /// The kind, which selects the function.
    pub kind: ShapeKind,
    /// Its parameters; for a shape with a payload, those derived from it.
    pub parameters: [f64; SHAPE_FLOATS],
    /// Its payload, which begins with a bounding sphere (center, radius); empty for a shape without.
    pub payload: Vec<[f64; 4]>,
    /// A box around the surface, in local space.
    pub bounds: Aabb,
    /// The bricks of a model.
    pub bricks: Option<Arc<BrickLevels>>,
    /// Whether it shows the looks of its bricks.
    pub has_looks: bool,
}

/// The texel at an index over all levels.
fn level_texel(levels: &BrickLevels, index: usize) -> [u32; 4] {
    let mut at = index;
    for bricks in levels.all() {
        if let Some(texel) = bricks.texels.get(at) {
            return *texel;
        }
        at -= bricks.texels.len();
    }
    [0; 4]
}

impl Payload for PreparedShape {
    fn row(&self, index: usize) -> [f64; 4] {
        self.payload[index]
    }
    fn texel(&self, index: usize) -> [u32; 4] {
        self.bricks.as_ref().map_or([0; 4], |levels| level_texel(levels, index))
    }
}

impl PreparedShape {
    /// Prepares a shape for evaluation.
    pub fn new(shape: &Shape) -> Self {
        let (kind, bounds) = (shape.kind(), shape.bounds());
        let PreparedParams { parameters, payload } = match shape {
            Shape::Tube { points, radius, closed } => tube::tube(points, *radius, *closed),
            Shape::Extrusion { corners, smooth, depth, rounding } => {
                profile::extrusion(corners, *smooth, *depth, *rounding)
            }
            Shape::Text { text, font, size, depth, rounding } => {
                profile::text(&text_profile(text, font, *size), *depth, *rounding)
            }
            Shape::Heightmap { image, size, height } => heightfield::heightmap(Heights::of(image), *size, *height),
            Shape::Revolution { corners, smooth, offset } => profile::revolution(corners, *smooth, *offset),
            Shape::Terrain { size, amplitude, wavelength, octaves, roughness, seed } => {
                heightfield::terrain(*size, *amplitude, *wavelength, *octaves, *roughness, *seed)
            }
            Shape::Ocean { size, amplitude, wavelength, waves, direction, spread, sharpness, phase, speed: _ } => {
                let run = [*direction, *spread, *phase].map(f64::to_radians);
                heightfield::ocean(*size, *amplitude, *wavelength, *waves, run, *sharpness)
            }
            Shape::MeshField { file, .. } => mesh_field::mesh_field(&file.bricks()),
            _ => PreparedParams { parameters: shape.packed(), payload: Vec::new() },
        };
        let mut payload = payload;
        if kind.has_data() {
            let bounding_sphere = bounding_sphere(bounds.center(), bounds.half().length());
            payload.insert(0, bounding_sphere);
        }
        let bricks = match shape {
            Shape::MeshField { file, .. } => Some(file.bricks()),
            _ => None,
        };
        let shows = matches!(shape, Shape::MeshField { file_materials: true, .. });
        let has_looks = shows && bricks.as_ref().is_some_and(|bricks| bricks.has_looks());
        Self { kind, parameters, payload, bounds, bricks, has_looks }
    }
}
