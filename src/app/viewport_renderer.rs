//! The viewport's picture: first a coarse one if the full one would take too long, then the full one bit by bit until
//! something changes. While nothing does, samples accumulate; a picture with all of them costs nothing.

use std::sync::Arc;
use std::time::{Duration, Instant};

use eframe::egui_wgpu::RenderState;
use egui::TextureId;

use super::samples::Samples;
use crate::editor::{Editor, GridView, Message, Picture, ViewSettings};
use crate::field::debug_view::{DepthRange, ViewMode};
use crate::field::{FlatScene, Shading};
use crate::mesh::TriangleMesh;
use crate::render::{Frame, Gpu, GridPlane, OverlaySettings, RenderError, Renderer, Slot, TracedParts, coarse_size};
use crate::scene::NodeId;

/// A picture that takes longer than this starts with a coarse one.
const AT_ONCE: Duration = Duration::from_millis(60);
/// Time for the full picture in each frame of the window, as a multiple of the time for painting the window. The result
/// is a sixtieth of a second on a graphics card, but a tenth on a software driver, where a shorter time would be spent
/// mostly on repainting.
const PER_PAINTING: f32 = 2.0;
/// Lower and upper limit of that time.
const PER_FRAME: [Duration; 2] = [Duration::from_millis(16), Duration::from_millis(150)];
/// A full picture that takes longer than this waits for pipelines in the making: they are many times faster than the
/// interpreter.
const WORTH_WAITING: Duration = Duration::from_millis(1500);
/// The same for tapes, which are ready sooner: after some 200 ms in most scenes.
const TAPES_WORTH_WAITING: Duration = Duration::from_millis(300);

/// Draws the viewport's picture and hands it to egui.
pub(super) struct ViewportRenderer {
    renderers: Renderers,
    state: RenderState,
    textures: [Option<(TextureId, [u32; 2])>; 2],
    shown: Option<Slot>,
    request: Option<RenderRequest>,
    /// The last scene, its shading, and what that makes of it.
    shaded: Option<(Arc<FlatScene>, Shading, Arc<FlatScene>)>,
    in_flight: Option<(Frame, Instant)>,
    /// Samples of the complete picture.
    samples: Samples,
    /// Number of samples that the artist wants.
    wanted: u32,
    elapsed: Duration,
    /// The last measured time for painting the window.
    painting: Duration,
    /// When the last update ended, if it requested an immediate repaint.
    painting_since: Option<Instant>,
    /// The artist drags the camera or a value.
    navigating: bool,
    /// The full picture waits for the end of a drag, or for pipelines or tapes in the making.
    waiting: bool,
    /// Pipelines may be ready that no picture has used yet.
    needs_prewarm: bool,
    /// Size of the last coarse picture before scaling.
    preview_size: Option<[u32; 2]>,
}

/// One renderer for the lit picture and one for the view modes that count. Counting costs time and memory, so the
/// second exists only while such a view mode is active.
struct Renderers {
    plain: Renderer,
    counting: Option<Renderer>,
}

impl Renderers {
    /// The renderer of the current view mode.
    fn active(&mut self) -> &mut Renderer {
        self.counting.as_mut().unwrap_or(&mut self.plain)
    }

    /// Switches to the renderer of this view mode.
    fn choose(&mut self, view_mode: ViewMode) -> Result<(), RenderError> {
        if !view_mode.counts() {
            self.counting = None;
        } else if self.counting.is_none() {
            self.counting = Some(of_window(Renderer::counting(self.plain.gpu())?));
        }
        Ok(())
    }
}

/// No picture of a window waits for shadows.
fn of_window(mut renderer: Renderer) -> Renderer {
    renderer.set_late_shadows(true);
    renderer
}

/// All inputs of the picture.
#[derive(Clone)]
struct RenderRequest {
    view: ViewSettings,
    flat: Arc<FlatScene>,
    meshes: Vec<Option<usize>>,
    outline: Vec<NodeId>,
}

impl PartialEq for RenderRequest {
    /// Compares flat scenes by pointer: each rebuild makes another one, and comparing values in every frame would take
    /// longer.
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.flat, &other.flat)
            && self.view == other.view
            && self.meshes == other.meshes
            && self.outline == other.outline
    }
}

impl ViewportRenderer {
    pub fn new(gpu: Gpu, state: RenderState) -> Result<Self, RenderError> {
        Ok(Self {
            renderers: Renderers { plain: of_window(Renderer::new(&gpu)?), counting: None },
            state,
            textures: [None, None],
            shown: None,
            request: None,
            shaded: None,
            in_flight: None,
            samples: Samples::default(),
            wanted: 1,
            elapsed: Duration::ZERO,
            painting: PER_FRAME[0],
            painting_since: None,
            navigating: false,
            waiting: false,
            needs_prewarm: false,
            preview_size: None,
        })
    }

