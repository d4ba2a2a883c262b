//! Which files of a module import which, and whether that comes back to where it began.

use super::source::{Token, closing, tokens};

/// The modules whose files import each other by file and in no circle. What a module's root re-exports is for outsiders.
pub const WITHOUT_CIRCLES: &[&str] = &["src/editor", "src/session"];

/// The root of a module, as a file that others import from.
const ROOT: &str = "mod";

/// Files that import each other in a circle, as text; nothing where there are none. `files` are names relative to `folder`
/// without their ending, with texts.
pub fn circle(folder: &str, files: &[(String, String)]) -> Option<String> {
    let names: Vec<String> = files.iter().map(|(name, _)| name.clone()).collect();
    let uses = |name: &str| -> Vec<String> {
        // A root declares all files, so whoever imports from it is in a circle with it.
        if name == ROOT {
            return names.iter().filter(|other| *other != ROOT).cloned().collect();
        }
        let text = files.iter().find(|(other, _)| other == name).map_or("", |(_, text)| text);
        imports(folder, name, text, &names)
    };
    let mut done: Vec<String> = Vec::new();
    for start in names.iter().filter(|name| *name != ROOT) {
        // Each with those it uses that are still to be visited.
        let mut chain = vec![(start.clone(), uses(start))];
        while let Some((name, rest)) = chain.last_mut() {
            let Some(next) = rest.pop() else {
                done.push(name.clone());
                chain.pop();
                continue;
            };
            if let Some(at) = chain.iter().position(|(name, _)| *name == next) {
                let names: Vec<_> = chain[at..].iter().map(|(name, _)| &**name).chain([&*next]).collect();
                return Some(format!("{folder}: {}", names.join(" uses ")));
            }
            if !done.contains(&next) {
                let used = uses(&next);
                chain.push((next, used));
            }
        }
    }
    None
}

/// The files of its own module that a file imports from, tests left out.
pub fn imports(folder: &str, name: &str, text: &str, names: &[String]) -> Vec<String> {
    let text = text.split("#[cfg(test)]").next().unwrap_or(text);
    let words = tokens(text);
    let module = folder.trim_start_matches("src/");
    let own: Vec<&str> = name.trim_end_matches("/mod").split('/').collect();
    let mut found = Vec::new();
    let mut i = 0;
    while i < words.len() {
        let (start, mut climbed) = (i, 0);
        while words.get(i).is_some_and(|word| word.text == "super") && is_path(&words, i + 1) {
            (i, climbed) = (i + 3, climbed + 1);
        }
        let is_whole = words[start].text == "crate" && is_path(&words, start + 1);
        if climbed > 0 && climbed <= own.len() {
            let base = &own[..own.len() - climbed];
            found.extend(paths(&words, i).iter().filter_map(|path| resolved(&[base, &path[..]].concat(), name, names)));
        } else if is_whole && words.get(start + 3).is_some_and(|word| word.text == module) && is_path(&words, start + 4)
        {
            found.extend(paths(&words, start + 6).iter().filter_map(|path| resolved(path, name, names)));
        }
        i = i.max(start + 1);
    }
    found.sort();
    found.dedup();
    found
}

fn is_path(words: &[Token<'_>], at: usize) -> bool {
    let is_colon = |i: usize| words.get(i).is_some_and(|word| word.text == ":");
    is_colon(at) && is_colon(at + 1)
}

/// All paths that begin at `at`, with their braces taken apart.
fn paths<'a>(words: &[Token<'a>], at: usize) -> Vec<Vec<&'a str>> {
    let Some(word) = words.get(at) else {
        return Vec::new();
    };
    if word.text != "{" {
        if !is_path(words, at + 1) {
            return vec![vec![word.text]];
        }
        let rest = paths(words, at + 3);
        return rest.into_iter().map(|rest| [&[word.text][..], &rest].concat()).collect();
    }
    let end = closing(words, at) - 1;
    let (mut out, mut i) = (Vec::new(), at + 1);
    while i < end {
        out.extend(paths(words, i));
        let mut depth = 0_usize;
        while i < end && (depth > 0 || words[i].text != ",") {
            match words[i].text {
                "{" => depth += 1,
                "}" => depth -= 1,
                _ => {}
            }
            i += 1;
        }
        i += 1;
    }
    out
}

/// The file that holds what the path names: itself is nothing, and what no file holds is the root's.
fn resolved(path: &[&str], name: &str, names: &[String]) -> Option<String> {
    let path: Vec<&str> = path.iter().copied().filter(|part| *part != "self").collect();
    let files =
        (1..=path.len()).rev().flat_map(|end| [path[..end].join("/"), format!("{}/mod", path[..end].join("/"))]);
    let file = files.into_iter().find(|file| names.contains(file)).unwrap_or_else(|| ROOT.into());
    (file != name).then_some(file)
}
