//! A scene at a moment, ready to be drawn, and the renderer that draws it. What one picture has prepared and compiled
//! serves the next.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use super::error::ExportError;
use crate::field::debug_view::ViewMode;
use crate::field::mesh_rays::Meshes;
use crate::field::standpoint::NARROW;
use crate::field::{FlatScene, GBuffer, Shading, Warning};
use crate::geometry::{Camera, Lens};
use crate::jobs::Task;
use crate::mesh::TriangleMesh;
use crate::render::driver::loop_iterations;
use crate::render::{
    AdapterChoice, EvalStrategy, Film, Gpu, RenderError, Renderer, SampleMoment, StillWatch, TracedParts,
};
use crate::scene::{NodeId, Scene};
use crate::session::PreparedScene;

/// Most pixels by which a lens may move the picture: f32 keeps its place to a thousandth of a pixel.
const MOST_BLUR: f64 = 8_192.0;

/// Most moments of a still, all of which are prepared before it is drawn; more samples take turns.
const MOST_MOMENTS: u32 = 64;

/// What pictures show.
#[derive(Clone, Debug)]
pub struct StillSettings {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Camera by name; `None` for the first one, or all of a scene without cameras.
    pub camera: Option<String>,
    /// What the colors mean.
    pub view_mode: ViewMode,
    /// How the scene is lit.
    pub shading: Shading,
    /// Number of passes over components after which the picture is shown; `None` for all.
    pub passes: Option<u32>,
    /// Samples, and the background. The lens is that of the camera.
    pub film: Film,
    /// Whether the light is wanted as it is before exposure and view transform.
    pub is_linear: bool,
    /// Whether base colors are wanted.
    pub has_layers: bool,
}

/// A scene of which pictures are made.
pub struct Stills {
    scene: Scene,
    folder: Option<PathBuf>,
    settings: StillSettings,
    prepared: Option<PreparedScene>,
    names: Arc<BTreeMap<u64, String>>,
}

/// A picture ready to be drawn.
#[derive(Clone)]
pub struct Still {
    /// The scene in its shading.
    pub flat: Arc<FlatScene>,
    /// The meshes that could be loaded.
    pub meshes: Vec<Option<Arc<TriangleMesh>>>,
    /// The view.
    pub camera: Camera,
    /// The other moments while the shutter is open, for the samples after the first.
    pub moments: Vec<Moment>,
    /// Samples, background and lens.
    pub film: Film,
    /// The settings.
    pub settings: StillSettings,
    /// The name of each node.
    pub names: Arc<BTreeMap<u64, String>>,
    /// Warnings for the artist.
    pub warnings: Vec<Warning>,
}

/// A scene at another moment of a still.
#[derive(Clone)]
pub struct Moment {
    /// The scene in its shading.
    pub flat: Arc<FlatScene>,
    /// The meshes that could be loaded.
    pub meshes: Vec<Option<Arc<TriangleMesh>>>,
    /// The view.
    pub camera: Camera,
}

impl Still {
    /// The moment of the picture, and then the others while the shutter is open.
    pub fn all_moments(&self) -> impl Iterator<Item = SampleMoment<'_>> {
        let Self { flat, meshes, camera, .. } = self;
        let others = self.moments.iter().map(|moment| SampleMoment {
            flat: &moment.flat,
            meshes: &moment.meshes,
            camera: &moment.camera,
        });
        std::iter::once(SampleMoment { flat, meshes, camera }).chain(others)
    }
}

/// A picture as numbers.
#[derive(Clone, Debug)]
pub struct Drawn {
    /// Color, depth, normals, hits, and light.
    pub buffers: GBuffer,
    /// Linear base color of each pixel; empty unless layers are wanted.
    pub base_colors: Vec<[f32; 3]>,
}

impl Stills {
    /// Pictures of the scene, whose models lie in the folder.
    pub fn new(scene: Scene, folder: Option<PathBuf>, settings: StillSettings) -> Self {
        let names = scene.nodes().iter().map(|node| (node.id.0, node.name.clone())).collect();
        Self { scene, folder, settings, prepared: None, names: Arc::new(names) }
    }

