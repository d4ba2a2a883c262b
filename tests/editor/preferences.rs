//! The preferences: chosen in their window, kept for the next start, and what becomes of a damaged file.

use isolith::document::{PreferenceValues, Preferences};

use super::*;

fn open_preferences(harness: &mut Harness<'_, Editor>) {
    press(harness, Modifiers::COMMAND, Key::Comma);
    harness.run_steps(3);
    harness.get_by_label("Close");
}

fn pick(harness: &mut Harness<'_, Editor>, list: &str, entry: &str) {
    list_box(harness, list).click();
    harness.run_steps(20);
    harness.get_by_label(entry).click();
    harness.run_steps(20);
}

fn values(store: &std::path::Path) -> PreferenceValues {
    Preferences::load_from(store).values().clone()
}

#[test]
fn preferences_are_chosen_in_their_window_and_kept() {
    let folder = tempfile::tempdir().unwrap();
    let store = folder.path().join("preferences.json");
    let (scene, [_, ball, ..]) = scene();
    let mut harness = open(scene.clone());
    harness.state_mut().set_preferences(Preferences::load_from(&store));
    harness.state_mut().document_mut().select(vec![ball]);
    open_preferences(&mut harness);
    let dark = harness.ctx.global_style().visuals.panel_fill;
    pick(&mut harness, "Theme", "Light");
    let light = harness.ctx.global_style().visuals.panel_fill;
    assert!(light.r() > 200 && dark.r() < 60, "{light:?} {dark:?}");
    pick(&mut harness, "Unit of length", "Centimeters (cm)");
    pick(&mut harness, "Samples", "256");
    pick(&mut harness, "Scale", "125 %");
    assert_eq!(harness.ctx.zoom_factor(), 1.25);
    harness.get_by_label("Close").click();
    harness.settle();
    let kept = values(&store);
    assert_eq!((&*kept.theme, &*kept.unit, kept.scale, kept.samples), ("Light", "cm", 1.25, Some(256)));
    let mut next = open(scene);
    next.state_mut().set_preferences(Preferences::load_from(&store));
    next.state_mut().document_mut().select(vec![ball]);
    next.settle();
    assert_eq!(next.ctx.global_style().visuals.panel_fill, light);
    assert_eq!((next.ctx.zoom_factor(), next.state().view().samples), (1.25, 256));
    let radius = field(&next, "Radius").accesskit_node().value().unwrap_or_default();
    assert!(radius.starts_with("50") && radius.ends_with("cm"), "{radius}");
}

