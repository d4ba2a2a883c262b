//! Animation clips: the transforms of nodes and the weights of morph targets at a time (specification, 3.11).

use std::collections::BTreeMap;

use glam::{DQuat, DVec3, DVec4};

use super::accessor::Source;
use super::clip_schema::{Animation, ClipSampler};
use super::error::{LoadRefusal, name};
use super::limits::MAX_KEYS;
use super::model_pose::ClipTime;
use super::remarks::Remarks;
use super::schema::Root;

/// A clip of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct ClipInfo {
    /// Its name, or its number if it has none.
    pub name: String,
    /// Its length in seconds.
    pub seconds: f64,
}

/// What a clip sets of a node.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct NodePose {
    pub translation: Option<DVec3>,
    pub rotation: Option<DQuat>,
    pub scale: Option<DVec3>,
    pub weights: Option<Vec<f64>>,
}

/// What a clip sets, by node; empty at rest.
pub(super) type Poses = BTreeMap<usize, NodePose>;

/// The clips of a document. What is broken in one counts when it is played.
pub(super) fn clips(source: &Source<'_>) -> Vec<ClipInfo> {
    let info = |(index, animation): (usize, &Animation)| {
        let seconds = length(source, animation, index).unwrap_or(0.0);
        ClipInfo { name: title(index, animation), seconds }
    };
    source.root.animations.iter().enumerate().map(info).collect()
}

fn title(index: usize, animation: &Animation) -> String {
    animation.name.as_deref().filter(|title| !title.is_empty()).map_or(index.to_string(), name)
}

/// The last time of a clip's keys.
fn length(source: &Source<'_>, animation: &Animation, index: usize) -> Result<f64, LoadRefusal> {
    let mut last = 0.0_f64;
    for (s, sampler) in animation.samplers.iter().enumerate() {
        let times = times(source, sampler, &format!("animations[{index}].samplers[{s}]"))?;
        last = last.max(times.last().copied().unwrap_or(0.0));
    }
    Ok(last)
}

/// What the clip sets at its time. A clip that is missing leaves the model at rest, with a remark.
pub(super) fn poses(source: &Source<'_>, clip: &ClipTime, remarks: &mut Remarks) -> Result<Poses, LoadRefusal> {
    let root: &Root = source.root;
    let by_name = root.animations.iter().position(|animation| animation.name.as_deref() == Some(&clip.name));
    let by_number = || clip.name.parse().ok().filter(|index: &usize| *index < root.animations.len());
    let Some(index) = by_name.or_else(by_number) else {
        remarks.add(missing(root, &clip.name));
        return Ok(Poses::new());
    };
    let animation = &root.animations[index];
    let seconds = length(source, animation, index)?;
    let is_within = (0.0..=seconds).contains(&clip.time);
    let time = if is_within || seconds == 0.0 { clip.time } else { clip.time.rem_euclid(seconds) };
    let mut poses = Poses::new();
    for (c, channel) in animation.channels.iter().enumerate() {
        let place = format!("animations[{index}].channels[{c}]");
        let Some(node) = channel.target.node else { continue };
        let Some(entry) = root.nodes.get(node.index()) else {
            return Err(LoadRefusal::at(format!("{place}.target"), format!("names node {}, which is missing", node.0)));
        };
        let Some(sampler) = animation.samplers.get(channel.sampler.index()) else {
            let reason = format!("names sampler {}, which is missing", channel.sampler.0);
            return Err(LoadRefusal::at(place, reason));
        };
        let place = format!("animations[{index}].samplers[{}]", channel.sampler.0);
        let pose = poses.entry(node.index()).or_default();
        match &*channel.target.path {
            "translation" => pose.translation = Some(vector(&sampled::<3>(source, sampler, 1, time, false, &place)?)),
            "scale" => pose.scale = Some(vector(&sampled::<3>(source, sampler, 1, time, false, &place)?)),
            "rotation" => {
                let turned = sampled::<4>(source, sampler, 1, time, true, &place)?;
                let turned = DQuat::from_vec4(DVec4::from(turned[0]));
                if turned.length() < 1e-6 {
                    return Err(LoadRefusal::at(format!("{place}.output"), "is not a rotation"));
                }
                pose.rotation = Some(turned.normalize());
            }
            "weights" => {
                let of_mesh = entry.mesh.and_then(|mesh| root.meshes.get(mesh.index()));
                let targets =
                    of_mesh.map_or(0, |mesh| mesh.primitives.iter().map(|p| p.targets.len()).max().unwrap_or(0));
                if targets > 0 {
                    let weights = sampled::<1>(source, sampler, targets, time, false, &place)?;
                    pose.weights = Some(weights.into_iter().map(|[weight]| weight).collect());
                }
            }
            other => remarks.add(format!("the clip moves “{}”, which is not supported; it stays at rest", name(other))),
        }
    }
    Ok(poses)
}

