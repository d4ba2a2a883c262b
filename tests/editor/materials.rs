//! The materials: the list, what is shared, presets, and what a new shape gets.

use std::sync::Arc;

use egui::{Event, Key, Modifiers, PointerButton, Pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use isolith::editor::Editor;
use isolith::scene::{Material, MaterialId, NodeId, NodeKind, Scene};

use super::{click, field, open, open_tall, pointer, press, scene, select, undo_all};
use crate::settle::Settle;

fn document(harness: &Harness<'_, Editor>) -> Arc<Scene> {
    harness.state().document().snapshot()
}

fn names(harness: &Harness<'_, Editor>) -> Vec<String> {
    document(harness).materials().iter().map(|material| material.name.clone()).collect()
}

fn material(harness: &Harness<'_, Editor>, node: NodeId) -> Arc<Material> {
    let scene = document(harness);
    let NodeKind::Object(object) = &scene.node(node).unwrap().kind else { panic!("not an object") };
    scene.material(object.material).unwrap().clone()
}

fn center(harness: &Harness<'_, Editor>, label: &str) -> Pos2 {
    harness.get_by_label(label).rect().center()
}

fn press_button(harness: &mut Harness<'_, Editor>, label: &str) {
    let pos = center(harness, label);
    click(harness, pos);
    // Long enough that the next click is not a double click.
    harness.run_steps(40);
}

/// Chooses an entry of the context menu of a row.
fn choose_in_menu(harness: &mut Harness<'_, Editor>, row: &str, entry: &str) {
    let pos = center(harness, row);
    harness.event(Event::PointerMoved(pos));
    for pressed in [true, false] {
        let button = PointerButton::Secondary;
        harness.event(Event::PointerButton { pos, button, pressed, modifiers: Modifiers::NONE });
    }
    harness.settle();
    press_button(harness, entry);
}

fn drag(harness: &mut Harness<'_, Editor>, from: Pos2, to: Pos2) {
    pointer(harness, from, true);
    harness.step();
    for step in 1..=8 {
        harness.event(Event::PointerMoved(from + (to - from) * (step as f32 / 8.0)));
        harness.step();
    }
    pointer(harness, to, false);
    harness.settle();
}

#[test]
fn the_list_adds_copies_renames_orders_and_deletes_and_undo_leads_back() {
    let (scene, _) = scene();
    let mut harness = open(scene.clone());
    press_button(&mut harness, "New material");
    assert_eq!(names(&harness), ["Clay", "Material"]);
    choose_in_menu(&mut harness, "Material Clay", "Duplicate material");
    assert_eq!(names(&harness), ["Clay", "Material", "Clay 2"]);
    choose_in_menu(&mut harness, "Material Clay 2", "Material up");
    assert_eq!(names(&harness), ["Clay", "Clay 2", "Material"]);
    let (from, to) = (center(&harness, "Material Material"), center(&harness, "Material Clay"));
    drag(&mut harness, from, to);
    assert_eq!(names(&harness), ["Material", "Clay", "Clay 2"]);
    choose_in_menu(&mut harness, "Material Clay 2", "Rename material");
    press(&mut harness, Modifiers::COMMAND, Key::A);
    harness.event(Event::Text("Copper".into()));
    harness.run();
    press(&mut harness, Modifiers::NONE, Key::Enter);
    assert_eq!(names(&harness), ["Material", "Clay", "Copper"]);
    choose_in_menu(&mut harness, "Material Copper", "Delete material");
    assert_eq!(names(&harness), ["Material", "Clay"]);
    press_button(&mut harness, "Delete unused materials");
    assert_eq!(names(&harness), ["Clay"], "what objects use stays");
    assert_eq!(undo_all(&mut harness), 7, "a step for each");
    assert_eq!(*document(&harness), scene);
}

#[test]
fn a_material_chosen_in_the_list_is_edited_and_escape_leads_back_to_the_scene() {
    let (scene, [_, ball, ..]) = scene();
    let mut harness = open(scene);
    assert!(harness.query_by_label("Material name").is_none());
    select(&mut harness, "Ball");
    press_button(&mut harness, "Material Clay");
    assert!(harness.state().document().selection().is_empty());
    assert!(harness.query_by_label("Used by 3").is_some());
    let name = field(&harness, "Material name").rect().center();
    click(&mut harness, name);
    press(&mut harness, Modifiers::COMMAND, Key::A);
    harness.event(Event::Text("Stone".into()));
    harness.run();
    press(&mut harness, Modifiers::NONE, Key::Enter);
    assert_eq!(names(&harness), ["Stone"]);
    press(&mut harness, Modifiers::NONE, Key::Escape);
    assert!(harness.query_by_label("Material name").is_none(), "the settings of the scene again");
    press_button(&mut harness, "Material Stone");
    press_button(&mut harness, "Select");
    assert_eq!(harness.state().document().selection().len(), 3, "what uses it");
    assert!(harness.state().document().selection().contains(&ball));
}

#[test]
fn a_shared_material_says_so_and_can_be_made_unique() {
    let (scene, [_, ball, cube, ring]) = scene();
    let mut harness = open_tall(scene.clone());
    select(&mut harness, "Ball");
    assert!(harness.query_by_label("Used by 3").is_some());
    press_button(&mut harness, "Make unique");
    assert_eq!(material(&harness, ball).name, "Clay 2");
    assert!([cube, ring].iter().all(|node| material(&harness, *node).name == "Clay"));
    assert!(harness.query_by_label("Used by 1").is_some() && harness.query_by_label("Make unique").is_none());
    assert_eq!(undo_all(&mut harness), 1);
    assert_eq!(*document(&harness), scene);
}

#[test]
fn a_preset_found_by_its_name_is_one_step() {
    let (scene, [_, ball, ..]) = scene();
    let mut harness = open_tall(scene.clone());
    select(&mut harness, "Ball");
    press_button(&mut harness, "Preset…");
    assert!(harness.query_by_label("Preset Clay").is_some());
    harness.event(Event::Text("gol".into()));
    harness.run();
    assert!(harness.query_by_label("Preset Clay").is_none(), "it does not fit the text");
    press_button(&mut harness, "Preset Gold");
    let gold = material(&harness, ball);
    assert!(gold.base_metalness == 1.0 && gold.id == scene.materials()[0].id, "{gold:?}");
    assert!(harness.query_by_label("Preset Gold").is_none(), "the list is closed");
    assert_eq!(undo_all(&mut harness), 1);
    assert_eq!(*document(&harness), scene);
    press(&mut harness, Modifiers::NONE, Key::Escape);
    press_button(&mut harness, "Add a material from a preset");
    harness.event(Event::Text("gold".into()));
    harness.run();
    press_button(&mut harness, "Preset Gold");
    assert_eq!(names(&harness), ["Clay", "Gold"]);
    assert_eq!(undo_all(&mut harness), 1);
}

#[test]
fn a_material_is_given_by_a_button_and_by_dropping_it_on_a_shape() {
    let (mut scene, [_, ball, cube, ring]) = scene();
    let red = MaterialId(2);
    scene.insert_material(Material::new(red, "Red", [0.8, 0.1, 0.1])).unwrap();
    let mut harness = open(scene.clone());
    select(&mut harness, "Ring");
    let row = center(&harness, "Material Red");
    harness.event(Event::PointerMoved(row));
    harness.run();
    press_button(&mut harness, "Assign Red");
    assert_eq!(material(&harness, ring).id, red);
    assert_eq!(undo_all(&mut harness), 1);
    let viewport = harness.get_by_label("Viewport").rect();
    let camera = harness.state().view().camera;
    drag(&mut harness, row, viewport.center());
    let given = [ball, cube, ring].into_iter().filter(|node| material(&harness, *node).id == red).count();
    assert_eq!(given, 1, "what stands in the middle");
    assert_eq!(harness.state().view().camera, camera, "the drag turns nothing");
    assert_eq!(undo_all(&mut harness), 1);
    drag(&mut harness, row, viewport.left_bottom() + vec2(40.0, -40.0));
    assert_eq!(*document(&harness), scene, "nothing stands in the corner");
}

#[test]
fn new_shapes_have_colors_of_their_own() {
    let mut harness = open(Scene::new());
    for name in ["Add sphere", "Add box", "Add torus"] {
        press_button(&mut harness, name);
    }
    let scene = document(&harness);
    let own: Vec<_> = scene.nodes().iter().map(|node| material(&harness, node.id)).collect();
    assert_eq!(own[0].name, "Clay", "the first one takes what the scene begins with");
    for (index, one) in own.iter().enumerate() {
        assert!(own[..index].iter().all(|other| other.id != one.id && other.base_color != one.base_color));
    }
    assert_eq!(scene.materials().len(), 3);
    assert_eq!(undo_all(&mut harness), 3, "one step for a shape with its material");
}

#[test]
fn parameters_of_less_use_are_folded_and_a_model_shows_its_own() {
    let (scene, _) = scene();
    let mut harness = open_tall(scene);
    select(&mut harness, "Ball");
    for shown in ["Metalness", "Roughness", "Emission strength", "Emission color"] {
        field(&harness, shown);
    }
    assert!(harness.query_by_label("Coat roughness").is_none());
    press_button(&mut harness, "Coat");
    field(&harness, "Coat roughness");
    press_button(&mut harness, "Advanced");
    let list = super::list_box(&harness, "Model").rect().center();
    click(&mut harness, list);
    press_button(&mut harness, "Blinn-Phong");
    field(&harness, "Specular exponent");
    assert!(harness.query_by_label("Coat").is_none() && harness.query_by_label("Metalness").is_none());
    assert_eq!(undo_all(&mut harness), 1);
}
