//! Ghosts: lines on the surface of selected nodes that the picture does not show, because they are cut away or hidden.

use std::sync::Arc;

use egui::{Painter, Pos2, Shape, Stroke};
use glam::{DAffine3, DVec3};

use super::bounds;
use super::projection::Projection;
use super::state::EditorState;
use super::theme;
use isolith_document::extracted;
use isolith_field::flatten;
use isolith_field::scene_eval::SceneEvaluator;
use isolith_geometry::{Aabb, Transform};
use isolith_scene::{Node, NodeId, NodeKind, Operation, Scene};

/// Most ghosts at once.
const MOST: usize = 8;
/// Slices through a ghost along each axis, and cells of a slice along each side.
const SLICES: usize = 5;
const CELLS: usize = 28;
/// The room around the bounds, for blends and modifiers, as a part of their size.
const MARGIN: f64 = 0.12;

/// The lines of one ghost in its own space.
struct Ghost {
    /// The nodes that it was made from.
    nodes: Vec<Arc<Node>>,
    lines: Vec<[DVec3; 2]>,
}

/// The ghosts of the selection, made anew where a node has changed.
#[derive(Default)]
pub struct Ghosts {
    ghosts: Vec<(NodeId, Ghost)>,
}

/// Whether a node cuts others, so that its own surface is not seen whole, by its own setting or by the operator of its group.
fn cuts(scene: &Scene, node: &Node) -> bool {
    let by_operator = || {
        let parent = node.parent.and_then(|id| scene.node(id))?;
        let NodeKind::Group(group) = parent.kind else { return None };
        let first = scene.children(Some(parent.id)).find(|child| child.visible && child.has_field())?;
        Some(group.operator.needs_first() && first.id != node.id)
    };
    node.has_field() && (!node.adds() || by_operator().unwrap_or(false))
}

impl Ghosts {
    /// Paints the ghosts of the selected nodes, and of the subtracted children of selected groups.
    pub fn paint(&mut self, state: &EditorState, painter: &Painter, projection: &Projection) {
        let scene = state.session.document.scene();
        let mut wanted = unseen(scene, state.session.document.selection());
        wanted.truncate(MOST);
        self.ghosts.retain(|(id, ghost)| wanted.contains(id) && is_current(scene, *id, &ghost.nodes));
        for id in wanted {
            if !self.ghosts.iter().any(|(known, _)| *known == id) {
                let Some(ghost) = ghost_of(state, scene, id) else { continue };
                self.ghosts.push((id, ghost));
            }
            let Some((_, ghost)) = self.ghosts.iter().find(|(known, _)| *known == id) else { continue };
            let is_cutter = scene.node(id).is_some_and(|node| cuts(scene, node));
            let color = if is_cutter { theme::NEGATIVE } else { theme::WEAK };
            paint_lines(painter, projection, &ghost.lines, &scene.world_from_local(id), *color);
        }
    }
}

/// The selected nodes that the picture does not show, and the subtracted children of selected groups.
fn unseen(scene: &Scene, selection: &[NodeId]) -> Vec<NodeId> {
    let mut found: Vec<NodeId> = Vec::new();
    for id in selection {
        let is_unseen = |node: &&Arc<Node>| node.has_field() && (!node.visible || cuts(scene, node));
        let own = scene.node(*id).filter(is_unseen).map(|node| node.id);
        let below = scene.children(Some(*id)).filter(|node| node.visible && cuts(scene, node));
        for id in own.into_iter().chain(below.map(|node| node.id)) {
            if !found.contains(&id) {
                found.push(id);
            }
        }
    }
    found
}

/// Whether the node and what is below it have only been moved since.
fn is_current(scene: &Scene, id: NodeId, nodes: &[Arc<Node>]) -> bool {
    let Some(index) = scene.index_of(id) else { return false };
    let now = &scene.nodes()[scene.subtree(index)];
    let placed = |node: &Node| Node { transform: Transform::IDENTITY, ..node.clone() };
    now.len() == nodes.len()
        && now.iter().zip(nodes).enumerate().all(|(place, (now, then))| {
            Arc::ptr_eq(now, then) || (place == 0 && placed(now) == placed(then)) || now == then
        })
}