/// The remark about a clip that a file does not have.
fn missing(root: &Root, wanted: &str) -> String {
    const NAMED: usize = 8;
    let all: Vec<_> = root.animations.iter().enumerate().map(|(i, animation)| title(i, animation)).collect();
    let has = match &*all {
        [] => "it has none".to_owned(),
        all if all.len() > NAMED => format!("it has “{}” and {} more", all[..NAMED].join("”, “"), all.len() - NAMED),
        all => format!("it has “{}”", all.join("”, “")),
    };
    format!("has no clip “{}”, so the model is shown at rest; {has}", name(wanted))
}

fn vector(value: &[[f64; 3]]) -> DVec3 {
    DVec3::from(value[0])
}

/// The times of the keys: at least one, finite, none before the one before it.
fn times(source: &Source<'_>, sampler: &ClipSampler, place: &str) -> Result<Vec<f64>, LoadRefusal> {
    let user = format!("{place}.input");
    if source.count(sampler.input) > MAX_KEYS as u64 {
        return Err(LoadRefusal::at(user, format!("has more than {MAX_KEYS} entries")));
    }
    let times: Vec<f64> = source.floats::<1>(sampler.input, 1, &user)?.into_iter().map(|[t]| f64::from(t)).collect();
    if times.iter().any(|t| !t.is_finite()) || times.windows(2).any(|pair| pair[1] < pair[0]) {
        return Err(LoadRefusal::at(user, "is not a list of times in their order"));
    }
    Ok(times)
}

/// The value at a time: of `width` entries, each of `N` numbers. Before the first and behind the last key it stays as
/// it is there. Rotations go the shorter way round.
fn sampled<const N: usize>(
    source: &Source<'_>,
    sampler: &ClipSampler,
    width: usize,
    time: f64,
    is_rotation: bool,
    place: &str,
) -> Result<Vec<[f64; N]>, LoadRefusal> {
    let times = times(source, sampler, place)?;
    let user = format!("{place}.output");
    let kind = sampler.interpolation.as_deref().unwrap_or("LINEAR");
    let is_spline = kind == "CUBICSPLINE";
    let per_key = if is_spline { 3 * width } else { width };
    let count = source.count(sampler.output);
    if count != (times.len() * per_key) as u64 {
        return Err(LoadRefusal::at(user, format!("has {count} entries for {} keys of {per_key}", times.len())));
    }
    let values = source.floats::<N>(sampler.output, N, &user)?;
    if let Some(i) = values.iter().position(|value| value.iter().any(|v| !v.is_finite())) {
        return Err(LoadRefusal::at(user, format!("is not finite at entry {i}")));
    }
    // Of a spline, each key has its tangent before, its value, and its tangent behind.
    let entry = |key: usize, part: usize, i: usize| values[key * per_key + part * width + i].map(f64::from);
    let value = |key: usize, i: usize| entry(key, usize::from(is_spline), i);
    let after = times.partition_point(|t| *t <= time);
    if after == 0 || after == times.len() || kind == "STEP" {
        let key = after.saturating_sub(1);
        return Ok((0..width).map(|i| value(key, i)).collect());
    }
    let (key, next) = (after - 1, after);
    let span = times[next] - times[key];
    let share = (time - times[key]) / span;
    let mixed = |i: usize| {
        let (from, to) = (value(key, i), value(next, i));
        if is_spline {
            return hermite(from, entry(key, 2, i), to, entry(next, 0, i), share, span);
        }
        if is_rotation {
            return turned(from, to, share);
        }
        std::array::from_fn(|c| from[c] + (to[c] - from[c]) * share)
    };
    Ok((0..width).map(mixed).collect())
}

/// The cubic Hermite spline (specification, appendix C.5).
fn hermite<const N: usize>(
    from: [f64; N],
    leaving: [f64; N],
    to: [f64; N],
    arriving: [f64; N],
    t: f64,
    span: f64,
) -> [f64; N] {
    let (t2, t3) = (t * t, t * t * t);
    std::array::from_fn(|c| {
        (2.0 * t3 - 3.0 * t2 + 1.0) * from[c]
            + span * (t3 - 2.0 * t2 + t) * leaving[c]
            + (3.0 * t2 - 2.0 * t3) * to[c]
            + span * (t3 - t2) * arriving[c]
    })
}

/// Between two rotations at constant speed, the shorter way round.
fn turned<const N: usize>(from: [f64; N], to: [f64; N], share: f64) -> [f64; N] {
    let quaternion = |v: &[f64; N]| DQuat::from_array(std::array::from_fn(|c| v.get(c).copied().unwrap_or(0.0)));
    let (from, to) = (quaternion(&from), quaternion(&to));
    if from.length_squared() == 0.0 || to.length_squared() == 0.0 {
        return [0.0; N];
    }
    let mixed = from.normalize().slerp(to.normalize(), share).to_array();
    std::array::from_fn(|c| mixed.get(c).copied().unwrap_or(0.0))
}
