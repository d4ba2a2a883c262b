//! Evaluates functions of a parsed shader, for tests of the generated text by its results.

use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use naga::{
    BinaryOperator as B, Block, Expression, Function, Handle, Literal, MathFunction as M, Module, RelationalFunction,
    ScalarKind, Statement, SwitchValue, TypeInner, UnaryOperator,
};

/// A value; booleans are 0 and 1.
#[derive(Clone, Debug, PartialEq)]
pub enum V {
    /// A number or a vector.
    N(Vec<f64>),
    /// Columns, elements or members.
    L(Vec<V>),
}

impl V {
    pub fn n(&self) -> &[f64] {
        match self {
            V::N(n) => n,
            V::L(_) => panic!("not a number or a vector"),
        }
    }

    fn part(&self, i: usize) -> V {
        match self {
            V::N(n) => V::N(vec![n[i]]),
            V::L(l) => l[i].clone(),
        }
    }

    fn set(&mut self, path: &[usize], value: V) {
        match (self, path) {
            (place, []) => *place = value,
            (V::N(n), [i]) => n[*i] = value.n()[0],
            (V::L(l), [i, rest @ ..]) => l[*i].set(rest, value),
            _ => panic!("no such place"),
        }
    }

    fn map(&self, f: impl Fn(f64) -> f64 + Copy) -> V {
        match self {
            V::N(n) => V::N(n.iter().map(|v| f(*v)).collect()),
            V::L(l) => V::L(l.iter().map(|v| v.map(f)).collect()),
        }
    }
}

/// A shader that can be called.
pub struct Machine {
    module: Module,
    info: ModuleInfo,
    /// Whether every result is rounded to f32.
    rounds: bool,
}

enum Next {
    On,
    Break,
    Continue,
    Return(V),
}

struct Frame<'a> {
    machine: &'a Machine,
    handle: Handle<Function>,
    function: &'a Function,
    arguments: Vec<V>,
    values: Vec<Option<V>>,
    locals: Vec<V>,
}

impl Machine {
    /// Parses the text. Panics if it is not valid.
    pub fn new(text: &str) -> Self {
        let module =
            naga::front::wgsl::parse_str(text).unwrap_or_else(|e| panic!("{}\n{text}", e.emit_to_string(text)));
        let info = Validator::new(ValidationFlags::all(), Capabilities::empty())
            .validate(&module)
            .unwrap_or_else(|e| panic!("{}\n{text}", e.emit_to_string(text)));
        Self { module, info, rounds: false }
    }

    /// The same machine, computing in f32.
    pub fn rounded(self) -> Self {
        Self { rounds: true, ..self }
    }

    /// The numbers that a function returns.
    pub fn call(&self, function: &str, arguments: &[&[f64]]) -> Vec<f64> {
        let (handle, _) = self.module.functions.iter().find(|(_, f)| f.name.as_deref() == Some(function)).unwrap();
        self.run(handle, arguments.iter().map(|a| V::N(a.to_vec())).collect()).n().to_vec()
    }

    /// The numbers of the members of the struct that a function returns.
    pub fn members(&self, function: &str, arguments: &[&[f64]]) -> Vec<f64> {
        fn numbers(value: &V) -> Vec<f64> {
            match value {
                V::N(n) => n.clone(),
                V::L(members) => members.iter().flat_map(numbers).collect(),
            }
        }
        let (handle, _) = self.module.functions.iter().find(|(_, f)| f.name.as_deref() == Some(function)).unwrap();
        numbers(&self.run(handle, arguments.iter().map(|a| V::N(a.to_vec())).collect()))
    }

    fn run(&self, handle: Handle<Function>, arguments: Vec<V>) -> V {
        let function = &self.module.functions[handle];
        let values = vec![None; function.expressions.len()];
        let mut frame = Frame { machine: self, handle, function, arguments, values, locals: vec![] };
        for (_, local) in function.local_variables.iter() {
            let start = local.init.map_or_else(|| self.zero(&self.module.types[local.ty].inner), |e| frame.value(e));
            frame.locals.push(start);
        }
        match frame.block(&function.body) {
            Next::Return(value) => value,
            _ => panic!("no result"),
        }
    }

    fn zero(&self, ty: &TypeInner) -> V {
        let of = |handle: Handle<naga::Type>| self.zero(&self.module.types[handle].inner);
        match ty {
            TypeInner::Scalar(_) => V::N(vec![0.0]),
            TypeInner::Vector { size, .. } => V::N(vec![0.0; *size as usize]),
            TypeInner::Matrix { columns, rows, .. } => V::L(vec![V::N(vec![0.0; *rows as usize]); *columns as usize]),
            TypeInner::Array { base, size: naga::ArraySize::Constant(n), .. } => {
                V::L(vec![of(*base); n.get() as usize])
            }
            TypeInner::Struct { members, .. } => V::L(members.iter().map(|m| of(m.ty)).collect()),
            other => panic!("no zero of {other:?}"),
        }
    }
}

