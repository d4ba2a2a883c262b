//! Forward-mode automatic differentiation: generates from the WGSL of a distance function its dual function, which also
//! returns the derivatives along x, y and z.
//!
//! Every value that depends on the point carries three tangents of its own type, so the rules of vectors are those of
//! scalars. One evaluation of a dual function replaces the six that central differences need, and has no truncation
//! error. The generated text copies expressions that do not depend on the point, or that do not affect the result. The
//! result of a function `detach_…` counts as constant.
//!
//! At kinks the derivative is that of one side. Tangents are finite where values are.

mod activity;
mod error;
mod rules;
mod statements;
mod tangent_writer;
#[cfg(test)]
mod tests;
mod values;

use std::collections::HashMap;

use naga::valid::{Capabilities, ValidationFlags, Validator};
use naga::{Expression, Function, Handle, MathFunction, Module};

use activity::Activity;
pub use error::DualError;
use tangent_writer::TangentWriter;
#[cfg(test)]
pub(crate) use tests::Machine;

/// Prelude of dual functions, needed once before the first: values with their derivatives along x, y and z.
pub const DUAL_PRELUDE: &str = "
struct DualF32 { v: f32, x: f32, y: f32, z: f32 }
struct DualVec2 { v: vec2f, x: vec2f, y: vec2f, z: vec2f }
struct DualVec3 { v: vec3f, x: vec3f, y: vec3f, z: vec3f }
struct DualVec4 { v: vec4f, x: vec4f, y: vec4f, z: vec4f }
";

/// The dual functions of `function`, named `dual_…`, and of those functions it calls with values that depend on its
/// point.
///
/// `source` is complete: it contains every function that `function` calls. The point is the first argument, a `vec3f`;
/// all other arguments are constants. The dual function returns the derivatives along x, y and z, then the distance.
/// Its text needs `source`, whose functions it calls, and follows [`DUAL_PRELUDE`].
pub fn dual(source: &str, function: &str) -> Result<String, DualError> {
    let module = naga::front::wgsl::parse_str(source).map_err(|e| DualError::Source(e.emit_to_string(source)))?;
    let info = Validator::new(ValidationFlags::all(), Capabilities::empty())
        .validate(&module)
        .map_err(|e| DualError::Source(e.emit_to_string(source)))?;
    let named = |(_, f): &(Handle<Function>, &Function)| f.name.as_deref() == Some(function);
    let (entry, _) = module.functions.iter().find(named).ok_or_else(|| DualError::NoFunction(function.to_owned()))?;
    check(&module, function)?;

    // Callers follow their callees: backward, all callers of a function are known before the function.
    let seeds = module.functions[entry].arguments.iter().enumerate().map(|(i, _)| i == 0).collect();
    let mut active: HashMap<_, Vec<bool>> = HashMap::from([(entry, seeds)]);
    let mut derived = Vec::new();
    for (handle, called) in module.functions.iter().rev() {
        let Some(arguments) = active.get(&handle) else { continue };
        let activity = Activity::of(&module, &info[handle], called, arguments);
        for (callee, arguments) in activity.calls(called) {
            let known = active.entry(callee).or_insert_with(|| vec![false; arguments.len()]);
            known.iter_mut().zip(arguments).for_each(|(known, more)| *known |= more);
        }
        derived.push((handle, activity));
    }
    let mut out = String::new();
    for (handle, activity) in derived.into_iter().rev() {
        out.push_str(&TangentWriter::new(&module, &info[handle], handle, activity, &active, handle == entry).write()?);
    }
    Ok(out)
}

/// Rejects constructs that could hide a dependency from the analysis, and names that dual functions need.
fn check(module: &Module, function: &str) -> Result<(), DualError> {
    let refuse = |function: &str, construct: &str| {
        Err(DualError::Unsupported { function: function.to_owned(), construct: construct.to_owned() })
    };
    if !module.global_variables.is_empty() {
        return refuse(function, "global variables");
    }
    for (_, f) in module.functions.iter() {
        let name = f.name.as_deref().unwrap_or_default();
        for (_, expression) in f.expressions.iter() {
            match expression {
                Expression::As { convert: None, .. } => return refuse(name, "bitcast"),
                Expression::Math { fun, .. } if is_packing(*fun) => return refuse(name, "packed numbers"),
                _ => {}
            }
        }
    }
    let functions = module.functions.iter().flat_map(|(_, f)| f.arguments.iter().map(|a| &a.name).chain([&f.name]));
    let constants = module.constants.iter().map(|(_, c)| &c.name);
    let types = module.types.iter().map(|(_, t)| &t.name);
    let own = |name: &str| name.starts_with('_') && !name.starts_with("__");
    let taken = |name: &&String| own(name) || rules::CALLED.split(' ').any(|called| called == *name);
    match functions.chain(constants).chain(types).flatten().find(taken) {
        Some(name) => refuse(function, &format!("the name {name}, which dual functions need")),
        None => Ok(()),
    }
}

fn is_packing(fun: MathFunction) -> bool {
    use MathFunction as M;
    matches!(fun, M::Pack4x8snorm | M::Pack4x8unorm | M::Pack2x16snorm | M::Pack2x16unorm | M::Pack2x16float)
}
