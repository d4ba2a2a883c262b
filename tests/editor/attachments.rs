//! Attachments of shapes: chosen, refused, or absent.

use std::path::Path;
use std::time::{Duration, Instant};

use egui::{Event, Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use isolith::editor::Editor;
use isolith::scene::{ColorTexture, NodeId, NodeKind, ParamPath, ParamValue, ShapeKind, Textures, Variants};

use super::{open, open_tall, press, scene, undo_all};

fn file_of(harness: &Harness<'_, Editor>, id: NodeId) -> String {
    let NodeKind::Object(object) = &harness.state().document().scene().node(id).unwrap().kind else {
        panic!("an object")
    };
    let values = object.shape.values();
    let file = values.iter().find_map(|v| if let ParamValue::File(file) = v { Some(file) } else { None });
    file.expect("a file").label().to_owned()
}

/// Clicks the file's field and types a path, without the final Enter.
fn name(harness: &mut Harness<'_, Editor>, field: &str, path: &Path) {
    harness.get_by_label(field).click();
    harness.run();
    press(harness, Modifiers::COMMAND, Key::A);
    harness.event(Event::Text(path.display().to_string()));
    harness.run();
}

/// Chooses a file and waits until the editor has read it.
pub fn choose(harness: &mut Harness<'_, Editor>, field: &str, path: &Path) {
    name(harness, field, path);
    harness.key_press(Key::Enter);
    harness.step();
    read_to_the_end(harness);
}

/// Draws frames until no file is being read. Does not use `run`, because the reader thread requests frames at any time.
fn read_to_the_end(harness: &mut Harness<'_, Editor>) {
    let since = Instant::now();
    while harness.state().files_being_read().next().is_some() {
        assert!(since.elapsed() < Duration::from_secs(60), "a file is read without an end");
        std::thread::sleep(Duration::from_millis(1));
        harness.step();
    }
    harness.run_steps(8);
}

/// Two heightmaps, both selected.
fn with_landscapes() -> (Harness<'static, Editor>, [NodeId; 2]) {
    let (mut scene, [_, ball, cube, _]) = scene();
    for id in [ball, cube] {
        let mut node = scene.node(id).unwrap().as_ref().clone();
        if let NodeKind::Object(object) = &mut node.kind {
            object.shape = ShapeKind::Heightmap.default_shape();
        }
        scene.replace(node).unwrap();
    }
    let mut harness = open(scene);
    harness.state_mut().document_mut().select(vec![ball, cube]);
    harness.run();
    (harness, [ball, cube])
}

#[test]
fn an_image_is_chosen_refused_and_done_without() {
    let folder = tempfile::tempdir().unwrap();
    let [image, text] = ["alps.png", "notes.txt"].map(|name| folder.path().join(name));
    image::GrayImage::from_fn(8, 8, |x, y| image::Luma([(16 * x + y) as u8])).save(&image).unwrap();
    std::fs::write(&text, "no image").unwrap();
    let (mut harness, [ball, cube]) = with_landscapes();
    choose(&mut harness, "Image: A hill", &image);
    assert_eq!([ball, cube].map(|id| file_of(&harness, id)), ["alps.png"; 2]);
    // A file that is not an image gives a message and changes nothing.
    choose(&mut harness, "Image: alps.png", &text);
    let message = harness.state().messages().last().unwrap().text.clone();
    let place = format!("Cube {cube}: Heightmap: image: ");
    assert!(message.starts_with(&format!("{place}\"notes.txt\" must be a PNG, JPEG or EXR image")), "{message}");
    choose(&mut harness, "Image: alps.png", &folder.path().join("none.png"));
    let message = harness.state().messages().last().unwrap().text.clone();
    assert!(message.contains("none.png") && message.contains("cannot be read"), "{message}");
    assert_eq!(file_of(&harness, ball), "alps.png");
    harness.get_by_label("Image: none").click();
    harness.run();
    assert_eq!(file_of(&harness, cube), "A hill");
    assert_eq!(undo_all(&mut harness), 2);
}

#[test]
fn a_file_is_read_beside_the_frames_and_dropped_with_its_document() {
    let folder = tempfile::tempdir().unwrap();
    let image = folder.path().join("alps.png");
    // So large that reading it takes more than a frame or two.
    image::GrayImage::new(8192, 8192).save(&image).unwrap();
    let (mut harness, [ball, _]) = with_landscapes();
    let scene = harness.state().document().scene().clone();
    let start = |harness: &mut Harness<'_, Editor>| {
        name(harness, "Image: A hill", &image);
        harness.key_press(Key::Enter);
        harness.step();
        // The editor looks for it in the next frame at the earliest, after reporting the job.
        assert_eq!(harness.state().files_being_read().collect::<Vec<_>>(), ["alps.png"]);
        assert_eq!(*harness.state().document().scene(), scene);
    };
    start(&mut harness);
    harness.step();
    assert!(harness.query_by_label("Reading alps.png…").is_some());
    read_to_the_end(&mut harness);
    assert_eq!(file_of(&harness, ball), "alps.png");
    assert!(harness.query_by_label("Reading alps.png…").is_none());
    assert_eq!(undo_all(&mut harness), 1);
    harness.run();
    start(&mut harness);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::N);
    harness.step();
    assert_eq!(harness.state().files_being_read().count(), 0);
    harness.run();
    assert_eq!(harness.state().document().scene().nodes().len(), 1, "a new scene has a sun");
    assert_eq!(undo_all(&mut harness), 0);
}

#[test]
fn an_image_is_chosen_for_a_texture_of_a_material() {
    let folder = tempfile::tempdir().unwrap();
    let [image, broken] = ["wall.png", "broken.png"].map(|name| folder.path().join(name));
    image::RgbImage::from_fn(8, 8, |x, y| image::Rgb([x as u8, y as u8, 9])).save(&image).unwrap();
    std::fs::write(&broken, &std::fs::read(&image).unwrap()[..40]).unwrap();
    let (mut scene, [_, ball, ..]) = scene();
    let mut material = scene.materials()[0].as_ref().clone();
    material.textures = Textures::triplanar();
    if let Textures::Triplanar { color, .. } = &mut material.textures {
        *color = ColorTexture::variants().swap_remove(1).0;
    }
    let path = ParamPath::of_material(material.id, "textures.color.image");
    let place = format!("{}: textures.color.image: ", material.name);
    scene.replace_material(material).unwrap();
    let mut harness = open_tall(scene);
    harness.state_mut().document_mut().select(vec![ball]);
    harness.run();
    harness.get_by_label("Textures").click();
    harness.run();
    choose(&mut harness, "Color image: No image", &image);
    let now = |harness: &Harness<'_, Editor>| match path.get(harness.state().document().scene()) {
        Ok(ParamValue::File(file)) => file.label().to_owned(),
        other => panic!("{other:?}"),
    };
    assert_eq!(now(&harness), "wall.png");
    choose(&mut harness, "Color image: wall.png", &broken);
    let message = harness.state().messages().last().unwrap().text.clone();
    assert!(message.starts_with(&format!("{place}\"broken.png\" must be a PNG, JPEG or EXR image: ")), "{message}");
    assert_eq!(now(&harness), "wall.png");
    assert_eq!(undo_all(&mut harness), 1);
}
