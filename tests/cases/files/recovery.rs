//! No unsaved change is lost when the program ends.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use egui::Key;
use egui_kittest::kittest::Queryable;
use isolith::document::Document;
use isolith::document::recovery::{Note, Recovered, Recovery, Rescued, Thumbnail};
use isolith::editor::Severity;
use isolith::scene::{Scene, file};

use super::{add_group, changed, editor, has, kept, kept_with, last_message, names, plain_scene, press, shows, until};
use crate::settle::Settle;

/// Leaves the document as a process that dies at this point would.
fn lose(root: &Path, document: &Document) {
    let mut recovery = Recovery::start(root).expect("starts");
    assert_eq!(recovery.follow(document, false), None);
    drop(recovery);
}

#[test]
fn several_windows_do_not_take_each_others_work() {
    let folder = tempfile::tempdir().expect("a folder");
    let root = folder.path();
    let [mut one, mut two] = [Recovery::start(root).expect("starts"), Recovery::start(root).expect("starts")];
    one.follow(&changed("One"), false);
    two.follow(&changed("Two"), false);
    until("both are kept", || kept_with(root, "One") && kept_with(root, "Two"));
    assert!(one.lost().is_empty() && two.lost().is_empty(), "both live");
    drop(two);
    let found = one.lost();
    assert_eq!(found.len(), 1);
    assert!(one.lost().is_empty() && Recovery::start(root).expect("starts").lost().is_empty(), "it is offered once");
    // The user decides later: recovery offers the document again.
    drop(found);
    let mut third = Recovery::start(root).expect("starts");
    let lost = third.lost().pop().expect("it is there again");
    let Recovered { document, .. } = third.recover(lost).expect("it can be read");
    assert!(has(&document, "Two") && document.is_changed() && document.path().is_none());
    assert!(one.lost().is_empty(), "whoever has recovered it owns it");
    // If that process dies before any change, nothing is lost.
    drop(third);
    assert_eq!(one.lost().len(), 1);
    one.forget();
    drop(one);
    assert!(!kept_with(root, "One") && kept_with(root, "Two"));
}

#[test]
fn what_is_kept_goes_when_it_is_saved_or_given_up_and_at_no_other_time() {
    let folder = tempfile::tempdir().expect("a folder");
    let root = folder.path().join("recovery");
    let mut document = changed("Ball");
    let mut recovery = Recovery::start(&root).expect("starts");
    recovery.follow(&document, false);
    until("it is kept", || kept_with(&root, "Ball"));
    // After an undo: a redo may follow.
    document.undo();
    assert!(!document.is_changed());
    recovery.follow(&document, false);
    until("the state after undoing is kept", || !kept_with(&root, "Ball"));
    assert_eq!(kept(&root).len(), 1);
    document.redo();
    recovery.follow(&document, false);
    until("and the one after doing it again", || kept_with(&root, "Ball"));
    document.save_as(&folder.path().join("ball.json")).expect("saved");
    recovery.forget();
    until("what is saved goes", || names(&root).is_empty());
    // Recovery does not keep an unchanged document.
    recovery.follow(&document, false);
    drop(recovery);
    assert_eq!(names(&root), Vec::<String>::new());
    // Killed between the save and the cleanup: nothing is lost, so recovery offers nothing.
    add_group(&mut document, "Cube");
    lose(&root, &document);
    document.save().expect("saved");
    let recovery = Recovery::start(&root).expect("starts");
    assert!(recovery.lost().is_empty());
    assert_eq!(names(&root), Vec::<String>::new());
}

#[test]
fn a_snapshot_that_cannot_be_read_is_replaced_by_the_one_before() {
    let folder = tempfile::tempdir().expect("a folder");
    let root = folder.path();
    let mut document = changed("First");
    let mut recovery = Recovery::start(root).expect("starts");
    for name in ["Second", "Third", "Fourth"] {
        recovery.follow(&document, false);
        until(name, || kept(root).iter().any(|path| file::load(path).as_ref() == Ok(document.scene())));
        add_group(&mut document, name);
    }
    drop(recovery);
    let place = kept(root).remove(0);
    let recover = || {
        let mut recovery = Recovery::start(root).expect("starts");
        let lost = recovery.lost().pop().expect("offered");
        recovery.recover(lost).map_err(|failure| failure.error)
    };
    let Recovered { document: read, problem } = recover().expect("read");
    assert!(has(&read, "Third") && problem.is_none());
    fs::write(&place, "{").expect("written");
    let Recovered { document: read, problem } = recover().expect("the one before is read");
    assert!(has(&read, "Second") && !has(&read, "Third") && problem.is_some());
    fs::remove_file(&place).expect("removed");
    let Recovered { document: read, problem } = recover().expect("the one before is read");
    assert!(has(&read, "Second") && problem.is_none());
    for generation in [1, 2] {
        fs::write(file::backup_path(&place, generation), "no scene").expect("written");
    }
    let error = recover().expect_err("nothing is left");
    assert!(!error.reason.is_empty());
    // Another program may be able to read an unreadable file, so recovery does not remove it.
    assert_eq!(Recovery::start(root).expect("starts").lost().len(), 1);
}

