//! Cut balls and the spindle. All are solids of revolution: `at` is the distance from the axis, then the height.

use super::planar::length2;
use crate::eval::Real;
use isolith_scene::SineCosine;
use isolith_scene::shape_params::{
    CutSphereParams, DeathStarParams, HollowCutSphereParams, SolidAngleParams, VesicaParams,
};

fn turned<T: Real>(p: [T; 3]) -> [T; 2] {
    [length2([p[0], p[2]]), p[1]]
}

/// The radius of the circle in which a plane cuts a ball, at a height over the ball's center.
fn rim(radius: f64, cut: f64) -> f64 {
    ((radius - cut) * (radius + cut)).sqrt()
}

/// A ball with a flat cut. Outside, the nearest point lies on the ball if the direction to its center leads there,
/// else on the flat or its rim; inside, the nearer of both is exact.
pub fn sdf_cut_sphere<T: Real>(p: [T; 3], q: &CutSphereParams) -> T {
    let (radius, cut) = (q.radius, q.cut.clamp(-q.radius, q.radius));
    let at = turned(p);
    let far = length2(at);
    let (over, under) = (far - radius, -at[1] + cut);
    if over.value() <= 0.0 && under.value() <= 0.0 {
        return over.max(under);
    }
    let edge = rim(radius, cut);
    if over.value() > 0.0 && at[1].value() * radius >= cut * far.value() {
        over
    } else if under.value() > 0.0 && at[0].value() <= edge {
        under
    } else {
        length2([at[0] - edge, under])
    }
}

/// A bowl. Inside, the value is a lower bound where its wall meets itself.
pub fn sdf_hollow_cut_sphere<T: Real>(p: [T; 3], q: &HollowCutSphereParams) -> T {
    let (radius, cut) = (q.radius, q.cut.clamp(-q.radius, q.radius));
    let at = turned(p);
    let edge = rim(radius, cut);
    // Whether the bowl covers the direction from the center. On the axis below it always does.
    let turn = at[1].value() * edge - at[0].value() * cut;
    let is_below = turn < 0.0 || (turn == 0.0 && at[1].value() < 0.0);
    let to_skin = if is_below { (length2(at) - radius).abs() } else { length2([at[0] - edge, at[1] - cut]) };
    to_skin - 0.5 * q.thickness
}

/// A ball minus another ball. Outside, the nearest point lies on the ball or in the hollow if that point belongs to
/// the surface, else on the circle where both meet. Inside, the nearer of both is exact.
pub fn sdf_death_star<T: Real>(p: [T; 3], q: &DeathStarParams) -> T {
    let (radius, distance) = (q.radius, q.distance);
    let cut_radius = q.cut_radius.min(radius + distance);
    let at = turned(p);
    let from_cut = [at[0], at[1] - distance];
    let (far, cut_far) = (length2(at), length2(from_cut));
    let (over, within) = (far - radius, -cut_far + cut_radius);
    if over.value() <= 0.0 && within.value() <= 0.0 {
        return over.max(within);
    }
    // Twice the distance times the height of the circle over either center.
    let height = radius * radius + (distance - cut_radius) * (distance + cut_radius);
    let cut_height = (radius - cut_radius) * (radius + cut_radius) - distance * distance;
    let twice = 2.0 * distance;
    if over.value() > 0.0 && twice * radius * at[1].value() <= height * far.value() {
        return over;
    }
    if within.value() > 0.0 && twice * cut_radius * from_cut[1].value() <= cut_height * cut_far.value() {
        return within;
    }
    let circle = (height / twice.max(1e-30)).clamp(-radius, radius);
    length2([at[0] - rim(radius, circle), at[1] - circle])
}

/// The part of a ball within an angle around the axis.
pub fn sdf_solid_angle<T: Real>(p: [T; 3], q: &SolidAngleParams) -> T {
    let SolidAngleParams { radius, half_angle: SineCosine { sine, cosine } } = *q;
    let at = turned(p);
    let along = at[0] * sine + at[1] * cosine;
    let across = at[0] * cosine - at[1] * sine;
    let far = length2(at);
    let to_side = if along.value() <= 0.0 {
        far
    } else if along.value() >= radius {
        length2([at[0] - radius * sine, at[1] - radius * cosine])
    } else {
        across.abs()
    };
    if across.value() >= 0.0 { to_side } else { (far - radius).max(-to_side) }
}

/// A spindle: an arc that revolves around its chord. The arc's center may be very far away, so the distance to it
/// minus its radius is written as the difference of their squares over their sum, all times `k`, the ratio of the
/// half axes.
pub fn sdf_vesica<T: Real>(p: [T; 3], q: &VesicaParams) -> T {
    let half_height = 0.5 * q.height;
    let half_width = (0.5 * q.width).min(half_height);
    let at = [length2([p[0], p[2]]), p[1].abs()];
    // `away` is k times the distance of the arc's center from the axis, in half heights.
    let scale = half_height.max(1e-100);
    let k = half_width / scale;
    let away = 0.5 * (1.0 - k) * (1.0 + k);
    let (x, y) = (at[0] * scale.recip(), at[1] * scale.recip());
    if half_height < 1e-100 || (y.value() >= 1.0 && (y.value() - 1.0) * away >= k * x.value()) {
        return length2([at[0], at[1] - half_height]);
    }
    let excess = ((x - k) * (x + k) + y.squared()) * k + (x - k) * (2.0 * away);
    let sum = length2([x * k + away, y * k]) + 0.5 * (1.0 + k * k);
    excess * half_height / sum
}
