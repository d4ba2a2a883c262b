//! Parameters: the values of a scene that have a name, limits, a default and a help text.
//!
//! Each type has one table, and a parameter is one row of it: `name: type = default, limits;` with the help text as the
//! comment above. The checks of files, the inspector, multi-edit, attachments and [`super::ParamPath`] follow from the
//! row. [`param_struct`] and [`param_kinds`] define the type with its table; [`param_table`] and [`param_variants`] add
//! a table to a type defined elsewhere.

use std::borrow::Cow;

use serde::{Deserialize, Deserializer, Serialize};

use super::Limits;

mod define;
#[cfg(test)]
mod tests;
mod value;

pub(crate) use define::{
    choices, missing_param, nested_params, nested_variants, param_kinds, param_name, param_rows, param_struct,
    param_table, param_variants, slot_params,
};
pub use value::{LIST_COLUMNS, List, ParamValue};

/// Reads a parameter that a file contains.
pub(crate) fn given<'de, D, T>(deserializer: D) -> Result<Option<T>, D::Error>
where
    D: Deserializer<'de>,
    T: ParamField + Deserialize<'de>,
{
    T::read(deserializer).map(Some)
}

/// The description of a parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Param {
    /// Its key in files, below the part that it belongs to.
    pub name: &'static str,
    /// Its display name.
    pub label: Cow<'static, str>,
    /// Its help text: one sentence.
    pub help: &'static str,
    /// Accepted and offered ranges, with the unit; for a text, those of its length. Unused by other types.
    pub limits: Limits,
    /// The value in a new object.
    pub default: ParamValue,
    /// The choices, if the value is one.
    pub choices: &'static [Choice],
    /// Whether its three numbers are a linear color.
    pub is_color: bool,
    /// Whether it may change with time: a change neither reads a file nor alters the structure.
    pub animatable: bool,
}

/// One of the values of a choice parameter.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Choice {
    /// Its name in files.
    pub key: String,
    /// Its display name.
    pub label: &'static str,
    /// Its help text: one sentence.
    pub help: &'static str,
}

/// The last column of a table: limits, and special properties of the parameter.
#[derive(Clone, Copy, Debug)]
pub struct ParamSpec {
    limits: Limits,
    label: Option<&'static str>,
    is_color: bool,
    is_fixed: bool,
}

impl From<Limits> for ParamSpec {
    fn from(limits: Limits) -> Self {
        Self { limits, label: None, is_color: false, is_fixed: false }
    }
}

impl Limits {
    /// These limits, with a display name that differs from the name in files.
    pub fn labeled(self, label: &'static str) -> ParamSpec {
        ParamSpec::from(self).labeled(label)
    }

    /// These limits, for each channel of a color.
    pub fn color(self) -> ParamSpec {
        ParamSpec { is_color: true, ..self.into() }
    }

    /// These limits, for a parameter that cannot change with time, see [`Param::animatable`].
    pub fn fixed(self) -> ParamSpec {
        ParamSpec { is_fixed: true, ..self.into() }
    }
}

impl ParamSpec {
    /// The same with a display name that differs from the name in files.
    pub fn labeled(self, label: &'static str) -> Self {
        Self { label: Some(label), ..self }
    }
}

/// Receives the prefix of a parameter's name, the parameter, and its value.
pub type Visit<'v> = dyn FnMut(&str, &'static Param, ParamValue) + 'v;

/// A type with parameters.
pub trait Params {
    /// The rows of its table.
    fn params(&self) -> &'static [Param];

    /// Visits every parameter that the value has now, in the order of the table, including those of its parts; `prefix`
    /// precedes their names.
    fn visit(&self, prefix: &str, visit: &mut Visit<'_>);

    /// The description of the parameter of this name.
    fn find(&self, name: &str) -> Option<&'static Param>;

    /// The value of the parameter of this name.
    fn get(&self, name: &str) -> Option<ParamValue>;

    /// Sets the parameter of this name. Returns false and changes nothing if there is none or the value is of another
    /// type. [`super::check`] checks the limits.
    fn set(&mut self, name: &str, value: ParamValue) -> bool;
}

/// The position of a field in its table.
#[derive(Clone, Copy)]
pub struct ParamSlot<'a> {
    /// The prefix of the field's name.
    pub prefix: &'a str,
    /// The field's name.
    pub name: &'static str,
    /// The table.
    pub table: &'static [Param],
}

impl ParamSlot<'_> {
    /// The prefix for the names of parameters below the field.
    pub fn inner_prefix(&self) -> String {
        format!("{}{}.", self.prefix, self.name)
    }
}

