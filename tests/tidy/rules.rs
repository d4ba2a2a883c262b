//! The rules of the house, as a function of a file's path and text.

use super::source::{Token, closing, tokens};

/// Allowed dependencies of each module, besides itself. All modules except [`PROGRAM`] are members of the workspace,
/// and their manifests must agree.
pub const MODULES: &[(&str, &[&str])] = &[
    ("geometry", &[]),
    ("guard", &[]),
    ("jobs", &["guard"]),
    ("font", &["geometry"]),
    ("bricks", &["geometry"]),
    ("scene", &["bricks", "font", "geometry", "guard", "jobs"]),
    ("mesh", &["bricks", "geometry", "guard"]),
    ("document", &["geometry", "jobs", "scene"]),
    ("gallery", &["geometry", "scene"]),
    ("field", &["bricks", "geometry", "guard", "jobs", "mesh", "scene"]),
    ("wgsl", &["bricks", "field", "scene"]),
    ("render", &["bricks", "field", "geometry", "guard", "mesh", "scene", "wgsl"]),
    ("session", &["bricks", "document", "field", "geometry", "jobs", "mesh", "scene"]),
    ("editor", &["document", "field", "geometry", "guard", "jobs", "mesh", "scene", "session"]),
    ("export", &["field", "geometry", "jobs", "mesh", "render", "scene", "session"]),
    ("bench", &["field", "geometry", "guard", "mesh", "render", "scene", "wgsl"]),
    (
        "app",
        &[
            "document", "editor", "export", "field", "font", "gallery", "geometry", "guard", "jobs", "mesh", "render",
            "scene", "session", "wgsl",
        ],
    ),
    (
        "cli",
        &[
            "app", "bench", "document", "editor", "export", "field", "font", "gallery", "geometry", "guard", "jobs",
            "mesh", "render", "scene", "session", "wgsl",
        ],
    ),
];

/// The modules of the program itself.
pub const PROGRAM: &[&str] = &["app", "bench", "cli", "export"];

/// Crates that only some modules may name. An entry also covers crates whose names start with it.
const CRATES: &[(&str, &[&str])] = &[
    ("wgpu", &["render", "app"]),
    ("eframe", &["editor", "app"]),
    ("egui", &["editor", "app"]),
    ("rfd", &["editor", "app"]),
    ("zbus", &["editor"]),
    ("clap", &["cli"]),
    ("plotters", &["bench"]),
    ("ab_glyph", &["bench"]),
    ("harfrust", &["font"]),
    ("unicode_bidi", &["font"]),
    ("skrifa", &["font"]),
    ("exr", &["scene", "export"]),
    ("indicatif", &["cli"]),
    ("ctrlc", &["cli"]),
];

/// Path prefixes of the files that may access the file system.
const FILE_OWNERS: &[&str] = &[
    "src/scene/file",
    "src/mesh/",
    "src/document/preferences",
    "src/document/recent",
    "src/document/recovery",
    "src/cli/",
    "src/gallery/write",
    "src/session/brick_cache",
    "src/session/packing",
    "src/wgsl/disk",
];

/// Items of `scene` hidden from the renderer, which may use the plain data of shapes, lights and materials.
const HIDDEN_FROM_RENDER: &[&str] = &["Scene", "Node", "NodeKind"];

/// Modules of the field crate that evaluate. The renderer uses none of them, so that a comparison of both compares two
/// programs that share data only.
const EVALUATORS: &[&str] = &["eval", "reference", "unflattened", "pick"];

/// Keywords before a new name.
const NAMING: &[&str] = &["mod", "struct", "enum", "trait", "type", "fn", "const", "static", "let"];

/// The only file with `unsafe`: wgpu does not expose Vulkan's statistics of pipelines, and this package is for tests
/// only.
const UNSAFE_FILE: &str = "tests/gpu_static/src/vulkan.rs";

/// The build script is beside the code that it serves, but is a separate program.
const BUILD_SCRIPT: &str = "src/wgsl/embed_shaders.rs";

/// Maximum lines of a Rust file, a shader, a Rust function and a WGSL function.
pub const MAX_LINES: [usize; 4] = [500, 250, 70, 80];

/// All problems of a file, as `path:line: what`. `path` is relative to the repository.
pub fn problems(path: &str, text: &str) -> Vec<String> {
    let mut found = Vec::new();
    for (i, line) in text.lines().enumerate() {
        for bad in machine_paths().iter().filter(|bad| line.contains(*bad)) {
            found.push(format!("{path}:{}: a path of one machine: {bad}", i + 1));
        }
    }
    let stem = path.rsplit('/').next().unwrap_or(path);
    if is_vague(stem.split('.').next().unwrap_or(stem)) {
        found.push(format!("{path}:1: a name that says nothing"));
    }
    if path.ends_with(".rs") {
        rust(path, text, &mut found);
        evaluators(path, text, &mut found);
    } else if path.ends_with(".wgsl") {
        wgsl(path, text, &mut found);
    }
    found
}