    pub fn gpu(&self) -> &Gpu {
        self.renderers.plain.gpu()
    }

    /// Gives its textures back.
    pub fn close(self) {
        let mut renderer = self.state.renderer.write();
        for (id, _) in self.textures.into_iter().flatten() {
            renderer.free_texture(&id);
        }
    }

    pub fn is_lost(&self) -> bool {
        self.renderers.plain.gpu().is_lost()
    }

    /// The current picture is final until the request changes.
    pub fn stop_drawing(&mut self) {
        (self.in_flight, self.waiting) = (None, false);
        self.samples.stop();
    }

    /// Whether the picture is complete, but for further samples.
    pub fn is_complete(&self) -> bool {
        self.in_flight.is_none() && !self.waiting && !self.navigating
    }

    /// The picture to show now.
    pub fn picture(&self) -> Picture {
        let shown = self.shown.and_then(|slot| self.textures[slot as usize]);
        Picture {
            texture: shown.map(|(id, _)| id),
            size_px: shown.map_or([1, 1], |(_, size)| size),
            progress: self.in_flight.as_ref().map(|(frame, _)| frame.progress()),
            is_waiting: self.waiting && !self.navigating,
            samples: self.samples.count().map(|count| [count, self.wanted.max(count)]),
            is_sampling: self.samples.wants_more(self.wanted),
            status: self.status(),
        }
    }

    fn status(&self) -> String {
        let renderer = &self.renderers.plain;
        let name = short_name(&renderer.gpu().info.name);
        let building = renderer.pipelines_building() + usize::from(renderer.awaits_shadows());
        status_text(name, self.elapsed, building, renderer.pipelines_failed())
    }

    /// Advances the picture toward the editor's request, in bounded time.
    ///
    /// A picture that `may_refine` not stays coarse until the next call.
    pub fn update(
        &mut self,
        editor: &mut Editor,
        view: ViewSettings,
        may_refine: bool,
        ctx: &egui::Context,
    ) -> Result<(), RenderError> {
        self.renderers.plain.gpu().check()?;
        self.painting = self.painting_since.take().map_or(self.painting, |since| since.elapsed());
        let ViewSettings { navigating, samples: wanted, .. } = view;
        self.wanted = wanted;
        // Not inputs of the picture: the end of a drag and the number of samples change nothing in it.
        let view = ViewSettings { navigating: false, samples: 0, ..view };
        let outline = if view.show_outline { with_descendants(editor) } else { Vec::new() };
        let flat = self.shaded(editor.flat(), view.shading);
        let meshes = flat.known_meshes(editor.meshes());
        let addresses = meshes.iter().map(|m| m.as_ref().map(|m| Arc::as_ptr(m) as usize)).collect();
        let request = RenderRequest { view, flat, meshes: addresses, outline };
        let news = self.follow_pipelines(editor, ctx);
        let settled = self.navigating && !navigating;
        self.navigating = navigating;
        let has_shadows = self.follow_shadows(ctx);
        let is_other = has_shadows || self.request.as_ref() != Some(&request);
        // Samples to come are worth the pipelines and tapes that have become ready.
        let is_faster = news && self.samples.wants_more(wanted);
        if is_other || is_faster || (self.waiting && (news || settled)) {
            if !has_shadows && self.differs_in_marks_only(&request) {
                self.restyle(&request, &meshes)?;
            } else {
                self.start(&request, &meshes, is_other)?;
            }
            self.request = Some(request);
        }
        if !may_refine {
            return Ok(());
        }
        if let Some((frame, started)) = &mut self.in_flight {
            let time = slice(self.painting);
            if !frame.is_done() {
                self.renderers.active().advance(frame, time)?;
            }
            if frame.is_done() {
                self.elapsed = started.elapsed();
                for mut warning in self.renderers.active().unfinished_rays(frame)? {
                    warning.name =
                        editor.document().scene().node(warning.node).map_or(String::new(), |n| n.name.clone());
                    editor.report(Message::warning(format!("{}: {}", warning.name, warning.reason)));
                }
                self.complete();
            }
            ctx.request_repaint();
            self.painting_since = Some(Instant::now());
        } else if let (true, Some(RenderRequest { view, flat, .. })) =
            (self.needs_prewarm && !self.waiting, &self.request)
        {
            self.needs_prewarm = self.renderers.active().prewarm_pipelines(flat, &view.camera, AT_ONCE)?;
            if self.needs_prewarm || self.samples.wants_more(wanted) {
                ctx.request_repaint();
            }
        } else if self.samples.wants_more(wanted) && !navigating {
            self.samples.advance(self.renderers.active(), wanted, slice(self.painting))?;
            ctx.request_repaint();
            self.painting_since = Some(Instant::now());
        }
        Ok(())
    }

