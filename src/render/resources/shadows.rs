//! Input and output of the pass `shadow`. Only scenes with shadows or occlusion fill them.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};

use crate::frame::plan::MOST_SHADOW_PIXELS;
use crate::gpu::Gpu;
use crate::resources::buffers::SyncedBuffer;
use crate::resources::hierarchy::{COPIES_LINK, HierarchyBuffers, Obstacles, SceneLimits};
use crate::resources::mesh_rays::MeshRayBuffer;
use crate::resources::uniforms::GpuComponent;
use glam::DVec3;
use isolith_field::copies::{FlatInstancer, GpuInstancer};
use isolith_field::hierarchy::Hierarchy;
use isolith_field::light::occlusion::OCCLUSION_CONES;
use isolith_field::light::shadow::cone_fineness;
use isolith_field::{Component, FlatScene};
use isolith_geometry::Aabb;
use isolith_mesh::TriangleMesh;

/// Settings of shadows and occlusion; `shaders/light/shadow_settings.wgsl` is its counterpart.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct ShadowSettings {
    /// Lights with shadows: the first ones.
    pub lights: u32,
    /// Words of shares per pixel.
    pub stride: u32,
    /// Cones of occlusion.
    pub cones: u32,
    /// 0: cones alone. Else the number of the sample: where a cone proves nothing, one ray decides.
    pub sample: u32,
    /// Least step of a cone in radii.
    pub fineness: f32,
    /// See the scene's `Shadowing`.
    pub occlusion_radius: f32,
    /// See the scene's `Shadowing`.
    pub occlusion_strength: f32,
    /// Pixels from one with shares of lights to the next, along each axis: 1, or more while something moves.
    pub spacing: u32,
    /// The same for the cones of occlusion.
    pub cone_spacing: u32,
}

/// Pixels from one with shares of lights to the next while something moves. Occlusion varies less: its cones, and lights if
/// there are many, have twice as much.
const SPARSE_SPACING: u32 = 2;
/// Most lights with shadows that have it.
const FEW_LIGHTS: u32 = 4;
/// See [`ShadowSettings::parts`].
pub const SHADOW_PARTS: usize = 3;
/// Shares in a word.
const BYTES: u64 = 4;
/// Words of the state of an unfinished pixel, of its shadows and again of its occlusion; further ones in scenes with
/// instancers. `shaders/light/shadow_settings.wgsl` has the same numbers.
pub const SHADOW_WORDS: usize = 12;
/// See [`SHADOW_WORDS`].
pub const SHADOW_COPIES_WORDS: usize = 5;

impl ShadowSettings {
    /// The settings of a scene with `light_count` lights, for a picture of `pixels` pixels and buffers of at most
    /// `bytes` bytes. Lights whose shares do not fit cast no shadows.
    pub fn new(flat: &FlatScene, light_count: usize, pixels: u64, bytes: u64) -> Self {
        let shadowing = &flat.environment.shadowing;
        let cones = if shadowing.occlusion { OCCLUSION_CONES } else { 0 };
        let cone_words = cones.div_ceil(BYTES as u32);
        let most = (bytes / (4 * pixels.max(1))).saturating_sub(cone_words.into()) * BYTES;
        let lights = if shadowing.shadows { (light_count as u64).min(most) as u32 } else { 0 };
        Self {
            lights,
            stride: lights.div_ceil(BYTES as u32) + cone_words,
            cones,
            sample: 0,
            fineness: cone_fineness(shadowing.shadow_quality) as f32,
            occlusion_radius: shadowing.occlusion_radius as f32,
            occlusion_strength: shadowing.occlusion_strength as f32,
            spacing: 1,
            cone_spacing: 1,
        }
    }

    /// The same for a picture of something that moves: not every pixel has shares.
    pub fn sparse(self) -> Self {
        let spacing = if self.lights > FEW_LIGHTS { 2 * SPARSE_SPACING } else { SPARSE_SPACING };
        Self { spacing, cone_spacing: 2 * SPARSE_SPACING, ..self }
    }

    /// Whether some pixels have no shares of their own.
    pub fn is_sparse(&self) -> bool {
        self.spacing > 1
    }