/// The lines where slices of the node's own space meet its surface.
fn ghost_of(state: &EditorState, scene: &Scene, id: NodeId) -> Option<Ghost> {
    let index = scene.index_of(id)?;
    let nodes = scene.nodes()[scene.subtree(index)].to_vec();
    let mut part = extracted(scene, &[id]).ok()?;
    let top = Node::clone(part.node(id)?);
    let alone = Node { transform: Transform::IDENTITY, operation: Operation::Add, visible: true, ..top };
    part.replace(alone).ok()?;
    let (_, bounds) = bounds::oriented(scene, state.derived.library(), id)?;
    let bounds = bounds.expanded(MARGIN * bounds.half().max_element());
    let flat = flatten(&part, state.session.document.time()).ok()?;
    let mut field = SceneEvaluator::new(&flat);
    let reach = 2.0 * bounds.half().length();
    let mut value = |p: DVec3| field.distance(p, reach).value;
    let mut lines = Vec::new();
    for axis in 0..3 {
        for slice in 0..SLICES {
            let share = (slice + 1) as f64 / (SLICES + 1) as f64;
            lines.extend(contour(&bounds, axis, share, &mut value));
        }
    }
    Some(Ghost { nodes, lines })
}

/// The lines of the zero set in a slice across an axis, by marching squares.
fn contour(bounds: &Aabb, axis: usize, share: f64, value: &mut impl FnMut(DVec3) -> f64) -> Vec<[DVec3; 2]> {
    let [u, v] = [[1, 2], [2, 0], [0, 1]][axis];
    let size = bounds.max - bounds.min;
    let at = |i: usize, j: usize| {
        let mut p = bounds.min;
        p[axis] += size[axis] * share;
        p[u] += size[u] * i as f64 / CELLS as f64;
        p[v] += size[v] * j as f64 / CELLS as f64;
        p
    };
    let values: Vec<f64> =
        (0..(CELLS + 1) * (CELLS + 1)).map(|k| value(at(k % (CELLS + 1), k / (CELLS + 1)))).collect();
    let mut lines = Vec::new();
    for k in 0..CELLS * CELLS {
        let (i, j) = (k % CELLS, k / CELLS);
        let corners = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]];
        let mut crossings = Vec::with_capacity(4);
        for edge in 0..4 {
            let ([ai, aj], [bi, bj]) = (corners[edge], corners[(edge + 1) % 4]);
            let (a, b) = (values[aj * (CELLS + 1) + ai], values[bj * (CELLS + 1) + bi]);
            if (a < 0.0) != (b < 0.0) {
                let t = (a / (a - b)).clamp(0.0, 1.0);
                crossings.push(at(ai, aj).lerp(at(bi, bj), t));
            }
        }
        lines.extend(crossings.chunks_exact(2).map(|pair| [pair[0], pair[1]]));
    }
    lines
}

fn paint_lines(
    painter: &Painter,
    projection: &Projection,
    lines: &[[DVec3; 2]],
    world_from_local: &DAffine3,
    color: egui::Color32,
) {
    let stroke = Stroke::new(1.0, color.gamma_multiply(0.55));
    let shown = |p: DVec3| projection.to_screen(world_from_local.transform_point3(p));
    painter.extend(lines.iter().filter_map(|[a, b]| {
        let ends: [Pos2; 2] = [shown(*a)?, shown(*b)?];
        Some(Shape::line_segment(ends, stroke))
    }));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lines_of_a_ball_lie_on_it() {
        let bounds = Aabb::from_center_half(DVec3::ZERO, DVec3::splat(1.2));
        let mut ball = |p: DVec3| p.length() - 1.0;
        for axis in 0..3 {
            let lines = contour(&bounds, axis, 0.5, &mut ball);
            assert!(lines.len() > CELLS, "{}", lines.len());
            let off = lines.iter().flatten().map(|p| (p.length() - 1.0).abs()).fold(0.0, f64::max);
            assert!(off < 5e-3, "{off}");
            assert!(lines.iter().flatten().all(|p| p[axis].abs() < 1e-12), "in the slice");
        }
        assert!(contour(&bounds, 0, 0.999, &mut ball).is_empty(), "beside it is nothing");
    }
}
