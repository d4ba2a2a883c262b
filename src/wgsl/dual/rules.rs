//! The rules of differentiation.
//!
//! `#` stands for the tangent of an operand along each axis in turn. Divisors and arguments of roots are kept away from
//! zero, so that tangents are finite where values are.

use naga::{BinaryOperator, Expression, Handle, MathFunction, TypeInner, UnaryOperator};

use super::error::DualError;
use super::tangent_writer::{AXES, TangentWriter, Tangents, construct};

/// The functions that rules call. A source must not define these names.
pub const CALLED: &str =
    "cos cosh cross degrees dot inverseSqrt length log max radians saturate select sin sinh transpose trunc";

/// The tangents of an expression as text, or an error if it has no rule.
type Ruled = Result<Tangents, DualError>;

impl TangentWriter<'_> {
    /// The tangents of an active expression whose value is already written.
    pub fn tangents(&mut self, of: Handle<Expression>) -> Ruled {
        let function = self.function;
        match &function.expressions[of] {
            Expression::Compose { ty, components } => {
                let name = self.type_name(*ty);
                Ok(self.each(components, |tangents| format!("{name}({})", tangents.join(", "))))
            }
            Expression::Splat { value, .. } => Ok(self.sum(&[(*value, &format!("{}(#)", self.type_of(of)))])),
            Expression::Access { base: whole, .. }
            | Expression::AccessIndex { base: whole, .. }
            | Expression::Swizzle { vector: whole, .. } => {
                let part = self.part(of)?;
                let mut tangents = self.sum(&[(*whole, &format!("#{part}"))]);
                if self.is_point(*whole) {
                    // The point's components are independent, so most tangents of its parts are zero.
                    for (axis, tangent) in AXES.iter().zip(&mut tangents) {
                        *tangent = tangent.take().filter(|_| part.contains(axis) || part.starts_with('['));
                    }
                }
                Ok(tangents)
            }
            Expression::Load { pointer } => {
                let [x, y, z] = AXES.map(|axis| self.place(*pointer, axis));
                Ok([Some(x?), Some(y?), Some(z?)])
            }
            Expression::Unary { op: UnaryOperator::Negate, expr } => Ok(self.sum(&[(*expr, "-#")])),
            Expression::Binary { op, left, right } => self.binary(of, *op, *left, *right),
            Expression::Select { condition, accept, reject } => {
                let condition = self.value(*condition)?;
                Ok(self.either(&condition, *accept, *reject))
            }
            Expression::As { expr, convert: Some(4), .. } => Ok(self.sum(&[(*expr, "#")])),
            Expression::Math { fun, arg, arg1, arg2, .. } => match (arg1, arg2) {
                (None, _) => self.math1(of, *fun, *arg),
                (Some(b), None) => self.math2(of, *fun, *arg, *b),
                (Some(b), Some(c)) => self.math3(of, *fun, *arg, *b, *c),
            },
            other => Err(self.unsupported(&construct(other))),
        }
    }

    /// The sum of terms, each linear in the tangent of its operand.
    fn sum(&self, terms: &[(Handle<Expression>, &str)]) -> Tangents {
        let mut sums = [const { None }; 3];
        for (operand, term) in terms {
            for (sum, tangent) in sums.iter_mut().zip(self.tangents_of(*operand)) {
                let Some(tangent) = tangent else { continue };
                let text = term.replace('#', &tangent);
                *sum = Some(match sum.take() {
                    Some(sum) => format!("{sum} + {text}").replace(" + -", " - "),
                    None => text,
                });
            }
        }
        sums
    }

    /// A text with the tangents of all operands, unless all of them are zero.
    fn each(&self, operands: &[Handle<Expression>], text: impl Fn(&[String]) -> String) -> Tangents {
        std::array::from_fn(|axis| {
            let moves = operands.iter().any(|operand| self.tangents_of(*operand)[axis].is_some());
            let tangents = || operands.iter().map(|operand| self.filled(*operand)[axis].clone()).collect::<Vec<_>>();
            moves.then(|| text(&tangents()))
        })
    }

    fn either(&self, condition: &str, accept: Handle<Expression>, reject: Handle<Expression>) -> Tangents {
        self.each(&[reject, accept], |tangents| format!("select({}, {condition})", tangents.join(", ")))
    }

    fn binary(
        &mut self,
        of: Handle<Expression>,
        op: BinaryOperator,
        left: Handle<Expression>,
        right: Handle<Expression>,
    ) -> Ruled {
        let (v, l, r) = (self.value(of)?, self.value(left)?, self.value(right)?);
        Ok(match op {
            BinaryOperator::Add => self.sum(&[(left, "#"), (right, "#")]),
            BinaryOperator::Subtract => self.sum(&[(left, "#"), (right, "-#")]),
            BinaryOperator::Multiply => self.sum(&[(left, &format!("# * {r}")), (right, &format!("{l} * #"))]),
            BinaryOperator::Divide => {
                let k = self.shared(of, "k", &format!("1.0 / {r}"));
                if !self.is_active(right) {
                    return Ok(self.sum(&[(left, &format!("# * {k}"))]));
                }
                let m = self.shared(of, "m", &format!("-{v} * {k}"));
                self.sum(&[(left, &format!("# * {k}")), (right, &format!("# * {m}"))])
            }
            BinaryOperator::Modulo => self.sum(&[(left, "#"), (right, &format!("-trunc({l} / {r}) * #"))]),
            other => return Err(self.unsupported(&construct(&other))),
        })
    }

    fn math1(&mut self, of: Handle<Expression>, fun: MathFunction, arg: Handle<Expression>) -> Ruled {
        use MathFunction as M;
        let (v, a) = (self.value(of)?, self.value(arg)?);
        let ty = self.type_of(of);
        let is_vector = matches!(self.inner(arg), TypeInner::Vector { .. });
        let slope = match fun {
            M::Fract => return Ok(self.sum(&[(arg, "#")])),
            M::Transpose => return Ok(self.sum(&[(arg, "transpose(#)")])),
            M::Radians => return Ok(self.sum(&[(arg, "radians(#)")])),
            M::Degrees => return Ok(self.sum(&[(arg, "degrees(#)")])),
            M::Length if is_vector => {
                let k = self.shared(of, "k", &direction(&a, &v, &self.type_of(arg)));
                return Ok(self.sum(&[(arg, &format!("dot({k}, #)"))]));
            }
            M::Normalize => {
                let k = self.shared(of, "k", &format!("1.0 / max(length({a}), 1e-30)"));
                return Ok(self.sum(&[(arg, &format!("(# - {v} * dot({v}, #)) * {k}"))]));
            }
            M::Abs | M::Length => format!("select({ty}(-1.0), {ty}(1.0), {a} >= {ty}())"),
            M::Saturate => format!("select({ty}(), {ty}(1.0), {a} == {v})"),
            M::Sqrt => format!("0.5 / max({v}, {ty}(1e-30))"),
            M::InverseSqrt => format!("-0.5 * {v} * {v} * {v}"),
            M::Exp => v,
            M::Exp2 => format!("{v} * 0.6931472"),
            M::Log => format!("1.0 / {a}"),
            M::Log2 => format!("1.442695 / {a}"),
            M::Sin => format!("cos({a})"),
            M::Cos => format!("-sin({a})"),
            M::Tan => format!("1.0 + {v} * {v}"),
            M::Asin => format!("inverseSqrt(max(1.0 - {a} * {a}, {ty}(1e-30)))"),
            M::Acos => format!("-inverseSqrt(max(1.0 - {a} * {a}, {ty}(1e-30)))"),
            M::Atan => format!("1.0 / (1.0 + {a} * {a})"),
            M::Sinh => format!("cosh({a})"),
            M::Cosh => format!("sinh({a})"),
            M::Tanh => format!("1.0 - {v} * {v}"),
            other => return Err(self.unsupported(&construct(&other))),
        };
        let k = self.shared(of, "k", &slope);
        Ok(self.sum(&[(arg, &format!("{k} * #"))]))
    }

    fn math2(
        &mut self,
        of: Handle<Expression>,
        fun: MathFunction,
        left: Handle<Expression>,
        right: Handle<Expression>,
    ) -> Ruled {
        use MathFunction as M;
        let (v, a, b) = (self.value(of)?, self.value(left)?, self.value(right)?);
        let ty = self.type_of(of);
        match fun {
            M::Min | M::Max => {
                let sign = if fun == M::Min { "<" } else { ">" };
                // For equal operands, the derivative of the first, unless only the second moves: on a face, where the
                // value is 0, the derivative is the one beside it.
                let equal = if self.is_active(left) { "=" } else { "" };
                let k = self.shared(of, "k", &format!("{a} {sign}{equal} {b}"));
                Ok(self.either(&k, left, right))
            }
            M::Dot => Ok(self.sum(&[(left, &format!("dot(#, {b})")), (right, &format!("dot({a}, #)"))])),
            M::Cross => Ok(self.sum(&[(left, &format!("cross(#, {b})")), (right, &format!("cross({a}, #)"))])),
            M::Distance if matches!(self.inner(left), TypeInner::Vector { .. }) => {
                let k = self.shared(of, "k", &direction(&format!("({a} - {b})"), &v, &self.type_of(left)));
                Ok(self.sum(&[(left, &format!("dot({k}, #)")), (right, &format!("-dot({k}, #)"))]))
            }
            M::Distance => {
                let k = self.shared(of, "k", &format!("select(-1.0, 1.0, {a} >= {b})"));
                Ok(self.sum(&[(left, &format!("{k} * #")), (right, &format!("-{k} * #"))]))
            }
            M::Pow => {
                let k = self.shared(of, "k", &format!("{b} * {v} / max({a}, {ty}(1e-30))"));
                if !self.is_active(right) {
                    return Ok(self.sum(&[(left, &format!("{k} * #"))]));
                }
                let m = self.shared(of, "m", &format!("{v} * log(max({a}, {ty}(1e-30)))"));
                Ok(self.sum(&[(left, &format!("{k} * #")), (right, &format!("{m} * #"))]))
            }
            M::Atan2 => {
                let k = self.shared(of, "k", &format!("1.0 / max({a} * {a} + {b} * {b}, {ty}(1e-30))"));
                Ok(self.sum(&[(left, &format!("{k} * {b} * #")), (right, &format!("-{k} * {a} * #"))]))
            }
            other => Err(self.unsupported(&construct(&other))),
        }
    }

    fn math3(
        &mut self,
        of: Handle<Expression>,
        fun: MathFunction,
        first: Handle<Expression>,
        second: Handle<Expression>,
        third: Handle<Expression>,
    ) -> Ruled {
        use MathFunction as M;
        let (a, b, c) = (self.value(first)?, self.value(second)?, self.value(third)?);
        match fun {
            M::Clamp => {
                let k = self.shared(of, "k", &format!("{a} < {b}"));
                let m = self.shared(of, "m", &format!("max({a}, {b}) > {c}"));
                Ok(self.each(&[first, second, third], |tangents| {
                    format!("select(select({}, {}, {k}), {}, {m})", tangents[0], tangents[1], tangents[2])
                }))
            }
            M::Mix => {
                let terms = [format!("# * (1.0 - {c})"), format!("# * {c}"), format!("({b} - {a}) * #")];
                Ok(self.sum(&[(first, &terms[0]), (second, &terms[1]), (third, &terms[2])]))
            }
            M::SmoothStep => {
                let u = self.shared(of, "u", &format!("saturate(({c} - {a}) / ({b} - {a}))"));
                let k = self.shared(of, "k", &format!("6.0 * {u} * (1.0 - {u}) / ({b} - {a})"));
                let terms = [format!("{k} * ({u} - 1.0) * #"), format!("-{k} * {u} * #"), format!("{k} * #")];
                Ok(self.sum(&[(first, &terms[0]), (second, &terms[1]), (third, &terms[2])]))
            }
            M::Fma => Ok(self.sum(&[(first, &format!("# * {b}")), (second, &format!("{a} * #")), (third, "#")])),
            other => Err(self.unsupported(&construct(&other))),
        }
    }
}

/// The gradient of the length `v` of `a`. At 0 it may be any vector but zero: if only one component moves, the length
/// is that of a number, and so is its derivative.
fn direction(a: &str, v: &str, ty: &str) -> String {
    format!("select({a} / max({v}, 1e-30), {ty}(1.0), {v} == 0.0)")
}
