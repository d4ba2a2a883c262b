//! The resources of a frame besides the scene: the view, its dispatches, the buffers between passes, and the targets of
//! its slot.

use bytemuck::Zeroable as _;
use glam::DVec2;
use wgpu::BindGroup;

use super::frame::Frame;
use super::mesh_materials::MeshMaterials;
use super::pixel_counts::MarchCounts;
use super::scene::SceneResources;
use super::scene::ShadedScene;
use super::slot::Slot;
use crate::frame::light_tiles::bytes_of_light_tiles;
use crate::frame::plan::{Dispatch, FramePlan, Room};
use crate::frame::rect::TILE;
use crate::gpu::Gpu;
use crate::passes::overlay_settings::OverlaySettings;
use crate::pipelines::cache::veil_of;
use crate::pipelines::field_buffers::FieldBuffers;
use crate::recipe::Pass;
use crate::resources::accumulation::Accumulation;
use crate::resources::buffers::SyncedBuffer;
use crate::resources::layouts::{Layouts, bind, window};
use crate::resources::shadows::ShadowBuffers;
use crate::resources::targets::{Target, Targets};
use crate::resources::texture_resources::{TextureBindings, TextureResources};
use crate::resources::uniforms::{DispatchParams, GpuView, UNIFORM_STRIDE, strided};
use isolith_field::light::environment_map::{PlacedMap, map_words};
use isolith_field::{FlatScene, GpuLight};
use isolith_geometry::Camera;
use isolith_wgsl::Veil;

/// Bytes of a subtile in a list.
const SUBTILE_BYTES: usize = 12;
/// Bytes of the lists for `subtiles` subtiles: those that the cones keep, and again those with hits.
pub fn bytes_of_subtiles(subtiles: u64) -> u64 {
    2 * subtiles * SUBTILE_BYTES as u64
}

impl Room {
    /// The capacity of a device for one frame, and the bytes of lists that it can bind.
    pub fn of(limits: &wgpu::Limits) -> (Self, u64) {
        // Buffers grow by powers of two.
        let whole = |bytes: u64| bytes.checked_ilog2().map_or(0, |bits| 1_u64 << bits);
        let bound = whole(limits.max_buffer_size.min(limits.max_storage_buffer_binding_size));
        let dispatches = whole(limits.max_buffer_size) as usize / UNIFORM_STRIDE;
        (Self { dispatches, subtiles: bound / bytes_of_subtiles(1) }, bound)
    }
}

/// Words of the counts of a subtile list, and of its list of unfinished rays: see `shaders/common/subtiles.wgsl`.
pub const SUBTILE_COUNTS: usize = 5;
pub const RAY_COUNTS: usize = 7;
/// Initial counts of a subtile list, and of its list of unfinished rays.
const NO_SUBTILES: [u32; SUBTILE_COUNTS] = [0, 1, 1, 0, 0];
const NO_RAYS: [u32; RAY_COUNTS] = [0, 1, 1, 0, 1, 1, 0];

/// The resources that passes bind.
#[derive(Clone, Debug)]
pub struct Bound<'a> {
    /// The textures of the picture.
    pub targets: &'a Targets,
    /// The buffers of the frame.
    pub resources: &'a FrameResources,
    /// The materials of the scene.
    pub materials: wgpu::BindingResource<'a>,
    /// The places of all instancers.
    pub places: wgpu::BindingResource<'a>,
}

/// Bind groups for the targets of a slot.
#[derive(Debug)]
pub struct Groups {
    pub view: BindGroup,
    pub scene: BindGroup,
    /// Like `scene`, with the rows of templates.
    pub templates: BindGroup,
    /// What pass `shade` reads of the scene.
    pub shaded: ShadedScene,
    /// The same two for types of instancers, if there are any.
    pub copies: Option<[BindGroup; 2]>,
    pub dispatch_params: BindGroup,
    /// Own bind groups of each pass, in the order of the frame.
    pub own: Vec<Vec<BindGroup>>,
}

/// Targets of a picture with their bind groups. The renderer rebuilds them when the picture's size changes, or when a
/// buffer or pipeline is replaced.
#[derive(Debug)]
pub struct SlotState {
    pub targets: Targets,
    /// Target of the enlarged picture, if marks are drawn over a picture that is too coarse for them.
    pub enlarged: Option<Target>,
    /// Textures of accumulated samples, once there are any.
    pub accumulation: Option<Accumulation>,
    pub groups: Option<Groups>,
}

