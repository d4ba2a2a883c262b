//! Letters: shaping, direction, kerning, hostile fonts.

mod build;

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use isolith::field::{NO_LEAF, flatten};
use isolith::geometry::{Aabb, ArcPiece};
use isolith::render::EvalStrategy;
use isolith::scene::{Attachment, NodeKind, Scene, Shape, file, text_profile};

use crate::gpu::BenchScene;
use build::{Font, arabic_forms, composite, polygons, rectangles};

/// How long a hostile file may take.
const PATIENCE: Duration = Duration::from_secs(5);

fn case(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases").join(name)
}

fn scene(name: &str) -> Scene {
    file::load(&case(name)).unwrap_or_else(|error| panic!("{error}"))
}

/// Text and font of the first text of a scene.
fn text_of(scene: &Scene) -> (String, Attachment<isolith::font::Face>) {
    let shape = |node: &std::sync::Arc<isolith::scene::Node>| match &node.kind {
        NodeKind::Object(object) => match &object.shape {
            Shape::Text { text, font, .. } => Some((text.clone(), font.clone())),
            _ => None,
        },
        _ => None,
    };
    scene.nodes().iter().find_map(shape).expect("the scene has a text")
}

fn arcs(name: &str) -> Vec<ArcPiece> {
    let (text, font) = text_of(&scene(&format!("text/{name}.json")));
    text_profile(&text, &font, 1.0)
}

/// Start and end of the ink of each closed curve, from left to right.
fn inks(arcs: &[ArcPiece]) -> Vec<[f64; 2]> {
    let mut out = Vec::new();
    let mut open: Option<(ArcPiece, Aabb)> = None;
    for arc in arcs {
        let (first, bounds) = open.take().unwrap_or((*arc, Aabb::EMPTY));
        let bounds = bounds.union(&arc.bounds());
        if arc.end().distance(first.start()) < 1e-9 {
            out.push([bounds.min.x, bounds.max.x]);
        } else {
            open = Some((first, bounds));
        }
    }
    assert!(open.is_none(), "a curve is open");
    out.sort_by(|a, b| a[0].total_cmp(&b[0]));
    out
}

fn assert_inks(found: &[ArcPiece], expected: &[[f64; 2]]) {
    let found = inks(found);
    let near = |a: &[f64; 2], b: &[f64; 2]| (a[0] - b[0]).abs() < 1e-6 && (a[1] - b[1]).abs() < 1e-6;
    let is_same = found.len() == expected.len() && found.iter().zip(expected).all(|(a, b)| near(a, b));
    assert!(is_same, "ink at {found:?}, not at {expected:?}");
}

/// The outlines of a text in a font made by code.
fn drawn(font: &Font, text: &str) -> Vec<ArcPiece> {
    let font = Attachment::new("made.ttf", font.file()).unwrap_or_else(|error| panic!("{error}"));
    text_profile(text, &font, 1.0)
}

#[test]
fn letters_stand_where_the_font_says() {
    // The pair A B has a kerning of -200 units.
    let kerned = inks(&arcs("ab"));
    assert!((kerned[0][0] + 0.3).abs() < 1e-6 && (kerned[kerned.len() - 1][1] - 0.3).abs() < 1e-6, "{kerned:?}");
    // The outline does not start at the side bearing.
    assert_inks(&arcs("side-bearing/ab"), &[[-0.5, -0.1], [0.1, 0.3]]);
    // A font with symbol encoding.
    assert_inks(&arcs("a"), &inks(&arcs("plain")));
    assert_eq!(arcs("decomposed"), arcs("composed"));
    assert_eq!(inks(&arcs("composed")).len(), 2, "a letter and its accent");
}

#[test]
fn letters_without_ink_leave_no_trace() {
    assert_eq!(arcs("zwj"), arcs("plain"));
    let (text, font) = text_of(&scene("text/plain.json"));
    for unseen in ['\u{200d}', '\u{fe0f}', '\u{200b}', '\u{200e}', '\u{ad}', '\u{200f}', '\u{2060}', '\u{feff}'] {
        let with = format!("A{unseen}B");
        assert_eq!(text_profile(&with, &font, 1.0), text_profile(&text, &font, 1.0), "U+{:04X}", u32::from(unseen));
    }
}

#[test]
fn hebrew_runs_from_right_to_left() {
    let (text, font) = text_of(&scene("text/alef-bet.json"));
    let first: String = text.chars().take(1).collect();
    let second: String = text.chars().skip(1).collect();
    let width = |text: &str| inks(&text_profile(text, &font, 1.0)).iter().map(|[a, b]| b - a).sum::<f64>();
    let both = inks(&text_profile(&text, &font, 1.0));
    assert!((width(&first) - width(&second)).abs() > 0.05, "the letters cannot be told apart");
    assert!((both[0][1] - both[0][0] - width(&second)).abs() < 1e-6, "the second letter stands on the left: {both:?}");
}

