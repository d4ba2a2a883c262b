//! Editors in processes of their own that are killed while they work.

use std::collections::BTreeMap;
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::{Mutex, mpsc};
use std::time::{Duration, Instant};

use isolith::document::recovery::{Note, Recovered, Recovery, Rescued};
use isolith::document::{Document, Edit};
use isolith::scene::{Node, file};

use super::{add_group, changed, editor, has, kept_with, names, plain_scene, until};

/// Largest loss, as time before the kill.
const MOST_LOST: Duration = Duration::from_secs(5);
/// Editors driven at the same time, each until it is killed.
const EDITORS: u64 = 8;
/// Environment variables that turn a test, started again as a process, into an editor: the recovery folder and its
/// file.
const EDITOR: [&str; 2] = ["ISOLITH_TEST_RECOVERY", "ISOLITH_TEST_SCENE"];

#[test]
fn killed_editors_lose_at_most_five_seconds() {
    if let Some(root) = std::env::var_os(EDITOR[0]) {
        edit_for_ever(Path::new(&root), Path::new(&std::env::var_os(EDITOR[1]).expect("given")));
    }
    let folder = tempfile::tempdir().expect("a folder");
    let root = folder.path().join("state/recovery");
    let one_at_a_time = Mutex::new(());
    let lost = std::thread::scope(|scope| {
        let all: Vec<_> = (0..EDITORS)
            .map(|number| {
                let path = folder.path().join(format!("scene {number}.json"));
                let (root, one_at_a_time) = (&root, &one_at_a_time);
                scope.spawn(move || kill_one(root, &path, number, one_at_a_time))
            })
            .collect();
        all.into_iter().map(|one| one.join().expect("recovered")).collect::<Vec<_>>()
    });
    eprintln!("{EDITORS} editors killed, lost: {lost:.2?}");
    assert!(lost.iter().all(|lost| *lost <= MOST_LOST), "{lost:?}");
    assert_eq!(names(&root), Vec::<String>::new(), "what is saved is not kept any longer");
}

/// Starts an editor, kills it after a while, and recovers its document. Returns how much is lost.
fn kill_one(root: &Path, path: &Path, number: u64, one_at_a_time: &Mutex<()>) -> Duration {
    file::save(&plain_scene(number, 300), path).expect("saved");
    let (mut editor, said) = start_editor(root, path);
    let mut ticks = BTreeMap::from([said.recv_timeout(Duration::from_secs(60)).expect("it starts to edit")]);
    std::thread::sleep(Duration::from_millis(1_500 + 700 * number));
    // Recovery must find the process that just died and none of the living ones.
    let guard = one_at_a_time.lock().expect("no other has failed");
    editor.kill().expect("it runs until it is killed");
    let killed = Instant::now();
    editor.wait().expect("it has ended");
    ticks.extend(said.try_iter());
    let mut recovery = Recovery::start(root).expect("starts");
    let mut found = recovery.lost();
    let described: Vec<_> = found.iter().map(|lost| (lost.name().to_owned(), lost.path())).collect();
    let name = path.file_name().expect("a name").to_string_lossy().into_owned();
    assert_eq!(described, [(name, Some(path.to_path_buf()))]);
    let Recovered { mut document, problem } = recovery.recover(found.remove(0)).expect("it can be read");
    drop(guard);
    assert!(document.is_changed() && problem.is_none());
    assert_eq!(document.path(), Some(path));
    let tick = |node: &std::sync::Arc<Node>| node.name.strip_prefix("tick ")?.parse::<u64>().ok();
    let last = document.scene().nodes().iter().find_map(tick).expect("one edit at least has been kept");
    document.save().expect("saved");
    recovery.forget();
    // The first edit that was not recovered.
    ticks.range(last + 1..).next().map_or(Duration::ZERO, |(_, at)| killed - *at)
}

