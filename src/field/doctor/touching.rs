//! Operands that cut nothing, and components without a surface, by proof: a function that grows by 1 per meter at most
//! and is larger at the center of a box than half its diagonal has no zero in that box.

use std::collections::BTreeMap;

use glam::DVec3;

use super::contract::looked_at;
use super::finding::{Finding, FindingKind};
use super::structure::cuts_nothing;
use crate::eval::{entry_field, field, partial_field};
use crate::{Component, FlatScene, Join};
use isolith_geometry::Aabb;
use isolith_jobs::{Canceled, Task};
use isolith_scene::NodeId;

/// Most evaluations of one proof. What is not decided by then is not told.
const MOST_BOXES: usize = 20_000;
/// Slack for the rounding of the arrays to f32, relative to the size of the box.
const SLACK: f64 = 1e-5;

/// Whether a function is positive everywhere in a box.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Positive {
    /// It is.
    Everywhere,
    /// It is not at one point at least.
    NotEverywhere,
    /// The work ended before it was decided.
    Undecided,
}

/// Decides whether `function`, of slope 1 at most, is above 0 in all of the box.
pub fn is_positive(function: &dyn Fn(DVec3) -> f64, bounds: &Aabb) -> Positive {
    let slack = SLACK * bounds.half().length();
    let mut open = vec![*bounds];
    let mut looked_at = 0;
    while let Some(region) = open.pop() {
        looked_at += 1;
        if looked_at > MOST_BOXES {
            return Positive::Undecided;
        }
        let (center, half) = (region.center(), region.half());
        let value = function(center);
        if value <= 0.0 {
            return Positive::NotEverywhere;
        }
        if value > half.length() + slack {
            continue;
        }
        if half.max_element() < slack {
            return Positive::Undecided;
        }
        // Along the longest side, so that parts stay as round as possible.
        let longest = if half.x >= half.y && half.x >= half.z {
            DVec3::X
        } else if half.y >= half.z {
            DVec3::Y
        } else {
            DVec3::Z
        };
        let part = half - half * longest * 0.5;
        for side in [-0.5, 0.5] {
            open.push(Aabb::from_center_half(center + half * longest * side, part));
        }
    }
    Positive::Everywhere
}

/// The findings of all components.
pub fn findings(flat: &FlatScene, task: &Task, told: &dyn Fn(f32)) -> Result<Vec<Finding>, Canceled> {
    // Whether each operand that cuts is proven to cut nothing, in every component in which it stands.
    let mut cutters: BTreeMap<NodeId, bool> = BTreeMap::new();
    let mut found = Vec::new();
    for (index, component) in flat.components.iter().enumerate() {
        task.check()?;
        told(index as f32 / flat.components.len() as f32);
        let bounds = looked_at(component);
        let all = component.first as usize..(component.first + component.count) as usize;
        look_at_fold(flat, component, all, &bounds, task, &mut cutters)?;
        let is_composed = component.count > 1 && component.bounds.is_finite();
        if is_composed && is_positive(&|p| field(flat, component, p), &bounds) == Positive::Everywhere {
            found.push(Finding {
                node: flat.ids[component.first as usize],
                kind: FindingKind::Empty,
                detail: "its operands leave nothing over".to_owned(),
                place: None,
                repair: None,
            });
        }
    }
    found.extend(cutters.into_iter().filter(|(_, is_idle)| *is_idle).map(|(node, _)| cuts_nothing(node)));
    Ok(found)
}

fn look_at_fold(
    flat: &FlatScene,
    component: &Component,
    range: std::ops::Range<usize>,
    bounds: &Aabb,
    task: &Task,
    cutters: &mut BTreeMap<NodeId, bool>,
) -> Result<(), Canceled> {
    let mut at = range.start;
    while at < range.end {
        let node = &flat.nodes[at];
        if node.is_run() {
            at += 1;
            continue;
        }
        let end = at + node.extent as usize;
        let is_cutter = at > range.start && node.join() == Join::Difference as u32;
        if is_cutter && component.bounds.is_finite() {
            task.check()?;
            let support = f64::from(flat.params[node.params as usize][0]);
            let apart = |p: DVec3| {
                let before = partial_field(flat, component, range.start..at, p);
                before.max(entry_field(flat, component, at, p)) - support
            };
            let is_idle = is_positive(&apart, bounds) == Positive::Everywhere;
            *cutters.entry(flat.ids[at]).or_insert(true) &= is_idle;
        }
        // Within a modifier boxes are other boxes.
        if !node.is_leaf() && node.modifier().is_none() {
            look_at_fold(flat, component, at + 1..end, bounds, task, cutters)?;
        }
        at = end;
    }
    Ok(())
}