#[test]
fn directions_mix_and_brackets_are_mirrored() {
    // Bars of three widths for two Hebrew letters and a Latin one; one bracket on the left, one on the right.
    let bar = |width: i16| rectangles(&[[0, 0, width, 700]]);
    let bracket = |x: i16| rectangles(&[[x, 0, x + 10, 700]]);
    let font = Font::new()
        .glyph(bar(100), 200)
        .glyph(bar(200), 300)
        .glyph(bar(50), 150)
        .glyph(bracket(0), 100)
        .glyph(bracket(90), 100)
        .letter('(', 4)
        .letter(')', 5)
        .letter('A', 3)
        .letter('א', 1)
        .letter('ב', 2);
    let widths = |text: &str| -> Vec<i32> {
        inks(&drawn(&font, text)).iter().map(|[a, b]| ((b - a) * 1000.0).round() as i32).collect()
    };
    assert_eq!(widths("אב"), [200, 100]);
    assert_eq!(widths("Aאב"), [50, 200, 100]);
    // A text that starts in Hebrew runs from right to left as a whole.
    assert_eq!(widths("אבA"), [50, 200, 100]);
    assert_eq!(widths("A\u{200f}אA"), [50, 100, 50]);
    // An opening bracket faces its content in either direction.
    let latin = inks(&drawn(&font, "(A)"));
    let hebrew = inks(&drawn(&font, "(א)"));
    assert!(latin[0][0] < latin[1][0] - 0.09 && hebrew[0][0] < hebrew[1][0] - 0.09, "{latin:?} {hebrew:?}");
}

#[test]
fn arabic_letters_are_joined() {
    let bar = |height: i16| rectangles(&[[0, 0, 100, height]]);
    let forms: [(&[u8; 4], u16); 3] = [(b"init", 2), (b"medi", 3), (b"fina", 4)];
    let mut font = Font::new().letter('ب', 1).table(b"GSUB", arabic_forms(&forms));
    for height in [100, 200, 300, 400] {
        font = font.glyph(bar(height), 150);
    }
    let heights = |text: &str| -> Vec<i32> {
        let arcs = drawn(&font, text);
        let mut bars: Vec<(f64, f64)> = arcs
            .chunks(4)
            .map(|bar| bar.iter().fold(Aabb::EMPTY, |all, arc| all.union(&arc.bounds())))
            .map(|b| (b.min.x, b.max.y - b.min.y))
            .collect();
        bars.sort_by(|a, b| a.0.total_cmp(&b.0));
        bars.iter().map(|(_, height)| (height * 1000.0).round() as i32).collect()
    };
    // From the left: final, medial, initial form.
    assert_eq!(heights("ب"), [100]);
    assert_eq!(heights("بب"), [400, 200]);
    assert_eq!(heights("ببب"), [400, 300, 200]);
    // A space separates words; a joiner connects to nothing.
    assert_eq!(heights("ب\u{200c}ب"), [100, 100]);
    assert_eq!(heights("ب\u{200d}"), [200]);
}

#[test]
fn overlapping_contours_look_as_their_union() {
    let [overlap, union] = ["overlap", "union"].map(|name| {
        BenchScene::new(name, &scene(&format!("text/{name}.json")), None).render(96, EvalStrategy::Interpreter)
    });
    let mut seen = 0;
    for i in 0..overlap.leaf.len() {
        assert_eq!(overlap.leaf[i] == NO_LEAF, union.leaf[i] == NO_LEAF, "pixel {i}");
        if union.leaf[i] != NO_LEAF {
            seen += 1;
            assert!((overlap.depth[i] - union.depth[i]).abs() < 1e-4, "pixel {i}");
        }
    }
    assert!(seen > 500, "only {seen} pixels show the letter");
    let length = |name: &str| arcs(name).iter().map(ArcPiece::length).sum::<f64>();
    assert!((length("overlap") - length("union")).abs() < 1e-9);
}

