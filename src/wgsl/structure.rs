//! The structure of a component, which determines its pipeline: everything but its parameters.

use super::op_set::{Extended, OpSet, fits_templates};
use isolith_field::{
    Component, FIRST_EXTENDED_KERNEL, FlatNode, FlatScene, GROUP_ROWS, Join, LEAF_ROWS, MODIFIER_ROWS, ParamRow,
    modifier_rows,
};
use isolith_scene::{ModifierKind, SHAPE_FLOATS, ShapeKind};

/// Row limit of a component with its own pipeline: 16 KiB, the uniform buffer that every device has.
pub const MAX_PIPELINE_ROWS: u32 = 1024;

/// Entry limit of a component with its own pipeline. Compile time grows faster than linearly, and beyond this limit the
/// interpreter has drawn many pictures before the pipeline is ready.
pub const MAX_PIPELINE_ENTRIES: u32 = 128;

/// Kind of an entry of the subtree-extent array.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum EntryKind {
    /// A shape.
    Leaf(ShapeKind),
    /// One of these shapes; its rows tell which one, see [`template_rows`].
    GenericLeaf(ShapeSet),
    /// A group of operands with its own accumulator.
    Nested,
    /// The content of a modifier.
    Modified(ModifierKind),
    /// Operands that the fold may skip together.
    Run,
}

/// A set of shapes, with a bit for each.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ShapeSet(pub u64);

impl ShapeSet {
    /// Whether the shapes are few enough to share one pipeline, which computes all of them to select one, even if
    /// structures are few enough for pipelines of their own.
    pub fn is_small(self) -> bool {
        self.count() <= 4
    }

    /// Number of shapes.
    pub fn count(self) -> u32 {
        self.0.count_ones()
    }

    /// The set of these shapes.
    pub fn of(shapes: impl IntoIterator<Item = ShapeKind>) -> Self {
        let mut all = Self::default();
        shapes.into_iter().for_each(|kind| all.insert(kind));
        all
    }

    /// Adds a shape.
    pub fn insert(&mut self, kind: ShapeKind) {
        self.0 |= 1 << kind as u32;
    }

    /// The shapes, in order.
    pub fn shapes(self) -> impl Iterator<Item = ShapeKind> {
        ShapeKind::ALL.iter().copied().filter(move |kind| self.0 >> *kind as u32 & 1 == 1)
    }
}

/// One entry of the subtree-extent array, without its parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct StructureEntry {
    /// Its kind.
    pub kind: EntryKind,
    /// Number of entries of its subtree, including itself.
    pub extent: u32,
    /// How it joins the preceding operands.
    pub join: Join,
    /// Kernel of the blend; `None` for a hard join.
    pub kernel: Option<u8>,
    /// Whether it is only moved, not turned or scaled; leaves and modifiers only.
    pub moved: bool,
    /// Whether its field has no factor; leaves and modifiers only.
    pub unscaled: bool,
    /// Whether its bounds allow skipping it; all but leaves.
    pub bounded: bool,
}

impl StructureEntry {
    /// Whether it is a leaf.
    pub fn is_leaf(&self) -> bool {
        matches!(self.kind, EntryKind::Leaf(_) | EntryKind::GenericLeaf(_))
    }

    /// Number of its rows.
    pub fn rows(&self) -> usize {
        match self.kind {
            EntryKind::Leaf(shape) => LEAF_ROWS + shape.rows(),
            EntryKind::GenericLeaf(_) => TEMPLATE_LEAF_ROWS,
            EntryKind::Modified(kind) => MODIFIER_ROWS + modifier_rows(kind),
            EntryKind::Nested | EntryKind::Run => GROUP_ROWS,
        }
    }
}

/// The structure of a component. Equal structures share a pipeline; a dragged value stays within one.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Structure {
    /// The entries in pre-order.
    pub entries: Vec<StructureEntry>,
}

impl Structure {
    /// The structure of a component, or `None` if it is too large for a pipeline.
    pub fn of(flat: &FlatScene, component: &Component) -> Option<Self> {
        fits(component).then(|| Self::whole(flat, component))
    }

    /// The structure of a component of any size.
    pub fn whole(flat: &FlatScene, component: &Component) -> Self {
        let range = component.first as usize..(component.first + component.count) as usize;
        Self { entries: flat.nodes[range].iter().map(|node| entry(flat, node)).collect() }
    }

