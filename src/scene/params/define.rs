//! Macros that define types and their code from a table of parameters.

/// The key of a field in files: its name, unless the table specifies another.
macro_rules! param_name {
    ($field:ident) => {
        stringify!($field)
    };
    ($field:ident, $key:literal) => {
        $key
    };
}
pub(crate) use param_name;

/// The rows of a table, built once.
macro_rules! param_rows {
    ($( $(#[doc = $help:literal])+ [$name:expr] $type:ty = $default:expr, $spec:expr; )*) => {{
        static TABLE: std::sync::LazyLock<Vec<$crate::params::Param>> = std::sync::LazyLock::new(|| {
            let rows: Vec<Option<$crate::params::Param>> = vec![$(
                $crate::params::row::<$type>($name, concat!($( $help, )+), $spec, $default),
            )*];
            rows.into_iter().flatten().collect()
        });
        TABLE.as_slice()
    }};
}
pub(crate) use param_rows;

/// Defines a struct whose fields are parameters. Fields in brackets are not parameters; they come first.
///
/// ```text
/// param_struct! {
///     /// A viewpoint.
///     #[derive(…)]
///     pub struct CameraNode {
///         /// Full vertical angle of view.
///         fov_y: f64 = 40.0, FOV.labeled("Field of view");
///     }
/// }
/// ```
macro_rules! param_struct {
    ($(#[$meta:meta])* $scope:vis struct $name:ident $([ $(
        $(#[doc = $about:literal])+ $field:ident: $field_type:ty = $value:expr;
    )* ])? { $(
        $(#[doc = $help:literal])+ $(#[serde($($serde:tt)*)])? $param:ident: $type:ty = $default:expr, $spec:expr;
    )* }) => {
        $(#[$meta])*
        $scope struct $name {
            $( $( $(#[doc = $about])+ pub $field: $field_type, )* )?
            $( $(#[doc = $help])+ $(#[serde($($serde)*)])? pub $param: $type, )*
        }

        impl Default for $name {
            fn default() -> Self {
                Self { $( $( $field: $value, )* )? $( $param: $default, )* }
            }
        }

        $crate::params::param_table! { $name { $( $(#[doc = $help])+ $param: $type = $default, $spec; )* } }
    };
}
pub(crate) use param_struct;

/// The table of a struct that is defined elsewhere. `field as "key"` gives a field another name in files.
macro_rules! param_table {
    ($name:ident { $(
        $(#[doc = $help:literal])+ $param:ident $(as $key:literal)?: $type:ty = $default:expr, $spec:expr;
    )* }) => {
        impl $crate::params::Params for $name {
            fn params(&self) -> &'static [$crate::params::Param] {
                $crate::params::param_rows! { $(
                    $(#[doc = $help])+
                    [$crate::params::param_name!($param $(, $key)?)] $type = $default, $spec;
                )* }
            }

            fn visit(&self, prefix: &str, visit: &mut $crate::params::Visit<'_>) {
                let table = self.params();
                $( {
                    let name = $crate::params::param_name!($param $(, $key)?);
                    let slot = $crate::params::ParamSlot { prefix, name, table };
                    $crate::params::ParamField::visit_field(&self.$param, slot, visit);
                } )*
            }

            fn find(&self, name: &str) -> Option<&'static $crate::params::Param> {
                $( {
                    let field = $crate::params::param_name!($param $(, $key)?);
                    if let Some(below) = $crate::params::below(name, field) {
                        let slot = $crate::params::ParamSlot { prefix: "", name: field, table: self.params() };
                        return $crate::params::ParamField::find_field(&self.$param, slot, below);
                    }
                } )*
                None
            }

            fn get(&self, name: &str) -> Option<$crate::params::ParamValue> {
                $( if let Some(below) =
                    $crate::params::below(name, $crate::params::param_name!($param $(, $key)?))
                {
                    return $crate::params::ParamField::get_field(&self.$param, below);
                } )*
                None
            }

            fn set(&mut self, name: &str, value: $crate::params::ParamValue) -> bool {
                $( if let Some(below) =
                    $crate::params::below(name, $crate::params::param_name!($param $(, $key)?))
                {
                    return $crate::params::ParamField::set_field(&mut self.$param, below, value);
                } )*
                false
            }
        }
    };
}
pub(crate) use param_table;

/// The value of a parameter that is missing in a file: its default, if its row in the table is marked with
/// `#[serde(default)]`.
macro_rules! missing_param {
    ([default] $param:ident, $default:expr) => {
        $default
    };
    ([] $param:ident, $default:expr) => {
        return Err(serde::de::Error::missing_field(stringify!($param)))
    };
}
pub(crate) use missing_param;

/// Defines an enum whose variants have parameters, and the enum of its kinds, without parameters. A row that is marked
/// with `#[serde(default)]` may be missing in a file: it then has the default of the table.
macro_rules! param_kinds {
    (
        $(#[$meta:meta])* pub enum $name:ident;
        $(#[$kind_meta:meta])* pub enum $kind:ident;
        $( $(#[doc = $doc:literal])+ $variant:ident = $label:literal { $(
            $(#[doc = $help:literal])+ $(#[serde($missing:ident)])? $param:ident: $type:ty = $default:expr, $spec:expr;
        )* } )+
    ) => {
        $(#[$meta])*
        #[serde(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
        pub enum $name {
            $( $(#[doc = $doc])+ $variant { $( $(#[doc = $help])+ $(#[serde($missing)])? $param: $type, )* }, )+
        }

        const _: () = {
            /// What files contain: each parameter, unless it is missing.
            #[derive(serde::Deserialize)]
            #[serde(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
            enum Written {
                $( $variant { $(
                    #[serde(default, deserialize_with = "crate::params::given")]
                    $param: Option<$type>,
                )* }, )+
            }

            impl<'de> serde::Deserialize<'de> for $name {
                fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                    Ok(match Written::deserialize(deserializer)? { $(
                        Written::$variant { $( $param, )* } => Self::$variant { $( $param: match $param {
                            Some(value) => value,
                            None => $crate::params::missing_param!([$($missing)?] $param, $default),
                        }, )* },
                    )+ })
                }
            }
        };

        $(#[$kind_meta])*
        pub enum $kind { $( $(#[doc = $doc])+ $variant, )+ }

        impl $kind {
            /// Every kind, in the order of the user interface.
            pub const ALL: &[Self] = &[$( Self::$variant, )+];

            /// Display name.
            pub fn label(self) -> &'static str {
                match self { $( Self::$variant => $label, )+ }
            }

            /// The help text.
            pub fn help(self) -> &'static str {
                match self { $( Self::$variant => concat!($( $doc, )+).trim_ascii(), )+ }
            }

            /// Its parameters in order.
            pub fn params(self) -> &'static [$crate::params::Param] {
                match self { $( Self::$variant => $crate::params::param_rows! { $(
                    $(#[doc = $help])+ [stringify!($param)] $type = $default, $spec;
                )* }, )+ }
            }

            /// The kind with its default parameters.
            fn with_defaults(self) -> $name {
                match self { $( Self::$variant => $name::$variant { $( $param: $default, )* }, )+ }
            }
        }

        impl $name {
            /// Its kind.
            pub fn kind(&self) -> $kind {
                match self { $( Self::$variant { .. } => $kind::$variant, )+ }
            }

            /// The parameters' values, in the order of their table.
            pub fn values(&self) -> Vec<$crate::params::ParamValue> {
                let mut values = Vec::new();
                $crate::params::Params::visit(self, "", &mut |_, _, value| values.push(value));
                values
            }

            /// Sets the parameter at `index`. Returns false and changes nothing if there is none or the value is of
            /// another type.
            pub fn set_value(&mut self, index: usize, value: $crate::params::ParamValue) -> bool {
                let param = self.kind().params().get(index);
                param.is_some_and(|param| $crate::params::Params::set(self, param.name, value))
            }
        }

        $crate::params::param_variants! { $name by |value| value.kind().params(); { $(
            $name::$variant { $( $param, )* }
        )+ } }
    };
}
pub(crate) use param_kinds;

/// Implements the parameters of an enum whose tables exist already.
macro_rules! param_variants {
    ($name:ident by |$value:ident| $table:expr; { $( $owner:ident::$variant:ident { $( $param:ident, )* } )+ }) => {
        #[allow(unused_variables, reason = "variants without parameters")]
        impl $crate::params::Params for $name {
            fn params(&self) -> &'static [$crate::params::Param] {
                let $value = self;
                $table
            }

            fn visit(&self, prefix: &str, visit: &mut $crate::params::Visit<'_>) {
                let table = self.params();
                match self { $( $owner::$variant { $( $param, )* } => { $(
                    let slot = $crate::params::ParamSlot { prefix, name: stringify!($param), table };
                    $crate::params::ParamField::visit_field($param, slot, visit);
                )* } )+ }
            }

            fn find(&self, name: &str) -> Option<&'static $crate::params::Param> {
                let table = self.params();
                match self { $( $owner::$variant { $( $param, )* } => { $(
                    if let Some(below) = $crate::params::below(name, stringify!($param)) {
                        let slot = $crate::params::ParamSlot { prefix: "", name: stringify!($param), table };
                        return $crate::params::ParamField::find_field($param, slot, below);
                    }
                )* } )+ }
                None
            }

            fn get(&self, name: &str) -> Option<$crate::params::ParamValue> {
                match self { $( $owner::$variant { $( $param, )* } => { $(
                    if let Some(below) = $crate::params::below(name, stringify!($param)) {
                        return $crate::params::ParamField::get_field($param, below);
                    }
                )* } )+ }
                None
            }

            fn set(&mut self, name: &str, value: $crate::params::ParamValue) -> bool {
                match self { $( $owner::$variant { $( $param, )* } => { $(
                    if let Some(below) = $crate::params::below(name, stringify!($param)) {
                        return $crate::params::ParamField::set_field($param, below, value);
                    }
                )* } )+ }
                false
            }
        }
    };
}
pub(crate) use param_variants;

/// Makes a struct with parameters usable as a part of another one.
macro_rules! nested_params {
    ($name:ident) => {
        impl $crate::params::ParamField for $name {
            fn to_value(&self) -> Option<$crate::params::ParamValue> {
                None
            }
            fn from_value(_: $crate::params::ParamValue) -> Option<Self> {
                None
            }
            fn visit_field(&self, slot: $crate::params::ParamSlot<'_>, visit: &mut $crate::params::Visit<'_>) {
                $crate::params::Params::visit(self, &slot.inner_prefix(), visit);
            }
            fn find_field(
                &self,
                _: $crate::params::ParamSlot<'_>,
                below: &str,
            ) -> Option<&'static $crate::params::Param> {
                $crate::params::Params::find(self, below.strip_prefix('.')?)
            }
            fn get_field(&self, below: &str) -> Option<$crate::params::ParamValue> {
                $crate::params::Params::get(self, below.strip_prefix('.')?)
            }
            fn set_field(&mut self, below: &str, value: $crate::params::ParamValue) -> bool {
                let name = below.strip_prefix('.');
                name.is_some_and(|name| $crate::params::Params::set(self, name, value))
            }
        }
    };
}
pub(crate) use nested_params;

/// Makes an enum with parameters usable as a part of a struct. Its variant is the parameter `type`, as in files.
macro_rules! nested_variants {
    ($name:ident, $label:literal, $help:literal) => {
        impl $name {
            fn type_param() -> &'static $crate::params::Param {
                static CHOICES: std::sync::LazyLock<Vec<$crate::params::Choice>> =
                    std::sync::LazyLock::new($crate::params::tags::<$name>);
                static PARAM: std::sync::LazyLock<$crate::params::Param> =
                    std::sync::LazyLock::new(|| $crate::params::Param {
                        name: "type",
                        label: $label.into(),
                        help: $help,
                        limits: $crate::limits::NO_LIMITS,
                        default: $crate::params::ParamValue::Choice(&CHOICES[0].key),
                        choices: &CHOICES,
                        is_color: false,
                        animatable: false,
                    });
                &PARAM
            }

            fn type_value(&self) -> $crate::params::ParamValue {
                let choices = Self::type_param().choices;
                $crate::params::ParamValue::Choice(&choices[$crate::params::Variants::variant(self)].key)
            }
        }

        impl $crate::params::ParamField for $name {
            fn to_value(&self) -> Option<$crate::params::ParamValue> {
                None
            }
            fn from_value(_: $crate::params::ParamValue) -> Option<Self> {
                None
            }
            fn visit_field(&self, slot: $crate::params::ParamSlot<'_>, visit: &mut $crate::params::Visit<'_>) {
                let prefix = slot.inner_prefix();
                visit(&prefix, Self::type_param(), self.type_value());
                $crate::params::Params::visit(self, &prefix, visit);
            }
            fn find_field(
                &self,
                _: $crate::params::ParamSlot<'_>,
                below: &str,
            ) -> Option<&'static $crate::params::Param> {
                match below.strip_prefix('.')? {
                    "type" => Some(Self::type_param()),
                    name => $crate::params::Params::find(self, name),
                }
            }
            fn get_field(&self, below: &str) -> Option<$crate::params::ParamValue> {
                match below.strip_prefix('.')? {
                    "type" => Some(self.type_value()),
                    name => $crate::params::Params::get(self, name),
                }
            }
            fn set_field(&mut self, below: &str, value: $crate::params::ParamValue) -> bool {
                let choices = Self::type_param().choices;
                match (below.strip_prefix('.'), value) {
                    (Some("type"), $crate::params::ParamValue::Choice(key)) => {
                        let index = choices.iter().position(|choice| choice.key == key);
                        index.map(|index| $crate::params::change_variant(self, index)).is_some()
                    }
                    (Some(name), value) => $crate::params::Params::set(self, name, value),
                    (None, _) => false,
                }
            }
        }
    };
}
pub(crate) use nested_variants;

/// Makes an enum without fields usable as a choice parameter. It needs `ALL`, `label` and `help`.
macro_rules! choices {
    ($name:ident) => {
        impl $crate::params::ParamField for $name {
            const ANIMATABLE: bool = false;

            fn choices() -> &'static [$crate::params::Choice] {
                static CHOICES: std::sync::LazyLock<Vec<$crate::params::Choice>> =
                    std::sync::LazyLock::new(|| $crate::params::choices_of(&$name::ALL, $name::label, $name::help));
                &CHOICES
            }
            fn to_value(&self) -> Option<$crate::params::ParamValue> {
                let index = Self::ALL.iter().position(|value| value == self)?;
                Some($crate::params::ParamValue::Choice(&Self::choices()[index].key))
            }
            fn from_value(value: $crate::params::ParamValue) -> Option<Self> {
                let $crate::params::ParamValue::Choice(key) = value else { return None };
                Self::choices().iter().position(|choice| choice.key == key).map(|index| Self::ALL[index])
            }
        }
    };
}
pub(crate) use choices;

/// Implements the parameters of an entry of a list: those of the entry itself, and those of `$inner` behind them.
macro_rules! slot_params {
    ($name:ident, $inner:ident, { $( $(#[doc = $help:literal])+ $own:ident: $type:ty = $default:expr; )+ }) => {
        impl $name {
            fn own_params() -> &'static [$crate::params::Param] {
                $crate::params::param_rows! { $(
                    $(#[doc = $help])+
                    [stringify!($own)] $type = $default, $crate::limits::NO_LIMITS.fixed();
                )+ }
            }

            fn own_slot(name: &'static str) -> $crate::params::ParamSlot<'static> {
                $crate::params::ParamSlot { prefix: "", name, table: Self::own_params() }
            }
        }

        impl $crate::params::Params for $name {
            fn params(&self) -> &'static [$crate::params::Param] {
                self.$inner.params()
            }

            fn visit(&self, prefix: &str, visit: &mut $crate::params::Visit<'_>) {
                $( {
                    let slot = $crate::params::ParamSlot { prefix, ..Self::own_slot(stringify!($own)) };
                    $crate::params::ParamField::visit_field(&self.$own, slot, visit);
                } )+
                self.$inner.visit(prefix, visit);
            }

            fn find(&self, name: &str) -> Option<&'static $crate::params::Param> {
                $( if name == stringify!($own) {
                    return $crate::params::ParamField::find_field(&self.$own, Self::own_slot(stringify!($own)), "");
                } )+
                self.$inner.find(name)
            }

            fn get(&self, name: &str) -> Option<$crate::params::ParamValue> {
                $( if name == stringify!($own) {
                    return $crate::params::ParamField::to_value(&self.$own);
                } )+
                self.$inner.get(name)
            }

            fn set(&mut self, name: &str, value: $crate::params::ParamValue) -> bool {
                $( if name == stringify!($own) {
                    return $crate::params::ParamField::set_field(&mut self.$own, "", value);
                } )+
                self.$inner.set(name, value)
            }
        }
    };
}
pub(crate) use slot_params;
