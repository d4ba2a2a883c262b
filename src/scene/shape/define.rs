//! Macros that define the types of shapes from their table.

macro_rules! shapes {
    ($( $(#[doc = $doc:literal])+ $name:ident = $function:ident $(with $data:ident)?, $label:literal {
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

        impl ShapeKind {
            /// The function that computes its field, on the CPU and on the GPU.
            pub fn function(self) -> &'static str {
                match self { $( Self::$name => stringify!($function), )+ }
            }

            /// The shape of these packed parameters, see [`Shape::packed`]; `None` for one with data.
            #[allow(unused_mut, unused_variables, reason = "shapes without parameters")]
            pub fn unpacked(self, packed: &[f64; SHAPE_FLOATS]) -> Option<Shape> {
                if self.has_data() {
                    return None;
                }
                let mut rest = packed.as_slice();
                Some(match self { $( Self::$name => Shape::$name { $( $param: Packed::unpack(&mut rest), )* }, )+ })
            }

            /// Rows of four numbers in total: those of its parameters, and for a shape with data the location of its
            /// payload.
            pub fn rows(self) -> usize {
                self.parameter_rows() + usize::from(self.has_data())
            }

            /// Rows of four numbers for its parameters, see [`Shape::packed`].
            pub fn parameter_rows(self) -> usize {
                if self.has_data() {
                    return DATA_PARAMETER_ROWS;
                }
                match self { $( Self::$name => const { (0_usize $( + <$type as Packed>::FLOATS )*).div_ceil(4) }, )+ }
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
            /// The parameters in order, as the evaluators read them; unused places are 0. An angle becomes its sine and
            /// cosine; a number of sides is followed by the cosine and sine of half the angle of one side. For a shape
            /// with data all are 0: `field::PreparedShape` makes the numbers that the evaluators read.
            #[allow(unused_mut, unused_variables, reason = "shapes without parameters")]
            pub fn packed(&self) -> [f64; SHAPE_FLOATS] {
                let mut out = [0.0; SHAPE_FLOATS];
                if self.kind().has_data() {
                    return out;
                }
                let mut rest = out.as_mut_slice();
                match self { $( Self::$name { $( $param, )* } => { $( Packed::pack($param, &mut rest); )* } )+ }
                out
            }
        }

        /// Calls `$callback!(Name = sdf_name, …)` with every shape; `with data` follows those that have data.
        #[macro_export]
        macro_rules! for_each_shape {
            ($callback:ident) => { $callback! { $( $name = $function $(with $data)?, )+ } };
        }
    };
}
