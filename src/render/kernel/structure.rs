//! What of a component decides its kernel: everything but its numbers.

use crate::flat::{Component, FlatNode, FlatScene, GROUP_ROWS, Join, LEAF_ROWS};
use crate::scene::ShapeKind;

/// Most rows of a component that gets a kernel of its own: 12 KiB of a uniform buffer's 16.
pub const MAX_KERNEL_ROWS: u32 = 768;

/// One entry of the subtree-extent array, without its numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Entry {
    /// The shape; `None` for a group.
    pub shape: Option<ShapeKind>,
    /// Entries of this one and all below.
    pub extent: u32,
    /// How it joins what precedes it.
    pub join: Join,
    /// Kernel of the blend; `None` where the joint is hard.
    pub kernel: Option<u8>,
    /// Only moved, not turned or scaled; leaves only.
    pub moved: bool,
    /// Its field is the shape's, without a factor; leaves only.
    pub unscaled: bool,
    /// Whether it may be skipped by its bounds; groups only.
    pub bounded: bool,
}

impl Entry {
    /// Rows of numbers that it takes.
    pub fn rows(&self) -> usize {
        self.shape.map_or(GROUP_ROWS, |shape| LEAF_ROWS + shape.rows())
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
        if component.rows > MAX_KERNEL_ROWS {
            return None;
        }
        let range = component.first as usize..(component.first + component.count) as usize;
        Some(Self { entries: flat.nodes[range].iter().map(|node| entry(flat, node)).collect() })
    }

    /// A key that equal structures share and different ones practically never (128 bits of FNV-1a), made
    /// without building the structure. `None` where it is too large for a kernel.
    pub fn key(flat: &FlatScene, component: &Component) -> Option<u128> {
        if component.rows > MAX_KERNEL_ROWS {
            return None;
        }
        let range = component.first as usize..(component.first + component.count) as usize;
        let mut hash: u128 = 0x6c62_272e_07bb_0142_62b8_2175_6295_c58d;
        for node in &flat.nodes[range] {
            let e = entry(flat, node);
            let kernel = e.kernel.map_or(0xff, u64::from);
            let flags = u64::from(e.moved) | (u64::from(e.unscaled) << 1) | (u64::from(e.bounded) << 2);
            let shape = e.shape.map_or(0xffff, |s| s as u64);
            let word = shape | ((e.join as u64) << 16) | (kernel << 20) | (flags << 28) | (u64::from(e.extent) << 32);
            hash = (hash ^ u128::from(word)).wrapping_mul(0x0000_0000_0100_0000_0000_0000_0000_013b);
        }
        Some(hash)
    }

    /// Rows of numbers of a component of this structure.
    pub fn rows(&self) -> usize {
        self.entries.iter().map(Entry::rows).sum()
    }
}

fn entry(flat: &FlatScene, node: &FlatNode) -> Entry {
    let rows = &flat.numbers[node.numbers as usize..];
    let joint = rows[0];
    let join = [Join::First, Join::Union, Join::Intersection, Join::Difference][node.join() as usize];
    let blended = joint[0] > 0.0 && join != Join::First;
    let identity = |i: usize| {
        let mut unit = [0.0; 3];
        unit[i] = 1.0;
        rows[1 + i][..3] == unit
    };
    let leaf = !node.is_group();
    Entry {
        shape: leaf.then(|| ShapeKind::ALL[(node.code & 0xffff) as usize]),
        extent: node.extent,
        join,
        kernel: blended.then_some(node.kernel() as u8),
        moved: leaf && identity(0) && identity(1) && identity(2),
        unscaled: leaf && joint[1] == 1.0,
        bounded: !leaf && joint[1] > 0.0,
    }
}
