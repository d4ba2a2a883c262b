//! The viewport's picture: a coarse one at once where the full one would take too long, the full one
//! bit by bit while nothing changes, nothing at all while it is up to date.

use std::sync::Arc;
use std::time::{Duration, Instant};

use eframe::egui_wgpu::RenderState;
use egui::TextureId;

use crate::editor::{Editor, Message, Picture, View};
use crate::flat::FlatScene;
use crate::mesh::TriangleMesh;
use crate::render::{Frame, Gpu, OverlaySettings, RenderError, Renderer, Slot};
use crate::scene::NodeId;

/// A picture that takes longer than this is made coarse first.
const AT_ONCE: Duration = Duration::from_millis(60);
/// Time given to the full picture in each frame of the window: on a software driver painting the window
/// takes about as long itself, so less would mostly repaint.
const PER_FRAME: Duration = Duration::from_millis(60);
/// A full picture that takes longer than this waits for the kernels that are being built: they make it
/// many times faster than the interpreter would.
const WORTH_WAITING: Duration = Duration::from_millis(1500);
/// The same for pruned lists, which are made sooner: some 200 ms in most scenes.
const LISTS_WORTH_WAITING: Duration = Duration::from_millis(300);
/// Pixels of the window to a side of a coarse pixel, at most.
const COARSEST: u32 = 8;

/// See the module.
pub(super) struct Canvas {
    renderer: Renderer,
    state: RenderState,
    textures: [Option<(TextureId, [u32; 2])>; 2],
    shown: Option<Slot>,
    wanted: Option<Wanted>,
    under_way: Option<(Frame, Instant)>,
    took: Duration,
    /// The camera or a value is being dragged.
    navigating: bool,
    /// The full picture waits for the end of a drag, or for kernels or lists that are being made.
    waiting: bool,
}

/// Everything that the picture depends on.
#[derive(Clone, PartialEq)]
struct Wanted {
    view: View,
    flat: Arc<FlatScene>,
    meshes: Vec<Option<usize>>,
    outline: Vec<NodeId>,
}

impl Canvas {
    pub fn new(gpu: Gpu, state: RenderState) -> Result<Self, RenderError> {
        Ok(Self {
            renderer: Renderer::new(&gpu)?,
            state,
            textures: [None, None],
            shown: None,
            wanted: None,
            under_way: None,
            took: Duration::ZERO,
            navigating: false,
            waiting: false,
        })
    }

    pub fn is_lost(&self) -> bool {
        self.renderer.gpu().is_lost()
    }

    /// What there is to show now.
    pub fn picture(&self) -> Picture {
        let shown = self.shown.and_then(|slot| self.textures[slot as usize]);
        Picture {
            texture: shown.map(|(id, _)| id),
            size_px: shown.map_or([1, 1], |(_, size)| size),
            progress: self.under_way.as_ref().map(|(frame, _)| frame.progress()),
            status: self.status(),
        }
    }

    fn status(&self) -> String {
        let name = short_name(&self.renderer.gpu().info.name);
        let took = self.took.as_secs_f64() * 1e3;
        match self.renderer.kernels_building() {
            0 => format!("{name} · {took:.0} ms"),
            n => format!("{name} · {took:.0} ms · compiling {n}"),
        }
    }

    /// Brings the picture nearer to what the editor wants, in bounded time.
    pub fn update(&mut self, editor: &mut Editor, ctx: &egui::Context) -> Result<(), RenderError> {
        self.renderer.gpu().check()?;
        let View { navigating, .. } = editor.view();
        // Not part of what the picture depends on: letting go changes nothing in it.
        let view = View { navigating: false, ..editor.view() };
        let outline = if view.show_outline { with_descendants(editor) } else { Vec::new() };
        let (flat, library) = editor.flat_and_meshes();
        let flat = flat.clone();
        let (meshes, _) = flat.load_meshes(library);
        let addresses = meshes.iter().map(|m| m.as_ref().map(|m| Arc::as_ptr(m) as usize)).collect();
        let wanted = Wanted { view, flat, meshes: addresses, outline };
        let news = self.follow_kernels(editor, ctx);
        let settled = self.navigating && !navigating;
        self.navigating = navigating;
        if self.wanted.as_ref() != Some(&wanted) || (self.waiting && (news || settled)) {
            if self.differs_in_marks_only(&wanted) {
                self.restyle(&wanted, &meshes)?;
            } else {
                self.start(&wanted, &meshes)?;
            }
            self.wanted = Some(wanted);
        }
        if let Some((frame, started)) = &mut self.under_way {
            self.renderer.advance(frame, PER_FRAME)?;
            if frame.is_done() {
                self.took = started.elapsed();
                for mut warning in self.renderer.unfinished_rays(frame)? {
                    warning.name =
                        editor.document().scene().node(warning.node).map_or(String::new(), |n| n.name.clone());
                    editor.report(Message::warning(format!("{}: {}", warning.name, warning.reason)));
                }
                self.under_way = None;
                self.show(Slot::Full);
            }
            ctx.request_repaint();
        }
        Ok(())
    }

