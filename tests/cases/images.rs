//! Images as heights and textures, and JSON that is large or comes from other programs.

use std::io::Cursor;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, Vec2, WritableImage,
};
use image::codecs::{jpeg::JpegEncoder, png::PngEncoder};
use image::{ExtendedColorType, ImageEncoder};
use isolith::scene::{Attachment, Content, Heights, NodeKind, Scene, Shape, file};
use serde_json::{Value, json};

/// Time limit for a hostile file.
const PATIENCE: Duration = Duration::from_secs(5);

fn case(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases").join(name)
}

fn parse(scene: &Value) -> Result<Scene, file::FileError> {
    file::parse(scene.to_string().as_bytes(), Path::new("scene.json"))
}

fn value(name: &str) -> Value {
    let text = std::fs::read_to_string(case(name)).expect("the case can be read");
    serde_json::from_str(&text).expect("it is JSON")
}

/// The heights at the centers of the quarters, row by row.
fn quarters(heights: &Heights) -> [f64; 4] {
    let [w, h] = heights.size.map(|n| n as isize);
    [(1, 1), (3, 1), (1, 3), (3, 3)].map(|(x, y)| heights.at(x * w / 4, y * h / 4))
}

fn assert_quarters(heights: &Heights, expected: [f64; 4], what: &str) {
    let found = quarters(heights);
    assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 0.01), "{what}: {found:?}, not {expected:?}");
}

fn heights_of(name: &str) -> Attachment<Heights> {
    let scene = file::load(&case(name)).unwrap_or_else(|error| panic!("{error}"));
    let image = |node: &std::sync::Arc<isolith::scene::Node>| match &node.kind {
        NodeKind::Object(object) => match &object.shape {
            Shape::Heightmap { image, .. } => Some(image.clone()),
            _ => None,
        },
        _ => None,
    };
    scene.nodes().iter().find_map(image).expect("the scene has an image")
}

fn read(name: &str, bytes: Vec<u8>) -> Heights {
    let file = Attachment::<Heights>::new(name, bytes).unwrap_or_else(|error| panic!("{error}"));
    file.content().expect("it holds heights").clone()
}

/// Gray levels of the four quarters, 16 by 16 pixels each.
const LEVELS: [f64; 4] = [0.2, 0.4, 0.6, 0.8];

fn level(x: usize, y: usize) -> f64 {
    LEVELS[2 * (y / 8) + x / 8]
}

fn gray() -> Vec<u8> {
    (0..256).map(|i| (255.0 * level(i % 16, i / 16)).round() as u8).collect()
}

/// EXIF data with an orientation, as cameras write it.
fn exif(orientation: u8) -> Vec<u8> {
    let mut out = b"MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0".to_vec();
    out.extend([orientation, 0, 0, 0, 0, 0, 0]);
    out
}

#[test]
fn images_are_read_as_their_makers_meant_them() {
    for (name, expected) in [
        ("images/y.json", LEVELS),
        ("images/rgb.json", LEVELS),
        ("images/orientation1.json", LEVELS),
        ("images/orientation6.json", [0.6, 0.2, 0.8, 0.4]),
    ] {
        assert_quarters(heights_of(name).content().expect("it holds heights"), expected, name);
    }
}

#[test]
fn photos_are_turned_as_they_are_to_be_shown() {
    let [a, b, c, d] = LEVELS;
    let shown = [
        [a, b, c, d],
        [b, a, d, c],
        [d, c, b, a],
        [c, d, a, b],
        [a, c, b, d],
        [c, a, d, b],
        [d, b, c, a],
        [b, d, a, c],
    ];
    for (orientation, expected) in (1..).zip(shown) {
        let mut png = Vec::new();
        let mut encoder = PngEncoder::new(&mut png);
        encoder.set_exif_metadata(exif(orientation)).expect("PNG has a place for it");
        encoder.write_image(&gray(), 16, 16, ExtendedColorType::L8).expect("memory takes all");
        assert_quarters(&read("x.png", png), expected, &format!("PNG, orientation {orientation}"));
        let mut jpeg = Vec::new();
        let mut encoder = JpegEncoder::new_with_quality(&mut jpeg, 100);
        encoder.set_exif_metadata(exif(orientation)).expect("JPEG has a place for it");
        encoder.write_image(&gray(), 16, 16, ExtendedColorType::L8).expect("memory takes all");
        assert_quarters(&read("x.jpg", jpeg), expected, &format!("JPEG, orientation {orientation}"));
    }
}

