//! Jobs run beside the frames: they are visible, can be canceled, and cannot crash the editor.

use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use egui::{Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use isolith::document::{Document, Edit};
use isolith::editor::{Editor, Example};
use isolith::jobs::Task;
use isolith::scene::{Group, Node, NodeKind, Scene};

use super::{click, no_picture, pointer, press, scene};
use crate::settle::Settle;

/// The next step of a slow reader.
enum Order {
    Progress(f32),
    Reply(Box<Result<Document, String>>),
    Panic,
}

fn read(orders: &Mutex<Receiver<Order>>, task: &Task) -> Result<Document, String> {
    loop {
        match orders.lock().expect("nobody has panicked").recv() {
            Ok(Order::Progress(share)) => task.set_progress(share),
            Ok(Order::Reply(answer)) => return *answer,
            Ok(Order::Panic) => break,
            Err(_) => return Err("the test is over".into()),
        }
    }
    panic!("a broken reader")
}

/// An editor with the example "Slow", whose reader follows the test's orders.
fn with_slow_example() -> (Harness<'static, Editor>, Sender<Order>) {
    let (orders, received) = channel();
    let received = Mutex::new(received);
    let mut editor = Editor::new(Document::new(scene().0));
    editor.ask_for_paths_in_window();
    let open = Arc::new(move |task: &_| read(&received, task));
    editor.set_examples(vec![Example { name: "Slow".into(), is_test: false, open }]);
    let mut harness = Harness::builder()
        .with_size(egui::vec2(1280.0, 800.0))
        .with_context_setup(Editor::setup)
        .build_ui_state(|ui, editor: &mut Editor| editor.show(ui, &no_picture()), editor);
    harness.settle();
    (harness, orders)
}

/// Clicks File, Examples, Slow.
fn order_example(harness: &mut Harness<'_, Editor>) {
    for name in ["File", "Examples"] {
        let entry = harness.get_all_by_label(name).next().expect("a menu").rect().center();
        click(harness, entry);
        harness.run_steps(40);
    }
    let entry = harness.get_by_label("Slow").rect().center();
    pointer(harness, entry, true);
    pointer(harness, entry, false);
    harness.run_steps(6);
}

fn until(harness: &mut Harness<'_, Editor>, what: &str, is_true: impl Fn(&Harness<'_, Editor>) -> bool) {
    let started = Instant::now();
    while !is_true(harness) {
        assert!(started.elapsed() < Duration::from_secs(20), "{what}");
        std::thread::sleep(Duration::from_millis(1));
        harness.step();
    }
}

fn last(harness: &Harness<'_, Editor>) -> String {
    harness.state().messages().next_back().map_or(String::new(), |message| message.text.clone())
}

/// A scene of one group.
fn another() -> Document {
    let mut scene = Scene::new();
    scene.insert(None, 0, Node::new("Another", NodeKind::Group(Group::UNION))).expect("there is room");
    Document::new(scene)
}

fn is_another(harness: &Harness<'_, Editor>) -> bool {
    harness.state().document().scene().nodes()[0].name == "Another"
}

const OPENING: &str = "Opening Slow…";
const CANCEL: &str = "Cancel: Opening Slow";

#[test]
fn while_a_scene_opens_frames_go_on_and_the_old_one_stays_until_the_new_one_is_whole() {
    let (mut harness, orders) = with_slow_example();
    order_example(&mut harness);
    let old = harness.state().document().scene().clone();
    orders.send(Order::Progress(0.25)).expect("it listens");
    until(&mut harness, "no progress", |harness| {
        harness.state().jobs().foremost().is_some_and(|task| task.progress() == Some(0.25))
    });
    let started = Instant::now();
    harness.run_steps(30);
    assert!(started.elapsed() < Duration::from_secs(20), "the reader holds the frames up");
    assert!(harness.query_by_label(OPENING).is_some() && harness.query_by_label(CANCEL).is_some());
    assert_eq!(*harness.state().document().scene(), old);
    // The open scene stays usable meanwhile.
    harness.key_press(Key::Num1);
    harness.run_steps(3);
    assert!(harness.query_by_label(OPENING).is_some());
    orders.send(Order::Reply(Box::new(Ok(another())))).expect("it listens");
    harness.settle();
    assert!(is_another(&harness) && harness.query_by_label(OPENING).is_none());
    assert!(!harness.state().document().is_changed());
}

