//! The lattice of a selected instancer over the picture: its limits with a dot at each cell border, and lines that
//! fade out along axes without end.

use egui::{Color32, Painter, Stroke};
use glam::{DAffine3, DVec3};

use super::instancing::{SHOWN_CELLS, cells, instancer};
use super::projection::Projection;
use super::state::EditorState;
use super::theme;
use isolith_scene::{Lattice, NodeId};

/// Most cells with dots along an axis.
const MOST_DOTS: f64 = 64.0;
/// Most rings drawn.
const MOST_RINGS: u32 = 16;
/// Segments of a ring.
const SEGMENTS: u32 = 96;

/// One axis of a lattice in cells.
#[derive(Clone, Copy, Debug, PartialEq)]
struct CellAxis {
    spacing: f64,
    /// Half the number of cells; [`SHOWN_CELLS`] without end, 0 for a single one.
    half: f64,
    is_endless: bool,
}

impl CellAxis {
    fn new(count: u32, spacing: f64) -> Self {
        let half = match count {
            0 => SHOWN_CELLS,
            1 => 0.0,
            count => 0.5 * f64::from(count),
        };
        Self { spacing, half, is_endless: count == 0 }
    }

    /// Where lines along other axes cross this one, in meters: its two ends, or its middle.
    fn crossings(&self) -> Vec<f64> {
        if self.is_endless || self.half == 0.0 { vec![0.0] } else { [-1.0, 1.0].map(|s| s * self.end()).into() }
    }

    fn end(&self) -> f64 {
        self.half * self.spacing
    }
}

/// A line in the instancer's space, and how visible its ends are.
#[derive(Clone, Copy, Debug, PartialEq)]
struct LatticeLine {
    ends: [DVec3; 2],
    /// From 0 to 1.
    strength: f64,
    /// Whether a dot marks its first end.
    dotted: bool,
}

fn lines(lattice: &Lattice) -> Vec<LatticeLine> {
    match (cells(lattice), *lattice) {
        (Some((counts, spacing)), _) => {
            let axes = [0, 1, 2].map(|axis| CellAxis::new(counts[axis], spacing[axis]));
            (0..3).flat_map(|axis| along(&axes, axis)).collect()
        }
        (None, Lattice::Polar { rings, radius, spacing, .. }) => ring_lines(rings, radius, spacing),
        (None, _) => Vec::new(),
    }
}

/// The edges of the box of cells along an axis, cell by cell.
fn along(axes: &[CellAxis; 3], axis: usize) -> Vec<LatticeLine> {
    let line = axes[axis];
    let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
    let dotted = 2.0 * line.half <= MOST_DOTS;
    let steps = if dotted { (2.0 * line.half).round() as u32 } else { 1 };
    let mut all = Vec::new();
    for (v, w) in axes[b].crossings().into_iter().flat_map(|v| axes[c].crossings().into_iter().map(move |w| (v, w))) {
        let at = |share: f64| {
            let mut point = DVec3::ZERO;
            (point[axis], point[b], point[c]) = (line.end() * share, v, w);
            point
        };
        for step in 0..steps {
            let share = |step: u32| 2.0 * f64::from(step) / f64::from(steps) - 1.0;
            let (from, to) = (share(step), share(step + 1));
            let strength = if line.is_endless { 1.0 - (0.5 * (from + to)).abs() } else { 1.0 };
            all.push(LatticeLine { ends: [at(from), at(to)], strength, dotted });
        }
    }
    all
}

/// The innermost and the outermost ring, and the ones between unless they are many.
fn ring_lines(rings: u32, radius: f64, spacing: f64) -> Vec<LatticeLine> {
    let last = rings.saturating_sub(1);
    let step = last.div_ceil(MOST_RINGS).max(1);
    let drawn = (0..last).step_by(step as usize).chain([last]);
    let circle = |ring: u32| {
        let far = radius + f64::from(ring) * spacing;
        let at = move |segment: u32| {
            let angle = std::f64::consts::TAU * f64::from(segment) / f64::from(SEGMENTS);
            far * DVec3::new(angle.cos(), 0.0, angle.sin())
        };
        (0..SEGMENTS).map(move |s| LatticeLine { ends: [at(s), at(s + 1)], strength: 1.0, dotted: false })
    };
    drawn.flat_map(circle).collect()
}

