//! Textures as renderers read them: what the textures of a material show, and the spaces in which objects use them.
//! `shaders/light/texture.wgsl` is the counterpart.
//!
//! A material with textures has one entry among the scene's materials for each object that uses it. So each material of
//! a mixture keeps its own space, and the texture of an operand stays on it while another one moves.

use std::collections::HashMap;
use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use glam::{DAffine3, DMat3, DQuat, DVec3, EulerRot};

use super::modifier_params::{RepeatParams, params_of};
use isolith_bricks::BrickLevels;
use isolith_scene::limits::MAX_TEXTURE_BYTES;
use isolith_scene::{
    ColorSpace, Material, MaterialId, PatternKind, Pyramid, TexelForm, TextureSource, TextureSpace, TextureWrap,
    Textures,
};

/// The textures that a scene uses; empty without any.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FlatTextures {
    /// The textures of the materials at the same places among the scene's materials. It may be shorter.
    pub placed: Vec<Option<PlacedTextures>>,
    /// The textures of each material that has some.
    pub sets: Vec<TextureSet>,
    /// The materials of the sets; `None` for those of a model's file.
    pub set_ids: Vec<Option<MaterialId>>,
    /// The models whose looks are shown.
    pub looks: Vec<Arc<BrickLevels>>,
    /// The images.
    pub images: Vec<FlatImage>,
}

/// The textures of a material on one object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacedTextures {
    /// From the world to tiles.
    pub texture_from_world: DAffine3,
    /// Height of the embossing, in meters of the world.
    pub bump: f64,
    /// Index of its set.
    pub set: u32,
    /// The array that repeats it, if any.
    pub repeated: Option<RepeatedSpace>,
    /// The instancer whose copies show it. The world is then the space of a copy.
    pub instancer: Option<u32>,
}

/// Where an object uses textures.
#[derive(Clone, Copy, Debug)]
pub(super) struct TextureUse {
    /// The space of the object.
    pub object_from_world: DAffine3,
    /// See [`PlacedTextures::repeated`].
    pub repeated: Option<RepeatedSpace>,
    /// See [`PlacedTextures::instancer`].
    pub instancer: Option<u32>,
}

/// The cells of an array, whose copies each show the same part of a texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RepeatedSpace {
    /// From the world to cells: whole numbers are the middles of copies.
    cells_from_world: DAffine3,
    /// The way in the world from one copy to the next, for each axis of the array.
    steps: DMat3,
    /// Shift along X, in cells, from one copy along Y to the next.
    skew: f64,
    /// First and last copies.
    first: DVec3,
    last: DVec3,
}

impl RepeatedSpace {
    /// The cells of an array by its rows. `None` for arrays that turn or mirror their
    /// copies: these show the texture as a whole.
    pub(super) fn new(rows: &[[f64; 4]], space_from_world: &DAffine3) -> Option<Self> {
        let params: RepeatParams = params_of(rows);
        if params.turn != 0.0 || params.mirrored != 0 {
            return None;
        }
        let [spacing, first, last, middle, offset] =
            [params.spacing, params.first, params.last, params.middle, params.offset].map(DVec3::from);
        let cells = DAffine3::from_scale(spacing.recip()) * DAffine3::from_translation(-middle);
        let steps = DMat3::from_cols(
            DVec3::new(spacing.x, offset.y, offset.z),
            DVec3::new(offset.x, spacing.y, 0.0),
            DVec3::new(0.0, 0.0, spacing.z),
        );
        Some(Self {
            cells_from_world: cells * *space_from_world,
            steps: space_from_world.matrix3.inverse() * steps,
            skew: offset.x / spacing.x,
            first,
            last,
        })
    }

    /// The copy at a point of the world, beyond the first and last too.
    fn cell(&self, at: DVec3) -> DVec3 {
        let at = self.cells_from_world.transform_point3(at).round();
        DVec3::new((at.x - self.skew * at.y).round(), at.y, at.z)
    }
}