/// Starts an editor in its own process. It reports the number of each edit; the receiver adds the time of arrival.
fn start_editor(root: &Path, path: &Path) -> (Child, mpsc::Receiver<(u64, Instant)>) {
    let mut child = Command::new(std::env::current_exe().expect("this program"))
        .args(["--exact", "cases::files::killed::killed_editors_lose_at_most_five_seconds", "--nocapture"])
        .env(EDITOR[0], root)
        .env(EDITOR[1], path)
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .expect("it starts");
    let lines = BufReader::new(child.stdout.take().expect("piped")).lines();
    let (sender, said) = mpsc::channel();
    std::thread::spawn(move || {
        let ticks = lines.map_while(Result::ok).filter_map(|line| line.strip_prefix("tick ")?.parse().ok());
        for tick in ticks {
            // The receiver is gone after the kill.
            let _ = sender.send((tick, Instant::now()));
        }
    });
    (child, said)
}

/// Edits like an artist, some with one click, some with drags of one second.
fn edit_for_ever(root: &Path, path: &Path) -> ! {
    let document = Document::open(path).expect("opens");
    let recovery = Recovery::start(root).expect("starts");
    let mut harness = editor(document, |editor| editor.set_recovery(recovery));
    add_group(harness.state_mut().document_mut(), "tick 0");
    let id = harness.state().document().scene().nodes()[0].id;
    for tick in 1_u64.. {
        let document = harness.state_mut().document_mut();
        match tick % 80 {
            40 => document.begin_gesture(),
            79 => document.end_gesture(),
            _ => {}
        }
        let node = document.scene().node(id).expect("is there");
        let node = Node { name: format!("tick {tick}"), ..Node::clone(node) };
        document.apply(Edit::Replace(node)).expect("valid");
        std::io::stdout().write_all(format!("\ntick {tick}\n").as_bytes()).expect("someone listens");
        harness.step();
        std::thread::sleep(Duration::from_millis(25));
    }
    unreachable!("the ticks have no end")
}

/// Started again as a process, this test makes two changes, the second of which is not written yet, panics on a thread,
/// and dies.
#[test]
fn a_panic_of_any_thread_is_told_of_and_loses_nothing() {
    if let Some(root) = std::env::var_os(EDITOR[0]) {
        panic_and_die(Path::new(&root));
    }
    let folder = tempfile::tempdir().expect("a folder");
    let output = Command::new(std::env::current_exe().expect("this program"))
        .args(["--exact", "cases::files::killed::a_panic_of_any_thread_is_told_of_and_loses_nothing", "--nocapture"])
        .env(EDITOR[0], folder.path())
        .output()
        .expect("it starts");
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(!output.status.success(), "{text}");
    assert!(text.contains("told: What was not saved has been kept"), "{text}");
    assert!(text.contains("noted: a worker failed (") && text.contains("killed.rs:"), "{text}");
    let mut recovery = Recovery::start(folder.path()).expect("starts");
    let lost = recovery.lost().pop().expect("it is offered");
    let Recovered { document, .. } = recovery.recover(lost).expect("it can be read");
    assert!(has(&document, "First") && has(&document, "Second"));
}

fn panic_and_die(root: &Path) -> ! {
    let say = |what: &str, text: &str| {
        std::io::stdout().write_all(format!("\n{what}: {text}\n").as_bytes()).expect("someone listens");
    };
    let mut document = changed("First");
    let mut recovery = Recovery::start(root).expect("starts");
    recovery.rescuer().rescue_at_panics(move |text| say("told", text));
    recovery.follow(&document, false);
    until("the first change is kept", || kept_with(root, "First"));
    add_group(&mut document, "Second");
    recovery.follow(&document, false);
    let failed = std::thread::spawn(|| panic!("a worker failed")).join();
    assert!(failed.is_err());
    for note in recovery.take_notes() {
        if let Note::Panicked(what, Rescued::Kept) = note {
            say("noted", &what);
        }
    }
    std::process::abort()
}
