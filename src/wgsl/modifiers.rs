//! WGSL of modifiers: the `switch` over their codes, and their gradients.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use super::params::{load_include, loaded};
use isolith_field::{FlatNode, changes_value, is_copying, modifier_layout, modifier_payload_row, moves_point};
use isolith_scene::ModifierKind;

/// The name of a modifier's file.
pub fn file(kind: ModifierKind) -> String {
    format!("{kind:?}").to_lowercase()
}

/// The line that includes a modifier's functions.
pub fn modifier_include(kind: ModifierKind) -> String {
    format!("#include \"mod/{}.wgsl\"", file(kind))
}

/// The generated file that selects a modifier's functions by its code.
pub fn modifiers_wgsl(modifiers: &BTreeSet<ModifierKind>) -> String {
    let mut out = String::new();
    for kind in modifiers {
        line(&mut out, &modifier_include(*kind));
        line(&mut out, &load_include(&modifier_layout(*kind)));
    }
    line(&mut out, "const NO_COPY: u32 = 0xffffffffu;");
    let copying = |kind: &ModifierKind| is_copying(*kind);
    let moving = |kind: &ModifierKind| moves_point(*kind);
    let changing = |kind: &ModifierKind| changes_value(*kind);
    let call = |name: &'static str, first: &'static str| {
        move |kind: ModifierKind| format!("mod_{}_{name}({})", file(kind), arguments(kind, first))
    };
    let of = |test: &dyn Fn(&ModifierKind) -> bool| modifiers.iter().copied().filter(|k| test(k)).collect::<Vec<_>>();
    choice(&mut out, "modifier_count(kind: u32, row: u32) -> u32", "1u", &of(&copying), &call("count", ""));
    let start = "modifier_start(kind: u32, p: vec3f, row: u32) -> f32";
    choice(&mut out, start, "3e38", &of(&copying), &call("start", "p"));
    let bound = "modifier_bound(kind: u32, p: vec3f, k: u32, row: u32) -> f32";
    choice(&mut out, bound, "-3e38", &of(&copying), &call("bound", "p, k"));
    let scale = "modifier_scale(kind: u32, k: u32, row: u32) -> f32";
    choice(&mut out, scale, "1.0", &of(&copying), &call("scale", "k"));
    let point = "modifier_point(kind: u32, p: vec3f, k: u32, row: u32) -> vec3f";
    choice(&mut out, point, "p", &of(&moving), &call("point", "p, k"));
    let value = "modifier_value(kind: u32, f: f32, p: vec3f, row: u32) -> f32";
    choice(&mut out, value, "f", &of(&changing), &call("value", "f, p"));
    line(&mut out, "#include \"field/modifier.wgsl\"");
    out
}

/// The generated file that passes gradients through modifiers.
pub fn modifier_gradients_wgsl(modifiers: &BTreeSet<ModifierKind>) -> String {
    let mut out = String::new();
    let moving: Vec<_> = modifiers.iter().copied().filter(|k| moves_point(*k)).collect();
    let changing: Vec<_> = modifiers.iter().copied().filter(|k| changes_value(*k)).collect();
    for kind in &moving {
        line(&mut out, &format!("#include \"generated/dual/pull_mod_{}.wgsl\"", file(*kind)));
    }
    for kind in &changing {
        line(&mut out, &format!("#include \"generated/dual/along_mod_{}.wgsl\"", file(*kind)));
        line(&mut out, &format!("#include \"generated/dual/through_mod_{}.wgsl\"", file(*kind)));
    }
    let pull = |kind| format!("dual_pull_mod_{}({}).xyz", file(kind), arguments(kind, "p, v, k"));
    let name = "modifier_pull(kind: u32, p: vec3f, k: u32, v: vec3f, row: u32) -> vec3f";
    choice(&mut out, name, "v", &moving, &pull);
    let slopes = |kind| {
        let along = format!("dual_along_mod_{}({}).xyz", file(kind), arguments(kind, "p, f"));
        let through = format!("dual_through_mod_{}({}).x", file(kind), arguments(kind, "vec3f(f, 0.0, 0.0), p"));
        format!("vec4f({along}, {through})")
    };
    let name = "modifier_slopes(kind: u32, f: f32, p: vec3f, row: u32) -> vec4f";
    choice(&mut out, name, "vec4f(0.0, 0.0, 0.0, 1.0)", &changing, &slopes);
    out
}

/// The arguments of a modifier's function: `first`, its parameters, read from their rows, and the start of its payload
/// rows.
fn arguments(kind: ModifierKind, first: &str) -> String {
    let params = loaded(&modifier_layout(kind), "row");
    let data =
        modifier_payload_row(kind).map_or(String::new(), |i| format!(", row + {i}u + u32(scene_row(row + {i}u).y)"));
    format!("{first}{params}{data}").trim_start_matches(", ").to_owned()
}

/// A function that selects among the calls of the modifiers.
fn choice(
    out: &mut String,
    signature: &str,
    otherwise: &str,
    kinds: &[ModifierKind],
    call: &dyn Fn(ModifierKind) -> String,
) {
    line(out, &format!("fn {signature} {{\n    switch kind {{"));
    for kind in kinds {
        let code = FlatNode::MODIFIER + *kind as u32;
        line(out, &format!("        case {code}u: {{ return {}; }}", call(*kind)));
    }
    line(out, &format!("        default: {{ return {otherwise}; }}\n    }}\n}}"));
}

fn line(out: &mut String, text: &str) {
    writeln!(out, "{text}").expect("strings take all");
}
