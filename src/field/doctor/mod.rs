//! The field doctor: looks for nodes whose field breaks its promise, which make rays slow, or which do nothing. It
//! evaluates in f64, names nodes, and proposes a repair where one leaves the rest of the scene as it is.
//!
//! | file | holds, or looks for |
//! |---|---|
//! | `finding` | what is found, what it means, and what repairs it |
//! | `structure` | what nodes themselves say: hidden first operands, scales, empty ones |
//! | `contract` | fields that are not finite, too steep, or larger than the distance; small steps |
//! | `touching` | operands that cut nothing, and results without a surface, by proof |
//! | `solid` | loose parts and thin walls, for those who print |

mod contract;
mod finding;
mod solid;
mod structure;
mod touching;

use super::arrays::{FlatScene, Warning};
pub use contract::{FieldSample, worst_sample};
pub use finding::{Checks, Finding, FindingKind, MAX_FINDINGS, Repair};
use isolith_jobs::{Canceled, Task};
use isolith_scene::Scene;

/// Looks at a scene, whose arrays are `flat`. Findings come gravest first.
///
/// # Errors
/// The task was canceled.
pub fn examine(scene: &Scene, flat: &FlatScene, checks: &Checks, task: &Task) -> Result<Vec<Finding>, Canceled> {
    task.set_stage("structure");
    let mut findings = refused(&flat.warnings);
    findings.extend(structure::findings(scene, flat));
    let fields_end = if checks.wall.is_some() || checks.loose_parts { 0.5 } else { 1.0 };
    for (index, component) in flat.components.iter().enumerate() {
        task.check()?;
        task.set_stage("fields");
        task.set_progress(0.5 * fields_end * index as f32 / flat.components.len() as f32);
        contract::look(flat, component, &mut findings);
    }
    task.set_stage("proofs");
    let told = |share: f32| task.set_progress(fields_end * (0.5 + 0.5 * share));
    findings.extend(touching::findings(flat, task, &told)?);
    if checks.wall.is_some() || checks.loose_parts {
        task.set_stage("solid");
        let told = |share: f32| task.set_progress(fields_end + (1.0 - fields_end) * share);
        findings.extend(solid::findings(flat, checks, task, &told)?);
    }
    task.set_progress(1.0);
    Ok(sorted(findings))
}

/// Gravest first, each node once for a kind.
fn sorted(mut findings: Vec<Finding>) -> Vec<Finding> {
    findings.sort_by_key(|finding| finding.kind);
    let mut kept: Vec<Finding> = Vec::new();
    for finding in findings {
        let alike = |other: &Finding| other.kind == finding.kind;
        let is_told = kept.iter().rev().take_while(|other| alike(other)).any(|other| {
            // Parts and walls of one node are told apart by their places.
            other.node == finding.node && (finding.kind < FindingKind::LoosePart || other.place == finding.place)
        });
        let count = kept.iter().rev().take_while(|other| alike(other)).count();
        if !is_told && count < MAX_FINDINGS {
            kept.push(finding);
        }
    }
    kept
}

fn refused(warnings: &[Warning]) -> Vec<Finding> {
    let finding = |warning: &Warning| Finding {
        node: warning.node,
        kind: FindingKind::Refused,
        detail: warning.reason.clone(),
        place: None,
        repair: None,
    };
    warnings.iter().map(finding).collect()
}

#[cfg(test)]
mod tests;
