//! What the passes that evaluate a component leave to each other.

/// Buffers that carry data from pass to pass.
#[derive(Clone, Copy, Debug)]
pub struct FieldBuffers<'a> {
    /// Subtiles that the cones keep, list after list; then the subtiles with hits.
    pub subtiles: &'a wgpu::Buffer,
    /// For each list the arguments of its indirect dispatch, and its length.
    pub subtile_counts: &'a wgpu::Buffer,
    /// Pixels whose march continues, list after list.
    pub rays: &'a wgpu::Buffer,
    /// For each list the arguments of its indirect dispatches over these pixels, and over subtiles with hits.
    pub ray_counts: &'a wgpu::Buffer,
    /// Placeholder: any other buffer.
    pub nothing: &'a wgpu::Buffer,
    /// Counters, see `shaders/common/counts.wgsl`.
    pub march_counts: &'a wgpu::Buffer,
}
