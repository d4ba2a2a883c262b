//! Names: the project defines a public type once, and retired words do not come back.

use std::collections::BTreeMap;

use super::rules::test_ranges;
use super::source::tokens;

/// Every retired word with its replacement. Applies to identifiers only: in sentences many of them are ordinary words.
pub const RETIRED: &[(&str, &str)] = &[
    ("twin", "eval"),
    ("Truth", "ReferenceImage"),
    ("Enclosure", "LowerBound"),
    ("Joining", "BlendOverride"),
    ("FIRST_FURTHER_KERNEL", "FIRST_EXTENDED_KERNEL"),
    ("leaf_data", "leaf_payload"),
    ("data_row", "payload_row"),
    ("bystander", "add_non_field"),
    ("Hitee", "HitTarget"),
    ("Look", "ViewMode"),
    ("Pruner", "TapeCache"),
    ("pruner", "tape_cache"),
    ("Carver", "CellTreeBuilder"),
    ("TokenOp", "TapeOp"),
    ("trees_so_far", "ready_trees"),
    ("take_back", "requeue"),
    ("Skipping", "SkipMode"),
    ("Walker", "InterpreterPipelines"),
    ("any_leaf", "generic_leaf"),
    ("Effort", "Cost"),
    ("Warmer", "Prewarmer"),
    ("meet_kernels", "prewarm"),
    ("RowTexture", "DataTexture"),
    ("Workbench", "EditSession"),
    ("workbench", "session"),
    ("Sheet", "MultiEdit"),
    ("Answer", "FieldResponse"),
    ("Keeper", "ParamTarget"),
    ("silhouettes", "shape_icons"),
    ("Palette", "CommandPalette"),
    ("Canvas", "ViewportRenderer"),
    ("Wanted", "RenderRequest"),
    ("under_way", "in_flight"),
    ("Stage", "SceneBuilder"),
    ("Subject", "BenchScene"),
    ("Figures", "Metrics"),
    ("worn_by", "material_of"),
    ("Kernels", "PipelineCache"),
    ("Method", "EvalStrategy"),
    ("Way", "Baseline"),
    ("Plan", "FramePlan"),
    ("Forms", "Templates"),
    ("Spread", "Distribution"),
    ("Span", "DepthRange"),
    ("relief", "heightfield"),
    ("Own", "TapeStats"),
    ("Specialised", "Specialized"),
    ("Cancelled", "Canceled"),
    ("AnyLeaf", "generic_leaf"),
    ("NO_OWNER", "NOT_VISIBLE"),
    ("LEAPS_FAR", "VERIFIED_OVERSTEP"),
    ("may_leap", "may_overstep"),
    ("Took", "TraceCounts"),
    ("KERNEL_WINDOW", "PIPELINE_WINDOW"),
];
/// British stems that no identifier may contain.
const BRITISH: &[(&str, &str)] = &[
    ("colour", "color"),
    ("centre", "center"),
    ("metre", "meter"),
    ("neighbour", "neighbor"),
    ("grey", "gray"),
    ("specialise", "specialize"),
    ("behaviour", "behavior"),
];

/// Every retired word in a source text, as `path:line: what`.
pub fn retired(path: &str, text: &str) -> Vec<String> {
    tokens(text)
        .iter()
        .filter_map(|word| {
            let lower = word.text.to_lowercase();
            let whole = RETIRED.iter().find(|(old, _)| *old == word.text);
            let (old, new) = whole.or_else(|| BRITISH.iter().find(|(old, _)| lower.contains(old)))?;
            Some(format!("{path}:{}: `{}`: not {old} but {new}", word.line, word.text))
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
                && let Some(name) = words.get(i + 1).filter(|name| name.text != "$")
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

#[test]
fn retired_words_are_found_in_code_only() {
    let old = RETIRED[0].0;
    assert_eq!(retired("a.wgsl", &format!("fn f() {{ {old}(); }}")).len(), 1);
    assert_eq!(retired("a.rs", &format!("fn {}_of() {{}}", ["neigh", "bour"].concat())).len(), 1);
    assert!(retired("a.rs", &format!("// {old}\nfn {old}_like() {{ \"{old}\" }}")).is_empty());
}
