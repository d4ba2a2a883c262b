//! The field doctor: each seeded fault is found and named, its repair mends it, and one undo takes the repair back.

use std::sync::Arc;

use egui::{Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use glam::DVec3;
use isolith::editor::Editor;
use isolith::export::GpuStudio;
use isolith::field::doctor::{Checks, FindingKind, examine as examine_scene};
use isolith::render::AdapterChoice;
use isolith::scene::{Group, MaterialId, Node, NodeId, NodeKind, Object, Operator, Scene, Shape};

use super::{click, open, press, undo_all};
use crate::settle::Settle;

fn ball(name: &str, radius: f64) -> Node {
    Node::new(name, NodeKind::Object(Object { shape: Shape::Sphere { radius }, material: MaterialId(1) }))
}

/// A ball with a notch, which is sound.
fn sound() -> (Scene, [NodeId; 3]) {
    let mut scene = Scene::new();
    let group = Group { operator: Operator::Difference, ..Group::UNION };
    let group = scene.insert(None, 0, Node::new("Notched", NodeKind::Group(group))).unwrap();
    let first = scene.insert(Some(group), 0, ball("Body", 0.5)).unwrap();
    let cutter = scene.insert(Some(group), 1, ball("Cutter", 0.3).at(DVec3::X * 0.5)).unwrap();
    (scene, [group, first, cutter])
}

fn changed(mut scene: Scene, id: NodeId, change: impl Fn(&mut Node)) -> Scene {
    let mut node = Node::clone(scene.node(id).unwrap());
    change(&mut node);
    scene.replace(node).unwrap();
    scene
}

/// Opens the window, which looks at once.
fn examine(harness: &mut Harness<'_, Editor>) {
    press(harness, Modifiers::NONE, Key::F10);
    harness.settle();
}

fn kinds(harness: &Harness<'_, Editor>) -> Vec<(FindingKind, NodeId)> {
    let findings = harness.state().findings().expect("it has looked");
    findings.iter().map(|finding| (finding.kind, finding.node)).collect()
}

fn press_button(harness: &mut Harness<'_, Editor>, name: &str) {
    let at = harness.get_by_label(name).rect().center();
    click(harness, at);
}

#[test]
fn a_sound_scene_has_no_findings() {
    let mut harness = open(sound().0);
    examine(&mut harness);
    assert_eq!(kinds(&harness), []);
    // There is no device here.
    harness.get_by_label("Nothing is wrong. What nodes cost was not measured.");
}

#[test]
fn each_seeded_fault_is_named_and_its_repair_is_one_step_of_undo() {
    let (scene, [_, first, cutter]) = sound();
    let hidden = changed(scene.clone(), first, |node| node.visible = false);
    let far = changed(scene.clone(), cutter, |node| node.transform.translation = DVec3::X * 3.0);
    let flat = changed(scene.clone(), first, |node| node.transform.scale = DVec3::new(1.0, -1e-4, 1.0));
    let mut with_empty = scene;
    let empty = with_empty.insert(None, 1, Node::new("Nothing", NodeKind::Group(Group::UNION))).unwrap();
    for (scene, kind, node, button) in [
        (hidden, FindingKind::HiddenFirst, first, "Show it: Body"),
        (far, FindingKind::CutsNothing, cutter, "Hide it: Cutter"),
        (flat, FindingKind::ExtremeScale, first, "Reset scale: Body"),
        (with_empty, FindingKind::Empty, empty, "Delete it: Nothing"),
    ] {
        let mut harness = open(scene.clone());
        examine(&mut harness);
        assert!(kinds(&harness).contains(&(kind, node)), "{kind:?}: {:?}", kinds(&harness));
        press_button(&mut harness, button);
        assert!(!kinds(&harness).contains(&(kind, node)), "{kind:?} is still there: {:?}", kinds(&harness));
        assert_ne!(*harness.state().document().scene(), scene);
        press(&mut harness, Modifiers::COMMAND, Key::Z);
        assert_eq!(*harness.state().document().scene(), scene, "{kind:?}: undo takes it back");
        assert_eq!(undo_all(&mut harness), 0);
        press_button(&mut harness, "Scan the scene");
        assert!(kinds(&harness).contains(&(kind, node)), "{kind:?} is found again");
    }
}

#[test]
fn several_repairs_are_one_step_and_a_click_selects_and_frames() {
    let (scene, [_, first, _]) = sound();
    let mut scene = changed(scene, first, |node| node.visible = false);
    scene.insert(None, 1, Node::new("Nothing", NodeKind::Group(Group::UNION))).unwrap();
    let mut harness = open(scene.clone());
    examine(&mut harness);
    let before = harness.state().view().camera;
    press_button(&mut harness, "Find Body");
    assert_eq!(harness.state().document().selection(), [first]);
    assert_ne!(harness.state().view().camera, before);
    press_button(&mut harness, "Repair all 2");
    assert_eq!(kinds(&harness), []);
    press(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!(*harness.state().document().scene(), scene);
}

#[test]
fn costs_are_measured_and_named() {
    let (mut scene, [group, ..]) = sound();
    let busy = scene.insert(None, 1, ball("Busy", 0.4).at(DVec3::X * 5.0)).unwrap();
    let mut harness = open(scene);
    harness.state_mut().set_studio(Arc::new(GpuStudio::new(AdapterChoice::default())));
    examine(&mut harness);
    press_button(&mut harness, "Cost");
    harness.get_by_label_contains(" ms for ");
    let names = ["Cost of Notched", "Cost of Busy"].map(|name| harness.query_by_label(name).is_some());
    assert!(names[0] || harness.query_by_label_contains("and 1 more").is_some(), "{names:?} {group} {busy}");
}

#[test]
fn the_examples_are_healthy() {
    // The head of the character is a model, which a session makes; a placeholder stands in for it here.
    for (name, scene) in isolith::gallery::all().into_iter().filter(|(name, _)| *name != "character") {
        let flat = isolith::field::flatten(&scene, 0.0).expect("within the limits");
        let task = isolith::jobs::Task::new("examining");
        let findings = examine_scene(&scene, &flat, &Checks::default(), &task).expect("nobody cancels");
        // The fields of fractals are estimates that stay far below the distance.
        let is_meant = |kind| kind == FindingKind::SmallSteps && ["shapes", "fractals"].contains(&name);
        let findings: Vec<_> = findings.into_iter().filter(|finding| !is_meant(finding.kind)).collect();
        assert_eq!(findings, [], "{name}");
    }
}
