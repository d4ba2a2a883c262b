//! Samples the field of each component: finite, with a gradient of length 1 at most, and never larger than the
//! distance to the surface. Where it is not, the innermost entry that breaks the promise is named.

use glam::DVec3;

use super::finding::{Finding, FindingKind};
use crate::eval::{content_point, entry_field, entry_gradient, field, gradient, surface};
use crate::{Component, FlatScene};
use isolith_geometry::Aabb;

/// Points in the bounds of a component.
const SAMPLES: usize = 96;
/// Side of the box that is looked at where a component has no bounds, in meters.
const UNBOUNDED: f64 = 20.0;
/// Newton steps from a point to the surface.
const NEWTON: usize = 12;
/// A point counts as on the surface at this value, relative to the size of the bounds.
const ON_SURFACE: f64 = 1e-6;
/// Deviations of slopes up to this are rounding of the arrays to f32.
const ROUNDING: f64 = 1e-3;
/// Length of the step by which slopes are confirmed, relative to the size of the bounds.
const SECANT: f64 = 1e-4;
/// Deviations of distances up to this, relative to the size of the bounds.
const DISTANCE_ROUNDING: f64 = 1e-5;
/// Distance from the surface at which steps are judged, relative to the size of the bounds.
const NEAR: f64 = 0.04;
/// A step that is smaller by this factor is worth telling.
const SMALL: f64 = 5.0;

/// The worst of a field's samples.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FieldSample {
    /// A point where it is not finite.
    pub not_finite: Option<DVec3>,
    /// The longest gradient that is longer than 1, and its place.
    pub steep: Option<(f64, DVec3)>,
    /// The most by which it exceeds the distance to a point of the surface, in meters, and the place.
    pub overstep: Option<(f64, DVec3)>,
}

impl FieldSample {
    fn is_sound(&self) -> bool {
        *self == Self::default()
    }
}

/// Samples a field with its gradient in a box; `seeds` are further points to look at.
pub fn worst_sample(field: &dyn Fn(DVec3) -> (f64, DVec3), bounds: &Aabb, seeds: &[DVec3]) -> FieldSample {
    let points: Vec<DVec3> =
        (0..SAMPLES).map(|i| bounds.min + spread_point(i) * 2.0 * bounds.half()).chain(seeds.iter().copied()).collect();
    let size = bounds.half().length();
    let mut worst = FieldSample::default();
    let mut told = |p: DVec3| {
        let (value, slope) = field(p);
        if !value.is_finite() || !slope.is_finite() {
            worst.not_finite.get_or_insert(p);
            return None;
        }
        let length = slope.length();
        if length > 1.0 + ROUNDING {
            // On a ridge a derivative may be longer than the field is steep: values decide.
            let step = slope / length * (SECANT * size);
            let rise = |to: DVec3| (field(to).0 - value).abs() / (SECANT * size);
            let secant = rise(p + step).max(rise(p - step));
            if secant > 1.0 + ROUNDING && worst.steep.is_none_or(|(most, _)| secant > most) {
                worst.steep = Some((secant, p));
            }
        }
        Some((value, slope))
    };
    let mut on_surface = Vec::new();
    for start in &points {
        let mut p = *start;
        for _ in 0..NEWTON {
            let Some((value, slope)) = told(p) else { break };
            if value.abs() <= ON_SURFACE * size {
                on_surface.push(p);
                break;
            }
            // A field that promises less than the distance is followed with its slope.
            let squared = slope.length_squared();
            if squared < 1e-12 {
                break;
            }
            p -= slope * (value / squared).clamp(-size, size);
        }
    }
    for p in &points {
        let (value, _) = field(*p);
        let nearest = on_surface.iter().map(|s| s.distance(*p)).fold(f64::INFINITY, f64::min);
        let excess = value.abs() - nearest;
        if excess > DISTANCE_ROUNDING * size && worst.overstep.is_none_or(|(most, _)| excess > most) {
            worst.overstep = Some((excess, *p));
        }
    }
    worst
}

/// The point `index` of a sequence that fills the unit cube evenly: Martin Roberts, "The unreasonable effectiveness of
/// quasirandom sequences" (2018), with the plastic number of three dimensions.
fn spread_point(index: usize) -> DVec3 {
    const G: f64 = 1.220_744_084_605_759_6;
    let n = index as f64 + 1.0;
    DVec3::new(0.5 + n / G, 0.5 + n / (G * G), 0.5 + n / (G * G * G)).map(f64::fract)
}

/// Looks at a component.
pub fn look(flat: &FlatScene, component: &Component, findings: &mut Vec<Finding>) {
    let bounds = looked_at(component);
    let worst = worst_sample(&|p| gradient(flat, component, p), &bounds, &[]);
    if !worst.is_sound() {
        findings.extend(named(flat, component, &worst, &bounds));
    }
    findings.extend(small_steps(flat, component, &bounds));
}

/// The bounds of a component, relative to its origin, with some room around.
pub fn looked_at(component: &Component) -> Aabb {
    let bounds = component.bounds;
    if bounds.is_finite() && !bounds.is_empty() {
        return bounds.expanded(0.1 * bounds.half().length() + 1e-9);
    }
    Aabb::from_center_half(DVec3::ZERO, DVec3::splat(0.5 * UNBOUNDED))
}

