//! Every command of the table on an empty scene, on one node and on a thousand: none fails, and undo leads back.

use egui::accesskit::Role;
use egui::{Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use isolith::document::Document;
use isolith::editor::{Command, Editor, Keymap};
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
    // With the draw tool, commands that add choose what is drawn.
    if command.info().label == "Draw tool" {
        let select = Command::all().find(|command| command.info().label == "Select tool").unwrap();
        harness.state_mut().run(select, &ctx);
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

/// What a command may change, apart from the inside of windows.
fn state_of(harness: &Harness<'_, Editor>) -> String {
    let editor = harness.state();
    let selection = editor.document().selection();
    let tools = ["Select tool", "Move tool", "Rotate tool", "Scale tool", "Draw tool"];
    let tools = tools.map(|tool| {
        let button = harness.query_by_label(tool).map(|node| node.accesskit_node().toggled());
        format!("{button:?}")
    });
    let windows = harness.root().children_recursive().filter(|node| node.accesskit_node().role() == Role::Window);
    let parts = [format!("{selection:?}"), format!("{:?}", editor.view()), editor.has_dialog().to_string()];
    format!("{} {parts:?} {tools:?} {}", bytes(harness), windows.count())
}

/// One editor gets the keys, another the commands: they stay alike.
#[test]
fn the_keys_of_both_keymaps_run_their_commands() {
    let mut harnesses = [0, 1].map(|_| open(crowd(24)));
    for keymap in Keymap::ALL {
        for harness in &mut harnesses {
            run(harness, Command::UseKeymap(keymap));
        }
        let mut pressed = 0;
        // What time changes differs by itself; what leaves the document is looked at elsewhere.
        let is_wanted = |command: &Command| *command != Command::Play && !LEAVING.contains(command);
        for command in Command::all().filter(is_wanted) {
            for key in command.info().keys(keymap) {
                for harness in &mut harnesses {
                    harness.state_mut().document_mut().select(vec![NodeId(3), NodeId(2)]);
                    harness.run_steps(2);
                }
                let [by_key, by_name] = &mut harnesses;
                by_key.key_press_modifiers(key.modifiers, key.logical_key);
                by_key.run_steps(2);
                let ctx = by_name.ctx.clone();
                by_name.state_mut().run(command, &ctx);
                by_name.run_steps(2);
                let label = &command.info().label;
                assert_eq!(state_of(by_key), state_of(by_name), "{label} by {key:?} of {keymap:?}");
                for harness in &mut harnesses {
                    for _ in 0..2 {
                        press(harness, Modifiers::NONE, Key::Escape);
                    }
                }
                pressed += 1;
            }
        }
        assert!(pressed > 60, "{pressed} keys of {keymap:?}");
    }
}

#[test]
fn a_key_of_one_keymap_means_something_else_in_the_other() {
    for (keymap, tool) in [(Keymap::Blender, false), (Keymap::Industry, true)] {
        let mut harness = open(crowd(24));
        run(&mut harness, Command::UseKeymap(keymap));
        harness.state_mut().document_mut().select(vec![NodeId(2)]);
        harness.run_steps(2);
        let before = state_of(&harness);
        press(&mut harness, Modifiers::NONE, Key::E);
        assert_eq!(state_of(&harness) != before, tool, "{keymap:?}");
    }
}
