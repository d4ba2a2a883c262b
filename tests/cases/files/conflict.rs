//! Two editors on one file: neither overwrites the other's save without asking.

use std::fs;
use std::path::{Path, PathBuf};

use egui::{Key, Modifiers};
use egui_kittest::Harness;
use isolith::document::{Document, Edit, OverwriteRisk, RecentFiles};
use isolith::editor::Editor;
use isolith::scene::{Environment, Scene, file};

use super::{editor, last_message, plain_scene, press, shows};
use crate::settle::Settle;

const QUESTION: &str = "“scene.json” was changed by another program";

fn saved(folder: &Path, seed: u64) -> PathBuf {
    let path = folder.join("scene.json");
    file::save(&plain_scene(seed, 5), &path).expect("saved");
    path
}

fn darken(document: &mut Document) {
    let environment = Environment::sky([0.125; 3], [0.5; 3], [0.5; 3]);
    document.apply(Edit::SetEnvironment(environment)).expect("valid");
}

/// An editor with a change, on a file that another editor has saved since.
fn overtaken(path: &Path, theirs: Scene) -> (Harness<'static, Editor>, Scene, Scene) {
    let mut document = Document::open(path).expect("opens");
    darken(&mut document);
    let mine = document.scene().clone();
    file::save(&theirs, path).expect("saved");
    (editor(document, |_| ()), mine, theirs)
}

fn save(harness: &mut Harness<'_, Editor>) {
    harness.key_press_modifiers(Modifiers::COMMAND, Key::S);
    harness.settle();
}

#[test]
fn saving_knows_what_it_would_replace() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = saved(folder.path(), 1);
    let mut document = Document::open(&path).expect("opens");
    let other = folder.path().join("other.json");
    assert_eq!(document.would_replace(&other), OverwriteRisk::Nothing, "nothing is there");
    fs::write(&other, "{}").expect("written");
    assert_eq!(document.would_replace(&other), OverwriteRisk::OtherFile);
    let text = fs::read(&path).expect("there");
    for (what, contents, expected) in [
        ("as it was read", text.clone(), OverwriteRisk::Nothing),
        ("written anew with the same contents", text.clone(), OverwriteRisk::Nothing),
        ("one byte longer", [&text[..], b"\n"].concat(), OverwriteRisk::ChangedByOthers),
        (
            "of the same length",
            text.iter().map(|b| if *b == b'0' { b'1' } else { *b }).collect(),
            OverwriteRisk::ChangedByOthers,
        ),
        ("empty", Vec::new(), OverwriteRisk::ChangedByOthers),
    ] {
        fs::write(&path, contents).expect("written");
        for spelling in [path.clone(), folder.path().join("./scene.json")] {
            assert_eq!(document.would_replace(&spelling), expected, "{what}");
        }
    }
    document.save().expect("saved");
    assert_eq!(document.would_replace(&path), OverwriteRisk::Nothing, "what was saved is known");
    fs::remove_file(&path).expect("removed");
    assert_eq!(document.would_replace(&path), OverwriteRisk::Nothing, "it is gone");
    // Saving under another name changes the document's file from then on.
    document.save_as(&other).expect("saved");
    fs::write(&other, "{}").expect("written");
    assert_eq!(document.would_replace(&other), OverwriteRisk::ChangedByOthers);
}

#[test]
fn a_file_that_was_changed_is_not_written_over_unasked() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = saved(folder.path(), 1);
    let (mut harness, mine, theirs) = overtaken(&path, plain_scene(98, 5));
    save(&mut harness);
    assert!(shows(&harness, QUESTION) && harness.state().has_dialog());
    // Escape changes nothing, and neither does the button.
    harness.key_press(Key::Escape);
    harness.settle();
    assert!(!shows(&harness, QUESTION));
    save(&mut harness);
    press(&mut harness, "Cancel");
    assert_eq!(file::load(&path).as_ref(), Ok(&theirs));
    assert!(harness.state().document().is_changed());
    save(&mut harness);
    press(&mut harness, "Overwrite");
    assert_eq!(file::load(&path), Ok(mine));
    assert!(!harness.state().document().is_changed());
    assert_eq!(file::load(&folder.path().join("scene.json~")), Ok(theirs), "the other's work is the backup");
    // The next save needs no question.
    darken_more(&mut harness);
    save(&mut harness);
    assert!(!shows(&harness, QUESTION) && last_message(&harness).starts_with("Saved"));
}

fn darken_more(harness: &mut Harness<'_, Editor>) {
    let document = harness.state_mut().document_mut();
    let environment = Environment::sky([0.25; 3], [0.5; 3], [0.5; 3]);
    document.apply(Edit::SetEnvironment(environment)).expect("valid");
    harness.settle();
}

#[test]
fn the_other_ones_work_can_be_taken_or_mine_saved_elsewhere() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = saved(folder.path(), 1);
    let (mut harness, _, theirs) = overtaken(&path, plain_scene(98, 5));
    save(&mut harness);
    press(&mut harness, "Reload");
    assert_eq!(harness.state().document().scene(), &theirs);
    assert!(!harness.state().document().is_changed());
    let (mut harness, mine, theirs) = overtaken(&path, plain_scene(99, 5));
    save(&mut harness);
    press(&mut harness, "Save as…");
    assert!(shows(&harness, "Save the scene"));
    assert_eq!(harness.state().document().scene(), &mine);
    assert_eq!(file::load(&path), Ok(theirs));
}

#[test]
fn a_file_changed_meanwhile_is_told_of_when_the_artist_comes_back() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = saved(folder.path(), 1);
    let mut harness = editor(Document::open(&path).expect("opens"), |_| ());
    let focus = |harness: &mut Harness<'_, Editor>, focused: bool| {
        harness.input_mut().focused = focused;
        harness.event(egui::Event::WindowFocused(focused));
        harness.settle();
    };
    focus(&mut harness, false);
    focus(&mut harness, true);
    assert_eq!(harness.state().messages().count(), 0, "nobody has changed it");
    focus(&mut harness, false);
    file::save(&plain_scene(2, 5), &path).expect("saved");
    focus(&mut harness, true);
    assert!(last_message(&harness).contains("has changed scene.json"), "{}", last_message(&harness));
    focus(&mut harness, false);
    focus(&mut harness, true);
    assert_eq!(harness.state().messages().count(), 1, "once");
}

#[test]
fn lists_of_recent_files_of_two_windows_do_not_push_each_other_out() {
    let folder = tempfile::tempdir().expect("a folder");
    let store = folder.path().join("recent.json");
    let [mut one, mut two] = [RecentFiles::load_from(&store), RecentFiles::load_from(&store)];
    let [a, b, c] = ["a.json", "b.json", "c.json"].map(|name| folder.path().join(name));
    one.add(&a);
    two.add(&b);
    one.add(&c);
    assert_eq!(RecentFiles::load_from(&store).paths(), [c.clone(), b.clone(), a.clone()]);
    two.remove(&c);
    assert_eq!(RecentFiles::load_from(&store).paths(), [b, a]);
    assert_eq!(super::names(folder.path()), ["recent.json"], "no temporary is left");
}
