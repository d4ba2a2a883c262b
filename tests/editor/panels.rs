//! Docked panels: moved by their tabs, closed, opened again, kept for the next start, reset. And their words.

use egui::{Rect, accesskit::Role};
use isolith::document::Preferences;

use super::*;

/// The tab of a panel.
fn tab(harness: &Harness<'_, Editor>, title: &str) -> Option<Rect> {
    let mut found = harness.query_all_by_label(title).filter(|node| node.accesskit_node().role() == Role::Tab);
    found.next().map(|node| node.rect())
}

fn tab_at(harness: &Harness<'_, Editor>, title: &str) -> Rect {
    tab(harness, title).unwrap_or_else(|| panic!("no tab {title}"))
}

fn viewport(harness: &Harness<'_, Editor>) -> Rect {
    harness.get_by_label("Viewport").rect()
}

/// Drags from one place to another over several frames.
fn drag(harness: &mut Harness<'_, Editor>, from: Pos2, to: Pos2) {
    pointer(harness, from, true);
    harness.step();
    for step in 1..=8 {
        harness.event(Event::PointerMoved(from.lerp(to, step as f32 / 8.0)));
        harness.step();
    }
    pointer(harness, to, false);
    harness.settle();
    harness.run_steps(30);
}

fn choose(harness: &mut Harness<'_, Editor>, names: &[&str]) {
    for name in names {
        let entry = harness.get_all_by_label(name).next().expect("an entry").rect().center();
        super::click(harness, entry);
        harness.run_steps(40);
    }
    press(harness, Modifiers::NONE, Key::Escape);
    harness.run_steps(40);
}

#[test]
fn the_first_layout_is_calm_and_no_panel_covers_another() {
    let harness = open(scene().0);
    let view = viewport(&harness);
    let [outliner, materials, inspector, timeline] =
        ["Outliner", "Materials", "Inspector", "Timeline"].map(|title| tab_at(&harness, title));
    assert!(outliner.bottom() < materials.top() && materials.right() < view.left(), "{outliner} {materials} {view}");
    assert!(inspector.left() >= view.right() && timeline.top() >= view.bottom(), "{inspector} {timeline} {view}");
    assert!(tab(&harness, "Log").is_some(), "the log is behind the timeline");
    assert!(tab(&harness, "Viewport").is_none(), "the viewport needs no tab");
    assert!(view.width() > 640.0 && view.height() > 600.0, "{view}");
}

#[test]
fn a_layout_is_kept_for_the_next_start_and_reset() {
    let folder = tempfile::tempdir().unwrap();
    let store = folder.path().join("preferences.json");
    let mut harness = open(scene().0);
    harness.state_mut().set_preferences(Preferences::load_from(&store));
    harness.settle();
    let first = ["Outliner", "Materials", "Inspector", "Timeline"].map(|title| tab(&harness, title));
    let before = viewport(&harness);
    // The materials go behind the inspector.
    let (from, to) = (tab_at(&harness, "Materials").left_center(), tab_at(&harness, "Inspector").right_center());
    drag(&mut harness, from + vec2(14.0, 0.0), to + vec2(6.0, 0.0));
    let (materials, inspector) = (tab_at(&harness, "Materials"), tab_at(&harness, "Inspector"));
    assert!((materials.top() - inspector.top()).abs() < 1.0 && materials.left() > before.right(), "{materials}");
    assert_eq!(viewport(&harness).width(), before.width());
    // The inspector becomes wider.
    let edge = viewport(&harness).right_center() + vec2(0.5, 40.0);
    drag(&mut harness, edge, edge - vec2(70.0, 0.0));
    let narrow = viewport(&harness).width();
    assert!((before.width() - narrow - 70.0).abs() < 8.0, "{} {narrow}", before.width());
    // The log is closed.
    harness.get_by_label("Close Log").click();
    harness.run_steps(10);
    assert!(tab(&harness, "Log").is_none());
    let now = ["Outliner", "Materials", "Inspector", "Timeline"].map(|title| tab(&harness, title));
    let mut next = open(scene().0);
    next.state_mut().set_preferences(Preferences::load_from(&store));
    next.settle();
    next.run_steps(10);
    assert_eq!(["Outliner", "Materials", "Inspector", "Timeline"].map(|title| tab(&next, title)), now);
    assert_eq!((viewport(&next).width(), tab(&next, "Log")), (narrow, None));
    choose(&mut next, &["View", "Panels", "Log"]);
    assert!(tab(&next, "Log").is_some(), "it is opened again where it was");
    choose(&mut next, &["View", "Panels", "Reset layout"]);
    assert_eq!(["Outliner", "Materials", "Inspector", "Timeline"].map(|title| tab(&next, title)), first);
    assert_eq!(viewport(&next), before);
    assert_eq!(Preferences::load_from(&store).values().layout, None);
}

