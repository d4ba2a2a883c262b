//! The outlines of what has no surface: cones of lights, frames of cameras, curves through points, the ring of a blend.

use std::f64::consts::TAU;

use glam::DVec3;

use super::kind_rows::SEAM_GAP;
use super::measures::Measures;
use isolith_geometry::ArcPiece;
use isolith_scene::{Dynamic, Falloff, LightKind, Mask, NodeKind, Shape, profile_curve, tube_curve};

/// Corners of a circle.
const CORNERS: usize = 48;
/// Points of an arc.
const ARC_POINTS: usize = 6;

/// Lines in the node's space, each through its points.
pub fn lines(m: &Measures<'_>) -> Vec<Vec<DVec3>> {
    match &m.node.kind {
        NodeKind::Object(object) => curve(&object.shape),
        NodeKind::Light(light) => light_lines(m, &light.light),
        NodeKind::Camera(_) => camera_lines(m),
        NodeKind::Group(group) if group.operator.has_radius() => {
            let radius = (m.number("blend.radius") * m.blend_unit).abs() + SEAM_GAP * m.reach;
            vec![circle(m.seam, m.right, m.up, radius)]
        }
        NodeKind::Instancer(instancer) => {
            let masks = instancer.masks.iter().flat_map(|slot| mask_lines(&slot.mask));
            masks.chain(m.node.dynamics.iter().flat_map(|slot| wind_lines(&slot.dynamic))).collect()
        }
        NodeKind::Group(_) | NodeKind::Mesh(_) => Vec::new(),
    }
}

/// Where a mask by distance begins and ends to be empty.
fn mask_lines(mask: &Mask) -> Vec<Vec<DVec3>> {
    match *mask {
        Mask::Radius { inner, outer } => [inner, outer].map(|at| circle(DVec3::ZERO, DVec3::X, DVec3::Z, at)).into(),
        Mask::Image { width, length, offset, .. } => {
            let corner = |x: f64, z: f64| DVec3::new(offset[0] + 0.5 * x * width, 0.0, offset[2] + 0.5 * z * length);
            vec![vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0), corner(-1.0, -1.0)]]
        }
        Mask::Noise { .. } | Mask::Height { .. } | Mask::Slope { .. } => Vec::new(),
    }
}

/// How far a placed source of wind reaches, and how far at full strength.
fn wind_lines(dynamic: &Dynamic) -> Vec<Vec<DVec3>> {
    let Dynamic::Wind { radius, source, core, .. } = *dynamic else { return Vec::new() };
    if radius <= 0.0 {
        return Vec::new();
    }
    let rings = [radius, core * radius].into_iter().filter(|radius| *radius > 0.0);
    rings.map(|radius| circle(source.into(), DVec3::X, DVec3::Z, radius)).collect()
}

fn circle(center: DVec3, a: DVec3, b: DVec3, radius: f64) -> Vec<DVec3> {
    let at = |i: usize| {
        let (sine, cosine) = (TAU * i as f64 / CORNERS as f64).sin_cos();
        center + (a * cosine + b * sine) * radius
    };
    (0..=CORNERS).map(at).collect()
}

fn curve(shape: &Shape) -> Vec<Vec<DVec3>> {
    match shape {
        Shape::Tube { points, closed, .. } => vec![along(tube_curve(points, *closed).iter().flatten())],
        Shape::Extrusion { corners, smooth, .. } => vec![along(&profile_curve(corners, *smooth))],
        Shape::Revolution { corners, smooth, offset } => {
            let profile = along(&profile_curve(corners, *smooth));
            vec![profile.into_iter().map(|point| point + DVec3::X * *offset).collect()]
        }
        _ => Vec::new(),
    }
}

fn along<'a>(arcs: impl IntoIterator<Item = &'a ArcPiece>) -> Vec<DVec3> {
    let part = |arc: &ArcPiece| {
        let arc = *arc;
        (0..=ARC_POINTS).map(move |i| arc.at(arc.reach * (2.0 * i as f64 / ARC_POINTS as f64 - 1.0)))
    };
    arcs.into_iter().flat_map(part).collect()
}

fn light_lines(m: &Measures<'_>, light: &LightKind) -> Vec<Vec<DVec3>> {
    let ball = |radius: f64| circle(DVec3::ZERO, m.right, m.up, radius);
    let ahead = |falloff: &Falloff| match falloff {
        Falloff::Attenuation { range, .. } => vec![vec![DVec3::ZERO, DVec3::NEG_Z * *range]],
        Falloff::InverseSquare {} => Vec::new(),
    };
    match light {
        LightKind::Sun { .. } => Vec::new(),
        LightKind::Point { radius, falloff, .. } => [vec![ball(*radius)], ahead(falloff)].concat(),
        LightKind::Spot { radius, falloff, inner, outer, .. } => {
            let mut lines = [vec![ball(*radius)], ahead(falloff)].concat();
            for angle in [inner, outer] {
                let (sine, cosine) = angle.to_radians().sin_cos();
                lines.push(circle(DVec3::NEG_Z * (cosine * m.reach), DVec3::X, DVec3::Y, sine * m.reach));
            }
            let (sine, cosine) = outer.to_radians().sin_cos();
            let rim = |across: DVec3| (across * sine - DVec3::Z * cosine) * m.reach;
            lines.extend([DVec3::X, DVec3::NEG_X].map(|across| vec![DVec3::ZERO, rim(across)]));
            lines
        }
        LightKind::Rectangle { width, height, .. } => vec![rectangle(DVec3::ZERO, 0.5 * width, 0.5 * height)],
    }
}

fn rectangle(center: DVec3, half_width: f64, half_height: f64) -> Vec<DVec3> {
    let corner = |x: f64, y: f64| center + DVec3::new(x * half_width, y * half_height, 0.0);
    vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0), corner(-1.0, -1.0)]
}

fn camera_lines(m: &Measures<'_>) -> Vec<Vec<DVec3>> {
    let (sine, cosine) = (0.5 * m.number("fov_y")).to_radians().sin_cos();
    let (height, depth) = (sine * m.reach, cosine * m.reach);
    const ASPECT: f64 = 16.0 / 9.0;
    let frame = rectangle(DVec3::NEG_Z * depth, height * ASPECT, height);
    let mut lines: Vec<_> = frame[..4].iter().map(|corner| vec![DVec3::ZERO, *corner]).collect();
    lines.push(frame);
    if m.number("aperture") > 0.0 {
        lines.push(vec![DVec3::ZERO, DVec3::NEG_Z * m.number("focus_distance")]);
    }
    lines
}
