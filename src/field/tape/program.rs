//! A tape at one point: its value there, and the simplified tape with the same value around the point.

use std::ops::Range;

use glam::DVec3;

use super::domain::Domain;
use super::entry::Entries;
use super::tape_entry::{TapeEntry, TapeOp};
use crate::Join;
use crate::eval::{BlendParams, op_join};

/// A tape entry while it passes from a cell to its children.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Step {
    pub tape_entry: TapeEntry,
    /// For the begin of a group: the number of steps to its end. It stays valid when tapes are moved.
    pub span: u32,
}

/// The entries in `range` in their order, without their runs; a modifier and its content are one step.
pub(super) fn full_tape(entries: &Entries<'_>, domains: &[Domain], range: Range<usize>) -> Vec<Step> {
    let mut steps = Vec::with_capacity(range.len() * 2);
    // Open groups: the entry after them, the step of their begin, and their end.
    let mut open: Vec<(usize, usize, TapeEntry)> = Vec::new();
    let mut index = range.start;
    loop {
        while let Some((_, begin, tape_entry)) = open.pop_if(|(end, ..)| *end <= index) {
            close(&mut steps, begin, tape_entry);
        }
        if index >= range.end {
            return steps;
        }
        let node = entries.node(index);
        let row = node.params - entries.params;
        let tape_entry = |op| TapeEntry::new(op, node, index as u32, row);
        if node.modifier().is_some() {
            let content = domains.iter().skip(1).position(|domain| domain.entries.start == index + 1);
            let content = content.expect("every modifier holds something") + 1;
            steps.push(Step { tape_entry: TapeEntry::modified(node, index as u32, row, content), span: 0 });
            index += node.extent as usize;
            continue;
        }
        if node.is_leaf() {
            steps.push(Step { tape_entry: tape_entry(TapeOp::Leaf), span: 0 });
        } else if node.is_group() && node.join() != Join::First as u32 {
            open.push((index + node.extent as usize, steps.len(), tape_entry(TapeOp::End)));
            steps.push(Step { tape_entry: tape_entry(TapeOp::Begin), span: 0 });
        }
        index += 1;
    }
}

fn close(steps: &mut Vec<Step>, begin: usize, end: TapeEntry) {
    steps[begin].span = (steps.len() - begin) as u32;
    steps.push(Step { tape_entry: end, span: 0 });
}

/// Which operands of a blend matter around a point.
enum Keep {
    First,
    Second,
    Both,
}

impl Keep {
    /// `reach` is the bound on how much the difference of the operands, or of their magnitudes, shrinks around the
    /// point.
    fn of(tape_entry: TapeEntry, entries: &Entries<'_>, a: Value, b: Value, reach: f64) -> Self {
        if a.jumps || b.jumps {
            return Self::Both;
        }
        let (a, b) = (a.at, b.at);
        let BlendParams { support, size, depth } = entries.blend_params[tape_entry.entry()];
        // By how much the first, or the second, is the only one that matters.
        let [first, second] = match Join::ALL[tape_entry.join() as usize] {
            Join::First => [f64::NEG_INFINITY, f64::INFINITY],
            Join::Union => [b - a - support, a - b - support],
            Join::Intersection => [a - b - support, b - a - support],
            Join::Difference => [a + b - support, -(a + b) - support],
            Join::Xor => [b - a.abs() - support, a - b.abs() - support],
            Join::Groove => [a + b.abs() - size - support, f64::NEG_INFINITY],
            Join::Tongue => [b.abs() - a - size - support, f64::NEG_INFINITY],
            Join::Engrave => [a + b.abs() - depth - 2.0 * support, f64::NEG_INFINITY],
            Join::Paint => [b - support, f64::NEG_INFINITY],
            Join::Pipe | Join::Morph => [f64::NEG_INFINITY; 2],
            Join::ReverseDifference => [-(a + b) - support, a + b - support],
        };
        match () {
            () if first >= reach => Self::First,
            () if second >= reach => Self::Second,
            () => Self::Both,
        }
    }
}

/// A value at a point.
#[derive(Clone, Copy)]
struct Value {
    at: f64,
    /// Whether the value says nothing about points beside this one.
    jumps: bool,
}

/// A saved accumulator: its value, and where it and the group begin in the new tape.
struct GroupFrame {
    value: Value,
    start: usize,
    begin: usize,
}

/// The buffers of [`Simplifier::run`], kept to avoid allocations per cell.
#[derive(Default)]
pub(super) struct Simplifier {
    frames: Vec<GroupFrame>,
}

