//! The command line: adapters, standard input and output, exit codes.

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use isolith::scene::{MaterialId, MeshNode, Node, NodeKind, Object, Scene, Shape, file};
use serde_json::Value;

/// A ball, and with `with_model` a model whose file is missing.
fn scene(with_model: bool) -> Scene {
    let mut scene = Scene::new();
    let ball = NodeKind::Object(Object { shape: Shape::Sphere { radius: 0.5 }, material: MaterialId(1) });
    scene.insert(None, 0, Node::new("ball", ball)).expect("the scene has room");
    if with_model {
        let mesh = NodeKind::Mesh(MeshNode::new("no.glb"));
        scene.insert(None, 0, Node::new("statue", mesh)).expect("the scene has room");
    }
    scene
}

/// A folder with `scene.json` and `warned.json`, a scene with a warning.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder for the test");
    for (name, with_model) in [("scene.json", false), ("warned.json", true)] {
        let text = file::to_json(&scene(with_model)).expect("a sound scene");
        std::fs::write(folder.path().join(name), text).expect("it can be written");
    }
    std::fs::write(folder.path().join("broken.json"), "{\"isolith\": 1").expect("it can be written");
    folder
}

fn program(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_isolith"));
    command.current_dir(folder).args(arguments).env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY");
    command.env_remove("WGPU_ADAPTER_NAME").env("XDG_RUNTIME_DIR", folder).stdin(Stdio::null());
    command
}

fn run(folder: &Path, arguments: &[&str]) -> Output {
    program(folder, arguments).output().expect("the program starts")
}

/// Runs the program with a file as standard input.
fn run_with(folder: &Path, arguments: &[&str], input: &str) -> Output {
    let input = std::fs::File::open(folder.join(input)).expect("the input is there");
    program(folder, arguments).stdin(input).output().expect("the program starts")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("text")
}

