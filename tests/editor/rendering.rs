//! The render dialog: what it writes is what the command line writes, and it never takes the artist by surprise.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;
use std::time::{Duration, Instant};

use egui::{Key, Modifiers, OutputCommand, accesskit::Role, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use glam::DVec3;
use isolith::document::Document;
use isolith::editor::Editor;
use isolith::export::GpuStudio;
use isolith::geometry::Camera;
use isolith::jobs::Task;
use isolith::render::AdapterChoice;
use isolith::scene::{CameraNode, MaterialId, Node, NodeKind, Object, Scene, Shape, file};
use isolith::session::{MeasuredView, RenderOrder, RenderRefusal, RenderReport, SceneCost, StillPreview, Studio};

use super::{click, field, no_picture, open_in, press};
use crate::settle::Settle;

/// A ball on a floor, seen by one of two cameras.
fn scene() -> Scene {
    let mut scene = Scene::new();
    let mut add = |node: Node| scene.insert(None, usize::MAX, node).expect("the scene has room");
    let object = |shape| NodeKind::Object(Object { shape, material: MaterialId(1) });
    add(Node::new("Floor", object(Shape::Plane {})).at(DVec3::Y * -0.5));
    add(Node::new("Ball", object(Shape::Sphere { radius: 0.5 })));
    for (name, eye) in [("Front", DVec3::new(0.0, 0.4, 3.0)), ("Above it", DVec3::new(0.0, 4.0, 0.1))] {
        let pose = Camera::looking_at(eye, DVec3::ZERO, 1.0);
        add(Node::new(name, NodeKind::Camera(CameraNode::default())).at(eye).rotated(pose.rotation));
    }
    scene
}

/// The editor on a scene in a folder, with this studio.
fn open_with(studio: Arc<dyn Studio>) -> (Harness<'static, Editor>, tempfile::TempDir) {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let path = folder.path().join("ball.json");
    file::save(&scene(), &path).expect("it can be written");
    let document = Document::open(&path).expect("a sound scene");
    let mut harness = open_in(document, vec2(1280.0, 864.0));
    harness.state_mut().set_studio(studio);
    press(&mut harness, Modifiers::NONE, Key::F12);
    field(&harness, "Render width").set_value_accesskit(40.0);
    field(&harness, "Render height").set_value_accesskit(30.0);
    field(&harness, "Render samples").set_value_accesskit(3.0);
    harness.settle();
    (harness, folder)
}

fn open() -> (Harness<'static, Editor>, tempfile::TempDir) {
    open_with(Arc::new(GpuStudio::new(AdapterChoice::default())))
}

fn press_button(harness: &mut Harness<'_, Editor>, name: &str) {
    let at = harness.get_by_label(name).rect().center();
    click(harness, at);
}

/// Chooses an entry of a drop-down list.
fn choose(harness: &mut Harness<'_, Editor>, list: &str, entry: &str) {
    let boxes = harness.get_all_by_label(list).find(|node| node.accesskit_node().role() == Role::ComboBox);
    let at = boxes.unwrap_or_else(|| panic!("no list {list}")).rect().center();
    click(harness, at);
    let entries = harness.get_all_by_label(entry).find(|node| node.accesskit_node().role() == Role::Button);
    let at = entries.unwrap_or_else(|| panic!("no entry {entry}")).rect().center();
    click(harness, at);
}

/// The command that the dialog copies.
fn copied(harness: &mut Harness<'_, Editor>) -> String {
    let at = harness.get_by_label("Copy the command").rect().center();
    super::pointer(harness, at, true);
    harness.step();
    super::pointer(harness, at, false);
    for _ in 0..4 {
        harness.step();
        let copied = harness.output().platform_output.commands.iter().find_map(|command| match command {
            OutputCommand::CopyText(text) => Some(text.clone()),
            _ => None,
        });
        if let Some(text) = copied {
            return text;
        }
    }
    panic!("nothing was copied");
}

fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).expect("the folder can be read");
    let mut names: Vec<_> = entries.map(|e| e.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

fn last(harness: &Harness<'_, Editor>) -> String {
    harness.state().messages().next_back().map_or(String::new(), |message| message.text.clone())
}

/// Runs the copied command; the files that it writes.
fn run(command: &str, files: &[PathBuf]) -> Vec<Vec<u8>> {
    files.iter().for_each(|file| std::fs::remove_file(file).expect("it is there"));
    let program = command.strip_prefix("isolith ").expect("it begins with the program");
    let shell = format!("'{}' {program} --quiet", env!("CARGO_BIN_EXE_isolith"));
    let output = Command::new("sh").args(["-c", &shell]).output().expect("a shell");
    assert!(output.status.success(), "{shell}: {}", String::from_utf8_lossy(&output.stderr));
    files.iter().map(|file| std::fs::read(file).unwrap_or_else(|error| panic!("{file:?}: {error}"))).collect()
}

#[test]
fn the_dialog_writes_the_same_bytes_as_the_command_it_shows() {
    let (mut harness, folder) = open();
    choose(&mut harness, "Render camera", "Above it");
    press_button(&mut harness, "Transparent background");
    press_button(&mut harness, "Render picture");
    let picture = folder.path().join("ball.png");
    assert!(last(&harness).starts_with("Rendered "), "{}", last(&harness));
    let ours = std::fs::read(&picture).expect("the picture");
    let size = image::load_from_memory(&ours).map(|image| (image.width(), image.height()));
    assert_eq!(size.expect("a PNG"), (40, 30));
    let command = copied(&mut harness);
    for part in ["--size 40x30", "--camera 'Above it'", "--samples 3", "--transparent"] {
        assert!(command.contains(part), "{part} is not in {command}");
    }
    assert!(run(&command, &[picture]) == [ours], "other bytes from {command}");
}

#[test]
fn frames_with_layers_are_those_of_the_command_too() {
    let (mut harness, folder) = open();
    choose(&mut harness, "Render format", "OpenEXR with layers");
    press_button(&mut harness, "Render a range of frames");
    field(&harness, "First frame to render").set_value_accesskit(2.0);
    field(&harness, "Last frame to render").set_value_accesskit(3.0);
    harness.settle();
    press_button(&mut harness, "Render frames");
    let files = ["ball.0002.exr", "ball.0003.exr"].map(|name| folder.path().join(name));
    let ours = files.each_ref().map(|file| std::fs::read(file).unwrap_or_else(|e| panic!("{e}: {}", last(&harness))));
    let command = copied(&mut harness);
    assert!(command.contains("--frames 2..3") && command.contains("--layers"), "{command}");
    assert!(run(&command, &files) == ours, "other bytes from {command}");
    let image = exr::prelude::read_all_flat_layers_from_file(&files[0]).expect("an EXR file");
    let channels: Vec<_> = image.layer_data[0].channel_data.list.iter().map(|c| c.name.to_string()).collect();
    for name in ["R", "A", "depth.Z", "normal.Y", "albedo.G", "node.id"] {
        assert!(channels.iter().any(|channel| channel == name), "no {name} in {channels:?}");
    }
    let of = |name: &str| &image.layer_data[0].channel_data.list[channels.iter().position(|c| c == name).unwrap()];
    let exr::prelude::FlatSamples::F32(albedo) = &of("albedo.G").sample_data else { panic!("not f32") };
    // The clay that a new scene begins with, wherever something is seen.
    let clay = scene().materials()[0].base_color[1] as f32;
    let off = albedo.iter().filter(|value| **value != 0.0).map(|value| (value - clay).abs()).fold(0.0, f32::max);
    assert!(albedo.iter().any(|value| *value > 0.0) && off < 1e-6, "{off}");
}

#[test]
fn files_that_exist_are_asked_about_and_kept_until_then() {
    let (mut harness, folder) = open();
    let picture = folder.path().join("ball.png");
    std::fs::write(&picture, "mine").expect("it can be written");
    press_button(&mut harness, "Render picture");
    assert_eq!(std::fs::read(&picture).expect("a file"), b"mine");
    press_button(&mut harness, "Keep the files");
    assert!(harness.query_by_label("Replace file").is_none());
    press_button(&mut harness, "Render picture");
    press_button(&mut harness, "Replace file");
    assert_ne!(std::fs::read(&picture).expect("a file"), b"mine");
    assert!(last(&harness).starts_with("Rendered "), "{}", last(&harness));
}

#[test]
fn a_canceled_picture_leaves_no_file_and_the_editor_never_waits() {
    let (mut harness, folder) = open();
    // Far more than a second of work.
    field(&harness, "Render width").set_value_accesskit(1200.0);
    field(&harness, "Render height").set_value_accesskit(900.0);
    field(&harness, "Render samples").set_value_accesskit(4096.0);
    harness.settle();
    let at = harness.get_by_label("Render picture").rect().center();
    super::pointer(&mut harness, at, true);
    super::pointer(&mut harness, at, false);
    harness.step();
    let started = Instant::now();
    let is_under_way = |harness: &Harness<'_, Editor>| {
        let tasks = harness.state().jobs().listed();
        tasks.iter().any(|task| task.name() == "Rendering ball.png" && task.progress().is_some_and(|p| p > 0.0))
    };
    while !is_under_way(&harness) {
        assert!(started.elapsed() < Duration::from_secs(40), "it does not begin");
        harness.step();
        std::thread::sleep(Duration::from_millis(2));
    }
    // A stray key does not end hours of work.
    harness.key_press(Key::Escape);
    harness.run_steps(3);
    assert!(harness.state().is_rendering() && is_under_way(&harness));
    let cancel = harness.get_by_label("Cancel rendering").rect().center();
    super::pointer(&mut harness, cancel, true);
    super::pointer(&mut harness, cancel, false);
    harness.settle();
    assert!(!harness.state().is_rendering());
    assert_eq!(names(folder.path()), ["ball.json"]);
    harness.get_by_label("Canceled.");
}

