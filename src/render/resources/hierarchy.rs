//! Input of the scene evaluator in `shaders/scene/`: the hierarchy over the components, and the components relative to
//! the origin of the query. Only passes that query the scene create these resources.

use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Vec3};
use wgpu::{BindGroup, BindGroupLayout, ShaderStages};

use crate::frame::plan::MAX_ITERATIONS;
use crate::gpu::Gpu;
use crate::resources::buffers::SyncedBuffer;
use crate::resources::layouts::{entry, layout, read_storage, uniform};
use crate::resources::uniforms::{GpuComponent, UNBOUNDED};
use isolith_field::FlatScene;
use isolith_field::hierarchy::{Hierarchy, HierarchyNode};
use isolith_field::standpoint::Standpoint;

/// In the link of a leaf: it is for all copies of an instancer, whose index the other bits are.
pub const COPIES_LINK: u32 = 1 << 31;

/// A node of the hierarchy. Its box is relative to the origin of the query.
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
    /// The node relative to `origin`. Rounding must never cut a component off.
    fn new(node: &HierarchyNode, origin: DVec3) -> Self {
        let bounds = node.bounds.translated(-origin);
        let reach = bounds.min.abs().max(bounds.max.abs()).max_element();
        let bounds = bounds.expanded(reach * 4.0 * f64::from(f32::EPSILON) + 1e-9);
        let clamp = |v: Vec3| v.clamp(Vec3::splat(-UNBOUNDED), Vec3::splat(UNBOUNDED)).to_array();
        let (low, high) = (clamp(bounds.min.as_vec3()), clamp(bounds.max.as_vec3()));
        Self { low, link: node.link, high, axis: node.axis }
    }

    /// A leaf for a component without bounds.
    fn unbounded(component: u32) -> Self {
        let axis = HierarchyNode::LEAF;
        Self { low: [-UNBOUNDED; 3], link: component, high: [UNBOUNDED; 3], axis }
    }
}

/// Sizes of the hierarchy, and limits of one invocation in a dispatch.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
pub struct SceneLimits {
    /// Number of nodes of the tree.
    pub tree_nodes: u32,
    /// Number of nodes including the leaves of components without bounds.
    pub all_nodes: u32,
    /// Limit of evaluations of components' fields.
    pub max_evaluations: u32,
    /// Limit of visited nodes.
    pub max_visits: u32,
}

/// Limit of node visits of one invocation in a dispatch. A ray that needs more to find one component is reported. A
/// tree of half as many components has no such ray.
pub const MAX_VISITS: u32 = 20_000;
/// A march needs two evaluations to advance.
const LEAST_EVALUATIONS: u32 = 2;

impl SceneLimits {
    /// Limits for a scene in which evaluating a component takes at most `iterations` loop iterations. The driver counts
    /// all loops of an invocation together.
    pub fn new(hierarchy: &Hierarchy, iterations: u32) -> Self {
        let tree_nodes = hierarchy.nodes.len() as u32;
        let all_nodes = tree_nodes + hierarchy.unbounded.len() as u32;
        let max_evaluations = ((MAX_ITERATIONS - MAX_VISITS) / iterations.max(1)).max(LEAST_EVALUATIONS);
        Self { tree_nodes, all_nodes, max_evaluations, max_visits: MAX_VISITS }
    }
}

/// The components of a scene relative to the origin of a query. `standpoints` is parallel to the components; it is
/// empty if all rows are relative to the origins of their components.
pub fn query_components(flat: &FlatScene, origin: DVec3, standpoints: &[Standpoint]) -> Vec<GpuComponent> {
    let at_origin = Standpoint::at_origin();
    let translucency = flat.translucency();
    let all = flat.components.iter().enumerate().map(|(i, component)| {
        let at = standpoints.get(i).unwrap_or(&at_origin);
        // In narrow pictures the eye lies elsewhere, but a query has one origin for all components.
        // Points are mapped to the space of a copy.
        let origin = if component.instanced.is_some() { DVec3::ZERO } else { origin };
        let eye = origin - component.origin - at.shift;
        let translucency = translucency.get(i).map_or(0.0, |share| *share as f32);
        GpuComponent { translucency, ..GpuComponent::new(component, &Standpoint { ray_origin_depth: 0.0, eye, ..*at }) }
    });
    all.collect()
}

/// What rays and cones meet besides components.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Obstacles {
    /// Meshes.
    pub meshes: bool,
    /// Copies of instancers.
    pub copies: bool,
}

/// The buffers of group 3 for passes that query the scene.
#[derive(Debug)]
pub struct HierarchyBuffers {
    nodes: SyncedBuffer,
    components: SyncedBuffer,
    limits: SyncedBuffer,
}

impl HierarchyBuffers {
    /// The layout of the buffers, and of what rays and cones meet besides components.
    pub fn layout(device: &wgpu::Device, Obstacles { meshes, copies }: Obstacles) -> BindGroupLayout {
        let types = [Some(read_storage()), Some(read_storage()), Some(uniform(false))];
        let others = [meshes.then(read_storage), copies.then(read_storage), copies.then(read_storage)];
        let all = types.into_iter().chain(others).enumerate();
        let entries = all.filter_map(|(i, ty)| Some(entry(i as u32, ShaderStages::COMPUTE, ty?)));
        layout(device, "hierarchy", &entries.collect::<Vec<_>>())
    }

    /// Empty buffers.
    pub fn new(device: &wgpu::Device) -> Self {
        Self {
            nodes: SyncedBuffer::storage(device, "hierarchy"),
            components: SyncedBuffer::storage(device, "components of queries"),
            limits: SyncedBuffer::uniform(device, "limits of queries"),
        }
    }

    /// Uploads changed data. Returns whether bind groups must be rebuilt.
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

    /// Bind group of the buffers, of that of the meshes, and of those of the instancers and their places.
    pub fn bind(
        &self,
        device: &wgpu::Device,
        layout: &BindGroupLayout,
        meshes: Option<wgpu::BindingResource<'_>>,
        copies: Option<[wgpu::BindingResource<'_>; 2]>,
    ) -> BindGroup {
        let own = [self.nodes.binding(), self.components.binding(), self.limits.binding()];
        let [instancers, places] = copies.map_or([None, None], |copies| copies.map(Some));
        let all = own.into_iter().map(Some).chain([meshes, instancers, places]).enumerate();
        let entries: Vec<_> = all
            .filter_map(|(i, resource)| Some(wgpu::BindGroupEntry { binding: i as u32, resource: resource? }))
            .collect();
        device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some("hierarchy"), layout, entries: &entries })
    }
}
