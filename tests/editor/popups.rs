//! Menus, lists, pickers and dialogs: how they close, that closing has no other effect, and that they fit the window.

use egui::{
    Event, Key, Modifiers, MouseWheelSource, MouseWheelUnit, PointerButton, Popup, Pos2, Rect, TouchPhase, vec2,
};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use isolith::document::Document;
use isolith::editor::Editor;
use isolith::scene::Shape;

use super::{click, field, open, open_in, open_tall, pointer, press, row, scene, select, shape, undo_all};

/// The buttons that open a popup.
const OPENERS: [&str; 9] =
    ["File", "Edit", "Add", "View", "Viewport shading", "Primitive", "Blend", "Base color", "Material"];

fn is_open(harness: &Harness<'_, Editor>) -> bool {
    Popup::is_any_open(&harness.ctx)
}

/// The position of a button that opens a popup.
fn opener(harness: &Harness<'_, Editor>, name: &str) -> Pos2 {
    let bar = ["File", "Edit", "Add", "View"].contains(&name);
    let mut found = harness.get_all_by_label(name).map(|node| node.rect().center());
    match name {
        _ if bar => found.find(|pos| pos.y < 40.0).unwrap(),
        "Primitive" | "Blend" | "Material" => super::list_box(harness, name).rect().center(),
        _ => field(harness, name).rect().center(),
    }
}

fn open_popup(harness: &mut Harness<'_, Editor>, name: &str) -> Pos2 {
    let pos = opener(harness, name);
    click(harness, pos);
    assert!(is_open(harness), "{name} opens");
    harness.run_steps(40);
    pos
}

fn wheel(lines: f32) -> Event {
    let (unit, phase, source) = (MouseWheelUnit::Line, TouchPhase::Move, MouseWheelSource::Wheel);
    Event::MouseWheel { unit, phase, source, delta: vec2(0.0, lines), modifiers: Modifiers::NONE }
}

fn right_click(harness: &mut Harness<'_, Editor>, pos: Pos2) {
    harness.event(Event::PointerMoved(pos));
    for pressed in [true, false] {
        let button = PointerButton::Secondary;
        harness.event(Event::PointerButton { pos, button, pressed, modifiers: Modifiers::NONE });
    }
    harness.run();
}

#[test]
fn escape_closes_a_menu_and_deselects_nothing() {
    let (scene, [_, ball, ..]) = scene();
    let mut harness = open_tall(scene.clone());
    select(&mut harness, "Ball");
    for name in OPENERS {
        open_popup(&mut harness, name);
        press(&mut harness, Modifiers::NONE, Key::Escape);
        assert!(!is_open(&harness), "{name}");
        assert_eq!(harness.state().document().selection(), [ball], "{name}");
    }
    for pos in [row(&harness, "Ball"), field(&harness, "Radius").rect().center()] {
        right_click(&mut harness, pos);
        assert!(is_open(&harness));
        press(&mut harness, Modifiers::NONE, Key::Escape);
        assert!(!is_open(&harness));
        assert_eq!(harness.state().document().selection(), [ball]);
    }
    press(&mut harness, Modifiers::NONE, Key::F3);
    press(&mut harness, Modifiers::NONE, Key::Escape);
    assert!(!harness.state().has_dialog());
    assert_eq!(harness.state().document().selection(), [ball]);
    press(&mut harness, Modifiers::COMMAND, Key::O);
    press(&mut harness, Modifiers::NONE, Key::Escape);
    assert!(!harness.state().has_dialog());
    assert_eq!(harness.state().document().selection(), [ball]);
    press(&mut harness, Modifiers::NONE, Key::Escape);
    assert!(harness.state().document().selection().is_empty(), "with nothing open it deselects");
}

#[test]
fn the_log_is_a_panel_which_escape_leaves_open() {
    let (scene, [_, ball, ..]) = scene();
    let mut harness = open(scene);
    select(&mut harness, "Ball");
    press(&mut harness, Modifiers::NONE, Key::F3);
    harness.event(Event::Text("log".into()));
    harness.run();
    press(&mut harness, Modifiers::NONE, Key::Enter);
    assert!(harness.query_by_label("No messages").is_some());
    assert_eq!(harness.state().document().selection(), [ball]);
    press(&mut harness, Modifiers::NONE, Key::Escape);
    assert!(harness.query_by_label("No messages").is_some());
    assert!(harness.state().document().selection().is_empty());
}

