//! Primitives: from attributes to triangles in the file's space.

use std::collections::HashMap;
use std::path::Path;
use std::sync::OnceLock;

use glam::{DAffine3, DMat3, DVec3};
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked;
use gltf::json::{Index, accessor, image, texture};

use super::accessor::Source;
use super::error::Refusal;
use super::limits::{MAX_COORDINATE, MAX_TEXTURE_BYTES, MAX_TRIANGLES, MAX_VERTICES};
use super::resolve::read_uri;
use super::texture::{Place, decode, place_of};
use super::{Part, TriangleMesh};
use crate::geometry::Aabb;

/// Writes primitives into one mesh, one after the other.
pub(super) struct Writer<'a> {
    source: &'a Source<'a>,
    folder: Option<&'a Path>,
    mesh: TriangleMesh,
    /// Which of the mesh's textures an image has become.
    texture_of: HashMap<usize, usize>,
    texture_budget: u64,
}

/// What a primitive says of its surface.
struct Surface {
    factor: [f32; 3],
    texture: Option<usize>,
    uv_set: u32,
}

impl<'a> Writer<'a> {
    pub fn new(source: &'a Source<'a>, folder: Option<&'a Path>) -> Self {
        let mesh = TriangleMesh {
            positions: Vec::new(),
            normals: Vec::new(),
            colors: Vec::new(),
            uvs: Vec::new(),
            indices: Vec::new(),
            parts: Vec::new(),
            textures: Vec::new(),
            bounds: Aabb::EMPTY,
            bvh: OnceLock::new(),
        };
        Self { source, folder, mesh, texture_of: HashMap::new(), texture_budget: MAX_TEXTURE_BYTES }
    }

    pub fn finish(mut self) -> TriangleMesh {
        let corners = self.mesh.indices.iter().map(|i| self.mesh.positions[*i as usize]);
        self.mesh.bounds = Aabb::from_points(corners.map(|p| DVec3::from(p.map(f64::from))));
        self.mesh
    }

    /// Adds a primitive as it stands in the world. Points and lines have no surface and are left out.
    pub fn add(&mut self, primitive: &Primitive, world_from_local: &DAffine3, place: &str) -> Result<(), Refusal> {
        let Checked::Valid(mode) = primitive.mode else {
            return Err(Refusal::at(format!("{place}.mode"), "is not known"));
        };
        if !matches!(mode, Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan) {
            return Ok(());
        }
        let surface = self.surface(primitive, place)?;
        let positions = self.positions(primitive, world_from_local, place)?;
        let triangles = self.triangles(primitive, mode, positions.len(), world_from_local, place)?;
        let colors = self.colors(primitive, surface.factor, positions.len(), place)?;
        let uvs = self.uvs(primitive, &surface, positions.len(), place)?;
        let normals = self.normals(primitive, world_from_local, positions.len(), place)?;
        let first_index = self.mesh.indices.len() as u32;
        match normals {
            Some(normals) => {
                self.reserve(positions.len(), triangles.len(), place)?;
                let base = self.mesh.positions.len() as u32;
                self.mesh.indices.extend(triangles.iter().flatten().map(|v| base + v));
                self.mesh.normals.extend(mended_normals(&positions, &triangles, normals));
                self.mesh.positions.extend(positions);
                self.mesh.colors.extend(colors);
                self.mesh.uvs.extend(uvs);
            }
            // Without normals a surface is flat-shaded (specification, 3.7.2.1): no vertex is shared.
            None => {
                self.reserve(triangles.len() * 3, triangles.len(), place)?;
                for triangle in &triangles {
                    let corners = triangle.map(|v| v as usize);
                    let normal = face_normal(corners.map(|v| positions[v])).unwrap_or(DVec3::Y);
                    for v in corners {
                        self.mesh.indices.push(self.mesh.positions.len() as u32);
                        self.mesh.positions.push(positions[v]);
                        self.mesh.normals.push(normal.as_vec3().to_array());
                        self.mesh.colors.push(colors[v]);
                        self.mesh.uvs.push(uvs[v]);
                    }
                }
            }
        }
        self.add_part(first_index, surface.texture);
        Ok(())
    }

    /// The run from `first_index` to the end; joined to the run before where the texture is the same.
    fn add_part(&mut self, first_index: u32, texture: Option<usize>) {
        let end = self.mesh.indices.len() as u32;
        match self.mesh.parts.last_mut() {
            _ if end == first_index => {}
            Some(last) if last.base_color_texture == texture => last.indices.end = end,
            _ => self.mesh.parts.push(Part { indices: first_index..end, base_color_texture: texture }),
        }
    }

