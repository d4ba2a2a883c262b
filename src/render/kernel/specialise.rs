//! Straight-line WGSL for a structure. Emits calls only: no formula of a distance stands here.

use std::fmt::Write as _;

use super::structure::{Entry, EntryKind, Structure};
use super::{Options, Skipping};
use crate::flat::{Join, LEAF_ROWS};
use crate::scene::ShapeKind;

/// Which of the two folds is written.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Fold {
    /// `field`: the distance.
    Value,
    /// `surface`: distance, leaf and material.
    Surface,
}

/// Groups of fewer entries are not worth a branch.
const LEAST_SKIPPED: u32 = 4;

/// The generated file for one fold over `structure`.
pub fn specialise(structure: &Structure, fold: Fold, options: Options) -> String {
    let mut writer = Writer { structure, fold, options, out: String::new() };
    writer.head();
    writer.body();
    writer.out
}

struct Writer<'a> {
    structure: &'a Structure,
    fold: Fold,
    options: Options,
    out: String,
}

impl Writer<'_> {
    fn line(&mut self, text: &str) {
        self.out.push_str(text);
        self.out.push('\n');
    }

    fn head(&mut self) {
        let rows = self.structure.rows();
        self.line(&format!("const ROW_COUNT: u32 = {rows}u;"));
        self.line("#include \"field/placed.wgsl\"");
        let shape = |e: &Entry| if let EntryKind::Leaf(shape) = e.kind { Some(shape) } else { None };
        let mut shapes: Vec<_> = self.structure.entries.iter().filter_map(shape).collect();
        shapes.sort_unstable();
        shapes.dedup();
        for shape in shapes {
            self.line(&super::source::shape_include(shape));
        }
        if self.fold == Fold::Surface {
            self.line("#include \"field/surface.wgsl\"");
            self.line("var<private> surface_first: u32;");
        }
        // Copied once: a uniform read at each use costs several times as much on a processor.
        for row in 0..rows {
            self.line(&format!("var<private> q{row}: vec4f;"));
        }
        let begin = if self.fold == Fold::Value { "field_begin" } else { "surface_begin" };
        self.line(&format!("fn {begin}(component: Component) {{"));
        if self.fold == Fold::Surface {
            self.line("    surface_first = component.first;");
        }
        for row in 0..rows {
            self.line(&format!("    q{row} = rows[{row}u];"));
        }
        self.line("}");
    }

    fn body(&mut self) {
        match self.fold {
            Fold::Value => self.line("fn field(p: vec3f) -> f32 {\n    var s0 = 0.0;"),
            Fold::Surface => self.line(
                "fn surface(p: vec3f) -> Surface {\n    var s0 = Surface(0.0, 0u, vec3f(0.0), 0.0, vec3f(0.0), 1.0);",
            ),
        }
        let mut row = 0;
        // Groups and runs under way: where each ends, its entry, its first row, whether it may be skipped.
        let mut open: Vec<(usize, Entry, usize, bool)> = Vec::new();
        let mut level = 0;
        for (at, entry) in self.structure.entries.iter().enumerate() {
            if let EntryKind::Leaf(shape) = entry.kind {
                let value = self.leaf(at, entry, shape, row);
                self.join(level, entry, row, &value);
            } else {
                let skipped = entry.bounded && entry.extent >= LEAST_SKIPPED && entry.join != Join::Intersection;
                self.open_block(level, at, entry, row, skipped);
                if entry.kind == EntryKind::Nested {
                    level += 1;
                    let kind = if self.fold == Fold::Value { "f32" } else { "Surface" };
                    self.line(&format!("    var s{level}: {kind};"));
                }
                open.push((at, *entry, row, skipped));
            }
            row += entry.rows();
            while let Some((begin, group, first, skipped)) = open.last().copied() {
                if begin + group.extent as usize != at + 1 {
                    break;
                }
                open.pop();
                if group.kind == EntryKind::Nested {
                    level -= 1;
                    self.join(level, &group, first, &format!("s{}", level + 1));
                }
                self.close_block(level, begin, skipped);
            }
        }
        self.line("    return s0;\n}");
    }

    /// The value of a leaf whose rows begin at `row`.
    fn leaf(&self, at: usize, entry: &Entry, shape: ShapeKind, row: usize) -> String {
        let placed = if entry.moved { "placed_moved" } else { "placed" };
        let parameter = |i: usize| {
            if i < shape.rows() { format!("q{}", row + LEAF_ROWS + i) } else { "vec4f(0.0)".to_owned() }
        };
        let mut value = format!(
            "{}({placed}(p, q{}, q{}, q{}), {}, {})",
            shape.function(),
            row + 1,
            row + 2,
            row + 3,
            parameter(0),
            parameter(1)
        );
        if !entry.unscaled {
            write!(value, " * q{row}.y").expect("strings take all");
        }
        match self.fold {
            Fold::Value => value,
            Fold::Surface => format!("surface_leaf(surface_first + {at}u, {value})"),
        }
    }

    /// Joins `value` to the accumulator of this level.
    fn join(&mut self, level: usize, entry: &Entry, row: usize, value: &str) {
        let name = match entry.join {
            Join::First => {
                self.line(&format!("    s{level} = {value};"));
                return;
            }
            Join::Union => "union",
            Join::Intersection => "intersection",
            Join::Difference => "difference",
        };
        let call = |a: &str, b: &str| match entry.kernel {
            Some(kernel) => format!("op_{name}({a}, {b}, q{row}.x, {kernel}u)"),
            None => format!("op_hard_{name}({a}, {b})"),
        };
        match self.fold {
            Fold::Value => {
                let joined = call(&format!("s{level}"), value);
                self.line(&format!("    s{level} = {joined}.x;"));
            }
            Fold::Surface => {
                let joined = call(&format!("s{level}.distance"), "operand.distance");
                self.line(&format!("    {{ let operand = {value};"));
                self.line(&format!("      s{level} = surface_join(s{level}, operand, {joined}); }}"));
            }
        }
    }

    /// A block that is entered only if what follows can change what stands so far. Every group has one
    /// of its own in any case: the group after it needs the same name for its accumulator.
    fn open_block(&mut self, level: usize, at: usize, entry: &Entry, row: usize, skipped: bool) {
        if !skipped {
            self.line("    {");
            return;
        }
        let so_far = self.so_far(level);
        let bound = match entry.join {
            Join::Union => format!("{so_far} + q{row}.x"),
            _ => format!("q{row}.x - {so_far}"),
        };
        let reached = format!("placed_bounds(p, q{row}, q{}, q{}) < {bound}", row + 1, row + 2);
        match self.options.skipping {
            Skipping::Branches => self.line(&format!("    if {reached} {{")),
            Skipping::Loops => self.line(&format!("    var once{at} = {reached};\n    while once{at} {{")),
        }
    }

    fn close_block(&mut self, level: usize, at: usize, skipped: bool) {
        if skipped && self.options.skipping == Skipping::Loops {
            // Never true, but no compiler knows that: it would make the loop an `if` again.
            let again = format!("    once{at} = {} < -1e37;", self.so_far(level));
            self.line(&again);
        }
        self.line("    }");
    }

    fn so_far(&self, level: usize) -> String {
        if self.fold == Fold::Value { format!("s{level}") } else { format!("s{level}.distance") }
    }
}
