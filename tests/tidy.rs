//! The rules of the house: allowed dependencies, length of files, retired words. For each rule, a counterexample below
//! breaks it and must be caught.

mod circles;
mod names;
mod rules;
mod source;

use std::path::{Path, PathBuf};

use circles::circles;
use names::{defined_twice, retired};
use rules::{MODULES, edges, problems};

/// Folders and files written by people.
const WRITTEN: &[&str] = &[
    "src",
    "shaders",
    "tests",
    "benches",
    "scenes",
    "assets",
    "README.md",
    "CONTRIBUTING.md",
    "Makefile",
    "Cargo.toml",
    ".ci",
];
/// Endings of text files.
const TEXT: &[&str] = &["rs", "wgsl", "md", "toml", "json", ""];

#[test]
fn every_file_keeps_the_rules() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut found = Vec::new();
    let mut count = 0;
    for path in written_files(root) {
        let Ok(text) = std::fs::read_to_string(root.join(&path)) else { continue };
        found.extend(problems(&path, &text));
        count += 1;
    }
    assert!(count > 30, "only {count} files were looked at");
    assert!(found.is_empty(), "{} problems:\n{}", found.len(), found.join("\n"));
}

/// Remaining circles of files. The list only shrinks.
const CIRCLES_LEFT: &[&[&str]] = &[];
/// Public types that more than one file still defines. The list only shrinks.
const TWICE_LEFT: &[&str] = &[];

/// Rust files below `src`, with their path relative to it and their text.
fn sources() -> Vec<(String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let rust = written_files(root).into_iter().filter(|path| path.starts_with("src/") && path.ends_with(".rs"));
    rust.map(|path| {
        let text = std::fs::read_to_string(root.join(&path)).expect("a source is text");
        (path.trim_start_matches("src/").to_owned(), text)
    })
    .collect()
}

#[test]
fn no_module_has_a_circle_of_files() {
    let found = circles(&sources());
    assert_eq!(found, CIRCLES_LEFT.iter().map(|circle| circle.to_vec()).collect::<Vec<_>>());
}

#[test]
fn public_types_are_defined_once() {
    let found = defined_twice(&sources());
    let names: Vec<&str> = found.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, TWICE_LEFT, "{found:#?}");
}

#[test]
fn retired_words_do_not_come_back() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let files = written_files(root).into_iter().filter(|path| path.ends_with(".rs") || path.ends_with(".wgsl"));
    let found: Vec<String> = files
        .filter(|path| path != "tests/tidy/names.rs")
        .flat_map(|path| retired(&path, &std::fs::read_to_string(root.join(&path)).expect("a source is text")))
        .collect();
    assert!(found.is_empty(), "{} retired words:\n{}", found.len(), found.join("\n"));
}

/// All text files below [`WRITTEN`], relative to `root`, with forward slashes.
fn written_files(root: &Path) -> Vec<String> {
    let mut open: Vec<PathBuf> = WRITTEN.iter().map(|name| root.join(name)).collect();
    let mut files = Vec::new();
    while let Some(path) = open.pop() {
        if path.is_symlink() {
            // Third-party files of a package are checked in their own folder.
            continue;
        }
        if path.is_dir() {
            let entries = std::fs::read_dir(&path).expect("a folder of the repository can be read");
            open.extend(entries.map(|entry| entry.expect("an entry of a folder can be read").path()));
        } else if path.is_file() {
            let ending = path.extension().map_or(String::new(), |e| e.to_string_lossy().into_owned());
            if TEXT.contains(&ending.as_str()) {
                let relative = path.strip_prefix(root).expect("below the root");
                files.push(relative.to_string_lossy().replace('\\', "/"));
            }
        }
    }
    files.sort();
    files
}

#[test]
fn the_table_of_modules_has_no_cycle_and_names_every_module() {
    // Each module follows all modules that it uses, so no chain of uses returns.
    for (i, (name, uses)) in MODULES.iter().enumerate() {
        for used in *uses {
            assert!(MODULES[..i].iter().any(|(earlier, _)| earlier == used), "{name} uses {used}, which stands later");
        }
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for path in written_files(root).iter().filter(|p| p.starts_with("src/")) {
        if let Some(module) = rules::module_of(path) {
            assert!(path.ends_with(".md") || MODULES.iter().any(|(name, _)| *name == module), "{module} has no row");
        }
    }
}

/// Whether the rules report a problem whose text contains `what`, for a file of this path and text.
fn caught(path: &str, body: &str, what: &str) -> bool {
    problems(path, &format!("//! A sample.\n{body}\n")).iter().any(|p| p.contains(what))
}

#[test]
fn manifests_say_what_the_table_of_modules_says() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for (name, uses) in MODULES.iter().filter(|(name, _)| !rules::PROGRAM.contains(name)) {
        let manifest = std::fs::read_to_string(root.join("src").join(name).join("Cargo.toml")).unwrap();
        assert_eq!(own_dependencies(&manifest), *uses, "the manifest of {name}");
    }
    let sample = "[dependencies]\nisolith-b.workspace = true\n[dev-dependencies]\nisolith-c.workspace = true\n";
    assert_eq!(own_dependencies(sample), ["b"]);
}

/// Members of the workspace that a manifest names under `[dependencies]`.
fn own_dependencies(manifest: &str) -> Vec<&str> {
    let body = manifest.split("[dependencies]").nth(1).unwrap_or_default();
    let lines = body.lines().take_while(|line| !line.starts_with('['));
    lines.filter_map(|line| line.strip_prefix("isolith-")?.split(['.', ' ']).next()).collect()
}