impl SlotState {
    /// The target on display.
    pub fn shown(&self) -> &Target {
        self.enlarged.as_ref().unwrap_or(&self.targets.color)
    }
}

/// Resources of a frame, see the module.
#[derive(Debug)]
pub struct FrameResources {
    layouts: Layouts,
    view: SyncedBuffer,
    /// The contents of `view` for the first sample.
    first_view: GpuView,
    lights: SyncedBuffer,
    /// The lights of each tile, and whether the frame has them.
    light_tiles: (SyncedBuffer, bool),
    environment_map: SyncedBuffer,
    /// The environment in that buffer.
    held_map: Option<Option<PlacedMap>>,
    mesh_materials: SyncedBuffer,
    textures: TextureResources,
    /// What rays may pass of the scene.
    veil: Veil,
    dispatch_params: SyncedBuffer,
    subtiles: SyncedBuffer,
    pub subtile_counts: SyncedBuffer,
    rays: SyncedBuffer,
    pub ray_counts: SyncedBuffer,
    nothing: SyncedBuffer,
    pub counts: MarchCounts,
    pub shadows: ShadowBuffers,
    slots: [Option<SlotState>; 2],
}

impl FrameResources {
    /// Empty resources. `counting`: whether the pipelines count.
    pub fn new(device: &wgpu::Device, layouts: Layouts, counting: bool) -> Self {
        let storage = |label| SyncedBuffer::storage(device, label);
        Self {
            layouts,
            view: SyncedBuffer::uniform(device, "view"),
            first_view: GpuView::zeroed(),
            lights: storage("lights"),
            light_tiles: (storage("tiles of lights"), false),
            environment_map: storage("environment map"),
            held_map: None,
            mesh_materials: storage("mesh materials"),
            textures: TextureResources::default(),
            veil: Veil::None,
            dispatch_params: SyncedBuffer::uniform(device, "dispatch_params"),
            subtiles: storage("subtiles"),
            subtile_counts: SyncedBuffer::indirect(device, "subtile counts"),
            rays: storage("rays"),
            nothing: storage("nothing"),
            ray_counts: SyncedBuffer::indirect(device, "ray counts"),
            counts: MarchCounts::new(device, counting),
            shadows: ShadowBuffers::new(device),
            slots: [None, None],
        }
    }

    /// A slot in which a frame has begun.
    pub fn slot(&self, slot: Slot) -> &SlotState {
        self.begun(slot).expect("begin makes the targets")
    }

    /// A slot, if a frame has begun in it.
    pub fn begun(&self, slot: Slot) -> Option<&SlotState> {
        self.slots[slot as usize].as_ref()
    }

    /// The bind groups of any slot that has them.
    pub fn any_groups(&self) -> Option<&Groups> {
        self.slots.iter().flatten().find_map(|state| state.groups.as_ref())
    }

    /// Gives the slot targets of this size, and a target for the enlarged picture if the overlay needs one.
    /// With `copies` it also gets a buffer for those.
    pub fn resize(
        &mut self,
        device: &wgpu::Device,
        slot: Slot,
        size: [u32; 2],
        overlay: &OverlaySettings,
        copies: bool,
    ) {
        let state = &mut self.slots[slot as usize];
        if state.as_ref().is_none_or(|state| state.targets.size != size) {
            *state = Some(SlotState {
                targets: Targets::new(device, size),
                enlarged: None,
                accumulation: None,
                groups: None,
            });
        }
        if let Some(state) = state {
            if copies && state.targets.keep_copied(device) {
                state.groups = None;
            }
            let shown = overlay.enlarged(size);
            let kept = state.enlarged.take().filter(|target| shown == Some(target.size()));
            state.enlarged = kept.or_else(|| shown.map(|size| Target::shown(device, size)));
        }
    }

