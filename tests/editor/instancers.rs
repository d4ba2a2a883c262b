//! Instancers: made from a selection, their cards, their types in the outliner, presets and seeds.

use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use isolith::editor::{Command, Editor};
use isolith::scene::{
    CurvePreset, Instancer, Lattice, LatticeKind, MAX_DYNAMICS, Mask, MaskJoin, MaskKind, Node, NodeId, NodeKind,
    Scene, Shape, Snap,
};

use super::{click, list_box, open_tall, row, scene, select, undo_all};
use crate::settle::Settle;

/// The scene of the other journeys, with an instancer "Copies" of two types, "Tall" and "Flat", which is selected.
fn with_instancer() -> (Harness<'static, Editor>, Scene, NodeId) {
    let (mut scene, [_, ball, cube, _]) = scene();
    let id = scene.insert(None, 2, Node::new("Copies", NodeKind::Instancer(Box::default()))).unwrap();
    for (name, of) in [("Tall", ball), ("Flat", cube)] {
        let node = Node { name: name.into(), ..Node::clone(scene.node(of).unwrap()) };
        scene.insert(Some(id), usize::MAX, node).unwrap();
    }
    let mut harness = open_tall(scene.clone());
    harness.state_mut().document_mut().select(vec![id]);
    harness.settle();
    (harness, scene, id)
}

fn node(harness: &Harness<'_, Editor>, id: NodeId) -> Node {
    Node::clone(harness.state().document().scene().node(id).unwrap())
}

fn instancer(harness: &Harness<'_, Editor>, id: NodeId) -> Instancer {
    let NodeKind::Instancer(instancer) = node(harness, id).kind else { panic!("no instancer") };
    *instancer
}

fn run(harness: &mut Harness<'_, Editor>, command: Command) {
    let ctx = harness.ctx.clone();
    harness.state_mut().run(command, &ctx);
    harness.settle();
}

/// Presses the button of this name in the inspector.
fn press(harness: &mut Harness<'_, Editor>, name: &str) {
    let buttons = harness.get_all_by_label(name).filter(|n| n.rect().center().x > 900.0);
    let pos = buttons.map(|n| n.rect().center()).next().unwrap_or_else(|| panic!("no button {name}"));
    click(harness, pos);
    harness.run_steps(40);
}

/// Whether a text stands anywhere.
fn says(harness: &Harness<'_, Editor>, text: &str) -> bool {
    harness.query_all_by_label_contains(text).next().is_some()
}

fn type_number(harness: &mut Harness<'_, Editor>, name: &str, value: f64) {
    let found = harness.get_all_by_label(name).find(|n| n.accesskit_node().role() == Role::SpinButton);
    found.unwrap_or_else(|| panic!("no number {name}")).set_value_accesskit(value);
    harness.run();
}

fn choose(harness: &mut Harness<'_, Editor>, list: &str, entry: &str) {
    let pos = list_box(harness, list).rect().center();
    click(harness, pos);
    press(harness, entry);
}

#[test]
fn the_selection_becomes_types_in_place_in_one_step() {
    let (scene, [_, ball, _, ring]) = scene();
    let mut harness = open_tall(scene.clone());
    run(&mut harness, Command::InstanceSelection);
    assert_eq!(*harness.state().document().scene(), scene, "nothing is selected");
    harness.state_mut().document_mut().select(vec![ball, ring]);
    harness.settle();
    let before = [ball, ring].map(|id| scene.world_from_local(id));
    run(&mut harness, Command::InstanceSelection);
    let [id] = *harness.state().document().selection() else { panic!("one is selected") };
    let after = harness.state().document().snapshot();
    assert_eq!(after.children(Some(id)).map(|n| n.id).collect::<Vec<_>>(), [ball, ring]);
    assert_eq!([ball, ring].map(|id| after.world_from_local(id)), before, "they stay where they are");
    assert_eq!(instancer(&harness, id), Instancer::default());
    assert_eq!(undo_all(&mut harness), 1);
    assert_eq!(*harness.state().document().scene(), scene);
}

#[test]
fn only_what_has_a_field_becomes_a_type() {
    let (mut scene, [_, ball, ..]) = scene();
    let sun = Node::new("Sun", NodeKind::Light(isolith::scene::Light::sun()));
    let sun = scene.insert(None, 0, sun).unwrap();
    let mut harness = open_tall(scene.clone());
    harness.state_mut().document_mut().select(vec![ball, sun]);
    harness.settle();
    run(&mut harness, Command::InstanceSelection);
    assert_eq!(*harness.state().document().scene(), scene);
}