/// An image on the device.
#[derive(Clone, Debug)]
pub struct FlatImage {
    /// Its levels.
    pub pyramid: Arc<Pyramid>,
    /// Number of its finest levels that are left out to stay within [`MAX_TEXTURE_BYTES`].
    pub skipped: usize,
    /// The set that uses it first.
    pub set: u32,
    /// Its file's name.
    pub name: String,
}

impl PartialEq for FlatImage {
    fn eq(&self, other: &Self) -> bool {
        let is_same = Arc::ptr_eq(&self.pyramid, &other.pyramid) || self.pyramid == other.pyramid;
        is_same && self.skipped == other.skipped && self.set == other.set
    }
}

/// A texture as the GPU reads it.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct FlatTexture {
    /// First color of a pattern.
    pub first: [f32; 3],
    /// What it is: 0 for none, see the constants.
    pub kind: u32,
    /// Second color of a pattern.
    pub second: [f32; 3],
    /// Index of the image.
    pub image: u32,
    /// Images or patterns per tile.
    pub scale: f32,
    /// See [`PatternKind`].
    pub a: f32,
    /// See [`PatternKind`].
    pub b: f32,
    /// How an image goes on beyond its edges: 0 repeats, 1 mirrors, 2 clamps.
    pub wrap: u32,
}

impl FlatTexture {
    /// An image.
    pub const IMAGE: u32 = 1;
    /// Squares.
    pub const CHECKER: u32 = 2;
    /// Bricks.
    pub const BRICKS: u32 = 3;
    /// Noise; this and what follows fill the space instead of being projected.
    pub const NOISE: u32 = 4;
    /// Wood.
    pub const WOOD: u32 = 5;
    /// Marble.
    pub const MARBLE: u32 = 6;
    /// The looks of a model: `image` is the first texel of their header, `wrap` the first of the model, `a` its index
    /// among those of [`FlatTextures::looks`]. It stands in place of all textures of the material.
    pub const LOOKS: u32 = 7;
}

/// Textures of a material.
const TEXTURES: usize = 5;
/// The place of the opacity among them.
pub const OPACITY_SLOT: usize = 4;

/// The textures of a material as the GPU reads them.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct TextureSet {
    /// Base color, roughness, normal, height, opacity.
    pub slots: [FlatTexture; TEXTURES],
    /// Factor on the base color.
    pub base_weight: f32,
    /// The power of the normal that weights the projections.
    pub sharpness: f32,
    /// Factor on the slopes of the normal map.
    pub strength: f32,
    /// Padding of four bytes.
    pub _padding: u32,
}

/// The place of an entry's textures as the GPU reads it, relative to the eye.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct GpuPlacedTextures {
    /// From positions relative to the eye to tiles, by rows.
    pub rows: [[f32; 4]; 3],
    /// Index of its set, or [`Self::NONE`].
    pub textures: u32,
    /// Height of the embossing, in meters of the world.
    pub bump: f32,
    /// 1 + the index of the instancer whose copies show it; 0 for none.
    pub copied_by: u32,
    /// Padding of four bytes.
    pub _padding: u32,
    /// From positions relative to the eye to cells of an array, counted from that of the eye, by rows.
    pub cells: [[f32; 4]; 3],
    /// First cell.
    pub first: [f32; 3],
    /// Shift along X, in cells, from one copy along Y to the next.
    pub skew: f32,
    /// Last cell.
    pub last: [f32; 3],
    /// 1 if an array repeats the textures.
    pub repeated: u32,
    /// The way from one copy to the next, in tiles, for each axis of the array.
    pub steps: [[f32; 4]; 3],
}

/// After this many tiles textures start again: the place of the eye among them is that of a number near 0, which f32
/// holds to 1/65 536 of a tile.
pub const TILES: f64 = 256.0;

impl GpuPlacedTextures {
    /// The set of an entry without textures.
    pub const NONE: u32 = u32::MAX;