    /// The scene in this shading: the same arrays until one of them changes.
    fn shaded(&mut self, flat: &Arc<FlatScene>, shading: Shading) -> Arc<FlatScene> {
        if shading == Shading::Rendered {
            self.shaded = None;
            return Arc::clone(flat);
        }
        match &self.shaded {
            Some((of, by, shown)) if Arc::ptr_eq(of, flat) && *by == shading => Arc::clone(shown),
            _ => {
                let shown = flat.shaded(shading);
                self.shaded = Some((Arc::clone(flat), shading, Arc::clone(&shown)));
                shown
            }
        }
    }

    /// Whether the full picture is complete and only the grid, the outline or the view mode differ, and the hits at
    /// hand suffice for the new view mode.
    fn differs_in_marks_only(&self, request: &RenderRequest) -> bool {
        let complete = self.shown == Some(Slot::Full) && self.in_flight.is_none() && !self.waiting;
        let marked_alike = |shown: &RenderRequest| {
            let ViewSettings { show_grid, grid, show_outline, view_mode, .. } = shown.view;
            let view_mode =
                if view_mode.counts() == request.view.view_mode.counts() { view_mode } else { request.view.view_mode };
            let view = ViewSettings { show_grid, grid, show_outline, view_mode, ..request.view };
            RenderRequest { view, outline: shown.outline.clone(), ..request.clone() }
        };
        // The hits of a later sample are not those of the picture.
        let has_hits =
            |shown: &RenderRequest| !self.samples.has_accumulated() || shown.view.view_mode == request.view.view_mode;
        complete && self.request.as_ref().is_some_and(|shown| has_hits(shown) && *shown == marked_alike(shown))
    }

    /// Redraws the marks over the complete picture.
    fn restyle(&mut self, request: &RenderRequest, meshes: &[Option<Arc<TriangleMesh>>]) -> Result<(), RenderError> {
        let frame = self.begin(Slot::Full, request, meshes, request.view.size_px)?;
        let is_new = self.samples.count().is_none();
        let frame = self.samples.restyle(self.renderers.active(), frame)?;
        if !frame.is_lit() {
            self.samples.reset();
        } else if is_new {
            self.samples.start(frame);
        }
        self.show(Slot::Full);
        Ok(())
    }

    /// Whether shadows have become ready that the picture lacks.
    fn follow_shadows(&mut self, ctx: &egui::Context) -> bool {
        if self.renderers.active().awaits_shadows() {
            ctx.request_repaint_after(Duration::from_millis(200));
        }
        self.renderers.active().collect_shadows()
    }

    /// Polls pipelines and tapes in the making at a low rate, and reports failed pipelines.
    /// True when another one has become ready.
    fn follow_pipelines(&mut self, editor: &mut Editor, ctx: &egui::Context) -> bool {
        let tapes = self.renderers.plain.tape_cache();
        let mut news = tapes.collect();
        let failures = tapes.take_failures();
        if tapes.building() > 0 {
            ctx.request_repaint_after(Duration::from_millis(30));
        }
        let pipelines = self.renderers.plain.pipelines();
        let built = pipelines.collect();
        news |= built;
        self.needs_prewarm |= built;
        if built {
            // The status bar of this frame still counts it.
            ctx.request_repaint();
        }
        for failure in failures.into_iter().chain(pipelines.take_failures()) {
            editor.report(Message::warning(failure));
        }
        if pipelines.building() > 0 {
            // Painting slows down the threads that compile pipelines for a software driver.
            ctx.request_repaint_after(Duration::from_millis(if self.waiting { 200 } else { 1_000 }));
        }
        news
    }

    /// Begins the full picture, after a coarse one if the full one takes too long. If only the pipelines have changed,
    /// draws another coarse picture only if it is finer than the last and the full one has to wait.
    fn start(
        &mut self,
        request: &RenderRequest,
        meshes: &[Option<Arc<TriangleMesh>>],
        is_other: bool,
    ) -> Result<(), RenderError> {
        self.samples.reset();
        let ViewSettings { camera, size_px, .. } = request.view;
        let flat = &*request.flat;
        self.renderers.choose(request.view.view_mode)?;
        let full = self.renderers.active().estimate(flat, &camera, size_px)?;
        let started = Instant::now();
        let active = self.renderers.active();
        let pipelines_pay = full > WORTH_WAITING && active.pipelines_building() > 0;
        let tapes_pay = full > TAPES_WORTH_WAITING && active.tape_cache().building() > 0;
        self.waiting = full > AT_ONCE && (self.navigating || pipelines_pay || tapes_pay);
        let coarse = coarse_size(size_px, full, AT_ONCE);
        let is_finer = self.waiting && self.preview_size.is_some_and(|shown| coarse > shown);
        if full > AT_ONCE && (is_other || is_finer) {
            let mut frame = self.begin(Slot::Preview, request, meshes, coarse)?;
            self.preview_size = Some(coarse);
            self.renderers.active().advance(&mut frame, Duration::MAX)?;
            self.show(Slot::Preview);
        }
        if self.waiting {
            self.in_flight = None;
            return Ok(());
        }
        let mut frame = self.begin(Slot::Full, request, meshes, size_px)?;
        if full <= AT_ONCE {
            // Rays that have not ended can take much longer than the estimate.
            self.renderers.active().advance(&mut frame, 4 * AT_ONCE)?;
        }
        if frame.is_done() && self.renderers.active().unfinished_rays(&frame)?.is_empty() {
            self.elapsed = started.elapsed();
            self.in_flight = Some((frame, started));
            self.complete();
        } else {
            self.in_flight = Some((frame, started));
        }
        Ok(())
    }

