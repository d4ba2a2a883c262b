//! What the editor says about instancers: the shares of their types, how many copies they make, what keeps them from
//! making any, and which nodes may be their target.

use std::collections::HashMap;

use glam::DVec3;

use super::numbers::number_text;
use isolith_field::FlatScene;
use isolith_field::copies::{COUNT_LIMITS, CopiesInView, Placement, copies_in_view};
use isolith_geometry::{Aabb, Camera};
use isolith_scene::{Instancer, Lattice, Node, NodeId, NodeKind, Scene, Shape, Snap};

/// The instancer of a node.
pub fn instancer(node: &Node) -> Option<&Instancer> {
    if let NodeKind::Instancer(instancer) = &node.kind { Some(instancer) } else { None }
}

/// The same, mutable.
pub fn instancer_mut(node: &mut Node) -> Option<&mut Instancer> {
    if let NodeKind::Instancer(instancer) = &mut node.kind { Some(instancer) } else { None }
}

/// The share of copies of each type of an instancer, from 0 to 1, in order; all 0 if their weights are.
pub fn shares(scene: &Scene, id: NodeId) -> Vec<(NodeId, f64)> {
    let is_chosen = |node: &Node| node.visible && node.can_be_type();
    let weight = |node: &Node| if is_chosen(node) { node.weight } else { 0.0 };
    let weights: Vec<_> = scene.children(Some(id)).map(|node| (node.id, weight(node))).collect();
    let sum: f64 = weights.iter().map(|(_, weight)| weight).sum();
    weights.into_iter().map(|(id, weight)| (id, if sum > 0.0 { weight / sum } else { 0.0 })).collect()
}

/// The shares of all types in the scene.
pub fn all_shares(scene: &Scene) -> HashMap<NodeId, f64> {
    let instancers = scene.nodes().iter().filter(|node| instancer(node).is_some());
    instancers.flat_map(|node| shares(scene, node.id)).collect()
}

/// A share in percent: whole, unless that would be 0 for what has one.
pub fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    let shown = if percent < 1.0 { (percent * 100.0).round() / 100.0 } else { percent.round() };
    format!("{} %", number_text(shown))
}

/// What its copies need a target for; `None` if they need none.
pub fn need_of_target(instancer: &Instancer) -> Option<TargetNeed> {
    match instancer.lattice {
        Lattice::Scatter { .. } => Some(TargetNeed::Surface),
        Lattice::Curve { .. } => Some(TargetNeed::Curve),
        _ if instancer.snap != Snap::Off => Some(TargetNeed::Surface),
        _ => None,
    }
}

/// What a target must have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TargetNeed {
    /// A surface to stand on.
    Surface,
    /// A curve to follow.
    Curve,
}

impl TargetNeed {
    /// Whether the node can be the target of the instancers.
    pub fn accepts(self, scene: &Scene, node: &Node, instancers: &[NodeId]) -> bool {
        let fits = match (self, &node.kind) {
            (Self::Surface, _) => node.has_field(),
            (Self::Curve, NodeKind::Object(object)) => matches!(object.shape, Shape::Tube { .. }),
            (Self::Curve, _) => false,
        };
        fits && !instancers.iter().any(|instancer| scene.is_within(node.id, *instancer))
    }
}

/// Why an instancer makes no copies, or not where it should.
pub fn problem(scene: &Scene, node: &Node) -> Option<String> {
    let instancer = instancer(node)?;
    let shares = shares(scene, node.id);
    if shares.is_empty() {
        return Some("has no types: drag what it shall copy onto it in the outliner".into());
    }
    if shares.iter().all(|(_, share)| *share == 0.0) {
        return Some("makes no copies: the weights of all types are 0, or all types are hidden".into());
    }
    let need = need_of_target(instancer)?;
    let what = match need {
        TargetNeed::Surface => "a target to stand on",
        TargetNeed::Curve => "a tube as the target to follow",
    };
    let Some(target) = instancer.target else { return Some(format!("needs {what}")) };
    let Some(target) = scene.node(target) else {
        return Some(format!("needs {what}: the one that it had is gone"));
    };
    if scene.is_within(target.id, node.id) {
        return Some(format!("needs another target: {} is one of its own types", target.name));
    }
    let fits = need.accepts(scene, target, &[node.id]);
    (!fits).then(|| format!("needs {what}, which {} is not", target.name))
}