/// Assembled at run time, so that this file does not contain them.
fn machine_paths() -> [String; 4] {
    [["/ho", "me/"], ["/wo", "rk/"], ["/ro", "ot/"], ["/tmp", "/"]].map(|parts| parts.concat())
}

fn is_vague(name: &str) -> bool {
    let name = name.to_lowercase();
    ["util", "helper", "manager", "misc"].iter().any(|bad| name.contains(bad))
}

fn rust(path: &str, text: &str, found: &mut Vec<String>) {
    let words = tokens(text);
    let mut report = |line: usize, what: String| found.push(format!("{path}:{line}: {what}"));
    let lines = text.lines().count();
    if lines > MAX_LINES[0] {
        report(1, format!("{lines} lines are more than {}", MAX_LINES[0]));
    }
    if !text.starts_with("//!") {
        report(1, "the file does not say what it is for (`//!`)".into());
    }
    // Tests may contain tables of samples.
    let longest = if path.starts_with("tests/") { MAX_LINES[2] + 10 } else { MAX_LINES[2] };
    for (line, length) in functions(&words).into_iter().filter(|(_, length)| *length > longest) {
        report(line, format!("a function of {length} lines is longer than {longest}"));
    }
    let module = module_of(path);
    let mut tests = test_ranges(&words);
    if path.ends_with("/tests.rs") || path.contains("/tests/") {
        // A file of tests.
        tests.push(0..words.len());
    }
    for (i, word) in words.iter().enumerate() {
        let next = words.get(i + 1).map_or("", |w| w.text);
        let in_path = next == ":" && words.get(i + 2).is_some_and(|w| w.text == ":");
        let tested = module.is_none() || tests.iter().any(|range| range.contains(&i));
        match word.text {
            "unsafe" if path != UNSAFE_FILE => report(word.line, "unsafe".into()),
            "todo" | "unimplemented" | "dbg" if next == "!" => report(word.line, format!("{}!", word.text)),
            "print" | "println" | "eprint" | "eprintln" if next == "!" && !tested => {
                report(word.line, "only the command line prints, through its own two functions".into());
            }
            "unwrap" if next == "(" && !tested => {
                report(word.line, "unwrap outside of tests; say why with expect".into())
            }
            "fs" | "File" | "OpenOptions"
                if (in_path || word.text == "fs")
                    && !tested
                    && !FILE_OWNERS.iter().any(|owner| path.starts_with(owner)) =>
            {
                report(word.line, "only files that own files touch the file system".into());
            }
            _ if NAMING.contains(&word.text) && is_vague(next) => {
                report(word.line, format!("`{next}` is a name that says nothing"));
            }
            name if module == Some("render")
                && !path.contains("/examples/")
                && HIDDEN_FROM_RENDER.contains(&name)
                && !tested =>
            {
                report(word.line, format!("the renderer sees no {name}, only what flattening makes of it"));
            }
            name if in_path || words.get(i.wrapping_sub(1)).is_some_and(|w| w.text == "use") => {
                for (owned, owners) in CRATES.iter().filter(|(owned, _)| of_crate(name, owned)) {
                    if module.is_some_and(|m| !owners.contains(&m)) {
                        report(word.line, format!("only {} may use {owned}", owners.join(" and ")));
                    }
                }
            }
            _ => {}
        }
    }
    if let Some(module) = module.filter(|module| PROGRAM.contains(module)) {
        for (at, used) in edges(path, &words) {
            // Tests may use every module.
            if tests.iter().any(|range| range.contains(&at)) {
                continue;
            }
            let line = words[at].line;
            let allowed = MODULES.iter().find(|(name, _)| *name == module).map(|(_, uses)| *uses);
            match allowed {
                None => report(line, format!("the module {module} stands in no table")),
                Some(uses) if used != module && !uses.contains(&used) => {
                    report(line, format!("{module} may not use {used}"));
                }
                _ => {}
            }
        }
    }
}

/// Refuses evaluators in the renderer, except in its tests.
fn evaluators(path: &str, text: &str, found: &mut Vec<String>) {
    if module_of(path) != Some("render") || path.ends_with("/tests.rs") || path.contains("/tests/") {
        return;
    }
    let words = tokens(text);
    let tests = test_ranges(&words);
    for (i, word) in words.iter().enumerate().filter(|(i, _)| !tests.iter().any(|range| range.contains(i))) {
        let parts = if word.text == "isolith_field" { named(&words, i + 1) } else { Vec::new() };
        for (_, part) in parts.into_iter().filter(|(_, part)| EVALUATORS.contains(part)) {
            found.push(format!("{path}:{}: the renderer may not use field::{part}: it never evaluates", word.line));
        }
    }
}

/// Whether `name` is the crate, or starts with its name (`egui_ltreeview` for `egui`).
fn of_crate(name: &str, owned: &str) -> bool {
    name.strip_prefix(owned).is_some_and(|rest| rest.is_empty() || rest.starts_with('_'))
}

/// The file's top-level module; `None` for the roots, the build script and files outside `src`.
pub fn module_of(path: &str) -> Option<&str> {
    if path == BUILD_SCRIPT {
        return None;
    }
    let name = path.strip_prefix("src/")?.split('/').next()?;
    let name = name.strip_suffix(".rs").unwrap_or(name);
    (name != "lib" && name != "main").then_some(name)
}