    /// The textures as seen from `eye`; those of copies from the origin of their space.
    pub fn new(placed: &PlacedTextures, eye: DVec3) -> Self {
        let eye = if placed.instancer.is_some() { DVec3::ZERO } else { eye };
        let matrix = placed.texture_from_world.matrix3;
        let mut at = placed.texture_from_world.transform_point3(eye);
        let mut own = Self::none();
        if let Some(repeated) = &placed.repeated {
            let cell = repeated.cell(eye);
            let steps = matrix * repeated.steps;
            at -= steps * cell;
            let linear = repeated.cells_from_world.matrix3;
            let mut from = repeated.cells_from_world.transform_point3(eye) - cell;
            from.x -= repeated.skew * cell.y;
            own.cells = [0, 1, 2].map(|i| linear.row(i).extend(from[i]).as_vec4().to_array());
            own.first = (repeated.first - cell).as_vec3().to_array();
            own.last = (repeated.last - cell).as_vec3().to_array();
            own.steps = [0, 1, 2].map(|i| steps.col(i).extend(0.0).as_vec4().to_array());
            (own.skew, own.repeated) = (repeated.skew as f32, 1);
        }
        let at = at - TILES * (at / TILES).round();
        let rows = [0, 1, 2].map(|i| matrix.row(i).extend(at[i]).as_vec4().to_array());
        let copied_by = placed.instancer.map_or(0, |index| index + 1);
        Self { rows, textures: placed.set, bump: placed.bump as f32, copied_by, ..own }
    }

    /// An entry without textures.
    pub fn none() -> Self {
        Self { textures: Self::NONE, ..Self::zeroed() }
    }
}

impl FlatTextures {
    /// Places the textures of the material at `at` of the scene's materials.
    pub(super) fn place(&mut self, material: &Material, at: usize, space: TextureUse) {
        let Some(set) = self.set(material) else { return };
        self.placed.resize(at, None);
        self.placed.push(placed(material, set as u32, space));
    }

    /// Places the looks of a model there, whose first texel is `first`.
    pub(super) fn place_looks(&mut self, model: &Arc<BrickLevels>, first: u32, at: usize, space: TextureUse) {
        let header = first + model.first_look() as u32;
        let is_known = |set: &TextureSet| set.slots[0].kind == FlatTexture::LOOKS && set.slots[0].image == header;
        let set = self.sets.iter().position(is_known).unwrap_or_else(|| {
            let index = self.looks.len() as f32;
            let looks = FlatTexture {
                kind: FlatTexture::LOOKS,
                image: header,
                wrap: first,
                a: index,
                ..FlatTexture::default()
            };
            let none = FlatTexture::default();
            self.sets.push(TextureSet { slots: [looks, none, none, none, none], ..TextureSet::zeroed() });
            self.set_ids.push(None);
            self.looks.push(model.clone());
            self.sets.len() - 1
        });
        self.placed.resize(at, None);
        self.placed.push(Some(placed_looks(model, set as u32, space)));
    }

    /// Whether copies of instancers carry some.
    pub fn are_carried(&self) -> bool {
        self.placed.iter().flatten().any(|placed| placed.instancer.is_some())
    }

    /// Whether the material at `at` shows the looks of a model.
    pub(super) fn has_looks(&self, at: usize) -> bool {
        let placed = self.placed.get(at).copied().flatten();
        placed.is_some_and(|placed| self.sets[placed.set as usize].slots[0].kind == FlatTexture::LOOKS)
    }

    /// Moves the textures at `at` to another place of their object, or the looks of a model.
    pub(super) fn replace(
        &mut self,
        material: &Material,
        looks: Option<&Arc<BrickLevels>>,
        at: usize,
        space: TextureUse,
    ) {
        if let Some(entry) = self.placed.get_mut(at)
            && let Some(PlacedTextures { set, instancer, .. }) = *entry
        {
            let space = TextureUse { instancer, ..space };
            *entry = match looks {
                Some(model) => Some(placed_looks(model, set, space)),
                None => placed(material, set, space),
            };
        }
    }