    /// Pixels from one with shares to the next, of each of [`Self::parts`].
    pub fn spacings(&self) -> [u32; SHADOW_PARTS] {
        [self.spacing, self.cone_spacing, self.spacing]
    }

    /// Which parts run: shadows of lights, the cones of occlusion, and, instead of the first in samples with occlusion,
    /// shadows and rays to the environment.
    pub fn parts(&self) -> [bool; SHADOW_PARTS] {
        let has_rays = self.cones > 0 && self.sample > 0;
        [self.lights > 0 && !has_rays, self.cones > 0, has_rays]
    }

    /// Those that a picture and its samples use.
    pub fn parts_of_still(&self) -> [bool; SHADOW_PARTS] {
        [self.lights > 0, self.cones > 0, self.cones > 0]
    }

    /// Whether there is anything to do.
    pub fn is_on(&self) -> bool {
        self.stride > 0
    }
}

/// What a frame asks of the scene.
#[derive(Debug)]
pub struct SceneQuery<'a> {
    /// The components relative to the eye.
    pub components: Vec<GpuComponent>,
    /// The eye.
    pub origin: DVec3,
    /// Upper bound of the loop iterations of one evaluation of a component.
    pub iterations: u32,
    /// The meshes, parallel to those of the scene.
    pub meshes: &'a [Option<Arc<TriangleMesh>>],
    /// Whether meshes cast shadows.
    pub has_meshes: bool,
    /// The instancers, with the components of their types.
    pub instancers: Vec<GpuInstancer>,
}

/// The buffers.
#[derive(Debug)]
pub struct ShadowBuffers {
    /// What the frame uses.
    pub used: ShadowSettings,
    /// The scene, for queries.
    pub hierarchy: HierarchyBuffers,
    /// The meshes, once a scene had some.
    pub meshes: Option<MeshRayBuffer>,
    /// The instancers of the scene.
    pub instancers: SyncedBuffer,
    /// What casts shadows in this frame besides components.
    pub obstacles: Obstacles,
    /// The settings.
    pub settings: SyncedBuffer,
    /// The shares of all lights and cones, for each pixel.
    pub shares: SyncedBuffer,
    /// State of unfinished pixels.
    pub states: SyncedBuffer,
    /// Their number, and that of evaluations.
    pub unfinished: SyncedBuffer,
}

impl ShadowBuffers {
    /// Empty buffers.
    pub fn new(device: &wgpu::Device) -> Self {
        Self {
            used: ShadowSettings::default(),
            hierarchy: HierarchyBuffers::new(device),
            meshes: None,
            instancers: SyncedBuffer::storage(device, "instancers of queries"),
            obstacles: Obstacles::default(),
            settings: SyncedBuffer::uniform(device, "shadow settings"),
            shares: SyncedBuffer::read_back(device, "shadow shares"),
            states: SyncedBuffer::storage(device, "shadow states"),
            unfinished: SyncedBuffer::read_back(device, "unfinished shadows"),
        }
    }

    /// Uploads changed data and reserves room. Returns whether bind groups must be rebuilt.
    pub fn upload(
        &mut self,
        gpu: &Gpu,
        flat: &FlatScene,
        query: &SceneQuery<'_>,
        settings: ShadowSettings,
        size: [u32; 2],
    ) -> bool {
        let Gpu { device, queue, .. } = gpu;
        let pixels = size[0] as usize * size[1] as usize;
        let with_copies = (!flat.instancers.is_empty()).then(|| hierarchy_with_copies(flat));
        let hierarchy = with_copies.as_ref().unwrap_or_else(|| flat.hierarchy());
        let mut limits = SceneLimits::new(hierarchy, query.iterations);
        let obstacles = Obstacles { meshes: query.has_meshes, copies: with_copies.is_some() };
        let mut obstacles_are_new = std::mem::replace(&mut self.obstacles, obstacles) != obstacles;
        if obstacles.copies {
            obstacles_are_new |= self.instancers.set(device, queue, bytemuck::cast_slice(&query.instancers));
        }
        if obstacles.meshes {
            // Visits of meshes count as iterations, too.
            limits.max_evaluations = (limits.max_evaluations * 3 / 5).max(2);
            let held = self.meshes.get_or_insert_with(|| MeshRayBuffer::new(device));
            obstacles_are_new |= held.set(gpu, flat, query.meshes, query.origin);
        }
        let words = SHADOW_WORDS + if obstacles.copies { SHADOW_COPIES_WORDS } else { 0 };
        let changed = [
            obstacles_are_new,
            self.used.is_on() != settings.is_on(),
            self.hierarchy.set(gpu, hierarchy, query.origin, &query.components, limits),
            self.settings.set(device, queue, bytemuck::bytes_of(&settings)),
            self.shares.reserve(device, pixels * settings.stride as usize * 4),
            self.states.reserve(device, pixels.min(MOST_SHADOW_PIXELS as usize) * 2 * words * 4),
        ];
        self.used = settings;
        changed.contains(&true)
    }

