//! The words of a tape. An interpreter processes them in order with an accumulator.

use crate::{FlatNode, Join, MAX_FLAT_ROWS};
use isolith_scene::{BlendKernel, ModifierKind, ShapeKind};

/// The operation of a tape entry.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum TapeOp {
    /// Join the distance of a leaf, or of a modifier with its content, to the accumulator; [`Join::First`] replaces
    /// it.
    Leaf,
    /// Begin a group: save the accumulator.
    Begin,
    /// End a group: join the saved accumulator (as a) with the current one (as b), by the group's join.
    End,
    /// Negate the accumulator: only the subtracted operand of a difference is left.
    Negate,
}

/// A tape entry: two words.
///
/// First word: bits 0–7 the shape code, or `MODIFIED` plus a modifier code (leaves only, otherwise meaningless), 8–9
/// the [`TapeOp`], 10–13 the [`Join`] (the group's for both of its ends), 14–16 the blend kernel, 17–31 the entry,
/// counted from the component's first. Second word: bits 0–23 the entry's first row, counted from the component's
/// first, which holds the parameters of the blend; bits 24–31 the index of a modifier's content in
/// [`Component::modifier_domains`](crate::Component::modifier_domains), counted from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TapeEntry(pub [u32; 2]);

/// The limit on entries of a component that has tapes: what a tape entry can address.
pub const MAX_TAPE_ENTRIES: u32 = 1 << (32 - ENTRY_SHIFT);

/// The limit on modifier contents of a component that has tapes: what a tape entry can address.
pub const MAX_TAPE_DOMAINS: usize = 255;

/// The first shape code that stands for a modifier.
pub const MODIFIED: u32 = 0xc0;
const _: () = assert!(ShapeKind::ALL.len() <= MODIFIED as usize && ModifierKind::ALL.len() <= 256 - MODIFIED as usize);

/// The bit position of the index of a modifier's content.
const CONTENT_SHIFT: u32 = 24;
const _: () = assert!(MAX_FLAT_ROWS <= 1 << CONTENT_SHIFT && MAX_TAPE_DOMAINS < 1 << (32 - CONTENT_SHIFT));

const OP_SHIFT: u32 = 8;
const JOIN_SHIFT: u32 = 10;
const KERNEL_SHIFT: u32 = 14;
const ENTRY_SHIFT: u32 = 17;
const JOIN_MASK: u32 = (1 << (KERNEL_SHIFT - JOIN_SHIFT)) - 1;
const KERNEL_MASK: u32 = (1 << (ENTRY_SHIFT - KERNEL_SHIFT)) - 1;
const _: () = assert!(Join::ALL.len() <= JOIN_MASK as usize + 1 && BlendKernel::ALL.len() <= KERNEL_MASK as usize + 1);

impl TapeEntry {
    /// The tape entry of `node`, the component's entry `entry` with its first row at `row`.
    pub(super) fn new(op: TapeOp, node: &FlatNode, entry: u32, row: u32) -> Self {
        let blend_params = (node.join() << JOIN_SHIFT) | (node.kernel() << KERNEL_SHIFT);
        Self([(node.code & 0xff) | ((op as u32) << OP_SHIFT) | blend_params | (entry << ENTRY_SHIFT), row])
    }

    /// The tape entry of a modifier with the content of index `content`.
    pub(super) fn modified(node: &FlatNode, entry: u32, row: u32, content: usize) -> Self {
        let [first, second] = Self::new(TapeOp::Leaf, node, entry, row).0;
        Self([first | MODIFIED, second | ((content as u32) << CONTENT_SHIFT)])
    }

    /// The modifier and the index of its content; `None` for anything else.
    pub fn content(self) -> Option<(ModifierKind, usize)> {
        let kind = self.shape().checked_sub(MODIFIED).filter(|_| self.op() == TapeOp::Leaf)?;
        Some((ModifierKind::ALL[kind as usize], (self.0[1] >> CONTENT_SHIFT) as usize))
    }

    /// The same tape entry with another operation.
    pub(super) fn with_op(self, op: TapeOp) -> Self {
        Self([(self.0[0] & !(3 << OP_SHIFT)) | ((op as u32) << OP_SHIFT), self.0[1]])
    }

    /// The same leaf as the first operand of an accumulator.
    pub(super) fn as_first(self) -> Self {
        const _: () = assert!(Join::First as u32 == 0);
        Self([self.0[0] & !(JOIN_MASK << JOIN_SHIFT), self.0[1]])
    }

    /// The same leaf, joined as `other` is.
    pub(super) fn joined_as(self, other: Self) -> Self {
        let blend_params = (JOIN_MASK << JOIN_SHIFT) | (KERNEL_MASK << KERNEL_SHIFT);
        Self([(self.0[0] & !blend_params) | (other.0[0] & blend_params), self.0[1]])
    }

    /// The operation.
    pub fn op(self) -> TapeOp {
        match (self.0[0] >> OP_SHIFT) & 3 {
            0 => TapeOp::Leaf,
            1 => TapeOp::Begin,
            2 => TapeOp::End,
            _ => TapeOp::Negate,
        }
    }

    /// The shape code; leaves only.
    pub fn shape(self) -> u32 {
        self.0[0] & 0xff
    }

    /// The blend's [`Join`] as a number.
    pub fn join(self) -> u32 {
        (self.0[0] >> JOIN_SHIFT) & JOIN_MASK
    }

    /// The blend's kernel, as a number of [`isolith_scene::BlendKernel::ALL`].
    pub fn kernel(self) -> u32 {
        (self.0[0] >> KERNEL_SHIFT) & KERNEL_MASK
    }

    /// The entry, counted from the component's first.
    pub fn entry(self) -> usize {
        (self.0[0] >> ENTRY_SHIFT) as usize
    }

    /// The entry's first row, counted from the component's first.
    pub fn row(self) -> usize {
        (self.0[1] & ((1 << CONTENT_SHIFT) - 1)) as usize
    }
}
