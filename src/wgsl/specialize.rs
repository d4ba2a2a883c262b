//! Straight-line WGSL for a structure. It contains only calls; distance formulas are in `shaders/sdf/`.

use std::collections::BTreeSet;

use super::calls::{arguments, data_argument, gradient_include, read_entry_rows, select_by_shape, shape_include};
use super::lookahead;
use super::material_weights::material_weights;
use super::modifiers::{file, modifier_include};
use super::options::{Options, SkipMode};
use super::params::constructed;
use super::structure::{EntryKind, ShapeSet, Structure, StructureEntry};
use isolith_field::{
    GROUP_ROWS, Join, MODIFIER_ROWS, changes_value, is_copying, modifier_layout, modifier_payload_row, moves_point,
};
use isolith_scene::{ModifierKind, ShapeKind};

/// The two folds over a structure.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Fold {
    /// `field`: the distance.
    Value,
    /// `surface`: distance, leaf, gradient and material.
    Surface,
}

/// Smallest group that justifies a branch, in entries.
const LEAST_SKIPPED: u32 = 4;

/// The generated file for one fold over `structure`. With `baked` rows it contains them as bits.
pub fn specialize(structure: &Structure, baked: Option<&Vec<[u32; 4]>>, fold: Fold, options: Options) -> String {
    let lookahead = fold == Fold::Value && baked.is_none() && lookahead::has_lookahead(structure, options);
    let mut writer =
        FoldWriter { structure, baked, lookahead, fold, options, points: vec!["p".to_owned()], out: String::new() };
    writer.head();
    writer.body();
    writer.out
}

struct FoldWriter<'a> {
    structure: &'a Structure,
    baked: Option<&'a Vec<[u32; 4]>>,
    fold: Fold,
    /// Whether it also writes the lookahead.
    lookahead: bool,
    options: Options,
    /// Names of the point outside, and in each open modifier.
    points: Vec<String>,
    out: String,
}