/// An uncompressed PNG file of these rows, each prefixed by its filter.
fn png(depth: u8, color: u8, palette: &[u8], lines: &[u8]) -> Vec<u8> {
    let crc = |bytes: &[u8]| {
        let step = |crc: u32, byte: &u8| {
            (0..8).fold(crc ^ u32::from(*byte), |crc, _| if crc & 1 == 1 { crc >> 1 ^ 0xedb8_8320 } else { crc >> 1 })
        };
        !bytes.iter().fold(!0, step)
    };
    let mut out = b"\x89PNG\r\n\x1a\n".to_vec();
    let mut chunk = |tag: &[u8], data: &[u8]| {
        out.extend((data.len() as u32).to_be_bytes());
        let body = [tag, data].concat();
        out.extend(&body);
        out.extend(crc(&body).to_be_bytes());
    };
    chunk(b"IHDR", &[0, 0, 0, 16, 0, 0, 0, 16, depth, color, 0, 0, 0]);
    if !palette.is_empty() {
        chunk(b"PLTE", palette);
    }
    let [a, b] = lines.iter().fold([1_u32, 0], |[a, b], byte| {
        let a = (a + u32::from(*byte)) % 65_521;
        [a, (b + a) % 65_521]
    });
    let length = lines.len() as u16;
    let head = [&[0x78, 1, 1], &length.to_le_bytes()[..], &(!length).to_le_bytes()].concat();
    chunk(b"IDAT", &[&head, lines, &(b << 16 | a).to_be_bytes()].concat());
    chunk(b"IEND", &[]);
    out
}

#[test]
fn every_kind_of_pixel_is_a_height() {
    let lines = |bytes: &dyn Fn(usize, usize) -> Vec<u8>| -> Vec<u8> {
        (0..16).flat_map(|y| [0].into_iter().chain((0..16).flat_map(move |x| bytes(x, y)))).collect()
    };
    let deep = |x, y| ((65_535.0 * level(x, y)).round() as u16).to_be_bytes().to_vec();
    let flat = |x, y| vec![(255.0 * level(x, y)).round() as u8];
    assert_quarters(&read("16.png", png(16, 0, &[], &lines(&deep))), LEVELS, "16 bits");
    assert!((quarters(&read("16.png", png(16, 0, &[], &lines(&deep))))[0] - 0.2).abs() < 1e-5);
    // Pixels hidden by alpha still have a height.
    let faint = |x, y| [flat(x, y), vec![7]].concat();
    assert_quarters(&read("la.png", png(8, 4, &[], &lines(&faint))), LEVELS, "gray and alpha");
    let color = |x, y| flat(x, y).repeat(3);
    assert_quarters(&read("rgb.png", png(8, 2, &[], &lines(&color))), LEVELS, "color");
    let palette: Vec<u8> = LEVELS.iter().flat_map(|v| [(255.0 * v) as u8; 3]).collect();
    let entry = |x: usize, y: usize| vec![(2 * (y / 8) + x / 8) as u8];
    assert_quarters(&read("p.png", png(8, 3, &palette, &lines(&entry))), LEVELS, "palette");
}

/// An EXR file with these channels, each with the gray levels.
fn exr_of(names: &[&str]) -> Vec<u8> {
    let samples = || FlatSamples::F32((0..256).map(|i| level(i % 16, i / 16) as f32).collect());
    let channels = names.iter().map(|name| AnyChannel::new(*name, samples())).collect();
    let layer =
        Layer::new(Vec2(16, 16), LayerAttributes::named("main"), Encoding::UNCOMPRESSED, AnyChannels::sort(channels));
    let mut out = Cursor::new(Vec::new());
    Image::from_layer(layer).write().to_buffered(&mut out).expect("memory takes all");
    out.into_inner()
}

#[test]
fn channels_of_exr_files_are_found_by_what_they_are() {
    for names in
        [&["Y"][..], &["Y", "A"], &["height"], &["depth.Z"], &["A", "mask"], &["R", "G", "B"], &["R", "G", "B", "Z"]]
    {
        assert_quarters(&read("x.exr", exr_of(names)), LEVELS, &format!("{names:?}"));
    }
    for names in [&["u", "v"][..], &["A"], &["R", "G"]] {
        let error = Attachment::<Heights>::new("x.exr", exr_of(names)).expect_err("it cannot be told");
        assert!(names.iter().all(|name| error.contains(&format!("{name:?}"))), "{error}");
    }
}

