//! Finds circles of files: files of one module that use each other, directly or through others.
//!
//! A path is a use of the file that defines its item; the search follows re-exports to that file. `mod` lines,
//! re-exports and tests are not uses.

use std::collections::{BTreeMap, BTreeSet};

use super::rules::{PROGRAM, test_ranges};
use super::source::{Token, tokens};

/// A path in segments, as written: `super::node::Node`.
type Path = Vec<String>;

/// Uses of a file, and its re-exports by name.
#[derive(Default)]
struct Uses {
    paths: Vec<Path>,
    exports: BTreeMap<String, Path>,
}

/// Every circle among `files` (path below `src/`, text), as sorted paths.
pub fn circles(files: &[(String, String)]) -> Vec<Vec<String>> {
    let modules: BTreeMap<Path, Uses> = files.iter().map(|(path, text)| (module(path), uses(path, text))).collect();
    let names: BTreeMap<Path, &String> = files.iter().map(|(path, _)| (module(path), path)).collect();
    let edges: BTreeMap<&Path, BTreeSet<&Path>> = modules
        .iter()
        .map(|(from, uses)| {
            let used = uses.paths.iter().filter_map(|path| resolve(&modules, from, path, 0));
            (from, used.filter(|to| *to != from && to.first() == from.first()).collect())
        })
        .collect();
    let mut rest: BTreeSet<&Path> = edges.keys().copied().filter(|m| !m.is_empty()).collect();
    let mut found = Vec::new();
    while let Some(start) = rest.pop_first() {
        let ahead = reached(&edges, start);
        let circle: Vec<&Path> = ahead.iter().copied().filter(|other| reached(&edges, other).contains(start)).collect();
        if circle.len() > 1 {
            found.push(circle.iter().map(|m| names[*m].clone()).collect());
            rest.retain(|other| !circle.contains(other));
        }
    }
    found
}

/// All nodes reachable from `start` by at least one edge.
fn reached<'a>(edges: &BTreeMap<&'a Path, BTreeSet<&'a Path>>, start: &Path) -> BTreeSet<&'a Path> {
    let (mut open, mut seen) = (vec![start], BTreeSet::new());
    while let Some(at) = open.pop() {
        for next in &edges[at] {
            if seen.insert(*next) {
                open.push(next);
            }
        }
    }
    seen
}

/// The module of a file: `flat/tape/mod.rs` is `flat::tape`.
fn module(path: &str) -> Path {
    let path = path.trim_end_matches(".rs").trim_end_matches("/mod");
    path.split('/').filter(|part| *part != "lib").map(str::to_owned).collect()
}

/// The file that `path`, written in `from`, refers to; `None` for other crates and local names.
fn resolve<'a>(modules: &'a BTreeMap<Path, Uses>, from: &Path, path: &[String], depth: usize) -> Option<&'a Path> {
    let absolute = absolute(modules, from, path).filter(|_| depth < 8)?;
    let length = (0..=absolute.len()).rev().find(|n| modules.contains_key(&absolute[..*n]))?;
    let (file, uses) = modules.get_key_value(&absolute[..length])?;
    let exported = absolute.get(length).and_then(|name| uses.exports.get(name));
    exported.and_then(|path| resolve(modules, file, path, depth + 1)).or(Some(file))
}

fn absolute(modules: &BTreeMap<Path, Uses>, from: &Path, path: &[String]) -> Option<Path> {
    match path.first()?.as_str() {
        // In a member of the workspace `crate` is the member's own root.
        "crate" if from.first().is_some_and(|top| !PROGRAM.contains(&top.as_str())) => {
            Some([&from[..1], &path[1..]].concat())
        }
        "crate" => Some(path[1..].to_vec()),
        "super" | "self" => {
            let mut base = from.clone();
            let climbs = path.iter().take_while(|part| ["super", "self"].contains(&part.as_str())).count();
            for part in &path[..climbs] {
                if part == "super" {
                    base.pop()?;
                }
            }
            Some([&base[..], &path[climbs..]].concat())
        }
        child => {
            let own = [&from[..], &[child.to_owned()]].concat();
            modules.contains_key(&own).then(|| [&from[..], path].concat())
        }
    }
}