    /// Whether the full picture is there and only grid or outline are to change.
    fn differs_in_marks_only(&self, wanted: &Wanted) -> bool {
        let complete = self.shown == Some(Slot::Full) && self.under_way.is_none() && !self.waiting;
        let marked_alike = |shown: &Wanted| {
            let View { show_grid, show_outline, .. } = shown.view;
            let view = View { show_grid, show_outline, ..wanted.view };
            Wanted { view, outline: shown.outline.clone(), ..wanted.clone() }
        };
        complete && self.wanted.as_ref().is_some_and(|shown| *shown == marked_alike(shown))
    }

    /// Draws the marks anew over the picture that is there.
    fn restyle(&mut self, wanted: &Wanted, meshes: &[Option<Arc<TriangleMesh>>]) -> Result<(), RenderError> {
        let overlay = OverlaySettings { grid: wanted.view.show_grid, outline: wanted.outline.clone() };
        let View { camera, size_px, .. } = wanted.view;
        let mut frame = self.renderer.begin(Slot::Full, &wanted.flat, meshes, &camera, size_px, overlay)?;
        frame.skip_to_shading();
        self.renderer.advance(&mut frame, Duration::MAX)?;
        self.show(Slot::Full);
        Ok(())
    }

    /// Kernels and lists that are being made are waited for without hurry; kernels that failed are told of.
    /// True when another one has become ready.
    fn follow_kernels(&mut self, editor: &mut Editor, ctx: &egui::Context) -> bool {
        let lists = self.renderer.pruner();
        let mut news = lists.collect();
        if lists.building() > 0 {
            ctx.request_repaint_after(Duration::from_millis(30));
        }
        let kernels = self.renderer.kernels();
        news |= kernels.collect();
        for failure in kernels.take_failures() {
            editor.report(Message::warning(failure));
        }
        if kernels.building() > 0 {
            ctx.request_repaint_after(Duration::from_millis(200));
        }
        news
    }

    /// Begins the full picture, after a coarse one if the full one is not to be had at once.
    fn start(&mut self, wanted: &Wanted, meshes: &[Option<Arc<TriangleMesh>>]) -> Result<(), RenderError> {
        let View { camera, size_px, .. } = wanted.view;
        let flat = &*wanted.flat;
        let overlay = OverlaySettings { grid: wanted.view.show_grid, outline: wanted.outline.clone() };
        let full = self.renderer.estimate(flat, &camera, size_px)?;
        let started = Instant::now();
        if full > AT_ONCE {
            let factor = (full.as_secs_f64() / AT_ONCE.as_secs_f64()).sqrt().ceil().min(f64::from(COARSEST)) as u32;
            let size = size_px.map(|v| v.div_ceil(factor).max(1));
            let mut frame = self.renderer.begin(Slot::Preview, flat, meshes, &camera, size, overlay.clone())?;
            self.renderer.advance(&mut frame, Duration::MAX)?;
            self.show(Slot::Preview);
        }
        let kernels_pay = full > WORTH_WAITING && self.renderer.kernels_building() > 0;
        let lists_pay = full > LISTS_WORTH_WAITING && self.renderer.pruner().building() > 0;
        self.waiting = full > AT_ONCE && (self.navigating || kernels_pay || lists_pay);
        if self.waiting {
            self.under_way = None;
            return Ok(());
        }
        let mut frame = self.renderer.begin(Slot::Full, flat, meshes, &camera, size_px, overlay)?;
        if full <= AT_ONCE {
            self.renderer.advance(&mut frame, Duration::MAX)?;
            self.took = started.elapsed();
            self.under_way = None;
            self.show(Slot::Full);
        } else {
            self.under_way = Some((frame, started));
        }
        Ok(())
    }

    /// Makes the picture in `slot` the one that egui draws.
    fn show(&mut self, slot: Slot) {
        let Some((view, size)) = self.renderer.picture(slot) else { return };
        let filter = match slot {
            Slot::Full => wgpu::FilterMode::Nearest,
            Slot::Preview => wgpu::FilterMode::Linear,
        };
        let mut egui_renderer = self.state.renderer.write();
        let device = &self.state.device;
        let texture = &mut self.textures[slot as usize];
        let id = match *texture {
            Some((id, _)) => {
                egui_renderer.update_egui_texture_from_wgpu_texture(device, view, filter, id);
                id
            }
            None => egui_renderer.register_native_texture(device, view, filter),
        };
        *texture = Some((id, size));
        self.shown = Some(slot);
    }
}

/// The selected nodes and all below them.
fn with_descendants(editor: &Editor) -> Vec<NodeId> {
    let document = editor.document();
    let scene = document.scene();
    let ranges = document.selection().iter().filter_map(|id| scene.index_of(*id)).map(|i| scene.subtree(i));
    ranges.flat_map(|range| scene.nodes()[range].iter().map(|n| n.id)).collect()
}

/// The adapter's name without the parenthesis that many carry.
fn short_name(name: &str) -> &str {
    name.split(" (").next().unwrap_or(name)
}