#[test]
fn forbidden_uses_are_caught() {
    assert!(caught("src/bench/a.rs", "use crate::editor::Editor;", "bench may not use editor"));
    assert!(caught("src/bench/a.rs", "use crate::{geometry::Aabb, app};", "bench may not use app"));
    assert!(caught("src/app/a.rs", "use super::super::cli::X;", "app may not use cli"));
    assert!(caught("src/app/mod.rs", "use super::cli;", "app may not use cli"));
    assert!(caught("src/app/a/b.rs", "fn f() { crate::cli::g() }", "app may not use cli"));
    assert!(caught("src/editor/a.rs", "use wgpu::Device;", "only render and app may use wgpu"));
    assert!(caught("src/editor/a.rs", "fn f(d: &wgpu::Device) {}", "only render and app may use wgpu"));
    assert!(caught("src/render/a.rs", "use egui::Ui;", "only editor and app may use egui"));
    assert!(caught("src/render/a.rs", "use egui_ltreeview::X;", "only editor and app may use egui"));
    assert!(caught("src/render/a.rs", "use isolith_scene::Scene;", "the renderer sees no Scene"));
    assert!(caught("src/render/a.rs", "use isolith_field::eval::field;", "it never evaluates"));
    assert!(caught("src/render/a.rs", "use isolith_field::{FlatScene, reference::trace};", "it never evaluates"));
    assert!(caught("src/document/mod.rs", "fn f() { std::fs::read(\"x\"); }", "touch the file system"));
    assert!(caught("src/field/mod.rs", "use std::fs;", "touch the file system"));
    assert!(caught("src/field/mod.rs", "fn f() { File::open(\"x\"); }", "touch the file system"));
}

#[test]
fn allowed_uses_are_let_through() {
    let fine = |path: &str, body: &str| assert_eq!(problems(path, &format!("//! A sample.\n{body}\n")), [""; 0]);
    fine("src/bench/a.rs", "use crate::geometry::Aabb;\nuse super::Node;\nuse crate::bench::Row;");
    fine("src/scene/mod.rs", "mod tests {\n use super::*;\n}");
    fine("src/bench/a.rs", "/// See [`crate::app`] and `wgpu::Device`.\nfn f() {}");
    fine("src/bench/a.rs", "#[cfg(test)]\nmod tests {\n use crate::app::X;\n}");
    fine("src/render/gpu.rs", "use wgpu::util::DeviceExt;\nuse isolith_scene::ShapeKind;");
    fine("src/render/a.rs", "#[cfg(test)]\nmod tests {\n use isolith_field::eval::field;\n}");
    fine("src/scene/file/mod.rs", "use std::fs;");
    fine("src/field/a.rs", "#[cfg(test)]\nmod tests {\n fn f() { std::fs::read(\"x\").unwrap(); }\n}");
}

#[test]
fn edges_are_seen_through_super_and_braces() {
    let words = source::tokens("use crate::{a::{x, y}, b}; mod t { use super::super::c; use super::d; }");
    let named: Vec<_> = edges("src/m.rs", &words).into_iter().map(|(_, name)| name).collect();
    assert_eq!(named, ["a", "b", "c"]);
}

#[test]
fn broken_house_rules_are_caught() {
    let bad = ["uns", "afe"].concat();
    assert!(caught("src/scene/a.rs", &format!("fn f() {{ {bad} {{}} }}"), &bad));
    assert!(caught("tests/gpu_static/src/cards.rs", &format!("fn f() {{ {bad} {{}} }}"), &bad));
    assert!(!caught("tests/gpu_static/src/vulkan.rs", &format!("fn f() {{ {bad} {{}} }}"), &bad));
    assert!(caught("src/scene/a.rs", &format!("fn f() {{ {}!() }}", ["to", "do"].concat()), "!"));
    assert!(caught("src/scene/a.rs", "fn f() { x.unwrap() }", "unwrap outside of tests"));
    assert!(caught("src/scene/a.rs", "fn f() { println!() }", "only the command line prints"));
    assert!(caught("src/scene/a.rs", &"// long\n".repeat(500), "lines are more than"));
    assert!(caught("src/scene/a.rs", &format!("fn f() {{\n{}}}", "g();\n".repeat(70)), "function of"));
    assert!(caught("src/scene/a.rs", &format!("fn f(a: [f64; 8]) {{\n{}}}", "g();\n".repeat(70)), "function of"));
    assert!(caught(&format!("src/scene/{}.rs", ["ut", "ils"].concat()), "", "says nothing"));
    assert!(caught("src/scene/a.rs", &format!("struct Scene{};", ["Man", "ager"].concat()), "says nothing"));
    assert!(caught("README.md", &format!("see {}me/x", "/ho"), "a path of one machine"));
    assert!(!problems("src/scene/a.rs", "fn f() {}\n").is_empty(), "a file without a first line of docs");
}

#[test]
fn shaders_that_break_the_rules_are_caught() {
    let shader = |text: &str| problems("shaders/trace.wgsl", text);
    assert_eq!(shader("// A pass.\nfn trace_step() {}\n@compute @workgroup_size(1)\nfn trace() {}\n"), [""; 0]);
    assert!(!shader("// A pass.\nfn step() {}\n").is_empty(), "a name without its file");
    assert!(!shader("fn trace_step() {}\n").is_empty(), "no first comment");
    assert!(!shader(&format!("// A pass.\n{}", "// long\n".repeat(250))).is_empty(), "too long");
    let long = format!("// A pass.\nfn trace(a: array<f32, 4>) {{\n{}}}\n", "g();\n".repeat(80));
    assert!(!shader(&long).is_empty(), "a function too long");
}
