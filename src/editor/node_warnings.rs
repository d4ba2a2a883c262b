//! What is wrong with single nodes: models that are missing, fields that are not as they should be, what is left out.

use std::collections::HashMap;

use super::state::EditorState;
use isolith_scene::NodeId;

/// The most important warning of the scene, with its node.
pub fn first(state: &EditorState) -> Option<(NodeId, String)> {
    if let Some(problem) = state.derived.model_problem() {
        return Some(problem.clone());
    }
    if let Some(problem) = state.derived.field_problem(&state.session.document) {
        return Some(problem);
    }
    let warnings = &state.flat().warnings;
    let first = warnings.first()?;
    let more = if warnings.len() > 1 { format!(" (+{})", warnings.len() - 1) } else { String::new() };
    Some((first.node, format!("{}: {}{more}", first.name, first.reason)))
}

/// The nodes that have one, for their rows.
pub fn all(state: &EditorState) -> HashMap<NodeId, String> {
    let warnings = state.flat().warnings.iter().map(|warning| (warning.node, warning.reason.clone()));
    let of_fields = state.derived.field_problem(&state.session.document);
    warnings.chain(of_fields).chain(state.derived.model_problems()).collect()
}