    /// The index of a material's textures, if it has some.
    fn set(&mut self, material: &Material) -> Option<usize> {
        if let Some(known) = self.set_ids.iter().rposition(|id| *id == Some(material.id)) {
            return Some(known);
        }
        let Textures::Triplanar { color, roughness, normal, height, opacity, sharpness, .. } = &material.textures
        else {
            return None;
        };
        let normal = normal.source();
        let (slope, strength) = (normal.map(|(source, _)| source), normal.map_or(1.0, |(_, strength)| strength));
        let sources = [color.source(), roughness.source(), slope, height.source(), opacity.source()];
        if sources.iter().all(Option::is_none) {
            return None;
        }
        let forms = [TexelForm::Color, TexelForm::Value, TexelForm::Vector, TexelForm::Value, TexelForm::Value];
        let mut slots = [FlatTexture::default(); TEXTURES];
        for ((slot, source), form) in slots.iter_mut().zip(sources).zip(forms) {
            *slot = source.map_or_else(FlatTexture::default, |source| self.texture(source, form));
        }
        self.sets.push(TextureSet {
            slots,
            base_weight: material.base_weight as f32,
            sharpness: *sharpness as f32,
            strength: strength as f32,
            _padding: 0,
        });
        self.set_ids.push(Some(material.id));
        Some(self.sets.len() - 1)
    }

    fn texture(&mut self, source: TextureSource<'_>, form: TexelForm) -> FlatTexture {
        match source {
            TextureSource::Image { image, color_space, wrap, scale } => {
                let pyramid = image.content().map(|image| image.pyramid(color_space == ColorSpace::Srgb, form));
                let name = image.name().unwrap_or_default();
                FlatTexture {
                    kind: FlatTexture::IMAGE,
                    image: pyramid.map_or(0, |pyramid| self.image(pyramid, name)) as u32,
                    scale: scale as f32,
                    wrap: match wrap {
                        TextureWrap::Repeat => 0,
                        TextureWrap::Mirror => 1,
                        TextureWrap::Clamp => 2,
                    },
                    ..FlatTexture::default()
                }
            }
            TextureSource::Pattern { kind, first, second, scale, numbers: [a, b] } => FlatTexture {
                first: first.map(|v| v as f32),
                second: second.map(|v| v as f32),
                kind: match kind {
                    PatternKind::Noise => FlatTexture::NOISE,
                    PatternKind::Checker => FlatTexture::CHECKER,
                    PatternKind::Bricks => FlatTexture::BRICKS,
                    PatternKind::Wood => FlatTexture::WOOD,
                    PatternKind::Marble => FlatTexture::MARBLE,
                },
                scale: scale as f32,
                a: a as f32,
                b: b as f32,
                ..FlatTexture::default()
            },
        }
    }

    fn image(&mut self, pyramid: Arc<Pyramid>, name: &str) -> usize {
        let known = self.images.iter().position(|image| Arc::ptr_eq(&image.pyramid, &pyramid));
        known.unwrap_or_else(|| {
            let set = self.sets.len() as u32;
            self.images.push(FlatImage { pyramid, skipped: 0, set, name: name.to_owned() });
            self.images.len() - 1
        })
    }

    /// Bytes of all images on the device.
    pub fn image_bytes(&self) -> usize {
        self.images.iter().map(FlatImage::bytes).sum()
    }

    /// Leaves out the finest levels of the largest images until all fit into `most` bytes. Returns the images that are
    /// smaller now.
    pub(super) fn fit(&mut self, most: usize) -> Vec<&FlatImage> {
        let mut bytes = self.image_bytes();
        while bytes > most {
            let largest = self.images.iter_mut().max_by_key(|image| image.bytes());
            let Some(image) = largest.filter(|image| image.skipped + 1 < image.pyramid.levels.len()) else { break };
            bytes -= image.bytes();
            image.skipped += 1;
            bytes += image.bytes();
        }
        self.images.iter().filter(|image| image.skipped > 0).collect()
    }
}

impl FlatImage {
    /// Bytes on the device.
    fn bytes(&self) -> usize {
        let texels: usize = self.pyramid.levels[self.skipped..].iter().map(|level| level.texels.len()).sum();
        (texels + IMAGE_HEADER) * size_of::<u32>()
    }

