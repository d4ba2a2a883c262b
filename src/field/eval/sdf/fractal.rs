//! Fractals.

use super::planar::{clamp, length2, length3};
use crate::eval::Real;
use isolith_scene::shape_params::{JuliaParams, KleinianParams, MandelbulbParams, MengerSpongeParams};

/// The limit on iterations of a sponge: the hard limit of the parameter.
const MOST: usize = 8;
/// The limit on squarings of a Julia set and powers of a Mandelbulb: the hard limit of the parameter.
const MOST_SQUARES: usize = 16;
/// The limit on steps of Newton's method; it needs four to seven.
const MOST_STEPS: usize = 40;
/// A relative error at which another step changes nothing.
const CONVERGED: f64 = 1e-13;
/// The limit on folds of a Kleinian set: the hard limit of the parameter.
const MOST_FOLDS: usize = 8;
/// The radius of the disc of a Kleinian set, in its own unit.
const DISC: f64 = 0.92;

/// A Menger sponge (Menger, "Dimensionstheorie", 1928): a cube without the bars that fill the middle thirds of its
/// cells along each axis. The field is the maximum of the distance to the cube and the depth of the point in the bars
/// of each size, so it is a lower bound of the distance with a slope of at most 1.
pub fn sdf_menger_sponge<T: Real>(p: [T; 3], q: &MengerSpongeParams) -> T {
    let d = p.map(|c| c.abs() - 0.5 * q.size);
    let most = d[0].max(d[1].max(d[2]));
    let mut field = if most.value() > 0.0 { length3(d.map(T::positive)) } else { most };
    let mut side = q.size;
    for step in 0..MOST {
        if step as f64 + 0.5 > q.iterations {
            break;
        }
        // The position relative to the middle of the cell. The second least coordinate gives the depth in the bars.
        let [x, y, z] = p.map(|c| (c - side * (c.value() / side.max(1e-30)).round()).abs());
        let second = x.min(y).max(x.max(y).min(z));
        field = field.max(-second + side / 6.0);
        side /= 3.0;
    }
    field
}

/// A Julia set of quaternions (Norton, "Julia sets in the quaternions", 1989): the points whose orbit under z² + c
/// never leaves the ball of radius R = (1 + √(1 + 4|c|)) / 2. Outside of that ball every step leads farther out.
///
/// The field is the radius of a ball around the point that lies on one side for certain. For quaternions |w² − z²| ≤
/// 2|z|σ + σ² where |w − z| ≤ σ. So if the ball of radius s around z² + c is on one side, the ball of radius √(|z|² +
/// s) − |z| around z is too; the orbit gives these radii from the last step back to the first. The same argument
/// finds every ball within such a ball, so the slope is at most 1.
pub fn sdf_julia<T: Real>(p: [T; 3], q: &JuliaParams) -> T {
    let [x, y, z] = q.constant;
    let constant = [x, y, z, q.fourth];
    let escape = 0.5 + (0.25 + constant.iter().map(|c| c * c).sum::<f64>().sqrt()).sqrt();
    let scale = q.radius.max(1e-30) / escape;
    let [x, y, z] = p.map(|v| v * scale.recip());
    let mut at = [x, y, z, T::constant(0.0)];
    let mut radii = [T::constant(0.0); MOST_SQUARES + 1];
    let mut last = 0;
    loop {
        let imaginary = at[1].squared() + at[2].squared() + at[3].squared();
        radii[last] = (at[0].squared() + imaginary).sqrt();
        // This far out the distance to the ball exceeds the bounds of later steps.
        if last == MOST_SQUARES || last as f64 + 0.5 > q.iterations || radii[last].value() > 4.0 * escape {
            break;
        }
        let twice = at[0] * 2.0_f64;
        at = [at[0].squared() - imaginary, at[1] * twice, at[2] * twice, at[3] * twice];
        at = [0, 1, 2, 3].map(|i| at[i] + constant[i]);
        last += 1;
    }
    let mut field = radii[last] - escape;
    for radius in radii[..last].iter().rev() {
        let sum = (radius.squared() + field.abs()).sqrt() + *radius;
        let back = if sum.value() > 1e-30 { field / sum } else { T::constant(0.0) };
        field = (*radius - escape).max(back);
    }
    field * scale
}