/// A studio whose disk is full.
struct FullDisk;

impl Studio for FullDisk {
    fn export(
        &self,
        order: &RenderOrder,
        _: &Task,
        show: &mut dyn FnMut(StillPreview),
    ) -> Result<RenderReport, RenderRefusal> {
        let file = Some(order.settings.output.clone());
        show(StillPreview { size: [2, 1], pixels: vec![[9, 9, 9, 255]; 2], samples: [1, 1], file });
        Err(RenderRefusal::Failed("ball.png: cannot be written: no space left on device".into()))
    }

    fn thumbnail(&self, _: &Scene, _: Option<PathBuf>, _: [u32; 2], _: &Task) -> Result<StillPreview, String> {
        Err("no thumbnails".into())
    }

    fn measure(&self, _: &MeasuredView, _: &Task) -> Result<SceneCost, String> {
        Err("no clock".into())
    }
}

#[test]
fn what_cannot_be_written_is_told_in_the_dialog_and_in_the_log() {
    let (mut harness, folder) = open_with(Arc::new(FullDisk));
    press_button(&mut harness, "Render picture");
    assert!(last(&harness).contains("no space left on device"), "{}", last(&harness));
    harness.get_by_label_contains("1 of 1 samples");
    // A folder of the picture's name cannot be replaced by a picture.
    let (mut harness, _folder) = open();
    std::fs::create_dir(_folder.path().join("ball.png")).expect("a folder");
    press_button(&mut harness, "Render picture");
    press_button(&mut harness, "Replace file");
    assert!(last(&harness).contains("cannot be written"), "{}", last(&harness));
    drop(folder);
}

#[test]
fn without_a_file_or_a_renderer_the_dialog_says_so() {
    let mut harness = Harness::builder()
        .with_size(vec2(1280.0, 864.0))
        .with_context_setup(Editor::setup)
        .build_ui_state(|ui, editor: &mut Editor| editor.show(ui, &no_picture()), Editor::new(Document::new(scene())));
    harness.settle();
    press(&mut harness, Modifiers::NONE, Key::F12);
    harness.get_by_label_contains("Save the scene, and the equal command");
    harness.get_by_label("There is no renderer.");
    assert!(harness.get_by_label("Render picture").accesskit_node().is_disabled());
}
