//! The parameters of shapes and modifiers in WGSL: structs with the names of their tables, and their reading from rows.
//!
//! | generated file | has |
//! |---|---|
//! | `generated/params/LinkParams.wgsl` | the struct; a shape's file includes it |
//! | `generated/load/LinkParams.wgsl` | `link_params(row)`, which reads it from the scene's rows from `row` on |
//!
//! Straight-line code knows the rows by name and builds the struct from these, see [`constructed`].

use std::fmt::Write as _;

use isolith_field::modifier_layout;
use isolith_scene::{MemberType, ModifierKind, ParamLayout, ShapeKind};

/// The text of a generated file, by its path.
pub fn params_file(path: &str) -> Option<String> {
    let (folder, name) = path.strip_prefix("generated/")?.strip_suffix(".wgsl")?.split_once('/')?;
    let text = match folder {
        "params" => struct_wgsl,
        "load" => load_wgsl,
        _ => return None,
    };
    let shapes = ShapeKind::ALL.iter().map(|kind| kind.eval_layout());
    let mut layouts = shapes.chain(ModifierKind::ALL.iter().map(|kind| modifier_layout(*kind)));
    // WGSL has no struct without members.
    let layout = layouts.find_map(|layout| named(layout, name)).filter(|layout| !layout.members.is_empty())?;
    Some(text(&layout))
}

/// The layout of this name: the given one, or one within it.
fn named(layout: ParamLayout, name: &str) -> Option<ParamLayout> {
    let inner = |ty| if let MemberType::Struct(inner) = ty { named(*inner, name) } else { None };
    if layout.name == name { Some(layout) } else { layout.members.iter().find_map(|member| inner(member.ty)) }
}

/// The name of a member's type.
fn type_name(ty: MemberType) -> &'static str {
    match ty {
        MemberType::Number => "f32",
        MemberType::Count => "u32",
        MemberType::Pair => "vec2f",
        MemberType::Vector => "vec3f",
        MemberType::Struct(layout) => layout.name,
    }
}

/// The struct, in one line.
fn struct_wgsl(layout: &ParamLayout) -> String {
    let mut out = String::new();
    for member in layout.members {
        if let MemberType::Struct(inner) = member.ty {
            writeln!(out, "{}", include(inner)).expect("strings take all");
        }
    }
    let members: Vec<_> =
        layout.members.iter().map(|member| format!("{}: {}", member.name, type_name(member.ty))).collect();
    out + &format!("struct {} {{ {} }}\n", layout.name, members.join(", "))
}

/// The line that includes a struct.
pub fn include(layout: &ParamLayout) -> String {
    format!("#include \"generated/params/{}.wgsl\"", layout.name)
}

/// The function that reads a struct from the scene's rows.
fn load_wgsl(layout: &ParamLayout) -> String {
    let rows: String = (0..layout.rows()).map(|i| format!("    let r{i} = scene_row(row + {i}u);\n")).collect();
    let (function, name) = (load_function(layout), layout.name);
    let value = constructed(layout, &|i| format!("r{i}"));
    format!("fn {function}(row: u32) -> {name} {{\n{rows}    return {value};\n}}\n")
}

/// The line that includes the function which reads a struct; empty for one without members.
pub fn load_include(layout: &ParamLayout) -> String {
    if layout.members.is_empty() { String::new() } else { format!("#include \"generated/load/{}.wgsl\"", layout.name) }
}

/// The name of the function that reads a struct.
fn load_function(layout: &ParamLayout) -> String {
    let mut out = String::new();
    for letter in layout.name.chars() {
        if letter.is_uppercase() && !out.is_empty() {
            out.push('_');
        }
        out.extend(letter.to_lowercase());
    }
    out
}

/// A struct read from the scene's rows, as a further argument of a function; empty for one without members, which the
/// function does not take.
pub fn loaded(layout: &ParamLayout, row: &str) -> String {
    if layout.members.is_empty() { String::new() } else { format!(", {}({row})", load_function(layout)) }
}

/// A struct built from rows, as a further argument of a function; empty for one without members. `row` returns the name
/// of each row.
pub fn built(layout: &ParamLayout, row: &dyn Fn(usize) -> String) -> String {
    if layout.members.is_empty() { String::new() } else { format!(", {}", constructed(layout, row)) }
}