#[test]
fn canceling_leaves_the_old_scene_at_once() {
    for by_key in [false, true] {
        let (mut harness, orders) = with_slow_example();
        let old = harness.state().document().scene().clone();
        order_example(&mut harness);
        if by_key {
            harness.key_press(Key::Escape);
        } else {
            harness.get_by_label(CANCEL).click();
        }
        harness.run_steps(4);
        // The reader does not know about the cancel yet; nothing waits for it.
        assert!(harness.query_by_label(OPENING).is_none(), "by key: {by_key}");
        assert_eq!(last(&harness), "Opening Slow was canceled.");
        assert!(orders.send(Order::Reply(Box::new(Ok(another())))).is_ok(), "it reads on");
        harness.settle();
        assert_eq!(*harness.state().document().scene(), old);
        // No job runs: Escape has its normal meaning, and another scene can be opened.
        order_example(&mut harness);
        orders.send(Order::Reply(Box::new(Ok(another())))).expect("it listens");
        harness.settle();
        assert!(is_another(&harness));
    }
}

#[test]
fn a_reader_that_panics_or_refuses_is_a_message() {
    let (mut harness, orders) = with_slow_example();
    let old = harness.state().document().scene().clone();
    order_example(&mut harness);
    orders.send(Order::Reply(Box::new(Err("slow.json: nodes: must be a list".into())))).expect("it listens");
    harness.settle();
    assert_eq!(last(&harness), "slow.json: nodes: must be a list");
    order_example(&mut harness);
    orders.send(Order::Panic).expect("it listens");
    harness.settle();
    assert_eq!(last(&harness), "Slow cannot be opened: an internal error: a broken reader");
    assert_eq!(*harness.state().document().scene(), old);
    // The editor still works.
    harness.get_by_label("Add sphere").click();
    harness.settle();
    assert_eq!(harness.state().document().scene().nodes().len(), old.nodes().len() + 1);
}

#[test]
fn what_is_changed_while_a_scene_opens_is_asked_about() {
    let (mut harness, orders) = with_slow_example();
    order_example(&mut harness);
    harness.get_by_label("Add sphere").click();
    harness.run_steps(4);
    assert!(harness.state().document().is_changed(), "it can be edited meanwhile");
    orders.send(Order::Reply(Box::new(Ok(another())))).expect("it listens");
    harness.settle();
    assert!(harness.query_by_label("Discard").is_some() && !is_another(&harness));
    press(&mut harness, Modifiers::NONE, Key::Escape);
    assert!(!is_another(&harness), "and stays where that is not agreed to");
}

#[test]
fn what_is_opened_later_is_what_is_opened() {
    let (mut harness, orders) = with_slow_example();
    order_example(&mut harness);
    press_new(&mut harness);
    assert_eq!(harness.state().document().scene().nodes().len(), 1, "a new scene has a sun");
    orders.send(Order::Reply(Box::new(Ok(another())))).ok();
    harness.settle();
    assert!(!is_another(&harness), "nobody waits for it any more");
}

fn press_new(harness: &mut Harness<'_, Editor>) {
    harness.key_press_modifiers(Modifiers::COMMAND, Key::N);
    harness.run_steps(4);
}

#[test]
fn edits_made_while_a_document_is_saved_stay_changes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.json");
    let mut document = another();
    let add = |document: &mut Document, name: &str| {
        let node = Node::new(name, NodeKind::Group(Group::UNION));
        document.apply(Edit::Insert { parent: None, position: 0, node }).expect("there is room");
    };
    add(&mut document, "First");
    let order = document.save_order(&path);
    add(&mut document, "Second");
    let saved = order.write().unwrap();
    document.take_saved(saved);
    assert!(document.is_changed() && document.path() == Some(&*path));
    assert_eq!(Document::open(&path).unwrap().scene().nodes().len(), 2);
    document.undo();
    assert!(!document.is_changed(), "this is what was written");
    // A reader canceled before it starts.
    let task = Task::new("Opening");
    task.cancel();
    let error = Document::open_by(&path, &task).unwrap_err().to_string();
    assert!(error.contains("scene.json") && error.contains("was canceled"), "{error}");
    let task = Task::new("Opening");
    assert!(Document::open_by(&path, &task).is_ok());
    assert_eq!(task.progress(), Some(0.5), "what follows is to be prepared");
}