impl Frame<'_> {
    fn block(&mut self, block: &Block) -> Next {
        for statement in block {
            match self.statement(statement) {
                Next::On => {}
                other => return other,
            }
        }
        Next::On
    }

    fn statement(&mut self, statement: &Statement) -> Next {
        match statement {
            Statement::Emit(range) => {
                for handle in range.clone() {
                    if !matches!(self.inner(handle), TypeInner::Pointer { .. } | TypeInner::ValuePointer { .. }) {
                        self.values[handle.index()] = Some(self.compute(handle));
                    }
                }
            }
            Statement::Block(inner) => return self.block(inner),
            Statement::If { condition, accept, reject } => {
                return self.block(if self.number(*condition) != 0.0 { accept } else { reject });
            }
            Statement::Switch { selector, cases } => {
                let chosen = self.number(*selector);
                let is = |value: &SwitchValue| match value {
                    SwitchValue::I32(v) => f64::from(*v) == chosen,
                    SwitchValue::U32(v) => f64::from(*v) == chosen,
                    SwitchValue::Default => false,
                };
                let default = cases.iter().position(|c| c.value == SwitchValue::Default);
                let from = cases.iter().position(|c| is(&c.value)).or(default).unwrap();
                let case = cases[from..].iter().find(|c| !c.fall_through).unwrap();
                return match self.block(&case.body) {
                    Next::Break => Next::On,
                    other => other,
                };
            }
            Statement::Loop { body, continuing, break_if } => loop {
                match self.block(body) {
                    Next::Break => return Next::On,
                    Next::Return(value) => return Next::Return(value),
                    Next::On | Next::Continue => {}
                }
                self.block(continuing);
                if break_if.is_some_and(|condition| self.number(condition) != 0.0) {
                    return Next::On;
                }
            },
            Statement::Break => return Next::Break,
            Statement::Continue => return Next::Continue,
            Statement::Return { value } => return Next::Return(self.value(value.unwrap())),
            Statement::Store { pointer, value } => {
                let (local, path) = self.place(*pointer);
                let value = self.value(*value);
                self.locals[local].set(&path, value);
            }
            Statement::Call { function, arguments, result } => {
                let arguments = arguments.iter().map(|argument| self.value(*argument)).collect();
                self.values[result.unwrap().index()] = Some(self.machine.run(*function, arguments));
            }
            other => panic!("cannot run {other:?}"),
        }
        Next::On
    }

    fn place(&self, pointer: Handle<Expression>) -> (usize, Vec<usize>) {
        match &self.function.expressions[pointer] {
            Expression::LocalVariable(local) => (local.index(), vec![]),
            Expression::AccessIndex { base, index } => {
                let (local, path) = self.place(*base);
                (local, [path, vec![*index as usize]].concat())
            }
            Expression::Access { base, index } => {
                let (local, path) = self.place(*base);
                (local, [path, vec![self.number(*index) as usize]].concat())
            }
            other => panic!("no place {other:?}"),
        }
    }

    fn inner(&self, handle: Handle<Expression>) -> &TypeInner {
        self.machine.info[self.handle][handle].ty.inner_with(&self.machine.module.types)
    }

    fn number(&self, handle: Handle<Expression>) -> f64 {
        self.value(handle).n()[0]
    }

    fn value(&self, handle: Handle<Expression>) -> V {
        self.values[handle.index()].clone().unwrap_or_else(|| self.compute(handle))
    }

    fn compute(&self, handle: Handle<Expression>) -> V {
        let value = self.exact(handle);
        let is_float = self.inner(handle).scalar_kind() == Some(ScalarKind::Float);
        if self.machine.rounds && is_float { value.map(|v| f64::from(v as f32)) } else { value }
    }

    fn exact(&self, handle: Handle<Expression>) -> V {
        let module = &self.machine.module;
        match &self.function.expressions[handle] {
            Expression::Literal(literal) => number(*literal),
            Expression::Constant(constant) => constant_value(module, module.constants[*constant].init),
            Expression::ZeroValue(ty) => self.machine.zero(&module.types[*ty].inner),
            Expression::Compose { ty, components } => {
                compose(&module.types[*ty].inner, components.iter().map(|c| self.value(*c)).collect())
            }
            Expression::Splat { size, value } => V::N(vec![self.number(*value); *size as usize]),
            Expression::Access { base, index } => self.value(*base).part(self.number(*index) as usize),
            Expression::AccessIndex { base, index } => self.value(*base).part(*index as usize),
            Expression::Swizzle { size, vector, pattern } => {
                let vector = self.value(*vector);
                V::N(pattern[..*size as usize].iter().map(|c| vector.n()[*c as usize]).collect())
            }
            Expression::FunctionArgument(i) => self.arguments[*i as usize].clone(),
            Expression::Load { pointer } => {
                let (local, path) = self.place(*pointer);
                path.iter().fold(self.locals[local].clone(), |value, i| value.part(*i))
            }
            Expression::Unary { op: UnaryOperator::Negate, expr } => self.value(*expr).map(|v| -v),
            Expression::Unary { op: UnaryOperator::LogicalNot, expr } => self.value(*expr).map(|v| 1.0 - v),
            Expression::Binary { op, left, right } => {
                let (left, right) = (*left, *right);
                if self.inner(handle).scalar_kind() == Some(ScalarKind::Uint) {
                    return zip(&self.value(left), &self.value(right), |a, b| wrapped(*op, a, b));
                }
                let whole = self.inner(handle).scalar_kind() != Some(ScalarKind::Float);
                binary(*op, &self.value(left), &self.value(right), whole)
            }
            Expression::Select { condition, accept, reject } => {
                let (condition, accept, reject) = (self.value(*condition), self.value(*accept), self.value(*reject));
                match condition.n() {
                    [c] => {
                        if *c != 0.0 {
                            accept
                        } else {
                            reject
                        }
                    }
                    c => V::N((0..c.len()).map(|i| if c[i] != 0.0 { accept.n()[i] } else { reject.n()[i] }).collect()),
                }
            }
            Expression::Relational { fun, argument } => {
                let all = self.value(*argument).n().iter().all(|v| *v != 0.0);
                let any = self.value(*argument).n().iter().any(|v| *v != 0.0);
                V::N(vec![f64::from(if *fun == RelationalFunction::All { all } else { any })])
            }
            Expression::Math { fun, arg, arg1, arg2, .. } => {
                let arguments: Vec<_> =
                    [Some(*arg), *arg1, *arg2].into_iter().flatten().map(|a| self.value(a)).collect();
                math(*fun, &arguments)
            }
            Expression::As { expr, kind: ScalarKind::Float | ScalarKind::Bool, .. } => self.value(*expr),
            Expression::As { expr, .. } => self.value(*expr).map(f64::trunc),
            other => panic!("cannot evaluate {other:?}"),
        }
    }
}

