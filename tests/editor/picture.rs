//! Navigation, picking and moving in the viewport; and general properties of the editor.

use egui::accesskit::Toggled;
use egui::{Event, Key, Modifiers, Pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use isolith::document::Document;
use isolith::editor::{Editor, Picture};
use isolith::field::Shading;
use isolith::field::debug_view::ViewMode;

use crate::settle::Settle;

use super::{click, open, pointer, press, scene, select, undo_all};

#[test]
fn turning_and_clicking_in_the_picture() {
    let (scene, _) = scene();
    let mut harness = open(scene.clone());
    let rect = harness.get_by_label("Viewport").rect();
    let before = harness.state().view().camera;
    let start = rect.left_bottom() + vec2(60.0, -60.0);
    pointer(&mut harness, start, true);
    harness.step();
    for step in 1..=8 {
        harness.event(Event::PointerMoved(start + vec2(step as f32 * 10.0, 0.0)));
        harness.step();
        assert!(step < 3 || harness.state().view().navigating);
    }
    pointer(&mut harness, start + vec2(80.0, 0.0), false);
    harness.run();
    assert_ne!(harness.state().view().camera, before);
    assert!(!harness.state().view().navigating);
    assert_eq!(*harness.state().document().scene(), scene, "looking changes nothing");
    click(&mut harness, rect.center());
    assert_eq!(harness.state().document().selection().len(), 1, "something stands in the middle");
    click(&mut harness, start);
    assert!(harness.state().document().selection().is_empty(), "nothing in the corner");
}

#[test]
fn an_arrow_moves_the_selection_in_one_step() {
    let (scene, [.., ring]) = scene();
    let mut harness = open(scene.clone());
    select(&mut harness, "Ring");
    press(&mut harness, Modifiers::NONE, Key::Num1);
    let rect = harness.get_by_label("Viewport").rect();
    let camera = harness.state().view().camera;
    let size = harness.state().view().size_px.map(f64::from);
    let (pixel, _) = camera.project(glam::DVec3::ZERO, size.into()).unwrap();
    // On the arrow along X, which points right in the front view.
    let start = rect.min + vec2(pixel.x as f32 + 50.0, pixel.y as f32);
    pointer(&mut harness, start, true);
    harness.step();
    for step in 1..=20 {
        harness.event(Event::PointerMoved(start + vec2(step as f32 * 4.0, 3.0)));
        harness.step();
    }
    pointer(&mut harness, start + vec2(80.0, 3.0), false);
    harness.run();
    let moved = harness.state().document().scene().node(ring).unwrap().transform.translation;
    assert!(moved.x > 0.05 && moved.y == 0.0 && moved.z == 0.0, "{moved}");
    let (now, _) = harness.state().view().camera.project(moved, size.into()).unwrap();
    assert!((now.x - pixel.x - 80.0).abs() < 0.5, "the arrow stays under the pointer: {now} {pixel}");
    assert_eq!(undo_all(&mut harness), 1);
    assert_eq!(*harness.state().document().scene(), scene);
}

#[test]
fn a_monkey_finds_no_panic_and_undo_leads_back() {
    let (scene, _) = scene();
    let mut harness = open(scene.clone());
    let mut seed = 0x2545_f491_4f6c_dd1d_u64;
    let mut random = move |below: u64| {
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        seed % below
    };
    const KEYS: [(Modifiers, Key); 20] = [
        (Modifiers::NONE, Key::G),
        (Modifiers::NONE, Key::R),
        (Modifiers::NONE, Key::S),
        (Modifiers::SHIFT, Key::Y),
        (Modifiers::NONE, Key::U),
        (Modifiers::NONE, Key::I),
        (Modifiers::NONE, Key::D),
        (Modifiers::NONE, Key::N),
        (Modifiers::NONE, Key::H),
        (Modifiers::NONE, Key::X),
        (Modifiers::SHIFT, Key::D),
        (Modifiers::COMMAND, Key::G),
        (Modifiers::COMMAND, Key::A),
        (Modifiers::COMMAND, Key::Z),
        (Modifiers::COMMAND, Key::Y),
        (Modifiers::NONE, Key::F),
        (Modifiers::NONE, Key::F2),
        (Modifiers::NONE, Key::Escape),
        (Modifiers::ALT, Key::ArrowUp),
        (Modifiers::NONE, Key::Enter),
    ];
    for _ in 0..600 {
        match random(3) {
            0 => {
                let (modifiers, key) = KEYS[random(KEYS.len() as u64) as usize];
                harness.key_press_modifiers(modifiers, key);
            }
            which => {
                // Below the menus, because those could open files.
                let pos = Pos2::new(random(1280) as f32, 40.0 + random(740) as f32);
                pointer(&mut harness, pos, which == 1 && random(4) > 0);
            }
        }
        harness.step();
        if harness.state().document().scene().nodes().len() > 60 {
            harness.state_mut().document_mut().undo();
        }
    }
    harness.remove_cursor();
    harness.run_ok();
    harness.state().document().scene().assert_invariants();
    undo_all(&mut harness);
    assert_eq!(*harness.state().document().scene(), scene);
}

/// Opens the menu of shadings and chooses an entry.
fn choose(harness: &mut Harness<'_, Editor>, path: &[&str]) {
    for name in [&["Viewport shading"], path].concat() {
        harness.get_by_label(name).click();
        harness.run();
    }
}

#[test]
fn the_view_for_debugging_chosen_in_the_menu_is_what_the_picture_is_asked_for() {
    let (scene, _) = scene();
    let mut harness = open(scene.clone());
    assert_eq!(harness.state().view().view_mode, ViewMode::Shaded);
    for (name, view_mode) in [("Debug: steps", ViewMode::Steps), ("Debug: normals", ViewMode::Normals)] {
        choose(&mut harness, &["Debug", name]);
        assert_eq!(harness.state().view().view_mode, view_mode);
    }
    choose(&mut harness, &["Debug", "Debug: normals"]);
    assert_eq!(harness.state().view().view_mode, ViewMode::Shaded, "the same again leads back");
    harness.get_by_label("View").click();
    harness.run();
    let is_on = |name| harness.get_by_label(name).accesskit_node().toggled() == Some(Toggled::True);
    assert!(is_on("Grid"), "a check mark shows what is on");
    harness.get_by_label("Shading").click();
    harness.run();
    let is_on = |name| harness.get_by_label(name).accesskit_node().toggled() == Some(Toggled::True);
    assert!(is_on("Shading: Rendered") && !is_on("Shading: Solid"));
    press(&mut harness, Modifiers::NONE, Key::Escape);
    press(&mut harness, Modifiers::NONE, Key::F3);
    harness.event(Event::Text("debug slope".into()));
    harness.run();
    press(&mut harness, Modifiers::NONE, Key::Enter);
    assert_eq!(harness.state().view().view_mode, ViewMode::Slope);
    assert_eq!(undo_all(&mut harness), 0, "looking changes nothing");
    assert_eq!(*harness.state().document().scene(), scene);
}

#[test]
fn a_shading_is_chosen_by_button_menu_and_key_and_stays_with_the_next_document() {
    let (scene, _) = scene();
    let mut harness = open(scene.clone());
    let shown = |harness: &Harness<'_, Editor>| (harness.state().view().shading, harness.state().view().view_mode);
    let is_on = |harness: &Harness<'_, Editor>, name| {
        harness.get_by_label(name).accesskit_node().toggled() == Some(Toggled::True)
    };
    assert_eq!(shown(&harness), (Shading::Rendered, ViewMode::Shaded), "a new window shows the scene as it is lit");
    let camera = harness.state().view().camera;
    for (name, shading) in [("Solid", Shading::Solid), ("Material Preview", Shading::Material)] {
        harness.get_by_label(name).click();
        harness.run();
        assert_eq!(shown(&harness), (shading, ViewMode::Shaded));
        assert!(is_on(&harness, name) && !is_on(&harness, "Rendered"));
    }
    choose(&mut harness, &["Shading: Solid"]);
    assert_eq!(shown(&harness).0, Shading::Solid);
    for shading in [Shading::Material, Shading::Rendered, Shading::Solid] {
        press(&mut harness, Modifiers::NONE, Key::Z);
        assert_eq!(shown(&harness).0, shading);
    }
    choose(&mut harness, &["Debug", "Debug: steps"]);
    assert!(!is_on(&harness, "Solid"), "a view for debugging hides the shading");
    press(&mut harness, Modifiers::NONE, Key::Z);
    assert_eq!(shown(&harness), (Shading::Solid, ViewMode::Shaded), "the key leads back to it");
    press(&mut harness, Modifiers::COMMAND, Key::N);
    assert_eq!(shown(&harness).0, Shading::Solid, "it belongs to the window, not to the document");
    assert_eq!(camera.rotation, harness.state().view().camera.rotation, "a button over the picture moves nothing");
}