    /// The scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The picture at `time` seconds.
    ///
    /// # Errors
    /// The scene is beyond a limit, the camera is missing or its lens blurs too much, or the task was canceled.
    pub fn at(&mut self, time: f64, task: &Task) -> Result<Still, ExportError> {
        let (settings, names) = (self.settings.clone(), Arc::clone(&self.names));
        let prepared = self.prepared_at(time, task)?;
        let flat = Arc::clone(&prepared.flat);
        let (meshes, missing) = flat.load_meshes(&mut prepared.library);
        let refused = prepared.warnings_of_fields();
        let warnings = flat.warnings.iter().cloned().chain(missing).chain(refused).collect();
        let (camera, lens) = choose_camera(&flat, &meshes, &settings)?;
        check_passes(&flat, &camera, &settings, &names)?;
        let film = with_lens(settings.film, lens, &camera, settings.size[1])?;
        let flat = flat.shaded(settings.shading);
        let moments = self.moments(time, film, task)?;
        Ok(Still { flat, meshes, camera, moments, film, settings, names, warnings })
    }

    /// The scene at the moments of the samples after the first, while the shutter is open.
    fn moments(&mut self, time: f64, film: Film, task: &Task) -> Result<Vec<Moment>, ExportError> {
        if film.lens.shutter <= 0.0 {
            return Ok(Vec::new());
        }
        let settings = self.settings.clone();
        let mut moment = |sample: u32| {
            let prepared = self.prepared_at(time + film.lens.moment(sample), task)?;
            let flat = Arc::clone(&prepared.flat);
            let (meshes, _) = flat.load_meshes(&mut prepared.library);
            let (camera, _) = choose_camera(&flat, &meshes, &settings)?;
            Ok(Moment { flat: flat.shaded(settings.shading), meshes, camera })
        };
        (1..film.samples.min(MOST_MOMENTS)).map(&mut moment).collect()
    }

    fn prepared_at(&mut self, time: f64, task: &Task) -> Result<&mut PreparedScene, ExportError> {
        let prepared = match self.prepared.take() {
            Some(mut prepared) => prepared.advance(&self.scene, time, task)?.then_some(prepared),
            None => PreparedScene::of(&self.scene, time, self.folder.clone(), task)?,
        };
        Ok(self.prepared.insert(prepared.ok_or(ExportError::Canceled)?))
    }
}

/// Draws pictures on a device of its own, which it opens for the first.
pub struct StillPainter {
    choice: AdapterChoice,
    renderer: Option<Renderer>,
}

impl StillPainter {
    /// A painter on this adapter.
    pub fn new(choice: AdapterChoice) -> Self {
        Self { choice, renderer: None }
    }

    /// Draws a picture. Returns warnings about it, too. The task cancels it.
    ///
    /// # Errors
    /// There is no device, or it fails, or the task was canceled.
    pub fn draw(
        &mut self,
        still: &Still,
        task: &Task,
        watch: &mut dyn StillWatch,
    ) -> Result<(Drawn, Vec<Warning>), ExportError> {
        let Still { flat, meshes, camera, film, settings, .. } = still;
        let view_mode = settings.view_mode;
        let renderer = self.renderer(view_mode)?;
        renderer.set_cancel(task.flag());
        renderer.set_traced(TracedParts { passes: settings.passes, ..TracedParts::default() });
        let share_of_picture = match settings.has_layers {
            true => film.samples as f32 / (film.samples + 1) as f32,
            false => 1.0,
        };
        let mut watch = Shared { watch, share: share_of_picture };
        let accumulates = film.samples > 1 || film.is_transparent || settings.is_linear;
        let drawn = match accumulates {
            true => {
                let moments: Vec<_> = still.all_moments().collect();
                renderer.render_moments_for(*film, &moments, settings.size, &mut watch)
            }
            false => {
                let progress = &mut |share| watch.progress(share);
                renderer.render_as(view_mode, flat, meshes, camera, settings.size, progress)
            }
        };
        let (buffers, warnings) = drawn.map_err(canceled)?;
        let (buffers, base_colors) = if settings.has_layers {
            let flat = flat.in_base_colors();
            let progress = &mut |share| {
                watch.watch.progress(share_of_picture + (1.0 - share_of_picture) * share) && !task.is_canceled()
            };
            let layers = renderer.render_base_colors(&flat, meshes, camera, settings.size, progress);
            let (base_colors, first) = layers.map_err(canceled)?;
            // Layers of numbers are those of the first surfaces, also where rays pass these.
            let GBuffer { color, radiance, .. } = buffers;
            (GBuffer { color, radiance, ..first }, base_colors)
        } else {
            (buffers, Vec::new())
        };
        Ok((Drawn { buffers, base_colors }, warnings))
    }

