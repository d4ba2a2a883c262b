//! Small drawings of the shapes.

use std::f32::consts::TAU;

use egui::{Color32, Painter, Pos2, Rect, Shape, Stroke, vec2};

use isolith_scene::ShapeKind;

/// Paints the silhouette of a shape, seen a little from above.
pub fn paint_shape(painter: &Painter, rect: Rect, kind: ShapeKind, color: Color32) {
    let pen = Pen { painter, rect, stroke: Stroke::new((rect.height() / 13.0).max(1.0), color) };
    if !(pen.balls(kind) || pen.rings(kind) || pen.prisms(kind) || pen.tips(kind) || pen.drawn(kind)) {
        pen.ellipse([0.0, 0.0], [0.8, 0.8], 0.0, 1.0);
    }
}

/// Draws in a square from −1 to 1, y down.
struct Pen<'a> {
    painter: &'a Painter,
    rect: Rect,
    stroke: Stroke,
}

impl Pen<'_> {
    /// Balls and parts of them. Like the following methods, returns whether it has drawn the shape.
    fn balls(&self, kind: ShapeKind) -> bool {
        match kind {
            ShapeKind::Sphere => {
                self.ellipse([0.0, 0.0], [0.8, 0.8], 0.0, 1.0);
                self.ellipse([0.0, 0.0], [0.8, 0.28], 0.0, 0.5);
            }
            ShapeKind::Ellipsoid => {
                self.ellipse([0.0, 0.0], [0.92, 0.55], 0.0, 1.0);
                self.ellipse([0.0, 0.0], [0.92, 0.2], 0.0, 0.5);
            }
            ShapeKind::Mandelbulb => {
                self.ellipse([0.0, 0.0], [0.55, 0.55], 0.0, 1.0);
                for i in 0..7 {
                    let angle = TAU * i as f32 / 7.0;
                    let outward = [0.68 * angle.sin(), -0.68 * angle.cos()];
                    self.ellipse(outward, [0.24, 0.24], (i as f32 / 7.0) - 0.53, 0.56);
                }
            }
            ShapeKind::Julia => {
                self.ellipse([-0.35, 0.2], [0.5, 0.6], 0.3, 0.75);
                self.ellipse([0.4, -0.25], [0.5, 0.55], 0.8, 0.75);
                self.ellipse([0.1, 0.65], [0.2, 0.2], 0.0, 1.0);
                self.ellipse([-0.15, -0.7], [0.2, 0.2], 0.0, 1.0);
            }
            ShapeKind::Kleinian => {
                self.ellipse([0.0, 0.0], [0.35, 0.35], 0.0, 1.0);
                for (x, y) in [(0.0, -0.62), (0.59, -0.2), (0.37, 0.5), (-0.37, 0.5), (-0.59, -0.2)] {
                    self.ellipse([x, y], [0.22, 0.22], 0.0, 1.0);
                }
            }
            ShapeKind::CutSphere => {
                self.ellipse([0.0, 0.3], [0.85, 0.85], 0.5, 0.5);
                self.ellipse([0.0, 0.3], [0.85, 0.28], 0.0, 0.5);
            }
            ShapeKind::HollowCutSphere => {
                self.ellipse([0.0, -0.2], [0.85, 0.85], 0.0, 0.5);
                self.ellipse([0.0, -0.2], [0.85, 0.28], 0.0, 1.0);
            }
            ShapeKind::DeathStar => {
                self.ellipse([0.0, 0.05], [0.85, 0.85], -0.12, 0.74);
                self.ellipse([0.0, -0.54], [0.62, 0.3], 0.0, 1.0);
            }
            ShapeKind::SolidAngle => {
                self.line(&[[-0.6, -0.45], [0.0, 0.9], [0.6, -0.45]]);
                self.ellipse([0.0, -0.45], [0.6, 0.22], 0.0, 1.0);
                self.ellipse([0.0, -0.45], [0.6, 0.42], 0.5, 0.5);
            }
            ShapeKind::Vesica => {
                self.ellipse([-0.6, 0.0], [1.1, 1.1], -0.157, 0.314);
                self.ellipse([0.6, 0.0], [1.1, 1.1], 0.343, 0.314);
            }
            ShapeKind::Capsule => {
                self.ellipse([0.0, -0.4], [0.45, 0.45], 0.5, 0.5);
                self.ellipse([0.0, 0.4], [0.45, 0.45], 0.0, 0.5);
                self.line(&[[-0.45, -0.4], [-0.45, 0.4]]);
                self.line(&[[0.45, -0.4], [0.45, 0.4]]);
            }
            _ => return false,
        }
        true
    }

    /// Rings and sheets.
    fn rings(&self, kind: ShapeKind) -> bool {
        match kind {
            ShapeKind::Torus => {
                self.ellipse([0.0, 0.0], [0.92, 0.6], 0.0, 1.0);
                self.ellipse([0.0, -0.05], [0.4, 0.2], 0.0, 1.0);
            }
            ShapeKind::CappedTorus => {
                self.ellipse([0.0, 0.0], [0.92, 0.65], 0.08, 0.84);
                self.ellipse([0.0, 0.0], [0.5, 0.3], 0.08, 0.84);
                self.line(&[[0.81, 0.31], [0.44, 0.14]]);
                self.line(&[[0.81, -0.31], [0.44, -0.14]]);
            }
            ShapeKind::Link => {
                for (x, y) in [(0.45, 0.5), (0.25, 0.2)] {
                    self.ellipse([0.45, 0.0], [x, y], -0.25, 0.5);
                    self.ellipse([-0.45, 0.0], [x, y], 0.25, 0.5);
                    self.line(&[[-0.45, -y], [0.45, -y]]);
                    self.line(&[[-0.45, y], [0.45, y]]);
                }
            }
            ShapeKind::PolygonRing => {
                self.line(&[
                    [-0.9, 0.0],
                    [-0.7, -0.35],
                    [0.7, -0.35],
                    [0.9, 0.0],
                    [0.7, 0.35],
                    [-0.7, 0.35],
                    [-0.9, 0.0],
                ]);
                self.ellipse([0.0, -0.12], [0.45, 0.14], 0.0, 1.0);
                self.line(&[[-0.9, 0.0], [-0.45, 0.08], [0.45, 0.08], [0.9, 0.0]]);
            }
            ShapeKind::Plane => self.line(&[[-0.95, 0.3], [-0.3, -0.35], [0.95, -0.3], [0.3, 0.4], [-0.95, 0.3]]),
            ShapeKind::Triangle => self.line(&[[-0.9, -0.4], [0.7, -0.5], [0.2, 0.65], [-0.9, -0.4]]),
            ShapeKind::Quad => self.line(&[[-0.6, -0.45], [0.8, -0.45], [0.6, 0.5], [-0.8, 0.5], [-0.6, -0.45]]),
            ShapeKind::Star => {
                let tips = (0..=10).map(|i| {
                    let (angle, far) = (TAU * (i as f32 / 10.0 - 0.25), if i % 2 == 0 { 0.95 } else { 0.4 });
                    [far * angle.cos(), far * angle.sin()]
                });
                self.line(&tips.collect::<Vec<_>>());
            }
            _ => return false,
        }
        true
    }

    /// Boxes, cylinders, prisms.
    fn prisms(&self, kind: ShapeKind) -> bool {
        match kind {
            ShapeKind::Box => self.cube(),
            ShapeKind::MengerSponge => {
                self.cube();
                self.line(&[[-0.5, -0.02], [-0.25, 0.1], [-0.25, 0.42], [-0.5, 0.3], [-0.5, -0.02]]);
                self.line(&[[0.5, -0.02], [0.25, 0.1], [0.25, 0.42], [0.5, 0.3], [0.5, -0.02]]);
                self.line(&[[0.0, -0.58], [0.25, -0.45], [0.0, -0.32], [-0.25, -0.45], [0.0, -0.58]]);
            }
            ShapeKind::BoxFrame => {
                self.cube();
                self.line(&[[-0.4, 0.32], [-0.4, 0.0], [-0.2, -0.1]]);
                self.line(&[[0.4, 0.32], [0.4, 0.0], [0.2, -0.1]]);
            }
            ShapeKind::Cylinder => self.tapered(0.65, 0.65),
            ShapeKind::InfiniteCylinder => {
                self.line(&[[-0.5, -0.9], [-0.5, 0.9]]);
                self.line(&[[0.5, -0.9], [0.5, 0.9]]);
                self.ellipse([0.0, -0.1], [0.5, 0.18], 0.0, 0.5);
            }
            ShapeKind::HexagonalPrism => self.prism(),
            ShapeKind::TriangularPrism => {
                self.line(&[[-0.85, -0.5], [0.85, -0.5], [0.0, 0.0], [-0.85, -0.5]]);
                self.line(&[[-0.85, -0.5], [-0.85, 0.25], [0.0, 0.8], [0.85, 0.25], [0.85, -0.5]]);
                self.line(&[[0.0, 0.0], [0.0, 0.8]]);
            }
            ShapeKind::Prism => {
                self.line(&[[-0.85, -0.45], [0.0, -0.75], [0.85, -0.45], [0.5, -0.1], [-0.5, -0.1], [-0.85, -0.45]]);
                self.line(&[[-0.85, -0.45], [-0.85, 0.3], [-0.5, 0.75], [0.5, 0.75], [0.85, 0.3], [0.85, -0.45]]);
                self.line(&[[-0.5, -0.1], [-0.5, 0.75]]);
                self.line(&[[0.5, -0.1], [0.5, 0.75]]);
            }
            ShapeKind::Rhombus => {
                self.line(&[[0.0, -0.55], [0.9, -0.1], [0.0, 0.35], [-0.9, -0.1], [0.0, -0.55]]);
                self.line(&[[-0.9, -0.1], [-0.9, 0.25], [0.0, 0.7], [0.9, 0.25], [0.9, -0.1]]);
                self.line(&[[0.0, 0.35], [0.0, 0.7]]);
            }
            _ => return false,
        }
        true
    }

    /// Shapes with a tip.
    fn tips(&self, kind: ShapeKind) -> bool {
        match kind {
            ShapeKind::CappedCone => self.tapered(0.75, 0.35),
            ShapeKind::RoundCone => {
                self.ellipse([0.0, -0.5], [0.38, 0.38], 0.53, 0.44);
                self.ellipse([0.0, 0.3], [0.6, 0.6], -0.03, 0.56);
                self.line(&[[-0.37, -0.57], [-0.59, 0.18]]);
                self.line(&[[0.37, -0.57], [0.59, 0.18]]);
            }
            ShapeKind::Cone => {
                self.line(&[[-0.7, 0.9], [0.0, -0.8], [0.7, 0.9]]);
                self.ellipse([0.0, 0.3], [0.45, 0.15], 0.0, 0.5);
            }
            ShapeKind::Pyramid => {
                self.line(&[[0.0, -0.85], [-0.85, 0.4], [0.1, 0.8], [0.85, 0.35], [0.0, -0.85]]);
                self.line(&[[0.0, -0.85], [0.1, 0.8]]);
            }
            ShapeKind::Octahedron => {
                self.line(&[[0.0, -0.9], [-0.75, 0.05], [0.0, 0.9], [0.75, 0.05], [0.0, -0.9]]);
                self.line(&[[-0.75, 0.05], [-0.15, 0.25], [0.75, 0.05]]);
                self.line(&[[0.0, -0.9], [-0.15, 0.25], [0.0, 0.9]]);
            }
            _ => return false,
        }
        true
    }

    /// Shapes with points, and heightfields.
    fn drawn(&self, kind: ShapeKind) -> bool {
        match kind {
            ShapeKind::Tube => {
                self.wave(0.45, [-0.15, -0.3]);
                self.wave(0.45, [0.15, 0.3]);
                self.ellipse([-0.8, 0.0], [0.17, 0.3], 0.0, 1.0);
                self.ellipse([0.8, 0.0], [0.17, 0.3], 0.75, 0.5);
            }
            ShapeKind::Extrusion => {
                let corner = |i: u8, by: f32| {
                    let angle = TAU * f32::from(i) / 10.0;
                    let r = if i.is_multiple_of(2) { 0.75 } else { 0.34 };
                    [r * angle.sin() + by, -r * angle.cos() - by]
                };
                self.line(&std::array::from_fn::<_, 11, _>(|i| corner(i as u8, -0.1)));
                self.line(&std::array::from_fn::<_, 5, _>(|i| corner(i as u8, 0.15)));
            }
            ShapeKind::Revolution => {
                self.line(&[[-0.5, -0.85], [-0.3, -0.45], [-0.65, 0.1], [-0.2, 0.7], [-0.5, 0.85]]);
                self.line(&[[0.5, -0.85], [0.3, -0.45], [0.65, 0.1], [0.2, 0.7], [0.5, 0.85]]);
                self.ellipse([0.0, -0.85], [0.5, 0.12], 0.0, 1.0);
                self.ellipse([0.0, 0.85], [0.5, 0.12], 0.0, 0.5);
            }
            ShapeKind::Text => {
                self.line(&[[-0.75, 0.8], [0.0, -0.85], [0.75, 0.8]]);
                self.line(&[[-0.45, 0.2], [0.45, 0.2]]);
            }
            ShapeKind::Terrain => {
                self.line(&[[-0.95, 0.5], [-0.4, -0.5], [-0.1, 0.0], [0.3, -0.75], [0.95, 0.5], [-0.95, 0.5]]);
                self.line(&[[0.05, -0.25], [0.25, -0.1], [0.35, -0.25], [0.55, -0.2]]);
            }
            ShapeKind::Heightmap => {
                self.line(&[[-0.9, -0.8], [0.9, -0.8], [0.9, 0.8], [-0.9, 0.8], [-0.9, -0.8]]);
                self.line(&[[-0.9, 0.55], [-0.4, -0.2], [-0.1, 0.2], [0.35, -0.4], [0.9, 0.45]]);
                self.ellipse([-0.45, -0.5], [0.15, 0.15], 0.0, 1.0);
            }
            ShapeKind::MeshField => {
                self.line(&[[-0.8, 0.7], [-0.5, -0.4], [0.1, -0.85], [0.75, -0.2], [0.6, 0.7], [-0.8, 0.7]]);
                self.line(&[[-0.5, -0.4], [0.05, 0.1], [0.75, -0.2]]);
                self.line(&[[-0.8, 0.7], [0.05, 0.1], [0.6, 0.7]]);
                self.line(&[[0.1, -0.85], [0.05, 0.1]]);
            }
            ShapeKind::Ocean => {
                self.wave(0.25, [-0.45, -0.45]);
                self.wave(0.25, [0.0, 0.0]);
                self.wave(0.25, [0.45, 0.45]);
            }
            _ => return false,
        }
        true
    }

    fn at(&self, [x, y]: [f32; 2]) -> Pos2 {
        self.rect.center() + vec2(x, y) * self.rect.height() * 0.5
    }

    fn line(&self, points: &[[f32; 2]]) {
        self.painter.add(Shape::line(points.iter().map(|p| self.at(*p)).collect(), self.stroke));
    }

    /// Part of an ellipse; `start` and `share` are in turns, clockwise from +X.
    fn ellipse(&self, center: [f32; 2], radii: [f32; 2], start: f32, share: f32) {
        let points = (0..=32).map(|i| {
            let angle = TAU * (start + share * i as f32 / 32.0);
            self.at([center[0] + radii[0] * angle.cos(), center[1] + radii[1] * angle.sin()])
        });
        self.painter.add(Shape::line(points.collect(), self.stroke));
    }

    /// A wave of one and a half periods from left to right, `height` high, between two heights.
    fn wave(&self, height: f32, [from, to]: [f32; 2]) {
        let points = (0..=32).map(|i| {
            let t = i as f32 / 32.0;
            self.at([2.0 * t - 1.0, from + (to - from) * t - height * (TAU * 1.5 * t).sin() * 0.5])
        });
        self.painter.add(Shape::line(points.collect(), self.stroke));
    }

    fn cube(&self) {
        self.line(&[
            [0.0, -0.85],
            [0.78, -0.45],
            [0.78, 0.45],
            [0.0, 0.85],
            [-0.78, 0.45],
            [-0.78, -0.45],
            [0.0, -0.85],
        ]);
        self.line(&[[-0.78, -0.45], [0.0, -0.05], [0.78, -0.45]]);
        self.line(&[[0.0, -0.05], [0.0, 0.85]]);
    }

    fn tapered(&self, bottom: f32, top: f32) {
        self.ellipse([0.0, -0.6], [top, top * 0.35], 0.0, 1.0);
        self.ellipse([0.0, 0.6], [bottom, bottom * 0.35], 0.0, 0.5);
        self.line(&[[-top, -0.6], [-bottom, 0.6]]);
        self.line(&[[top, -0.6], [bottom, 0.6]]);
    }

    fn prism(&self) {
        let top = [[-0.8, -0.4], [-0.4, -0.68], [0.4, -0.68], [0.8, -0.4], [0.4, -0.12], [-0.4, -0.12], [-0.8, -0.4]];
        self.line(&top);
        self.line(&[[-0.8, -0.4], [-0.8, 0.4], [-0.4, 0.68], [0.4, 0.68], [0.8, 0.4], [0.8, -0.4]]);
        self.line(&[[-0.4, -0.12], [-0.4, 0.68]]);
        self.line(&[[0.4, -0.12], [0.4, 0.68]]);
    }
}