/// Cells shown to each side along an axis without end.
pub const SHOWN_CELLS: f64 = 8.0;

/// Number and size of the cells of a lattice along each axis; `None` for one that is a list of places.
pub fn cells(lattice: &Lattice) -> Option<([u32; 3], [f64; 3])> {
    match *lattice {
        Lattice::Grid { counts, spacing } => Some((counts, spacing)),
        Lattice::Hexagonal { counts, spacing, height } => Some((counts, [spacing, height, spacing * 0.75_f64.sqrt()])),
        Lattice::Polar { .. } | Lattice::Scatter { .. } | Lattice::Curve { .. } => None,
    }
}

/// The box around the places of copies in the instancer's own space; of axes without end the part that is shown.
/// Empty where the places follow from a surface or a curve.
pub fn extent(lattice: &Lattice) -> Aabb {
    let half = match (cells(lattice), *lattice) {
        (Some((counts, spacing)), _) => DVec3::from_array([0, 1, 2].map(|axis| {
            let cells = if counts[axis] == 0 { SHOWN_CELLS } else { 0.5 * f64::from(counts[axis] - 1) };
            cells * spacing[axis]
        })),
        (None, Lattice::Polar { rings, radius, spacing, .. }) => {
            let far = radius + f64::from(rings.saturating_sub(1)) * spacing;
            DVec3::new(far, 0.0, far)
        }
        (None, _) => return Aabb::EMPTY,
    };
    Aabb::from_center_half(DVec3::ZERO, half)
}

/// How many copies an instancer makes whose places the flat scene lists; `None` for others.
pub fn listed_text(flat: &FlatScene, id: NodeId) -> Option<String> {
    let made = flat.instancers.iter().find(|made| made.id == id)?;
    if let Placement::List(list) = &made.placement { Some(copies(list.places.len() as f64)) } else { None }
}

/// How many of an instancer's copies are in view; `None` for one that makes none.
pub fn in_view_text(flat: &FlatScene, id: NodeId, camera: &Camera, aspect: f64) -> Option<String> {
    let made = flat.instancers.iter().find(|made| made.id == id)?;
    // Bounds of meshes are not known here: the middle of a copy counts.
    let CopiesInView { all, cut } = copies_in_view(made, 0.0, camera, aspect, COUNT_LIMITS);
    let count = number_text(all.len() as f64);
    Some(match cut {
        Some(depth) => format!("over {count} in view, as far as {} m", number_text(depth.round())),
        None => format!("{count} in view"),
    })
}

fn copies(count: f64) -> String {
    format!("{} {}", number_text(count), if count == 1.0 { "copy" } else { "copies" })
}

/// How many copies it makes; `None` where that follows from a surface or a curve.
pub fn count_text(instancer: &Instancer) -> Option<String> {
    let (counts, places) = match (cells(&instancer.lattice), instancer.lattice) {
        (Some((counts, _)), _) => (counts, counts.iter().map(|count| f64::from(*count)).product()),
        (None, Lattice::Polar { count, rings, radius, spacing }) => {
            ([1; 3], places_of_rings(count, rings, radius, spacing))
        }
        (None, _) => return None,
    };
    let endless: Vec<_> = (0..3).filter(|axis| counts[*axis] == 0).map(|axis| ["X", "Y", "Z"][axis]).collect();
    let falls = instancer.snap != Snap::Off;
    if !endless.is_empty() {
        return (!falls).then(|| format!("Copies without end along {}", endless.join(", ")));
    }
    let is_thinned = falls || instancer.probability < 1.0 || !instancer.masks.is_empty();
    Some(format!("{}{}", if is_thinned { "At most " } else { "" }, copies(places)))
}