    /// How much smaller it is than its file.
    pub fn reduction(&self) -> u32 {
        1 << self.skipped
    }
}

/// Words of an image's header: width, height, number of levels, form, and where its levels begin.
pub(super) const IMAGE_HEADER: usize = 20;
/// Most levels of an image.
const MOST_LEVELS: usize = IMAGE_HEADER - 4;
const _: () = assert!(isolith_scene::limits::MAX_IMAGE_SIDE < 1 << MOST_LEVELS);
const _: () = assert!(MAX_TEXTURE_BYTES < 1 << 32);

/// The looks of a model on an object.
fn placed_looks(model: &BrickLevels, set: u32, space: TextureUse) -> PlacedTextures {
    let TextureUse { object_from_world, repeated, instancer } = space;
    let (center, unit) = model.look_space();
    let looks = DAffine3::from_scale(DVec3::splat(unit.recip())) * DAffine3::from_translation(-center);
    PlacedTextures { texture_from_world: looks * object_from_world, bump: 0.0, set, repeated, instancer }
}

/// The textures of a material on an object.
fn placed(material: &Material, set: u32, space_of_use: TextureUse) -> Option<PlacedTextures> {
    let TextureUse { object_from_world, repeated, instancer } = space_of_use;
    let object_from_world = &object_from_world;
    let Textures::Triplanar { bump, space, size, stretch, offset, rotation, .. } = &material.textures else {
        return None;
    };
    let object = match space {
        TextureSpace::Object => *object_from_world,
        TextureSpace::FixedSize => without_scale(object_from_world),
        TextureSpace::World => DAffine3::IDENTITY,
    };
    let scale = object.matrix3.determinant().abs().cbrt();
    let [x, y, z] = rotation.map(f64::to_radians);
    // About X, then Y, then Z.
    let turn = DQuat::from_euler(EulerRot::ZYX, z, y, x).inverse();
    let tile = DVec3::from(*stretch) * *size;
    let tiles = DAffine3::from_scale(tile.recip()) * DAffine3::from_quat(turn);
    let texture_from_world = tiles * DAffine3::from_translation(-DVec3::from(*offset)) * object;
    let repeated = repeated.filter(|_| *space != TextureSpace::World);
    // Textures of the world stay where they are while copies pass.
    let instancer = instancer.filter(|_| *space != TextureSpace::World);
    Some(PlacedTextures { texture_from_world, bump: bump / scale, set, repeated, instancer })
}

/// The same space in meters of the world.
fn without_scale(object_from_world: &DAffine3) -> DAffine3 {
    let DAffine3 { matrix3, translation } = object_from_world;
    let rows = [0, 1, 2].map(|i| matrix3.row(i));
    let meters = DVec3::from(rows.map(|row| row.length().recip()));
    let matrix3 = DMat3::from_cols(rows[0] * meters.x, rows[1] * meters.y, rows[2] * meters.z).transpose();
    DAffine3 { matrix3, translation: *translation * meters }
}

/// The materials with textures, for flattening.
#[derive(Debug, Default)]
pub(super) struct TexturedMaterials<'a>(HashMap<MaterialId, &'a Material>);

impl<'a> TexturedMaterials<'a> {
    pub fn new(materials: &'a [Arc<Material>]) -> Self {
        let textured = materials.iter().filter(|material| !material.textures.is_none());
        Self(textured.map(|material| (material.id, &**material)).collect())
    }

    /// The material, if it has textures.
    pub fn get(&self, id: MaterialId) -> Option<&'a Material> {
        self.0.get(&id).copied()
    }

    /// Whether each object that uses the material needs an entry of its own.
    pub fn is_placed(&self, id: MaterialId) -> bool {
        let space = |material: &Material| match material.textures {
            Textures::Triplanar { space, .. } => Some(space),
            Textures::None {} => None,
        };
        self.get(id).and_then(space).is_some_and(|space| space != TextureSpace::World)
    }
}
