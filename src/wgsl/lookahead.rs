//! Lookahead: lower bounds of the field ahead on a ray, from straight-line code.
//!
//! The distance to a convex body is a convex function along a ray: ahead it lies above the line through its last two
//! values. So each leaf has a lower bound for some way ahead, at no cost. Since a fold never falls when its operands
//! rise, the same fold over these bounds is a lower bound of the field on that stretch. If all blends are concave, so
//! is the fold of the lines themselves, including rising ones: on that stretch the field lies above the line from its
//! present value to the value of that fold at the end. The code computes both folds side by side. In a fold each blend
//! waits for the one before, so the second fold takes hardly any time.
//!
//! The same holds before the two values, so an overstep to the expected surface can be verified afterward: see
//! `shaders/common/march.wgsl`.

use super::evaluator::Evaluator;
use super::options::{Options, SkipMode};
use super::structure::{EntryKind, Structure, StructureEntry};
use isolith_field::Join;
use isolith_scene::{BlendKernel, ShapeKind};

/// Degree of convexity of a shape's field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Convexity {
    /// Convex everywhere: the exact distance to a convex body.
    Everywhere,
    /// Convex except for what the function `sdf_…_concavity` beside its field accounts for.
    Nearly,
    /// Not convex, or not known to be.
    Unknown,
}

/// How convex the field of a shape is.
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
        ShapeKind::Torus => Convexity::Nearly,
        _ => Convexity::Unknown,
    }
}

/// Whether pipelines use lookahead. Modifiers and operators that may fall when an operand rises exclude it. Only
/// software drivers use it: it has not been measured on graphics cards, and skipped code has no last value.
pub fn has_lookahead(structure: &Structure, options: Options) -> bool {
    options.skip_mode == SkipMode::Selects && !structure.is_modified() && !structure.has_extended_joins()
}

/// WGSL constants that tell whether the pipeline uses lookahead; whether the fold is concave, so that the field lies
/// above the line from its present value to the fold of lines below its leaves; and whether each leaf has such a line,
/// so that oversteps can be verified.
pub fn constants(evaluator: &Evaluator, options: Options) -> String {
    let [lookahead, concave, convex] = match evaluator {
        Evaluator::StraightLine(structure) => {
            let lookahead = has_lookahead(structure, options);
            [
                lookahead,
                structure.entries.iter().all(is_concave),
                lookahead && structure.entries.iter().all(|one| is_concave(one) && has_convex_leaves(one)),
            ]
        }
        _ => [false; 3],
    };
    format!(
        "const LOOKAHEAD: bool = {lookahead};\nconst LOOKAHEAD_IS_CONCAVE: bool = {concave};\nconst VERIFIED_OVERSTEP: bool = {convex};\n"
    )
}

/// Whether the entry's join is a concave function of both operands. Min is, also after subtracting a blend whose
/// derivative never falls. Intersections are convex; steps and columns are neither.
fn is_concave(entry: &StructureEntry) -> bool {
    let smooth =
        |kernel: u8| !matches!(BlendKernel::ALL[usize::from(kernel)], BlendKernel::Stairs | BlendKernel::Columns);
    matches!(entry.join, Join::First | Join::Union) && entry.kernel.is_none_or(smooth)
}

/// Whether the leaf's field is convex or nearly so for every shape that it may have.
fn has_convex_leaves(entry: &StructureEntry) -> bool {
    match entry.kind {
        EntryKind::Leaf(kind) => convexity(kind) != Convexity::Unknown,
        EntryKind::GenericLeaf(kinds) => kinds.shapes().all(|kind| convexity(kind) != Convexity::Unknown),
        EntryKind::Nested | EntryKind::Modified(_) | EntryKind::Run => true,
    }
}