#[test]
fn an_empty_instancer_says_what_to_do_and_takes_the_next_shape_but_no_lights() {
    let mut harness = open_tall(Scene::new());
    run(&mut harness, Command::AddInstancer);
    let [id] = *harness.state().document().selection() else { panic!("it is selected") };
    assert!(says(&harness, "No types yet"));
    assert!(says(&harness, "Instancer has no types: drag what it shall copy"), "in the card");
    assert!(says(&harness, "Instancer: has no children"), "in the status bar");
    run(&mut harness, Command::AddSun);
    let sun = harness.state().document().selection()[0];
    assert_eq!(node(&harness, sun).parent, None, "beside the instancer");
    harness.state_mut().document_mut().select(vec![id]);
    run(&mut harness, Command::AddShape(isolith::scene::ShapeKind::Sphere));
    let ball = harness.state().document().selection()[0];
    assert_eq!(node(&harness, ball).parent, Some(id));
    assert!(!says(&harness, "has no types"));
    assert!(says(&harness, "100 % of the copies are of this type"));
}

#[test]
fn weights_show_shares_and_all_zero_is_told() {
    let (mut harness, scene, id) = with_instancer();
    type_number(&mut harness, "Weight of Tall", 3.0);
    let types: Vec<_> = scene.children(Some(id)).map(|n| n.id).collect();
    assert_eq!(node(&harness, types[0]).weight, 3.0);
    assert_eq!(harness.get_all_by_label("75 %").count(), 2, "in the card and in the outliner");
    assert_eq!(harness.get_all_by_label("25 %").count(), 2);
    for name in ["Weight of Tall", "Weight of Flat"] {
        type_number(&mut harness, name, 0.0);
    }
    assert!(says(&harness, "the weights of all types are 0"));
    press(&mut harness, "Select Flat");
    assert_eq!(harness.state().document().selection(), [types[1]]);
    type_number(&mut harness, "Weight", 1.0);
    assert_eq!(node(&harness, types[1]).weight, 1.0);
    assert_eq!(undo_all(&mut harness), 4);
    assert_eq!(*harness.state().document().scene(), scene);
}

#[test]
fn lattices_are_chosen_their_parameters_typed_and_the_number_of_copies_shown() {
    let (mut harness, scene, id) = with_instancer();
    assert_eq!(harness.get_all_by_label("25 copies").count(), 2, "in the card and in the status bar");
    type_number(&mut harness, "Counts X", 7.0);
    type_number(&mut harness, "Spacing Z", 3.5);
    assert_eq!(instancer(&harness, id).lattice, Lattice::Grid { counts: [7, 1, 5], spacing: [2.0, 2.0, 3.5] });
    assert_eq!(harness.get_all_by_label("35 copies").count(), 2);
    type_number(&mut harness, "Counts X", 0.0);
    assert_eq!(harness.get_all_by_label("Copies without end along X").count(), 2);
    choose(&mut harness, "Distribution", "Polar");
    assert_eq!(instancer(&harness, id).lattice.kind(), LatticeKind::Polar);
    assert_eq!(undo_all(&mut harness), 4);
    assert_eq!(*harness.state().document().scene(), scene);
}

#[test]
fn a_target_is_asked_for_where_it_is_needed_and_chosen_by_its_name() {
    let (mut harness, _, id) = with_instancer();
    assert!(harness.query_by_label("Target: None").is_none(), "a grid needs none");
    choose(&mut harness, "Distribution", "Scatter on surface");
    assert!(says(&harness, "Copies needs a target to stand on"));
    press(&mut harness, "Target: None");
    let ring = harness.state().document().scene().nodes().iter().find(|n| n.name == "Ring").unwrap().id;
    let own = harness.state().document().scene().children(Some(id)).next().unwrap().id;
    assert!(harness.query_by_label(&format!("Tall {own}")).is_none(), "no type of its own");
    press(&mut harness, &format!("Ring {ring}"));
    assert_eq!(instancer(&harness, id).target, Some(ring));
    assert!(!says(&harness, "needs a target"));
    harness.state_mut().document_mut().select(vec![ring]);
    run(&mut harness, Command::Delete);
    harness.state_mut().document_mut().select(vec![id]);
    harness.settle();
    assert!(harness.query_by_label(&format!("Target: Missing {ring}")).is_some());
    assert!(says(&harness, "the one that it had is gone"));
    choose(&mut harness, "Distribution", "Grid");
    assert!(!says(&harness, "Target:"));
    choose(&mut harness, "Snap", "Along Y");
    assert_eq!(instancer(&harness, id).snap, Snap::Down);
    assert!(harness.query_by_label(&format!("Target: Missing {ring}")).is_some());
}