#[test]
fn kinds_of_images_that_are_not_read_are_named() {
    let tiff = b"II*\0\x08\0\0\0\0\0\0\0\0\0".to_vec();
    let error = Attachment::<Heights>::new("x.tif", tiff).expect_err("TIFF is not read");
    assert!(error.contains("TIFF") || error.contains("Tiff"), "{error}");
    let wide = Attachment::<Heights>::new("x.png", {
        let mut file = png(8, 0, &[], &[0; 17 * 16]);
        // Overwrite the width in the first chunk. Its checksum is wrong then, so the reader stops there.
        file[16..20].copy_from_slice(&20_000_u32.to_be_bytes());
        file
    });
    assert!(wide.is_err());
}

/// A file reader with a bug.
struct Buggy;

impl Content for Buggy {
    const WHAT: &'static str = "a file of the other program";
    const WITHOUT: &'static str = "Nothing";
    const ENDINGS: &'static [&'static str] = &["bug"];

    fn read(bytes: &[u8]) -> Result<Self, String> {
        assert!(bytes.len() > 10, "the bug");
        Ok(Self)
    }
}

#[test]
fn a_panic_of_a_reader_is_an_error() {
    let error = Attachment::<Buggy>::new("x.bug", vec![1]).expect_err("the reader panics");
    assert_eq!(error, "\"x.bug\" must be a file of the other program: an internal error: the bug");
    assert!(Attachment::<Buggy>::new("x.bug", vec![1; 20]).is_ok());
}

/// A scene of `count` large images; `name` gives each file's name.
fn many(count: usize, name: impl Fn(usize) -> String) -> Value {
    let mut scene = value("hostile/png-8192-1bit.json");
    let nodes = scene["nodes"].as_array_mut().expect("a list of nodes");
    let at = nodes.iter().position(|node| node["object"].is_object()).expect("an object");
    let node = nodes.remove(at);
    for i in 0..count {
        let mut node = node.clone();
        node["id"] = json!(1000 + i);
        node["name"] = json!(format!("hill {i}"));
        node["object"]["shape"]["image"]["name"] = json!(name(i));
        nodes.push(node);
    }
    scene
}

#[test]
fn the_pixels_of_all_images_of_a_scene_are_counted_before_they_are_read() {
    let begun = Instant::now();
    let error = parse(&many(120, |i| format!("{i}.png"))).expect_err("these are too many pixels");
    assert!(begun.elapsed() < PATIENCE, "it took {:?}", begun.elapsed());
    assert_eq!(error.node.as_deref(), Some("hill 2 #1002"), "{error}");
    assert!(error.field.as_deref().is_some_and(|field| field.ends_with("object.shape.image")), "{error}");
    assert!(error.reason.contains("128 megapixels"), "{error}");
    // The loader reads a file once, however many nodes use it.
    let begun = Instant::now();
    let scene = parse(&many(120, |_| "same.png".into())).unwrap_or_else(|error| panic!("{error}"));
    assert!(begun.elapsed() < PATIENCE, "it took {:?}", begun.elapsed());
    assert_eq!(scene.nodes().iter().filter(|node| node.name.starts_with("hill")).count(), 120);
}

#[test]
fn a_scene_with_images_that_could_not_be_read_again_is_not_made() {
    let mut scene = parse(&many(2, |i| format!("{i}.png"))).unwrap_or_else(|error| panic!("{error}"));
    let hill = scene.nodes().iter().rev().find(|node| node.name.starts_with("hill")).expect("a hill").clone();
    // A copy shares the image, and moving a node does not touch it.
    let copy = scene.insert(None, 0, isolith::scene::Node::clone(&hill)).expect("copies cost nothing");
    let mut third = isolith::scene::Node::clone(scene.node(copy).expect("it is there"));
    third.transform.translation.x += 1.0;
    scene.replace(third.clone()).expect("nothing was added");
    let NodeKind::Object(object) = &mut third.kind else { panic!("a hill is an object") };
    let bytes = value("hostile/png-8192-1bit.json");
    let node = bytes["nodes"].as_array().expect("nodes").iter().find(|n| n["object"].is_object()).expect("an object");
    let image: Attachment<Heights> =
        serde_json::from_value(node["object"]["shape"]["image"].clone()).expect("an image by itself may be large");
    if let Shape::Heightmap { image: held, .. } = &mut object.shape {
        *held = image;
    }
    let error = scene.replace(third).expect_err("a third large image is too much");
    assert!(error.to_string().contains("the pixels of all images"), "{error}");
}

