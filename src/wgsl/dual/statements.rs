//! The statements of a dual function, in the order of the original.

use std::fmt::Write as _;

use naga::{Block, Expression, Function, Handle, Statement, SwitchCase, SwitchValue};

use super::activity::root;
use super::error::DualError;
use super::tangent_writer::{AXES, Carried, PASSIVE, TangentWriter, construct};

impl<'a> TangentWriter<'a> {
    /// The text of the dual function.
    pub fn write(mut self) -> Result<String, DualError> {
        for (handle, expression) in self.function.expressions.iter() {
            if let Expression::FunctionArgument(i) = expression {
                self.carried[handle.index()] = Some(self.argument(*i as usize));
            }
        }
        self.head()?;
        self.locals()?;
        self.block(&self.function.body)?;
        self.out.push_str("}\n");
        Ok(self.out)
    }

    fn head(&mut self) -> Result<(), DualError> {
        let mut arguments = Vec::new();
        for (argument, active) in self.function.arguments.iter().zip(&self.active[&self.handle]) {
            let ty = if *active && !self.is_entry { self.dual_type(argument.ty)? } else { self.type_name(argument.ty) };
            arguments.push(format!("{}: {ty}", argument.name.as_deref().unwrap_or_default()));
        }
        let result = self.function.result.as_ref().map(|result| self.type_name(result.ty));
        let takes_point = arguments.first().is_some_and(|first| first.ends_with(": vec3f"));
        let result = match (&self.function.result, result.as_deref()) {
            (_, Some("f32")) if self.is_entry && takes_point => "vec4f".to_owned(),
            (Some(result), _) if !self.is_entry => self.dual_type(result.ty)?,
            _ => return Err(self.unsupported("a function that takes no vec3f first or returns no f32")),
        };
        let name = self.function.name.as_deref().unwrap_or_default();
        writeln!(self.out, "\nfn dual_{name}({}) -> {result} {{", arguments.join(", ")).expect("strings take all");
        Ok(())
    }

    fn argument(&self, index: usize) -> Carried {
        let name = self.function.arguments[index].name.clone().unwrap_or_default();
        if !self.active[&self.handle][index] {
            return Carried { value: name, tangents: PASSIVE };
        }
        if self.is_entry {
            let unit = ["1.0, 0.0, 0.0", "0.0, 1.0, 0.0", "0.0, 0.0, 1.0"];
            return Carried { value: name, tangents: unit.map(|unit| Some(format!("vec3f({unit})"))) };
        }
        fields(&name)
    }

    fn locals(&mut self) -> Result<(), DualError> {
        for (handle, local) in self.function.local_variables.iter() {
            let ty = self.type_name(local.ty);
            let start = match local.init {
                Some(init) => format!(" = {}", self.value(init)?),
                None => String::new(),
            };
            let name = self.local_name(handle);
            self.line(&format!("var {name}: {ty}{start};"));
            if self.activity.locals[handle.index()] {
                for axis in AXES {
                    self.line(&format!("var {name}{axis}: {ty};"));
                }
            }
        }
        Ok(())
    }

    fn block(&mut self, block: &'a Block) -> Result<(), DualError> {
        block.iter().try_for_each(|statement| self.statement(statement))
    }

    fn indented(&mut self, block: &'a Block) -> Result<(), DualError> {
        self.depth += 1;
        self.block(block)?;
        self.depth -= 1;
        Ok(())
    }

    fn statement(&mut self, statement: &'a Statement) -> Result<(), DualError> {
        match statement {
            Statement::Emit(range) => range.clone().try_for_each(|handle| self.emit(handle))?,
            Statement::Block(inner) => {
                self.line("{");
                self.indented(inner)?;
                self.line("}");
            }
            Statement::If { condition, accept, reject } => {
                let condition = self.value(*condition)?;
                self.line(&format!("if {condition} {{"));
                self.indented(accept)?;
                if !reject.is_empty() {
                    self.line("} else {");
                    self.indented(reject)?;
                }
                self.line("}");
            }
            Statement::Switch { selector, cases } => self.switch(*selector, cases)?,
            Statement::Loop { body, continuing, break_if } => {
                self.line("loop {");
                self.indented(body)?;
                self.line("    continuing {");
                self.depth += 1;
                self.indented(continuing)?;
                if let Some(condition) = break_if {
                    let condition = self.value(*condition)?;
                    self.line(&format!("    break if {condition};"));
                }
                self.line("}");
                self.depth -= 1;
                self.line("}");
            }
            Statement::Break => self.line("break;"),
            Statement::Continue => self.line("continue;"),
            Statement::Return { value: Some(value) } => self.give_back(*value)?,
            Statement::Store { pointer, value } => self.store(*pointer, *value)?,
            Statement::Call { function, arguments, result: Some(result) } => {
                self.call(*function, arguments, *result)?
            }
            other => return Err(self.unsupported(&construct(other))),
        }
        Ok(())
    }