impl FoldWriter<'_> {
    fn line(&mut self, text: &str) {
        self.out.push_str(text);
        self.out.push('\n');
    }

    fn head(&mut self) {
        let rows = self.structure.rows();
        self.line(&format!("const ROW_COUNT: u32 = {}u;", if self.baked.is_some() { 1 } else { rows }));
        self.line("#include \"field/placed.wgsl\"");
        let modifier = |e: &StructureEntry| if let EntryKind::Modified(kind) = e.kind { Some(kind) } else { None };
        let modifiers: BTreeSet<_> = self.structure.entries.iter().filter_map(modifier).collect();
        for kind in modifiers {
            self.line(&modifier_include(kind));
        }
        for shape in self.structure.shapes().shapes() {
            self.line(&shape_include(shape));
            if self.fold == Fold::Surface {
                self.line(&gradient_include(shape));
            }
        }
        if self.fold == Fold::Surface {
            self.line("#include \"field/surface.wgsl\"");
            self.line("var<private> surface_first: u32;");
        }
        // Copied once: a uniform read at each use costs several times as much on a processor. The surface is evaluated
        // only once, and reads at the use.
        let is_copied = self.fold == Fold::Value && self.baked.is_none() && !self.reads_at_use();
        let copied = if is_copied { rows } else { 0 };
        for (row, bits) in self.baked.into_iter().flatten().enumerate() {
            let [x, y, z, w] = bits.map(f32::from_bits);
            self.line(&format!("const q{row} = vec4f({x:?}, {y:?}, {z:?}, {w:?});"));
        }
        for row in 0..copied {
            self.line(&format!("var<private> q{row}: vec4f;"));
        }
        self.line("var<private> first_row: u32;");
        let begin = if self.fold == Fold::Value { "field_begin" } else { "surface_begin" };
        self.line(&format!("fn {begin}(component: Component) {{"));
        self.line("    first_row = component.params;");
        if self.fold == Fold::Surface {
            self.line("    surface_first = component.first;");
        }
        for row in 0..copied {
            self.line(&format!("    q{row} = rows[{row}u];"));
        }
        self.line("}");
    }

    /// Whether rows are read at their use. Graphics cards hold uniforms in about a hundred scalar registers: when all
    /// rows were read before the march, most of them spilled into lanes of vector registers.
    fn reads_at_use(&self) -> bool {
        self.options.skip_mode == SkipMode::Branches && self.baked.is_none()
    }

    /// Writes the declarations before the fold.
    fn open_fold(&mut self) {
        if self.fold == Fold::Surface {
            self.line("fn surface(p: vec3f) -> Surface {\n    var s0 = 0.0;\n    var l0 = 0u;");
            let is_read = self.baked.is_none() && !self.reads_at_use();
            for row in 0..if is_read { self.structure.rows() } else { 0 } {
                self.line(&format!("    let q{row} = rows[{row}u];"));
            }
            for (at, entry) in self.structure.entries.iter().enumerate() {
                if entry.join != Join::First && entry.kind != EntryKind::Run {
                    // The weight of the joined operand, or in general the result of `op_join`.
                    let nothing = if self.is_general() { "vec4f(0.0, 1.0, 0.0, 0.0)" } else { "0.0" };
                    self.line(&format!("    var w{at} = {nothing};"));
                }
            }
        } else {
            let entries = self.structure.entries.iter().enumerate();
            for (at, _) in entries.filter(|(_, entry)| self.lookahead && entry.is_leaf()).collect::<Vec<_>>() {
                self.line(&format!("var<private> b{at}: f32;"));
            }
            self.line("fn field(p: vec3f) -> f32 {\n    var s0 = 0.0;");
            if self.lookahead {
                self.line("    var h0 = 0.0;");
            }
        }
    }

    fn body(&mut self) {
        let surface = self.fold == Fold::Surface;
        self.open_fold();
        let mut row = 0;
        // Open groups and runs: the start of each, its entry, its first row.
        let mut open: Vec<(usize, StructureEntry, usize)> = Vec::new();
        let mut level = 0;
        for (at, entry) in self.structure.entries.iter().enumerate() {
            if self.reads_at_use() {
                self.out.push_str(&read_entry_rows(entry, row, ""));
            }
            if entry.is_leaf() {
                let is_operand = |e: &&StructureEntry| e.kind != EntryKind::Run && e.join == Join::Difference;
                let cuts = open.iter().map(|(_, group, _)| group).chain([entry]).filter(is_operand).count();
                let value = self.leaf(at, entry, row, cuts % 2 == 1);
                self.join(level, at, entry, row, &value, &format!("{at}u"));
            } else {
                let skipped = entry.bounded && entry.extent >= LEAST_SKIPPED && entry.join.is_skipped_far_off();
                let skipped = skipped && self.options.skip_mode == SkipMode::Branches;
                self.open_block(level, entry, row, skipped);
                if entry.kind != EntryKind::Run {
                    level += 1;
                    self.line(&format!("    var s{level}: f32;"));
                    if self.lookahead {
                        self.line(&format!("    var h{level}: f32;"));
                    }
                    if surface {
                        self.line(&format!("    var l{level}: u32;"));
                    }
                }
                if let EntryKind::Modified(kind) = entry.kind {
                    self.open_modifier(at, entry, kind, row);
                }
                open.push((at, *entry, row));
            }
            row += entry.rows();
            while let Some((begin, group, first)) = open.last().copied() {
                if begin + group.extent as usize != at + 1 {
                    break;
                }
                open.pop();
                if let EntryKind::Modified(kind) = group.kind {
                    self.close_modifier(level, begin, &group, kind, first);
                }
                if group.kind != EntryKind::Run {
                    level -= 1;
                    let [value, leaf] = ["s", "l"].map(|name| format!("{name}{}", level + 1));
                    self.join(level, begin, &group, first, &value, &leaf);
                }
                self.line("    }");
            }
        }
        if surface {
            let text = material_weights(self.structure, self.reads_at_use(), self.options.skip_mode);
            self.line(&text);
            self.line("    return Surface(s0, surface_first + l0, gradient, materials);\n}");
        } else {
            if self.lookahead {
                self.line("    lookahead_minimum = h0;");
            }
            self.line("    return s0;\n}");
        }
    }

    /// Whether surfaces need derivatives and material weights apart.
    fn is_general(&self) -> bool {
        self.fold == Fold::Surface && self.structure.has_extended_joins()
    }

    /// The value of a leaf whose rows begin at `row`. `is_cut`: below an odd number of cuts.
    fn leaf(&mut self, at: usize, entry: &StructureEntry, row: usize, is_cut: bool) -> String {
        let value = match entry.kind {
            EntryKind::Leaf(shape) => {
                let value = format!("{}({})", shape.function(), arguments(self.point(), entry, shape, row));
                if entry.unscaled { value } else { format!("{value} * q{row}.y") }
            }
            EntryKind::GenericLeaf(shapes) => self.generic_leaf(at, entry, shapes, row),
            EntryKind::Nested | EntryKind::Modified(_) | EntryKind::Run => unreachable!("these are no leaves"),
        };
        if !self.lookahead {
            return value;
        }
        let text = lookahead::leaf(at, entry, row, is_cut, &value, &|kind| arguments(self.point(), entry, kind, row));
        self.out.push_str(&text);
        format!("v{at}")
    }

    /// Writes the code for the value of a leaf of any shape, and returns an expression for it.
    fn generic_leaf(&mut self, at: usize, entry: &StructureEntry, shapes: ShapeSet, row: usize) -> String {
        self.line(&format!("    var d{at} = 0.0;"));
        let call = |kind: ShapeKind| format!("{}({})", kind.function(), arguments(self.point(), entry, kind, row));
        let text = select_by_shape(shapes, at, row, "d", &call, self.options.skip_mode);
        self.line(&text);
        format!("d{at} * q{row}.y")
    }

    /// Joins `value` to the accumulator of this level. `leaf` is the leaf that it comes from.
    fn join(&mut self, level: usize, at: usize, entry: &StructureEntry, row: usize, value: &str, leaf: &str) {
        let surface = self.fold == Fold::Surface;
        let name = match entry.join {
            Join::First => {
                self.line(&format!("    s{level} = {value};"));
                if self.lookahead {
                    self.line(&format!("    h{level} = {};", lookahead_minimum(level, at, entry)));
                }
                if surface {
                    self.line(&format!("    l{level} = {leaf};"));
                }
                return;
            }
            Join::Union => "union",
            Join::Intersection => "intersection",
            Join::Difference => "difference",
            _ => "extended",
        };
        let general = self.is_general() || entry.join.is_extended();
        let call = |a: &str, b: &str| match entry.kernel {
            _ if general => {
                let (join, kernel) = (entry.join as u32, entry.kernel.unwrap_or(0));
                format!("op_join({join}u, {a}, {b}, q{row}, {kernel}u)")
            }
            Some(kernel) => format!("op_{name}({a}, {b}, q{row}, {kernel}u)"),
            None => format!("op_hard_{name}({a}, {b})"),
        };
        let joined = call(&format!("s{level}"), value);
        if self.lookahead {
            let lookahead = call(&format!("h{level}"), &lookahead_minimum(level, at, entry));
            self.line(&format!("    h{level} = {lookahead}.x;"));
        }
        if surface && general {
            self.line(&format!("    w{at} = {joined}; s{level} = w{at}.x;"));
            self.line(&format!("    l{level} = select(l{level}, {leaf}, w{at}.w > 0.5);"));
        } else if surface {
            self.line(&format!("    {{ let joined = {joined};"));
            self.line(&format!("      l{level} = select(l{level}, {leaf}, joined.y > 0.5);"));
            self.line(&format!("      w{at} = joined.y; s{level} = joined.x; }}"));
        } else {
            self.line(&format!("    s{level} = {joined}.x;"));
        }
    }

    /// The name of the current point of the fold.
    fn point(&self) -> &str {
        self.points.last().map_or("p", String::as_str)
    }

    /// Opens a modifier: the point in its space and in its content, and a loop over copies if there are several.
    fn open_modifier(&mut self, at: usize, entry: &StructureEntry, kind: ModifierKind, row: usize) {
        let placed = if entry.moved { "placed_moved" } else { "placed" };
        let [x, y, z] = [0, 1, 2].map(|i| row + GROUP_ROWS + i);
        let outside = self.point().to_owned();
        self.line(&format!("    let a{at} = {placed}({outside}, q{x}, q{y}, q{z});"));
        let params = constructed(&modifier_layout(kind), &|i| format!("q{}", row + MODIFIER_ROWS + i));
        self.line(&format!("    let m{at} = {params};"));
        let (name, rows) = (file(kind), own_arguments(at, kind, row));
        if is_copying(kind) {
            self.line(&format!("    var v{at} = mod_{name}_start(a{at}{rows});"));
            self.line(&format!("    var k{at} = 0u;\n    loop {{"));
            self.line(&format!("    while k{at} < mod_{name}_count({})", rows.trim_start_matches(", ")));
            self.line(&format!("        && mod_{name}_bound(a{at}, k{at}{rows}) >= v{at} {{ k{at} += 1u; }}"));
            self.line(&format!("    if k{at} >= mod_{name}_count({}) {{ break; }}", rows.trim_start_matches(", ")));
            self.line(&format!("    let b{at} = mod_{name}_point(a{at}, k{at}{rows});"));
        } else if moves_point(kind) {
            self.line(&format!("    let b{at} = mod_{name}_point(a{at}, 0u{rows});"));
        }
        self.points.push(if moves_point(kind) { format!("b{at}") } else { format!("a{at}") });
    }

    fn close_modifier(&mut self, level: usize, at: usize, entry: &StructureEntry, kind: ModifierKind, row: usize) {
        self.points.pop();
        let (name, rows) = (file(kind), own_arguments(at, kind, row));
        if is_copying(kind) {
            self.line(&format!("    v{at} = min(v{at}, s{level} * mod_{name}_scale(k{at}{rows}));"));
            self.line(&format!("    k{at} += 1u;\n    }}\n    s{level} = v{at};"));
        }
        if changes_value(kind) {
            self.line(&format!("    s{level} = mod_{name}_value(s{level}, a{at}{rows});"));
        }
        if !entry.unscaled {
            self.line(&format!("    s{level} *= q{}.w;", row + 1));
        }
    }

    /// Opens a block that is entered only if its operands can change the accumulator. Every group has its own block in
    /// any case: the next group needs the same name for its accumulator.
    fn open_block(&mut self, level: usize, entry: &StructureEntry, row: usize, skipped: bool) {
        if !skipped {
            self.line("    {");
            return;
        }
        let bound = match entry.join {
            Join::Union => format!("s{level} + q{row}.x"),
            _ => format!("q{row}.x - s{level}"),
        };
        let point = self.point();
        let reached = format!("placed_bounds({point}, q{row}, q{}, q{}) < {bound}", row + 1, row + 2);
        self.line(&format!("    if {reached} {{"));
    }
}

/// The name of an operand's lower bound ahead.
fn lookahead_minimum(level: usize, at: usize, entry: &StructureEntry) -> String {
    if entry.is_leaf() { format!("a{at}") } else { format!("h{}", level + 1) }
}

/// The parameters of a modifier and the start of its payload rows, as further arguments.
fn own_arguments(at: usize, kind: ModifierKind, row: usize) -> String {
    let data = modifier_payload_row(kind).map(|i| format!(", {}", data_argument(row + MODIFIER_ROWS + i)));
    format!(", m{at}{}", data.unwrap_or_default())
}