#[test]
fn how_drags_snap_is_kept() {
    let folder = tempfile::tempdir().unwrap();
    let store = folder.path().join("preferences.json");
    let mut harness = open(scene().0);
    harness.state_mut().set_preferences(Preferences::load_from(&store));
    for command in ["Snap lengths: 0.02", "Snap angles: 45", "Snap always"] {
        press(&mut harness, Modifiers::NONE, Key::F3);
        harness.event(Event::Text(command.into()));
        harness.run();
        press(&mut harness, Modifiers::NONE, Key::Enter);
    }
    let kept = values(&store);
    assert_eq!((kept.snaps, kept.snap_length, kept.snap_angle), (true, Some(0.02), Some(45.0)));
    // Steps that are none are not taken over.
    std::fs::write(&store, r#"{ "snap_length": -1.0, "snap_angle": 0.0 }"#).unwrap();
    let kept = values(&store);
    assert_eq!((kept.snaps, kept.snap_length, kept.snap_angle), (false, None, None));
}

#[test]
fn a_length_is_typed_in_the_unit_in_use_or_in_another() {
    let (scene, [_, ball, ..]) = scene();
    let mut harness = open(scene);
    let mut preferences = Preferences::default();
    preferences.change(|values| values.unit = "cm".into());
    harness.state_mut().set_preferences(preferences);
    select(&mut harness, "Ball");
    for (text, meters) in [("25", 0.25), ("1.5 m", 1.5), ("10 in", 0.254), ("2*3 cm", 0.06)] {
        let radius = field(&harness, "Radius").rect().center();
        click(&mut harness, radius);
        press(&mut harness, Modifiers::COMMAND, Key::A);
        harness.event(Event::Text(text.into()));
        harness.run();
        press(&mut harness, Modifiers::NONE, Key::Enter);
        let Shape::Sphere { radius } = shape(&harness, ball) else { panic!() };
        assert!((radius - meters).abs() < 1e-12, "{text}: {radius}");
    }
}

#[test]
fn a_damaged_file_is_told_and_kept() {
    let folder = tempfile::tempdir().unwrap();
    let store = folder.path().join("preferences.json");
    std::fs::write(&store, "{ \"theme\": ").unwrap();
    let mut harness = open(scene().0);
    harness.state_mut().set_preferences(Preferences::load_from(&store));
    harness.settle();
    let told = harness.state().messages().next_back().expect("a message").text.clone();
    assert!(told.contains("preferences.json.broken"), "{told}");
    assert_eq!(std::fs::read_to_string(folder.path().join("preferences.json.broken")).unwrap(), "{ \"theme\": ");
    press(&mut harness, Modifiers::COMMAND, Key::Equals);
    harness.run_steps(4);
    assert!(values(&store).scale > 1.0, "the scale changed by keys is kept, too");
}

fn open_keys(harness: &mut Harness<'_, Editor>) {
    open_preferences(harness);
    harness.get_all_by_label("Keymap").next().expect("the page").click();
    harness.run_steps(5);
}

fn search(harness: &mut Harness<'_, Editor>, text: &str) {
    let at = harness.get_by_label("Search keys").rect().center();
    click(harness, at);
    press(harness, Modifiers::COMMAND, Key::A);
    harness.event(Event::Text(text.into()));
    harness.run_steps(3);
}

#[test]
fn keys_are_changed_conflicts_are_named_and_everything_can_be_reset() {
    let folder = tempfile::tempdir().unwrap();
    let store = folder.path().join("preferences.json");
    let (scene, [_, ball, ..]) = scene();
    let mut harness = open(scene);
    harness.state_mut().set_preferences(Preferences::load_from(&store));
    open_keys(&mut harness);
    search(&mut harness, "toggle visible");
    harness.get_by_label("Toggle visible: H").click();
    harness.run_steps(3);
    press(&mut harness, Modifiers::NONE, Key::J);
    harness.get_by_label("Toggle visible: J");
    // K belongs to another command.
    harness.get_by_label("Toggle visible: J").click();
    harness.run_steps(3);
    press(&mut harness, Modifiers::NONE, Key::K);
    harness.get_by_label("K belongs to Insert key.");
    harness.get_by_label("Leave it").click();
    harness.run_steps(3);
    harness.get_by_label("Toggle visible: J");
    harness.get_by_label("Add a key to Toggle visible").click();
    harness.run_steps(3);
    press(&mut harness, Modifiers::NONE, Key::K);
    harness.get_by_label("Give it to Toggle visible").click();
    harness.run_steps(3);
    harness.get_by_label("Close").click();
    harness.settle();
    harness.state_mut().document_mut().select(vec![ball]);
    let visible = |harness: &Harness<'_, Editor>| harness.state().document().scene().node(ball).unwrap().visible;
    for (key, is_visible) in [(Key::H, true), (Key::J, false), (Key::K, true)] {
        press(&mut harness, Modifiers::NONE, key);
        assert_eq!(visible(&harness), is_visible, "{key:?}");
    }
    assert_eq!(values(&store).keys["Blender"]["Toggle visible"], ["J", "K"]);
    open_keys(&mut harness);
    harness.get_by_label("Reset all keys").click();
    harness.run_steps(3);
    harness.get_by_label("Close").click();
    harness.settle();
    press(&mut harness, Modifiers::NONE, Key::H);
    assert!(!visible(&harness));
}

#[test]
fn escape_leaves_a_key_and_keys_are_exported_and_imported() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("keys.json");
    let mut harness = open(scene().0);
    let ask = |harness: &mut Harness<'_, Editor>, button: &str, agree: &str| {
        harness.get_by_label(button).click();
        harness.run_steps(5);
        press(harness, Modifiers::COMMAND, Key::A);
        harness.event(Event::Text(file.display().to_string()));
        harness.run_steps(3);
        harness.get_by_label(agree).click();
        harness.run_steps(5);
    };
    open_keys(&mut harness);
    search(&mut harness, "lock");
    harness.get_by_label("Toggle lock: L").click();
    harness.run_steps(3);
    press(&mut harness, Modifiers::NONE, Key::Escape);
    harness.get_by_label("Toggle lock: L").click();
    harness.run_steps(3);
    press(&mut harness, Modifiers::ALT, Key::F9);
    harness.get_by_label("Toggle lock: Alt+F9");
    ask(&mut harness, "Export…", "Save");
    assert!(std::fs::read_to_string(&file).unwrap().contains("Alt+F9"));
    harness.get_by_label("Reset all keys").click();
    harness.run_steps(3);
    harness.get_by_label("Toggle lock: L");
    ask(&mut harness, "Import…", "Open");
    harness.get_by_label("Toggle lock: Alt+F9");
    harness.get_by_label("Reset the keys of Toggle lock").click();
    harness.run_steps(3);
    harness.get_by_label("Toggle lock: L");
}