/// Line and length of every function.
fn functions(words: &[Token<'_>]) -> Vec<(usize, usize)> {
    let starts = words.iter().enumerate().filter(|(_, w)| w.text == "fn");
    starts
        .filter_map(|(i, word)| {
            let body = body_of(words, i)?;
            let end = closing(words, body);
            Some((word.line, words[end - 1].line - word.line + 1))
        })
        .collect()
}

/// The brace that opens the body of the function at `start`; `None` for a declaration. The `;` of an array type is in
/// brackets and does not end a declaration.
fn body_of(words: &[Token<'_>], start: usize) -> Option<usize> {
    let mut brackets = 0_usize;
    for (i, word) in words.iter().enumerate().skip(start) {
        match word.text {
            "[" => brackets += 1,
            "]" => brackets = brackets.saturating_sub(1),
            "{" if brackets == 0 => return Some(i),
            ";" if brackets == 0 => return None,
            _ => {}
        }
    }
    None
}

/// Ranges of the file that are tests: the bodies of modules behind `cfg(test)`.
pub fn test_ranges(words: &[Token<'_>]) -> Vec<std::ops::Range<usize>> {
    let is = |i: usize, text: &str| words.get(i).is_some_and(|w| w.text == text);
    (0..words.len())
        .filter(|i| is(*i, "cfg") && is(i + 1, "(") && is(i + 2, "test") && is(i + 3, ")"))
        .filter_map(|i| {
            let open = words[i..].iter().position(|w| w.text == "{")? + i;
            Some(open..closing(words, open))
        })
        .collect()
}

/// Every top-level module that the file names through `crate` or through `super`, with the index of its word.
pub fn edges<'a>(path: &str, words: &[Token<'a>]) -> Vec<(usize, &'a str)> {
    let segments = path.trim_start_matches("src/").trim_end_matches(".rs").trim_end_matches("/mod").split('/').count();
    let (mut out, mut brace_depth, mut inline) = (Vec::new(), 0_usize, Vec::new());
    let mut i = 0;
    while i < words.len() {
        match words[i].text {
            "{" => {
                if i >= 2 && words[i - 2].text == "mod" {
                    inline.push(brace_depth);
                }
                brace_depth += 1;
            }
            "}" => {
                brace_depth = brace_depth.saturating_sub(1);
                if inline.last() == Some(&brace_depth) {
                    inline.pop();
                }
            }
            "crate" => out.extend(named(words, i + 1)),
            "super" => {
                let mut climbed = 1;
                while words.get(i + 3).is_some_and(|w| w.text == "super") {
                    (i, climbed) = (i + 3, climbed + 1);
                }
                if climbed >= segments + inline.len() {
                    out.extend(named(words, i + 1));
                }
            }
            _ => {}
        }
        i += 1;
    }
    out
}

/// The names after the `::` at `at`: one, or those at the top level of a brace.
fn named<'a>(words: &[Token<'a>], at: usize) -> Vec<(usize, &'a str)> {
    if words.get(at).is_none_or(|w| w.text != ":") {
        return Vec::new();
    }
    match words.get(at + 2) {
        Some(open) if open.text == "{" => {
            let inside = at + 3..closing(words, at + 2) - 1;
            let (mut depth, mut fresh, mut out) = (0_usize, true, Vec::new());
            for i in inside {
                match words[i].text {
                    "{" => depth += 1,
                    "}" => depth -= 1,
                    "," if depth == 0 => fresh = true,
                    name if fresh && depth == 0 => {
                        out.push((i, name));
                        fresh = false;
                    }
                    _ => {}
                }
            }
            out
        }
        Some(name) => vec![(at + 2, name.text)],
        None => Vec::new(),
    }
}

fn wgsl(path: &str, text: &str, found: &mut Vec<String>) {
    let lines = text.lines().count();
    if lines > MAX_LINES[1] {
        found.push(format!("{path}:1: {lines} lines are more than {}", MAX_LINES[1]));
    }
    if !text.starts_with("//") {
        found.push(format!("{path}:1: the file does not say what it is for"));
    }
    // A function's name contains a word from its file's or folder's name: `sdf_sphere`, `shade_encode`.
    let inside = path.strip_prefix("shaders/").unwrap_or(path).trim_end_matches(".wgsl");
    let words = tokens(text);
    for (line, length) in functions(&words).into_iter().filter(|(_, length)| *length > MAX_LINES[3]) {
        found.push(format!("{path}:{line}: a function of {length} lines is longer than {}", MAX_LINES[3]));
    }
    for pair in words.windows(2).filter(|pair| pair[0].text == "fn") {
        let name = format!("_{}_", pair[1].text);
        let mut words = inside.split(['/', '_']).map(|word| word.trim_end_matches('s'));
        if !words.any(|word| name.contains(&format!("_{word}_")) || name.contains(&format!("_{word}s_"))) {
            found.push(format!("{path}:{}: `{}` does not carry the name of its file", pair[1].line, pair[1].text));
        }
    }
}
