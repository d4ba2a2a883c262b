//! Pass `resolution`: which rays of a part with a resolution of its own are traced, and what the pixels between show. It
//! evaluates nothing, so one pipeline serves all components; types of instancers have another one.

use std::ops::Range;
use std::sync::OnceLock;

use wgpu::{BindGroup, BindGroupLayout, ComputePipeline, Device, TextureFormat};

use super::frame_pass::{Building, FramePass};
use crate::pipelines::field_buffers::FieldBuffers;
use crate::recipe::Pass;
use crate::renderer::recorder::Recorder;
use crate::renderer::resources::{Bound, SUBTILE_COUNTS};
use crate::resources::layouts::*;
use crate::resources::targets::Targets;
use isolith_wgsl::{ShaderError, assemble_featured};

bindings! {
    /// Group 2.
    ResolutionBindings, "resolution targets", COMPUTE {
        depth: read_write_texture(TextureFormat::R32Float),
        visibility: read_write_texture(TextureFormat::R32Uint),
        march: write_texture(TextureFormat::R32Float),
        hiz: write_texture(TextureFormat::R32Float),
        subtiles: write_storage(),
        subtile_counts: read_storage(),
        rays: write_storage(),
        ray_counts: write_storage(),
    }
}

bindings! {
    /// The same over copies.
    ResolutionCopiesBindings, "resolution targets with copies", COMPUTE {
        depth: read_write_texture(TextureFormat::R32Float),
        visibility: read_write_texture(TextureFormat::R32Uint),
        march: write_texture(TextureFormat::R32Float),
        hiz: write_texture(TextureFormat::R32Float),
        subtiles: write_storage(),
        subtile_counts: read_storage(),
        rays: write_storage(),
        ray_counts: write_storage(),
        copied: write_storage(),
    }
}

/// The pass. Of each pair the second one is for types of instancers.
#[derive(Debug)]
pub struct ResolutionPass {
    /// Built on first use: few scenes have such parts.
    pipelines: [OnceLock<ComputePipeline>; 2],
    device: Device,
    texts: [String; 2],
    /// The layouts of the groups around the targets.
    around: [BindGroupLayout; 3],
    /// Group 1, which is empty.
    scene: BindGroup,
    targets: [BindGroupLayout; 2],
}

impl ResolutionPass {
    fn pipeline(&self, own: usize) -> &ComputePipeline {
        self.pipelines[own].get_or_init(|| {
            let [view, nothing, dispatch_params] = &self.around;
            let groups = [view, nothing, &self.targets[own], dispatch_params];
            compute_pipeline(
                &self.device,
                Pass::Resolution.label(),
                self.texts[own].clone(),
                "resolution_pass",
                &groups,
            )
        })
    }

    fn bind_plain(&self, device: &wgpu::Device, targets: &Targets, lists: FieldBuffers<'_>) -> BindGroup {
        let group = ResolutionBindings {
            depth: targets.depth.binding(),
            visibility: targets.visibility.binding(),
            march: targets.march.binding(),
            hiz: targets.hiz.binding(),
            subtiles: lists.subtiles.as_entire_binding(),
            subtile_counts: lists.subtile_counts.as_entire_binding(),
            rays: lists.rays.as_entire_binding(),
            ray_counts: lists.ray_counts.as_entire_binding(),
        };
        group.bind(device, &self.targets[0])
    }

    fn bind_copies(
        &self,
        device: &wgpu::Device,
        targets: &Targets,
        lists: FieldBuffers<'_>,
        copied: &wgpu::Buffer,
    ) -> BindGroup {
        let group = ResolutionCopiesBindings {
            depth: targets.depth.binding(),
            visibility: targets.visibility.binding(),
            march: targets.march.binding(),
            hiz: targets.hiz.binding(),
            subtiles: lists.subtiles.as_entire_binding(),
            subtile_counts: lists.subtile_counts.as_entire_binding(),
            rays: lists.rays.as_entire_binding(),
            ray_counts: lists.ray_counts.as_entire_binding(),
            copied: copied.as_entire_binding(),
        };
        group.bind(device, &self.targets[1])
    }
}

impl FramePass for ResolutionPass {
    fn new(Building { device, layouts, .. }: Building<'_>) -> Result<Self, ShaderError> {
        let nothing = layout(device, "nothing", &[]);
        let targets = [ResolutionBindings::layout(device), ResolutionCopiesBindings::layout(device)];
        let text = |features: &[&str]| assemble_featured(Pass::Resolution.file(), features);
        Ok(Self {
            pipelines: Default::default(),
            device: device.clone(),
            texts: [text(&[])?, text(&["COPIES"])?],
            scene: bind(device, "nothing", &nothing, &[]),
            around: [layouts.view.clone(), nothing, layouts.dispatch_params.clone()],
            targets,
        })
    }

    fn bind(&self, device: &wgpu::Device, bound: &Bound<'_>) -> Vec<BindGroup> {
        let (targets, lists) = (bound.targets, bound.resources.lists());
        let of_copies = targets.copied.as_ref().map(|copied| self.bind_copies(device, targets, lists, copied));
        std::iter::once(self.bind_plain(device, targets, lists)).chain(of_copies).collect()
    }

    fn record(&self, recorder: &mut Recorder<'_>, dispatches: Range<usize>) {
        for at in dispatches {
            let dispatch = &recorder.frame.plan.dispatches[at];
            let list = dispatch.params.list as usize;
            let own = usize::from(recorder.frame.is_of_copies(dispatch));
            let counts = recorder.resources.subtile_counts.buffer();
            let [_, targets] = recorder.groups(own);
            let pass = recorder.compute(at);
            pass.set_pipeline(self.pipeline(own));
            pass.set_bind_group(1, &self.scene, &[]);
            pass.set_bind_group(2, targets, &[]);
            pass.dispatch_workgroups_indirect(counts, (list * SUBTILE_COUNTS) as u64 * 4);
        }
    }
}
