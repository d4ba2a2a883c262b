//! A list at one point: its value there, and the shorter list that has the same value around the point.

use std::ops::Range;

use glam::DVec3;

use super::domain::Domain;
use super::entry::Entries;
use super::token::{Token, TokenOp};
use crate::flat::Join;
use crate::flat::twin::{Joint, op_join};

/// A token on its way from a cell to its children.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Step {
    pub token: Token,
    /// Where a group begins: how many steps after this one it ends. It stays when lists are moved.
    pub span: u32,
}

/// The entries in `range` as they stand, without their runs; a modifier with all that it holds is one step.
pub(super) fn whole(entries: &Entries<'_>, domains: &[Domain], range: Range<usize>) -> Vec<Step> {
    let mut steps = Vec::with_capacity(range.len() * 2);
    // Groups that are open: the entry behind them, where they begin, and how they end.
    let mut open: Vec<(usize, usize, Token)> = Vec::new();
    let mut index = range.start;
    loop {
        while let Some((_, begin, token)) = open.pop_if(|(end, ..)| *end <= index) {
            close(&mut steps, begin, token);
        }
        if index >= range.end {
            return steps;
        }
        let node = entries.node(index);
        let row = node.numbers - entries.numbers;
        let token = |op| Token::new(op, node, index as u32, row);
        if node.modifier().is_some() {
            let content = domains.iter().skip(1).position(|domain| domain.entries.start == index + 1);
            let content = content.expect("every modifier holds something") + 1;
            steps.push(Step { token: Token::modified(node, index as u32, row, content), span: 0 });
            index += node.extent as usize;
            continue;
        }
        if node.is_leaf() {
            steps.push(Step { token: token(TokenOp::Leaf), span: 0 });
        } else if node.is_group() && node.join() != Join::First as u32 {
            open.push((index + node.extent as usize, steps.len(), token(TokenOp::End)));
            steps.push(Step { token: token(TokenOp::Begin), span: 0 });
        }
        index += 1;
    }
}

fn close(steps: &mut Vec<Step>, begin: usize, end: Token) {
    steps[begin].span = (steps.len() - begin) as u32;
    steps.push(Step { token: end, span: 0 });
}

/// Which operands of a joint matter around a point.
enum Keep {
    First,
    Second,
    Both,
}

