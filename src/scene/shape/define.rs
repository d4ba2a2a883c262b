//! Macros that define the types of shapes from their table.

/// The struct that the evaluators of a shape read: its parameters, or for one with data what is derived from them.
macro_rules! shape_eval_params {
    ($(#[doc = $doc:literal])+ $eval:ident { $($own:tt)* } data { $($members:tt)* }) => {
        $crate::eval_params! { $(#[doc = $doc])+ $eval { $($members)* } }
    };
    ($(#[doc = $doc:literal])+ $eval:ident { $( $(#[doc = $help:literal])+ $param:ident: $type:ty, )* }) => {
        $crate::eval_params! {
            $(#[doc = $doc])+ $eval { $( $(#[doc = $help])+ $param: <$type as Packed>::Value, )* }
        }
    };
}

/// Writes the parameters of a shape without data.
macro_rules! pack_shape {
    ($eval:ident, $out:ident, { $($param:ident,)* }) => {
        shape_params::$eval { $( $param: Packed::pack($param), )* }.write(|at, number| $out[at] = number)
    };
    ($eval:ident, $out:ident, { $($param:ident,)* } data) => {
        ()
    };
}

/// The shape of packed parameters, if it has no data.
macro_rules! unpack_shape {
    ($name:ident, $eval:ident, $packed:ident, { $($param:ident,)* }) => {{
        let read = shape_params::$eval::read(|i| $packed[i]);
        Some(Shape::$name { $( $param: Packed::unpack(read.$param), )* })
    }};
    ($name:ident, $eval:ident, $packed:ident, { $($param:ident,)* } data) => {
        None
    };
}

macro_rules! shapes {
    ($( $(#[doc = $doc:literal])+ $name:ident = $function:ident($eval:ident) $(with $data:ident {
        $( $(#[doc = $member_help:literal])+ $member:ident: $member_type:ty, )*
    })?, $label:literal {
        $( $(#[doc = $help:literal])+ $(#[serde($missing:ident)])? $param:ident: $type:ty = $default:expr, $limits:expr; )*
    } )+) => {
        $crate::params::param_kinds! {
            /// A shape with its parameters, in meters, in local space.
            #[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
            pub enum Shape;

            /// The kind of a shape, without its parameters. The number is the code that the GPU reads.
            #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
            #[repr(u32)]
            pub enum ShapeKind;

            $( $(#[doc = $doc])+ $name = $label {
                $( $(#[doc = $help])+ $(#[serde($missing)])? $param: $type = $default, $limits; )*
            } )+
        }

        /// The parameters of each shape as its evaluators read them, by the names of the table.
        pub mod shape_params {
            use super::{Degrees, Packed, Sides};

            $( shape_eval_params! {
                $(#[doc = $doc])+ $eval { $( $(#[doc = $help])+ $param: $type, )* } $( $data {
                    $( $(#[doc = $member_help])+ $member: $member_type, )*
                } )?
            } )+
        }

        impl ShapeKind {
            /// The function that computes its field, on the CPU and on the GPU.
            pub fn function(self) -> &'static str {
                match self { $( Self::$name => stringify!($function), )+ }
            }

            /// The shape of these packed parameters, see [`Shape::packed`]; `None` for one with data.
            #[allow(unused_variables, reason = "shapes without parameters")]
            pub fn unpacked(self, packed: &[f64; SHAPE_FLOATS]) -> Option<Shape> {
                match self { $( Self::$name => unpack_shape!($name, $eval, packed, { $($param,)* } $($data)?), )+ }
            }

            /// Rows of four numbers in total: those of its parameters, and for a shape with data the location of its
            /// payload.
            pub fn rows(self) -> usize {
                self.parameter_rows() + usize::from(self.has_data())
            }

            /// Rows of four numbers for its parameters, see [`Shape::packed`].
            pub fn parameter_rows(self) -> usize {
                match self { $( Self::$name => const { <shape_params::$eval as EvalParams>::LAYOUT.rows() }, )+ }
            }

            /// The names of the numbers in these rows, and their places.
            pub fn eval_layout(self) -> ParamLayout {
                match self { $( Self::$name => <shape_params::$eval as EvalParams>::LAYOUT, )+ }
            }

            /// Whether it is evaluated from a payload derived from its parameters.
            pub fn has_data(self) -> bool {
                match self { $( Self::$name => false $( || stringify!($data) == "data" )?, )+ }
            }

            /// Whether its field is computed by iteration, like that of a fractal.
            pub fn is_iterated(self) -> bool {
                self.params().iter().any(|param| param.name == "iterations")
            }

            /// The shape with its default parameters.
            pub fn default_shape(self) -> Shape {
                self.with_defaults()
            }
        }

        impl Shape {
            /// The parameters as the evaluators read them, see [`ShapeKind::eval_layout`]; unused places are 0. For a
            /// shape with data all are 0: `field::PreparedShape` makes the numbers that the evaluators read.
            #[allow(unused_variables, reason = "shapes with data")]
            pub fn packed(&self) -> [f64; SHAPE_FLOATS] {
                let mut out = [0.0; SHAPE_FLOATS];
                match self { $( Self::$name { $( $param, )* } => pack_shape!($eval, out, { $($param,)* } $($data)?), )+ }
                out
            }
        }

        /// Calls `$callback!(Name = sdf_name(NameParams), …)` with every shape; `with data` follows those that have data.
        #[macro_export]
        macro_rules! for_each_shape {
            ($callback:ident) => { $callback! { $( $name = $function($eval) $(with $data)?, )+ } };
        }
    };
}
