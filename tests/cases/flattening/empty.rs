//! The empty set is an operand like any other.

use glam::DVec3;
use isolith::field::reference::image::render_reference;
use isolith::field::{FlatScene, Warning};
use isolith::scene::{Attachment, CameraNode, Group, Light, Modifier, Node, NodeId, NodeKind, Operator, Scene, Shape};

use super::{ALL_AXES, add, around, ball, blended, flat, group, load, object};

/// Number of kinds of the empty set.
const KINDS: usize = 9;

/// Adds an empty set of this kind below `parent`.
fn add_nothing(scene: &mut Scene, parent: Option<NodeId>, kind: usize) {
    let blank = |text: &str| {
        object(Shape::Text { text: text.into(), font: Attachment::NONE, size: 1.0, depth: 0.2, rounding: 0.0 })
    };
    let no_size = || object(Shape::Box { size: [0.0; 3], rounding: 0.0 });
    let named = |node: Node| Node { name: "nothing".into(), ..node };
    match kind {
        0 => drop(add(scene, parent, named(group(Operator::Union)))),
        1 => {
            let hides = add(scene, parent, named(group(Operator::Union)));
            add(scene, Some(hides), Node { visible: false, ..ball() });
        }
        2 => drop(add(scene, parent, named(blank("")))),
        3 => drop(add(scene, parent, named(blank(" \n ")))),
        4 => drop(add(scene, parent, named(no_size()))),
        5 => drop(add(scene, parent, named(object(Shape::Sphere { radius: 0.0 })).at(DVec3::X))),
        6 => {
            let outer = add(scene, parent, named(group(Operator::Union)));
            let inner = add(scene, Some(outer), group(Operator::Difference));
            add(scene, Some(inner), no_size());
        }
        7 => drop(add(scene, parent, named(group(Operator::Union)).modified(ALL_AXES).modified(around(1024)))),
        _ => {
            let twisted = named(group(Operator::Intersection)).modified(Modifier::Twist { angle: 90.0 });
            let outer = add(scene, parent, twisted);
            add(scene, Some(outer), blank("\u{a0}"));
        }
    }
}

fn count(flat: &FlatScene) -> usize {
    flat.components.len()
}

#[test]
fn cases_of_empty_operands_are_nothing_by_every_evaluator() {
    for (name, warned) in [("difference", 1), ("intersection", 1), ("hidden-base", 0)] {
        let flat = flat(&load(&format!("empty-operand/{name}.json")));
        assert_eq!((count(&flat), flat.nodes.len()), (0, 0), "{name}");
        assert_eq!(flat.warnings.len(), warned, "{name}: {:?}", flat.warnings);
        for Warning { node, reason, .. } in &flat.warnings {
            assert_eq!((node.0, reason.contains("g1 (#1)")), (2, true), "{name}: {reason}");
        }
        let picture =
            render_reference(&flat, &[], &flat.cameras[0].camera, [16, 12], &|_| {}).expect("nothing to trace");
        assert!(picture.buffers.depth.iter().all(|depth| depth.is_infinite()), "{name}");
    }
}

#[test]
fn every_operator_takes_every_kind_of_nothing() {
    let lone = {
        let mut scene = Scene::new();
        add(&mut scene, None, ball());
        flat(&scene)
    };
    for operator in Operator::ALL {
        // The result with the empty set as first and as last operand.
        let expected = match operator {
            Operator::Union | Operator::Xor => [true, true],
            Operator::Intersection | Operator::Pipe | Operator::Morph => [false, false],
            _ => [false, true],
        };
        for kind in 0..KINDS {
            for (last, expected) in [false, true].into_iter().zip(expected) {
                let mut scene = Scene::new();
                let parent = Some(add(&mut scene, None, blended(operator)));
                if last {
                    add(&mut scene, parent, ball());
                }
                add_nothing(&mut scene, parent, kind);
                if !last {
                    add(&mut scene, parent, ball());
                }
                let flat = flat(&scene);
                let what = format!("{operator:?}, kind {kind}, last: {last}");
                assert_eq!(count(&flat), usize::from(expected), "{what}");
                if expected {
                    assert_eq!((&flat.params, flat.nodes.len()), (&lone.params, 1), "{what}");
                }
                let names: Vec<&str> = flat.warnings.iter().map(|warning| &*warning.name).collect();
                assert_eq!(names, if expected { vec![] } else { vec!["nothing"] }, "{what}: {:?}", flat.warnings);
            }
        }
    }
}

#[test]
fn a_morph_with_nothing_follows_its_formula() {
    for (share, first, expected) in [(0.0, true, 1), (0.0, false, 0), (1.0, true, 0), (1.0, false, 1), (0.5, true, 0)] {
        let mut scene = Scene::new();
        let morph = NodeKind::Group(Group { share, ..Group::new(Operator::Morph, isolith::scene::Blend::HARD) });
        let parent = Some(add(&mut scene, None, Node::new("morph", morph)));
        if first {
            add(&mut scene, parent, ball());
        }
        add_nothing(&mut scene, parent, 0);
        if !first {
            add(&mut scene, parent, ball());
        }
        assert_eq!(count(&flat(&scene)), expected, "{share} {first}");
    }
}