/// A possible type of a field in a table: one value, or a part with parameters of its own. `below` is the remainder
/// after the field's name: empty for the field itself, or a dot and a name.
pub trait ParamField: Sized {
    /// Whether a value of this type may change with time.
    const ANIMATABLE: bool = true;

    /// The choices; empty for most types.
    fn choices() -> &'static [Choice] {
        &[]
    }

    /// The value; `None` for a part.
    fn to_value(&self) -> Option<ParamValue>;

    /// A field of this value, if the value is of the right type.
    fn from_value(value: ParamValue) -> Option<Self>;

    /// Reads the field from a file.
    fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error>
    where
        Self: Deserialize<'de>,
    {
        Self::deserialize(deserializer)
    }

    /// See [`Params::visit`].
    fn visit_field(&self, slot: ParamSlot<'_>, visit: &mut Visit<'_>) {
        if let (Some(value), Some(param)) = (self.to_value(), named(slot.table, slot.name)) {
            visit(slot.prefix, param, value);
        }
    }

    /// See [`Params::find`].
    fn find_field(&self, slot: ParamSlot<'_>, below: &str) -> Option<&'static Param> {
        below.is_empty().then(|| named(slot.table, slot.name)).flatten()
    }

    /// See [`Params::get`].
    fn get_field(&self, below: &str) -> Option<ParamValue> {
        below.is_empty().then(|| self.to_value()).flatten()
    }

    /// See [`Params::set`].
    fn set_field(&mut self, below: &str, value: ParamValue) -> bool {
        let new = below.is_empty().then(|| Self::from_value(value)).flatten();
        new.map(|new| *self = new).is_some()
    }
}

/// A row of a table; `None` for a part, which has its own table.
pub(super) fn row<T: ParamField>(
    name: &'static str,
    help: &'static str,
    spec: impl Into<ParamSpec>,
    default: T,
) -> Option<Param> {
    let ParamSpec { limits, label, is_color, is_fixed } = spec.into();
    Some(Param {
        name,
        label: label.map_or_else(|| sentence_case(name).into(), Cow::Borrowed),
        help: help.trim_ascii(),
        limits,
        default: default.to_value()?,
        choices: T::choices(),
        is_color,
        animatable: T::ANIMATABLE && !is_fixed,
    })
}

/// The parameter of this name.
pub(super) fn named(table: &'static [Param], name: &str) -> Option<&'static Param> {
    table.iter().find(|param| param.name == name)
}

/// The remainder of a name after the field: empty, or a dot and the rest.
pub(super) fn below<'n>(name: &'n str, field: &str) -> Option<&'n str> {
    name.strip_prefix(field).filter(|rest| rest.is_empty() || rest.starts_with('.'))
}

/// `bottom_radius` → `Bottom radius`.
fn sentence_case(name: &str) -> String {
    let spaced = name.replace('_', " ");
    let mut chars = spaced.chars();
    chars.next().map_or_else(String::new, |first| first.to_uppercase().collect::<String>() + chars.as_str())
}

/// The choices of an enum without fields, with their keys in files.
pub(super) fn choices_of<T: Copy + Serialize>(
    all: &[T],
    label: impl Fn(T) -> &'static str,
    help: impl Fn(T) -> &'static str,
) -> Vec<Choice> {
    let key = |value: T| serde_json::to_value(value).ok().and_then(|key| key.as_str().map(str::to_owned));
    all.iter().map(|v| Choice { key: key(*v).unwrap_or_default(), label: label(*v), help: help(*v) }).collect()
}

/// An enum whose variants have parameters.
pub trait Variants: Params + Serialize + Sized {
    /// Each variant with its default parameters, its display name and its help text.
    fn variants() -> Vec<(Self, &'static str, &'static str)>;
    /// The index of its variant among them.
    fn variant(&self) -> usize;
}

/// The variants as choices, with their tags in files as keys.
pub(super) fn tags<T: Variants>() -> Vec<Choice> {
    let tag = |value: &T| serde_json::to_value(value).ok()?.get("type")?.as_str().map(str::to_owned);
    let choice = |(value, label, help)| Choice { key: tag(&value).unwrap_or_default(), label, help };
    T::variants().into_iter().map(choice).collect()
}

/// Changes to another variant and keeps the values of all parameters that both have.
pub(super) fn change_variant<T: Variants>(this: &mut T, index: usize) {
    let mut new = T::variants().swap_remove(index).0;
    this.visit("", &mut |prefix, param, value| {
        new.set(&format!("{prefix}{}", param.name), value);
    });
    *this = new;
}
