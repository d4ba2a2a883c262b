//! Straight-line WGSL for a structure. Emits calls only: no formula of a distance stands here.

use super::shares::shares;
use super::structure::{Entry, EntryKind, Structure};
use super::{Options, Skipping};
use crate::flat::{Join, LEAF_ROWS};
use crate::scene::ShapeKind;

/// Which of the two folds is written.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Fold {
    /// `field`: the distance.
    Value,
    /// `surface`: distance, leaf, gradient and material.
    Surface,
}

/// Groups of fewer entries are not worth a branch.
const LEAST_SKIPPED: u32 = 4;

/// The generated file for one fold over `structure`; with `baked` rows they are written into it, as bits.
pub fn specialise(structure: &Structure, baked: Option<&Vec<[u32; 4]>>, fold: Fold, options: Options) -> String {
    let mut writer = Writer { structure, baked, fold, options, out: String::new() };
    writer.head();
    writer.body();
    writer.out
}

struct Writer<'a> {
    structure: &'a Structure,
    baked: Option<&'a Vec<[u32; 4]>>,
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
        self.line(&format!("const ROW_COUNT: u32 = {}u;", if self.baked.is_some() { 1 } else { rows }));
        self.line("#include \"field/placed.wgsl\"");
        let shape = |e: &Entry| if let EntryKind::Leaf(shape) = e.kind { Some(shape) } else { None };
        let mut shapes: Vec<_> = self.structure.entries.iter().filter_map(shape).collect();
        shapes.sort_unstable();
        shapes.dedup();
        for shape in shapes {
            self.line(&super::source::shape_include(shape));
            if self.fold == Fold::Surface {
                self.line(&super::source::gradient_include(shape));
            }
        }
        if self.fold == Fold::Surface {
            self.line("#include \"field/surface.wgsl\"");
            self.line("var<private> surface_first: u32;");
        }
        // Copied once: a uniform read at each use costs several times as much on a processor. A surface is
        // evaluated once only, and reads where it needs to.
        let copied = if self.fold == Fold::Value && self.baked.is_none() { rows } else { 0 };
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
        self.line("    first_row = component.numbers;");
        if self.fold == Fold::Surface {
            self.line("    surface_first = component.first;");
        }
        for row in 0..copied {
            self.line(&format!("    q{row} = rows[{row}u];"));
        }
        self.line("}");
    }

    fn body(&mut self) {
        let surface = self.fold == Fold::Surface;
        if surface {
            self.line("fn surface(p: vec3f) -> Surface {\n    var s0 = 0.0;\n    var l0 = 0u;");
            for row in 0..if self.baked.is_some() { 0 } else { self.structure.rows() } {
                self.line(&format!("    let q{row} = rows[{row}u];"));
            }
            for (at, entry) in self.structure.entries.iter().enumerate() {
                if entry.join != Join::First && entry.kind != EntryKind::Run {
                    self.line(&format!("    var w{at} = 0.0;"));
                }
            }
        } else {
            self.line("fn field(p: vec3f) -> f32 {\n    var s0 = 0.0;");
        }
        let mut row = 0;
        // Groups and runs under way: where each begins, its entry, its first row, whether it may be skipped.
        let mut open: Vec<(usize, Entry, usize, bool)> = Vec::new();
        let mut level = 0;
        for (at, entry) in self.structure.entries.iter().enumerate() {
            if let EntryKind::Leaf(shape) = entry.kind {
                let value = self.leaf(entry, shape, row);
                self.join(level, at, entry, row, &value, &format!("{at}u"));
            } else {
                let skipped = entry.bounded && entry.extent >= LEAST_SKIPPED && entry.join != Join::Intersection;
                let skipped = skipped && self.options.skipping != Skipping::Never;
                self.open_block(level, at, entry, row, skipped);
                if entry.kind == EntryKind::Nested {
                    level += 1;
                    self.line(&format!("    var s{level}: f32;"));
                    if surface {
                        self.line(&format!("    var l{level}: u32;"));
                    }
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
                    let [value, leaf] = ["s", "l"].map(|name| format!("{name}{}", level + 1));
                    self.join(level, begin, &group, first, &value, &leaf);
                }
                self.close_block(level, begin, skipped);
            }
        }
        if surface {
            let text = shares(self.structure, self.options.skipping);
            self.line(&text);
            self.line("    return Surface(s0, surface_first + l0, gradient, diffuse, emission);\n}");
        } else {
            self.line("    return s0;\n}");
        }
    }

    /// The value of a leaf whose rows begin at `row`.
    fn leaf(&self, entry: &Entry, shape: ShapeKind, row: usize) -> String {
        let value = format!("{}({})", shape.function(), arguments(entry, shape, row));
        if entry.unscaled { value } else { format!("{value} * q{row}.y") }
    }

    /// Joins `value` to the accumulator of this level; `leaf` is the one that it comes from.
    fn join(&mut self, level: usize, at: usize, entry: &Entry, row: usize, value: &str, leaf: &str) {
        let surface = self.fold == Fold::Surface;
        let name = match entry.join {
            Join::First => {
                self.line(&format!("    s{level} = {value};"));
                if surface {
                    self.line(&format!("    l{level} = {leaf};"));
                }
                return;
            }
            Join::Union => "union",
            Join::Intersection => "intersection",
            Join::Difference => "difference",
        };
        let joined = match entry.kernel {
            Some(kernel) => format!("op_{name}(s{level}, {value}, q{row}.x, {kernel}u)"),
            None => format!("op_hard_{name}(s{level}, {value})"),
        };
        if surface {
            self.line(&format!("    {{ let joined = {joined};"));
            self.line(&format!("      l{level} = select(l{level}, {leaf}, joined.y > 0.5);"));
            self.line(&format!("      w{at} = joined.y; s{level} = joined.x; }}"));
        } else {
            self.line(&format!("    s{level} = {joined}.x;"));
        }
    }

    /// A block that is entered only if what follows can change what stands so far. Every group has one
    /// of its own in any case: the group after it needs the same name for its accumulator.
    fn open_block(&mut self, level: usize, at: usize, entry: &Entry, row: usize, skipped: bool) {
        if !skipped {
            self.line("    {");
            return;
        }
        let bound = match entry.join {
            Join::Union => format!("s{level} + q{row}.x"),
            _ => format!("q{row}.x - s{level}"),
        };
        let reached = format!("placed_bounds(p, q{row}, q{}, q{}) < {bound}", row + 1, row + 2);
        match self.options.skipping {
            Skipping::Branches | Skipping::Never => self.line(&format!("    if {reached} {{")),
            Skipping::Loops => self.line(&format!("    var once{at} = {reached};\n    while once{at} {{")),
        }
    }

    fn close_block(&mut self, level: usize, at: usize, skipped: bool) {
        if skipped && self.options.skipping == Skipping::Loops {
            // Never true, but no compiler knows that: it would make the loop an `if` again.
            self.line(&format!("    once{at} = s{level} < -1e37;"));
        }
        self.line("    }");
    }
}

/// The point in the leaf's own space, and the parameters of its shape.
pub(super) fn arguments(entry: &Entry, shape: ShapeKind, row: usize) -> String {
    let placed = if entry.moved { "placed_moved" } else { "placed" };
    let parameter = |i: usize| {
        if i < shape.rows() { format!("q{}", row + LEAF_ROWS + i) } else { "vec4f(0.0)".to_owned() }
    };
    let (a, b) = (parameter(0), parameter(1));
    let data = if shape.has_data() { format!(", first_row + {row}u + u32(q{row}.w)") } else { String::new() };
    format!("{placed}(p, q{}, q{}, q{}), {a}, {b}{data}", row + 1, row + 2, row + 3)
}