/// Asserts that the program exited with `code` and one line on standard error that contains `parts`.
fn assert_fails(output: &Output, code: i32, parts: &[&str]) {
    let error = text(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{error}");
    assert_eq!(error.lines().count(), 1, "{error}");
    for part in parts {
        assert!(error.contains(part), "`{part}` is not in: {error}");
    }
}

/// One JSON object per line.
fn objects(output: &Output) -> Vec<Value> {
    text(&output.stdout).lines().map(|line| serde_json::from_str(line).expect("an object")).collect()
}

#[test]
fn adapters_are_listed_and_chosen_by_part_of_their_name() {
    let place = folder();
    let listed = run(place.path(), &["adapters", "--json"]);
    let all = objects(&listed).remove(0);
    let name = all[0]["name"].as_str().expect("a name").to_owned();
    assert!(text(&run(place.path(), &["adapters"]).stdout).contains(&name));
    let part = name.split([' ', '(']).next().expect("a word").to_uppercase();
    let drawn = run(place.path(), &["render", "scene.json", "-o", "x.png", "--size", "16x16", "--adapter", &part]);
    assert!(drawn.status.success(), "{}", text(&drawn.stderr));
}

#[test]
fn an_adapter_that_is_not_there_is_one_line_with_those_that_are() {
    let place = folder();
    let render = ["render", "scene.json", "-o", "x.png", "--size", "16x16"];
    assert_fails(&run(place.path(), &[&render[..], &["--adapter", "Voodoo 9"]].concat()), 2, &["Voodoo 9", "there is"]);
    let by_environment = program(place.path(), &render).env("WGPU_ADAPTER_NAME", "Voodoo 9").output();
    assert_fails(&by_environment.expect("the program starts"), 2, &["Voodoo 9", "there is"]);
    assert!(!place.path().join("x.png").exists());
}

#[test]
#[cfg(target_os = "linux")]
fn without_a_driver_there_is_one_line_and_exit_code_4() {
    let place = folder();
    for arguments in [&["render", "scene.json", "-o", "x.png"][..], &["adapters"], &["bench", "scene.json"]] {
        let mut command = program(place.path(), arguments);
        let output = command.env("VK_DRIVER_FILES", "/nonexistent").output().expect("the program starts");
        assert_fails(&output, 4, &["mesa-vulkan-drivers"]);
    }
}

#[test]
#[cfg(target_os = "linux")]
fn quiet_is_quiet_without_a_runtime_folder() {
    let place = folder();
    for value in [None, Some("")] {
        let mut command = program(place.path(), &["render", "scene.json", "-o", "x.png", "--size", "16x16", "--quiet"]);
        match value {
            None => command.env_remove("XDG_RUNTIME_DIR"),
            Some(value) => command.env("XDG_RUNTIME_DIR", value),
        };
        let output = command.env("TMPDIR", place.path()).output().expect("the program starts");
        assert!(output.status.success());
        assert_eq!((text(&output.stdout), text(&output.stderr)), (String::new(), String::new()));
    }
}

#[test]
fn scenes_come_from_standard_input_and_pictures_go_to_standard_output() {
    let place = folder();
    let size = ["--size", "24x16"];
    let written = run(place.path(), &[&["render", "scene.json", "-o", "x.png"][..], &size].concat());
    assert!(written.status.success());
    let piped = run_with(place.path(), &[&["render", "-", "-o", "-"][..], &size].concat(), "scene.json");
    assert!(piped.status.success(), "{}", text(&piped.stderr));
    assert_eq!(piped.stdout, std::fs::read(place.path().join("x.png")).expect("written"));
    let checked = run_with(place.path(), &["check", "-", "--json"], "scene.json");
    let found = objects(&checked).remove(0);
    assert_eq!((&found["ok"], &found["file"]), (&true.into(), &"standard input".into()));
    assert_fails(&run_with(place.path(), &["check", "-"], "broken.json"), 3, &["standard input"]);
    assert_fails(&run(place.path(), &["render", "scene.json", "-o", "-", "--json"]), 2, &["not both"]);
}

#[test]
fn several_scenes_are_all_checked() {
    let place = folder();
    let output = run(place.path(), &["check", "--json", "scene.json", "broken.json", "none.json", "warned.json"]);
    assert_eq!(output.status.code(), Some(3));
    let all = objects(&output);
    let of = |key: &str| all.iter().map(|o| o[key].clone()).collect::<Vec<_>>();
    assert_eq!(of("ok"), [true, false, false, true].map(Value::from));
    assert_eq!(of("file"), ["scene.json", "broken.json", "none.json", "warned.json"].map(Value::from));
    assert!(text(&output.stderr).contains("2 of 4 scenes"), "{}", text(&output.stderr));
    assert!(run(place.path(), &["check", "scene.json", "warned.json"]).status.success());
    assert_eq!(run(place.path(), &["check"]).status.code(), Some(2));
}

#[test]
fn strict_makes_warnings_errors() {
    let place = folder();
    assert!(run(place.path(), &["check", "warned.json"]).status.success());
    assert_fails(&run(place.path(), &["check", "warned.json", "--strict"]), 3, &["warned.json", "--strict"]);
    let report = run(place.path(), &["check", "warned.json", "--strict", "--json"]);
    assert_eq!(objects(&report)[0]["ok"], false);
    let render = ["render", "warned.json", "-o", "x.png", "--size", "16x16"];
    let strict = run(place.path(), &[&render[..], &["--strict"]].concat());
    assert_eq!(strict.status.code(), Some(3), "{}", text(&strict.stderr));
    assert!(!place.path().join("x.png").exists(), "a picture was written all the same");
    assert!(run(place.path(), &render).status.success());
    assert!(run(place.path(), &["check", "scene.json", "--strict"]).status.success());
}

#[test]
fn a_render_tells_what_it_did_as_one_object() {
    let place = folder();
    let render = ["render", "warned.json", "-o", "x.png", "--size", "24x16", "--depth", "d.exr", "--json"];
    let output = run(place.path(), &render);
    assert!(output.status.success() && output.stderr.is_empty(), "{}", text(&output.stderr));
    let object = objects(&output).remove(0);
    assert_eq!((&object["ok"], &object["width"], &object["height"]), (&true.into(), &24.into(), &16.into()));
    let quantities = object["outputs"].as_array().expect("a list").iter().map(|o| o["quantity"].clone());
    assert_eq!(quantities.collect::<Vec<_>>(), ["output", "depth"].map(Value::from));
    assert_eq!(object["warnings"].as_array().map(Vec::len), Some(1));
    let failed = run(place.path(), &["render", "none.json", "-o", "x.png", "--json"]);
    assert_eq!(failed.status.code(), Some(3));
    let object = objects(&failed).remove(0);
    assert_eq!((&object["ok"], &object["file"]), (&false.into(), &"none.json".into()));
}

#[test]
fn a_check_says_whether_it_is_fine_what_limits_are_used_and_which_cameras_there_are() {
    let place = folder();
    let report = objects(&run(place.path(), &["check", "scene.json", "--json"])).remove(0);
    for key in ["ok", "file", "limits", "cameras", "nodes", "components", "tree_depth", "warnings"] {
        assert!(!report[key].is_null(), "{key} is missing: {report}");
    }
    let nodes = report["limits"].as_array().expect("a list").iter().find(|l| l["name"] == "nodes").expect("nodes");
    assert_eq!((&nodes["used"], &nodes["limit"]), (&1.into(), &100_000.into()));
}

#[test]
fn a_word_that_is_neither_command_nor_file_is_not_a_scene() {
    let place = folder();
    for word in ["adaptors", "rendr", "-"] {
        assert_fails(&run(place.path(), &[word]), 2, &[word, "neither a file nor a command", "adapters"]);
    }
    assert!(!place.path().join("adaptors.png").exists());
    assert_fails(&run(place.path(), &["scen.json"]), 3, &["scen.json"]);
}

#[test]
fn names_from_files_do_not_control_the_terminal() {
    let place = folder();
    let mut scene = scene(true);
    // The reader of the file refuses control characters; a character that changes the text direction is an ordinary
    // letter.
    let evil = "\u{202e}gnp.elcnu";
    let statue = scene.nodes().iter().find(|node| node.name == "statue").expect("the model");
    let renamed = Node { name: evil.into(), ..(**statue).clone() };
    scene.replace(renamed).expect("a node of the scene");
    std::fs::write(place.path().join("evil.json"), file::to_json(&scene).expect("sound")).expect("written");
    let models = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/cases/hostile/mesh");
    for (folder, name) in [(place.path(), "evil.json"), (&models, "escape.json")] {
        let picture = place.path().join("x.png");
        let picture = picture.to_str().expect("text");
        for arguments in
            [&["check", name][..], &["check", name, "--json"], &["render", name, "-o", picture, "--size", "8x8"]]
        {
            let output = run(folder, arguments);
            for stream in [output.stdout, output.stderr].map(|bytes| text(&bytes)) {
                let harmful = stream.chars().find(|c| c.is_control() && *c != '\n' || *c == '\u{202e}');
                assert_eq!(harmful, None, "{arguments:?}: {stream}");
                assert!(stream.lines().all(|line| line.chars().count() <= 2_100), "{arguments:?}");
            }
        }
    }
}

#[test]
fn ids_beyond_16_million_are_written_exactly() {
    use exr::prelude::{FlatSamples, read_all_flat_layers_from_file};
    let place = folder();
    let large = (1u64 << 24) + 1;
    let json = file::to_json(&scene(false)).expect("sound");
    let mut value: Value = serde_json::from_str(&json).expect("JSON");
    value["nodes"][0]["id"] = large.into();
    value["next_id"] = (large + 1).into();
    std::fs::write(place.path().join("large.json"), value.to_string()).expect("written");
    let render = ["render", "large.json", "-o", "x.png", "--size", "16x16", "--node-id", "id.exr"];
    let output = run(place.path(), &render);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let image = read_all_flat_layers_from_file(place.path().join("id.exr")).expect("an EXR");
    let channel = &image.layer_data[0].channel_data.list[0];
    let FlatSamples::U32(ids) = &channel.sample_data else { panic!("not whole numbers") };
    assert_eq!((channel.name.to_string().as_str(), ids[8 * 16 + 8], ids[0]), ("id", large as u32, 0));
}