    /// Number of meshes that cast no shadows for want of room.
    pub fn left_out(&self) -> usize {
        let meshes = self.meshes.as_ref().filter(|_| self.obstacles.meshes);
        meshes.map_or(0, |meshes| meshes.left_out().len())
    }

    /// Settings and shares as bindings, if there are some.
    pub fn bindings(&self) -> Option<[wgpu::BindingResource<'_>; 2]> {
        self.used.is_on().then(|| [self.settings.binding(), self.shares.binding()])
    }

    /// Uploads the number of the sample. Samples have shares for every pixel.
    pub fn set_sample(&mut self, gpu: &Gpu, sample: u32) {
        if self.used.is_on() {
            self.used = ShadowSettings { sample, spacing: 1, cone_spacing: 1, ..self.used };
            self.settings.set(&gpu.device, &gpu.queue, bytemuck::bytes_of(&self.used));
        }
    }

    /// No shadows in this frame. Returns whether bind groups must be rebuilt.
    pub fn switch_off(&mut self) -> bool {
        std::mem::take(&mut self.used).is_on()
    }
}

/// The hierarchy over the components that are no types of instancers, and over the instancers: each is one leaf, so that
/// a cone walks once past the copies of all types.
fn hierarchy_with_copies(flat: &FlatScene) -> Hierarchy {
    let bounds = |component: &Component| match component.instanced {
        None => component.world_bounds(),
        Some(_) => Aabb::EMPTY,
    };
    let of_copies = flat.instancers.iter().map(FlatInstancer::world_bounds);
    let mut tree = Hierarchy::build(&flat.components.iter().map(bounds).chain(of_copies).collect::<Vec<_>>());
    let first = flat.components.len() as u32;
    let link = |item: &mut u32| *item = item.checked_sub(first).map_or(*item, |at| COPIES_LINK | at);
    tree.nodes.iter_mut().filter(|node| node.is_leaf()).for_each(|node| link(&mut node.link));
    tree.unbounded.iter_mut().for_each(link);
    tree
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::rect::TILE;

    #[test]
    fn lights_whose_shares_do_not_fit_cast_no_shadows() {
        let mut flat = FlatScene::default();
        assert!(!ShadowSettings::new(&flat, 3, 100, 1 << 20).is_on());
        flat.environment.shadowing = isolith_scene::Shadowing::default();
        let all = ShadowSettings::new(&flat, 3, 100, 1 << 20);
        assert_eq!((all.lights, all.cones, all.stride), (3, OCCLUSION_CONES, 3));
        let few = ShadowSettings::new(&flat, 30, 100, 1600);
        assert_eq!((few.lights, few.stride), (8, 4));
    }

    #[test]
    fn only_what_moves_has_sparse_light() {
        let mut flat = FlatScene::default();
        flat.environment.shadowing = isolith_scene::Shadowing::default();
        let of = |lights| ShadowSettings::new(&flat, lights, 100, 1 << 20);
        assert!(!of(1).is_sparse() && of(1).spacings() == [1; SHADOW_PARTS]);
        assert!(of(1).sparse().is_sparse() && of(1).sparse().spacings() == [2, 4, 2]);
        assert_eq!(of(16).sparse().spacings(), [4; SHADOW_PARTS]);
        let sample = ShadowSettings { sample: 3, ..of(1) };
        assert_eq!((of(1).parts(), sample.parts()), ([true, true, false], [false, true, true]));
        // Pixels with shares are found by masks, and parts begin at tiles.
        assert!(of(16).sparse().spacings().iter().all(|side| side.is_power_of_two() && TILE.is_multiple_of(*side)));
    }
}