/// The constructor of a struct from its rows; `row` returns the name of each.
pub fn constructed(layout: &ParamLayout, row: &dyn Fn(usize) -> String) -> String {
    constructed_from(layout, 0, row)
}

/// The constructor of a struct whose first number is at `first`.
fn constructed_from(layout: &ParamLayout, first: usize, row: &dyn Fn(usize) -> String) -> String {
    let places = layout.places();
    let members = layout.members.iter().zip(places).map(|(member, place)| {
        let at = first + place;
        let numbers = format!("{}.{}", row(at / 4), &"xyzw"[at % 4..][..member.ty.floats()]);
        match member.ty {
            MemberType::Number | MemberType::Pair | MemberType::Vector => numbers,
            MemberType::Count => format!("u32({numbers})"),
            MemberType::Struct(inner) => constructed_from(inner, at, row),
        }
    });
    format!("{}({})", layout.name, members.collect::<Vec<_>>().join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dual::Machine;
    use crate::files::library;
    use isolith_field::{for_each_modifier_params, modifier_params};
    use isolith_scene::{EvalParams, for_each_shape, shape_params};

    /// The function that reads these parameters, with all that it needs. The rows hold 1, 2, 3 and so on.
    fn reading(layout: &ParamLayout) -> String {
        let text =
            |folder: &str| library(&format!("generated/{folder}/{}.wgsl", layout.name)).expect("it is generated");
        let row = "fn scene_row(at: u32) -> vec4f { return f32(4u * at) + vec4f(1.0, 2.0, 3.0, 4.0); }";
        format!("{}{}{row}", text("params"), text("load"))
    }

    /// Whether the text reads what Rust packs.
    fn agrees<P: EvalParams>(text: &str) -> bool {
        let mut packed = Vec::new();
        P::read(|at| at as f64 + 1.0).write(|_, number| packed.push(number));
        Machine::new(text).members(&load_function(&P::LAYOUT), &[&[0.0]]) == packed
    }

    fn check<P: EvalParams>() {
        let layout = P::LAYOUT;
        if layout.members.is_empty() {
            return;
        }
        let text = reading(&layout);
        assert!(agrees::<P>(&text), "{text}");
        // It must fail if a number stands elsewhere.
        let moved = text.replacen("r0.x", "r0.y", 1);
        assert!(moved == text || !agrees::<P>(&moved), "{moved}");
        // The names are those of the table.
        for member in layout.members {
            assert!(text.contains(&format!(" {}: {}", member.name, type_name(member.ty))), "{text}");
        }
    }

    macro_rules! check_shapes {
        ($( $name:ident = $function:ident($params:ident) $(with $data:ident)?, )+) => {
            $( check::<shape_params::$params>(); )+
        };
    }

    macro_rules! check_modifiers {
        ($($params:ident)+) => {{
            $( check::<modifier_params::$params>(); )+
            [$( stringify!($params) ),+]
        }};
    }

    #[test]
    fn wgsl_reads_what_rust_packs() {
        for_each_shape!(check_shapes);
        let checked = for_each_modifier_params!(check_modifiers);
        let named = ModifierKind::ALL.iter().map(|kind| modifier_layout(*kind).name);
        assert_eq!(named.filter(|name| *name != "NoParams").collect::<Vec<_>>(), checked);
    }

    #[test]
    fn a_struct_and_its_reading_have_the_names_of_the_table() {
        let star = ShapeKind::Star.eval_layout();
        assert_eq!(
            library("generated/params/StarParams.wgsl").expect("it is generated"),
            "struct PolygonSides { count: f32, cosine: f32, sine: f32 }\nstruct StarParams { points: PolygonSides, \
             outer_radius: f32, inner_radius: f32, height: f32, rounding: f32 }\n"
        );
        let built = built(&star, &|i| format!("q{}", 7 + i));
        assert_eq!(built, ", StarParams(PolygonSides(q7.x, q7.y, q7.z), q7.w, q8.x, q8.y, q8.z)");
        assert_eq!(loaded(&star, "row"), ", star_params(row)");
        assert_eq!(loaded(&ShapeKind::Plane.eval_layout(), "row"), "");
        assert!(params_file("generated/params/NoParams.wgsl").is_none());
    }
}