    /// A key that equal structures share and different ones practically never (128 bits of FNV-1a), computed without
    /// building the structure. `None` if the component is too large for a pipeline.
    pub fn key(flat: &FlatScene, component: &Component) -> Option<u128> {
        if !fits(component) {
            return None;
        }
        let range = component.first as usize..(component.first + component.count) as usize;
        let mut hash = FNV_START;
        for node in &flat.nodes[range] {
            let e = entry(flat, node);
            let kernel = e.kernel.map_or(0xff, u64::from);
            let flags = u64::from(e.moved) | (u64::from(e.unscaled) << 1) | (u64::from(e.bounded) << 2);
            let word = u64::from(node.code & 0xffff)
                | ((e.join as u64) << 16)
                | (kernel << 20)
                | (flags << 28)
                | (u64::from(e.extent) << 32);
            hash = (hash ^ u128::from(word)).wrapping_mul(FNV_PRIME);
        }
        Some(hash)
    }

    /// The template of a component: its structure, with leaves that may have any of these shapes and any placement.
    /// Many structures share one template, and its pipeline. `None` if the component is too large, or has no template:
    /// extended operators keep their depth in the place of the shape's code, modifiers have rows of their own, and
    /// shapes with loops would run them for every leaf.
    pub fn template(flat: &FlatScene, component: &Component, shapes: ShapeSet) -> Option<Self> {
        if !has_template(flat, component) {
            return None;
        }
        let mut structure = Self::of(flat, component)?;
        for entry in &mut structure.entries {
            if let EntryKind::Leaf(_) = entry.kind {
                *entry =
                    StructureEntry { kind: EntryKind::GenericLeaf(shapes), moved: false, unscaled: false, ..*entry };
            }
        }
        Some(structure)
    }

    /// Whether it is the template of many structures.
    pub fn is_template(&self) -> bool {
        self.entries.iter().any(|entry| matches!(entry.kind, EntryKind::GenericLeaf(_)))
    }

    /// A key of the template, and the shapes in the component; `None` if it has no template.
    pub fn template_key(flat: &FlatScene, component: &Component) -> Option<(u128, ShapeSet)> {
        if !fits(component) || !has_template(flat, component) {
            return None;
        }
        let range = component.first as usize..(component.first + component.count) as usize;
        let (mut hash, mut shapes) = (FNV_START, ShapeSet::default());
        for node in &flat.nodes[range] {
            let e = entry(flat, node);
            let kind = match e.kind {
                EntryKind::Leaf(shape) => {
                    shapes.insert(shape);
                    0
                }
                EntryKind::GenericLeaf(_) => 0,
                EntryKind::Nested => 1,
                EntryKind::Run => 2,
                EntryKind::Modified(_) => return None,
            };
            let kernel = e.kernel.map_or(0xff, u64::from);
            let word = kind | ((e.join as u64) << 16) | (kernel << 20) | (u64::from(e.bounded) << 28);
            hash = (hash ^ u128::from(word | (u64::from(e.extent) << 32))).wrapping_mul(FNV_PRIME);
        }
        Some((hash, shapes))
    }

    /// A key of a component of any size, including its parameters.
    pub fn baked_key(flat: &FlatScene, component: &Component) -> u128 {
        let range = |first: u32, count: u32| first as usize..(first + count) as usize;
        let codes = flat.nodes[range(component.first, component.count)].iter().map(|node| node.code);
        let params = flat.params[range(component.params, component.param_rows)].iter().flatten().map(|v| v.to_bits());
        codes.chain(params).fold(FNV_START, |hash, word| (hash ^ u128::from(word)).wrapping_mul(FNV_PRIME))
    }

    /// All shapes that its leaves have or may have.
    pub fn shapes(&self) -> ShapeSet {
        let mut all = ShapeSet::default();
        for entry in &self.entries {
            match entry.kind {
                EntryKind::Leaf(shape) => all.insert(shape),
                EntryKind::GenericLeaf(shapes) => all.0 |= shapes.0,
                EntryKind::Nested | EntryKind::Modified(_) | EntryKind::Run => {}
            }
        }
        all
    }

    /// Whether it contains modifiers.
    pub fn is_modified(&self) -> bool {
        self.entries.iter().any(|e| matches!(e.kind, EntryKind::Modified(_)))
    }

    /// Whether it has operators beyond union, intersection and difference.
    pub fn has_extended_joins(&self) -> bool {
        self.entries.iter().any(|entry| entry.join.is_extended())
    }

    /// The operations that an interpreter needs for it.
    pub fn op_set(&self) -> OpSet {
        let mut ops = OpSet::none();
        ops.extended = Extended {
            joins: self.has_extended_joins(),
            kernels: self.entries.iter().any(|e| e.kernel.is_some_and(|k| u32::from(k) >= FIRST_EXTENDED_KERNEL)),
        };
        ops.shapes = self.shapes().shapes().collect();
        // Ends of the open groups and modifiers.
        let mut open: Vec<usize> = Vec::new();
        for (at, entry) in self.entries.iter().enumerate() {
            open.retain(|end| *end > at);
            match entry.kind {
                EntryKind::Leaf(_) | EntryKind::GenericLeaf(_) => {}
                EntryKind::Modified(kind) => {
                    ops.modifiers.insert(kind);
                    open.push(at + entry.extent as usize);
                }
                EntryKind::Nested => open.push(at + entry.extent as usize),
                EntryKind::Run => {}
            }
            ops.stack = ops.stack.max((open.len() as u32).next_power_of_two());
        }
        ops
    }

