//! Input and output of the pass `shadow`. Only scenes with shadows or occlusion fill them.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};

use crate::frame::plan::MOST_SHADOW_PIXELS;
use crate::gpu::Gpu;
use crate::resources::buffers::SyncedBuffer;
use crate::resources::hierarchy::{HierarchyBuffers, SceneLimits};
use crate::resources::mesh_rays::MeshRayBuffer;
use crate::resources::uniforms::GpuComponent;
use glam::DVec3;
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
    /// Padding.
    pub padding: f32,
}

/// Shares in a word.
const BYTES: u64 = 4;
/// Words of the state of an unfinished pixel, of its shadows and again of its occlusion: `SHADOW_STATE` in `shaders/light/shadow_settings.wgsl`.
pub const SHADOW_STATE: usize = 12;

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
            padding: 0.0,
        }
    }

    /// Whether there are shadows, and occlusion.
    pub fn parts(&self) -> [bool; 2] {
        [self.lights > 0, self.cones > 0]
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
    /// Whether meshes cast shadows in this frame.
    pub has_meshes: bool,
    /// The settings.
    pub settings: SyncedBuffer,
    /// The shares of all lights and cones, for each pixel.
    pub shares: SyncedBuffer,
    /// State of unfinished pixels.
    pub states: SyncedBuffer,
    /// Their number.
    pub unfinished: SyncedBuffer,
}

impl ShadowBuffers {
    /// Empty buffers.
    pub fn new(device: &wgpu::Device) -> Self {
        Self {
            used: ShadowSettings::default(),
            hierarchy: HierarchyBuffers::new(device),
            meshes: None,
            has_meshes: false,
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
        let without_copies = (!flat.instancers.is_empty()).then(|| hierarchy_without_copies(flat));
        let hierarchy = without_copies.as_ref().unwrap_or_else(|| flat.hierarchy());
        let mut limits = SceneLimits::new(hierarchy, query.iterations);
        let had_meshes = std::mem::replace(&mut self.has_meshes, query.has_meshes);
        let mut meshes_are_new = had_meshes != self.has_meshes;
        if self.has_meshes {
            // Visits of meshes count as iterations, too.
            limits.max_evaluations = (limits.max_evaluations * 3 / 5).max(2);
            let held = self.meshes.get_or_insert_with(|| MeshRayBuffer::new(device));
            meshes_are_new |= held.set(gpu, flat, query.meshes, query.origin);
        }
        let changed = [
            meshes_are_new,
            self.used.is_on() != settings.is_on(),
            self.hierarchy.set(gpu, hierarchy, query.origin, &query.components, limits),
            self.settings.set(device, queue, bytemuck::bytes_of(&settings)),
            self.shares.reserve(device, pixels * settings.stride as usize * 4),
            self.states.reserve(device, pixels.min(MOST_SHADOW_PIXELS as usize) * 2 * SHADOW_STATE * 4),
        ];
        self.used = settings;
        changed.contains(&true)
    }

    /// Number of meshes that cast no shadows for want of room.
    pub fn left_out(&self) -> usize {
        let meshes = self.meshes.as_ref().filter(|_| self.has_meshes);
        meshes.map_or(0, |meshes| meshes.left_out().len())
    }

    /// Settings and shares as bindings, if there are some.
    pub fn bindings(&self) -> Option<[wgpu::BindingResource<'_>; 2]> {
        self.used.is_on().then(|| [self.settings.binding(), self.shares.binding()])
    }

    /// Uploads the number of the sample.
    pub fn set_sample(&mut self, gpu: &Gpu, sample: u32) {
        if self.used.is_on() {
            self.used.sample = sample;
            self.settings.set(&gpu.device, &gpu.queue, bytemuck::bytes_of(&self.used));
        }
    }

    /// No shadows in this frame. Returns whether bind groups must be rebuilt.
    pub fn switch_off(&mut self) -> bool {
        std::mem::take(&mut self.used).is_on()
    }
}

/// The hierarchy over the components that are no types of instancers: cones do not meet copies.
fn hierarchy_without_copies(flat: &FlatScene) -> Hierarchy {
    let bounds = |component: &Component| match component.instanced {
        None => component.world_bounds(),
        Some(_) => Aabb::EMPTY,
    };
    Hierarchy::build(&flat.components.iter().map(bounds).collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::*;

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
}