/// Declares the value of the leaf `at`, and its lower bound in the window ahead (below an odd number of cuts the upper
/// bound). `value` is code, and so are the `arguments` of a shape's field.
pub fn leaf(
    at: usize,
    entry: &StructureEntry,
    row: usize,
    is_cut: bool,
    value: &str,
    arguments: &dyn Fn(ShapeKind) -> String,
) -> String {
    let mut out = format!("    let v{at} = {value};\n");
    if is_cut {
        return out + &format!("    let a{at} = v{at} + lookahead_window;\n");
    }
    let concavity = |kind: ShapeKind| match convexity(kind) {
        Convexity::Everywhere => Some("0.0".to_owned()),
        Convexity::Nearly => {
            Some(format!("{}_concavity({}, q{row}.y, lookahead_span)", kind.function(), arguments(kind)))
        }
        Convexity::Unknown => None,
    };
    let known = match entry.kind {
        EntryKind::Leaf(kind) => concavity(kind),
        EntryKind::GenericLeaf(kinds) => {
            kinds.shapes().filter_map(|kind| Some((kind, concavity(kind)?))).fold(None, |others, (kind, concavity)| {
                let others = others.unwrap_or("LOOKAHEAD_UNKNOWN".to_owned());
                Some(format!("select({others}, {concavity}, q{row}.w == {}.0)", kind as u32))
            })
        }
        EntryKind::Nested | EntryKind::Modified(_) | EntryKind::Run => unreachable!("these are no leaves"),
    };
    out += &known.map_or_else(
        || format!("    let a{at} = v{at} - lookahead_window;\n"),
        |known| {
            format!("    let a{at} = lookahead_base(b{at}, v{at}) - lookahead_window * lookahead_descent(b{at}, v{at}, {known});\n    b{at} = v{at};\n")
        },
    );
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;
    use isolith_field::eval::shape_distance;
    use isolith_scene::EvalParams as _;
    use isolith_scene::shape_params::TorusParams;

    /// The largest distance by which the middle of a chord lies below the field, over random chords of `kind` with
    /// default parameters, minus the allowance of a concavity within the chord's length of the first end.
    fn worst(kind: ShapeKind, concavity: impl Fn([f64; 3], f64) -> f64) -> f64 {
        let prepared = isolith_field::PreparedShape::new(&kind.default_shape());
        let field = |p: [f64; 3]| shape_distance(kind, p, &prepared.parameters, &prepared);
        let mut random = Random(1);
        let mut worst = 0.0_f64;
        for _ in 0..20_000 {
            let (middle, way) = (random.point(2.0), random.point(0.5));
            let length = way.iter().map(|v| v * v).sum::<f64>().sqrt();
            let end = |sign: f64| [0, 1, 2].map(|i| middle[i] + sign * way[i]);
            let allowed = 0.5 * concavity(end(-1.0), 2.0 * length) * length * length;
            worst = worst.max(field(middle) - 0.5 * (field(end(-1.0)) + field(end(1.0))) - allowed);
        }
        worst
    }

    #[test]
    fn fields_are_convex_where_it_is_said() {
        for kind in ShapeKind::ALL.iter().copied() {
            if convexity(kind) == Convexity::Everywhere {
                let worst = worst(kind, |_, _| 0.0);
                assert!(worst < 1e-9, "{kind:?} by {worst}");
            }
        }
    }

    /// The counterpart of `sdf_torus_concavity`.
    #[test]
    fn a_torus_is_concave_only_within_its_ring_and_by_no_more_than_is_said() {
        let packed = ShapeKind::Torus.default_shape().packed();
        let torus = TorusParams::read(|i| packed[i]);
        let from_axis = |p: [f64; 3], length: f64| p[0].hypot(p[2]) - length;
        let concavity = |p: [f64; 3], length: f64| match from_axis(p, length) {
            nearest if nearest >= torus.major_radius => 0.0,
            nearest => 1.0 / nearest.max(1e-9),
        };
        let within = worst(ShapeKind::Torus, concavity);
        assert!(within < 1e-9, "by {within}");
        for less in [0.0, 0.05] {
            let less = worst(ShapeKind::Torus, |p, length| less * concavity(p, length));
            assert!(less > 1e-4, "the test cannot see that a torus is concave within its ring: {less}");
        }
    }
}
