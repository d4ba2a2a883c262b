//! The reader opens no file outside the folder.

use std::fs;
use std::path::Path;

use isolith::mesh::{MeshLibrary, load};
use serde_json::json;

use super::tiny::triangle;

/// Writes a glTF whose buffer is at `uri`, a good buffer beside it, and one outside its folder.
fn folder_with(uri: &str) -> tempfile::TempDir {
    let outside = tempfile::tempdir().unwrap();
    let inside = outside.path().join("inside");
    fs::create_dir(&inside).unwrap();
    let mut tiny = triangle();
    for file in [outside.path().join("secret.bin"), inside.join("good buffer.bin")] {
        fs::write(file, &tiny.bytes).unwrap();
    }
    tiny.json["buffers"] = json!([{ "byteLength": tiny.bytes.len(), "uri": uri }]);
    fs::write(inside.join("model.gltf"), tiny.gltf()).unwrap();
    outside
}

fn refusal(uri: &str, change: impl Fn(&Path)) -> String {
    let outside = folder_with(uri);
    change(outside.path());
    let file = outside.path().join("inside/model.gltf");
    let error = load(&file).expect_err(uri);
    assert_eq!(error.place, "buffers[0].uri", "{error}");
    assert_eq!(error.file, file.display().to_string());
    let mut library = MeshLibrary::new(Some(outside.path().to_owned()));
    assert!(library.get("inside/model.gltf").is_err());
    error.reason
}

#[test]
fn a_buffer_beside_the_file_is_read() {
    for uri in ["good buffer.bin", "good%20buffer.bin", "./good%20buffer.bin"] {
        let outside = folder_with(uri);
        assert_eq!(load(&outside.path().join("inside/model.gltf")).unwrap().triangle_count(), 1);
        let mut library = MeshLibrary::new(Some(outside.path().to_owned()));
        assert_eq!(library.get("inside/model.gltf").unwrap().triangle_count(), 1);
    }
}

#[test]
fn paths_that_leave_the_folder_are_refused() {
    for (uri, reason) in [
        ("../secret.bin", ".."),
        ("%2e%2e/secret.bin", ".."),
        ("good/../../secret.bin", ".."),
        ("..\\secret.bin", "slashes"),
        ("/etc/hostname", "relative"),
        ("file:///etc/hostname", "plain relative"),
        ("http://localhost/x.bin", "plain relative"),
        ("C:/secret.bin", "plain relative"),
        ("", "no file"),
        ("no-such.bin", "is not there"),
        (".", "not a file"),
    ] {
        let have = refusal(uri, |_| ());
        assert!(have.contains(reason), "{uri}: {have}");
    }
}

#[cfg(unix)]
#[test]
fn links_that_leave_the_folder_are_refused() {
    use std::os::unix::fs::symlink;
    let file =
        refusal("link.bin", |outside| symlink(outside.join("secret.bin"), outside.join("inside/link.bin")).unwrap());
    assert!(file.contains("link"), "{file}");
    let folder = refusal("up/secret.bin", |outside| symlink(outside, outside.join("inside/up")).unwrap());
    assert!(folder.contains("link"), "{folder}");
    let round = refusal("round.bin", |outside| symlink("round.bin", outside.join("inside/round.bin")).unwrap());
    assert!(round.contains("cannot be opened"), "{round}");
}

#[cfg(unix)]
#[test]
fn the_library_stays_in_its_folder() {
    let outside = folder_with("good buffer.bin");
    let mut library = MeshLibrary::new(Some(outside.path().join("inside")));
    assert!(library.get("model.gltf").is_ok());
    std::os::unix::fs::symlink(outside.path(), outside.path().join("inside/up")).unwrap();
    for path in ["../inside/model.gltf", "up/inside/../secret.bin", "/etc/hostname", "up/secret.bin", ""] {
        let error = library.get(path).unwrap_err();
        assert_eq!(error.file, path);
    }
}

#[test]
fn pipes_and_folders_are_not_read() {
    let folder = tempfile::tempdir().unwrap();
    let error = load(folder.path()).unwrap_err();
    assert!(error.reason.contains("not a file"), "{error}");
}
