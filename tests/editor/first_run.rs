//! Welcome, tour and help, as a new user meets them.

use std::sync::Arc;

use egui::{Key, Modifiers, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use isolith::document::{Document, Preferences};
use isolith::editor::{Editor, Example};
use isolith::gallery;
use isolith::scene::Scene;

use super::{click, no_picture, open, press};
use crate::settle::Settle;

fn example(name: &str, is_test: bool, scene: Scene) -> Example {
    Example { name: name.into(), is_test, open: Arc::new(move |_: &_| Ok(Document::new(scene.clone()))) }
}

/// An editor as the program starts it, with these preferences.
fn start(preferences: Preferences) -> Harness<'static, Editor> {
    let mut editor = Editor::new(Document::new(Scene::new()));
    editor.ask_for_paths_in_window();
    editor.set_preferences(preferences);
    let all = gallery::all().into_iter();
    editor.set_examples(
        all.map(|(name, scene)| example(&name.replace('-', " "), gallery::is_test_scene(name), scene)).collect(),
    );
    let templates = gallery::templates().into_iter().map(|template| example(template.name, false, template.scene));
    editor.set_templates(templates.collect(), gallery::thumbnail);
    editor.welcome_at_start();
    let mut harness = Harness::builder()
        .with_size(vec2(1280.0, 800.0))
        .with_context_setup(Editor::setup)
        .build_ui_state(|ui, editor: &mut Editor| editor.show(ui, &no_picture()), editor);
    harness.settle();
    harness
}

fn press_button(harness: &mut Harness<'_, Editor>, name: &str) {
    let at = harness.get_by_label(name).rect().center();
    click(harness, at);
}

#[test]
fn an_example_and_a_template_open_from_the_welcome() {
    let mut harness = start(Preferences::default());
    assert!(harness.state().has_dialog());
    assert!(harness.query_by_label("Example random 37").is_none(), "test scenes are not for artists");
    press_button(&mut harness, "Example pawn");
    assert!(!harness.state().has_dialog(), "it has closed");
    let pawn = gallery::all().into_iter().find(|(name, _)| *name == "pawn").expect("the pawn").1;
    assert_eq!(*harness.state().document().scene(), pawn);
    for template in gallery::templates() {
        let mut harness = start(Preferences::default());
        press_button(&mut harness, &format!("Start with {}", template.name));
        assert_eq!(*harness.state().document().scene(), template.scene, "{}", template.name);
        assert!(!harness.state().document().is_changed() && harness.state().document().path().is_none());
    }
}

#[test]
fn the_welcome_comes_back_from_the_menu_and_stays_away_if_it_is_told_to() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let store = folder.path().join("preferences.json");
    let mut harness = start(Preferences::load_from(&store));
    press_button(&mut harness, "Show at the start");
    press_button(&mut harness, "Close the welcome");
    assert!(!harness.state().has_dialog());
    let mut harness = start(Preferences::load_from(&store));
    assert!(!harness.state().has_dialog(), "it was told to stay away");
    press_button(&mut harness, "Help");
    press_button(&mut harness, "Welcome…");
    assert!(harness.state().has_dialog());
    press(&mut harness, Modifiers::NONE, Key::Escape);
    assert!(!harness.state().has_dialog());
}

#[test]
fn the_tour_goes_on_back_and_ends_and_can_be_skipped() {
    let mut harness = start(Preferences::default());
    press_button(&mut harness, "Take the tour");
    harness.get_by_label("Look around");
    press_button(&mut harness, "Next");
    harness.get_by_label("Add shapes");
    press_button(&mut harness, "Back");
    for _ in 0..5 {
        press_button(&mut harness, "Next");
    }
    harness.get_by_label("6 of 6");
    press_button(&mut harness, "Done");
    assert!(harness.query_by_label("6 of 6").is_none());
    // Again from the menu; the scene can be edited meanwhile.
    press_button(&mut harness, "Help");
    press_button(&mut harness, "Tour");
    harness.get_by_label("Add sphere").click();
    harness.settle();
    assert_eq!(harness.state().document().scene().nodes().len(), 1);
    harness.get_by_label("1 of 6");
    press_button(&mut harness, "Skip the tour");
    assert!(harness.query_by_label("1 of 6").is_none());
}

#[test]
fn help_shows_pages_keys_and_news() {
    let mut harness = open(Scene::new());
    press(&mut harness, Modifiers::NONE, Key::F1);
    press_button(&mut harness, "Field doctor");
    harness.get_by_label_contains("Finds nodes whose field is broken");
    press_button(&mut harness, "Keys");
    harness.get_by_label_contains("Shift+D, ");
    press_button(&mut harness, "What's new");
    harness.get_by_label("Unreleased");
}

#[test]
fn pictures_of_examples_are_those_of_the_golden_tests() {
    let goldens = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden");
    for (name, _) in gallery::all().into_iter().filter(|(name, _)| !gallery::is_test_scene(name)) {
        let bytes = gallery::thumbnail(name).unwrap_or_else(|| panic!("no picture of {name}"));
        let shown = image::load_from_memory(bytes).expect("a JPEG").into_rgb8();
        // The golden tests ask for pictures that are missing.
        let Ok(golden) = image::open(goldens.join(name).with_extension("png")) else { continue };
        // Small enough that edges and the blocks of JPEG do not count.
        let (width, height) = (32, 32);
        let reduced = |picture: image::RgbImage| image::imageops::thumbnail(&picture, width, height);
        let (shown, golden) = (reduced(shown), reduced(golden.into_rgb8()));
        let sum: u64 = shown.iter().zip(golden.iter()).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
        let mean = sum as f64 / f64::from(width * height * 3);
        // Rounding and JPEG take up to 2 of 255; another scene or view takes far more.
        let again = format!("tests/golden/{name}.png -resize 192x192 -quality 86 src/gallery/thumbnails/{name}.jpg");
        assert!(mean < 5.0, "the picture of {name} differs by {mean:.1}: `magick {again}` makes it again");
    }
}

#[test]
fn escape_closes_the_window_above_the_others_first() {
    let mut harness = open(Scene::new());
    for (first, second) in [(Key::F1, Key::F10), (Key::F10, Key::F1)] {
        let shows = |harness: &Harness<'_, Editor>, key: Key| {
            let bottom = if key == Key::F1 { "What's new" } else { "Findings" };
            harness.query_by_label(bottom).is_some()
        };
        let is_open = |harness: &Harness<'_, Editor>| [first, second].map(|key| shows(harness, key));
        press(&mut harness, Modifiers::NONE, first);
        press(&mut harness, Modifiers::NONE, second);
        harness.settle();
        assert_eq!(is_open(&harness), [true, true]);
        press(&mut harness, Modifiers::NONE, Key::Escape);
        assert_eq!(is_open(&harness), [true, false], "the one above");
        press(&mut harness, Modifiers::NONE, Key::Escape);
        assert_eq!(is_open(&harness), [false, false]);
    }
}