#[test]
fn escape_cancels_what_is_being_typed_or_dragged() {
    let (scene, [_, ball, ..]) = scene();
    let mut harness = open_tall(scene.clone());
    select(&mut harness, "Ball");
    for name in ["Radius", "Position X", "Name", "Material name"] {
        let pos = field(&harness, name).rect().center();
        click(&mut harness, pos);
        press(&mut harness, Modifiers::COMMAND, Key::A);
        harness.event(Event::Text("7".into()));
        harness.run();
        press(&mut harness, Modifiers::NONE, Key::Escape);
        assert_eq!(*harness.state().document().scene(), scene, "{name}");
        assert_eq!(harness.state().document().selection(), [ball], "{name}");
    }
    let pos = field(&harness, "Radius").rect().center();
    pointer(&mut harness, pos, true);
    for step in 1..=8 {
        harness.event(Event::PointerMoved(pos + vec2(step as f32 * 10.0, 0.0)));
        harness.step();
    }
    assert_ne!(*harness.state().document().scene(), scene);
    press(&mut harness, Modifiers::NONE, Key::Escape);
    assert_eq!(*harness.state().document().scene(), scene);
    harness.event(Event::PointerMoved(pos + vec2(200.0, 0.0)));
    pointer(&mut harness, pos + vec2(200.0, 0.0), false);
    harness.run();
    assert_eq!(*harness.state().document().scene(), scene);
    assert_eq!(harness.state().document().selection(), [ball]);
    assert!(!harness.state().document().is_changed());
    assert_eq!(undo_all(&mut harness), 0);
}

#[test]
fn escape_cancels_a_color() {
    let (scene, _) = scene();
    let mut harness = open_tall(scene.clone());
    select(&mut harness, "Ball");
    open_popup(&mut harness, "Base color");
    let hex = field(&harness, "Hex").rect().center();
    click(&mut harness, hex);
    press(&mut harness, Modifiers::COMMAND, Key::A);
    harness.event(Event::Text("#00ff00".into()));
    harness.run();
    press(&mut harness, Modifiers::NONE, Key::Escape);
    assert_eq!(*harness.state().document().scene(), scene);
    if !is_open(&harness) {
        open_popup(&mut harness, "Base color");
    }
    let square = harness.get_by_label("Saturation and brightness").rect();
    pointer(&mut harness, square.center(), true);
    for step in 1..=8 {
        harness.event(Event::PointerMoved(square.center() + vec2(step as f32 * 6.0, 0.0)));
        harness.step();
    }
    press(&mut harness, Modifiers::NONE, Key::Escape);
    pointer(&mut harness, square.center(), false);
    harness.run();
    assert_eq!(*harness.state().document().scene(), scene);
}

#[test]
fn a_click_beside_a_popup_takes_what_was_typed_in_it() {
    let (scene, _) = scene();
    let mut harness = open_tall(scene);
    select(&mut harness, "Ball");
    open_popup(&mut harness, "Base color");
    let hex = field(&harness, "Hex").rect().center();
    click(&mut harness, hex);
    press(&mut harness, Modifiers::COMMAND, Key::A);
    harness.event(Event::Text("#00ff00".into()));
    harness.run();
    let viewport = harness.get_by_label("Viewport").rect().center();
    click(&mut harness, viewport);
    assert!(!is_open(&harness));
    assert_eq!(harness.state().document().scene().materials()[0].base_color, [0.0, 1.0, 0.0]);
}

#[test]
fn a_click_beside_a_popup_only_closes_it() {
    let (scene, [_, ball, ..]) = scene();
    let mut harness = open_tall(scene.clone());
    select(&mut harness, "Ball");
    let viewport = harness.get_by_label("Viewport").rect();
    let camera = harness.state().view().camera;
    let beside = [
        viewport.center(),
        viewport.left_bottom() + vec2(60.0, -60.0),
        row(&harness, "Ring"),
        harness.get_by_label("Hide Ball").rect().center(),
        harness.get_by_label("Delete").rect().center(),
        field(&harness, "Name").rect().center(),
    ];
    for name in OPENERS {
        let mut tried = 0;
        for pos in beside {
            open_popup(&mut harness, name);
            if harness.ctx.layer_id_at(pos).is_some_and(|layer| layer.order == egui::Order::Foreground) {
                press(&mut harness, Modifiers::NONE, Key::Escape);
                continue;
            }
            tried += 1;
            // A drag has no effect either.
            pointer(&mut harness, pos, true);
            harness.event(Event::PointerMoved(pos + vec2(-30.0, 20.0)));
            pointer(&mut harness, pos + vec2(-30.0, 20.0), false);
            harness.run();
            assert!(!is_open(&harness), "{name} {pos}");
            assert_eq!(harness.state().document().selection(), [ball], "{name} {pos}");
            assert_eq!(*harness.state().document().scene(), scene, "{name} {pos}");
            assert_eq!(harness.state().view().camera, camera, "{name} {pos}");
        }
        assert!(tried >= 2, "{name}");
    }
    assert!(!harness.ctx.text_edit_focused(), "nor is a field entered");
    click(&mut harness, viewport.left_bottom() + vec2(60.0, -60.0));
    assert!(harness.state().document().selection().is_empty(), "the next click counts");
}