    fn reserve(&mut self, vertices: usize, triangles: usize, place: &str) -> Result<(), Refusal> {
        if self.mesh.positions.len() + vertices > MAX_VERTICES {
            return Err(Refusal::at(place, format!("makes the mesh larger than {MAX_VERTICES} vertices")));
        }
        if self.mesh.triangle_count() + triangles > MAX_TRIANGLES {
            return Err(Refusal::at(place, format!("makes the mesh larger than {MAX_TRIANGLES} triangles")));
        }
        Ok(())
    }

    fn positions(
        &self,
        primitive: &Primitive,
        world_from_local: &DAffine3,
        place: &str,
    ) -> Result<Vec<[f32; 3]>, Refusal> {
        let place = format!("{place}.attributes.POSITION");
        let accessor = attribute(primitive, Semantic::Positions).ok_or_else(|| Refusal::at(&place, "is missing"))?;
        let mut positions = self.source.floats::<3>(accessor, false, &place)?;
        for (i, position) in positions.iter_mut().enumerate() {
            let world = world_from_local.transform_point3(DVec3::from(position.map(f64::from)));
            if !world.is_finite() || world.abs().max_element() > MAX_COORDINATE {
                return Err(Refusal::at(place, format!("puts vertex {i} at {world}, too far away")));
            }
            *position = world.as_vec3().to_array();
        }
        Ok(positions)
    }

    /// Corners of each triangle, all of them among the vertices; seen from the front they run
    /// counter-clockwise, mirrored nodes included. Triangles with a repeated corner are left out.
    fn triangles(
        &self,
        primitive: &Primitive,
        mode: Mode,
        vertices: usize,
        world_from_local: &DAffine3,
        place: &str,
    ) -> Result<Vec<[u32; 3]>, Refusal> {
        let user = format!("{place}.indices");
        let corners = match primitive.indices {
            Some(accessor) => self.source.indices(accessor, &user)?,
            None => (0..vertices as u32).collect(),
        };
        if let Some(i) = corners.iter().position(|c| *c as usize >= vertices) {
            let reason = format!("names vertex {} at entry {i}, but there are {vertices}", corners[i]);
            return Err(Refusal::at(user, reason));
        }
        if corners.len() < 3 || (mode == Mode::Triangles && corners.len() % 3 != 0) {
            return Err(Refusal::at(user, format!("has {} entries, which does not make triangles", corners.len())));
        }
        let mut triangles: Vec<[u32; 3]> = match mode {
            Mode::TriangleStrip => {
                (0..corners.len() - 2).map(|i| [corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]]).collect()
            }
            Mode::TriangleFan => corners[1..].windows(2).map(|w| [w[0], w[1], corners[0]]).collect(),
            _ => corners.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect(),
        };
        triangles.retain(|[a, b, c]| a != b && b != c && c != a);
        if world_from_local.matrix3.determinant() < 0.0 {
            triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        }
        Ok(triangles)
    }

    /// The normals in the world, zero where the file's are; `None` where it has none.
    fn normals(
        &self,
        primitive: &Primitive,
        world_from_local: &DAffine3,
        vertices: usize,
        place: &str,
    ) -> Result<Option<Vec<DVec3>>, Refusal> {
        let Some(accessor) = attribute(primitive, Semantic::Normals) else { return Ok(None) };
        let place = format!("{place}.attributes.NORMAL");
        let normals = self.source.floats::<3>(accessor, false, &place)?;
        same_count(normals.len(), vertices, &place)?;
        let cofactors = cofactors(&world_from_local.matrix3);
        let mut out = Vec::with_capacity(vertices);
        for (i, normal) in normals.into_iter().enumerate() {
            let normal = DVec3::from(normal.map(f64::from));
            if !normal.is_finite() {
                return Err(Refusal::at(place, format!("is not finite at vertex {i}")));
            }
            out.push((cofactors * normal).try_normalize().unwrap_or(DVec3::ZERO));
        }
        Ok(Some(out))
    }

    fn colors(
        &self,
        primitive: &Primitive,
        factor: [f32; 3],
        vertices: usize,
        place: &str,
    ) -> Result<Vec<[f32; 3]>, Refusal> {
        let Some(accessor) = attribute(primitive, Semantic::Colors(0)) else { return Ok(vec![factor; vertices]) };
        let place = format!("{place}.attributes.COLOR_0");
        let mut colors = self.source.floats::<3>(accessor, true, &place)?;
        same_count(colors.len(), vertices, &place)?;
        for (i, color) in colors.iter_mut().enumerate() {
            if color.iter().any(|c| !c.is_finite()) {
                return Err(Refusal::at(place, format!("is not finite at vertex {i}")));
            }
            *color = [0, 1, 2].map(|c| color[c].clamp(0.0, 1.0) * factor[c]);
        }
        Ok(colors)
    }

    fn uvs(
        &self,
        primitive: &Primitive,
        surface: &Surface,
        vertices: usize,
        place: &str,
    ) -> Result<Vec<[f32; 2]>, Refusal> {
        let accessor = match surface.texture {
            None => None,
            Some(_) => attribute(primitive, Semantic::TexCoords(surface.uv_set)),
        };
        let Some(accessor) = accessor else { return Ok(vec![[0.0; 2]; vertices]) };
        let place = format!("{place}.attributes.TEXCOORD_{}", surface.uv_set);
        let uvs = self.source.floats::<2>(accessor, false, &place)?;
        same_count(uvs.len(), vertices, &place)?;
        match uvs.iter().position(|uv| uv.iter().any(|c| !c.is_finite())) {
            Some(i) => Err(Refusal::at(place, format!("is not finite at vertex {i}"))),
            None => Ok(uvs),
        }
    }

    fn surface(&mut self, primitive: &Primitive, place: &str) -> Result<Surface, Refusal> {
        let plain = Surface { factor: [1.0; 3], texture: None, uv_set: 0 };
        let Some(index) = primitive.material else { return Ok(plain) };
        let root = self.source.root;
        let material = root.get(index).ok_or_else(|| Refusal::at(format!("{place}.material"), "is missing"))?;
        let pbr = &material.pbr_metallic_roughness;
        let [r, g, b, _] = pbr.base_color_factor.0;
        let factor = [r, g, b].map(|c| if c.is_finite() { c.clamp(0.0, 1.0) } else { 1.0 });
        let Some(info) = &pbr.base_color_texture else { return Ok(Surface { factor, ..plain }) };
        let texture = self.texture(info.index)?;
        Ok(Surface { factor, texture: Some(texture), uv_set: info.tex_coord })
    }

    fn texture(&mut self, index: Index<texture::Texture>) -> Result<usize, Refusal> {
        let missing = || Refusal::at(format!("textures[{}]", index.value()), "is missing");
        let image: Index<image::Image> = self.source.root.get(index).ok_or_else(missing)?.source;
        if let Some(known) = self.texture_of.get(&image.value()) {
            return Ok(*known);
        }
        let place = format!("images[{}]", image.value());
        let entry = self.source.root.get(image).ok_or_else(|| Refusal::at(&place, "is missing"))?;
        let texture = match place_of(entry) {
            None => return Err(Refusal::at(place, "has no data")),
            Some(Place::View(view)) => decode(self.source.view(view)?, &mut self.texture_budget),
            Some(Place::Uri(uri)) => {
                read_uri(uri, self.folder).and_then(|bytes| decode(&bytes, &mut self.texture_budget))
            }
        };
        let number = self.mesh.textures.len();
        self.mesh.textures.push(texture.map_err(|reason| Refusal::at(place, reason))?);
        self.texture_of.insert(image.value(), number);
        Ok(number)
    }
}