    /// Uploads changed data and reserves space for the plan. Returns whether a buffer was replaced.
    pub fn upload(
        &mut self,
        gpu: &Gpu,
        flat: &FlatScene,
        (lights, meshes): (&[GpuLight], &MeshMaterials),
        camera: &Camera,
        size: [u32; 2],
        plan: &FramePlan,
    ) -> bool {
        let Gpu { device, queue, .. } = gpu;
        self.first_view = GpuView::new(camera, size, flat, lights.len() as u32);
        let tiles = bytes_of_light_tiles(lights.len(), size, device.limits().max_storage_buffer_binding_size);
        let tiles_are_new = std::mem::replace(&mut self.light_tiles.1, tiles.is_some()) != tiles.is_some();
        let veil = veil_of(flat);
        let uploads = [
            tiles_are_new,
            std::mem::replace(&mut self.veil, veil) != veil,
            self.light_tiles.0.reserve(device, tiles.unwrap_or(0) as usize),
            self.upload_map(gpu, flat),
            self.view.set(device, queue, bytemuck::bytes_of(&self.first_view)),
            self.lights.set(device, queue, bytemuck::cast_slice(lights)),
            self.mesh_materials.set(device, queue, bytemuck::cast_slice(&meshes.all)),
            self.textures.upload(gpu, flat, camera),
            self.set_work(gpu, &plan.dispatches),
            self.subtiles.reserve(device, bytes_of_subtiles(plan.subtiles.into()) as usize),
            self.rays.reserve(device, (plan.lists + plan.longest * TILE * TILE) as usize * 4),
            self.reset_lists(gpu, plan, flat.components.len(), size),
        ];
        uploads.contains(&true)
    }

    /// Resets the lists and counts that the passes of a frame fill. Returns whether a buffer was replaced.
    pub fn reset_lists(&mut self, gpu: &Gpu, plan: &FramePlan, components: usize, size: [u32; 2]) -> bool {
        let Gpu { device, queue, .. } = gpu;
        let no_subtiles = vec![NO_SUBTILES; plan.lists as usize];
        let no_rays = vec![NO_RAYS; plan.lists as usize];
        let resets = [
            self.subtile_counts.reset(device, queue, bytemuck::cast_slice(&no_subtiles)),
            self.ray_counts.reset(device, queue, bytemuck::cast_slice(&no_rays)),
            self.counts.reset(gpu, components, size),
        ];
        resets.contains(&true)
    }

    /// Makes the frame show the first surfaces that have any opacity.
    pub fn show_first_surfaces(&mut self, gpu: &Gpu) {
        self.first_view.first_surfaces = 1;
        self.view.set(&gpu.device, &gpu.queue, bytemuck::bytes_of(&self.first_view));
    }

    /// Uploads the view of another sample of the frame.
    pub fn set_sample(&mut self, gpu: &Gpu, index: u32, is_transparent: bool, offset: DVec2) {
        let view = self.first_view.of_sample(index, is_transparent, offset);
        self.view.set(&gpu.device, &gpu.queue, bytemuck::bytes_of(&view));
        self.shadows.set_sample(gpu, index);
    }

    /// Uploads the environment, if it is another one. Returns whether the buffer was replaced.
    fn upload_map(&mut self, gpu: &Gpu, flat: &FlatScene) -> bool {
        if self.held_map.as_ref() == Some(&flat.environment_map) {
            return false;
        }
        self.held_map = Some(flat.environment_map.clone());
        let words = map_words(flat.environment_map.as_ref());
        self.environment_map.set(&gpu.device, &gpu.queue, bytemuck::cast_slice(&words))
    }

    /// Gives the slot textures for accumulated samples, if it has none.
    pub fn keep_accumulation(&mut self, device: &wgpu::Device, slot: Slot) {
        if let Some(state) = &mut self.slots[slot as usize] {
            let size = state.targets.size;
            state.accumulation.get_or_insert_with(|| Accumulation::new(device, size));
        }
    }

    /// Uploads dispatches. Returns whether the buffer was replaced.
    pub fn set_work(&mut self, gpu: &Gpu, dispatches: &[Dispatch]) -> bool {
        self.dispatch_params.set(&gpu.device, &gpu.queue, &strided(dispatches.iter().map(|dispatch| dispatch.params)))
    }

    /// Drops all bind groups, so that [`Self::bind`] rebuilds them.
    pub fn forget_groups(&mut self) {
        self.slots.iter_mut().flatten().for_each(|state| state.groups = None);
    }

