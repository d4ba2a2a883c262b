//! The program from outside: every command and exit code, its files and its messages.

mod frames;
mod light;
mod passes;
mod shading;

use std::path::{Path, PathBuf};

use assert_cmd::Command;
use glam::DVec3;
use image::GenericImageView;
use isolith::geometry::Camera;
use isolith::scene::{CameraNode, Group, MaterialId, MeshNode, Node, NodeKind, Object, ParamPath, Scene, Shape, file};
use serde_json::Value;

/// A floor (1) and a ball (2), a group (3) with two cameras.
fn sample() -> Scene {
    let mut scene = Scene::new();
    let object = |shape| NodeKind::Object(Object { shape, material: MaterialId(1) });
    let mut add = |parent, node: Node| scene.insert(parent, usize::MAX, node).expect("the scene has room");
    add(None, Node::new("floor", object(Shape::Plane {})).at(DVec3::new(0.0, -0.6, 0.0)));
    add(None, Node::new("ball", object(Shape::Sphere { radius: 0.5 })));
    let rig = add(None, Node::new("rig", NodeKind::Group(Group::UNION)));
    let lens = CameraNode { fov_y: 40.0, near: 0.01, far: 20.0, ..CameraNode::default() };
    for (name, eye) in [("front", DVec3::new(0.0, 0.0, 4.0)), ("above", DVec3::new(0.0, 4.0, 0.1))] {
        let pose = Camera::looking_at(eye, DVec3::ZERO, 1.0);
        add(Some(rig), Node::new(name, NodeKind::Camera(lens)).at(eye).rotated(pose.rotation));
    }
    scene
}

/// A folder with the scene in it as `scene.json`.
struct Place {
    folder: tempfile::TempDir,
}

/// The result of a run.
struct Outcome {
    code: i32,
    out: String,
    err: String,
}

impl Place {
    fn new() -> Self {
        let folder = tempfile::tempdir().expect("a folder for the test");
        let place = Self { folder };
        place.write("scene.json", &sample());
        place
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn write(&self, name: &str, scene: &Scene) {
        std::fs::write(self.path(name), file::to_json(scene).expect("a sound scene")).expect("it can be written");
    }

    /// Writes the scene with a radius outside its limits.
    fn write_broken(&self, name: &str) {
        let text = file::to_json(&sample()).expect("a sound scene");
        let broken = text.replace("\"radius\": 0.5", "\"radius\": -0.5");
        assert_ne!(text, broken, "the sample has changed");
        std::fs::write(self.path(name), broken).expect("it can be written");
    }

    fn names(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.folder.path()).expect("the folder can be read");
        let mut names: Vec<_> =
            entries.map(|e| e.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    /// The program, to be run in this folder without a display.
    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_isolith"));
        command.current_dir(self.folder.path()).args(arguments).env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY");
        command.env("XDG_RUNTIME_DIR", self.folder.path());
        command
    }

    fn run(&self, arguments: &[&str]) -> Outcome {
        let output = self.command(arguments).output().expect("the program starts");
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        let code = output.status.code().expect("it was not killed");
        Outcome { code, out: text(&output.stdout), err: text(&output.stderr) }
    }
}

impl Outcome {
    /// Asserts that the run failed with this code and an error that contains each of `parts`.
    fn failed(&self, code: i32, parts: &[&str]) -> &Self {
        assert_eq!(self.code, code, "{}", self.err);
        assert!(self.err.contains("error: "), "{}", self.err);
        for part in parts {
            assert!(self.err.contains(part), "`{part}` is not in: {}", self.err);
        }
        self
    }

    fn succeeded(&self) -> &Self {
        assert_eq!(self.code, 0, "{}", self.err);
        self
    }

