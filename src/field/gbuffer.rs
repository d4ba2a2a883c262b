//! The picture as arrays, as the reference renderer and the renderer's read-back deliver it.

/// The pixels of a picture, row by row from the upper left corner.
#[derive(Clone, Debug, PartialEq)]
pub struct GBuffer {
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Distance along the ray, in meters; [`BACKGROUND_DEPTH`] where nothing is hit.
    pub depth: Vec<f32>,
    /// The hit: an index into [`super::FlatScene::nodes`], or [`MESH_BIT`] with an index into
    /// [`super::FlatScene::meshes`], or [`NO_LEAF`]. See [`HitTarget`].
    pub leaf: Vec<u32>,
    /// Unit world normal; zero where nothing is hit.
    pub normal: Vec<[f32; 3]>,
    /// sRGB and alpha; the background is opaque too, unless it is left out.
    pub color: Vec<[u8; 4]>,
    /// Linear light before exposure and view transform, multiplied by coverage, and coverage; empty unless samples were
    /// accumulated.
    pub radiance: Vec<[f32; 4]>,
}

/// No hit.
pub const NO_LEAF: u32 = u32::MAX;
/// The flag of mesh hits.
pub const MESH_BIT: u32 = 1 << 31;
/// The depth of pixels without a hit.
pub const BACKGROUND_DEPTH: f32 = f32::INFINITY;

/// The hit of a pixel, decoded from [`GBuffer::leaf`].
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
    /// Decodes a number of [`GBuffer::leaf`].
    pub fn from_code(code: u32) -> Self {
        match code {
            NO_LEAF => Self::Background,
            code if code & MESH_BIT != 0 => Self::Mesh((code & !MESH_BIT) as usize),
            code => Self::Leaf(code as usize),
        }
    }
}

impl GBuffer {
    /// A black picture without hits.
    pub fn empty(width: u32, height: u32) -> Self {
        let pixels = width as usize * height as usize;
        Self {
            width,
            height,
            depth: vec![BACKGROUND_DEPTH; pixels],
            leaf: vec![NO_LEAF; pixels],
            normal: vec![[0.0; 3]; pixels],
            color: vec![[0, 0, 0, 255]; pixels],
            radiance: Vec::new(),
        }
    }

    /// Index of the pixel in the arrays.
    pub fn index(&self, x: u32, y: u32) -> usize {
        y as usize * self.width as usize + x as usize
    }

    /// The hit of the pixel at `index`.
    pub fn hit_target(&self, index: usize) -> HitTarget {
        HitTarget::from_code(self.leaf[index])
    }
}
