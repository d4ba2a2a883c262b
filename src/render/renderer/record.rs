//! Writes the dispatches of a frame down and hands them to the device.

use std::time::{Duration, Instant};

use super::upload::Groups;
use super::{CONE_GROUP, Frame, QUAD_COUNTS, RAY_COUNTS, RenderError, Renderer, SlotState};
use crate::flat::FlatScene;
use crate::geometry::Camera;
use crate::render::kernels::Choice;
use crate::render::passes::field::Kernel;
use crate::render::schedule::{Piece, QUADS, Stage, TILE};
use crate::render::uniforms::UNIFORM_STRIDE;

impl Renderer {
    pub(super) fn submit(&self, frame: &Frame, range: std::ops::Range<usize>) {
        let SlotState { targets, enlarged, groups } = self.slot(frame.slot);
        let groups = groups.as_ref().expect("begin binds");
        let descriptor = wgpu::CommandEncoderDescriptor { label: Some("frame") };
        let mut encoder = self.gpu.device.create_command_encoder(&descriptor);
        let pieces = &frame.plan.pieces;
        let mut at = range.start;
        while at < range.end {
            // One of them after the other, as far as they are recorded in one pass.
            let is_alike = |stage| matches!(stage, Stage::Mesh | Stage::Shade).then_some(stage);
            let kind = is_alike(pieces[at].stage);
            let end = (at..range.end).find(|i| is_alike(pieces[*i].stage) != kind).unwrap_or(range.end);
            match kind {
                Some(Stage::Mesh) => {
                    // No ray is left over yet.
                    encoder.clear_buffer(self.rays.buffer(), 0, Some(u64::from(frame.plan.lists.max(1)) * 4));
                    self.clear_pixel_counts(&mut encoder, targets.size);
                    self.mesh.record(&mut encoder, targets, &groups.view);
                }
                Some(_) => {
                    let own = [&groups.view, &groups.lights, &groups.shade];
                    self.shade.record(&mut encoder, &targets.color.view, own, pieces[at..end].iter());
                }
                None => self.record_compute(&mut encoder, groups, frame, at..end),
            }
            at = end;
        }
        if range.end == pieces.len() {
            self.record_look(&mut encoder, frame);
            if !frame.overlay.is_empty() {
                let (device, enlarged) = (&self.gpu.device, enlarged.as_ref());
                self.overlay.record(device, &mut encoder, targets, enlarged, &groups.view, &frame.plan);
            }
        }
        self.gpu.queue.submit([encoder.finish()]);
    }

    /// Dispatches kernels that have become ready over nothing, for this long: lavapipe compiles a kernel, or reads what it
    /// has compiled, when it meets it, which would hold up the next picture. Whether there are more.
    pub fn meet_kernels(&mut self, flat: &FlatScene, camera: &Camera, time: Duration) -> Result<bool, RenderError> {
        if !self.gpu.is_software() {
            return Ok(false);
        }
        let (start, mut has_met) = (Instant::now(), false);
        let choices = self.choose(flat, camera)?.choices;
        let Some(groups) = self.slots.iter().flatten().find_map(|slot| slot.groups.as_ref()) else { return Ok(false) };
        for Choice { kernel, .. } in choices {
            if has_met && start.elapsed() > time {
                return Ok(true);
            }
            let mut fresh = [Stage::Cone, Stage::Trace, Stage::Surface].to_vec();
            fresh.retain(|stage| kernel.first_use(*stage as usize));
            if fresh.is_empty() {
                continue;
            }
            has_met = true;
            let mut encoder = self.gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_bind_group(0, &groups.view, &[]);
            pass.set_bind_group(1, &groups.scene, &[0, 0]);
            pass.set_bind_group(3, &groups.work, &[0]);
            for stage in fresh {
                let (pipeline, targets) = of_field(&kernel, groups, stage, false);
                pass.set_pipeline(pipeline);
                pass.set_bind_group(2, targets, &[]);
                pass.dispatch_workgroups(0, 0, 0);
            }
            drop(pass);
            self.gpu.queue.submit([encoder.finish()]);
            self.gpu.wait()?;
        }
        Ok(false)
    }