#[test]
fn the_log_shows_messages_and_comes_to_the_front() {
    let mut harness = open(scene().0);
    harness.state_mut().report(isolith::editor::Message::info("Something was done."));
    harness.run_steps(3);
    assert_eq!(harness.query_all_by_label("Something was done.").count(), 1, "the toast alone");
    choose(&mut harness, &["View", "Log"]);
    assert!(harness.query_all_by_label("Something was done.").count() >= 1);
    harness.run_steps(300);
    assert_eq!(harness.query_all_by_label("Something was done.").count(), 1, "the log alone");
    choose(&mut harness, &["View", "Log"]);
    assert!(tab(&harness, "Log").is_none(), "the same command closes it");
}

#[test]
fn every_control_has_a_name() {
    let (scene, [group, ball, ..]) = scene();
    let mut harness = open_tall(scene);
    let mut unnamed = Vec::new();
    for selection in [vec![], vec![ball], vec![group], vec![ball, group]] {
        harness.state_mut().document_mut().select(selection.clone());
        harness.settle();
        collect_unnamed(&harness, &format!("{selection:?}"), &mut unnamed);
    }
    for (menu, title) in [("View", "Log"), ("Edit", "Preferences…")] {
        choose_without_closing(&mut harness, &[menu, title]);
        collect_unnamed(&harness, title, &mut unnamed);
    }
    harness.get_by_label("Keymap").click();
    harness.run_steps(5);
    collect_unnamed(&harness, "the keys", &mut unnamed);
    assert!(unnamed.is_empty(), "{}", unnamed.join("\n"));
}

fn choose_without_closing(harness: &mut Harness<'_, Editor>, names: &[&str]) {
    for name in names {
        let entry = harness.get_all_by_label(name).next().expect("an entry").rect().center();
        super::click(harness, entry);
        harness.run_steps(40);
    }
}

/// Notes the controls that a screen reader could not name.
fn collect_unnamed(harness: &Harness<'_, Editor>, when: &str, unnamed: &mut Vec<String>) {
    const CONTROLS: [Role; 10] = [
        Role::Button,
        Role::CheckBox,
        Role::ComboBox,
        Role::TextInput,
        Role::SpinButton,
        Role::Slider,
        Role::RadioButton,
        Role::Tab,
        Role::Link,
        Role::ColorWell,
    ];
    let mut count = 0;
    for node in harness.query_all_by(|node| CONTROLS.contains(&node.role())) {
        count += 1;
        let inner = node.accesskit_node();
        let is_icon = |c: char| ('\u{e000}'..='\u{f8ff}').contains(&c) || c.is_whitespace();
        if inner.label().unwrap_or_default().chars().all(is_icon) {
            unnamed.push(format!("{when}: {:?} at {} ({:?})", inner.role(), node.rect(), inner.value()));
        }
    }
    assert!(count > 20, "{when}: the tree has only {count} controls");
}

#[test]
fn names_in_any_script_and_of_any_length_fit_the_outliner() {
    let (mut scene, [_, ball, ..]) = scene();
    let names = [
        "كرة زرقاء",
        "红色的球",
        "लाल गेंद",
        "Ein sehr langer Name, der gewiss nicht in die Zeile paßt ".repeat(3).leak(),
    ];
    for name in names {
        scene.insert(None, 0, Node::new(name, NodeKind::Group(Group::UNION))).unwrap();
    }
    let mut harness = open(self::scene().0);
    harness.ctx.add_font_provider(std::sync::Arc::new(egui_system_font_provider::SystemFontProvider::new()));
    // A machine without fonts for a script shows boxes.
    harness.ctx.set_missing_glyph_policy(egui::epaint::text::MissingGlyphPolicy::Tofu);
    harness.run_steps(2);
    let view = viewport(&harness);
    *harness.state_mut() = Editor::new(Document::new(scene));
    harness.state_mut().document_mut().select(vec![ball]);
    harness.settle();
    for name in names {
        let node = harness.get_all_by_label(name).next().expect(name);
        assert!(node.rect().height() > 8.0 && node.rect().left() < view.left(), "{name}: {}", node.rect());
    }
    assert!(harness.get_by_label("Viewport").rect() == view, "a long name moves nothing");
}