#[test]
fn a_click_beside_the_palette_or_a_right_click_beside_a_menu_only_closes_it() {
    let (scene, [_, ball, ..]) = scene();
    let mut harness = open(scene.clone());
    select(&mut harness, "Ball");
    let corner = harness.get_by_label("Viewport").rect().left_bottom() + vec2(60.0, -60.0);
    for pos in [corner, row(&harness, "Ring")] {
        press(&mut harness, Modifiers::NONE, Key::F3);
        click(&mut harness, pos);
        assert!(!harness.state().has_dialog());
        assert_eq!(harness.state().document().selection(), [ball]);
        open_popup(&mut harness, "File");
        right_click(&mut harness, pos);
        assert!(!is_open(&harness));
        assert_eq!(harness.state().document().selection(), [ball]);
    }
}

#[test]
fn the_wheel_beside_a_popup_moves_nothing() {
    let (scene, _) = scene();
    let mut harness = open(scene);
    let camera = harness.state().view().camera;
    let viewport = harness.get_by_label("Viewport").rect();
    let turn = |harness: &mut Harness<'_, Editor>| {
        harness.event(Event::PointerMoved(viewport.left_bottom() + vec2(60.0, -60.0)));
        harness.event(wheel(3.0));
        harness.run_steps(60);
    };
    open_popup(&mut harness, "File");
    turn(&mut harness);
    assert_eq!(harness.state().view().camera, camera);
    press(&mut harness, Modifiers::NONE, Key::Escape);
    turn(&mut harness);
    assert_ne!(harness.state().view().camera, camera, "without one it does");
}

#[test]
fn a_click_on_an_open_menus_button_closes_it() {
    let (scene, [_, ball, ..]) = scene();
    let mut harness = open_tall(scene);
    select(&mut harness, "Ball");
    for name in OPENERS {
        let pos = open_popup(&mut harness, name);
        click(&mut harness, pos);
        assert!(!is_open(&harness), "{name}");
        harness.run_steps(40);
        assert!(!is_open(&harness), "{name} stays closed");
        open_popup(&mut harness, name);
        press(&mut harness, Modifiers::NONE, Key::Escape);
    }
    assert_eq!(harness.state().document().selection(), [ball]);
}

/// Rectangles of everything in front of the panels.
fn popup_rects(harness: &Harness<'_, Editor>) -> Vec<Rect> {
    harness.ctx.memory(|memory| {
        let layers = memory.areas().visible_layer_ids().into_iter().filter(|l| l.order == egui::Order::Foreground);
        layers.filter_map(|layer| memory.area_rect(layer.id)).collect()
    })
}

#[test]
fn menus_fit_the_window_and_scroll() {
    let (scene, [_, ball, ..]) = scene();
    for size in [vec2(800.0, 500.0), vec2(1280.0, 720.0)] {
        let mut harness = open_in(Document::new(scene.clone()), size);
        harness.state_mut().document_mut().select(vec![ball]);
        harness.run();
        let screen = Rect::from_min_size(Pos2::ZERO, size);
        for name in ["File", "Edit", "Add", "View", "Viewport shading", "Blend"] {
            open_popup(&mut harness, name);
            harness.run_steps(4);
            for rect in popup_rects(&harness) {
                assert!(screen.contains_rect(rect), "{name} in {size}: {rect}");
            }
            press(&mut harness, Modifiers::NONE, Key::Escape);
        }
        press(&mut harness, Modifiers::NONE, Key::F3);
        for rect in popup_rects(&harness) {
            assert!(screen.contains_rect(rect), "palette in {size}: {rect}");
        }
    }
    // The wheel reaches the last entry.
    let mut harness = open_in(Document::new(scene), vec2(800.0, 500.0));
    let pos = open_popup(&mut harness, "Add");
    harness.event(Event::PointerMoved(pos + vec2(20.0, 200.0)));
    for _ in 0..60 {
        harness.event(wheel(-5.0));
    }
    harness.run_steps(60);
    let last = harness.get_by_label("Camera from view").rect();
    assert!(last.bottom() < 500.0, "{last}");
    click(&mut harness, last.center());
    assert_eq!(harness.state().document().scene().nodes().last().unwrap().name, "Camera");
}

#[test]
fn a_menu_does_not_scroll_where_there_is_room_for_it() {
    let (scene, _) = scene();
    let mut harness = open_in(Document::new(scene), vec2(1280.0, 1650.0));
    for (name, last) in [("Add", "Camera from view"), ("View", "Field doctor…"), ("Edit", "Instancer presets")] {
        open_popup(&mut harness, name);
        let [menu] = popup_rects(&harness)[..] else { panic!("one menu") };
        let last = harness.get_by_label(last).rect();
        assert!(menu.contains_rect(last) && last.bottom() > menu.bottom() - 20.0, "{name}: {last} in {menu}");
        press(&mut harness, Modifiers::NONE, Key::Escape);
    }
}

#[test]
fn a_list_still_does_what_is_chosen_in_it() {
    let (scene, [_, ball, ..]) = scene();
    let mut harness = open(scene);
    select(&mut harness, "Ball");
    open_popup(&mut harness, "Primitive");
    let entry = harness.get_all_by_label("Box").next().unwrap().rect().center();
    click(&mut harness, entry);
    assert!(!is_open(&harness));
    assert!(matches!(shape(&harness, ball), Shape::Box { .. }));
}