#[test]
fn json_of_other_programs_is_read() {
    for name in ["json/schema-key.json", "json/whole-floats.json"] {
        let scene = file::load(&case(name)).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(scene.nodes().len(), 2);
        // The written file has neither.
        let text = file::to_json(&scene).expect("a sound scene");
        assert!(!text.contains("$schema") && !text.contains("100000.0"), "{text}");
    }
}

#[test]
fn whole_numbers_may_be_written_with_a_point_everywhere() {
    let mut scene = value("json/whole-floats.json");
    scene["isolith"] = json!(1.0);
    for kind in isolith::scene::ModifierKind::ALL {
        let slot = json!({"modifier": serde_json::to_value(kind.default_modifier()).expect("it can be written")});
        let mut with_points = slot.clone();
        points(&mut with_points);
        for slot in [slot, with_points] {
            scene["nodes"][1]["modifiers"] = json!([slot]);
            assert!(parse(&scene).is_ok(), "{kind:?}: {:?}", parse(&scene));
        }
    }
    for (bad, reason) in
        [(json!(1.5), "a whole number"), (json!(-1.0), "a whole number"), (json!(1e300), "a whole number")]
    {
        scene["nodes"][1]["modifiers"] = json!([]);
        scene["nodes"][1]["id"] = bad;
        let error = parse(&scene).expect_err("it is not whole");
        assert!(error.reason.contains(reason), "{error}");
    }
}

/// Writes all integers with a decimal point.
fn points(value: &mut Value) {
    match value {
        Value::Number(number) if number.is_u64() => *value = json!(number.as_f64().expect("a small number")),
        Value::Array(list) => list.iter_mut().for_each(points),
        Value::Object(map) => map.values_mut().for_each(points),
        _ => {}
    }
}

#[test]
fn large_json_is_refused_before_it_is_built() {
    let zeros = |count: usize| format!("[{}0]", "0,".repeat(count));
    let million = zeros(1 << 20);
    let shape = |text: &str| {
        format!(
            r#"{{"isolith": 1, "nodes": [{{"id": 1, "camera": {{"fov_y": 40, "near": 1, "far": 2}}}}, {{"id": 7, "name": "bomb", "object": {{"material": 1, "shape": {text}}}}}]}}"#
        )
    };
    let begun = Instant::now();
    for (text, node, field) in [
        (format!(r#"{{"isolith": {million}, "nodes": []}}"#), None, "isolith"),
        (shape(&million), Some("bomb #7"), "nodes[1]"),
        (shape(&format!(r#"{{"points": {million}, "type": "tube"}}"#)), Some("bomb #7"), "nodes[1]"),
        (format!(r#"{{"isolith": 1, "materials": [{{"x": {million}}}], "nodes": []}}"#), None, "materials[0]"),
        (format!(r#"{{"environment": {million}, "isolith": 1, "nodes": []}}"#), None, "environment"),
    ] {
        let error = file::parse(text.as_bytes(), Path::new("x.json")).expect_err("it holds too much");
        assert!(error.reason.contains("holds more than 65536 values"), "{error}");
        assert_eq!((error.node.as_deref(), error.field.as_deref()), (node, Some(field)), "{error}");
    }
    assert!(begun.elapsed() < PATIENCE, "it took {:?}", begun.elapsed());
    // Deep nesting does not overflow the stack.
    for depth in [200, 30_000] {
        let nested = "[".repeat(depth) + &"]".repeat(depth);
        let text = shape(&format!(r#"{{"points": {nested}, "type": "tube"}}"#));
        let error = file::parse(text.as_bytes(), Path::new("x.json")).expect_err("it is nested too deeply");
        assert!(error.reason.contains("recursion limit"), "{error}");
    }
}

/// Bounds the memory of the program as well. The limit applies to address space, of which a program reserves more than
/// it uses.
#[cfg(target_os = "linux")]
#[test]
fn a_file_of_64_mib_takes_less_than_a_gibibyte() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let path = folder.path().join("bomb.json");
    let head = r#"{"isolith": 1, "nodes": [{"id": 7, "name": "bomb", "object": {"material": 1, "shape": {"points": ["#;
    std::fs::write(&path, head.to_owned() + &"0,".repeat(32 << 20) + "0]}}}]}").expect("it can be written");
    let mut command = std::process::Command::new("sh");
    command.args(["-c", "ulimit -v 1572864; exec \"$0\" check \"$1\"", env!("CARGO_BIN_EXE_isolith")]).arg(&path);
    let output = command.output().expect("the program starts");
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(3), "{said}");
    assert!(said.contains("bomb #7"), "{said}");
}