#[test]
fn panics_keep_the_last_change_first() {
    let folder = tempfile::tempdir().expect("a folder");
    let root = folder.path();
    let mut document = changed("Before");
    let mut recovery = Recovery::start(root).expect("starts");
    let rescuer = recovery.rescuer();
    assert_eq!(rescuer.rescue("nothing was changed"), Rescued::Nothing);
    recovery.follow(&document, false);
    until("the first change is kept", || kept_with(root, "Before"));
    // The next write waits for a second.
    add_group(&mut document, "After");
    recovery.follow(&document, false);
    assert!(!kept_with(root, "After"), "too fast to test anything");
    let rescued = std::thread::scope(|scope| scope.spawn(|| rescuer.rescue("a worker failed (x.rs:7)")).join());
    assert_eq!(rescued.expect("ended"), Rescued::Kept);
    assert!(kept_with(root, "After"));
    assert_eq!(rescuer.rescue("again"), Rescued::Kept);
    let notes = recovery.take_notes();
    assert!(notes.contains(&Note::Panicked("a worker failed (x.rs:7)".into(), Rescued::Kept)), "{notes:?}");
}

#[test]
fn where_nothing_can_be_kept_the_artist_is_told_and_goes_on() {
    let folder = tempfile::tempdir().expect("a folder");
    let plain = folder.path().join("plain");
    fs::write(&plain, "not a folder").expect("written");
    for root in [plain.join("recovery"), PathBuf::from("/proc/recovery"), PathBuf::from("/dev/null/recovery")] {
        let mut recovery = Recovery::start(&root).expect("starts all the same");
        assert!(recovery.lost().is_empty());
        recovery.follow(&changed("Ball"), false);
        let notes = std::cell::RefCell::new(Vec::new());
        until("a note", || {
            notes.borrow_mut().extend(recovery.take_notes());
            !notes.borrow().is_empty()
        });
        assert!(matches!(&notes.borrow()[..], [Note::Failed(reason)] if !reason.is_empty()), "{notes:?}");
        let rescued = recovery.rescuer().rescue("and then it panics");
        assert!(matches!(rescued, Rescued::Failed(_)), "{rescued:?}");
    }
    let mut harness = editor(Document::new(Scene::new()), |editor| {
        editor.set_recovery(Recovery::start(&plain.join("recovery")).expect("starts"));
    });
    add_group(harness.state_mut().document_mut(), "Ball");
    harness.settle();
    let start = Instant::now();
    while harness.state().messages().next().is_none() && start.elapsed() < Duration::from_secs(20) {
        std::thread::sleep(Duration::from_millis(20));
        harness.step();
    }
    let message = harness.state().messages().next_back().expect("told");
    assert_eq!(message.severity, Severity::Error);
    assert!(message.text.contains("cannot be kept"), "{}", message.text);
}

/// The interface hands over a pointer. The next edit copies the node table, at most twice a second during a drag.
#[test]
fn keeping_never_blocks_the_interface() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut document = Document::new(crate::random_scene::random_scene(4, 10_000));
    let mut recovery = Recovery::start(folder.path()).expect("starts");
    let mut times = Vec::new();
    for number in 0..40 {
        add_group(&mut document, &format!("Group {number}"));
        let start = Instant::now();
        recovery.follow(&document, false);
        times.push(start.elapsed());
        std::thread::sleep(Duration::from_millis(20));
    }
    times.sort();
    let start = Instant::now();
    let json = file::to_json(document.scene()).expect("valid");
    file::replace(&folder.path().join("snapshot.json"), json.as_bytes(), 2).expect("written");
    let writing = start.elapsed();
    eprintln!("keeping 10 000 nodes: median {:?}, longest {:?}; writing them {writing:.2?}", times[20], times[39]);
    // Use a quantile instead of the maximum: other tests may keep the processors busy.
    assert!(times[35] < Duration::from_millis(2), "{times:?}");
    let mut snapshots = 0;
    let start = Instant::now();
    while start.elapsed() < Duration::from_millis(1_200) {
        add_group(&mut document, "Dragged");
        let before = recovery.follow(&document, true);
        snapshots += usize::from(before.is_none());
        std::thread::sleep(Duration::from_millis(5));
    }
    assert!((1..=3).contains(&snapshots), "{snapshots}");
}

