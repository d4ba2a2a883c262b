//! What a picture needs of the pass `shade`. Each combination has a source and pipelines of its own, built when a
//! picture first needs it, so that a scene pays for nothing that it does not use.

use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindingResource, ShaderStages, TextureFormat,
};

use crate::recipe::Pass;
use crate::resources::accumulation::SUM_FORMAT;
use crate::resources::layouts::{
    BRICKS_FORMAT, TEXELS_FORMAT, entry, layout, read_only_texture, read_storage, read_texture, uniform,
};
use crate::resources::texture_resources::TextureBindings;
use isolith_field::{FlatMaterial, FlatScene, GpuLight};
use isolith_scene::ViewTransform;
use isolith_wgsl::{Evaluator, OpSet, Options, SCENE_COPIES, ShaderError, assemble_with};

/// What a scene needs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct ShadeFeatures {
    /// The layers of OpenPBR: not every material is by Blinn and Phong.
    pub layers: bool,
    /// A material has textures.
    pub textures: bool,
    /// A model shows the materials of its file.
    pub looks: bool,
    /// Copies of instancers carry textures.
    pub carried: bool,
    /// A light has a size.
    pub area_lights: bool,
    /// The environment is not a gradient.
    pub image_lit: bool,
    /// Light is shadowed or occluded.
    pub shadowed: bool,
    /// There are copies of instancers.
    pub copies: bool,
    /// There are many lights, and tiles know those that may reach them.
    pub tiled: bool,
    /// Rays may pass surfaces, and so meet others from within.
    pub veiled: bool,
    /// Not every pixel has shares of its own.
    pub sparse: bool,
}

impl ShadeFeatures {
    /// What a scene with these materials of its meshes needs.
    pub fn new(flat: &FlatScene, lights: &[GpuLight], of_meshes: &[FlatMaterial], shadowed: bool) -> Self {
        let layers = flat.materials.iter().chain(of_meshes).any(|material| material.phong_weight < 1.0);
        Self {
            layers,
            textures: !flat.textures.sets.is_empty(),
            looks: !flat.textures.looks.is_empty(),
            carried: flat.textures.are_carried(),
            area_lights: lights.iter().any(GpuLight::has_size),
            image_lit: flat.environment_map.is_some(),
            shadowed,
            copies: !flat.instancers.is_empty(),
            tiled: false,
            veiled: flat.veiled().contains(&true),
            sparse: false,
        }
    }

    /// The source of the pass.
    ///
    /// # Errors
    /// A shader file is missing.
    pub fn source(self) -> Result<String, ShaderError> {
        let Self { layers, textures, looks, carried, area_lights, image_lit, shadowed, copies, tiled, veiled, sparse } =
            self;
        let options = Options { layers, area_lights, image_lit, shadowed, ..Options::default() };
        let used = [
            (textures, "TEXTURES"),
            (looks, "LOOKS"),
            (carried, SCENE_COPIES),
            (copies, "COPIES"),
            (tiled, "LIGHT_TILES"),
            (veiled, "VEILS"),
            (sparse, "SPARSE_SHARES"),
        ];
        let features: Vec<&str> = used.into_iter().filter_map(|(is_used, name)| is_used.then_some(name)).collect();
        assemble_with(Pass::Shade.file(), &Evaluator::Interpreter(OpSet::none()), options, &features)
    }
}

/// What the pass writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ShadeOutput {
    /// The picture of a single sample, encoded for the screen.
    Picture(ViewTransform),
    /// The sum of several samples.
    Sum,
}

impl ShadeOutput {
    /// The format of its target.
    pub fn format(self) -> TextureFormat {
        match self {
            Self::Picture(_) => TextureFormat::Rgba8Unorm,
            Self::Sum => SUM_FORMAT,
        }
    }