/// An operation on unsigned integers, with wrapping.
fn wrapped(op: B, a: f64, b: f64) -> f64 {
    let [a, b] = [a, b].map(|v| v as i64 as u32);
    f64::from(match op {
        B::Add => a.wrapping_add(b),
        B::Subtract => a.wrapping_sub(b),
        B::Multiply => a.wrapping_mul(b),
        B::Divide => a / b,
        B::Modulo => a % b,
        B::And => a & b,
        B::InclusiveOr => a | b,
        B::ExclusiveOr => a ^ b,
        B::ShiftRight => a >> b,
        other => panic!("cannot evaluate {other:?}"),
    })
}

fn number(literal: Literal) -> V {
    V::N(vec![match literal {
        Literal::F32(v) => f64::from(v),
        Literal::I32(v) => f64::from(v),
        Literal::U32(v) => f64::from(v),
        Literal::Bool(v) => f64::from(v),
        other => panic!("cannot evaluate {other:?}"),
    }])
}

fn constant_value(module: &Module, handle: Handle<Expression>) -> V {
    match &module.global_expressions[handle] {
        Expression::Literal(literal) => number(*literal),
        Expression::Compose { ty, components } => {
            compose(&module.types[*ty].inner, components.iter().map(|c| constant_value(module, *c)).collect())
        }
        other => panic!("cannot evaluate {other:?}"),
    }
}

fn compose(ty: &TypeInner, components: Vec<V>) -> V {
    match ty {
        TypeInner::Vector { .. } => V::N(components.iter().flat_map(|c| c.n().to_vec()).collect()),
        _ => V::L(components),
    }
}