/// A pseudo-Kleinian set (Knighty, fractalforums.com, 2011): each step folds space at a box and inverts the inside of
/// a ball. The set is the points that end near a disc.
///
/// The field is the radius of a ball around the point that lies on one side for certain, from the distance to the
/// disc back through the steps. Folds bring points nearer to each other. The inversion stretches by k / r² if that is
/// more than 1, so a distance of `s` from r inward becomes at most k / (r − s) − k / r; the step back solves this for
/// `s`.
pub fn sdf_kleinian<T: Real>(p: [T; 3], q: &KleinianParams) -> T {
    let KleinianParams { fold, inversion, thickness, .. } = *q;
    let ball = length3(p) - q.radius;
    let scale = q.radius.max(1e-30) / q.reach;
    let mut at = p.map(|v| v * scale.recip());
    let mut radii = [T::constant(0.0); MOST_FOLDS];
    let count = (0..MOST_FOLDS).take_while(|step| *step as f64 + 0.5 < q.iterations).count();
    for radius in &mut radii[..count] {
        at = [0, 1, 2].map(|i| clamp(at[i], -fold[i], fold[i]) * 2.0_f64 - at[i]);
        *radius = length3(at);
        let square = radius.squared();
        if square.value() < inversion {
            let factor = T::constant(inversion) / square.max(T::constant(1e-30));
            at = at.map(|v| v * factor);
        }
    }
    let (around, far) = (length2([at[0], at[2]]), length3(at));
    let to_plane = if far.value() > 1e-30 { (around * at[1] / far).abs() } else { T::constant(0.0) };
    let mut field = to_plane.max(around - DISC) - thickness;
    let edge = inversion.sqrt();
    for radius in radii[..count].iter().rev() {
        let way = field.abs();
        let back = if radius.value() < edge {
            way * radius.squared() / (way * *radius + inversion)
        } else if way.value() <= radius.value() - edge {
            way
        } else {
            *radius - T::constant(inversion) / (way - *radius + 2.0 * edge).max(T::constant(1e-30))
        };
        field = if field.value() < 0.0 { -back } else { back };
    }
    ball.max(field * scale)
}

/// A Mandelbulb (White and Nylander, "The unraveling of the real 3D Mandelbulb", 2009): the points whose orbit z →
/// P(z) + c, from z = c, never leaves the ball of radius B = 2^(1/(n−1)). Outside of that ball every step leads
/// farther out. P raises the distance from the center to the power n, and multiplies by n both the angle from the Y
/// axis and the angle around it.
///
/// The field is the radius of a ball around the point that lies on one side for certain (idea: Hart, Sandin and
/// Kauffman, "Ray tracing deterministic 3-D fractals", 1989). If the ball of radius t around P(z) + c is on one side,
/// so is the ball of radius e around z where e (1 + L) = t, if P stretches by no more than L within it: c moves by no
/// more than z, because at the first step it is z, and later z moves at least as far as c. The orbit gives these
/// radii from the last step back to the first. For a ball within the ball L is the same or less, so the same argument
/// finds every ball within such a ball, and the slope is at most 1.
pub fn sdf_mandelbulb<T: Real>(p: [T; 3], q: &MandelbulbParams) -> T {
    let power = (q.power + 0.5).floor().clamp(2.0, 16.0);
    let escape = (1.0 / (power - 1.0)).exp2();
    // This far out the distance to the ball exceeds the bounds of later steps: (2r − B)ⁿ ≥ 2rⁿ.
    let reach = escape / (2.0 - (1.0 / power).exp2());
    let scale = q.radius.max(1e-30) / escape;
    let start = p.map(|v| v * scale.recip());
    let mut at = start;
    let mut orbit = [[T::constant(0.0); 2]; MOST_SQUARES + 1];
    let mut last = 0;
    loop {
        orbit[last] = [length3(at), length2([at[0], at[2]])];
        if last == MOST_SQUARES || last as f64 + 0.5 > q.iterations || orbit[last][0].value() > reach {
            break;
        }
        at = bulb_power(at, orbit[last][1], power as u32);
        at = [0, 1, 2].map(|i| at[i] + start[i]);
        last += 1;
    }
    let mut field = orbit[last][0] - escape;
    for spot in orbit[..last].iter().rev() {
        let radius = bulb_back(*spot, field.abs(), power);
        field = (spot[0] - escape).max(if field.value() < 0.0 { -radius } else { radius });
    }
    field * scale
}