#[test]
fn lost_work_is_offered_with_name_time_and_picture() {
    let folder = tempfile::tempdir().expect("a folder");
    let root = folder.path().join("recovery");
    let path = folder.path().join("pawn.json");
    let mut document = Document::new(Scene::new());
    document.save_as(&path).expect("saved");
    add_group(&mut document, "Pawn");
    let mut recovery = Recovery::start(&root).expect("starts");
    recovery.follow(&document, false);
    until("it is kept", || kept_with(&root, "Pawn"));
    let picture = Thumbnail::of([400, 300], |x, _| [x as u8, 0, 0]).expect("not empty");
    recovery.picture_taker()(picture.clone());
    drop(recovery);
    lose(&root, &changed("Bishop"));

    let start = |root: &Path| {
        let recovery = Recovery::start(root).expect("starts");
        editor(Document::new(Scene::new()), |editor| editor.set_recovery(recovery))
    };
    let found = Recovery::start(&root).expect("starts").lost();
    let about: Vec<_> = found.iter().map(|lost| (lost.name(), lost.picture(), lost.path())).collect();
    assert_eq!(about, [("Untitled", None, None), ("pawn.json", Some(&picture), Some(path.clone()))]);
    assert!(found[0].changed().elapsed().expect("in the past") < Duration::from_secs(60));
    drop(found);

    // The user decides later, by button and by key.
    let mut harness = start(&root);
    assert!(shows(&harness, "Recover unsaved work?") && shows(&harness, &path.display().to_string()));
    assert!(shows(&harness, "never saved") && harness.state().has_dialog());
    press(&mut harness, "Decide later");
    assert!(!harness.state().has_dialog());
    drop(harness);
    let mut harness = start(&root);
    harness.key_press(Key::Escape);
    harness.settle();
    assert!(!harness.state().has_dialog() && !harness.state().document().is_changed());
    drop(harness);

    // The chosen document opens, the other one stays.
    let mut harness = start(&root);
    press(&mut harness, "Recover pawn.json");
    let document = harness.state().document();
    assert!(has(document, "Pawn") && document.is_changed());
    assert_eq!((document.path(), document.title()), (Some(&*path), "pawn.json *".to_owned()));
    assert!(last_message(&harness).contains("1 more"), "{}", last_message(&harness));
    assert_eq!(kept(&root).len(), 2, "it is kept until it is saved");
    // The file is unchanged since it was read, so saving needs no question.
    harness.key_press_modifiers(egui::Modifiers::COMMAND, Key::S);
    harness.settle();
    assert!(!harness.state().document().is_changed() && !harness.state().has_dialog());
    until("what is saved goes", || kept(&root).len() == 1);
    drop(harness);

    // Two clicks discard it.
    let mut harness = start(&root);
    press(&mut harness, "Discard Untitled");
    assert_eq!(kept(&root).len(), 1, "one click could be a mistake");
    press(&mut harness, "Really discard Untitled");
    assert!(!harness.state().has_dialog());
    until("what is thrown away goes", || kept(&root).is_empty());
}

/// A recovered document asks before it replaces a file that changed since.
#[test]
fn a_recovered_document_asks_before_it_replaces_what_others_wrote() {
    let folder = tempfile::tempdir().expect("a folder");
    let root = folder.path().join("recovery");
    let path = folder.path().join("pawn.json");
    let mut document = Document::new(Scene::new());
    document.save_as(&path).expect("saved");
    add_group(&mut document, "Mine");
    lose(&root, &document);
    file::save(&plain_scene(5, 5), &path).expect("saved by somebody else");
    let recovery = Recovery::start(&root).expect("starts");
    let mut harness = editor(Document::new(Scene::new()), |editor| editor.set_recovery(recovery));
    harness.key_press(Key::Enter);
    harness.settle();
    assert!(has(harness.state().document(), "Mine"));
    harness.key_press_modifiers(egui::Modifiers::COMMAND, Key::S);
    harness.settle();
    assert!(shows(&harness, "“pawn.json” was changed by another program"));
    assert_eq!(file::load(&path), Ok(plain_scene(5, 5)));
    // The user would not confirm closing now: the unsaved document stays kept.
    harness.state_mut().end_recovery();
    drop(harness);
    assert!(kept_with(&root, "Mine"));
}

#[test]
fn a_window_that_is_closed_by_wish_keeps_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let root = folder.path();
    for agrees in [true, false] {
        let recovery = Recovery::start(root).expect("starts");
        let mut harness = editor(Document::new(Scene::new()), |editor| editor.set_recovery(recovery));
        add_group(harness.state_mut().document_mut(), "Ball");
        harness.settle();
        until("it is kept", || kept_with(root, "Ball"));
        if agrees {
            harness.key_press_modifiers(egui::Modifiers::COMMAND, Key::Q);
            harness.settle();
            press(&mut harness, "Discard");
            assert!(harness.state().wants_close());
        }
        harness.state_mut().end_recovery();
        drop(harness);
        assert_eq!(kept_with(root, "Ball"), !agrees);
    }
    assert!(editor(Document::new(Scene::new()), |_| ()).query_by_label("Recover unsaved work?").is_none());
}