    /// Number of rows of a component of this structure.
    pub fn rows(&self) -> usize {
        self.entries.iter().map(StructureEntry::rows).sum()
    }
}

/// Rows of a leaf in a template: room for the parameters of any shape.
const TEMPLATE_LEAF_ROWS: usize = LEAF_ROWS + SHAPE_FLOATS / 4;

/// Appends the rows of a component, from `params`, in the layout of its template's pipeline. Every leaf takes the same
/// number of rows. The fourth number of its first row holds the code of its shape; otherwise only extended operators
/// use that number, for their depth.
pub fn template_rows(flat: &FlatScene, params: &[ParamRow], component: &Component, out: &mut Vec<ParamRow>) {
    for node in &flat.nodes[component.first as usize..][..component.count as usize] {
        let (rows, first) = (&params[node.params as usize..], out.len());
        if !node.is_leaf() {
            out.extend_from_slice(&rows[..GROUP_ROWS]);
            continue;
        }
        let code = node.code & 0xffff;
        out.extend_from_slice(&rows[..LEAF_ROWS + ShapeKind::ALL[code as usize].rows()]);
        out.resize(first + TEMPLATE_LEAF_ROWS, [0.0; 4]);
        out[first][3] = code as f32;
    }
}

/// FNV-1a of 128 bits.
const FNV_START: u128 = 0x6c62_272e_07bb_0142_62b8_2175_6295_c58d;
const FNV_PRIME: u128 = 0x0000_0000_0100_0000_0000_0000_0000_013b;

fn fits(component: &Component) -> bool {
    component.param_rows - component.payload_rows <= MAX_PIPELINE_ROWS && component.count <= MAX_PIPELINE_ENTRIES
}

/// Whether a component has a template: no modifiers, no operators beyond the first three, no shapes with loops or
/// payload.
fn has_template(flat: &FlatScene, component: &Component) -> bool {
    let nodes = &flat.nodes[component.first as usize..][..component.count as usize];
    let is_extended = |node: &FlatNode| Join::ALL[node.join() as usize].is_extended();
    let fits = |node: &FlatNode| !node.is_leaf() || fits_templates(ShapeKind::ALL[(node.code & 0xffff) as usize]);
    !component.is_modified() && nodes.iter().all(|node| !is_extended(node) && fits(node))
}

fn entry(flat: &FlatScene, node: &FlatNode) -> StructureEntry {
    let rows = &flat.params[node.params as usize..];
    let blend_params = rows[0];
    let join = Join::ALL[node.join() as usize];
    let blended = blend_params[0] > 0.0 && join != Join::First;
    let leaf = node.is_leaf();
    let modifier = node.modifier().is_some();
    let placing = if leaf { 1 } else { GROUP_ROWS };
    let identity = |i: usize| {
        let mut unit = [0.0; 3];
        unit[i] = 1.0;
        rows[placing + i][..3] == unit
    };
    StructureEntry {
        kind: match node.code & 0xffff {
            FlatNode::GROUP => EntryKind::Nested,
            FlatNode::RUN => EntryKind::Run,
            shape => match node.modifier() {
                Some(kind) => EntryKind::Modified(kind),
                None => EntryKind::Leaf(ShapeKind::ALL[shape as usize]),
            },
        },
        extent: node.extent,
        join,
        kernel: blended.then_some(node.kernel() as u8),
        moved: (leaf || modifier) && identity(0) && identity(1) && identity(2),
        unscaled: if leaf { blend_params[1] == 1.0 } else { modifier && rows[1][3] == 1.0 },
        bounded: !leaf && blend_params[1] > 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use isolith_field::flatten;
    use isolith_gallery as gallery;

    #[test]
    fn what_is_modified_or_joined_by_extended_operators_has_no_template() {
        let mut without = 0;
        for (name, scene) in gallery::all() {
            let flat = flatten(&scene, 0.0).unwrap_or_else(|e| panic!("{name}: {e}"));
            for component in &flat.components {
                let whole = Structure::whole(&flat, component);
                let ops = whole.op_set();
                let plain = !component.is_modified() && !ops.extended.joins;
                let plain = plain && ops.shapes.iter().all(|kind| fits_templates(*kind));
                assert_eq!(Structure::template_key(&flat, component).is_some(), plain && fits(component), "{name}");
                assert!(plain || Structure::template(&flat, component, whole.shapes()).is_none(), "{name}");
                without += usize::from(!plain);
            }
        }
        assert!(without > 10, "only {without} components have no template");
    }
}
