//! Activity analysis: finds the expressions and variables of a function that must carry a derivative, because they
//! depend on an active argument and affect the result. The dual function copies all others unchanged.

use std::collections::HashMap;

use naga::valid::FunctionInfo;
use naga::{
    Block, Expression, Function, Handle, LocalVariable, MathFunction, Module, ScalarKind, Statement, TypeInner,
};

/// The arguments of each call, by its result.
type Calls<'a> = HashMap<Handle<Expression>, &'a [Handle<Expression>]>;

/// The active parts of one function, by index.
pub struct Activity {
    /// Expressions.
    pub expressions: Vec<bool>,
    /// Local variables.
    pub locals: Vec<bool>,
}

impl Activity {
    /// Analyses `function` where `arguments` says which arguments are active.
    pub fn of(module: &Module, info: &FunctionInfo, function: &Function, arguments: &[bool]) -> Self {
        let mut flow = Flow { module, function, calls: HashMap::new(), stores: Vec::new(), results: Vec::new() };
        flow.collect(&function.body);
        let varies = flow.forward(info, arguments);
        let matters = flow.backward();
        let both = |a: Vec<bool>, b: Vec<bool>| a.into_iter().zip(b).map(|(a, b)| a && b).collect();
        Self { expressions: both(varies.0, matters.0), locals: both(varies.1, matters.1) }
    }

    /// The functions that need dual functions, with the active arguments of each call.
    pub fn calls(&self, function: &Function) -> Vec<(Handle<Function>, Vec<bool>)> {
        let mut calls = Vec::new();
        walk(&function.body, &mut |statement| {
            if let Statement::Call { function, arguments, result: Some(result) } = statement
                && self.expressions[result.index()]
            {
                calls.push((*function, arguments.iter().map(|a| self.expressions[a.index()]).collect()));
            }
        });
        calls
    }
}

/// Flags of expressions and of local variables.
type Flags = (Vec<bool>, Vec<bool>);

/// The flow of values between expressions.
struct Flow<'a> {
    module: &'a Module,
    function: &'a Function,
    calls: Calls<'a>,
    stores: Vec<(Handle<LocalVariable>, Handle<Expression>)>,
    results: Vec<Handle<Expression>>,
}

impl<'a> Flow<'a> {
    fn collect(&mut self, block: &'a Block) {
        walk(block, &mut |statement| match statement {
            Statement::Store { pointer, value } => {
                self.stores.extend(root(self.function, *pointer).map(|local| (local, *value)));
            }
            Statement::Call { arguments, result: Some(result), .. } => {
                self.calls.insert(*result, arguments);
            }
            Statement::Return { value } => self.results.extend(value),
            _ => {}
        });
    }

    /// Everything that depends on an active argument.
    fn forward(&self, info: &FunctionInfo, arguments: &[bool]) -> Flags {
        let (mut expressions, mut locals) = self.none();
        loop {
            let before = locals.clone();
            for (handle, expression) in self.function.expressions.iter() {
                expressions[handle.index()] = match expression {
                    _ if is_discrete(info[handle].ty.inner_with(&self.module.types)) => false,
                    Expression::FunctionArgument(i) => arguments[*i as usize],
                    Expression::Load { pointer } => {
                        root(self.function, *pointer).is_some_and(|local| locals[local.index()])
                    }
                    _ => self.carriers(handle).iter().any(|operand| expressions[operand.index()]),
                };
            }
            for (local, value) in &self.stores {
                locals[local.index()] |= expressions[value.index()];
            }
            if locals == before {
                return (expressions, locals);
            }
        }
    }

    /// Everything that affects the result.
    fn backward(&self) -> Flags {
        let (mut expressions, mut locals) = self.none();
        for value in &self.results {
            expressions[value.index()] = true;
        }
        loop {
            let before = locals.clone();
            for (handle, expression) in self.function.expressions.iter().rev() {
                if !expressions[handle.index()] {
                    continue;
                }
                if let Expression::Load { pointer } = expression
                    && let Some(local) = root(self.function, *pointer)
                {
                    locals[local.index()] = true;
                }
                for operand in self.carriers(handle) {
                    expressions[operand.index()] = true;
                }
            }
            for (local, value) in &self.stores {
                expressions[value.index()] |= locals[local.index()];
            }
            if locals == before {
                return (expressions, locals);
            }
        }
    }

    fn none(&self) -> Flags {
        (vec![false; self.function.expressions.len()], vec![false; self.function.local_variables.len()])
    }

    /// The operands with an influence on the expression's derivative.
    fn carriers(&self, handle: Handle<Expression>) -> Vec<Handle<Expression>> {
        use MathFunction as M;
        match &self.function.expressions[handle] {
            Expression::Math { fun: M::Sign | M::Floor | M::Ceil | M::Round | M::Trunc | M::Step, .. } => vec![],
            Expression::Math { arg, arg1, arg2, arg3, .. } => {
                [Some(*arg), *arg1, *arg2, *arg3].into_iter().flatten().collect()
            }
            Expression::Compose { components, .. } => components.clone(),
            Expression::Access { base, .. } | Expression::AccessIndex { base, .. } => vec![*base],
            Expression::Splat { value: one, .. }
            | Expression::Swizzle { vector: one, .. }
            | Expression::Unary { expr: one, .. }
            | Expression::As { expr: one, .. } => vec![*one],
            Expression::Binary { left, right, .. } => vec![*left, *right],
            Expression::Select { accept, reject, .. } => vec![*accept, *reject],
            Expression::CallResult(callee) if !is_detached(self.module, *callee) => {
                self.calls.get(&handle).map_or(vec![], |arguments| arguments.to_vec())
            }
            _ => vec![],
        }
    }
}

/// Whether the result of this function is excluded from differentiation.
fn is_detached(module: &Module, function: Handle<Function>) -> bool {
    module.functions[function].name.as_deref().is_some_and(|name| name.starts_with("detach_"))
}

/// Whether values of this type have no derivative: integers and booleans.
fn is_discrete(ty: &TypeInner) -> bool {
    matches!(ty.scalar_kind(), Some(ScalarKind::Sint | ScalarKind::Uint | ScalarKind::Bool))
}

/// The local variable that a pointer points into.
pub fn root(function: &Function, pointer: Handle<Expression>) -> Option<Handle<LocalVariable>> {
    match function.expressions[pointer] {
        Expression::LocalVariable(local) => Some(local),
        Expression::Access { base, .. } | Expression::AccessIndex { base, .. } => root(function, base),
        _ => None,
    }
}

/// Visits every statement of a block and of the blocks within it.
fn walk<'a>(block: &'a Block, visit: &mut impl FnMut(&'a Statement)) {
    for statement in block {
        visit(statement);
        match statement {
            Statement::Block(inner) => walk(inner, visit),
            Statement::If { accept, reject, .. } => {
                walk(accept, visit);
                walk(reject, visit);
            }
            Statement::Switch { cases, .. } => {
                for case in cases {
                    walk(&case.body, visit);
                }
            }
            Statement::Loop { body, continuing, .. } => {
                walk(body, visit);
                walk(continuing, visit);
            }
            _ => {}
        }
    }
}
