//! Every command of the table on an empty scene, on one node and on a thousand: none fails, and undo leads back.

use egui::{Key, Modifiers};
use egui_kittest::Harness;
use isolith::document::Document;
use isolith::editor::{Command, Editor};
use isolith::scene::{NodeId, Scene, file};

use super::scale::crowd;
use super::{open, press};

/// Commands that replace or leave the document: they run last, and undo does not lead back over them.
const LEAVING: [Command; 7] =
    [Command::New, Command::Open, Command::Reload, Command::Recover, Command::Save, Command::SaveAs, Command::Quit];

fn run(harness: &mut Harness<'_, Editor>, command: Command) {
    let ctx = harness.ctx.clone();
    harness.state_mut().run(command, &ctx);
    harness.run_steps(2);
    if command == Command::Play {
        harness.state_mut().run(command, &ctx);
    }
    // Whatever it has opened or begun.
    for _ in 0..2 {
        press(harness, Modifiers::NONE, Key::Escape);
    }
}

fn bytes(harness: &Harness<'_, Editor>) -> String {
    file::to_json(harness.state().document().resting()).unwrap()
}

/// Runs all commands on a scene with these nodes selected; returns how many of them changed it.
fn run_all(scene: &Scene, selected: &[NodeId]) -> usize {
    let mut harness = open(scene.clone());
    let before = bytes(&harness);
    let mut changed = 0;
    for command in Command::all().filter(|command| !LEAVING.contains(command)) {
        harness.state_mut().document_mut().select(selected.to_vec());
        harness.step();
        run(&mut harness, command);
        changed += usize::from(bytes(&harness) != before);
        let label = &command.info().label;
        assert!(!harness.state().has_dialog(), "{label} leaves a dialog open");
        while harness.state_mut().document_mut().undo() {}
        assert!(bytes(&harness) == before, "{label}: undo does not lead back");
    }
    for command in LEAVING {
        run(&mut harness, command);
    }
    changed
}

#[test]
fn every_command_runs_on_an_empty_scene_and_on_one_node() {
    let added = run_all(&Scene::new(), &[]);
    let kinds = isolith::scene::ShapeKind::ALL.len();
    assert!(added > kinds, "{added}: at least every shape is added");
    let one = crowd(2);
    let with_one = run_all(&one, &[NodeId(2)]);
    assert!(with_one > added + 10, "{with_one}: and the node is changed");
}

#[test]
fn every_command_runs_on_a_thousand_nodes() {
    let scene = crowd(1_000);
    let groups: Vec<NodeId> = (0..1_000 / 11).map(|group| NodeId(group * 11 + 1)).collect();
    assert!(run_all(&scene, &groups) > 20);
    // A document that was never drawn can be edited, too.
    let mut document = Document::new(scene);
    document.select(groups);
    assert_eq!(document.selection().len(), 90);
}