/// Rings keep the distance of their copies along the ring, see [`Lattice::Polar`].
fn places_of_rings(count: u32, rings: u32, radius: f64, spacing: f64) -> f64 {
    let of_ring = |ring: u32| (f64::from(count) * (radius + f64::from(ring) * spacing) / radius).round().max(1.0);
    (0..rings).map(of_ring).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use isolith_scene::{Group, LatticeKind, MaskKind, Object, ShapeKind};

    fn object(scene: &Scene, kind: ShapeKind) -> Node {
        let material = scene.materials()[0].id;
        Node::new(kind.label(), NodeKind::Object(Object { shape: kind.default_shape(), material }))
    }

    #[test]
    fn counts_follow_from_the_lattice() {
        let text = |lattice| count_text(&Instancer { lattice, ..Instancer::default() });
        let grid = |counts| text(Lattice::Grid { counts, spacing: [1.0; 3] }).unwrap();
        assert_eq!(grid([5, 1, 5]), "25 copies");
        assert_eq!(grid([1, 1, 1]), "1 copy");
        assert_eq!(grid([0, 1, 0]), "Copies without end along X, Z");
        let polar = Lattice::Polar { count: 6, rings: 2, radius: 3.0, spacing: 3.0 };
        assert_eq!(text(polar).unwrap(), "18 copies", "twice as many in a ring of twice the radius");
        assert_eq!(text(LatticeKind::Scatter.default_lattice()), None);
        let thin =
            Instancer { masks: vec![MaskKind::Noise.default_mask().into()], ..Instancer::grid([2; 3], [1.0; 3]) };
        assert_eq!(count_text(&thin).unwrap(), "At most 8 copies");
        let fallen = |counts| Instancer { snap: Snap::Down, ..Instancer::grid(counts, [1.0; 3]) };
        assert_eq!(count_text(&fallen([2; 3])).unwrap(), "At most 8 copies");
        assert_eq!(count_text(&fallen([0, 1, 0])), None, "as far as the ground reaches");
    }

    #[test]
    fn every_reason_for_no_copies_is_named() {
        let mut scene = Scene::new();
        let mut node = Node::new("Trees", NodeKind::Instancer(Box::default()));
        node.id = scene.insert(None, 0, node.clone()).unwrap();
        let with = |scene: &mut Scene, node: &Node| {
            scene.replace(node.clone()).unwrap();
            problem(scene, node)
        };
        assert!(with(&mut scene, &node).unwrap().starts_with("has no types"));
        let child = object(&scene, ShapeKind::Sphere).weighted(0.0);
        let child = scene.insert(Some(node.id), 0, child).unwrap();
        assert!(with(&mut scene, &node).unwrap().contains("weights of all types are 0"));
        let mut heavy = Node::clone(scene.node(child).unwrap());
        heavy.weight = 2.0;
        scene.replace(heavy).unwrap();
        assert_eq!(with(&mut scene, &node), None);
        let ground = scene.insert(None, 0, object(&scene, ShapeKind::Box)).unwrap();
        let set = |node: &mut Node, lattice: LatticeKind, target| {
            let instancer = instancer_mut(node).unwrap();
            (instancer.lattice, instancer.target) = (lattice.default_lattice(), target);
        };
        let mut wanted = |lattice, target, says: Option<&str>| {
            set(&mut node, lattice, target);
            let problem = with(&mut scene, &node);
            assert_eq!(problem.is_some(), says.is_some(), "{problem:?}");
            assert!(says.is_none_or(|says| problem.as_ref().unwrap().contains(says)), "{problem:?}");
        };
        wanted(LatticeKind::Scatter, None, Some("needs a target to stand on"));
        wanted(LatticeKind::Scatter, Some(NodeId(99)), Some("is gone"));
        wanted(LatticeKind::Scatter, Some(child), Some("one of its own types"));
        wanted(LatticeKind::Scatter, Some(ground), None);
        wanted(LatticeKind::Curve, Some(ground), Some("needs a tube as the target to follow, which Box is not"));
        wanted(LatticeKind::Grid, None, None);
    }

    #[test]
    fn shares_add_up_and_hidden_types_have_none() {
        let mut scene = Scene::new();
        let parent = scene.insert(None, 0, Node::new("Trees", NodeKind::Instancer(Box::default()))).unwrap();
        let mut add = |weight: f64, visible| {
            let node = Node { visible, ..Node::new("Type", NodeKind::Group(Group::UNION)).weighted(weight) };
            scene.insert(Some(parent), usize::MAX, node).unwrap()
        };
        let [a, b, hidden] = [add(3.0, true), add(1.0, true), add(5.0, false)];
        assert_eq!(shares(&scene, parent), [(a, 0.75), (b, 0.25), (hidden, 0.0)]);
        assert_eq!(all_shares(&scene)[&b], 0.25);
        assert_eq!([0.75, 0.004, 0.0].map(percent), ["75 %", "0.4 %", "0 %"]);
    }
}