    /// Shows the frame in flight, which is complete. If it is lit, its samples accumulate from now on.
    fn complete(&mut self) {
        let frame = self.in_flight.take().map(|(frame, _)| frame);
        if let Some(frame) = frame.filter(Frame::is_lit) {
            self.samples.start(frame);
        }
        self.show(Slot::Full);
    }

    /// Begins the picture of a request.
    fn begin(
        &mut self,
        slot: Slot,
        request: &RenderRequest,
        meshes: &[Option<Arc<TriangleMesh>>],
        size_px: [u32; 2],
    ) -> Result<Frame, RenderError> {
        let RenderRequest { view, flat, outline, .. } = request;
        let ViewSettings { camera, show_grid, grid, view_mode, passes, has_cut_offs, .. } = view;
        let GridView { axis, cell, fades } = grid;
        // Grid lines would falsify the colors of a view mode.
        let grid = *show_grid && *view_mode == ViewMode::Shaded;
        let shown_at = Some(request.view.size_px);
        let overlay = OverlaySettings {
            grid,
            plane: GridPlane { axis: *axis, cell: Some(*cell), fades: *fades },
            outline: outline.clone(),
            shown_at,
        };
        // Samples follow, and have the light of every pixel.
        let is_first_of_many = self.wanted > 1;
        let renderer = self.renderers.active();
        renderer.set_sparse_light(is_first_of_many);
        renderer.set_traced(TracedParts { passes: *passes, has_cut_offs: *has_cut_offs });
        let mut frame = renderer.begin(slot, flat, meshes, camera, size_px, overlay)?;
        if *view_mode != ViewMode::Shaded {
            renderer.debug_view(
                &mut frame,
                *view_mode,
                flat,
                &DepthRange::of(&flat.content(meshes), camera.position),
            )?;
        }
        Ok(frame)
    }

    /// Makes egui draw the picture in `slot`.
    fn show(&mut self, slot: Slot) {
        let Some((view, size)) = self.renderers.active().picture(slot) else { return };
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

/// Time for the picture in a frame of the window that took `painting` to paint.
fn slice(painting: Duration) -> Duration {
    painting.mul_f32(PER_PAINTING).clamp(PER_FRAME[0], PER_FRAME[1])
}

/// The selected nodes and their descendants.
fn with_descendants(editor: &Editor) -> Vec<NodeId> {
    let document = editor.document();
    let scene = document.scene();
    let ranges = document.selection().iter().filter_map(|id| scene.index_of(*id)).map(|i| scene.subtree(i));
    ranges.flat_map(|range| scene.nodes()[range].iter().map(|n| n.id)).collect()
}

/// Adapter, time of the last picture, pipelines in the making, failed pipelines.
fn status_text(adapter: &str, elapsed: Duration, building: usize, failed: usize) -> String {
    let mut text = format!("{adapter} · {:.0} ms", elapsed.as_secs_f64() * 1e3);
    if building > 0 {
        text += " · Preparing shaders…";
    }
    if failed > 0 {
        text += &format!(" · {failed} pipeline{} failed, interpreter in use", if failed == 1 { "" } else { "s" });
    }
    text
}

/// The adapter's name without a parenthesized suffix.
fn short_name(name: &str) -> &str {
    name.split(" (").next().unwrap_or(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn failed_pipelines_stay_in_the_status() {
        let text = |building, failed| status_text("card", Duration::from_millis(12), building, failed);
        assert_eq!(text(0, 0), "card · 12 ms");
        assert_eq!(text(2, 0), "card · 12 ms · Preparing shaders…");
        assert_eq!(text(0, 1), "card · 12 ms · 1 pipeline failed, interpreter in use");
        assert_eq!(text(1, 3), "card · 12 ms · Preparing shaders… · 3 pipelines failed, interpreter in use");
    }
}
