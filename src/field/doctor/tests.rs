//! Each fault, seeded, is found and named; sound scenes have none.

use glam::DVec3;

use super::touching::{Positive, is_positive};
use super::*;
use crate::{LEAF_ROWS, flatten};
use isolith_geometry::Aabb;
use isolith_scene::{Group, MaterialId, Modifier, Node, NodeId, NodeKind, Object, Operator, Shape};

fn object(shape: Shape) -> NodeKind {
    NodeKind::Object(Object { shape, material: MaterialId(1) })
}

fn ball(name: &str, radius: f64) -> Node {
    Node::new(name, object(Shape::Sphere { radius }))
}

/// A group of two balls.
fn pair(operator: Operator, offset: f64) -> (Scene, [NodeId; 3]) {
    let mut scene = Scene::new();
    let group = Group { operator, ..Group::UNION };
    let group = scene.insert(None, 0, Node::new("Pair", NodeKind::Group(group))).unwrap();
    let first = scene.insert(Some(group), 0, ball("First", 0.5)).unwrap();
    let second = scene.insert(Some(group), 1, ball("Second", 0.3).at(DVec3::X * offset)).unwrap();
    (scene, [group, first, second])
}

fn found(scene: &Scene, checks: &Checks) -> Vec<Finding> {
    let flat = flatten(scene, 0.0).unwrap();
    examine(scene, &flat, checks, &Task::new("looking")).unwrap()
}

fn kinds(findings: &[Finding]) -> Vec<(FindingKind, NodeId)> {
    findings.iter().map(|finding| (finding.kind, finding.node)).collect()
}

#[test]
fn sound_scenes_have_no_findings() {
    let (scene, _) = pair(Operator::Difference, 0.5);
    let checks = Checks { wall: Some(0.01), loose_parts: true };
    assert_eq!(found(&scene, &checks), []);
    let mut single = Scene::new();
    single.insert(None, 0, Node::new("Floor", object(Shape::Plane {}))).unwrap();
    assert_eq!(found(&single, &checks), []);
    assert_eq!(found(&Scene::new(), &checks), []);
}

#[test]
fn a_field_of_a_false_slope_is_named_by_its_leaf() {
    let (scene, [_, _, second]) = pair(Operator::Union, 0.5);
    let mut flat = flatten(&scene, 0.0).unwrap();
    let leaf = flat.ids.iter().position(|id| *id == second).unwrap();
    // The factor on the local distance.
    flat.params[flat.nodes[leaf].params as usize][1] *= 1.5;
    let task = Task::new("looking");
    let findings = examine(&scene, &flat, &Checks::default(), &task).unwrap();
    assert_eq!(kinds(&findings), [(FindingKind::Steep, second)]);
    assert!(findings[0].detail.contains("1.5"), "{findings:?}");
    flat.params[flat.nodes[leaf].params as usize + LEAF_ROWS][0] = f32::NAN;
    let findings = examine(&scene, &flat, &Checks::default(), &task).unwrap();
    assert!(kinds(&findings).contains(&(FindingKind::NotFinite, second)), "{findings:?}");
    task.cancel();
    assert!(examine(&scene, &flat, &Checks::default(), &task).is_err());
}

#[test]
fn a_field_that_oversteps_is_seen_though_its_gradient_is_short() {
    let bounds = Aabb::from_center_half(DVec3::ZERO, DVec3::splat(2.0));
    let sound = |p: DVec3| (p.length() - 1.0, p.normalize_or_zero());
    assert!(worst_sample(&sound, &bounds, &[]) == FieldSample::default());
    // A jump, as of copies that do not know their neighbors: the slope is 1 on both sides.
    let jumps = |p: DVec3| {
        let (value, slope) = sound(p);
        (if p.x > 0.3 { value + 0.2 * f64::from(u8::from(value > 0.1)) } else { value }, slope)
    };
    let worst = worst_sample(&jumps, &bounds, &[]);
    assert!(worst.steep.is_none() && worst.overstep.is_some_and(|(excess, _)| excess > 0.1), "{worst:?}");
}

