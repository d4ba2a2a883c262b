//! Saving: whatever fails, the previous file survives.

use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use isolith::document::{Document, Edit};
use isolith::scene::{Scene, file};

use crate::random_scene::{Random, random_scene};

/// Number of times the test kills a saver.
const KILLS: u64 = 500;
/// Environment variable that makes this test, started again as a process, save a file forever. Its value is the file.
const SAVER: &str = "ISOLITH_TEST_SAVER";
/// The file and its backups.
const KEPT: [&str; 4] = ["scene.json", "scene.json~", "scene.json~2~", "scene.json~3~"];

/// Savers record their temporaries here, and opening a scene looks for the records here.
fn keep_records() {
    file::keep_records_in(&Path::new(env!("CARGO_TARGET_TMPDIR")).join("temporaries"));
}

fn big_scenes() -> [Scene; 2] {
    [random_scene(1, 700), random_scene(2, 650)]
}

#[test]
fn killed_savers_lose_nothing() {
    keep_records();
    if let Some(path) = std::env::var_os(SAVER) {
        save_for_ever(Path::new(&path));
    }
    let work = |part: u64| {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("scene.json");
        let scenes = big_scenes();
        // Save often enough that all backups exist from the start.
        [1, 0, 1].iter().for_each(|i| file::save(&scenes[*i], &path).expect("the first saves"));
        let start = Instant::now();
        file::save(&scenes[0], &path).expect("one more save");
        let one_save = start.elapsed();
        let (mut left_over, mut second) = (0, 0);
        for kill in (part..KILLS).step_by(2) {
            kill_one(&path, kill, one_save);
            left_over += u64::from(names(folder.path()).len() > KEPT.len());
            let document = Document::open(&path).unwrap_or_else(|e| panic!("kill {kill}: {e}"));
            assert!(scenes.contains(document.scene()), "kill {kill}");
            second += u64::from(*document.scene() == scenes[1]);
            for backup in &KEPT[1..] {
                assert!(file::load(&folder.path().join(backup)).is_ok_and(|s| scenes.contains(&s)), "kill {kill}");
            }
            assert_eq!(names(folder.path()), KEPT, "kill {kill}");
        }
        (left_over, second)
    };
    let (a, b) = std::thread::scope(|scope| {
        let other = scope.spawn(|| work(0));
        (work(1), other.join().expect("the other half"))
    });
    let (left_over, second) = (a.0 + b.0, a.1 + b.1);
    eprintln!("{KILLS} kills, {left_over} of them inside a save");
    assert!(left_over > 0, "no kill ever hit a save");
    assert!(second > 0 && second < KILLS, "all kills left the same scene: {second}");
}

/// Starts a saver, lets it save up to three times and into part of the next save, and kills it. Counts saves rather
/// than time, because a slow disk takes longer for each.
fn kill_one(path: &Path, seed: u64, one_save: Duration) {
    let mut saver = Command::new(std::env::current_exe().expect("this program"))
        .args(["--exact", "saving::killed_savers_lose_nothing", "--nocapture"])
        .env(SAVER, path)
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .expect("the saver starts");
    let lines = BufReader::new(saver.stdout.take().expect("piped")).lines();
    let saves = seed as usize / 2 % 4;
    let said = lines.map_while(Result::ok).filter(|line| line.contains("saving")).take(1 + saves).count();
    assert_eq!(said, 1 + saves, "the saver says when it starts to save");
    std::thread::sleep(one_save.mul_f64(1.2 * Random::new(seed).unit()));
    saver.kill().expect("it runs until it is killed");
    saver.wait().expect("it has ended");
}