    fn renderer(&mut self, view_mode: ViewMode) -> Result<&mut Renderer, ExportError> {
        let renderer = match self.renderer.take() {
            Some(renderer) => renderer,
            None => {
                let gpu = Gpu::open(&self.choice)?;
                loop_iterations(&gpu)?;
                let mut renderer = if view_mode.counts() { Renderer::counting(&gpu)? } else { Renderer::new(&gpu)? };
                if !view_mode.counts() {
                    // One picture is done before straight-line pipelines could be compiled: 4 s against 40 s at 577
                    // nodes on lavapipe. Tapes take a fraction of a second to build, and draw a large blend up to a
                    // hundred times as fast.
                    renderer.set_strategy(EvalStrategy::Tape);
                }
                renderer
            }
        };
        Ok(self.renderer.insert(renderer))
    }
}

/// A watch whose picture is only a part of the work.
struct Shared<'a> {
    watch: &'a mut dyn StillWatch,
    share: f32,
}

impl StillWatch for Shared<'_> {
    fn progress(&mut self, share: f32) -> bool {
        self.watch.progress(share * self.share)
    }

    fn wants_picture(&mut self) -> bool {
        self.watch.wants_picture()
    }

    fn picture(&mut self, color: &[[u8; 4]], samples: u32) {
        self.watch.picture(color, samples);
    }
}

/// The error of a renderer; a canceled one is no failure of it.
pub(super) fn canceled(error: RenderError) -> ExportError {
    match error {
        RenderError::Canceled => ExportError::Canceled,
        error => error.into(),
    }
}

/// The camera chosen by name, or the default view of the scene.
fn choose_camera(flat: &FlatScene, meshes: &Meshes, settings: &StillSettings) -> Result<(Camera, Lens), ExportError> {
    let aspect = f64::from(settings.size[0]) / f64::from(settings.size[1]);
    let Some(name) = &settings.camera else {
        let lens = flat.cameras.first().map_or(Lens::default(), |first| first.lens);
        return Ok((flat.default_camera(meshes, aspect), lens));
    };
    if let Some(found) = flat.cameras.iter().find(|camera| camera.name == *name) {
        return Ok((found.camera, found.lens));
    }
    let names: Vec<_> = flat.cameras.iter().map(|camera| format!("\"{}\"", camera.name)).collect();
    let has = if names.is_empty() { "none".to_string() } else { names.join(", ") };
    Err(ExportError::Settings(format!("there is no camera \"{name}\"; the scene has {has}")))
}

/// Refuses a pass beyond the last one.
fn check_passes(
    flat: &FlatScene,
    camera: &Camera,
    settings: &StillSettings,
    names: &BTreeMap<u64, String>,
) -> Result<(), ExportError> {
    let passes = flat.component_passes(camera.position);
    let Some(wanted) = settings.passes.filter(|wanted| *wanted as usize > passes.len()) else { return Ok(()) };
    let name = |id: &NodeId| names.get(&id.0).map_or_else(|| id.to_string(), String::clone);
    let listed: Vec<String> = (1..).zip(&passes).map(|(at, pass)| format!("{at} {:?}", name(&pass.node))).collect();
    let has = if listed.is_empty() { "none".to_owned() } else { listed.join(", ") };
    Err(ExportError::Settings(format!("there is no pass {wanted}; the passes over the scene's parts are {has}")))
}

/// The film with the lens of the camera. Refuses a lens that blurs more than the picture can be moved exactly.
fn with_lens(film: Film, lens: Lens, camera: &Camera, height: u32) -> Result<Film, ExportError> {
    let pixels = lens.greatest_offset(camera, height);
    if film.samples == 1 {
        return Ok(film);
    }
    if lens.is_open() && camera.footprint(height.into()) < NARROW {
        let reason = "the camera's aperture: pixels are too narrow for depth of field";
        return Err(ExportError::Settings(reason.into()));
    }
    if pixels > MOST_BLUR {
        let reason = format!("it moves the picture by {pixels:.0} pixels, and the limit is {MOST_BLUR}");
        return Err(ExportError::Settings(format!("the camera's aperture: {reason}")));
    }
    Ok(Film { lens, ..film })
}