#[test]
fn drawing_can_be_stopped_where_something_is_drawn() {
    let (scene, _) = scene();
    let mut harness = open(scene);
    assert!(!harness.state_mut().take_stop_drawing());
    harness.get_by_label("Stop drawing").click();
    harness.run();
    assert!(harness.state_mut().take_stop_drawing() && !harness.state_mut().take_stop_drawing(), "once");
}

#[test]
fn panels_are_hidden_and_shown_by_the_menu() {
    let (scene, _) = scene();
    let mut harness = open(scene);
    let width = |harness: &Harness<'_, Editor>| harness.get_by_label("Viewport").rect().width();
    let before = width(&harness);
    let toggle = |harness: &mut Harness<'_, Editor>, title: &str| {
        for name in ["View", "Panels", title] {
            let entry = harness.get_all_by_label(name).next().expect("an entry").rect().center();
            click(harness, entry);
            harness.run_steps(40);
        }
        press(harness, Modifiers::NONE, Key::Escape);
        harness.run_steps(40);
    };
    toggle(&mut harness, "Outliner");
    assert!(harness.query_by_label("Search").is_none(), "the tree is hidden");
    assert_eq!(width(&harness), before, "the materials have its place");
    toggle(&mut harness, "Materials");
    assert!(width(&harness) > before + 100.0, "{} {before}", width(&harness));
    toggle(&mut harness, "Materials");
    toggle(&mut harness, "Outliner");
    assert_eq!(width(&harness), before);
}