#[test]
fn letters_that_overlap_are_one() {
    // Strokes that reach into the next letter with collinear edges, like joined letters.
    let font = Font::new().glyph(rectangles(&[[-100, 100, 700, 300]]), 600).letter('a', 1);
    let arcs = drawn(&font, "aaa");
    assert_inks(&arcs, &[[-1.0, 1.0]]);
    assert!((arcs.iter().map(ArcPiece::length).sum::<f64>() - 4.4).abs() < 1e-6);
    // Two strokes of opposite orientation cancel where they cross, as in every program that draws fonts.
    let cross = [[0, 200], [600, 200], [600, 400], [0, 400], [200, 0], [200, 600], [400, 600], [400, 0]];
    let font = Font::new().glyph(polygons(&cross, 4), 600).letter('a', 1);
    assert!((drawn(&font, "a").iter().map(ArcPiece::length).sum::<f64>() - 3.2).abs() < 1e-6);
    // Three glyphs at one place act as one.
    let font = Font::new().glyph(rectangles(&[[0, 0, 300, 300]]), 400).glyph(composite(&[1, 1, 1]), 400).letter('a', 2);
    assert_eq!(inks(&drawn(&font, "a")).len(), 1);
}

/// Tries a text with a font; returns the reason for the refusal.
fn refusal(font: &Font, text: &str) -> String {
    let begun = Instant::now();
    let refused = refused(font, text);
    assert!(begun.elapsed() < PATIENCE, "it took {:?}", begun.elapsed());
    refused
}

fn refused(font: &Font, text: &str) -> String {
    let font = match Attachment::new("made.ttf", font.file()) {
        Ok(font) => font,
        Err(reason) => return reason,
    };
    let mut scene = scene("text/plain.json");
    let id = scene.nodes().iter().find(|node| matches!(node.kind, NodeKind::Object(_))).expect("a text").id;
    let mut node = isolith::scene::Node::clone(scene.node(id).expect("it is there"));
    if let NodeKind::Object(object) = &mut node.kind {
        object.shape = Shape::Text { text: text.into(), font, size: 1.0, depth: 0.1, rounding: 0.0 };
    }
    match isolith::scene::check::node(&node) {
        Ok(()) => {
            scene.replace(node).expect("the node is there");
            flatten(&scene, 0.0).unwrap();
            String::new()
        }
        Err(fault) => format!("{}: {}", fault.field, fault.reason),
    }
}

#[test]
fn fonts_of_endless_work_are_refused_by_name() {
    for (name, reason) in [
        ("hostile/font-comp-8-10.json", "is made of more than 32768 points"),
        ("hostile/fonts_cff_9_100.json", "run over more than 256 KiB"),
    ] {
        let begun = Instant::now();
        let error = file::load(&case(name)).expect_err("it is too much");
        assert!(begun.elapsed() < PATIENCE, "{name} took {:?}", begun.elapsed());
        assert_eq!(error.node.as_deref(), Some("n1 #1"), "{error}");
        assert!(error.field.as_deref().is_some_and(|field| field.ends_with("object.shape.font")), "{error}");
        assert!(error.reason.contains(reason) && error.reason.contains('A'), "{error}");
    }
}

#[test]
fn relatives_of_fonts_of_endless_work() {
    let a = |glyph: u32| Font::new().letter('a', glyph);
    // A glyph that contains itself, directly and through another.
    let ring = a(1).glyph(composite(&[2]), 500).glyph(composite(&[1]), 500);
    assert!(refusal(&ring, "a").contains("is a part of itself"), "{}", refusal(&ring, "a"));
    // A long chain of composite glyphs.
    let chain = (1..60).fold(a(59), |font, i: u16| font.glyph(composite(&[i - 1]), 500));
    assert!(refusal(&chain, "a").contains("deep"), "{}", refusal(&chain, "a"));
    // Two thousand parts of twenty points are too many; twenty parts are not.
    let dense: Vec<[i16; 2]> = (0..20).map(|i| [10 * i, i * i]).collect();
    let parts = |count: usize| a(2).glyph(polygons(&dense, 20), 500).glyph(composite(&vec![1; count]), 500);
    assert!(refusal(&parts(2_000), "a").contains("points"));
    assert_eq!(refusal(&parts(20), "a"), "");
    // A glyph of 60 000 points.
    let dense: Vec<[i16; 2]> = (0..60_000).map(|i| [(i % 500) as i16, (i / 500) as i16]).collect();
    assert!(refusal(&a(1).glyph(polygons(&dense, 4), 500), "a").contains("points"));
    // 4 000 long lines that all cross each other.
    let star: Vec<[i16; 2]> = (0..8_000).map(|i| [(i * 7_919 % 1_000) as i16, (i * 104_729 % 997) as i16]).collect();
    let reason = refusal(&a(1).glyph(polygons(&star, 8), 500), "a");
    assert!(reason.contains("cross each other too often"), "{reason}");
    // Many letters with many points.
    let dense: Vec<[i16; 2]> = (0..4_000)
        .map(|i| [(i / 4 % 40 * 20) as i16 + [0, 0, 9, 9][i % 4], (i / 160 * 20) as i16 + [0, 9, 9, 0][i % 4]])
        .collect();
    let reason = refusal(&a(1).glyph(polygons(&dense, 4), 1_000), &"a".repeat(64));
    assert!(reason.contains("takes more than 32768 arcs"), "{reason}");
    // A map of all letters, repeated many times, costs nothing.
    let mut wide = a(1).glyph(rectangles(&[[0, 0, 300, 300]]), 400);
    wide.letters.extend((0..100_000).map(|i| (0x1_0000 + i, u32::MAX - 1, 1)));
    assert_eq!(refusal(&wide, "ab\u{1f600}\u{10ffff}"), "");
}

