//! The functions of shapes and modifiers together with their gradients; derived once, however many pipelines hold
//! them.

use std::collections::BTreeMap;
use std::sync::{LazyLock, Mutex, PoisonError};

use super::assemble::assemble_plain;
use super::dual::dual;

/// A shape's function, or one about a modifier (see [`super::modifiers`]), with its gradient.
pub fn gradient_wgsl(function: &str) -> Option<String> {
    static DERIVED: LazyLock<Mutex<BTreeMap<String, String>>> = LazyLock::new(Mutex::default);
    let mut derived = DERIVED.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(text) = derived.get(function) {
        return Some(text.clone());
    }
    // What has no derivative has no pipeline; a test derives every one.
    let text = match function.strip_prefix("sdf_") {
        Some(shape) => dual(&with_rows(assemble_plain(&format!("sdf/{shape}.wgsl")).ok()?), function).ok()?,
        None => super::modifiers::derived(function)?,
    };
    derived.insert(function.to_owned(), text.clone());
    Some(text)
}

/// A source with something that stands for the data it reads; their derivative is zero.
pub(super) fn with_rows(text: String) -> String {
    if !text.contains("scene_row(") {
        return text;
    }
    format!("{text}\nfn scene_row(at: u32) -> vec4f {{ return vec4f(f32(at)); }}\n")
}
