//! The writer of a dual function: the text of each expression, and the names and types of its values.
//!
//! It writes in layers, each in a file that calls only those before it: values, rules, statements. Every expression
//! becomes a `let` at its place of evaluation. Its tangents follow with their axis as the last letter: `_d_8`, `_d_8x`,
//! `_d_8y`, `_d_8z`. Names in dual functions begin with an underscore.

use std::collections::HashMap;
use std::fmt::Debug;

use naga::common::wgsl::TypeContext as _;
use naga::valid::FunctionInfo;
use naga::{Expression, Function, Handle, LocalVariable, Module, Type, TypeInner};

use super::activity::Activity;
use super::error::DualError;

/// The last letters of tangents, and the fields of the prelude's structs.
pub const AXES: [&str; 3] = ["x", "y", "z"];

/// The tangents of an expression along x, y and z; `None` for one that is known to be zero.
pub type Tangents = [Option<String>; 3];

/// The text of an expression: names, or texts as simple as names.
#[derive(Clone)]
pub struct Carried {
    pub value: String,
    pub tangents: Tangents,
}

/// The tangents of values that do not depend on the point.
pub const PASSIVE: Tangents = [const { None }; 3];

/// Writes the dual function of a function.
pub struct TangentWriter<'a> {
    pub module: &'a Module,
    pub info: &'a FunctionInfo,
    pub function: &'a Function,
    pub handle: Handle<Function>,
    pub activity: Activity,
    /// The active arguments of every function that has a dual function.
    pub active: &'a HashMap<Handle<Function>, Vec<bool>>,
    /// Whether this is the requested dual function, which takes the point and returns a vector.
    pub is_entry: bool,
    /// By index of the expression; `None` if it is not evaluated yet.
    pub carried: Vec<Option<Carried>>,
    pub out: String,
    pub depth: usize,
}

impl<'a> TangentWriter<'a> {
    /// A writer without text.
    pub fn new(
        module: &'a Module,
        info: &'a FunctionInfo,
        handle: Handle<Function>,
        activity: Activity,
        active: &'a HashMap<Handle<Function>, Vec<bool>>,
        is_entry: bool,
    ) -> Self {
        let function = &module.functions[handle];
        let carried = vec![None; function.expressions.len()];
        Self { module, info, function, handle, activity, active, is_entry, carried, out: String::new(), depth: 1 }
    }

    /// Writes a `let` and returns its name.
    pub fn define(&mut self, name: &str, text: &str) -> String {
        self.line(&format!("let {name} = {text};"));
        name.to_owned()
    }

    /// Writes a value that a rule computes once for all three tangents of an expression.
    pub fn shared(&mut self, of: Handle<Expression>, letter: &str, text: &str) -> String {
        let name = self.name(of);
        self.define(&format!("{name}{letter}"), text)
    }

    /// Whether the expression carries tangents.
    pub fn is_active(&self, handle: Handle<Expression>) -> bool {
        self.activity.expressions[handle.index()]
    }

    /// The texts of an expression's tangents.
    pub fn tangents_of(&self, handle: Handle<Expression>) -> Tangents {
        self.carried[handle.index()].as_ref().map_or(PASSIVE, |carried| carried.tangents.clone())
    }

    /// The texts of an expression's tangents, with explicit zeros.
    pub fn filled(&self, handle: Handle<Expression>) -> [String; 3] {
        let zero = match self.type_of(handle).as_str() {
            "f32" => "0.0".to_owned(),
            ty => format!("{ty}()"),
        };
        self.tangents_of(handle).map(|tangent| tangent.unwrap_or_else(|| zero.clone()))
    }

    /// An error that names this function.
    pub fn unsupported(&self, construct: &str) -> DualError {
        let function = self.function.name.clone().unwrap_or_default();
        DualError::Unsupported { function, construct: construct.to_owned() }
    }

    /// The name of a local variable; its number makes it unique.
    pub fn local_name(&self, local: Handle<LocalVariable>) -> String {
        let name = self.function.local_variables[local].name.as_deref().unwrap_or("e");
        let name = name.trim_start_matches('_');
        format!("_{name}_v{}", local.index())
    }

    /// The name of an expression.
    pub fn name(&self, handle: Handle<Expression>) -> String {
        let name = self.function.named_expressions.get(&handle).map_or("e", String::as_str);
        let name = name.trim_start_matches('_');
        format!("_{name}_{}", handle.index())
    }

    /// The type of an expression.
    pub fn inner(&self, handle: Handle<Expression>) -> &TypeInner {
        self.info[handle].ty.inner_with(&self.module.types)
    }

    /// Whether an expression is a pointer to a variable.
    pub fn is_pointer(&self, handle: Handle<Expression>) -> bool {
        matches!(self.inner(handle), TypeInner::Pointer { .. } | TypeInner::ValuePointer { .. })
    }

    /// Whether an expression is the point.
    pub fn is_point(&self, handle: Handle<Expression>) -> bool {
        self.is_entry && matches!(self.function.expressions[handle], Expression::FunctionArgument(0))
    }

    /// The name of an expression's type.
    pub fn type_of(&self, handle: Handle<Expression>) -> String {
        short(&self.module.types.type_resolution_to_string(&self.info[handle].ty))
    }

    /// The name of a type.
    pub fn type_name(&self, ty: Handle<Type>) -> String {
        short(&self.module.types.type_to_string(ty))
    }

    /// The name of the prelude's struct for a type.
    pub fn dual_type(&self, ty: Handle<Type>) -> Result<String, DualError> {
        let name = self.type_name(ty);
        Ok(match name.as_str() {
            "f32" => "DualF32",
            "vec2f" => "DualVec2",
            "vec3f" => "DualVec3",
            "vec4f" => "DualVec4",
            _ => return Err(self.unsupported(&format!("a call that hands over {name}"))),
        }
        .to_owned())
    }

    /// Writes a line.
    pub fn line(&mut self, text: &str) {
        for _ in 0..self.depth {
            self.out.push_str("    ");
        }
        self.out.push_str(text);
        self.out.push('\n');
    }
}

/// The name of a construct, from its debug output.
pub fn construct(of: &impl Debug) -> String {
    format!("{of:?}").split(|c: char| !c.is_alphanumeric()).next().unwrap_or_default().to_owned()
}

fn short(name: &str) -> String {
    name.replace("<f32>", "f")
}
