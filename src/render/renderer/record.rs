//! Writes the dispatches of a frame down and hands them to the device.

use super::upload::Groups;
use super::{CONE_GROUP, Frame, QUAD_COUNTS, RAY_COUNTS, Renderer, SlotState};
use crate::render::schedule::{Piece, QUADS, Stage, TILE};
use crate::render::uniforms::UNIFORM_STRIDE;

impl Renderer {
    pub(super) fn submit(&self, frame: &Frame, range: std::ops::Range<usize>) {
        let SlotState { targets, groups } = self.slot(frame.slot);
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
                self.overlay.record(&self.gpu.device, &mut encoder, targets, &groups.view, &frame.plan);
            }
        }
        self.gpu.queue.submit([encoder.finish()]);
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
        let (pipeline, targets) = match piece.stage {
            Stage::Cone => (&kernel.cone, &groups.field.cone),
            Stage::Trace if piece.work.packed == 1 => (&kernel.trace, &groups.field.packed),
            Stage::Trace => (&kernel.trace, &groups.field.trace),
            Stage::Surface => (&kernel.surface, &groups.field.surface),
            Stage::Mesh | Stage::Farthest | Stage::Shade => unreachable!("the caller records these"),
        };
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
