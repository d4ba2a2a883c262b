//! The scene at a moment: its tracks put into the values of their parameters.

use std::borrow::Cow;
use std::sync::Arc;

use super::track::Track;
use crate::check::{self, Fault};
use crate::limits::{Limits, Rule};
use crate::params::Params;
use crate::{Material, Node, NodeId, Param, ParamOwner, ParamPath, ParamValue, Scene};

impl Scene {
    /// The scene as it is at `time` seconds. It shares all nodes and materials whose values differ in nothing from
    /// those at rest; without tracks it is the scene itself. Values are held to their limits.
    pub fn at(&self, time: f64) -> Cow<'_, Self> {
        self.at_with_faults(time).0
    }

    /// The same, and the nodes that stay at rest at this moment because their values contradict each other, such as a
    /// camera whose clip start is beyond its clip end.
    pub fn at_with_faults(&self, time: f64) -> (Cow<'_, Self>, Vec<(NodeId, Fault)>) {
        if self.animation.is_empty() {
            return (Cow::Borrowed(self), Vec::new());
        }
        let mut shown = self.clone();
        let mut faults = Vec::new();
        for tracks in self.animation.tracks().chunk_by(|a, b| is_same_owner(&a.path, &b.path)) {
            match tracks[0].path.owner {
                ParamOwner::Node(id, _) => {
                    if let Some(index) = self.index_of(id)
                        && let Err(fault) = shown.move_node(index, tracks, time)
                    {
                        faults.push((id, fault));
                    }
                }
                ParamOwner::Material(id) => {
                    let place = self.materials.iter().position(|material| material.id == id);
                    if let Some(place) = place {
                        let mut material = Material::clone(&self.materials[place]);
                        set_all(tracks, time, &mut material);
                        if material != *self.materials[place] {
                            shown.materials[place] = Arc::new(material);
                        }
                    }
                }
                ParamOwner::Environment => set_all(tracks, time, &mut shown.environment),
                ParamOwner::Display => set_all(tracks, time, &mut shown.display),
            }
        }
        (Cow::Owned(shown), faults)
    }

    fn move_node(&mut self, index: usize, tracks: &[Arc<Track>], time: f64) -> Result<(), Fault> {
        let resting = &self.nodes[index];
        let mut node = Node::clone(resting);
        for track in tracks {
            let ParamOwner::Node(_, part) = track.path.owner else { continue };
            if let Some(params) = part.params_mut(&mut node) {
                set(track, time, params);
            }
        }
        if node != **resting {
            check::node(&node)?;
            self.nodes[index] = Arc::new(node);
        }
        Ok(())
    }
}

fn set_all(tracks: &[Arc<Track>], time: f64, params: &mut dyn Params) {
    for track in tracks {
        set(track, time, params);
    }
}

fn set(track: &Track, time: f64, params: &mut dyn Params) {
    let ParamPath { name, .. } = &track.path;
    if let (Some(param), Some(value)) = (params.find(name), track.value_at(time)) {
        track.path.set_value(params, held(param, value));
    }
}

/// The value within the limits of its parameter. Keys keep them, but what is between two scales of opposite signs does
/// not.
fn held(param: &Param, value: ParamValue) -> ParamValue {
    let limits = &param.limits;
    match value {
        ParamValue::Scalar(v) => ParamValue::Scalar(within(v, limits)),
        ParamValue::Vector(v) => ParamValue::Vector(v.to_array().map(|v| within(v, limits)).into()),
        ParamValue::Count(n) => ParamValue::Count(within(f64::from(n), limits) as u32),
        ParamValue::Counts(n) => ParamValue::Counts(n.map(|n| within(f64::from(n), limits) as u32)),
        other => other,
    }
}

fn within(value: f64, limits: &Limits) -> f64 {
    let [least, most] = limits.hard;
    match limits.rule {
        Rule::Magnitude => value.abs().clamp(least, most).copysign(value),
        Rule::Any | Rule::Whole => value.clamp(least, most),
    }
}

/// Whether two parameters belong to the same node, material, environment or display.
fn is_same_owner(a: &ParamPath, b: &ParamPath) -> bool {
    match (a.owner, b.owner) {
        (ParamOwner::Node(a, _), ParamOwner::Node(b, _)) => a == b,
        (a, b) => a == b,
    }
}
