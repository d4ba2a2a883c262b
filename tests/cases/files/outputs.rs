//! `isolith render` writes the requested files to the requested places, and nothing else.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use image::GenericImageView;

use super::names;

/// A folder with the ball in `ball.json`, and a folder for the program's state.
struct Place {
    folder: tempfile::TempDir,
    state: tempfile::TempDir,
}

impl Place {
    fn new() -> Self {
        let place =
            Self { folder: tempfile::tempdir().expect("a folder"), state: tempfile::tempdir().expect("a folder") };
        let ball = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases/outputs/ball.json");
        fs::copy(ball, place.at("ball.json")).expect("copied");
        place
    }

    fn at(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn run(&self, arguments: &[&str]) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_isolith"));
        command.current_dir(self.folder.path()).args(arguments);
        command.env("XDG_STATE_HOME", self.state.path()).env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY");
        command.output().expect("the program starts")
    }

    /// Renders with the reference renderer, which needs no driver.
    fn render(&self, outputs: &[&str]) -> Output {
        self.run(&[&["render", "ball.json", "--reference", "--size", "16x12", "--quiet"], outputs].concat())
    }

    fn rendered(&self, outputs: &[&str]) {
        let output = self.render(outputs);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        // No temporary remains, and no record of one.
        assert!(names(self.folder.path()).iter().all(|name| !name.starts_with('.')), "{:?}", names(self.folder.path()));
        let records = self.state.path().join("isolith/temporaries");
        assert_eq!(names(&records), Vec::<String>::new());
    }

    fn refused(&self, outputs: &[&str], part: &str) {
        let before = names(self.folder.path());
        let output = self.render(outputs);
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(5), "{outputs:?}: {text}");
        assert!(text.contains(part), "{part}: {text}");
        assert_eq!(names(self.folder.path()), before, "{outputs:?}");
    }
}

fn size(path: &Path) -> (u32, u32) {
    image::open(path).expect("a picture").dimensions()
}

#[cfg(unix)]
#[test]
fn a_link_is_written_through_and_the_file_keeps_its_mode() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let mode = |path: &Path| fs::metadata(path).expect("there").permissions().mode() & 0o777;
    let place = Place::new();
    fs::create_dir(place.at("deep")).expect("made");
    fs::write(place.at("deep/real.png"), "old").expect("written");
    fs::set_permissions(place.at("deep/real.png"), fs::Permissions::from_mode(0o604)).expect("set");
    symlink("deep/real.png", place.at("link.png")).expect("linked");
    symlink("link.png", place.at("chain.png")).expect("linked");
    symlink("deep/new.exr", place.at("dangling.exr")).expect("linked");
    place.rendered(&["-o", "chain.png", "--depth", "dangling.exr"]);
    assert!(["link.png", "chain.png", "dangling.exr"].iter().all(|name| place.at(name).is_symlink()));
    assert_eq!((size(&place.at("deep/real.png")), size(&place.at("deep/new.exr"))), ((16, 12), (16, 12)));
    assert_eq!(mode(&place.at("deep/real.png")), 0o604);
    // A new file gets its mode from the user's mask.
    place.rendered(&["-o", "plain.png"]);
    fs::write(place.at("by hand"), "").expect("written");
    assert_eq!(mode(&place.at("plain.png")), mode(&place.at("by hand")));
}

#[test]
fn names_may_be_as_long_as_the_system_allows() {
    let place = Place::new();
    for length in [100, 245, 255] {
        let name = "n".repeat(length - 4) + ".png";
        place.rendered(&["-o", &name]);
        assert_eq!(size(&place.at(&name)), (16, 12), "{length}");
    }
    place.refused(&["-o", &("n".repeat(252) + ".png")], "too long");
}

#[test]
fn two_outputs_of_one_name_are_refused() {
    let place = Place::new();
    let absolute = place.at("x.png").display().to_string();
    for second in ["x.png", "./x.png", &absolute] {
        place.refused(&["-o", "x.png", "--depth", second], "the same file as x.png");
    }
    place.refused(&["-o", "x.png", "--depth", "y.exr", "--normal", "y.exr"], "the same file as y.exr");
    place.refused(&["-o", "x.png", "--depth", "y.exr", "--node-id", "./y.exr"], "another output");
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("x.png", place.at("link.png")).expect("linked");
        std::os::unix::fs::symlink(".", place.at("here")).expect("linked");
        for second in ["link.png", "here/x.png", "here/link.png"] {
            place.refused(&["-o", "x.png", "--depth", second], "another output");
        }
        fs::write(place.at("x.png"), "there already").expect("written");
        place.refused(&["-o", "link.png", "--depth", "x.png"], "another output");
        assert_eq!(fs::read(place.at("x.png")).expect("there"), b"there already");
    }
    place.rendered(&["-o", "x.png", "--depth", "x.exr", "--normal", "y.png"]);
}

