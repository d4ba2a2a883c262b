//! Textures of materials: colors and values that vary over a surface.
//!
//! A material names one source for each property, and one mapping for all of them. Images, checkers and bricks are
//! projected along the three axes of the texture's space; noise, wood and marble fill that space.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::attachment::Attachment;
use super::limits::{BUMP, NO_LIMITS, POSITION, SHARPNESS, STRETCH, TEXTURE_SCALE, TILE, TURBULENCE, TURN};
use super::params::{Variants, choices, nested_variants, param_rows, param_variants};
use super::texture_image::TextureImage;
use super::texture_source::{
    ColorSpace, ColorTexture, HeightTexture, OpacityTexture, RoughnessTexture, TextureSource, TextureWrap,
};

/// The space that textures live in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum TextureSpace {
    /// That of the object: they move, turn and scale with it.
    Object,
    /// That of the object without its scale: they move and turn with it, and keep their size.
    FixedSize,
    /// The world: the object moves through them.
    World,
}

impl TextureSpace {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Object, Self::FixedSize, Self::World];

    /// Display name.
    pub fn label(self) -> &'static str {
        ["Object", "Fixed size", "World"][self as usize]
    }

    fn help(self) -> &'static str {
        [
            "Textures move, turn and scale with the object.",
            "Textures move and turn with the object, and keep their size.",
            "The object moves through its textures.",
        ][self as usize]
    }
}

choices!(TextureSpace);

/// The texture of the normal.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
pub enum NormalTexture {
    /// None: the surface's own normal.
    None {},
    /// A normal map: red to the right, green up, blue out of the surface.
    Image {
        /// The image; none shows the surface's own normal.
        image: Attachment<TextureImage>,
        /// How its numbers are meant.
        color_space: ColorSpace,
        /// How it goes on beyond its edges.
        wrap: TextureWrap,
        /// Images per tile.
        scale: f64,
        /// Factor on the slopes.
        strength: f64,
    },
}

param_variants! { NormalTexture by |texture| texture.table(); {
    NormalTexture::None {}
    NormalTexture::Image { image, color_space, wrap, scale, strength, }
} }
nested_variants!(NormalTexture, "Normal", "What bends the normal.");

impl Default for NormalTexture {
    fn default() -> Self {
        Self::None {}
    }
}

impl NormalTexture {
    fn is_none(&self) -> bool {
        matches!(self, Self::None {})
    }

    /// What it shows, and the factor on its slopes.
    pub fn source(&self) -> Option<(TextureSource<'_>, f64)> {
        let Self::Image { image, color_space, wrap, scale, strength } = self else { return None };
        image.content()?;
        Some((TextureSource::Image { image, color_space: *color_space, wrap: *wrap, scale: *scale }, *strength))
    }

    /// The table of its parameters.
    fn table(&self) -> &'static [super::Param] {
        match self {
            Self::None {} => &[],
            Self::Image { .. } => param_rows! {
                /// The normal map; the scene keeps a copy of the file.
                ["image"] Attachment<TextureImage> = Attachment::NONE, NO_LIMITS.labeled("Normal image");
                /// How its numbers are meant.
                ["color_space"] ColorSpace = ColorSpace::Linear, NO_LIMITS.labeled("Normal space");
                /// How it goes on beyond its edges.
                ["wrap"] TextureWrap = TextureWrap::Repeat, NO_LIMITS.labeled("Normal wrap");
                /// Images per tile.
                ["scale"] f64 = 1.0, TEXTURE_SCALE.labeled("Normal scale");
                /// Factor on the slopes.
                ["strength"] f64 = 1.0, TURBULENCE.labeled("Normal strength");
            },
        }
    }
}

impl Variants for NormalTexture {
    fn variants() -> Vec<(Self, &'static str, &'static str)> {
        let (image, color_space, wrap) = (Attachment::NONE, ColorSpace::Linear, TextureWrap::Repeat);
        vec![
            (Self::None {}, "None", "The surface's own normal."),
            (Self::Image { image, color_space, wrap, scale: 1.0, strength: 1.0 }, "Image", "A normal map, green up."),
        ]
    }

    fn variant(&self) -> usize {
        usize::from(!self.is_none())
    }
}

