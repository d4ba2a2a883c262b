//! Second half of a specialized surface: the weight of each leaf. The fold has left the weight of every blend in `w…`.
//! Gradient and material are sums over the leaves, each times the product of the weights on its path (reverse mode: the
//! weight of a blend is its derivative). So the code visits only leaves with an influence on the surface, most often
//! one. It only computes the weights of materials here; see `shaders/common/mixture.wgsl`.
//!
//! On graphics cards this code reads each leaf's rows again, from places that no compiler can recognize as the same.
//! Otherwise the compiler keeps all that the fold has computed of every leaf until here, where the derivatives need the
//! same values: seven ellipsoids took 216 vector registers, and now take 80.
//!
//! With operators beyond the first three a blend has two derivatives of any sign, and a material weight that equals
//! neither. `w…` then holds all of them, and the code carries `wear…` along beside `share…`.

use std::fmt::Write as _;
use std::ops::Range;

use super::calls::{arguments, read_entry_rows, select_by_shape};
use super::options::SkipMode;
use super::structure::{EntryKind, Structure, StructureEntry};
use isolith_field::Join;
use isolith_scene::ShapeKind;

/// The text that declares and accumulates `gradient` and `materials`. `reads_again`: see the module.
pub fn material_weights(structure: &Structure, reads_again: bool, skip_mode: SkipMode) -> String {
    let rows = structure.entries.iter().scan(0, |row, entry| {
        let first = *row;
        *row += entry.rows();
        Some(first)
    });
    let general = structure.has_extended_joins();
    let mut writer =
        MaterialWeights { structure, rows: rows.collect(), reads_again, skip_mode, general, out: String::new() };
    let entries = structure.entries.len();
    writer.line(&format!("    var gradient = vec3f(0.0);\n    var weights: array<f32, {entries}>;"));
    writer.line("    var heaviest = 0.0;\n    var rest0 = 1.0;");
    if general {
        writer.line("    var worn0 = 1.0;");
    }
    if reads_again {
        // Always 0, but no compiler knows that.
        writer.line("    let again = subject.first >> 31u;");
    }
    writer.siblings(0..entries, 0, 1.0);
    // Usually one leaf has all the weight. A loop, since without it lavapipe would compile and compute the same code
    // for each leaf.
    writer.line("    var materials = mixture_of(nodes[surface_first + l0].material);");
    writer.line("    if heaviest < 1.0 { materials = mixture_none(); }");
    writer.line(&format!("    var weighed = select({entries}u, 0u, heaviest < 1.0);"));
    writer.line(&format!("    while weighed < {entries}u {{"));
    writer.line("    let material = nodes[surface_first + weighed].material;");
    writer.line("    materials = mixture_add(materials, material, weights[weighed]);\n    weighed += 1u;\n    }");
    writer.out
}

struct MaterialWeights<'a> {
    structure: &'a Structure,
    rows: Vec<usize>,
    reads_again: bool,
    skip_mode: SkipMode,
    general: bool,
    out: String,
}

impl MaterialWeights<'_> {
    /// The operands in `range`, last first: each takes its weight of the rest that those after it have left. `sign` is
    /// -1 inside a cut.
    fn siblings(&mut self, range: Range<usize>, level: usize, sign: f32) {
        let mut operands = Vec::new();
        let mut at = range.start;
        while at < range.end {
            let entry = &self.structure.entries[at];
            if entry.kind == EntryKind::Run {
                // A run has no value of its own: its operands are siblings.
                at += 1;
                continue;
            }
            operands.push(at);
            at += entry.extent as usize;
        }
        for at in operands.into_iter().rev() {
            let entry = self.structure.entries[at];
            if self.general {
                self.general_share(at, &entry, level);
                self.operand(at, &entry, level, 1.0);
                continue;
            }
            let share = if entry.join == Join::First { format!("rest{level}") } else { format!("rest{level} * w{at}") };
            self.line(&format!("    let share{at} = {share};"));
            if entry.join != Join::First {
                self.line(&format!("    rest{level} -= share{at};"));
            }
            let sign = if entry.join == Join::Difference { -sign } else { sign };
            self.operand(at, &entry, level, sign);
        }
    }

    /// An operand's weights in the gradient and in the material.
    fn general_share(&mut self, at: usize, entry: &StructureEntry, level: usize) {
        if entry.join == Join::First {
            self.line(&format!("    let share{at} = rest{level};\n    let wear{at} = worn{level};"));
            return;
        }
        self.line(&format!("    let share{at} = rest{level} * w{at}.z;\n    let wear{at} = worn{level} * w{at}.w;"));
        self.line(&format!("    rest{level} *= w{at}.y;\n    worn{level} -= wear{at};"));
    }

    /// One operand, skipped if it has no weight.
    fn operand(&mut self, at: usize, entry: &StructureEntry, level: usize, sign: f32) {
        let wear = if self.general { "wear" } else { "share" };
        let has = format!("share{at} {} 0.0", if self.general { "!=" } else { ">" });
        let has = if self.general { format!("{has} || wear{at} > 0.0") } else { has };
        match self.skip_mode {
            SkipMode::Branches | SkipMode::Never => self.line(&format!("    if {has} {{")),
            SkipMode::Selects => self.line("    {"),
        }
        let row = self.rows[at];
        if self.reads_again && entry.is_leaf() {
            self.out.push_str(&read_entry_rows(entry, row, " + again"));
        }
        let gradient = match entry.kind {
            EntryKind::Leaf(shape) => Some(format!("dual_{}({})", shape.function(), arguments("p", entry, shape, row))),
            EntryKind::GenericLeaf(shapes) => {
                self.line(&format!("    var g{at} = vec4f(0.0);"));
                let call = |kind: ShapeKind| format!("dual_{}({})", kind.function(), arguments("p", entry, kind, row));
                let text = select_by_shape(shapes, at, row, "g", &call, self.skip_mode);
                self.line(&text);
                Some(format!("g{at}"))
            }
            EntryKind::Nested | EntryKind::Modified(_) | EntryKind::Run => None,
        };
        if let Some(gradient) = gradient {
            let moved = if entry.moved { "placed_gradient_moved" } else { "placed_gradient" };
            let factor = if entry.unscaled { format!("{sign:?}") } else { format!("{sign:?} * q{row}.y") };
            let moved = format!("{moved}({gradient}, q{}, q{}, q{})", row + 1, row + 2, row + 3);
            let part = format!("share{at} * {factor} * {moved}");
            self.line(&match self.skip_mode {
                SkipMode::Branches | SkipMode::Never => format!("    gradient += {part};"),
                // A leaf without weight may have no gradient here.
                SkipMode::Selects => format!("    gradient += select(vec3f(0.0), {part}, {has});"),
            });
            self.line(&format!("    weights[{at}u] = {wear}{at};\n    heaviest = max(heaviest, {wear}{at});"));
        } else {
            self.line(&format!("    var rest{} = share{at};", level + 1));
            if self.general {
                self.line(&format!("    var worn{} = wear{at};", level + 1));
            }
            self.siblings(at + 1..at + entry.extent as usize, level + 1, sign);
        }
        self.line("    }");
    }

    fn line(&mut self, text: &str) {
        writeln!(self.out, "{text}").expect("strings take all");
    }
}