#[test]
fn an_idle_editor_asks_for_no_frames() {
    let (scene, _) = scene();
    let mut harness = open(scene);
    harness.run();
    for _ in 0..3 {
        harness.step();
        let viewport = &harness.output().viewport_output[&egui::ViewportId::ROOT];
        assert!(viewport.repaint_delay > std::time::Duration::from_secs(1), "{:?}", viewport.repaint_delay);
    }
}

#[test]
fn samples_are_counted_chosen_and_stopped() {
    let sampling = || Picture { samples: Some([16, 64]), is_sampling: true, ..Picture::default() };
    let mut harness =
        Harness::builder().with_size(vec2(1280.0, 800.0)).with_context_setup(Editor::setup).build_ui_state(
            move |ui, editor: &mut Editor| editor.show(ui, &sampling()),
            Editor::new(Document::new(scene().0)),
        );
    harness.settle();
    harness.get_by_label("16 / 64 samples");
    assert!(!harness.state_mut().take_stop_drawing());
    harness.get_by_label("Stop drawing").click();
    harness.run();
    assert!(harness.state_mut().take_stop_drawing());
    assert_eq!(harness.state().view().samples, 64);
    for name in ["Viewport shading", "Samples", "256 samples"] {
        harness.get_by_label(name).click();
        harness.run();
    }
    assert_eq!(harness.state().view().samples, 256);
}
