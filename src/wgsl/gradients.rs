//! The functions of shapes and modifiers together with their gradients. Each is derived once, however many pipelines
//! contain it.

use std::collections::BTreeMap;
use std::sync::{LazyLock, Mutex, PoisonError};

use super::dual::dual;
use super::files::library;
use super::modifiers::file;
use super::params::include;
use isolith_field::{modifier_layout, modifier_payload_row};
use isolith_scene::{ModifierKind, ShapeKind};

/// The function of a shape, or one of a modifier (see [`modifier_gradient`]), with its gradient.
pub fn gradient_wgsl(function: &str) -> Option<String> {
    static DERIVED: LazyLock<Mutex<BTreeMap<String, String>>> = LazyLock::new(Mutex::default);
    let mut derived = DERIVED.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(text) = derived.get(function) {
        return Some(text.clone());
    }
    if function == ShapeKind::MeshField.function() {
        // Its derivative is not what is wanted, see there.
        return library("sdf/mesh_field_gradient.wgsl").ok();
    }
    // Functions without a derivative have no pipeline; a test derives all of them.
    let text = match function.strip_prefix("sdf_") {
        Some(shape) => dual(&with_rows(library(&format!("sdf/{shape}.wgsl")).ok()?), function).ok()?,
        None => modifier_gradient(function)?,
    };
    derived.insert(function.to_owned(), text.clone());
    Some(text)
}

/// A source with placeholders for the rows it reads, whose derivative is zero.
pub(super) fn with_rows(text: String) -> String {
    let mut text = text;
    for (read, placeholder) in [
        ("scene_row(", "fn scene_row(at: u32) -> vec4f { return vec4f(f32(at)); }"),
        ("bricks_texel(", "fn bricks_texel(at: u32) -> vec4u { return vec4u(at); }"),
    ] {
        if text.contains(read) {
            text = format!("{text}\n{placeholder}\n");
        }
    }
    text
}

/// The derivatives of one of three functions of a modifier: `pull_mod_x` (the point in the copy along a vector),
/// `along_mod_x` (the value by the point), `through_mod_x` (the value by the field of the content).
fn modifier_gradient(function: &str) -> Option<String> {
    let (way, name) = function.split_once("_mod_")?;
    let kind = ModifierKind::ALL.iter().copied().find(|kind| file(*kind) == name)?;
    // All three may differentiate the same function by different arguments, so each has its own copy of the source.
    let text = renamed(&library(&format!("mod/{name}.wgsl")).ok()?, &format!("{way}_{name}"));
    let (structs, text): (Vec<_>, Vec<_>) = text.lines().partition(|line| line.starts_with("struct "));
    let text = text.into_iter().filter(|line| !line.starts_with("const ")).collect::<Vec<_>>().join("\n");
    let layout = modifier_layout(kind);
    let [rows, passed] = match modifier_payload_row(kind) {
        Some(_) => [format!(", q: {}, data: u32", layout.name), ", q, data".to_owned()],
        None => [format!(", q: {}", layout.name), ", q".to_owned()],
    };
    let wrapper = match way {
        "pull" => format!(
            "fn {function}(p: vec3f, v: vec3f, k: u32{rows}) -> f32 {{\n    return dot(v, \
             mod_{name}_point_pull_{name}(p, k{passed}));\n}}\n"
        ),
        "along" => format!(
            "fn {function}(p: vec3f, f: f32{rows}) -> f32 {{\n    return mod_{name}_value_along_{name}(f, p{passed});\n}}\n"
        ),
        "through" => format!(
            "fn {function}(f: vec3f, p: vec3f{rows}) -> f32 {{\n    return mod_{name}_value_through_{name}(f.x, \
             p{passed});\n}}\n"
        ),
        _ => return None,
    };
    let source = format!("{text}\n{wrapper}");
    let derived = dual(&with_rows(format!("{}\n{source}", structs.join("\n"))), function).ok()?;
    Some(format!("{}\n{source}{derived}", include(&layout)))
}

/// The source with `_suffix` appended to the name of each function.
fn renamed(source: &str, suffix: &str) -> String {
    let mut names: Vec<&str> = source.lines().filter_map(|line| line.strip_prefix("fn ")?.split('(').next()).collect();
    // Longer names first, since a name may start with another.
    names.sort_unstable_by_key(|name| std::cmp::Reverse(name.len()));
    names.iter().fold(source.to_owned(), |text, name| text.replace(&format!("{name}("), &format!("{name}_{suffix}(")))
}