    /// The entry point.
    pub fn entry_point(self) -> &'static str {
        match self {
            Self::Picture(ViewTransform::None) => "shade_fragment",
            Self::Picture(ViewTransform::Agx) => "shade_agx_fragment",
            Self::Picture(ViewTransform::PbrNeutral) => "shade_neutral_fragment",
            Self::Sum => "shade_sample_fragment",
        }
    }
}

/// Places in group 3, whose resources depend on the features: `shaders/shade.wgsl` declares them.
const SUM: u32 = 0;
const TEXTURES: [u32; 3] = [1, 2, 3];
const CARRIED: [u32; 2] = [4, 5];
const COPIED: u32 = 6;
const BRICKS: u32 = 7;
const SHARES: [u32; 2] = [8, 9];
const TILES: u32 = 10;

/// The resources of group 3.
#[derive(Clone, Debug, Default)]
pub struct ShadeExtras<'a> {
    /// The sum of the samples so far, if the pass adds one.
    pub sum: Option<BindingResource<'a>>,
    /// The textures, if the scene has some.
    pub textures: Option<TextureBindings<'a>>,
    /// Settings and shares of shadows and occlusion, if there are some.
    pub shares: Option<[BindingResource<'a>; 2]>,
    /// Which copies the pixels show, if there are some.
    pub copied: Option<BindingResource<'a>>,
    /// The bricks of models, if they have looks.
    pub bricks: Option<BindingResource<'a>>,
    /// The instancers and their places, if copies carry textures.
    pub carried: Option<[BindingResource<'a>; 2]>,
    /// The lights of each tile, if there are many.
    pub tiles: Option<BindingResource<'a>>,
}

impl ShadeFeatures {
    /// The layout of group 3.
    pub fn extras_layout(self, device: &wgpu::Device, output: ShadeOutput) -> BindGroupLayout {
        let sum = (output == ShadeOutput::Sum).then(|| (SUM, read_texture(false)));
        let of_textures = [read_storage(), read_storage(), read_only_texture(TEXELS_FORMAT)];
        let textures = TEXTURES.into_iter().zip(of_textures).filter(|_| self.textures);
        let shares = SHARES.into_iter().zip([uniform(false), read_storage()]).filter(|_| self.shadowed);
        let copied = self.copies.then(|| (COPIED, read_storage()));
        let bricks = self.looks.then(|| (BRICKS, read_only_texture(BRICKS_FORMAT)));
        let carried = CARRIED.map(|at| (at, read_storage())).into_iter().filter(|_| self.carried);
        let tiles = self.tiled.then(|| (TILES, read_storage()));
        let all = sum.into_iter().chain(textures).chain(shares).chain(copied).chain(bricks).chain(carried).chain(tiles);
        let entries: Vec<_> = all.map(|(at, ty)| entry(at, ShaderStages::FRAGMENT, ty)).collect();
        layout(device, "shade extras", &entries)
    }
}

impl ShadeExtras<'_> {
    /// The bind group of these resources.
    pub fn bind(self, device: &wgpu::Device, layout: &BindGroupLayout) -> BindGroup {
        let sum = self.sum.map(|sum| (SUM, sum));
        let textures = self.textures.map(|TextureBindings { placed, sets, texels }| [placed, sets, texels]);
        let textures = textures.into_iter().flat_map(|resources| TEXTURES.into_iter().zip(resources));
        let shares = self.shares.into_iter().flat_map(|resources| SHARES.into_iter().zip(resources));
        let copied = self.copied.map(|copied| (COPIED, copied));
        let bricks = self.bricks.map(|bricks| (BRICKS, bricks));
        let carried = self.carried.into_iter().flat_map(|resources| CARRIED.into_iter().zip(resources));
        let tiles = self.tiles.map(|tiles| (TILES, tiles));
        let all = sum.into_iter().chain(textures).chain(shares).chain(copied).chain(bricks).chain(carried).chain(tiles);
        let entries: Vec<_> = all.map(|(binding, resource)| BindGroupEntry { binding, resource }).collect();
        device.create_bind_group(&BindGroupDescriptor { label: Some("shade extras"), layout, entries: &entries })
    }
}
