//! What straight-line code proves of the field ahead on a ray.
//!
//! The distance to a convex body is a convex function along a ray: ahead it lies above the line through its last two
//! values. So each leaf is known to be no less, some way ahead, than a number that costs nothing; and as a fold never
//! falls where its operands rise, the same fold over these numbers is no more than the field is anywhere until there. Both
//! folds are made side by side: a fold is a chain in which each joint waits for the one before, so the second one takes
//! hardly any time.

use super::structure::{Entry, EntryKind, Structure};
use super::{Evaluator, Options, Skipping};
use crate::flat::Join;
use crate::scene::{BlendKernel, ShapeKind};

/// Where the field of a shape is convex.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Convexity {
    /// Everywhere: the exact distance to a convex body.
    Everywhere,
    /// Around a point as far as the function `sdf_…_convex` beside its field says.
    Around,
    /// It is not, or nobody knows.
    Unknown,
}

/// Where the field of a shape is convex.
pub fn convexity(kind: ShapeKind) -> Convexity {
    match kind {
        ShapeKind::Sphere
        | ShapeKind::Box
        | ShapeKind::Cylinder
        | ShapeKind::CappedCone
        | ShapeKind::RoundCone
        | ShapeKind::Capsule
        | ShapeKind::Plane
        | ShapeKind::InfiniteCylinder => Convexity::Everywhere,
        ShapeKind::Torus => Convexity::Around,
        _ => Convexity::Unknown,
    }
}

/// Whether kernels look ahead. Not with modifiers, nor with operators that may fall where an operand rises; and only on
/// processors: on graphics cards it has not been measured, and code that is skipped knows no last value.
pub fn looks_ahead(structure: &Structure, options: Options) -> bool {
    options.skipping == Skipping::Selects && !structure.is_modified() && !structure.has_further_joins()
}

/// Lines of constants: whether the kernel looks ahead, and whether the fold is concave, so that it lies above the line
/// from what it is here to the least that it can be ahead.
pub fn constants(evaluator: &Evaluator, options: Options) -> String {
    let [ahead, concave] = match evaluator {
        Evaluator::Specialised(structure) => {
            [looks_ahead(structure, options), structure.entries.iter().all(is_concave)]
        }
        _ => [false; 2],
    };
    format!("const AHEAD: bool = {ahead};\nconst AHEAD_IS_CONCAVE: bool = {concave};\n")
}

/// Whether what an entry joins with is a concave function of both operands: min is, and less a blend as long as the
/// derivative of the blend never falls. Intersections are convex; steps and columns are neither.
fn is_concave(entry: &Entry) -> bool {
    let smooth =
        |kernel: u8| !matches!(BlendKernel::ALL[usize::from(kernel)], BlendKernel::Stairs | BlendKernel::Columns);
    matches!(entry.join, Join::First | Join::Union) && entry.kernel.is_none_or(smooth)
}

/// Names the value of the leaf `at`, and the least (below an odd number of cuts the most) that it can be in the window
/// ahead. `value` is code; so is `arguments`, those of the field of a kind.
pub fn leaf(
    at: usize,
    entry: &Entry,
    row: usize,
    is_cut: bool,
    value: &str,
    arguments: &dyn Fn(ShapeKind) -> String,
) -> String {
    let mut out = format!("    let v{at} = {value};\n");
    if is_cut {
        return out + &format!("    let a{at} = v{at} + ahead_window;\n");
    }
    let holds = |kind: ShapeKind| match convexity(kind) {
        Convexity::Everywhere => Some("true".to_owned()),
        Convexity::Around => Some(format!("{}_convex({}) * q{row}.y >= ahead_span", kind.function(), arguments(kind))),
        Convexity::Unknown => None,
    };
    let is_convex = match entry.kind {
        EntryKind::Leaf(kind) => holds(kind),
        EntryKind::AnyLeaf(kinds) => kinds
            .shapes()
            .filter_map(|kind| Some(format!("(q{row}.w == {}.0 && {})", kind as u32, holds(kind)?)))
            .reduce(|all, one| format!("{all} || {one}")),
        EntryKind::Nested | EntryKind::Modified(_) | EntryKind::Run => unreachable!("these are no leaves"),
    };
    out += &is_convex.map_or_else(
        || format!("    let a{at} = v{at} - ahead_window;\n"),
        |holds| format!("    let a{at} = v{at} - ahead_window * select(1.0, ahead_fall(b{at}, v{at}), {holds});\n    b{at} = v{at};\n"),
    );
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flat::twin::shape_distance;
    use crate::render::kernel::random::Random;

    /// How far the middle of a chord is below the field, at most, over random chords of what `kind` is by default.
    fn worst(kind: ShapeKind, holds: impl Fn([f64; 3], f64) -> bool) -> f64 {
        let body = crate::flat::Body::new(&kind.default_shape());
        let field = |p: [f64; 3]| shape_distance(kind, p, &body.parameters, &|row| body.rows[row]);
        let mut random = Random(1);
        let mut worst = 0.0_f64;
        for _ in 0..20_000 {
            let (middle, way) = (random.point(2.0), random.point(0.5));
            let length = way.iter().map(|v| v * v).sum::<f64>().sqrt();
            let end = |sign: f64| [0, 1, 2].map(|i| middle[i] + sign * way[i]);
            if holds(end(-1.0), 2.0 * length) {
                worst = worst.max(field(middle) - 0.5 * (field(end(-1.0)) + field(end(1.0))));
            }
        }
        worst
    }

    #[test]
    fn fields_are_convex_where_it_is_said() {
        for kind in ShapeKind::ALL.iter().copied() {
            if convexity(kind) == Convexity::Everywhere {
                let worst = worst(kind, |_, _| true);
                assert!(worst < 1e-9, "{kind:?} by {worst}");
            }
        }
    }

    /// Its twin on the GPU is `sdf_torus_convex`.
    #[test]
    fn a_torus_is_convex_outside_of_its_ring() {
        let body = crate::flat::Body::new(&ShapeKind::Torus.default_shape());
        let convex = |p: [f64; 3]| p[0].hypot(p[2]) - body.parameters[0];
        let within = worst(ShapeKind::Torus, |p, length| convex(p) >= length);
        assert!(within < 1e-9, "by {within}");
        let anywhere = worst(ShapeKind::Torus, |_, _| true);
        assert!(anywhere > 0.01, "the test cannot see that a torus is not convex everywhere: {anywhere}");
    }
}