#[test]
fn masks_are_added_inverted_reordered_and_removed() {
    let (mut harness, scene, id) = with_instancer();
    let kinds = |harness: &Harness<'_, Editor>| {
        instancer(harness, id).masks.iter().map(|slot| slot.mask.kind()).collect::<Vec<_>>()
    };
    for kind in [MaskKind::Noise, MaskKind::Height] {
        harness.get_by_label_contains("Add mask").click();
        harness.run();
        press(&mut harness, kind.label());
    }
    assert_eq!(kinds(&harness), [MaskKind::Noise, MaskKind::Height]);
    assert!(says(&harness, "At most 25 copies"));
    harness.get_all_by_label("Inverted").find(|n| n.accesskit_node().role() == Role::CheckBox).unwrap().click();
    harness.run();
    assert!(instancer(&harness, id).masks[0].inverted);
    press(&mut harness, "Move down");
    assert_eq!(kinds(&harness), [MaskKind::Height, MaskKind::Noise]);
    assert!(instancer(&harness, id).masks[1].inverted);
    type_number(&mut harness, "To", 4.0);
    assert!(matches!(instancer(&harness, id).masks[0].mask, Mask::Height { to: 4.0, .. }));
    press(&mut harness, "Remove the mask");
    assert_eq!(kinds(&harness), [MaskKind::Noise]);
    assert_eq!(undo_all(&mut harness), 6);
    assert_eq!(*harness.state().document().scene(), scene);
}

#[test]
fn the_curve_of_a_mask_is_chosen_and_dragged() {
    let (mut harness, scene, id) = with_instancer();
    harness.get_by_label_contains("Add mask").click();
    harness.run();
    press(&mut harness, "Image");
    assert!(says(&harness, "No image"), "its file is named");
    assert!(says(&harness, "has no image for its mask 1"), "in the status bar");
    let curve = |harness: &Harness<'_, Editor>| instancer(harness, id).masks[0].curve.clone();
    choose(&mut harness, "Join", "Subtract");
    assert_eq!(instancer(&harness, id).masks[0].join, MaskJoin::Subtract);
    choose(&mut harness, "Response", "Peak");
    assert_eq!(curve(&harness), CurvePreset::Peak.curve());
    let plot = harness.get_by_label("Response curve").rect();
    // The peak, in the middle of the upper edge, goes to a quarter of the height.
    let from = egui::pos2(plot.center().x, plot.top() + 6.0);
    let to = egui::pos2(plot.center().x - 30.0, plot.bottom() - 6.0 - 0.25 * (plot.height() - 12.0));
    super::pointer(&mut harness, from, true);
    harness.step();
    for step in 1..=4 {
        harness.event(egui::Event::PointerMoved(from + (to - from) * (step as f32 / 4.0)));
        harness.step();
    }
    super::pointer(&mut harness, to, false);
    harness.settle();
    let dragged = curve(&harness);
    assert!((dragged.points[1][1] - 0.25).abs() < 0.03 && dragged.points[1][0] < 0.48, "{dragged:?}");
    assert_eq!(dragged.points.len(), 3);
    assert_eq!(undo_all(&mut harness), 4);
    assert_eq!(*harness.state().document().scene(), scene);
}

#[test]
fn the_ends_of_a_range_give_way_to_each_other() {
    let (mut harness, scene, id) = with_instancer();
    type_number(&mut harness, "Scale min X", 2.0);
    let variation = instancer(&harness, id).variation;
    assert_eq!((variation.scale_min, variation.scale_max), ([2.0, 1.0, 1.0], [2.0, 1.0, 1.0]));
    type_number(&mut harness, "Offset max Y", -1.0);
    let variation = instancer(&harness, id).variation;
    assert_eq!((variation.offset_min, variation.offset_max), ([0.0, -1.0, 0.0], [0.0, -1.0, 0.0]));
    assert_eq!(undo_all(&mut harness), 2);
    assert_eq!(*harness.state().document().scene(), scene);
}

#[test]
fn seeds_are_rolled_unless_they_are_locked() {
    let (mut harness, scene, id) = with_instancer();
    press(&mut harness, "Re-roll");
    let first = instancer(&harness, id).seed;
    assert_ne!(first, 1);
    run(&mut harness, Command::RerollSeeds);
    let second = instancer(&harness, id).seed;
    assert_ne!(second, first);
    press(&mut harness, "Lock the seed");
    assert!(instancer(&harness, id).seed_locked);
    run(&mut harness, Command::RerollSeeds);
    press(&mut harness, "Re-roll");
    assert_eq!(instancer(&harness, id).seed, second);
    assert_eq!(undo_all(&mut harness), 3);
    assert_eq!(*harness.state().document().scene(), scene);
}

