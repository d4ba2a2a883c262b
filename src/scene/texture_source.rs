//! What a texture shows: an image, or a pattern between two colors or values.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::attachment::Attachment;
use super::limits::{NO_LIMITS, OCTAVES, PATTERN_SHARE, SEED, TEXTURE_SCALE, TURBULENCE, UNIT};
use super::params::{ParamField, Variants, choices, nested_variants, param_rows, param_variants};
use super::texture_image::TextureImage;

/// How the numbers of an image are meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ColorSpace {
    /// Encoded as colors for screens are. Files with linear numbers, such as EXR, are read as they are.
    Srgb,
    /// Amounts.
    Linear,
}

impl ColorSpace {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Srgb, Self::Linear];

    /// Display name.
    pub fn label(self) -> &'static str {
        ["sRGB", "Linear"][self as usize]
    }

    fn help(self) -> &'static str {
        ["Encoded as colors for screens are.", "Amounts, such as heights and roughness."][self as usize]
    }
}

choices!(ColorSpace);

/// How an image goes on beyond its edges.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum TextureWrap {
    /// It starts again.
    Repeat,
    /// Every second one is a mirror image.
    Mirror,
    /// Its edge goes on.
    Clamp,
}

impl TextureWrap {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Repeat, Self::Mirror, Self::Clamp];

    /// Display name.
    pub fn label(self) -> &'static str {
        ["Repeat", "Mirror", "Clamp"][self as usize]
    }

    fn help(self) -> &'static str {
        ["It starts again.", "Every second one is a mirror image.", "Its edge goes on."][self as usize]
    }
}

choices!(TextureWrap);

/// A pattern that is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PatternKind {
    /// Layers of noise. Numbers: layers, seed.
    Noise,
    /// Squares of two colors.
    Checker,
    /// Bricks in mortar. Numbers: height of a row and width of the joint, both in bricks.
    Bricks,
    /// Rings around the Z axis. Numbers: turbulence.
    Wood,
    /// Veins. Numbers: turbulence, seed.
    Marble,
}

/// What a texture shows, whichever property it is for.
#[derive(Clone, Copy, Debug)]
pub enum TextureSource<'a> {
    /// An image; without a file there is nothing to show.
    Image {
        /// The image.
        image: &'a Attachment<TextureImage>,
        /// How its numbers are meant.
        color_space: ColorSpace,
        /// How it goes on beyond its edges.
        wrap: TextureWrap,
        /// Images per tile.
        scale: f64,
    },
    /// A pattern between two colors; those of a value have three equal channels.
    Pattern {
        /// The pattern.
        kind: PatternKind,
        /// First color.
        first: [f64; 3],
        /// Second color.
        second: [f64; 3],
        /// Patterns per tile.
        scale: f64,
        /// See [`PatternKind`].
        numbers: [f64; 2],
    },
}

/// A color or a value as three channels.
trait Channels {
    fn channels(self) -> [f64; 3];
}

impl Channels for [f64; 3] {
    fn channels(self) -> [f64; 3] {
        self
    }
}

impl Channels for f64 {
    fn channels(self) -> [f64; 3] {
        [self; 3]
    }
}