fn save_for_ever(path: &Path) -> ! {
    let scenes = big_scenes();
    for scene in scenes.iter().rev().cycle() {
        std::io::stdout().write_all(b"\nsaving\n").expect("someone listens");
        file::save(scene, path).expect("saving works");
    }
    unreachable!("the cycle has no end")
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("the folder is there");
    let mut names: Vec<String> =
        entries.map(|e| e.expect("readable").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

#[test]
fn saving_where_nothing_can_be_saved_says_why_and_stays_changed() {
    let folder = tempfile::tempdir().expect("a folder");
    let plain_file = folder.path().join("plain.txt");
    fs::write(&plain_file, "not a folder").expect("written");
    let read_only = folder.path().join("read_only.json");
    fs::write(&read_only, "keep me").expect("written");
    let mut permissions = fs::metadata(&read_only).expect("there").permissions();
    permissions.set_readonly(true);
    fs::set_permissions(&read_only, permissions).expect("set");
    let cases: Vec<(PathBuf, &str)> = vec![
        (folder.path().join("missing/scene.json"), "No such file"),
        (plain_file.join("scene.json"), "Not a directory"),
        (folder.path().to_path_buf(), "it is a folder"),
        (read_only.clone(), "it is read-only"),
        (folder.path().join("n".repeat(300)), "too long"),
        (PathBuf::from("/dev/null"), "it is not a file"),
        (PathBuf::from("/proc/scene.json"), "cannot be saved"),
        (PathBuf::from("/"), "it is a folder"),
        (PathBuf::new(), "cannot be saved"),
    ];
    let mut document = Document::new(random_scene(7, 5));
    let environment = isolith::scene::Environment::sky([0.5; 3], [0.25; 3], [0.25; 3]);
    document.apply(Edit::SetEnvironment(environment)).expect("valid");
    for (path, reason) in cases {
        let error = document.save_as(&path).expect_err("cannot work");
        assert_eq!(error.file, path.display().to_string());
        assert!(error.reason.contains(reason), "{reason}: {error}");
        assert!(document.is_changed() && document.path().is_none());
    }
    assert_eq!(fs::read_to_string(&read_only).expect("there"), "keep me");
    assert_eq!(names(folder.path()), ["plain.txt", "read_only.json"]);
}

/// Root may write everywhere except where the system itself forbids it.
#[cfg(unix)]
#[test]
fn a_read_only_folder_is_told_of_and_loses_nothing() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().expect("a folder");
    let mut document = Document::new(random_scene(7, 5));
    let path = folder.path().join("scene.json");
    document.save_as(&path).expect("saved");
    let environment = isolith::scene::Environment::sky([0.5; 3], [0.25; 3], [0.25; 3]);
    document.apply(Edit::SetEnvironment(environment)).expect("valid");
    let set_mode = |mode| fs::set_permissions(folder.path(), fs::Permissions::from_mode(mode)).expect("set");
    set_mode(0o555);
    let is_root = fs::write(folder.path().join("probe"), "").is_ok();
    let target = if is_root { PathBuf::from("/sys/kernel/scene.json") } else { path.clone() };
    let before = names(folder.path());
    let result = document.save_as(&target);
    let after = names(folder.path());
    set_mode(0o755);
    let error = result.expect_err("nothing can be made there");
    assert!(error.reason.contains("making a temporary file beside it"), "{error}");
    assert!(document.is_changed() && document.path() == Some(&path) && before == after);
    assert!(Document::open(&path).is_ok());
}

/// Starts a test again as a process in which no file may exceed 4 KiB: the system fails the write midway, as on a full
/// disk.
#[cfg(unix)]
#[test]
fn a_full_disk_loses_nothing() {
    const FOLDER: &str = "ISOLITH_TEST_FULL_DISK";
    if let Some(folder) = std::env::var_os(FOLDER) {
        return save_on_a_full_disk(Path::new(&folder));
    }
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("scene.json");
    file::save(&random_scene(1, 0), &path).expect("saved");
    file::save(&random_scene(2, 0), &path).expect("saved");
    let program = std::env::current_exe().expect("this program");
    let limited = "trap '' XFSZ; ulimit -f 8; exec \"$0\" --exact saving::a_full_disk_loses_nothing";
    let mut shell = Command::new("sh");
    shell.args(["-c", limited]).arg(program).env(FOLDER, folder.path());
    // The limit also holds for files that receive its output.
    let output = shell.output().expect("the shell starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stdout));
    // The folder holds exactly what the process saved.
    assert_eq!(file::load(&path), Ok(random_scene(3, 0)));
    assert_eq!(file::load(&folder.path().join("scene.json~")), Ok(random_scene(2, 0)));
    assert_eq!(names(folder.path()), ["scene.json", "scene.json~", "scene.json~2~"]);
}

#[cfg(unix)]
fn save_on_a_full_disk(folder: &Path) {
    let path = folder.join("scene.json");
    let [big, _] = big_scenes();
    let mut document = Document::recovered(big.clone(), Some(path.clone()), None);
    for _ in 0..5 {
        let error = document.save().expect_err("the scene is too large");
        assert!(error.reason.contains("writing the temporary file"), "{error}");
        assert!(error.reason.contains("too large"), "{error}");
        assert!(document.is_changed());
        assert_eq!(file::load(&path), Ok(random_scene(2, 0)));
        assert_eq!(names(folder), ["scene.json", "scene.json~"]);
    }
    file::save(&random_scene(3, 0), &path).expect("a small one fits");
}

#[test]
fn loading_what_is_not_there_or_no_file_says_why() {
    let folder = tempfile::tempdir().expect("a folder");
    let huge = folder.path().join("huge.json");
    let size = isolith::scene::limits::MAX_FILE_BYTES + 1;
    fs::File::create(&huge).and_then(|f| f.set_len(size)).expect("a sparse file");
    let cases = vec![
        (folder.path().join("gone.json"), "No such file"),
        (folder.path().to_path_buf(), "is not a file"),
        (PathBuf::from("/dev/zero"), "is not a file"),
        (huge, "is larger than 256 MiB"),
        // On Linux: a file that opens but cannot be read.
        #[cfg(target_os = "linux")]
        (PathBuf::from("/proc/self/mem"), "cannot be read: Input/output error"),
    ];
    for (path, reason) in cases {
        let error = Document::open(&path).expect_err("cannot work");
        assert_eq!(error.file, path.display().to_string());
        assert!(error.reason.contains(reason), "{reason}: {error}");
    }
}

#[test]
fn a_file_that_vanished_is_saved_anew() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("scene.json");
    let mut document = Document::new(random_scene(9, 9));
    document.save_as(&path).expect("saved");
    fs::remove_file(&path).expect("removed");
    document.save().expect("saved again");
    assert_eq!(file::load(&path).as_ref(), Ok(document.scene()));
    fs::remove_dir_all(folder.path()).expect("removed");
    let error = document.save().expect_err("the folder is gone");
    assert!(error.reason.contains("No such file"), "{error}");
}

#[cfg(unix)]
#[test]
fn links_are_written_through_and_permissions_stay() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let folder = tempfile::tempdir().expect("a folder");
    let [real, link, dangling] = ["real.json", "link.json", "dangling.json"].map(|n| folder.path().join(n));
    let [first, second] = big_scenes();
    file::save(&first, &real).expect("saved");
    fs::set_permissions(&real, fs::Permissions::from_mode(0o640)).expect("set");
    symlink("real.json", &link).expect("linked");
    file::save(&second, &link).expect("saved");
    assert!(fs::symlink_metadata(&link).expect("there").is_symlink());
    assert_eq!(file::load(&real), Ok(second.clone()));
    assert_eq!(fs::metadata(&real).expect("there").permissions().mode() & 0o777, 0o640);
    symlink("new.json", &dangling).expect("linked");
    file::save(&second, &dangling).expect("saved");
    assert_eq!(file::load(&folder.path().join("new.json")), Ok(second.clone()));
    let ring = folder.path().join("ring.json");
    symlink("ring.json", &ring).expect("linked");
    let error = file::save(&second, &ring).expect_err("a circle");
    assert!(error.reason.contains("circle"), "{error}");
}
