//! What the scene evaluator of `shaders/scene/` reads: the hierarchy over the components, and the components as they stand to
//! the origin of the query. Whoever needs it makes it; a frame without such a pass has none of it.

use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Vec3};
use wgpu::{BindGroup, BindGroupLayout, ShaderStages};

use crate::frame::plan::MAX_ITERATIONS;
use crate::gpu::Gpu;
use crate::resources::buffers::SyncedBuffer;
use crate::resources::layouts::{bind, entry, layout, read_storage, uniform};
use crate::resources::uniforms::{GpuComponent, UNBOUNDED};
use isolith_field::FlatScene;
use isolith_field::hierarchy::{Hierarchy, HierarchyNode};
use isolith_field::standpoint::Standpoint;

/// A node of the hierarchy; its box is relative to the origin of the query.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct GpuHierarchyNode {
    /// Lower corner.
    pub low: [f32; 3],
    /// See [`HierarchyNode::link`].
    pub link: u32,
    /// Upper corner.
    pub high: [f32; 3],
    /// See [`HierarchyNode::axis`].
    pub axis: u32,
}

impl GpuHierarchyNode {
    /// Relative to `origin`. Rounding must never cut a component off.
    fn new(node: &HierarchyNode, origin: DVec3) -> Self {
        let bounds = node.bounds.translated(-origin);
        let reach = bounds.min.abs().max(bounds.max.abs()).max_element();
        let bounds = bounds.expanded(reach * 4.0 * f64::from(f32::EPSILON) + 1e-9);
        let clamp = |v: Vec3| v.clamp(Vec3::splat(-UNBOUNDED), Vec3::splat(UNBOUNDED)).to_array();
        let (low, high) = (clamp(bounds.min.as_vec3()), clamp(bounds.max.as_vec3()));
        Self { low, link: node.link, high, axis: node.axis }
    }

    /// A component without bounds.
    fn unbounded(component: u32) -> Self {
        let axis = HierarchyNode::LEAF;
        Self { low: [-UNBOUNDED; 3], link: component, high: [UNBOUNDED; 3], axis }
    }
}

/// What there is, and what one invocation may do in a dispatch.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
pub struct SceneLimits {
    /// Nodes of the tree.
    pub tree_nodes: u32,
    /// Those, and leaves for components without bounds.
    pub all_nodes: u32,
    /// Evaluations of the field of a component.
    pub max_evaluations: u32,
    /// Nodes that are visited.
    pub max_visits: u32,
}

/// Visits of nodes that one invocation may do in a dispatch. A ray that would have to visit more to find one component is
/// reported; a tree of half as many components has no such ray.
pub const MAX_VISITS: u32 = 20_000;
/// A march needs two evaluations to get on.
const LEAST_EVALUATIONS: u32 = 2;

impl SceneLimits {
    /// For a scene in which evaluating a component takes at most so many loop iterations. The driver counts all loops of an
    /// invocation together.
    pub fn new(hierarchy: &Hierarchy, iterations: u32) -> Self {
        let tree_nodes = hierarchy.nodes.len() as u32;
        let all_nodes = tree_nodes + hierarchy.unbounded.len() as u32;
        let max_evaluations = ((MAX_ITERATIONS - MAX_VISITS) / iterations.max(1)).max(LEAST_EVALUATIONS);
        Self { tree_nodes, all_nodes, max_evaluations, max_visits: MAX_VISITS }
    }
}

/// The components of a scene as they stand to the origin of a query. `standpoints` say relative to which points their rows
/// are; they stand beside the components, or there are none where all rows are relative to their components' origins.
pub fn query_components(flat: &FlatScene, origin: DVec3, standpoints: &[Standpoint]) -> Vec<GpuComponent> {
    let at_origin = Standpoint::at_origin();
    let all = flat.components.iter().enumerate().map(|(i, component)| {
        let at = standpoints.get(i).unwrap_or(&at_origin);
        // In narrow pictures the eye stands elsewhere; a query has one origin for all.
        let eye = origin - component.origin - at.shift;
        GpuComponent::new(component, &Standpoint { ray_origin_depth: 0.0, eye, ..*at })
    });
    all.collect()
}

/// The buffers of group 3 of passes that ask the scene.
#[derive(Debug)]
pub struct HierarchyBuffers {
    nodes: SyncedBuffer,
    components: SyncedBuffer,
    limits: SyncedBuffer,
}

impl HierarchyBuffers {
    /// Their layout.
    pub fn layout(device: &wgpu::Device) -> BindGroupLayout {
        let types = [read_storage(), read_storage(), uniform(false)];
        let entries: Vec<_> =
            types.into_iter().enumerate().map(|(i, ty)| entry(i as u32, ShaderStages::COMPUTE, ty)).collect();
        layout(device, "hierarchy", &entries)
    }

    /// Empty ones.
    pub fn new(device: &wgpu::Device) -> Self {
        Self {
            nodes: SyncedBuffer::storage(device, "hierarchy"),
            components: SyncedBuffer::storage(device, "components of queries"),
            limits: SyncedBuffer::uniform(device, "limits of queries"),
        }
    }

    /// Uploads what has changed. Returns whether bind groups must be made anew.
    pub fn set(
        &mut self,
        gpu: &Gpu,
        hierarchy: &Hierarchy,
        origin: DVec3,
        components: &[GpuComponent],
        limits: SceneLimits,
    ) -> bool {
        let tree = hierarchy.nodes.iter().map(|node| GpuHierarchyNode::new(node, origin));
        let nodes: Vec<_> = tree.chain(hierarchy.unbounded.iter().copied().map(GpuHierarchyNode::unbounded)).collect();
        let set = |buffer: &mut SyncedBuffer, bytes: &[u8]| buffer.set(&gpu.device, &gpu.queue, bytes);
        let grown = [
            set(&mut self.nodes, bytemuck::cast_slice(&nodes)),
            set(&mut self.components, bytemuck::cast_slice(components)),
            set(&mut self.limits, bytemuck::bytes_of(&limits)),
        ];
        grown.contains(&true)
    }

    /// Binds them.
    pub fn bind(&self, device: &wgpu::Device, layout: &BindGroupLayout) -> BindGroup {
        bind(device, "hierarchy", layout, &[self.nodes.binding(), self.components.binding(), self.limits.binding()])
    }
}