fn named(flat: &FlatScene, component: &Component, worst: &FieldSample, bounds: &Aabb) -> Vec<Finding> {
    let all = component.first as usize..(component.first + component.count) as usize;
    let node = |is_bad: &dyn Fn(usize, DVec3) -> bool, p: DVec3| {
        let entry = innermost(flat, component, all.clone(), p, is_bad).unwrap_or(all.start);
        flat.ids[entry]
    };
    let place = |p: DVec3| component.instanced.is_none().then(|| p + component.origin);
    let finding = |kind, node, detail, p| Finding { node, kind, detail, place: place(p), repair: None };
    let mut found = Vec::new();
    if let Some(p) = worst.not_finite {
        let is_bad = |entry: usize, q: DVec3| !entry_field(flat, component, entry, q).is_finite();
        let detail = "the value at one point at least is not a number".to_owned();
        found.push(finding(FindingKind::NotFinite, node(&is_bad, p), detail, p));
    }
    let slope_at = |entry: usize, q: DVec3| entry_gradient(flat, component, entry, q).1.length();
    if let Some((slope, p)) = worst.steep {
        let is_bad = |entry: usize, q: DVec3| slope_at(entry, q) > 1.0 + ROUNDING;
        let detail = format!("the gradient is {slope:.3} long, and 1 is the limit");
        found.push(finding(FindingKind::Steep, node(&is_bad, p), detail, p));
    }
    if let (Some((excess, p)), None) = (worst.overstep, worst.steep) {
        // Which entry is at fault shows in a sample of each.
        let is_bad = |entry: usize, _: DVec3| {
            worst_sample(&|q| entry_gradient(flat, component, entry, q), bounds, &[p]).overstep.is_some()
        };
        let detail = format!("a step can be {excess:.2e} m too long");
        found.push(finding(FindingKind::Overstep, node(&is_bad, p), detail, p));
    }
    found
}

/// The innermost entry of a fold that is bad at a point.
fn innermost(
    flat: &FlatScene,
    component: &Component,
    range: std::ops::Range<usize>,
    p: DVec3,
    is_bad: &dyn Fn(usize, DVec3) -> bool,
) -> Option<usize> {
    let mut at = range.start;
    while at < range.end {
        let node = &flat.nodes[at];
        if node.is_run() {
            at += 1;
            continue;
        }
        let end = at + node.extent as usize;
        if is_bad(at, p) {
            let inside = content_point(flat, component, at, p)
                .and_then(|content| innermost(flat, component, at + 1..end, content, is_bad));
            return inside.or(Some(at));
        }
        at = end;
    }
    None
}

/// What makes rays take small steps near the surface, if anything does.
fn small_steps(flat: &FlatScene, component: &Component, bounds: &Aabb) -> Option<Finding> {
    let size = bounds.half().length();
    // Points at a known distance from the surface, with the share of it that the field promises.
    let mut shares: Vec<(f64, DVec3)> = Vec::new();
    for index in 0..SAMPLES / 2 {
        let mut p = bounds.min + spread_point(index) * 2.0 * bounds.half();
        for _ in 0..2 * NEWTON {
            let (value, slope) = gradient(flat, component, p);
            let length = slope.length();
            if length < 1e-9 || !value.is_finite() {
                break;
            }
            if value.abs() <= 1e-4 * size {
                let away = NEAR * size;
                let beside = p + slope / length * away;
                shares.push((field(flat, component, beside) / away, beside));
                break;
            }
            p -= slope * (value / (length * length)).clamp(-size, size);
        }
    }
    shares.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (share, p) = *shares.get(shares.len() / 2)?;
    if share * SMALL > 1.0 {
        return None;
    }
    let leaf = surface(flat, component, p).leaf as usize;
    let (entry, factor) = greatest_loss(flat, component, leaf, p);
    (factor >= SMALL).then(|| Finding {
        node: flat.ids[entry],
        kind: FindingKind::SmallSteps,
        detail: match flat.nodes[entry].modifier() {
            Some(kind) => format!("{} makes steps {factor:.0} times smaller", kind.label()),
            None => format!("the field of this shape is {factor:.0} times smaller than the distance"),
        },
        place: component.instanced.is_none().then(|| p + component.origin),
        repair: None,
    })
}

/// The entry between the component and a leaf that lowers the field most, and by how much.
fn greatest_loss(flat: &FlatScene, component: &Component, leaf: usize, p: DVec3) -> (usize, f64) {
    let mut range = component.first as usize..(component.first + component.count) as usize;
    let (mut p, mut chain) = (p, Vec::new());
    'descend: loop {
        let mut at = range.start;
        while at < range.end {
            let end = at + flat.nodes[at].extent.max(1) as usize;
            if !flat.nodes[at].is_run() && (at..end).contains(&leaf) {
                chain.push((at, entry_field(flat, component, at, p).abs()));
                match content_point(flat, component, at, p) {
                    Some(content) if at != leaf => {
                        (p, range) = (content, at + 1..end);
                        continue 'descend;
                    }
                    _ => break 'descend,
                }
            }
            at = if flat.nodes[at].is_run() { at + 1 } else { end };
        }
        break;
    }
    // A leaf loses by its scale, which shows in its slope.
    let slope_of_leaf = entry_gradient(flat, component, leaf, p).1.length().max(1e-12);
    let inner = chain.iter().skip(1).map(|(_, value)| *value).chain([f64::NAN]);
    let losses = chain.iter().zip(inner).map(|((entry, value), inner)| match *entry == leaf {
        true => (leaf, 1.0 / slope_of_leaf),
        false => (*entry, inner / value.max(1e-12)),
    });
    let is_cause = |entry: usize| flat.nodes[entry].is_leaf() || flat.nodes[entry].modifier().is_some();
    losses
        .filter(|(entry, _)| is_cause(*entry))
        .fold((leaf, 0.0), |most, loss| if loss.1 > most.1 { loss } else { most })
}