/// Paints the lattices of the selected instancers.
pub fn paint(state: &EditorState, painter: &Painter, projection: &Projection) {
    let scene = state.session.document.scene();
    let selection = state.session.document.selection();
    for id in selection {
        let Some(instancer) = scene.node(*id).and_then(|node| instancer(node)) else { continue };
        let color = if selection.last() == Some(id) { *theme::GROUP } else { theme::GROUP.gamma_multiply(0.6) };
        paint_lines(painter, projection, &scene.world_from_local(*id), &lines(&instancer.lattice), color);
    }
}

fn paint_lines(
    painter: &Painter,
    projection: &Projection,
    world_from_local: &DAffine3,
    lines: &[LatticeLine],
    color: Color32,
) {
    /// Below this many points between them, dots would merge.
    const LEAST_GAP: f32 = 6.0;
    for line in lines {
        let [from, to] = line.ends.map(|end| projection.to_screen(world_from_local.transform_point3(end)));
        let (Some(from), Some(to)) = (from, to) else { continue };
        let color = color.gamma_multiply(0.8 * line.strength as f32);
        painter.line_segment([from, to], Stroke::new(1.0, color));
        if line.dotted && from.distance(to) > LEAST_GAP {
            painter.circle_filled(from, 1.8, color);
        }
    }
}

/// The nodes whose lattice has lines: the box of their content is not drawn besides.
pub fn has_lines(state: &EditorState, id: NodeId) -> bool {
    let scene = state.session.document.scene();
    let lattice = scene.node(id).and_then(|node| instancer(node)).map(|instancer| instancer.lattice);
    !matches!(lattice, None | Some(Lattice::Scatter { .. } | Lattice::Curve { .. }))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn length(line: &LatticeLine) -> f64 {
        line.ends[0].distance(line.ends[1])
    }

    #[test]
    fn a_box_has_an_edge_of_cells_along_each_axis() {
        let all = lines(&Lattice::Grid { counts: [4, 3, 2], spacing: [1.0, 2.0, 3.0] });
        assert_eq!(all.len(), 4 * (4 + 3 + 2));
        assert!(all.iter().all(|line| line.strength == 1.0 && line.dotted));
        let most = all.iter().flat_map(|line| line.ends).fold(DVec3::ZERO, |most, end| most.max(end));
        assert_eq!(most, DVec3::new(2.0, 3.0, 3.0), "half of the cells to each side");
        let flat = lines(&Lattice::Grid { counts: [4, 1, 2], spacing: [1.0; 3] });
        assert_eq!(flat.len(), 2 * (4 + 2), "a single layer has no height");
    }

    #[test]
    fn axes_without_end_fade_out_and_long_ones_have_no_dots() {
        let all = lines(&Lattice::Grid { counts: [0, 1, 0], spacing: [2.0; 3] });
        assert_eq!(all.len(), 2 * 16, "a cross");
        let strongest = all.iter().map(|line| line.strength).fold(0.0, f64::max);
        let weakest = all.iter().map(|line| line.strength).fold(1.0, f64::min);
        assert!(strongest > 0.9 && weakest < 0.1, "{strongest} {weakest}");
        let long = lines(&Lattice::Grid { counts: [1_000_000, 1, 1], spacing: [1.0; 3] });
        assert_eq!(long.len(), 1);
        assert!(!long[0].dotted && length(&long[0]) == 1e6);
    }

    #[test]
    fn rings_are_drawn_up_to_the_last() {
        for rings in [1, 3, 1_000] {
            let all = lines(&Lattice::Polar { count: 5, rings, radius: 3.0, spacing: 2.0 });
            assert!(all.len() <= (SEGMENTS * (MOST_RINGS + 2)) as usize);
            let far = all.iter().map(|line| line.ends[0].length()).fold(0.0, f64::max);
            assert!((far - (3.0 + 2.0 * f64::from(rings - 1))).abs() < 1e-9, "{far}");
        }
    }
}