    /// Builds the bind groups of the slot if they are missing; `own` builds those of the passes.
    pub fn bind(
        &mut self,
        device: &wgpu::Device,
        slot: Slot,
        scene: &SceneResources,
        own: impl FnOnce(&Bound<'_>) -> Vec<Vec<BindGroup>>,
    ) {
        let state = self.slot(slot);
        if state.groups.is_some() {
            return;
        }
        let (materials, places) = (scene.materials(), scene.places());
        let bound = Bound { targets: &state.targets, resources: self, materials, places };
        let [of_scene, templates] = scene.bind(device);
        let dispatch_params = window(self.dispatch_params.buffer(), size_of::<DispatchParams>());
        let groups = Groups {
            view: bind(device, "view", &self.layouts.view, &[self.view.binding()]),
            scene: of_scene,
            templates,
            copies: state.targets.copied.is_some().then(|| scene.bind_copies(device)),
            shaded: scene.shaded(),
            dispatch_params: bind(device, "dispatch_params", &self.layouts.dispatch_params, &[dispatch_params]),
            own: own(&bound),
        };
        if let Some(state) = &mut self.slots[slot as usize] {
            state.groups = Some(groups);
        }
    }

    /// The buffers between the passes over components.
    pub fn lists(&self) -> FieldBuffers<'_> {
        FieldBuffers {
            subtiles: self.subtiles.buffer(),
            subtile_counts: self.subtile_counts.buffer(),
            rays: self.rays.buffer(),
            ray_counts: self.ray_counts.buffer(),
            nothing: self.nothing.buffer(),
            march_counts: self.counts.buffer(),
        }
    }