    fn switch(&mut self, selector: Handle<Expression>, cases: &'a [SwitchCase]) -> Result<(), DualError> {
        let selector = self.value(selector)?;
        self.line(&format!("switch {selector} {{"));
        let mut labels = Vec::new();
        for case in cases {
            labels.push(match case.value {
                SwitchValue::I32(value) => format!("{value}i"),
                SwitchValue::U32(value) => format!("{value}u"),
                SwitchValue::Default => "default".to_owned(),
            });
            if case.fall_through && case.body.is_empty() {
                continue;
            }
            if case.fall_through {
                return Err(self.unsupported("a case that falls through"));
            }
            self.line(&format!("case {}: {{", labels.join(", ")));
            self.indented(&case.body)?;
            self.line("}");
            labels.clear();
        }
        self.line("}");
        Ok(())
    }

    fn give_back(&mut self, value: Handle<Expression>) -> Result<(), DualError> {
        let text = self.value(value)?;
        let [x, y, z] = self.filled(value);
        let result = match &self.function.result {
            Some(result) if !self.is_entry => format!("{}({text}, {x}, {y}, {z})", self.dual_type(result.ty)?),
            _ => format!("vec4f({x}, {y}, {z}, {text})"),
        };
        self.line(&format!("return {result};"));
        Ok(())
    }

    fn store(&mut self, pointer: Handle<Expression>, value: Handle<Expression>) -> Result<(), DualError> {
        let text = self.value(value)?;
        let place = self.place(pointer, "")?;
        self.line(&format!("{place} = {text};"));
        if root(self.function, pointer).is_some_and(|local| self.activity.locals[local.index()]) {
            for (axis, tangent) in AXES.iter().zip(self.filled(value)) {
                let place = self.place(pointer, axis)?;
                self.line(&format!("{place} = {tangent};"));
            }
        }
        Ok(())
    }

    fn call(
        &mut self,
        callee: Handle<Function>,
        arguments: &[Handle<Expression>],
        result: Handle<Expression>,
    ) -> Result<(), DualError> {
        if arguments.iter().any(|argument| self.is_pointer(*argument)) {
            return Err(self.unsupported("pointers as arguments"));
        }
        let here = self.name(result);
        let name = self.module.functions[callee].name.as_deref().unwrap_or_default();
        let mut texts = arguments.iter().map(|argument| self.value(*argument)).collect::<Result<Vec<_>, _>>()?;
        if !self.is_active(result) {
            self.line(&format!("let {here} = {name}({});", texts.join(", ")));
            self.carried[result.index()] = Some(Carried { value: here, tangents: PASSIVE });
            return Ok(());
        }
        let parameters = &self.module.functions[callee].arguments;
        for (i, text) in texts.iter_mut().enumerate().filter(|(i, _)| self.active[&callee][*i]) {
            let [x, y, z] = self.filled(arguments[i]);
            *text = format!("{}({text}, {x}, {y}, {z})", self.dual_type(parameters[i].ty)?);
        }
        self.line(&format!("let {here} = dual_{name}({});", texts.join(", ")));
        self.carried[result.index()] = Some(fields(&here));
        Ok(())
    }

    /// Writes an expression here, unless it is only a part of one that is already written.
    fn emit(&mut self, handle: Handle<Expression>) -> Result<(), DualError> {
        if self.is_pointer(handle) {
            return Ok(());
        }
        let expression = &self.function.expressions[handle];
        let name = self.name(handle);
        let is_part = matches!(
            expression,
            Expression::Access { .. } | Expression::AccessIndex { .. } | Expression::Swizzle { .. }
        );
        let text = self.text(handle)?;
        let value = if is_part { text } else { self.define(&name, &text) };
        self.carried[handle.index()] = Some(Carried { value, tangents: PASSIVE });
        if self.is_active(handle) {
            let mut tangents = self.tangents(handle)?;
            // A variable may change later, so its value needs a name. Other texts as simple as a name need none.
            let is_variable = matches!(expression, Expression::Load { .. });
            for (axis, tangent) in AXES.iter().zip(&mut tangents) {
                *tangent = tangent.take().map(|text| {
                    let stands = is_part || (is_simple(&text) && !is_variable);
                    if stands { text } else { self.define(&format!("{name}{axis}"), &text) }
                });
            }
            self.carried[handle.index()].as_mut().expect("was written above").tangents = tangents;
        }
        Ok(())
    }
}

/// The fields of a value of the prelude's structs.
fn fields(name: &str) -> Carried {
    Carried { value: format!("{name}.v"), tangents: AXES.map(|axis| Some(format!("{name}.{axis}"))) }
}

/// Whether a text is a name or a part of a named value.
fn is_simple(text: &str) -> bool {
    text.chars().all(|c| c.is_alphanumeric() || c == '_' || c == '.')
}