fn attribute(primitive: &Primitive, semantic: Semantic) -> Option<Index<accessor::Accessor>> {
    primitive.attributes.get(&Checked::Valid(semantic)).copied()
}

fn same_count(count: usize, vertices: usize, place: &str) -> Result<(), Refusal> {
    if count == vertices {
        return Ok(());
    }
    Err(Refusal::at(place, format!("has {count} entries for {vertices} vertices")))
}

/// What carries normals along with `m`: the inverse transpose times the determinant's magnitude, which
/// exists for flattened matrices too.
fn cofactors(m: &DMat3) -> DMat3 {
    let (x, y, z) = (m.x_axis, m.y_axis, m.z_axis);
    DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y)) * m.determinant().signum()
}

/// Unit normals in f32; those that are zero are replaced by the mean of the faces around the vertex.
fn mended_normals(positions: &[[f32; 3]], triangles: &[[u32; 3]], mut normals: Vec<DVec3>) -> Vec<[f32; 3]> {
    if normals.contains(&DVec3::ZERO) {
        let mut sums = vec![DVec3::ZERO; normals.len()];
        for triangle in triangles {
            let face = face_normal(triangle.map(|v| positions[v as usize])).unwrap_or(DVec3::ZERO);
            triangle.iter().for_each(|v| sums[*v as usize] += face);
        }
        for (normal, sum) in normals.iter_mut().zip(sums).filter(|(n, _)| **n == DVec3::ZERO) {
            *normal = sum.try_normalize().unwrap_or(DVec3::Y);
        }
    }
    normals.into_iter().map(|n| n.as_vec3().to_array()).collect()
}

/// The unit normal on the side from which the corners run counter-clockwise; `None` without area.
fn face_normal(corners: [[f32; 3]; 3]) -> Option<DVec3> {
    let [a, b, c] = corners.map(|p| DVec3::from(p.map(f64::from)));
    (b - a).cross(c - a).try_normalize()
}