    /// The lights.
    pub fn lights(&self) -> wgpu::BindingResource<'_> {
        self.lights.binding()
    }

    /// The lights of each tile, if there are many lights.
    pub fn light_tiles(&self) -> Option<wgpu::BindingResource<'_>> {
        self.light_tiles.1.then(|| self.light_tiles.0.binding())
    }

    /// The environment.
    pub fn environment_map(&self) -> wgpu::BindingResource<'_> {
        self.environment_map.binding()
    }

    /// The parameters of all dispatches.
    pub fn dispatch_params(&self) -> &wgpu::Buffer {
        self.dispatch_params.buffer()
    }

    /// The materials of the meshes.
    pub fn mesh_materials(&self) -> wgpu::BindingResource<'_> {
        self.mesh_materials.binding()
    }

    /// What rays may pass of the scene.
    pub fn veil(&self) -> Veil {
        self.veil
    }

    /// The textures, if the scene uses some.
    pub fn textures(&self) -> Option<TextureBindings<'_>> {
        self.textures.bindings()
    }

    /// Clears the counts of unfinished rays of `lists` lists, and the counters of pixels.
    pub fn clear(&self, encoder: &mut wgpu::CommandEncoder, lists: u32, size: [u32; 2]) {
        encoder.clear_buffer(self.rays.buffer(), 0, Some(u64::from(lists.max(1)) * 4));
        self.counts.clear_pixels(encoder, size);
    }

    /// Uploads the dispatches of the frame, which continues with those from `planned` on. Resets the counts and lists
    /// that they fill.
    pub fn restart(&mut self, gpu: &Gpu, frame: &Frame, planned: usize, is_meant: &dyn Fn(u32) -> bool) -> bool {
        let write = |buffer: &wgpu::Buffer, word: usize, words: &[u32]| {
            gpu.queue.write_buffer(buffer, word as u64 * 4, bytemuck::cast_slice(words));
        };
        for component in (0..frame.origins.len()).filter(|at| is_meant(*at as u32)) {
            write(self.counts.buffer(), component * super::pixel_counts::COMPONENT_COUNTS, &[0]);
        }
        for dispatch in frame.plan.dispatches[planned..].iter().filter(|dispatch| dispatch.pass == Pass::Cone) {
            let list = dispatch.params.list as usize;
            write(self.subtile_counts.buffer(), list * SUBTILE_COUNTS, &NO_SUBTILES);
            write(self.ray_counts.buffer(), list * RAY_COUNTS, &NO_RAYS);
            write(self.rays.buffer(), list, &[0]);
        }
        self.set_work(gpu, &frame.plan.dispatches)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::light_tiles::LIGHT_TILE;
    use crate::frame::plan::SUBTILES;
    use crate::frame::rect::TILE;
    use crate::renderer::pixel_counts::{COMPONENT_COUNTS, PIXEL_COUNTS};
    use crate::resources::buffers::DataTexture;
    use crate::resources::hierarchy::COPIES_LINK;
    use crate::resources::shadows::{SHADOW_COPIES_WORDS, SHADOW_WORDS};
    use isolith_field::light::occlusion::{OCCLUSION_CONES, OCCLUSION_RAYS};
    use isolith_field::{FlatNode, LEAF_ROWS, MESH_BIT, MODIFIER_ROWS, NO_LEAF};
    use isolith_wgsl::assemble_plain;

    /// The value of a constant in a shader.
    fn constant(file: &str, name: &str) -> u32 {
        let text = assemble_plain(file).unwrap_or_else(|error| panic!("{error}"));
        let start = format!("const {name}: u32 = ");
        let line =
            text.lines().find_map(|line| line.strip_prefix(&start)).unwrap_or_else(|| panic!("{file}: no {name}"));
        let digits = line.trim_end_matches(';').trim_end_matches('u');
        let number = digits.strip_prefix("0x").map_or_else(|| digits.parse(), |hex| u32::from_str_radix(hex, 16));
        number.unwrap_or_else(|error| panic!("{file}: {name}: {digits}: {error}"))
    }

    #[test]
    fn shaders_have_the_same_constants() {
        let twins = [
            ("common/subtiles.wgsl", "SUBTILE_COUNTS", SUBTILE_COUNTS as u32),
            ("common/subtiles.wgsl", "RAY_COUNTS", RAY_COUNTS as u32),
            ("common/subtiles.wgsl", "SUBTILE", TILE / SUBTILES),
            ("common/dispatch.wgsl", "TILE", TILE),
            ("common/depth.wgsl", "VISIBILITY_NONE", NO_LEAF),
            ("common/depth.wgsl", "MESH_BIT", MESH_BIT),
            ("common/scene.wgsl", "LEAF_ROWS", LEAF_ROWS as u32),
            ("common/scene.wgsl", "MODIFIER_ROWS", MODIFIER_ROWS as u32),
            ("common/scene.wgsl", "GROUP", FlatNode::GROUP),
            ("common/scene.wgsl", "RUN", FlatNode::RUN),
            ("common/scene.wgsl", "MODIFIER", FlatNode::MODIFIER),
            ("common/lines.wgsl", "LINE", DataTexture::LINE as u32),
            ("light/shadow_settings.wgsl", "SHADOW_WORDS", SHADOW_WORDS as u32),
            ("light/shadow_settings.wgsl", "SHADOW_COPIES_WORDS", SHADOW_COPIES_WORDS as u32),
            ("scene/hierarchy.wgsl", "COPIES_LINK", COPIES_LINK),
            ("light/occlusion.wgsl", "OCCLUSION_CONES", OCCLUSION_CONES),
            ("light/occlusion.wgsl", "OCCLUSION_RAYS", OCCLUSION_RAYS),
            ("light/light_tiles.wgsl", "LIGHT_TILE", LIGHT_TILE),
            ("common/counts.wgsl", "COMPONENT_COUNTS", COMPONENT_COUNTS as u32),
            ("common/counts.wgsl", "PIXEL_COUNTS", PIXEL_COUNTS as u32),
        ];
        for (file, name, ours) in twins {
            assert_eq!(constant(file, name), ours, "{file}: {name}");
        }
    }

    #[test]
    fn subtiles_have_room() {
        let text = assemble_plain("trace.wgsl").unwrap_or_else(|error| panic!("{error}"));
        let module = naga::front::wgsl::parse_str(&text).unwrap_or_else(|error| panic!("{error}"));
        let (_, subtile) = module.types.iter().find(|(_, t)| t.name.as_deref() == Some("Subtile")).expect("a subtile");
        let naga::TypeInner::Struct { span, .. } = subtile.inner else { panic!("{subtile:?}") };
        assert_eq!(span as usize, SUBTILE_BYTES);
    }
}