/// The textures of a material, and their mapping.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
#[allow(clippy::large_enum_variant, reason = "there are few materials, and each is held once")]
pub enum Textures {
    /// None.
    None {},
    /// Textures in a space with three axes.
    Triplanar {
        /// The base color.
        #[serde(default, skip_serializing_if = "ColorTexture::is_none")]
        color: ColorTexture,
        /// The roughness.
        #[serde(default, skip_serializing_if = "RoughnessTexture::is_none")]
        roughness: RoughnessTexture,
        /// The normal.
        #[serde(default, skip_serializing_if = "NormalTexture::is_none")]
        normal: NormalTexture,
        /// The height.
        #[serde(default, skip_serializing_if = "HeightTexture::is_none")]
        height: HeightTexture,
        /// The opacity.
        #[serde(default, skip_serializing_if = "OpacityTexture::is_none")]
        opacity: OpacityTexture,
        /// Height of the embossing, in meters.
        bump: f64,
        /// The space that they live in.
        space: TextureSpace,
        /// Width of a tile.
        size: f64,
        /// Factor on the width of a tile along each axis.
        stretch: [f64; 3],
        /// Position of a tile's middle.
        offset: [f64; 3],
        /// Rotation of the axes, in degrees about X, then Y, then Z.
        rotation: [f64; 3],
        /// The power of the normal that weights the three projections: more is sharper.
        sharpness: f64,
    },
}

param_variants! { Textures by |textures| textures.table(); {
    Textures::None {}
    Textures::Triplanar {
        color, roughness, normal, height, opacity, bump, space, size, stretch, offset, rotation, sharpness,
    }
} }
nested_variants!(Textures, "Textures", "Colors and values that vary over the surface.");

impl Default for Textures {
    fn default() -> Self {
        Self::None {}
    }
}

impl Textures {
    /// Whether there are none, and files say nothing about them.
    pub fn is_none(&self) -> bool {
        matches!(self, Self::None {})
    }

    /// Whether one of them gives the opacity.
    pub fn has_opacity(&self) -> bool {
        matches!(self, Self::Triplanar { opacity, .. } if opacity.source().is_some())
    }

    /// A mapping by default, still without textures.
    pub fn triplanar() -> Self {
        Self::Triplanar {
            color: ColorTexture::default(),
            roughness: RoughnessTexture::default(),
            normal: NormalTexture::default(),
            height: HeightTexture::default(),
            opacity: OpacityTexture::default(),
            bump: 0.02,
            space: TextureSpace::Object,
            size: 1.0,
            stretch: [1.0; 3],
            offset: [0.0; 3],
            rotation: [0.0; 3],
            sharpness: 4.0,
        }
    }

    /// The table of its parameters; the textures have their own.
    fn table(&self) -> &'static [super::Param] {
        match self {
            Self::None {} => &[],
            Self::Triplanar { .. } => param_rows! {
                /// Height of the embossing.
                ["bump"] f64 = 0.02, BUMP.labeled("Bump height");
                /// The space that textures live in.
                ["space"] TextureSpace = TextureSpace::Object, NO_LIMITS.labeled("Texture space");
                /// Width of a tile.
                ["size"] f64 = 1.0, TILE.labeled("Tile size");
                /// Factor on the width of a tile along each axis.
                ["stretch"] [f64; 3] = [1.0; 3], STRETCH.labeled("Tile stretch");
                /// Position of a tile's middle.
                ["offset"] [f64; 3] = [0.0; 3], POSITION.labeled("Texture offset");
                /// Rotation of the axes about X, then Y, then Z.
                ["rotation"] [f64; 3] = [0.0; 3], TURN.labeled("Texture rotation");
                /// The power of the normal that weights the three projections: more is sharper.
                ["sharpness"] f64 = 4.0, SHARPNESS;
            },
        }
    }
}

impl Variants for Textures {
    fn variants() -> Vec<(Self, &'static str, &'static str)> {
        vec![
            (Self::None {}, "None", "The material is the same everywhere."),
            (Self::triplanar(), "Triplanar", "Projected along the three axes of a space."),
        ]
    }

    fn variant(&self) -> usize {
        usize::from(!self.is_none())
    }
}