/// Applies `f` to each component, with scalars extended to vectors.
fn zip(a: &V, b: &V, f: impl Fn(f64, f64) -> f64) -> V {
    let (a, b) = (a.n(), b.n());
    let at = |v: &[f64], i: usize| if v.len() == 1 { v[0] } else { v[i] };
    V::N((0..a.len().max(b.len())).map(|i| f(at(a, i), at(b, i))).collect())
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn binary(op: B, left: &V, right: &V, whole: bool) -> V {
    match (op, left, right) {
        (B::Multiply, V::L(columns), V::N(v)) if v.len() > 1 => {
            let scaled = columns.iter().zip(v).map(|(c, s)| c.map(|x| x * s));
            return scaled.reduce(|a, b| zip(&a, &b, |a, b| a + b)).unwrap();
        }
        (B::Multiply, V::N(v), V::L(columns)) if v.len() > 1 => {
            return V::N(columns.iter().map(|c| dot(c.n(), v)).collect());
        }
        (B::Multiply, V::L(_), V::L(columns)) => {
            return V::L(columns.iter().map(|c| binary(op, left, c, whole)).collect());
        }
        (_, V::L(l), V::L(r)) => return V::L(l.iter().zip(r).map(|(l, r)| binary(op, l, r, whole)).collect()),
        (_, V::L(l), _) => return V::L(l.iter().map(|l| binary(op, l, right, whole)).collect()),
        (_, _, V::L(r)) => return V::L(r.iter().map(|r| binary(op, left, r, whole)).collect()),
        _ => {}
    }
    let from_bool = f64::from;
    zip(left, right, |a, b| match op {
        B::Add => a + b,
        B::Subtract => a - b,
        B::Multiply => a * b,
        B::Divide if whole => (a / b).trunc(),
        B::Divide => a / b,
        B::Modulo => a % b,
        B::Equal => from_bool(a == b),
        B::NotEqual => from_bool(a != b),
        B::Less => from_bool(a < b),
        B::LessEqual => from_bool(a <= b),
        B::Greater => from_bool(a > b),
        B::GreaterEqual => from_bool(a >= b),
        B::And | B::LogicalAnd => f64::from((a as i64 & b as i64) as i32),
        B::InclusiveOr | B::LogicalOr => (a as u32 | b as u32).into(),
        other => panic!("cannot evaluate {other:?}"),
    })
}

fn math(fun: M, args: &[V]) -> V {
    let length = |v: &V| dot(v.n(), v.n()).sqrt();
    let a = &args[0];
    match (fun, args.len()) {
        (M::Length, _) => V::N(vec![length(a)]),
        (M::Normalize, _) => a.map(|v| v / length(a)),
        (M::Dot, _) => V::N(vec![dot(a.n(), args[1].n())]),
        (M::Distance, _) => V::N(vec![length(&zip(a, &args[1], |a, b| a - b))]),
        (M::Cross, _) => {
            let (a, b) = (a.n(), args[1].n());
            V::N((0..3).map(|i| a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3]).collect())
        }
        (M::Transpose, _) => {
            let V::L(columns) = a else { panic!("not a matrix") };
            V::L((0..columns[0].n().len()).map(|i| V::N(columns.iter().map(|c| c.n()[i]).collect())).collect())
        }
        (_, 1) => a.map(|v| math1(fun, v)),
        (_, 2) => zip(a, &args[1], |a, b| math2(fun, a, b)),
        _ => {
            let count = args.iter().map(|v| v.n().len()).max().unwrap();
            let at = |v: &V, i: usize| if v.n().len() == 1 { v.n()[0] } else { v.n()[i] };
            V::N((0..count).map(|i| math3(fun, at(a, i), at(&args[1], i), at(&args[2], i))).collect())
        }
    }
}

fn math1(fun: M, v: f64) -> f64 {
    match fun {
        M::Abs => v.abs(),
        M::Sign => {
            if v == 0.0 {
                0.0
            } else {
                v.signum()
            }
        }
        M::Floor => v.floor(),
        M::Ceil => v.ceil(),
        M::Round => v.round_ties_even(),
        M::Trunc => v.trunc(),
        M::Fract => v - v.floor(),
        M::Saturate => v.clamp(0.0, 1.0),
        M::Sqrt => v.sqrt(),
        M::InverseSqrt => 1.0 / v.sqrt(),
        M::Exp => v.exp(),
        M::Exp2 => v.exp2(),
        M::Log => v.ln(),
        M::Log2 => v.log2(),
        M::Sin => v.sin(),
        M::Cos => v.cos(),
        M::Tan => v.tan(),
        M::Asin => v.asin(),
        M::Acos => v.acos(),
        M::Atan => v.atan(),
        M::Sinh => v.sinh(),
        M::Cosh => v.cosh(),
        M::Tanh => v.tanh(),
        M::Radians => v.to_radians(),
        M::Degrees => v.to_degrees(),
        other => panic!("cannot evaluate {other:?}"),
    }
}

fn math2(fun: M, a: f64, b: f64) -> f64 {
    match fun {
        M::Min => a.min(b),
        M::Max => a.max(b),
        M::Step => f64::from(b >= a),
        M::Pow => a.powf(b),
        M::Atan2 => a.atan2(b),
        other => panic!("cannot evaluate {other:?}"),
    }
}

fn math3(fun: M, a: f64, b: f64, c: f64) -> f64 {
    match fun {
        M::Clamp => a.max(b).min(c),
        M::Mix => a * (1.0 - c) + b * c,
        M::Fma => a * b + c,
        M::SmoothStep => {
            let t = ((c - a) / (b - a)).clamp(0.0, 1.0);
            t * t * (3.0 - 2.0 * t)
        }
        other => panic!("cannot evaluate {other:?}"),
    }
}