/// Defines the texture of one property: an image, or a pattern between two values of `$type`.
macro_rules! texture {
    (
        $(#[$doc:meta])* $name:ident, $slot:literal, $help:literal;
        $type:ty, $spec:expr, $space:ident, $first:expr, $second:expr
    ) => {
        $(#[$doc])*
        #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
        #[serde(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
        pub enum $name {
            /// None: the material's own value.
            None {},
            /// An image.
            Image {
                /// The image; none shows the material's own value.
                image: Attachment<TextureImage>,
                /// How its numbers are meant.
                color_space: ColorSpace,
                /// How it goes on beyond its edges.
                wrap: TextureWrap,
                /// Images per tile.
                scale: f64,
            },
            /// Layers of noise.
            Noise {
                /// Where the noise is least.
                first: $type,
                /// Where the noise is greatest.
                second: $type,
                /// Hills per tile in the first layer.
                scale: f64,
                /// Number of layers.
                #[serde(deserialize_with = "ParamField::read")]
                layers: u32,
                /// Another seed gives another pattern.
                #[serde(deserialize_with = "ParamField::read")]
                seed: u32,
            },
            /// Squares in turn.
            Checker {
                /// Every second square.
                first: $type,
                /// The squares between.
                second: $type,
                /// Pairs of squares per tile.
                scale: f64,
            },
            /// Bricks in mortar.
            Bricks {
                /// The bricks.
                first: $type,
                /// The mortar.
                second: $type,
                /// Bricks per tile.
                scale: f64,
                /// Height of a row, in lengths of a brick.
                row: f64,
                /// Width of the joints, in lengths of a brick.
                joint: f64,
            },
            /// Rings of a tree around the Z axis.
            Wood {
                /// Between the rings.
                first: $type,
                /// The rings.
                second: $type,
                /// Rings per tile.
                scale: f64,
                /// How far the rings are out of round, in rings.
                turbulence: f64,
            },
            /// Veins across the X axis.
            Marble {
                /// The stone.
                first: $type,
                /// The veins.
                second: $type,
                /// Veins per tile.
                scale: f64,
                /// How far the veins wander, in veins.
                turbulence: f64,
                /// Another seed gives another pattern.
                #[serde(deserialize_with = "ParamField::read")]
                seed: u32,
            },
        }

        param_variants! { $name by |texture| texture.table(); {
            $name::None {}
            $name::Image { image, color_space, wrap, scale, }
            $name::Noise { first, second, scale, layers, seed, }
            $name::Checker { first, second, scale, }
            $name::Bricks { first, second, scale, row, joint, }
            $name::Wood { first, second, scale, turbulence, }
            $name::Marble { first, second, scale, turbulence, seed, }
        } }
        nested_variants!($name, $slot, $help);

        impl Default for $name {
            fn default() -> Self {
                Self::None {}
            }
        }

        impl $name {
            /// Whether there is none.
            pub fn is_none(&self) -> bool {
                matches!(self, Self::None {})
            }

            /// What it shows; `None` for the material's own value.
            pub fn source(&self) -> Option<TextureSource<'_>> {
                use PatternKind as Kind;
                let pattern = |kind, first: &$type, second: &$type, scale: &f64, numbers| {
                    let [first, second] = [first, second].map(|v| Channels::channels(*v));
                    Some(TextureSource::Pattern { kind, first, second, scale: *scale, numbers })
                };
                match self {
                    Self::None {} => None,
                    Self::Image { image, color_space, wrap, scale } => image.content().map(|_| {
                        TextureSource::Image { image, color_space: *color_space, wrap: *wrap, scale: *scale }
                    }),
                    Self::Noise { first, second, scale, layers, seed } => {
                        pattern(Kind::Noise, first, second, scale, [f64::from(*layers), f64::from(*seed)])
                    }
                    Self::Checker { first, second, scale } => pattern(Kind::Checker, first, second, scale, [0.0; 2]),
                    Self::Bricks { first, second, scale, row, joint } => {
                        pattern(Kind::Bricks, first, second, scale, [*row, *joint])
                    }
                    Self::Wood { first, second, scale, turbulence } => {
                        pattern(Kind::Wood, first, second, scale, [*turbulence, 0.0])
                    }
                    Self::Marble { first, second, scale, turbulence, seed } => {
                        pattern(Kind::Marble, first, second, scale, [*turbulence, f64::from(*seed)])
                    }
                }
            }

            /// The table of its parameters.
            fn table(&self) -> &'static [super::Param] {
                match self {
                    Self::None {} => &[],
                    Self::Image { .. } => param_rows! {
                        /// The image; the scene keeps a copy of the file.
                        ["image"] Attachment<TextureImage> = Attachment::NONE, NO_LIMITS.labeled(concat!($slot, " image"));
                        /// How its numbers are meant.
                        ["color_space"] ColorSpace = ColorSpace::$space, NO_LIMITS.labeled(concat!($slot, " space"));
                        /// How it goes on beyond its edges.
                        ["wrap"] TextureWrap = TextureWrap::Repeat, NO_LIMITS.labeled(concat!($slot, " wrap"));
                        /// Images per tile.
                        ["scale"] f64 = 1.0, TEXTURE_SCALE.labeled(concat!($slot, " scale"));
                    },
                    Self::Noise { .. } => param_rows! {
                        /// Where the noise is least.
                        ["first"] $type = $first, $spec.labeled(concat!($slot, " of valleys"));
                        /// Where the noise is greatest.
                        ["second"] $type = $second, $spec.labeled(concat!($slot, " of hills"));
                        /// Hills per tile in the first layer.
                        ["scale"] f64 = 4.0, TEXTURE_SCALE.labeled(concat!($slot, " scale"));
                        /// Number of layers, each of twice as many hills and half as high.
                        ["layers"] u32 = 5, OCTAVES.labeled(concat!($slot, " layers"));
                        /// Another seed gives another pattern.
                        ["seed"] u32 = 0, SEED.labeled(concat!($slot, " seed"));
                    },
                    Self::Checker { .. } => param_rows! {
                        /// Every second square.
                        ["first"] $type = $first, $spec.labeled(concat!($slot, " of squares"));
                        /// The squares between.
                        ["second"] $type = $second, $spec.labeled(concat!($slot, " of others"));
                        /// Pairs of squares per tile.
                        ["scale"] f64 = 4.0, TEXTURE_SCALE.labeled(concat!($slot, " scale"));
                    },
                    Self::Bricks { .. } => param_rows! {
                        /// The bricks.
                        ["first"] $type = $first, $spec.labeled(concat!($slot, " of bricks"));
                        /// The mortar.
                        ["second"] $type = $second, $spec.labeled(concat!($slot, " of mortar"));
                        /// Bricks per tile.
                        ["scale"] f64 = 4.0, TEXTURE_SCALE.labeled(concat!($slot, " scale"));
                        /// Height of a row, in lengths of a brick.
                        ["row"] f64 = 0.4, PATTERN_SHARE.labeled(concat!($slot, " row height"));
                        /// Width of the joints, in lengths of a brick.
                        ["joint"] f64 = 0.05, UNIT.labeled(concat!($slot, " joint"));
                    },
                    Self::Wood { .. } => param_rows! {
                        /// Between the rings.
                        ["first"] $type = $first, $spec.labeled(concat!($slot, " of wood"));
                        /// The rings.
                        ["second"] $type = $second, $spec.labeled(concat!($slot, " of rings"));
                        /// Rings per tile.
                        ["scale"] f64 = 8.0, TEXTURE_SCALE.labeled(concat!($slot, " scale"));
                        /// How far the rings are out of round, in rings.
                        ["turbulence"] f64 = 0.5, TURBULENCE.labeled(concat!($slot, " turbulence"));
                    },
                    Self::Marble { .. } => param_rows! {
                        /// The stone.
                        ["first"] $type = $first, $spec.labeled(concat!($slot, " of stone"));
                        /// The veins.
                        ["second"] $type = $second, $spec.labeled(concat!($slot, " of veins"));
                        /// Veins per tile.
                        ["scale"] f64 = 3.0, TEXTURE_SCALE.labeled(concat!($slot, " scale"));
                        /// How far the veins wander, in veins.
                        ["turbulence"] f64 = 1.0, TURBULENCE.labeled(concat!($slot, " turbulence"));
                        /// Another seed gives another pattern.
                        ["seed"] u32 = 0, SEED.labeled(concat!($slot, " seed"));
                    },
                }
            }
        }

        impl Variants for $name {
            fn variants() -> Vec<(Self, &'static str, &'static str)> {
                let (first, second) = ($first, $second);
                let (image, color_space, wrap) = (Attachment::NONE, ColorSpace::$space, TextureWrap::Repeat);
                vec![
                    (Self::None {}, "None", "The material's own value."),
                    (Self::Image { image, color_space, wrap, scale: 1.0 }, "Image", "An image, projected along the axes."),
                    (Self::Noise { first, second, scale: 4.0, layers: 5, seed: 0 }, "Noise", "Layers of noise."),
                    (Self::Checker { first, second, scale: 4.0 }, "Checker", "Squares in turn."),
                    (Self::Bricks { first, second, scale: 4.0, row: 0.4, joint: 0.05 }, "Bricks", "Bricks in mortar."),
                    (Self::Wood { first, second, scale: 8.0, turbulence: 0.5 }, "Wood", "Rings of a tree around Z."),
                    (Self::Marble { first, second, scale: 3.0, turbulence: 1.0, seed: 0 }, "Marble", "Veins across X."),
                ]
            }

            fn variant(&self) -> usize {
                match self {
                    Self::None {} => 0,
                    Self::Image { .. } => 1,
                    Self::Noise { .. } => 2,
                    Self::Checker { .. } => 3,
                    Self::Bricks { .. } => 4,
                    Self::Wood { .. } => 5,
                    Self::Marble { .. } => 6,
                }
            }
        }
    };
}

texture! {
    /// The texture of the base color.
    ColorTexture, "Color", "What gives the base color.";
    [f64; 3], UNIT.color(), Srgb, [0.8; 3], [0.05; 3]
}
texture! {
    /// The texture of the roughness.
    RoughnessTexture, "Roughness", "What gives the roughness.";
    f64, UNIT, Linear, 0.2, 0.7
}
texture! {
    /// The texture of the opacity.
    OpacityTexture, "Opacity", "What gives the opacity: 1 is there, 0 is a hole.";
    f64, UNIT, Linear, 1.0, 0.0
}
texture! {
    /// The texture of the height, which bends the light as if the surface were embossed.
    HeightTexture, "Height", "What embosses the surface: 1 is high, 0 is low.";
    f64, UNIT, Linear, 1.0, 0.0
}
