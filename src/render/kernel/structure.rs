//! What of a component decides its kernel: everything but its numbers.

use super::source::{Features, Further};
use crate::flat::{
    Component, FIRST_FURTHER_KERNEL, FlatNode, FlatScene, GROUP_ROWS, Join, LEAF_ROWS, MODIFIER_ROWS, modifier_rows,
};
use crate::scene::{ModifierKind, ShapeKind};

/// Most rows of a component that gets a kernel of its own: 12 KiB of a uniform buffer's 16.
pub const MAX_KERNEL_ROWS: u32 = 768;

/// Most entries of a component that gets a kernel of its own: compiling grows faster than linearly, and
/// beyond this the interpreter has made many pictures by the time the kernel is ready.
pub const MAX_KERNEL_ENTRIES: u32 = 128;

/// What an entry of the subtree-extent array is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum EntryKind {
    /// A shape.
    Leaf(ShapeKind),
    /// Operands with an accumulator of their own.
    Nested,
    /// What a modifier holds.
    Modified(ModifierKind),
    /// Operands that may be skipped together.
    Run,
}

/// One entry of the subtree-extent array, without its numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Entry {
    /// What it is.
    pub kind: EntryKind,
    /// Entries of this one and all below.
    pub extent: u32,
    /// How it joins what precedes it.
    pub join: Join,
    /// Kernel of the blend; `None` where the joint is hard.
    pub kernel: Option<u8>,
    /// Only moved, not turned or scaled; leaves and modifiers only.
    pub moved: bool,
    /// Its field is taken without a factor; leaves and modifiers only.
    pub unscaled: bool,
    /// Whether it may be skipped by its bounds; all but leaves.
    pub bounded: bool,
}

impl Entry {
    /// Rows of numbers that it takes.
    pub fn rows(&self) -> usize {
        match self.kind {
            EntryKind::Leaf(shape) => LEAF_ROWS + shape.rows(),
            EntryKind::Modified(kind) => MODIFIER_ROWS + modifier_rows(kind),
            EntryKind::Nested | EntryKind::Run => GROUP_ROWS,
        }
    }
}

/// The structure of a component. Equal structures share a kernel; a dragged value stays within one.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Structure {
    /// The entries in pre-order.
    pub entries: Vec<Entry>,
}

impl Structure {
    /// The structure of a component, or `None` where it is too large for a kernel.
    pub fn of(flat: &FlatScene, component: &Component) -> Option<Self> {
        fits(component).then(|| Self::whole(flat, component))
    }

    /// The structure of a component of any size.
    pub fn whole(flat: &FlatScene, component: &Component) -> Self {
        let range = component.first as usize..(component.first + component.count) as usize;
        Self { entries: flat.nodes[range].iter().map(|node| entry(flat, node)).collect() }
    }

    /// A key that equal structures share and different ones practically never (128 bits of FNV-1a), made
    /// without building the structure. `None` where it is too large for a kernel.
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

    /// A key of everything about a component of any size, its numbers too.
    pub fn baked_key(flat: &FlatScene, component: &Component) -> u128 {
        let range = |first: u32, count: u32| first as usize..(first + count) as usize;
        let codes = flat.nodes[range(component.first, component.count)].iter().map(|node| node.code);
        let numbers = flat.numbers[range(component.numbers, component.rows)].iter().flatten().map(|v| v.to_bits());
        codes.chain(numbers).fold(FNV_START, |hash, word| (hash ^ u128::from(word)).wrapping_mul(FNV_PRIME))
    }

    /// Whether it holds modifiers.
    pub fn is_modified(&self) -> bool {
        self.entries.iter().any(|e| matches!(e.kind, EntryKind::Modified(_)))
    }

    /// Whether it has operators beyond union, intersection and difference.
    pub fn has_further_joins(&self) -> bool {
        self.entries.iter().any(|entry| entry.join.is_further())
    }

    /// What an interpreter must know to evaluate it.
    pub fn features(&self) -> Features {
        let mut features = Features::none();
        features.further = Further {
            joins: self.has_further_joins(),
            kernels: self.entries.iter().any(|e| e.kernel.is_some_and(|k| u32::from(k) >= FIRST_FURTHER_KERNEL)),
        };
        // Where the groups and modifiers under way end.
        let mut open: Vec<usize> = Vec::new();
        for (at, entry) in self.entries.iter().enumerate() {
            open.retain(|end| *end > at);
            match entry.kind {
                EntryKind::Leaf(shape) => {
                    features.shapes.insert(shape);
                }
                EntryKind::Modified(kind) => {
                    features.modifiers.insert(kind);
                    open.push(at + entry.extent as usize);
                }
                EntryKind::Nested => open.push(at + entry.extent as usize),
                EntryKind::Run => {}
            }
            features.stack = features.stack.max((open.len() as u32).next_power_of_two());
        }
        features
    }

    /// Rows of numbers of a component of this structure.
    pub fn rows(&self) -> usize {
        self.entries.iter().map(Entry::rows).sum()
    }
}

/// FNV-1a of 128 bits.
const FNV_START: u128 = 0x6c62_272e_07bb_0142_62b8_2175_6295_c58d;
const FNV_PRIME: u128 = 0x0000_0000_0100_0000_0000_0000_0000_013b;

fn fits(component: &Component) -> bool {
    component.rows - component.data <= MAX_KERNEL_ROWS && component.count <= MAX_KERNEL_ENTRIES
}

fn entry(flat: &FlatScene, node: &FlatNode) -> Entry {
    let rows = &flat.numbers[node.numbers as usize..];
    let joint = rows[0];
    let join = Join::ALL[node.join() as usize];
    let blended = joint[0] > 0.0 && join != Join::First;
    let leaf = node.is_leaf();
    let modifier = node.modifier().is_some();
    let placing = if leaf { 1 } else { GROUP_ROWS };
    let identity = |i: usize| {
        let mut unit = [0.0; 3];
        unit[i] = 1.0;
        rows[placing + i][..3] == unit
    };
    Entry {
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
        unscaled: if leaf { joint[1] == 1.0 } else { modifier && rows[1][3] == 1.0 },
        bounded: !leaf && joint[1] > 0.0,
    }
}
