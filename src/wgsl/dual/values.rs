//! The text of expressions and places.

use naga::back::binary_operation_str;
use naga::common::wgsl::TryToWgsl as _;
use naga::{Expression, Handle, Literal, RelationalFunction, SwizzleComponent, TypeInner, UnaryOperator};

use super::error::DualError;
use super::tangent_writer::{TangentWriter, construct};

impl TangentWriter<'_> {
    /// The text of an expression's value: a name, or a text that needs no brackets.
    pub fn value(&self, handle: Handle<Expression>) -> Result<String, DualError> {
        match &self.carried[handle.index()] {
            Some(carried) => Ok(carried.value.clone()),
            None => self.text(handle),
        }
    }

    /// An expression in terms of its operands.
    pub fn text(&self, handle: Handle<Expression>) -> Result<String, DualError> {
        let expression = &self.function.expressions[handle];
        Ok(match expression {
            Expression::Literal(literal) => self.literal(*literal)?,
            Expression::Constant(constant) => match &self.module.constants[*constant].name {
                Some(name) => name.clone(),
                None => return Err(self.unsupported("a constant without a name")),
            },
            Expression::ZeroValue(ty) => format!("{}()", self.type_name(*ty)),
            Expression::Compose { ty, components } => {
                let components = components.iter().map(|c| self.value(*c)).collect::<Result<Vec<_>, _>>()?;
                format!("{}({})", self.type_name(*ty), components.join(", "))
            }
            Expression::Splat { value, .. } => format!("{}({})", self.type_of(handle), self.value(*value)?),
            Expression::Access { base, .. } | Expression::AccessIndex { base, .. } => {
                format!("{}{}", self.value(*base)?, self.part(handle)?)
            }
            Expression::Swizzle { vector, .. } => format!("{}{}", self.value(*vector)?, self.part(handle)?),
            Expression::Load { pointer } => self.place(*pointer, "")?,
            Expression::Unary { op, expr } => format!("{}{}", unary(*op), self.value(*expr)?),
            Expression::Binary { op, left, right } => {
                format!("{} {} {}", self.value(*left)?, binary_operation_str(*op), self.value(*right)?)
            }
            Expression::Select { condition, accept, reject } => {
                format!("select({}, {}, {})", self.value(*reject)?, self.value(*accept)?, self.value(*condition)?)
            }
            Expression::Relational { fun: RelationalFunction::All, argument } => {
                format!("all({})", self.value(*argument)?)
            }
            Expression::Relational { fun: RelationalFunction::Any, argument } => {
                format!("any({})", self.value(*argument)?)
            }
            Expression::Math { fun, arg, arg1, arg2, arg3 } => {
                let name = fun.try_to_wgsl().ok_or_else(|| self.unsupported(&construct(fun)))?;
                let arguments = [Some(*arg), *arg1, *arg2, *arg3].into_iter().flatten();
                let arguments = arguments.map(|argument| self.value(argument)).collect::<Result<Vec<_>, _>>()?;
                format!("{name}({})", arguments.join(", "))
            }
            Expression::As { expr, convert: Some(_), .. } => {
                format!("{}({})", self.type_of(handle), self.value(*expr)?)
            }
            other => return Err(self.unsupported(&construct(other))),
        })
    }

    fn literal(&self, literal: Literal) -> Result<String, DualError> {
        let text = match literal {
            Literal::F32(value) => format!("{value:?}f"),
            Literal::U32(value) => format!("{value}u"),
            Literal::I32(i32::MIN) => "i32(-2147483648)".to_owned(),
            Literal::I32(value) => format!("{value}i"),
            Literal::Bool(value) => format!("{value}"),
            other => return Err(self.unsupported(&construct(&other))),
        };
        Ok(if text.starts_with('-') { format!("({text})") } else { text })
    }

    /// The suffix of a base that selects a part of it.
    pub fn part(&self, handle: Handle<Expression>) -> Result<String, DualError> {
        match &self.function.expressions[handle] {
            Expression::Access { index, .. } => Ok(format!("[{}]", self.value(*index)?)),
            Expression::AccessIndex { base, index } => {
                let mut inner = self.inner(*base);
                if let TypeInner::Pointer { base, .. } = inner {
                    inner = &self.module.types[*base].inner;
                }
                Ok(match inner {
                    TypeInner::Vector { .. } | TypeInner::ValuePointer { .. } => {
                        format!(".{}", ["x", "y", "z", "w"][*index as usize])
                    }
                    TypeInner::Struct { members, .. } => {
                        format!(".{}", members[*index as usize].name.as_deref().unwrap_or_default())
                    }
                    _ => format!("[{index}]"),
                })
            }
            Expression::Swizzle { size, pattern, .. } => {
                Ok(std::iter::once('.').chain(pattern[..*size as usize].iter().map(|c| letter(*c))).collect())
            }
            other => Err(self.unsupported(&construct(other))),
        }
    }

    /// A place in a local variable, or in the variable of one of its tangents.
    pub fn place(&self, pointer: Handle<Expression>, axis: &str) -> Result<String, DualError> {
        match &self.function.expressions[pointer] {
            Expression::LocalVariable(local) => Ok(format!("{}{axis}", self.local_name(*local))),
            Expression::Access { base, .. } | Expression::AccessIndex { base, .. } => {
                Ok(format!("{}{}", self.place(*base, axis)?, self.part(pointer)?))
            }
            _ => Err(self.unsupported("pointers as arguments")),
        }
    }
}

fn letter(component: SwizzleComponent) -> char {
    ['x', 'y', 'z', 'w'][component as usize]
}

fn unary(op: UnaryOperator) -> &'static str {
    match op {
        UnaryOperator::Negate => "-",
        UnaryOperator::LogicalNot => "!",
        UnaryOperator::BitwiseNot => "~",
    }
}