#[test]
fn operands_that_cut_nothing_are_proven() {
    for (offset, is_idle) in [(0.79, false), (0.81, true), (3.0, true), (0.0, false)] {
        let (scene, [_, _, second]) = pair(Operator::Difference, offset);
        let findings = found(&scene, &Checks::default());
        let expected = [(FindingKind::CutsNothing, second)];
        assert_eq!(kinds(&findings), if is_idle { &expected[..] } else { &[] }, "{offset}");
        assert!(findings.iter().all(|finding| finding.repair == Some(Repair::Hide(second))));
    }
    let (scene, [group, ..]) = pair(Operator::Intersection, 3.0);
    let findings = found(&scene, &Checks::default());
    assert!(findings.iter().any(|finding| finding.kind == FindingKind::Empty), "{group}: {findings:?}");
    let unit = Aabb::from_center_half(DVec3::ZERO, DVec3::ONE);
    assert_eq!(is_positive(&|p| p.x + 1.5, &unit), Positive::Everywhere);
    assert_eq!(is_positive(&|p| p.x + 0.9, &unit), Positive::NotEverywhere);
    assert_eq!(is_positive(&|p| p.x + 1.0, &unit), Positive::Undecided, "it touches zero in a face");
}

#[test]
fn what_nodes_say_themselves_is_told_with_a_repair() {
    let (mut scene, [_, first, _]) = pair(Operator::Difference, 0.5);
    let mut hidden = Node::clone(scene.node(first).unwrap());
    hidden.visible = false;
    scene.replace(hidden).unwrap();
    let mut tiny = ball("Tiny", 0.5).at(DVec3::X * 9.0);
    tiny.transform.scale = DVec3::new(1.0, 1e-4, 1.0);
    let tiny = scene.insert(None, 1, tiny).unwrap();
    let empty = scene.insert(None, 2, Node::new("Empty", NodeKind::Group(Group::UNION))).unwrap();
    let point = scene.insert(None, 3, ball("Point", 0.0)).unwrap();
    let findings = found(&scene, &Checks::default());
    for (kind, node, repair) in [
        (FindingKind::HiddenFirst, first, Some(Repair::Show(first))),
        (FindingKind::ExtremeScale, tiny, Some(Repair::ResetScale(tiny))),
        (FindingKind::Empty, empty, Some(Repair::Delete(empty))),
        (FindingKind::Empty, point, None),
    ] {
        let told = findings.iter().find(|finding| finding.kind == kind && finding.node == node);
        assert_eq!(told.map(|finding| finding.repair), Some(repair), "{kind:?}: {findings:?}");
    }
    assert!(findings.is_sorted_by_key(|finding| finding.kind), "gravest first");
}

#[test]
fn modifiers_that_shrink_steps_are_named_with_their_factor() {
    let mut scene = Scene::new();
    let waves = Modifier::Waves { amplitude: 0.1, length: 0.05, phase: 0.0 };
    let wavy = scene.insert(None, 0, ball("Wavy", 0.5).modified(waves)).unwrap();
    let gentle = Modifier::Waves { amplitude: 0.01, length: 0.5, phase: 0.0 };
    scene.insert(None, 1, ball("Gentle", 0.5).modified(gentle).at(DVec3::X * 4.0)).unwrap();
    let findings = found(&scene, &Checks::default());
    assert_eq!(kinds(&findings), [(FindingKind::SmallSteps, wavy)], "{findings:?}");
    assert!(findings[0].detail.contains("times smaller"));
}

#[test]
fn loose_parts_and_thin_walls_are_found_where_they_are() {
    let mut scene = Scene::new();
    let plate = Shape::Box { size: [1.0, 1.0, 0.004], rounding: 0.0 };
    let plate = scene.insert(None, 0, Node::new("Plate", object(plate))).unwrap();
    scene.insert(None, 1, ball("Ball", 0.3).at(DVec3::Z * 0.2)).unwrap();
    let far = scene.insert(None, 2, ball("Far", 0.1).at(DVec3::X * 1.5)).unwrap();
    let findings = found(&scene, &Checks { wall: Some(0.01), loose_parts: true });
    assert_eq!(kinds(&findings), [(FindingKind::LoosePart, far), (FindingKind::ThinWall, plate)], "{findings:?}");
    assert!(["3.99 mm", "10.00 mm"].iter().all(|part| findings[1].detail.contains(part)), "{findings:?}");
    assert!(findings[0].place.is_some_and(|place| place.distance(DVec3::X * 1.5) < 0.2));
    let thinner = found(&scene, &Checks { wall: Some(0.003), loose_parts: false });
    assert_eq!(thinner, [], "thicker than that");
}