impl Keep {
    /// `reach` is how much closer to each other than here the operands, or their sizes, may come around the point.
    fn of(token: Token, entries: &Entries<'_>, a: Value, b: Value, reach: f64) -> Self {
        if a.jumps || b.jumps {
            return Self::Both;
        }
        let (a, b) = (a.at, b.at);
        let Joint { support, size, depth } = entries.joints[token.entry()];
        // By how much the first, or the second, is alone.
        let [first, second] = match Join::ALL[token.join() as usize] {
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
            Join::Remainder => [-(a + b) - support, a + b - support],
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
    /// Whether nothing is known of it beside the point.
    jumps: bool,
}

/// An accumulator that was put aside: its value, where it and the group begin in the new list.
struct Frame {
    value: Value,
    start: usize,
    begin: usize,
}

/// What [`Pruning::run`] works with; kept so that nothing is allocated for a cell.
#[derive(Default)]
pub(super) struct Pruning {
    frames: Vec<Frame>,
}

impl Pruning {
    /// The value of `steps` at `p`, and in `out` those of them that matter where no operand's field
    /// differs from its value at `p` by more than `reach` / 2.
    pub fn run(&mut self, steps: &[Step], entries: &Entries<'_>, p: DVec3, reach: f64, out: &mut Vec<Step>) -> f64 {
        out.clear();
        self.frames.clear();
        let (mut value, mut start) = (Value { at: 0.0, jumps: false }, 0);
        let distance = |entry: usize| Value { at: entries.distance(entry, p), jumps: entries.jumps[entry] };
        let mut at = 0;
        while let Some(step) = steps.get(at) {
            let token = step.token;
            at += 1;
            match token.op() {
                TokenOp::Leaf => {
                    let entry = token.entry();
                    if token.join() == Join::First as u32 {
                        value = distance(entry);
                        start = out.len();
                        out.push(*step);
                    } else if !is_out_of_reach(token, entries, p, value, reach) {
                        value = join_leaf(token, entries, [value, distance(entry)], reach, start, out);
                    }
                }
                TokenOp::Begin if is_out_of_reach(token, entries, p, value, reach) => at += step.span as usize,
                TokenOp::Begin => {
                    self.frames.push(Frame { value, start, begin: out.len() });
                    out.push(*step);
                    start = out.len();
                }
                TokenOp::End => {
                    let frame = self.frames.pop().expect("every group that ends has begun");
                    value = join_group(token, entries, value, &frame, reach, out);
                    start = frame.start;
                }
                TokenOp::Negate => {
                    value.at = -value.at;
                    negate(token, start, out);
                }
            }
        }
        value.at
    }
}

/// Whether an operand is certainly too far off to join what stands so far, told by the ball around it.
#[inline]
fn is_out_of_reach(token: Token, entries: &Entries<'_>, p: DVec3, so_far: Value, reach: f64) -> bool {
    const UNION: u32 = Join::Union as u32;
    const DIFFERENCE: u32 = Join::Difference as u32;
    let far = entries.joints[token.entry()].support + reach;
    let value = so_far.at;
    match token.join() {
        _ if so_far.jumps => false,
        UNION => entries.balls[token.entry()].is_beyond(p, value + far),
        DIFFERENCE => entries.balls[token.entry()].is_beyond(p, far - value),
        _ => false,
    }
}

/// Joins the leaf `b` to the accumulator `a`, which begins at `start`.
fn join_leaf(
    token: Token,
    entries: &Entries<'_>,
    [a, b]: [Value; 2],
    reach: f64,
    start: usize,
    out: &mut Vec<Step>,
) -> Value {
    match Keep::of(token, entries, a, b, reach) {
        Keep::First if token.join() == Join::Remainder as u32 => {
            negate(token, start, out);
            return Value { at: -a.at, ..a };
        }
        Keep::First => return a,
        Keep::Second => {
            out.truncate(start);
            out.push(Step { token: token.as_first(), span: 0 });
            if token.join() != Join::Difference as u32 {
                return b;
            }
            negate(token, start, out);
            return Value { at: -b.at, ..b };
        }
        Keep::Both => out.push(Step { token, span: 0 }),
    }
    joined(token, entries, a, b)
}

/// Joins the group that ends, whose value is `b`, to what was put aside when it began.
fn join_group(token: Token, entries: &Entries<'_>, b: Value, frame: &Frame, reach: f64, out: &mut Vec<Step>) -> Value {
    match Keep::of(token, entries, frame.value, b, reach) {
        Keep::First => {
            out.truncate(frame.begin);
            if token.join() != Join::Remainder as u32 {
                return frame.value;
            }
            negate(token, frame.start, out);
            return Value { at: -frame.value.at, ..frame.value };
        }
        Keep::Second => {
            out.drain(frame.start..=frame.begin);
            if token.join() != Join::Difference as u32 {
                return b;
            }
            negate(token, frame.start, out);
            return Value { at: -b.at, ..b };
        }
        Keep::Both => {}
    }
    // One leaf is all that is left of the group: it can be joined itself, where its own numbers for the
    // joint are the group's.
    match out[frame.begin + 1..] {
        [leaf] if entries.joints[leaf.token.entry()] == entries.joints[token.entry()] => {
            out.truncate(frame.begin);
            out.push(Step { token: leaf.token.joined_as(token), span: 0 });
        }
        _ => close(out, frame.begin, token),
    }
    joined(token, entries, frame.value, b)
}

fn joined(token: Token, entries: &Entries<'_>, a: Value, b: Value) -> Value {
    let joined = op_join(token.join(), a.at, b.at, &entries.joints[token.entry()], token.kernel());
    Value { at: joined.value, jumps: a.jumps || b.jumps }
}

/// Changes the sign of the accumulator that begins at `start`; twice is not at all.
fn negate(token: Token, start: usize, out: &mut Vec<Step>) {
    if out.len() > start && out.last().is_some_and(|last| last.token.op() == TokenOp::Negate) {
        out.pop();
    } else {
        out.push(Step { token: token.with_op(TokenOp::Negate), span: 0 });
    }
}
