//! Linked duplicates, packed models, and Escape on the windows beside the scene.

use super::*;
use isolith::editor::Command;
use isolith::gallery;

fn run(harness: &mut Harness<'_, Editor>, command: Command) {
    let ctx = harness.ctx.clone();
    harness.state_mut().run(command, &ctx);
    harness.settle();
}

#[test]
fn linked_copies_change_together_until_they_are_unlinked() {
    let (scene, [_, ball, ..]) = scene();
    let mut harness = open(scene);
    harness.state_mut().document_mut().select(vec![ball]);
    harness.run();
    press(&mut harness, Modifiers::ALT, Key::D);
    let copy = harness.state().document().selection()[0];
    assert_ne!(copy, ball);
    harness.get_by_label_contains("linked with 1 more");
    let type_radius = |harness: &mut Harness<'_, Editor>, text: &str| {
        let at = field(harness, "Radius").rect().center();
        click(harness, at);
        press(harness, Modifiers::COMMAND, Key::A);
        harness.event(Event::Text(text.into()));
        harness.run();
        press(harness, Modifiers::NONE, Key::Enter);
    };
    type_radius(&mut harness, "0.25");
    let radius = 0.25;
    assert_eq!([ball, copy].map(|id| shape(&harness, id)), [Shape::Sphere { radius }, Shape::Sphere { radius }]);
    run(&mut harness, Command::SelectLinked);
    assert_eq!(harness.state().document().selection().len(), 2);
    harness.state_mut().document_mut().select(vec![copy]);
    harness.run();
    harness.get_by_label("Unlink").click();
    harness.run();
    harness.run_steps(40);
    type_radius(&mut harness, "0.75");
    assert_eq!(shape(&harness, ball), Shape::Sphere { radius });
    assert_eq!(undo_all(&mut harness), 4, "duplicate, size, unlink, size");
}

#[test]
fn models_are_packed_and_unpacked_by_two_commands() {
    let folder = tempfile::tempdir().unwrap();
    let (name, scene) = gallery::all().into_iter().find(|(name, _)| *name == "mesh-and-fields").unwrap();
    let file = gallery::install(name, &scene, folder.path()).unwrap();
    let mut harness = open_in(Document::open(&file).unwrap(), vec2(1280.0, 864.0));
    run(&mut harness, Command::PackFiles);
    let packed = harness.state().document().scene().packed.clone();
    assert!(!packed.is_empty() && harness.state().document().is_changed());
    let models = folder.path().join("models");
    std::fs::remove_dir_all(&models).unwrap();
    run(&mut harness, Command::ReloadModels);
    assert!(harness.state().messages().all(|message| !message.text.contains("cannot be")), "it needs no files");
    run(&mut harness, Command::UnpackFiles);
    assert!(harness.state().document().scene().packed.is_empty());
    for (name, bytes) in packed.table().iter() {
        assert_eq!(std::fs::read(folder.path().join(name)).unwrap(), bytes[..], "{name}");
    }
    assert_eq!(undo_all(&mut harness), 2);
}

#[test]
fn escape_closes_what_is_beside_the_scene_and_keeps_the_selection() {
    let (scene, [_, ball, ..]) = scene();
    let mut harness = open(scene);
    harness.state_mut().document_mut().select(vec![ball]);
    harness.run();
    for (command, inside) in [
        (Command::ShowHistory, "Step 0: Begin"),
        (Command::ShowKeys, "What's new"),
        (Command::ExamineScene, "Scan the scene"),
        (Command::Render, "Close the render dialog"),
    ] {
        run(&mut harness, command);
        harness.run_steps(30);
        assert_eq!(harness.query_all_by_label(inside).count(), 1, "{inside} is shown");
        press(&mut harness, Modifiers::NONE, Key::Escape);
        harness.run_steps(30);
        assert_eq!(harness.query_all_by_label(inside).count(), 0, "{inside} is gone");
        assert_eq!(harness.state().document().selection(), [ball], "{inside}");
    }
    press(&mut harness, Modifiers::NONE, Key::Escape);
    assert!(harness.state().document().selection().is_empty());
}