#[test]
fn tables_of_layout_that_share_everything_are_refused() {
    // 10 000 references to one lookup, with 10 000 identical parts.
    let count = 10_000_u16;
    let mut table: Vec<u16> = vec![1, 0, 10, 10, 10, count];
    table.extend(vec![2 + 2 * count; usize::from(count)]);
    table.extend([1, 0, count]);
    table.extend(vec![6 + 2 * count; usize::from(count)]);
    table.extend([1, 6, 0, 1, 1, 1]);
    let table: Vec<u8> = table.iter().flat_map(|word| word.to_be_bytes()).collect();
    for tag in [b"GSUB", b"GPOS"] {
        let font = Font::new().glyph(rectangles(&[[0, 0, 9, 9]]), 400).letter('a', 1).table(tag, table.clone());
        assert!(refusal(&font, "a").contains("entries"), "{}", refusal(&font, "a"));
    }
}

#[test]
fn broken_fonts_never_panic() {
    let forms: [(&[u8; 4], u16); 1] = [(b"init", 2)];
    let whole = Font::new()
        .glyph(rectangles(&[[0, 0, 300, 300], [100, 100, 400, 400]]), 400)
        .glyph(composite(&[1, 1]), 400)
        .letter('a', 1)
        .letter('ب', 2)
        .table(b"GSUB", arabic_forms(&forms))
        .file();
    let mut state = 7_u64;
    let mut random = |most: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % most
    };
    let mut read = 0;
    for _ in 0..3_000 {
        let mut bytes = whole.clone();
        for _ in 0..1 + random(4) {
            let at = random(bytes.len());
            bytes[at] = random(256) as u8;
        }
        bytes.truncate(if random(5) == 0 { random(bytes.len()) } else { bytes.len() });
        if let Ok(face) = isolith::font::Face::new(bytes) {
            read += 1;
            let _ = isolith::font::text_curve("aبaب", Some(&face));
        }
    }
    assert!(read > 500, "only {read} were read at all");
}

/// Files of fonts below a folder.
fn font_files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let below = |path: PathBuf| if path.is_dir() { font_files(&path) } else { vec![path] };
    let ending = |path: &PathBuf| path.extension().is_some_and(|e| e == "ttf" || e == "otf");
    entries.flat_map(|entry| below(entry.path())).filter(ending).collect()
}

#[test]
fn names_show_letters_of_every_script_that_a_font_of_the_system_has() {
    let letters = ['ש', 'ب', 'क', 'ก', '中', 'あ', '한'];
    let found = |ctx: &egui::Context| {
        let mut found = [false; 7];
        let mut output = ctx.run_ui(egui::RawInput::default(), |ui| {
            let font = egui::FontId::proportional(13.0);
            found = letters.map(|letter| ui.ctx().fonts_mut(|fonts| fonts.has_glyph(&font, letter)));
        });
        output.textures_delta.clear();
        found
    };
    let ctx = egui::Context::default();
    assert_eq!(found(&ctx), [false; 7], "the editor's own fonts have none of them");
    // As in the window, through a feature of eframe.
    ctx.add_font_provider(std::sync::Arc::new(egui_system_font_provider::SystemFontProvider::new()));
    let found = found(&ctx);
    let files: Vec<Vec<u8>> = font_files(Path::new("/usr/share/fonts")).iter().flat_map(std::fs::read).collect();
    for (letter, found) in letters.into_iter().zip(found) {
        let has = |file: &Vec<u8>| {
            use skrifa::MetadataProvider;
            skrifa::FontRef::new(file).is_ok_and(|font| font.charmap().map(letter).is_some())
        };
        assert!(found || !files.iter().any(has), "{letter} is not found, though a font of the system has it");
    }
    let manifest = include_str!("../../Cargo.toml");
    assert!(
        manifest.contains("\"system_fonts\""),
        "the window asks the system's fonts only with this feature of eframe"
    );
}
