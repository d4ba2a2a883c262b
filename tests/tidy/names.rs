//! Names: a public type is defined once in the project, and words that were retired do not come back.

use std::collections::BTreeMap;

use super::rules::test_ranges;
use super::source::tokens;

/// Every word that was replaced, and the one that stands for it now. Identifiers only: in sentences many of them are
/// ordinary words.
pub const RETIRED: &[(&str, &str)] = &[];

/// Every retired word in a source text, as `path:line: what`. Parts of longer names count: `is_carver`.
pub fn retired(path: &str, text: &str) -> Vec<String> {
    tokens(text)
        .iter()
        .filter_map(|word| {
            let (old, new) = RETIRED.iter().find(|(old, _)| *old == word.text)?;
            Some(format!("{path}:{}: `{old}` is called `{new}`", word.line))
        })
        .collect()
}

/// Every public type that more than one file defines, with the files.
pub fn defined_twice(files: &[(String, String)]) -> Vec<(String, Vec<String>)> {
    let mut places: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for (path, text) in files {
        let words = tokens(text);
        let tests = test_ranges(&words);
        for i in 0..words.len() {
            let is_type = ["struct", "enum", "trait", "type", "union"].contains(&words[i].text);
            let is_public = i > 0 && words[i - 1].text == "pub" && !tests.iter().any(|range| range.contains(&i));
            if is_type
                && is_public
                && let Some(name) = words.get(i + 1)
            {
                places.entry(name.text.to_owned()).or_default().push(path.clone());
            }
        }
    }
    places.into_iter().filter(|(_, paths)| paths.len() > 1).collect()
}

#[test]
fn types_that_are_defined_twice_are_found() {
    let files = [("a.rs", "pub struct Row; struct Own;"), ("b.rs", "pub enum Row {} pub enum Own {}")];
    let files = files.map(|(path, text)| (path.to_owned(), text.to_owned()));
    assert_eq!(defined_twice(&files), [("Row".to_owned(), vec!["a.rs".to_owned(), "b.rs".to_owned()])]);
}