/// P, as powers of two complex numbers by squaring: height and distance from the axis, the direction around it.
fn bulb_power<T: Real>(at: [T; 3], around: T, power: u32) -> [T; 3] {
    let times = |u: [T; 2], v: [T; 2]| [u[0] * v[0] - u[1] * v[1], u[0] * v[1] + u[1] * v[0]];
    let beside = around.max(T::constant(1e-18));
    let mut squares = [[at[1], around], [at[0] / beside, at[2] / beside]];
    let mut products = [[T::constant(1.0), T::constant(0.0)]; 2];
    let mut bits = power;
    while bits > 0 {
        if bits & 1 == 1 {
            products = [0, 1].map(|i| times(products[i], squares[i]));
        }
        squares = squares.map(|s| times(s, s));
        bits >>= 1;
    }
    let [[up, out], [x, z]] = products;
    [out * x, up, out * z]
}

/// The radius e at a point of the orbit (distance from the center, from the axis) for which e (1 + L) is `way`.
///
/// Newton's method works on logarithms, in which the slope only grows, and approaches the root from above; the
/// remaining error is subtracted. Only the last step takes part in differentiation.
fn bulb_back<T: Real>(spot: [T; 2], way: T, power: f64) -> T {
    let (fixed, goal) = (spot.map(T::value), way.value().max(1e-300));
    let mut radius = goal / (1.0 + bulb_stretch(fixed, 0.0, power)[0]);
    for _ in 0..MOST_STEPS {
        let [stretch, growth] = bulb_stretch(fixed, radius, power);
        let excess = radius * (1.0 + stretch) / goal;
        radius *= excess.powf(-(1.0 + stretch) / (1.0 + stretch + growth));
        if (excess - 1.0).abs() < CONVERGED {
            break;
        }
    }
    let [stretch, growth] = bulb_stretch(spot, radius, power);
    let held = stretch.value();
    let safe = radius / (radius * (1.0 + held) / goal).max(1.0);
    (way - way.value() - (stretch - held) * radius) * (1.0 + held + growth.value()).recip() + safe
}

/// L within the radius, and the radius times its derivative. P stretches by n |z|ⁿ⁻¹ max(1, |sin nα / sin α|), with α
/// the angle from the axis; the lesser of n and 1 / sin α bounds that quotient.
fn bulb_stretch<T: Real>([far, around]: [T; 2], radius: f64, power: f64) -> [T; 2] {
    let far = (far + radius).max(T::constant(1e-300));
    let beside = around - radius;
    let is_near = beside.value() <= far.value() / power;
    let beside = if is_near { far * power.recip() } else { beside };
    let raised = (1..power as u32).fold(T::constant(power), |product, _| product * far);
    let nearing = if is_near { 0.0 } else { radius / beside.value() + radius / far.value() };
    let stretch = raised * far / beside;
    [stretch, stretch * ((power - 1.0) * radius / far.value() + nearing)]
}
