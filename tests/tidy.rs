//! The rules of the house: who may use whom, how long a file may be, which words are not used. Each rule
//! has a counterexample below that breaks it and must be caught.

mod rules;
mod source;

use std::path::{Path, PathBuf};

use rules::{MODULES, edges, problems};

/// Folders and files that hold what people write.
const WRITTEN: &[&str] =
    &["src", "shaders", "tests", "benches", "scenes", "assets", "README.md", "Makefile", "Cargo.toml", ".ci"];
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

/// All text files below [`WRITTEN`], relative to `root`, with forward slashes.
fn written_files(root: &Path) -> Vec<String> {
    let mut open: Vec<PathBuf> = WRITTEN.iter().map(|name| root.join(name)).collect();
    let mut files = Vec::new();
    while let Some(path) = open.pop() {
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
    // Each module stands behind everything that it uses, so no chain of uses comes back.
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

/// Whether the rules find something whose text contains `what` in a file of this text.
fn caught(path: &str, body: &str, what: &str) -> bool {
    problems(path, &format!("//! A sample.\n{body}\n")).iter().any(|p| p.contains(what))
}

#[test]
fn forbidden_uses_are_caught() {
    assert!(caught("src/scene/a.rs", "use crate::flat::FlatScene;", "scene may not use flat"));
    assert!(caught("src/scene/a.rs", "use crate::{geometry::Aabb, render};", "scene may not use render"));
    assert!(caught("src/scene/a.rs", "use super::super::render::X;", "scene may not use render"));
    assert!(caught("src/scene/mod.rs", "use super::flat;", "scene may not use flat"));
    assert!(caught("src/editor/a/b.rs", "fn f() { crate::render::g() }", "editor may not use render"));
    assert!(caught("src/novelty/a.rs", "use crate::scene::Scene;", "stands in no table"));
    assert!(caught("src/editor/a.rs", "use wgpu::Device;", "only render and app may use wgpu"));
    assert!(caught("src/editor/a.rs", "fn f(d: &wgpu::Device) {}", "only render and app may use wgpu"));
    assert!(caught("src/render/a.rs", "use egui::Ui;", "only editor and app may use egui"));
    assert!(caught("src/render/a.rs", "use egui_ltreeview::X;", "only editor and app may use egui"));
    assert!(caught("src/render/a.rs", "use crate::scene::Scene;", "the renderer sees no Scene"));
    assert!(caught("src/document/mod.rs", "fn f() { std::fs::read(\"x\"); }", "touch the file system"));
    assert!(caught("src/flat/mod.rs", "use std::fs;", "touch the file system"));
    assert!(caught("src/flat/mod.rs", "fn f() { File::open(\"x\"); }", "touch the file system"));
}

#[test]
fn allowed_uses_are_let_through() {
    let fine = |path: &str, body: &str| assert_eq!(problems(path, &format!("//! A sample.\n{body}\n")), [""; 0]);
    fine("src/scene/a.rs", "use crate::geometry::Aabb;\nuse super::Node;\nuse crate::scene::Light;");
    fine("src/scene/mod.rs", "mod tests {\n use super::*;\n}");
    fine("src/scene/a.rs", "/// See [`crate::flat`] and `wgpu::Device`.\nfn f() {}");
    fine("src/scene/a.rs", "#[cfg(test)]\nmod tests {\n use crate::render::X;\n}");
    fine("src/render/gpu.rs", "use wgpu::util::DeviceExt;\nuse crate::scene::ShapeKind;");
    fine("src/scene/file/mod.rs", "use std::fs;");
    fine("src/flat/a.rs", "#[cfg(test)]\nmod tests {\n fn f() { std::fs::read(\"x\").unwrap(); }\n}");
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
}
