//! What is made of the table of shapes.

macro_rules! shapes {
    ($( $(#[doc = $doc:literal])+ $name:ident = $function:ident $(with $data:ident)?, $label:literal {
        $( $(#[doc = $help:literal])+ $(#[serde($missing:ident)])? $param:ident: $type:ty = $default:expr, $limits:expr; )*
    } )+) => {
        $crate::params::param_kinds! {
            /// A shape with its parameters, in meters, in local space.
            #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
            #[serde(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
            pub enum Shape;

            /// Which shape, without its parameters. The number is the code that the GPU reads.
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

            /// The shape of these packed parameters, see [`Shape::packed`]; nothing for one with data.
            #[allow(unused_mut, unused_variables, reason = "shapes without parameters")]
            pub fn unpacked(self, packed: &[f64; SHAPE_FLOATS]) -> Option<Shape> {
                if self.has_data() {
                    return None;
                }
                let mut rest = packed.as_slice();
                Some(match self { $( Self::$name => Shape::$name { $( $param: Packed::unpack(&mut rest), )* }, )+ })
            }

            /// How many rows of four numbers it takes: its parameters, and behind them where its data are.
            pub fn rows(self) -> usize {
                self.parameter_rows() + usize::from(self.has_data())
            }

            /// How many rows of four numbers its parameters take, see [`Shape::packed`].
            pub fn parameter_rows(self) -> usize {
                if self.has_data() {
                    return DATA_PARAMETER_ROWS;
                }
                match self { $( Self::$name => const { (0_usize $( + <$type as Packed>::FLOATS )*).div_ceil(4) }, )+ }
            }

            /// Whether it is evaluated from numbers made of its parameters, with further rows behind them.
            pub fn has_data(self) -> bool {
                match self { $( Self::$name => false $( || stringify!($data) == "data" )?, )+ }
            }

            /// Whether its field is found by iterating, as that of a fractal.
            pub fn is_iterated(self) -> bool {
                self.params().iter().any(|param| param.name == "iterations")
            }

            /// The shape with its default parameters.
            pub fn default_shape(self) -> Shape {
                self.with_defaults()
            }
        }

        impl Shape {
            /// The parameters in order, as the evaluators read them; unused places are 0. An angle is its sine and
            /// cosine; a number of sides is followed by the cosine and sine of half the angle of one. Of a shape with
            /// data all are 0: `flat::PreparedShape` makes what is read instead.
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

        /// Calls `$callback!(Name = sdf_name, …)` with every shape; `with data` behind those that have data.
        #[macro_export]
        macro_rules! for_each_shape {
            ($callback:ident) => { $callback! { $( $name = $function $(with $data)?, )+ } };
        }
    };
}
