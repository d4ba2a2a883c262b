//! Calls of the functions of shapes: their include lines, their arguments, and the `switch` among them.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use super::op_set::OpSet;
use super::options::SkipMode;
use super::params::{built, load_include, loaded};
use super::structure::{ShapeSet, StructureEntry};
use isolith_field::{LEAF_ROWS, payload_row};
use isolith_scene::ShapeKind;

/// The line that includes a shape's function.
pub fn shape_include(kind: ShapeKind) -> String {
    let texels = if kind == ShapeKind::MeshField { "#include \"common/bricks.wgsl\"\n" } else { "" };
    format!("{texels}#include \"sdf/{}.wgsl\"", kind.function().trim_start_matches("sdf_"))
}

/// The line that includes a shape's function together with its gradient.
pub fn gradient_include(kind: ShapeKind) -> String {
    format!("#include \"generated/dual/{}.wgsl\"", kind.function())
}

/// The generated file that selects the shape by its code. Each shape reads only the rows it has, from `row` on.
pub fn shapes_wgsl(ops: &OpSet) -> String {
    let mut out = String::new();
    for kind in &ops.shapes {
        writeln!(out, "{}\n{}", shape_include(*kind), load_include(&kind.eval_layout())).expect("strings take all");
    }
    writeln!(out, "const STACK_SIZE: u32 = {}u;", ops.stack).expect("strings take all");
    let call = |kind: ShapeKind| format!("{}({})", kind.function(), read_rows(kind));
    choice(&mut out, &ops.shapes, "shape_distance", ["f32", "1e30"], &call);
    out
}

/// The generated file that selects the gradient by the shape's code.
pub fn gradients_wgsl(ops: &OpSet) -> String {
    let mut out = String::new();
    for kind in &ops.shapes {
        writeln!(out, "{}\n{}", gradient_include(*kind), load_include(&kind.eval_layout())).expect("strings take all");
    }
    let call = |kind: ShapeKind| format!("dual_{}({})", kind.function(), read_rows(kind));
    choice(&mut out, &ops.shapes, "shape_gradient", ["vec4f", "vec4f(0.0)"], &call);
    out
}

/// A function that selects among the calls of the shapes.
fn choice(
    out: &mut String,
    shapes: &BTreeSet<ShapeKind>,
    name: &str,
    [result, nothing]: [&str; 2],
    call: &dyn Fn(ShapeKind) -> String,
) {
    writeln!(out, "fn {name}(shape: u32, p: vec3f, row: u32) -> {result} {{\n    switch shape {{")
        .expect("strings take all");
    for kind in shapes {
        writeln!(out, "        case {}u: {{ return {}; }}", *kind as u32, call(*kind)).expect("strings take all");
    }
    writeln!(out, "        default: {{ return {nothing}; }}\n    }}\n}}").expect("strings take all");
}

/// The arguments of a shape's function: the point, the parameters, read from their rows, and the start of its payload
/// rows.
fn read_rows(kind: ShapeKind) -> String {
    let data = |at: usize| format!(", row + {at}u + u32(scene_row(row + {at}u).y)");
    let data = payload_row(kind).map_or(String::new(), |at| data(at - LEAF_ROWS));
    format!("p{}{data}", loaded(&kind.eval_layout(), "row"))
}

/// Sets `{name}{at}` to the result of `call` for the shape whose code is in the row.
pub fn select_by_shape(
    shapes: ShapeSet,
    at: usize,
    row: usize,
    name: &str,
    call: &dyn Fn(ShapeKind) -> String,
    skip_mode: SkipMode,
) -> String {
    let mut out = String::new();
    for kind in shapes.shapes() {
        let (code, value) = (kind as u32, call(kind));
        let is_it = format!("q{row}.w == {code}.0");
        out += &match skip_mode {
            SkipMode::Branches | SkipMode::Never => format!("    if {is_it} {{ {name}{at} = {value}; }}\n"),
            SkipMode::Selects => format!("    {name}{at} = select({name}{at}, {value}, {is_it});\n"),
        };
    }
    out
}

/// The point in the leaf's own space, the parameters of its shape, and the start of its payload rows.
pub fn arguments(point: &str, entry: &StructureEntry, shape: ShapeKind, row: usize) -> String {
    let placed = if entry.moved { "placed_moved" } else { "placed" };
    let params = built(&shape.eval_layout(), &|i| format!("q{}", row + LEAF_ROWS + i));
    let data = payload_row(shape).map_or(String::new(), |i| format!(", {}", data_argument(row + i)));
    format!("{placed}({point}, q{}, q{}, q{}){params}{data}", row + 1, row + 2, row + 3)
}

/// The first payload row, whose place is in the component's row `at`.
pub fn data_argument(at: usize) -> String {
    format!("first_row + {at}u + u32(q{at}.y)")
}

/// Reads the rows of an entry, from `row` on. `offset` is code that is added to each place.
pub(super) fn read_entry_rows(entry: &StructureEntry, row: usize, offset: &str) -> String {
    (row..row + entry.rows()).map(|row| format!("    let q{row} = rows[{row}u{offset}];\n")).collect()
}
