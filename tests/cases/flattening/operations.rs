//! Nodes that are added, subtracted or intersected.

use std::path::Path;

use glam::DVec3;
use isolith::field::FlatScene;
use isolith::field::eval::field;
use isolith::field::unflattened::SceneField;
use isolith::scene::{Node, NodeId, Operation, Operator, Scene, Shape, file};

use super::{add, ball, blended, flat, group, object};

/// Three balls along X, and a box that holds half of the one in the middle and none of the last.
fn balls(scene: &mut Scene, parent: Option<NodeId>) {
    for x in [-1.0, 0.5, 4.0] {
        add(scene, parent, ball().at(DVec3::X * x));
    }
}

fn keeper() -> Node {
    object(Shape::Box { size: [3.0, 3.0, 1.0], rounding: 0.0 }).at(DVec3::X * -1.0)
}

/// The value of the arrays at `p`.
fn value(flat: &FlatScene, p: DVec3) -> f64 {
    flat.components.iter().map(|c| field(flat, c, p - c.origin)).fold(f64::INFINITY, f64::min)
}

fn points() -> impl Iterator<Item = DVec3> {
    (0..2000).map(|i| DVec3::new(1.31, 2.17, 3.79).map(|v| (v * f64::from(i) + v).sin()) * DVec3::new(5.0, 1.2, 1.2))
}

/// Whether both hold the same points; the number of points inside.
fn same(a: &Scene, b: &Scene) -> usize {
    let [a, b] = [a, b].map(flat);
    let mut inside = 0;
    for p in points() {
        let (a, b) = (value(&a, p), value(&b, p));
        assert!((a < 0.0) == (b < 0.0) || a.abs().max(b.abs()) < 1e-6, "{p}: {a} and {b}");
        inside += usize::from(a < 0.0);
    }
    inside
}

#[test]
fn an_intersection_keeps_what_is_inside_of_it_at_the_top_and_in_groups() {
    // What it means, by groups alone.
    let mut meant = Scene::new();
    let all = add(&mut meant, None, group(Operator::Intersection));
    let union = add(&mut meant, Some(all), group(Operator::Union));
    balls(&mut meant, Some(union));
    add(&mut meant, Some(all), keeper());
    for within in [None, Some(group(Operator::Union)), Some(group(Operator::Xor)), Some(blended(Operator::Union))] {
        let is_hard_union = within.as_ref().is_none_or(|node| *node == group(Operator::Union));
        let mut scene = Scene::new();
        let parent = within.map(|node| add(&mut scene, None, node));
        balls(&mut scene, parent);
        add(&mut scene, parent, keeper().intersected());
        let flat = flat(&scene);
        assert!(flat.warnings.is_empty());
        if is_hard_union {
            assert!(same(&scene, &meant) > 20);
        }
        let tree = SceneField::new(&scene).unwrap();
        for p in points() {
            assert_eq!(value(&flat, p) < -1e-5, tree.value(p) < -1e-5, "{p}");
        }
    }
    let mut top = Scene::new();
    balls(&mut top, None);
    assert_eq!(flat(&top).components.len(), 3);
    add(&mut top, None, keeper().intersected());
    assert_eq!(flat(&top).components.len(), 2, "a component that it does not reach is gone");
    // What comes later is not touched, and a subtraction is something else.
    add(&mut top, None, ball().at(DVec3::X * 9.0));
    assert_eq!(flat(&top).components.len(), 3);
}

#[test]
fn an_empty_intersection_leaves_nothing_and_says_so() {
    let mut scene = Scene::new();
    balls(&mut scene, None);
    let empty = add(&mut scene, None, group(Operator::Union).intersected());
    let warned = |scene: &Scene| flat(scene).warnings.iter().map(|w| (w.node, w.reason.clone())).collect::<Vec<_>>();
    assert_eq!(flat(&scene).components.len(), 0);
    assert_eq!(warned(&scene), [(empty, "is empty, so nothing is left of what it keeps".to_owned())]);
    // Nothing stands before it.
    let mut scene = Scene::new();
    let first = add(&mut scene, None, keeper().intersected());
    balls(&mut scene, None);
    assert_eq!(flat(&scene).components.len(), 3);
    assert!(matches!(&warned(&scene)[..], [(node, reason)] if *node == first && reason.contains("intersects")));
    for operator in Operator::ALL {
        let mut scene = Scene::new();
        let parent = Some(add(&mut scene, None, group(operator)));
        balls(&mut scene, parent);
        add(&mut scene, parent, Node { name: "nothing".into(), ..group(Operator::Union).intersected() });
        assert_eq!(flat(&scene).components.len(), 0, "{operator:?}");
        assert_eq!(flat(&scene).warnings.len(), 1, "{operator:?}");
    }
}

#[test]
fn a_cut_holds_for_siblings_that_keep_apart_from_it() {
    // A ball with a hole, and another that blends with the ball, but not with what cuts it.
    for operation in [Operation::Subtract, Operation::Intersect] {
        let mut scene = Scene::new();
        let parent = Some(add(&mut scene, None, blended(Operator::Union)));
        add(&mut scene, parent, ball());
        let cutter = object(Shape::Box { size: [0.5, 4.0, 0.5], rounding: 0.0 });
        let cutter = add(&mut scene, parent, Node { operation, ..cutter });
        add(&mut scene, parent, Node { apart: vec![cutter], ..ball().at(DVec3::X * 2.02) });
        let cut = if operation == Operation::Subtract { DVec3::ZERO } else { DVec3::X * -0.7 };
        assert!(value(&flat(&scene), cut) > 0.0, "{operation:?}: what is cut away came back");
        assert!(SceneField::new(&scene).unwrap().value(cut) > 0.0);
    }
}

#[test]
fn files_name_the_operation_and_earlier_ones_say_negative() {
    let read = |operation: &str| {
        let blend = r#"{"kernel": "circular", "radius": 0}"#;
        let node = format!(r#"{{"id": 1, {operation} "group": {{"operator": "union", "blend": {blend}}}}}"#);
        file::parse(format!(r#"{{"isolith": 2, "nodes": [{node}]}}"#).as_bytes(), Path::new("test.json"))
    };
    for (text, operation) in [
        ("", Operation::Add),
        (r#""negative": false,"#, Operation::Add),
        (r#""negative": true,"#, Operation::Subtract),
        (r#""operation": "add","#, Operation::Add),
        (r#""operation": "subtract","#, Operation::Subtract),
        (r#""operation": "intersect","#, Operation::Intersect),
    ] {
        let scene = read(text).unwrap_or_else(|error| panic!("{text}: {error}"));
        assert_eq!(scene.nodes()[0].operation, operation, "{text}");
        let written = file::to_json(&scene).unwrap();
        assert!(!written.contains("negative"), "{written}");
    }
    for text in [r#""operation": "xor","#, r#""operation": 3,"#, r#""operation": "add", "negative": true,"#] {
        let error = read(text).expect_err(text).to_string();
        assert!(error.contains("nodes[0]"), "{text}: {error}");
    }
}