#[cfg(unix)]
#[test]
fn the_scene_is_never_an_output() {
    let place = Place::new();
    let scene = fs::read(place.at("ball.json")).expect("there");
    std::os::unix::fs::symlink("ball.json", place.at("ball.png")).expect("linked");
    place.refused(&["-o", "ball.png"], "which is read");
    place.refused(&["-o", "x.png", "--depth", "ball.png"], "which is read");
    assert_eq!(fs::read(place.at("ball.json")).expect("there"), scene);
}

#[test]
fn two_charts_of_one_name_are_refused() {
    let place = Place::new();
    fs::create_dir(place.at("other")).expect("made");
    fs::copy(place.at("ball.json"), place.at("other/ball.json")).expect("copied");
    let output = place.run(&["bench", "ball.json", "other/ball.json", "--size", "16", "-o", "report"]);
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{text}");
    assert!(text.contains("two scenes are called ball"), "{text}");
}

/// Links planted under names that were guessable in the past: their targets stay unchanged.
#[cfg(unix)]
#[test]
fn links_planted_beside_an_output_empty_no_file() {
    let place = Place::new();
    let precious = place.at("precious");
    fs::write(&precious, "keep me").expect("written");
    let next = std::process::id();
    let planted = |name: String| std::os::unix::fs::symlink(&precious, place.at(&name)).expect("linked");
    // The next process ids, including a wrap of the counter.
    let processes: Vec<u32> = (next..next + 1_500).chain(2..300).collect();
    for process in &processes {
        planted(format!(".x.png.tmp-{process}"));
    }
    let output = place.render(&["-o", "x.png"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(fs::read_to_string(&precious).expect("there"), "keep me");
    assert_eq!(names(place.folder.path()).iter().filter(|name| name.starts_with('.')).count(), processes.len());
}

#[test]
fn whoever_opens_a_scene_deletes_nothing_beside_it() {
    let place = Place::new();
    let others = [
        ".ball.json.tmp-4000000000-0".to_owned(),
        ".ball.json.tmp-1".to_owned(),
        format!(".isolith-{}.tmp", "0".repeat(32)),
        format!(".isolith-{}.tmp", isolith::scene::file::random_name()),
    ];
    others.iter().for_each(|name| fs::write(place.at(name), "not yours").expect("written"));
    let before = names(place.folder.path());
    isolith::document::Document::open(&place.at("ball.json")).expect("opens");
    assert!(place.run(&["check", "ball.json"]).status.success());
    assert_eq!(names(place.folder.path()), before);
    assert!(place.render(&["-o", "x.png"]).status.success());
    assert_eq!(names(place.folder.path()).len(), before.len() + 1);
}

/// A failed write leaves the previous picture.
#[cfg(unix)]
#[test]
fn a_full_disk_leaves_the_old_picture() {
    let place = Place::new();
    place.rendered(&["-o", "x.png"]);
    let old = fs::read(place.at("x.png")).expect("there");
    // No file may grow beyond zero bytes; an ignored signal becomes an error.
    let limited = format!(
        "trap '' XFSZ; ulimit -f 0; exec '{}' render ball.json --reference --size 64x48 --quiet -o x.png",
        env!("CARGO_BIN_EXE_isolith")
    );
    let mut command = Command::new("sh");
    command.current_dir(place.folder.path()).args(["-c", &limited]).env("XDG_STATE_HOME", place.state.path());
    let output = command.output().expect("the shell starts");
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(5), "{text}");
    assert!(text.contains("x.png") && text.contains("writing the temporary file: File too large"), "{text}");
    assert_eq!(fs::read(place.at("x.png")).expect("there"), old);
    assert_eq!(names(place.folder.path()), ["ball.json", "x.png"]);
}
