//! The picture as arrays: what the reference tracer and the renderer's read-back both deliver.

/// What the pixels show, row by row from the upper left corner.
#[derive(Clone, Debug, PartialEq)]
pub struct GBuffer {
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Distance along the ray, in meters; [`BACKGROUND_DEPTH`] where nothing is hit.
    pub depth: Vec<f32>,
    /// What is hit: an index into [`super::FlatScene::nodes`], or [`MESH_BIT`] with an index into
    /// [`super::FlatScene::meshes`], or [`NO_LEAF`]. See [`HitTarget`].
    pub leaf: Vec<u32>,
    /// Unit world normal; zero where nothing is hit.
    pub normal: Vec<[f32; 3]>,
    /// sRGB and alpha; the background is opaque too.
    pub color: Vec<[u8; 4]>,
}

/// Nothing is hit.
pub const NO_LEAF: u32 = u32::MAX;
/// Set where a mesh is hit.
pub const MESH_BIT: u32 = 1 << 31;
/// The depth where nothing is hit.
pub const BACKGROUND_DEPTH: f32 = f32::INFINITY;

/// What a pixel shows, read from [`GBuffer::leaf`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HitTarget {
    /// Nothing.
    Background,
    /// A leaf: index into [`super::FlatScene::nodes`].
    Leaf(usize),
    /// A mesh: index into [`super::FlatScene::meshes`].
    Mesh(usize),
}

impl HitTarget {
    /// From the number in [`GBuffer::leaf`].
    pub fn from_code(code: u32) -> Self {
        match code {
            NO_LEAF => Self::Background,
            code if code & MESH_BIT != 0 => Self::Mesh((code & !MESH_BIT) as usize),
            code => Self::Leaf(code as usize),
        }
    }
}

impl GBuffer {
    /// A picture of nothing, in black.
    pub fn empty(width: u32, height: u32) -> Self {
        let pixels = width as usize * height as usize;
        Self {
            width,
            height,
            depth: vec![BACKGROUND_DEPTH; pixels],
            leaf: vec![NO_LEAF; pixels],
            normal: vec![[0.0; 3]; pixels],
            color: vec![[0, 0, 0, 255]; pixels],
        }
    }

    /// Where the pixel stands in the arrays.
    pub fn index(&self, x: u32, y: u32) -> usize {
        y as usize * self.width as usize + x as usize
    }

    /// What the pixel at `index` shows.
    pub fn hit_target(&self, index: usize) -> HitTarget {
        HitTarget::from_code(self.leaf[index])
    }
}