impl Simplifier {
    /// The value of `steps` at `p`. `out` receives the steps that matter where no operand's field differs from its
    /// value at `p` by more than `reach` / 2.
    pub fn run(&mut self, steps: &[Step], entries: &Entries<'_>, p: DVec3, reach: f64, out: &mut Vec<Step>) -> f64 {
        out.clear();
        self.frames.clear();
        let (mut value, mut start) = (Value { at: 0.0, jumps: false }, 0);
        let distance = |entry: usize| Value { at: entries.distance(entry, p), jumps: entries.jumps[entry] };
        let mut at = 0;
        while let Some(step) = steps.get(at) {
            let tape_entry = step.tape_entry;
            at += 1;
            match tape_entry.op() {
                TapeOp::Leaf => {
                    let entry = tape_entry.entry();
                    if tape_entry.join() == Join::First as u32 {
                        value = distance(entry);
                        start = out.len();
                        out.push(*step);
                    } else if !is_out_of_reach(tape_entry, entries, p, value, reach) {
                        value = join_leaf(tape_entry, entries, [value, distance(entry)], reach, start, out);
                    }
                }
                TapeOp::Begin if is_out_of_reach(tape_entry, entries, p, value, reach) => at += step.span as usize,
                TapeOp::Begin => {
                    self.frames.push(GroupFrame { value, start, begin: out.len() });
                    out.push(*step);
                    start = out.len();
                }
                TapeOp::End => {
                    let frame = self.frames.pop().expect("every group that ends has begun");
                    value = join_group(tape_entry, entries, value, &frame, reach, out);
                    start = frame.start;
                }
                TapeOp::Negate => {
                    value.at = -value.at;
                    negate(tape_entry, start, out);
                }
            }
        }
        value.at
    }
}

/// Whether an operand's bounding sphere proves that it is too far away to join the accumulator.
#[inline]
fn is_out_of_reach(tape_entry: TapeEntry, entries: &Entries<'_>, p: DVec3, so_far: Value, reach: f64) -> bool {
    const UNION: u32 = Join::Union as u32;
    const DIFFERENCE: u32 = Join::Difference as u32;
    let far = entries.blend_params[tape_entry.entry()].support + reach;
    let value = so_far.at;
    match tape_entry.join() {
        _ if so_far.jumps => false,
        UNION => entries.spheres[tape_entry.entry()].is_beyond(p, value + far),
        DIFFERENCE => entries.spheres[tape_entry.entry()].is_beyond(p, far - value),
        _ => false,
    }
}

/// Joins the leaf `b` to the accumulator `a`, which begins at `start`.
fn join_leaf(
    tape_entry: TapeEntry,
    entries: &Entries<'_>,
    [a, b]: [Value; 2],
    reach: f64,
    start: usize,
    out: &mut Vec<Step>,
) -> Value {
    match Keep::of(tape_entry, entries, a, b, reach) {
        Keep::First if tape_entry.join() == Join::ReverseDifference as u32 => {
            negate(tape_entry, start, out);
            return Value { at: -a.at, ..a };
        }
        Keep::First => return a,
        Keep::Second => {
            out.truncate(start);
            out.push(Step { tape_entry: tape_entry.as_first(), span: 0 });
            if tape_entry.join() != Join::Difference as u32 {
                return b;
            }
            negate(tape_entry, start, out);
            return Value { at: -b.at, ..b };
        }
        Keep::Both => out.push(Step { tape_entry, span: 0 }),
    }
    joined(tape_entry, entries, a, b)
}

/// Joins the group that ends, whose value is `b`, to the accumulator saved at its begin.
fn join_group(
    tape_entry: TapeEntry,
    entries: &Entries<'_>,
    b: Value,
    frame: &GroupFrame,
    reach: f64,
    out: &mut Vec<Step>,
) -> Value {
    match Keep::of(tape_entry, entries, frame.value, b, reach) {
        Keep::First => {
            out.truncate(frame.begin);
            if tape_entry.join() != Join::ReverseDifference as u32 {
                return frame.value;
            }
            negate(tape_entry, frame.start, out);
            return Value { at: -frame.value.at, ..frame.value };
        }
        Keep::Second => {
            out.drain(frame.start..=frame.begin);
            if tape_entry.join() != Join::Difference as u32 {
                return b;
            }
            negate(tape_entry, frame.start, out);
            return Value { at: -b.at, ..b };
        }
        Keep::Both => {}
    }
    // Only one leaf of the group is left: it can join directly if its own blend parameters are the group's.
    match out[frame.begin + 1..] {
        [leaf] if entries.blend_params[leaf.tape_entry.entry()] == entries.blend_params[tape_entry.entry()] => {
            out.truncate(frame.begin);
            out.push(Step { tape_entry: leaf.tape_entry.joined_as(tape_entry), span: 0 });
        }
        _ => close(out, frame.begin, tape_entry),
    }
    joined(tape_entry, entries, frame.value, b)
}

fn joined(tape_entry: TapeEntry, entries: &Entries<'_>, a: Value, b: Value) -> Value {
    let joined = op_join(tape_entry.join(), a.at, b.at, &entries.blend_params[tape_entry.entry()], tape_entry.kernel());
    Value { at: joined.value, jumps: a.jumps || b.jumps }
}

/// Negates the accumulator that begins at `start`; two negations cancel.
fn negate(tape_entry: TapeEntry, start: usize, out: &mut Vec<Step>) {
    if out.len() > start && out.last().is_some_and(|last| last.tape_entry.op() == TapeOp::Negate) {
        out.pop();
    } else {
        out.push(Step { tape_entry: tape_entry.with_op(TapeOp::Negate), span: 0 });
    }
}