#[test]
fn what_follows_nothing_goes_on_by_the_same_rules() {
    let kinds = |operator, nothings: [bool; 3]| {
        let mut scene = Scene::new();
        let parent = Some(add(&mut scene, None, blended(operator)));
        for (i, nothing) in nothings.into_iter().enumerate() {
            if nothing {
                add_nothing(&mut scene, parent, i);
            } else {
                add(&mut scene, parent, ball().at(DVec3::X * i as f64));
            }
        }
        flat(&scene).nodes.iter().filter(|node| node.is_leaf()).count()
    };
    assert_eq!(kinds(Operator::Union, [true, false, false]), 2);
    assert_eq!(kinds(Operator::Union, [false, true, false]), 2);
    assert_eq!(kinds(Operator::Xor, [true, true, false]), 1);
    assert_eq!(kinds(Operator::Difference, [false, true, false]), 2);
    assert_eq!(kinds(Operator::Difference, [true, false, false]), 0);
    assert_eq!(kinds(Operator::Intersection, [false, true, false]), 0, "nothing stays nothing");
    assert_eq!(kinds(Operator::Union, [true, true, true]), 0);
}

#[test]
fn negative_children_cut_nothing_from_nothing() {
    let mut scene = Scene::new();
    let parent = Some(add(&mut scene, None, blended(Operator::Union)));
    add_nothing(&mut scene, parent, 0);
    let cutter = add(&mut scene, parent, ball().subtracted());
    assert_eq!(count(&flat(&scene)), 0);
    assert_eq!(flat(&scene).warnings.iter().map(|w| w.node).collect::<Vec<_>>(), [cutter]);
    // An empty cutter cuts nothing and needs no warning.
    let mut scene = Scene::new();
    add(&mut scene, None, ball());
    add(&mut scene, None, group(Operator::Union).subtracted());
    assert_eq!((count(&flat(&scene)), flat(&scene).warnings.len()), (1, 0));
}

#[test]
fn a_hidden_child_is_left_out_and_a_hidden_base_hides_what_works_on_it() {
    for operator in Operator::ALL {
        for hidden in [0, 1] {
            let mut scene = Scene::new();
            let parent = Some(add(&mut scene, None, blended(operator)));
            for i in 0..2 {
                add(&mut scene, parent, Node { visible: i != hidden, ..ball().at(DVec3::X * i as f64) });
            }
            let flat = flat(&scene);
            let expected = hidden == 1 || !operator.needs_first();
            assert_eq!(count(&flat), usize::from(expected), "{operator:?}, hidden: {hidden}");
            assert!(flat.warnings.is_empty(), "who hides something knows it: {:?}", flat.warnings);
        }
    }
}

#[test]
fn lights_and_cameras_in_a_group_of_their_own_are_no_operands() {
    for operator in Operator::ALL {
        let mut scene = Scene::new();
        let parent = Some(add(&mut scene, None, blended(operator)));
        let lights = Some(add(&mut scene, parent, group(Operator::Union)));
        add(&mut scene, lights, Node::new("sun", NodeKind::Light(Light::sun())));
        let lens = CameraNode { fov_y: 40.0, near: 0.01, far: 20.0, ..CameraNode::default() };
        add(&mut scene, lights, Node::new("lens", NodeKind::Camera(lens)));
        add(&mut scene, parent, ball());
        let flat = flat(&scene);
        assert_eq!((count(&flat), flat.lights.len(), flat.cameras.len()), (1, 1, 1), "{operator:?}");
        assert!(flat.warnings.is_empty(), "{:?}", flat.warnings);
    }
}

#[test]
fn lights_in_a_group_of_which_nothing_is_left_still_shine() {
    let mut scene = Scene::new();
    let parent = Some(add(&mut scene, None, blended(Operator::Difference).modified(around(3))));
    add_nothing(&mut scene, parent, 0);
    add(&mut scene, parent, Node::new("sun", NodeKind::Light(Light::sun())));
    add(&mut scene, parent, ball());
    assert_eq!((count(&flat(&scene)), flat(&scene).lights.len()), (0, 1));
}

#[test]
fn a_point_that_a_modifier_thickens_is_something() {
    let no_size = || object(Shape::Box { size: [0.0; 3], rounding: 0.0 });
    for modifier in [
        Modifier::Round { radius: 0.3 },
        Modifier::Elongate { length: [1.0; 3] },
        Modifier::Onion { thickness: 0.1, walls: 1, spacing: 0.2 },
    ] {
        let mut scene = Scene::new();
        add(&mut scene, None, no_size().modified(modifier.clone()));
        assert_eq!(count(&flat(&scene)), 1, "{modifier:?}");
        let mut scene = Scene::new();
        let parent = add(&mut scene, None, blended(Operator::Union).modified(modifier.clone()));
        add(&mut scene, Some(parent), no_size());
        assert_eq!(count(&flat(&scene)), 1, "{modifier:?} of a group");
    }
    let mut scene = Scene::new();
    add(&mut scene, None, no_size().modified(Modifier::Twist { angle: 90.0 }));
    assert_eq!(count(&flat(&scene)), 0);
}