fn uses(path: &str, text: &str) -> Uses {
    let words = tokens(text);
    let tests = test_ranges(&words);
    let mut out = Uses::default();
    if path.ends_with("/tests.rs") || path.contains("/tests/") {
        return out;
    }
    let mut i = 0;
    while i < words.len() {
        if let Some(range) = tests.iter().find(|range| range.contains(&i)) {
            i = range.end;
        } else if words[i].text == "use" {
            let end = i + words[i..].iter().position(|w| w.text == ";").unwrap_or(words.len() - i);
            let is_export = is_public(&words[..i]);
            for (path, name) in tree(&words[i + 1..end], &[]) {
                if is_export {
                    out.exports.insert(name, path);
                } else {
                    out.paths.push(path);
                }
            }
            i = end;
        } else {
            let (path, length) = path_at(&words[i..]);
            if path.len() > 1 {
                out.paths.push(path);
            }
            i += length.max(1);
        }
    }
    out
}

/// Whether the words before a `use` end with `pub` or `pub(...)`.
fn is_public(before: &[Token<'_>]) -> bool {
    let last = |n: usize| before.len().checked_sub(n).map_or("", |i| before[i].text);
    last(1) == "pub" || (last(1) == ")" && (last(4) == "pub" || last(5) == "pub"))
}

/// The path at the start of `words`, and its length in words.
fn path_at(words: &[Token<'_>]) -> (Path, usize) {
    let is_name = |w: &Token<'_>| w.text.starts_with(|c: char| c.is_alphabetic() || c == '_');
    let is_colon = |i: usize| words.get(i).is_some_and(|w| w.text == ":");
    let (mut path, mut i) = (Path::new(), 0);
    while words.get(i).is_some_and(is_name) {
        path.push(words[i].text.to_owned());
        i += 1;
        if !(is_colon(i) && is_colon(i + 1)) {
            break;
        }
        i += 2;
    }
    (path, i)
}

/// Every path of a `use`, with the name that it introduces.
fn tree(words: &[Token<'_>], before: &[String]) -> Vec<(Path, String)> {
    let (path, taken) = path_at(words);
    let path = [before, &path[..]].concat();
    match words.get(taken).map(|w| w.text) {
        Some("{") => {
            let (mut depth, mut start, mut out) = (0, taken + 1, Vec::new());
            for i in taken..words.len() {
                match words[i].text {
                    "{" => depth += 1,
                    "}" => depth -= 1,
                    _ => {}
                }
                if (words[i].text == "," && depth == 1) || depth == 0 {
                    out.extend(tree(&words[start..i], &path));
                    start = i + 1;
                }
                if depth == 0 {
                    break;
                }
            }
            out
        }
        _ => {
            // `a as b` is the three words `a`, `as`, `b`.
            let renamed = words.iter().position(|w| w.text == "as").and_then(|i| words.get(i + 1));
            let Some(last) = path.iter().rev().find(|part| *part != "self") else { return Vec::new() };
            vec![(path.clone(), renamed.map_or(last.clone(), |w| w.text.to_owned()))]
        }
    }
}

#[test]
fn circles_are_found_through_reexports_and_braces() {
    let files =
        |list: &[(&str, &str)]| list.iter().map(|(p, t)| ((*p).to_owned(), (*t).to_owned())).collect::<Vec<_>>();
    let root = ("m/mod.rs", "mod a; mod b; mod c; pub use a::A; pub use b::{B, deep::{D as E}};");
    let circle = files(&[root, ("m/a.rs", "use super::{E, c::C};"), ("m/b.rs", "use crate::A;"), ("m/c.rs", "")]);
    assert_eq!(circles(&circle), [["m/a.rs", "m/b.rs"]]);
    let by_path =
        files(&[root, ("m/a.rs", "fn f() { super::c::g() }"), ("m/b.rs", ""), ("m/c.rs", "fn g() { super::a::f() }")]);
    assert_eq!(circles(&by_path), [["m/a.rs", "m/c.rs"]]);
    let parent = files(&[("m/mod.rs", "mod a; struct S; fn f() { a::g() }"), ("m/a.rs", "use super::S;")]);
    assert_eq!(circles(&parent), [["m/mod.rs", "m/a.rs"]]);
}

#[test]
fn uses_in_tests_and_towards_other_modules_make_no_circle() {
    let one_way = [
        ("m/mod.rs", "mod a; mod b; pub use a::A;"),
        ("m/a.rs", "use super::b::B; #[cfg(test)] mod tests { use super::super::b::x; }"),
        ("m/b.rs", "struct B; #[cfg(test)] mod tests { use crate::a::A; }"),
        ("n.rs", "use crate::m::A;"),
    ];
    assert!(circles(&one_way.map(|(p, t)| (p.to_owned(), t.to_owned()))).is_empty());
}