    fn record_compute(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        groups: &Groups,
        frame: &Frame,
        range: std::ops::Range<usize>,
    ) {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_bind_group(0, &groups.view, &[]);
        for at in range {
            let piece = &frame.plan.pieces[at];
            pass.set_bind_group(3, &groups.work, &[(at * UNIFORM_STRIDE) as u32]);
            match piece.stage {
                Stage::Farthest => {
                    pass.set_pipeline(self.farthest.pipeline());
                    pass.set_bind_group(1, self.farthest.scene(), &[]);
                    pass.set_bind_group(2, &groups.farthest, &[]);
                }
                _ => {
                    self.record_field(&mut pass, groups, frame, piece);
                    continue;
                }
            }
            let [x, y] = if piece.stage == Stage::Farthest {
                piece.tiles().map(|tiles| (tiles * QUADS).div_ceil(TILE))
            } else {
                piece.tiles()
            };
            pass.dispatch_workgroups(x, y, 1);
        }
    }

    /// A pass over one component.
    fn record_field(&self, pass: &mut wgpu::ComputePass<'_>, groups: &Groups, frame: &Frame, piece: &Piece) {
        let component = piece.work.component as usize;
        let kernel = &frame.choices[component].kernel;
        let (pipeline, targets) = of_field(kernel, groups, piece.stage, piece.work.packed == 1);
        pass.set_pipeline(pipeline);
        let subject = (component * UNIFORM_STRIDE) as u32;
        match frame.form_window(component) {
            Some(window) => pass.set_bind_group(1, &groups.forms, &[subject, window]),
            None => pass.set_bind_group(1, &groups.scene, &[subject, frame.rows[component]]),
        }
        pass.set_bind_group(2, targets, &[]);
        if piece.stage == Stage::Cone {
            let [x, y] = piece.tiles();
            pass.dispatch_workgroups((x * y).div_ceil(CONE_GROUP), 1, 1);
        } else {
            let list = piece.work.list as usize;
            let (counts, word) = match (piece.stage, piece.work.packed) {
                (Stage::Surface, _) => (&self.ray_counts, list * RAY_COUNTS + 3),
                (_, 1) => (&self.ray_counts, list * RAY_COUNTS),
                _ => (&self.quad_counts, list * QUAD_COUNTS),
            };
            pass.dispatch_workgroups_indirect(counts.buffer(), word as u64 * 4);
        }
    }
}

/// The pipeline and the targets of a pass over a component.
fn of_field<'g>(
    kernel: &'g Kernel,
    groups: &'g Groups,
    stage: Stage,
    packed: bool,
) -> (&'g wgpu::ComputePipeline, &'g wgpu::BindGroup) {
    match stage {
        Stage::Cone => (&kernel.cone, &groups.field.cone),
        Stage::Trace if packed => (&kernel.trace, &groups.field.packed),
        Stage::Trace => (&kernel.trace, &groups.field.trace),
        Stage::Surface => (&kernel.surface, &groups.field.surface),
        Stage::Mesh | Stage::Farthest | Stage::Shade => unreachable!("these evaluate no field"),
    }
}

#[cfg(test)]
mod tests {
    use super::super::Slot;
    use super::*;
    use crate::flat::flatten;
    use crate::gallery;
    use crate::render::kernels::Walk;
    use crate::render::{Gpu, OverlaySettings};

    #[test]
    fn kernels_that_were_met_are_not_met_first_by_a_picture() {
        let gpu = Gpu::headless().unwrap_or_else(|error| panic!("{error}"));
        let flat = flatten(&gallery::random(32, 3), 0.0).expect("within the limits");
        let camera = flat.default_camera(&[], 1.0);
        let is_fresh = |met: bool| {
            let mut renderer = Renderer::new(&gpu).unwrap_or_else(|error| panic!("{error}"));
            let mut begin = || {
                let frame = renderer.begin(Slot::Full, &flat, &[], &camera, [40, 40], OverlaySettings::default());
                (frame.expect("a frame"), renderer.is_preparing())
            };
            while begin().1 {
                std::thread::sleep(Duration::from_millis(10));
            }
            let (frame, _) = begin();
            // One after the other, as between two paintings of the window.
            while met && renderer.meet_kernels(&flat, &camera, Duration::ZERO).expect("a device that answers") {}
            assert!(frame.choices.iter().any(|choice| choice.walk == Walk::Straight));
            frame.uses_fresh_kernel(0..frame.plan.pieces.len())
        };
        assert!(is_fresh(false));
        // Elsewhere drivers compile when a kernel is built.
        assert_eq!(is_fresh(true), !gpu.is_software());
    }
}