#[test]
fn a_palette_keeps_its_materials_in_use() {
    let (mut harness, scene, id) = with_instancer();
    harness.get_by_label_contains("Add to palette").click();
    harness.run();
    let clay = scene.materials()[0].id;
    press(&mut harness, "Clay");
    assert_eq!(instancer(&harness, id).palette, [clay]);
    press(&mut harness, "Remove Clay from the palette");
    assert!(instancer(&harness, id).palette.is_empty());
    type_number(&mut harness, "Hue", 0.25);
    assert_eq!(instancer(&harness, id).material.hue, 0.25);
    assert_eq!(undo_all(&mut harness), 3);
    assert_eq!(*harness.state().document().scene(), scene);
}

#[test]
fn dynamics_stand_on_objects_groups_and_instancers_and_end_somewhere() {
    let (mut harness, scene, id) = with_instancer();
    let [group, ring] = ["Body", "Ring"].map(|name| scene.nodes().iter().find(|n| n.name == name).unwrap().id);
    harness.state_mut().document_mut().select(vec![group, ring, id]);
    harness.settle();
    harness.get_by_label_contains("Add dynamic").click();
    harness.run();
    press(&mut harness, "Spin");
    for id in [group, ring, id] {
        assert_eq!(node(&harness, id).dynamics.len(), 1, "all of the selection");
    }
    type_number(&mut harness, "Frequency", 2.0);
    press(&mut harness, "Spin");
    assert!(!node(&harness, group).dynamics[0].enabled);
    press(&mut harness, "Remove the dynamic");
    assert_eq!(undo_all(&mut harness), 4);
    assert_eq!(*harness.state().document().scene(), scene);
    let mut full = node(&harness, ring);
    full.dynamics = vec![isolith::scene::DynamicKind::Bob.default_dynamic().into(); MAX_DYNAMICS];
    harness.state_mut().document_mut().apply(isolith::document::Edit::Replace(full)).unwrap();
    harness.state_mut().document_mut().select(vec![ring]);
    harness.settle();
    assert!(!says(&harness, "Add dynamic"));
    assert!(says(&harness, "8 dynamics are the most"));
}

#[test]
fn a_preset_sets_an_instancer_or_makes_one_in_one_step() {
    use isolith::scene::InstancerPreset::{AsteroidBelt, Meadow};
    let (mut harness, scene, id) = with_instancer();
    run(&mut harness, Command::ApplyPreset(Meadow));
    assert!(matches!(instancer(&harness, id).lattice, Lattice::Grid { counts: [0, 1, 0], .. }));
    assert_eq!(node(&harness, id).dynamics.len(), 1);
    assert_eq!(undo_all(&mut harness), 1);
    let ring = scene.nodes().iter().find(|n| n.name == "Ring").unwrap().id;
    harness.state_mut().document_mut().select(vec![ring]);
    harness.settle();
    run(&mut harness, Command::ApplyPreset(AsteroidBelt));
    let [id] = *harness.state().document().selection() else { panic!("one is selected") };
    assert_eq!(node(&harness, ring).parent, Some(id));
    let Lattice::Polar { radius, .. } = instancer(&harness, id).lattice else { panic!("not rings") };
    let Shape::Torus { major_radius, minor_radius } = super::shape(&harness, ring) else { panic!("no torus") };
    assert!((radius - 20.0 * 2.0 * (major_radius + minor_radius)).abs() < 1e-9, "in proportion to the torus: {radius}");
    assert_eq!(undo_all(&mut harness), 1);
    assert_eq!(*harness.state().document().scene(), scene);
}

#[test]
fn rows_are_dragged_into_an_instancer_and_become_types() {
    let (mut harness, scene, id) = with_instancer();
    let ring = scene.nodes().iter().find(|n| n.name == "Ring").unwrap().id;
    select(&mut harness, "Ring");
    let (from, to) = (row(&harness, "Ring"), row(&harness, "Copies"));
    super::pointer(&mut harness, from, true);
    harness.step();
    for step in 1..=8 {
        harness.event(egui::Event::PointerMoved(from + (to - from) * (step as f32 / 8.0)));
        harness.step();
    }
    super::pointer(&mut harness, to, false);
    harness.settle();
    assert_eq!(node(&harness, ring).parent, Some(id));
    assert_eq!(undo_all(&mut harness), 1);
    assert_eq!(*harness.state().document().scene(), scene);
}