    fn object(&self) -> Value {
        let value: Value = serde_json::from_str(&self.out).expect("standard output is one JSON value");
        assert!(value.is_object());
        value
    }
}

fn keys(value: &Value) -> Vec<&str> {
    value.as_object().expect("an object").keys().map(String::as_str).collect()
}

/// The ids of an EXR file.
fn ids(path: &Path) -> Vec<u32> {
    let image = exr::prelude::read_all_flat_layers_from_file(path).expect("an EXR file");
    match &image.layer_data[0].channel_data.list[0].sample_data {
        exr::prelude::FlatSamples::U32(ids) => ids.clone(),
        other => panic!("not whole numbers: {other:?}"),
    }
}

fn open(path: &Path) -> image::DynamicImage {
    image::open(path).expect("a picture")
}

#[test]
fn help_lists_the_commands_and_the_exit_codes() {
    let place = Place::new();
    let help = place.run(&["--help"]);
    for part in ["render", "check", "schema", "Exit codes", "130"] {
        assert!(help.succeeded().out.contains(part), "{part}");
    }
    assert!(place.run(&["--version"]).succeeded().out.starts_with("isolith "));
    let readme = include_str!("../src/cli/README.md");
    for code in ["| 0 |", "| 1 |", "| 2 |", "| 3 |", "| 4 |", "| 5 |", "| 130 |"] {
        assert!(readme.contains(code), "the page of the command line does not explain {code}");
    }
}

#[test]
fn what_is_not_understood_is_refused_with_a_reason() {
    let place = Place::new();
    place.run(&["render", "scene.json"]).failed(2, &["--output"]);
    place.run(&["paint", "scene.json"]).failed(2, &[]);
    for (flag, value, reason) in [
        ("--size", "640", "like 1280x720"),
        ("--size", "0x20", "like 1280x720"),
        ("--size", "16384x16384", "pixels"),
        ("--time", "nan", "finite"),
        ("--depth", "depth.jpg", ".exr or .png"),
        ("-o", "picture.bmp", ".png"),
        ("--samples", "0", "1..=4096"),
        ("--exposure", "99", "-20 to 20"),
        ("--view-transform", "filmic", "none, agx, pbr_neutral"),
        ("--view", "heat", "shaded, steps, evaluations"),
        ("--shading", "matcap", "solid, porcelain, bronze, wax, material, rendered"),
    ] {
        let mut arguments = vec!["render", "scene.json", flag, value];
        if flag != "-o" {
            arguments.extend(["-o", "x.png"]);
        }
        place.run(&arguments).failed(2, &[value, reason]);
    }
    assert_eq!(place.names(), ["scene.json"]);
}

#[test]
fn a_picture_has_the_size_asked_for_and_shows_the_scene() {
    let place = Place::new();
    let done = place.run(&["render", "scene.json", "-o", "out.png", "--size", "48x32"]);
    assert!(done.succeeded().out.contains("wrote out.png"), "{}", done.out);
    let picture = open(&place.path("out.png"));
    assert_eq!(picture.dimensions(), (48, 32));
    assert_ne!(picture.get_pixel(24, 16), picture.get_pixel(1, 1), "the ball looks like the background");
    assert_eq!(place.names(), ["out.png", "scene.json"], "something was left behind");
}

#[test]
fn quiet_is_quiet_and_overwrites() {
    let place = Place::new();
    std::fs::write(place.path("out.png"), "old").expect("written");
    let done = place.run(&["render", "scene.json", "-o", "out.png", "--size", "16x16", "--quiet"]);
    assert_eq!((done.succeeded().out.as_str(), done.err.as_str()), ("", ""));
    assert_eq!(open(&place.path("out.png")).dimensions(), (16, 16));
}

#[test]
fn numbers_are_written_as_numbers_and_the_reference_agrees() {
    let place = Place::new();
    let mut depths = Vec::new();
    for reference in [false, true] {
        let mut arguments = vec!["render", "scene.json", "-o", "out.png", "--size", "24x16"];
        arguments.extend(["--depth", "depth.exr", "--normal", "normal.exr", "--node-id", "id.exr"]);
        if reference {
            arguments.push("--reference");
        }
        place.run(&arguments).succeeded();
        let [depth, normal] = ["depth", "normal"].map(|name| open(&place.path(&format!("{name}.exr"))).into_rgb32f());
        let ids = ids(&place.path("id.exr"));
        let center = depth.get_pixel(12, 8)[0];
        assert!((center - 3.5).abs() < 0.1, "the ball is {center} m away");
        assert!(depth.get_pixel(12, 0)[0].is_infinite(), "the background has a depth");
        assert!(normal.get_pixel(12, 8)[2] > 0.9, "the ball does not face the camera");
        assert_eq!((ids[8 * 24 + 12], ids[12]), (2, 0));
        assert_eq!(ids[15 * 24 + 12], 1, "the floor has another id");
        depths.push(center);
    }
    assert!((depths[0] - depths[1]).abs() < 1e-4, "{depths:?}");
}

#[test]
fn pictures_of_numbers_can_be_looked_at() {
    let place = Place::new();
    let mut arguments = vec!["render", "scene.json", "-o", "out.png", "--size", "24x16"];
    arguments.extend(["--depth", "depth.png", "--normal", "normal.png", "--node-id", "id.png"]);
    let done = place.run(&arguments);
    assert!(done.succeeded().out.contains("wrote depth.png (white "), "the range is not stated: {}", done.out);
    let depth = open(&place.path("depth.png")).into_luma16();
    assert!(depth.get_pixel(12, 8)[0] > 6_000 && depth.get_pixel(12, 0)[0] == 0);
    let normal = open(&place.path("normal.png")).into_rgb8();
    assert!(normal.get_pixel(12, 8)[2] > 230, "the ball does not face the camera");
    let id = open(&place.path("id.png")).into_rgb8();
    let [ball, floor, nothing] = [(12, 8), (12, 15), (12, 0)].map(|(x, y)| *id.get_pixel(x, y));
    assert!(ball != floor && ball != nothing && floor != nothing);
}

#[test]
fn pictures_show_what_the_view_says() {
    let place = Place::new();
    let render = |view: &str| {
        let done = place.run(&["render", "scene.json", "-o", "out.png", "--size", "24x16", "--view", view]);
        (done.succeeded().out.clone(), open(&place.path("out.png")).into_rgb8())
    };
    let (said, normals) = render("normals");
    assert!(said.contains("wrote out.png (direction in the world)"), "{said}");
    assert!(normals.get_pixel(12, 8)[2] > 230, "the ball does not face the camera");
    let (said, steps) = render("steps");
    assert!(said.contains("evaluations by rays, per pixel: 0 1 4"), "{said}");
    assert_ne!(steps.get_pixel(12, 8), steps.get_pixel(12, 0), "the sky takes as many steps as the ball");
    let (said, shaded) = render("shaded");
    assert!(said.contains("wrote out.png\n"), "{said}");
    assert_ne!(shaded, normals);
    place.run(&["render", "scene.json", "-o", "out.png", "--view", "steps", "--reference"]).failed(2, &["--reference"]);
}

#[test]
fn cameras_are_chosen_by_name() {
    let place = Place::new();
    let render =
        |camera: &str| place.run(&["render", "scene.json", "-o", "out.png", "--size", "16x16", "--camera", camera]);
    render("above").succeeded();
    let above = open(&place.path("out.png"));
    render("front").succeeded();
    assert_ne!(above, open(&place.path("out.png")));
    render("nowhere").failed(2, &["nowhere", "front", "above"]);
}

#[test]
fn files_that_are_missing_or_broken_are_named() {
    let place = Place::new();
    place.run(&["render", "none.json", "-o", "out.png"]).failed(3, &["none.json"]);
    place.run(&["check", "none.json"]).failed(3, &["none.json"]);
    place.write_broken("broken.json");
    place.run(&["render", "broken.json", "-o", "out.png"]).failed(3, &["broken.json", "ball", "radius"]);
    assert_eq!(place.names(), ["broken.json", "scene.json"]);
}

#[test]
fn outputs_that_cannot_be_written_are_refused_before_the_work() {
    let place = Place::new();
    std::fs::create_dir(place.path("folder.png")).expect("made");
    place.run(&["render", "scene.json", "-o", "folder.png"]).failed(5, &["folder.png", "folder"]);
    place.run(&["render", "scene.json", "-o", "no/such/out.png"]).failed(5, &["no/such/out.png"]);
    place.run(&["render", "scene.json", "-o", "out.png", "--depth", "no/depth.exr"]).failed(5, &["no/depth.exr"]);
    assert_eq!(place.names(), ["folder.png", "scene.json"]);
}

#[test]
fn without_a_driver_it_says_so() {
    let place = Place::new();
    let mut command = Command::new(env!("CARGO_BIN_EXE_isolith"));
    command.current_dir(place.folder.path()).args(["render", "scene.json", "-o", "out.png"]);
    // A missing backend simulates a machine without a driver.
    let output = command.env("WGPU_BACKEND", "dx12").output().expect("the program starts");
    if cfg!(windows) {
        return;
    }
    assert_eq!(output.status.code(), Some(4));
    assert!(String::from_utf8_lossy(&output.stderr).contains("mesa-vulkan-drivers"));
}

#[test]
fn check_counts_what_is_there() {
    let place = Place::new();
    let report = place.run(&["check", "scene.json", "--json"]).succeeded().object();
    let all = ["ok", "file", "nodes", "components", "tree_depth", "cameras", "clips", "limits", "warnings"];
    assert_eq!(keys(&report), all);
    assert_eq!(report["cameras"], serde_json::json!(["front", "above"]));
    assert_eq!((&report["nodes"], &report["components"], &report["tree_depth"]), (&5.into(), &2.into(), &2.into()));
    assert_eq!(report["warnings"], Value::Array(Vec::new()));
    let text = place.run(&["check", "scene.json"]).succeeded().out.clone();
    for part in ["nodes", "of 100000", "components", "depth of the tree", "warnings"] {
        assert!(text.contains(part), "{part} is not in {text}");
    }
}

#[test]
fn check_lists_every_parameter_with_unit_limits_and_default() {
    let place = Place::new();
    let scene = sample();
    let report = place.run(&["check", "scene.json", "--params", "--json"]).succeeded().object();
    let listed = report["params"].as_array().expect("a list").clone();
    let all = ParamPath::all(&scene);
    assert_eq!(listed.len(), all.len());
    for (entry, (path, param, value)) in listed.iter().zip(&all) {
        assert_eq!(keys(entry), ["path", "label", "value", "unit", "least", "most", "default", "animatable"]);
        assert_eq!(entry["path"].as_str(), Some(path.to_string().as_str()));
        assert_eq!(entry["value"].as_str(), Some(value.to_string().as_str()));
        assert_eq!(entry["default"].as_str(), Some(param.default.to_string().as_str()));
    }
    let text = place.run(&["check", "scene.json", "--params"]).succeeded().out.clone();
    for part in [
        "environment.background.sky = [",
        "material.1.specular_roughness = 0.3 (0 to 1, default 0.3)",
        ".camera.fov_y = 40 ° (",
    ] {
        assert!(text.contains(part), "{part} is not in {text}");
    }
    assert!(!place.run(&["check", "scene.json"]).succeeded().out.contains("environment.background.sky"));
}

#[test]
fn check_warns_about_meshes_that_are_missing() {
    let place = Place::new();
    let mut scene = sample();
    let mesh = NodeKind::Mesh(MeshNode::new("no.glb"));
    let mut field = isolith::scene::ShapeKind::MeshField.default_shape();
    assert!(field.set_value(0, isolith::scene::ParamValue::Text("no.glb".into())));
    let field = NodeKind::Object(Object { shape: field, material: scene.materials()[0].id });
    for (name, kind) in [("statue", mesh), ("solid statue", field)] {
        scene.insert(None, 0, Node::new(name, kind)).expect("the scene has room");
    }
    place.write("mesh.json", &scene);
    let report = place.run(&["check", "mesh.json", "--json"]).succeeded().object();
    assert_eq!(report["warnings"].as_array().map(Vec::len), Some(2));
    assert_eq!(keys(&report["warnings"][0]), ["node", "reason"]);
}

#[test]
fn check_reports_what_cannot_be_used_as_one_object() {
    let place = Place::new();
    place.write_broken("broken.json");
    let outcome = place.run(&["check", "broken.json", "--json"]);
    outcome.failed(3, &["radius"]);
    let error = outcome.object();
    assert_eq!(keys(&error), ["ok", "file", "node", "field", "reason"]);
    assert_eq!(error["ok"], false);
    assert_eq!(error["file"], "broken.json");
    assert!(error["node"].as_str().is_some_and(|node| node.contains("ball")), "{error}");
    assert!(error["field"].as_str().is_some_and(|field| field.contains("radius")), "{error}");
    let missing = place.run(&["check", "none.json", "--json"]);
    assert_eq!(missing.failed(3, &[]).object()["node"], Value::Null);
}

#[test]
fn the_schema_is_a_json_schema() {
    let schema = Place::new().run(&["schema"]).succeeded().object();
    assert!(schema["$schema"].is_string() && schema["properties"].is_object());
}

#[test]
fn without_a_display_a_scene_is_rendered_and_the_file_named() {
    let place = Place::new();
    let outcome = place.run(&["scene.json"]);
    assert!(outcome.succeeded().out.contains("wrote scene.png"), "{}", outcome.out);
    assert_eq!(open(&place.path("scene.png")).dimensions(), (1280, 720));
    place.run(&[]).failed(4, &["no display"]);
}

#[test]
fn the_gallery_writes_scenes_that_pass_the_check() {
    let place = Place::new();
    place.run(&["gallery", "scenes"]).succeeded();
    place.run(&["check", "scenes/showcase.json", "--json"]).succeeded();
}

#[test]
#[cfg(unix)]
fn ctrl_c_ends_a_render_and_leaves_nothing_behind() {
    let place = Place::new();
    let mut child = std::process::Command::new(env!("CARGO_BIN_EXE_isolith"))
        .current_dir(place.folder.path())
        .args(["render", "scene.json", "-o", "out.png", "--size", "8192x8192", "--samples", "1"])
        .stdout(std::process::Stdio::null())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .expect("the program starts");
    // Long enough for the march to start, far less than it takes.
    std::thread::sleep(std::time::Duration::from_secs(3));
    let interrupted = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(interrupted.expect("kill can be run").success());
    let status = child.wait().expect("it ends");
    assert_eq!(status.code(), Some(130));
    assert_eq!(place.names(), ["scene.json"]);
}

#[test]
fn bench_measures_every_method_and_writes_tables_and_charts() {
    let place = Place::new();
    let methods = "thesis,baked,interpreter,tape,straight-line,limit,auto";
    let run = place.run(&["bench", "scene.json", "--methods", methods, "--size", "32", "--json", "--output", "report"]);
    run.succeeded();
    let rows: Vec<Value> = run.out.lines().map(|line| serde_json::from_str(line).expect("an object a line")).collect();
    let of = |row: &Value, key: &str| row[key].as_str().map(str::to_owned);
    let measured: Vec<_> = rows.iter().filter_map(|row| of(row, "method")).collect();
    assert_eq!(measured.join(","), methods);
    for row in &rows {
        for key in ["cpu_ms", "wall_ms", "steps_per_px", "evals_per_px", "wrong_share", "depth_p99", "normal_p99"]
            .into_iter()
            .chain([
                "steps_p99",
                "steps_max",
                "cells_per_px",
                "entries_per_px",
                "grazing_share",
                "surface_evals_per_px",
            ])
        {
            assert!(row[key].as_f64().is_some_and(|v| v >= 0.0), "{key} of {row}");
        }
        assert_eq!(row["wrong_share"].as_f64(), Some(0.0), "{row}");
        // Evaluations for normals count too: the floor and the ball fill more than half of the picture.
        let [all, surfaces] = ["evals_per_px", "surface_evals_per_px"].map(|key| row[key].as_f64().unwrap_or(0.0));
        assert!(all > surfaces && surfaces > 0.5, "{row}");
    }
    for name in ["bench.md", "bench.csv"] {
        let text = std::fs::read_to_string(place.path("report").join(name)).expect("a table");
        assert!(["interpreter", "auto", "grazing"].iter().all(|word| text.contains(word)), "{name}");
    }
    assert!(open(&place.path("report").join("scene.png")).dimensions().0 > 800);
}

#[test]
fn bench_refuses_what_it_does_not_know() {
    let place = Place::new();
    place.run(&["bench", "scene.json", "--methods", "fastest"]).failed(2, &["fastest", "thesis, baked"]);
    place.run(&["bench", "scene.json", "--qualities", "best"]).failed(2, &["best", "draft, default, fine"]);
    place.run(&["bench", "scene.json", "--size", "5"]).failed(2, &["16..=4096"]);
    place.run(&["bench", "missing.json"]).failed(3, &["missing.json"]);
}

#[test]
fn shader_prints_what_naga_accepts_and_says_what_there_is() {
    let place = Place::new();
    let list = place.run(&["shader", "scene.json", "--list"]);
    let lines: Vec<&str> = list.succeeded().out.lines().collect();
    assert!(lines[0].starts_with("passes: ") && lines[0].contains("surface"), "{}", list.out);
    assert!(lines[1].starts_with("evaluator 0: interpreter; components: 2; "), "{}", list.out);
    let straight = "evaluator 1: straight-line code for 1 entry; components: 1; shapes: ";
    assert!(lines.len() == 4 && lines[2].starts_with(straight), "{}", list.out);
    for (evaluator, pass) in [("0", "trace"), ("1", "surface"), ("2", "cone"), ("0", "shade")] {
        let run = place.run(&["shader", "scene.json", "--pass", pass, "--evaluator", evaluator]);
        let module = naga::front::wgsl::parse_str(&run.succeeded().out);
        let module = module.unwrap_or_else(|error| panic!("{pass}: {}", error.emit_to_string(&run.out)));
        assert!(!module.entry_points.is_empty(), "{pass}");
    }
    let of = |arguments: &[&str]| place.run(&[&["shader"], arguments].concat()).succeeded().out.clone();
    assert_ne!(of(&["scene.json"]), of(&["scene.json", "--counting"]));
    assert_ne!(of(&["scene.json", "--evaluator", "1"]), of(&["scene.json", "--evaluator", "1", "--for", "processor"]));
    assert_ne!(of(&["scene.json"]), of(&["scene.json", "--method", "baked"]));
    assert!(of(&[]).contains("fn sdf_mandelbulb"), "without a scene it knows every shape");
    place.run(&["shader", "scene.json", "--pass", "paint"]).failed(2, &["paint", "surface"]);
    place.run(&["shader", "scene.json", "--evaluator", "3"]).failed(2, &["evaluator 3", "--list"]);
    place.run(&["shader", "scene.json", "--method", "fastest"]).failed(2, &["fastest", "auto"]);
    place.run(&["shader", "missing.json"]).failed(3, &["missing.json"]);
}

#[test]
fn spans_are_told_where_the_environment_asks_for_them() {
    let place = Place::new();
    let run = |filter: Option<&str>| {
        let mut command = place.command(&["render", "scene.json", "--size", "32x32", "-o", "out.png"]);
        command.env_remove("RUST_LOG");
        filter.map(|filter| command.env("RUST_LOG", filter));
        String::from_utf8(command.output().expect("the program starts").stderr).expect("text")
    };
    let told = run(Some("isolith_field=debug,isolith_render=debug"));
    for span in ["flatten{nodes=", "plan{components=", "upload", "pass{name=\"trace\"", "pass{name=\"shade\""] {
        assert!(told.contains(span), "{span}: {told}");
    }
    assert!(!run(None).contains("flatten"), "nobody asked");
}
