//! Primitives: from attributes to triangles in the file's space.
//!
//! Primitives of a mesh that name the same accessors share their vertices, and only vertices of triangles are written:
//! 850 primitives that take pieces of one large accessor cost no more than one.

use std::collections::HashMap;
use std::sync::OnceLock;

use glam::DVec3;

use super::accessor::Source;
use super::clip::clips;
use super::error::LoadRefusal;
use super::limits::{MAX_ATTRIBUTES, MAX_COORDINATE, MAX_TRIANGLES, MAX_VERTICES};
use super::pose::{Pose, Vertices, same_count};
use super::remarks::Remarks;
use super::schema::{GltfMesh, Primitive, Whole};
use super::surface::{Surface, Surfaces, UvSets};
use super::{MeshPart, TriangleMesh};
use isolith_geometry::Aabb;

/// Appends meshes to one mesh.
pub(super) struct Writer<'a> {
    source: &'a Source<'a>,
    surfaces: Surfaces<'a>,
    mesh: TriangleMesh,
    remarks: Remarks,
    /// Attributes counted so far, for the limit.
    attributes: usize,
}

/// Primitives of one mesh that share their vertices.
struct Group<'p> {
    /// The first of them; the attributes of the others are the same.
    primitive: &'p Primitive,
    place: String,
    /// The sets of texture coordinates.
    uv_sets: UvSets,
    runs: Vec<Run>,
}

/// The triangles of one primitive.
struct Run {
    surface: Surface,
    triangles: Vec<[u32; 3]>,
}

/// Primitives with equal keys share vertices.
type Key = (Vec<(String, Whole)>, Vec<Vec<(String, Whole)>>, UvSets);

impl<'a> Writer<'a> {
    pub fn new(source: &'a Source<'a>, surfaces: Surfaces<'a>, remarks: Remarks) -> Self {
        let mesh = TriangleMesh {
            positions: Vec::new(),
            normals: Vec::new(),
            colors: Vec::new(),
            uvs: Vec::new(),
            tangents: Vec::new(),
            indices: Vec::new(),
            parts: Vec::new(),
            textures: Vec::new(),
            images: Vec::new(),
            clips: clips(source),
            bounds: Aabb::EMPTY,
            warnings: Vec::new(),
            bvh: OnceLock::new(),
        };
        Self { source, surfaces, mesh, remarks, attributes: 0 }
    }

    pub fn finish(mut self) -> TriangleMesh {
        let mesh = &self.mesh;
        let corners = mesh.parts.iter().flat_map(|part| {
            let indices = &mesh.indices[part.indices.start as usize..part.indices.end as usize];
            indices.iter().map(|i| part.origin + point(mesh.positions[*i as usize]))
        });
        self.mesh.bounds = Aabb::from_points(corners);
        if !self.mesh.tangents.is_empty() {
            self.mesh.tangents.resize(self.mesh.positions.len(), [0.0; 4]);
        }
        (self.mesh.textures, self.mesh.images) = self.surfaces.into_textures();
        self.mesh.warnings = self.remarks.finish();
        self.mesh
    }

    /// Adds a mesh in its pose. Points and lines have no surface and are left out.
    pub fn add(&mut self, mesh: &GltfMesh, pose: &Pose, morph: &[f64], place: &str) -> Result<(), LoadRefusal> {
        for group in self.groups(mesh, place)? {
            self.add_group(&group, pose, morph)?;
        }
        Ok(())
    }

    fn groups<'p>(&mut self, mesh: &'p GltfMesh, place: &str) -> Result<Vec<Group<'p>>, LoadRefusal> {
        let mut groups: Vec<Group<'_>> = Vec::new();
        let mut known: HashMap<Key, usize> = HashMap::new();
        let mut found = 0;
        for (p, primitive) in mesh.primitives.iter().enumerate() {
            let of_targets: usize = primitive.targets.iter().map(|target| 1 + target.len()).sum();
            self.attributes += 1 + primitive.attributes.len() + of_targets;
            if self.attributes > MAX_ATTRIBUTES {
                return Err(LoadRefusal::at(place, format!("makes more than {MAX_ATTRIBUTES} attributes to look at")));
            }
            let mode = primitive.mode.map_or(TRIANGLES, |mode| mode.0);
            if !matches!(mode, TRIANGLES | STRIP | FAN) {
                self.remarks.points_or_lines();
                continue;
            }
            let place = format!("{place}.primitives[{p}]");
            let (surface, uv_sets) = self.surfaces.of(primitive, &mut self.remarks);
            let triangles = self.triangles(primitive, mode, &place)?;
            found += triangles.len();
            self.reserve(0, found, &place)?;
            let list = |attributes: &super::schema::Attributes| -> Vec<_> {
                attributes.iter().map(|(name, accessor)| (name.clone(), *accessor)).collect()
            };
            let key = (list(&primitive.attributes), primitive.targets.iter().map(list).collect(), uv_sets);
            let group = *known.entry(key).or_insert(groups.len());
            if group == groups.len() {
                groups.push(Group { primitive, place, uv_sets, runs: Vec::new() });
            }
            groups[group].runs.push(Run { surface, triangles });
        }
        Ok(groups)
    }

    /// The corners of each triangle, checked against the vertex count; triangles with a repeated corner are left out.
    fn triangles(&self, primitive: &Primitive, mode: u64, place: &str) -> Result<Vec<[u32; 3]>, LoadRefusal> {
        let user = format!("{place}.indices");
        let vertices = primitive.attributes.get("POSITION").map_or(0, |accessor| self.source.count(*accessor));
        if vertices == 0 || vertices > MAX_VERTICES as u64 {
            let reason = format!("has {vertices} entries; 1 to {MAX_VERTICES} are allowed");
            return Err(LoadRefusal::at(format!("{place}.attributes.POSITION"), reason));
        }
        let corners = match primitive.indices {
            Some(accessor) => self.source.indices(accessor, &user)?,
            None => {
                self.source.charge(vertices, &user)?;
                (0..vertices as u32).collect()
            }
        };
        if let Some(i) = corners.iter().position(|c| u64::from(*c) >= vertices) {
            let reason = format!("names vertex {} at entry {i}, but there are {vertices}", corners[i]);
            return Err(LoadRefusal::at(user, reason));
        }
        if corners.len() < 3 || (mode == TRIANGLES && corners.len() % 3 != 0) {
            return Err(LoadRefusal::at(user, format!("has {} entries, which does not make triangles", corners.len())));
        }
        let count = if mode == TRIANGLES { corners.len() / 3 } else { corners.len() - 2 };
        self.reserve(0, count, place)?;
        let mut triangles: Vec<[u32; 3]> = match mode {
            STRIP => {
                (0..corners.len() - 2).map(|i| [corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]]).collect()
            }
            FAN => corners[1..].windows(2).map(|w| [w[0], w[1], corners[0]]).collect(),
            _ => corners.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect(),
        };
        triangles.retain(|[a, b, c]| a != b && b != c && c != a);
        Ok(triangles)
    }

    fn add_group(&mut self, group: &Group<'_>, pose: &Pose, morph: &[f64]) -> Result<(), LoadRefusal> {
        let place = &group.place;
        let is_bumpy = group.runs.iter().any(|run| run.surface.normal.is_some());
        let vertices = Vertices::read(self.source, group.primitive, pose, morph, is_bumpy, place)?;
        let colors = self.colors(group.primitive, vertices.positions.len(), place)?;
        let uvs = self.uvs(group, vertices.positions.len())?;
        let used = Used::by(&group.runs, vertices.positions.len());
        if used.list.is_empty() {
            return Ok(());
        }
        let bounds = bounds(&vertices, &used, place)?;
        let origin = self.origin(&bounds);
        let local = |v: u32| (vertices.world(v as usize) - origin).as_vec3().to_array();
        let turned = |[a, b, c]: [u32; 3]| if vertices.is_mirrored(a as usize) { [a, c, b] } else { [a, b, c] };
        let count: usize = group.runs.iter().map(|run| run.triangles.len()).sum();
        let write = |mesh: &mut TriangleMesh, v: u32, position: [f32; 3]| {
            mesh.positions.push(position);
            mesh.colors.push(colors.as_ref().map_or([1.0; 4], |colors| colors[v as usize]));
            let uv = |slot: usize| uvs[slot].as_ref().map_or([0.0; 2], |uvs| uvs[v as usize]);
            let ([u, v], [u2, v2]) = (uv(0), uv(1));
            mesh.uvs.push([u, v, u2, v2]);
        };
        if vertices.normals.is_some() {
            self.reserve(used.list.len(), count, place)?;
            let base = self.mesh.positions.len() as u32;
            let mut normals = Vec::with_capacity(used.list.len());
            if vertices.tangents.is_some() {
                self.mesh.tangents.resize(base as usize, [0.0; 4]);
            }
            for v in &used.list {
                self.mesh.tangents.extend(vertices.tangent(*v as usize));
                write(&mut self.mesh, *v, local(*v));
                normals.push(vertices.normal(*v as usize).unwrap_or(DVec3::ZERO));
            }
            let mut written = Vec::with_capacity(count);
            for run in &group.runs {
                let first = self.mesh.indices.len() as u32;
                let triangles = run.triangles.iter().map(|t| turned(*t).map(|v| used.number(v)));
                written.extend(triangles);
                let fresh = &written[written.len() - run.triangles.len()..];
                self.mesh.indices.extend(fresh.iter().flatten().map(|v| base + v));
                self.add_part(first, origin, run.surface);
            }
            let normals = mended_normals(&self.mesh.positions[base as usize..], &written, normals);
            self.mesh.normals.extend(normals);
        } else {
            // A surface without normals is flat-shaded (specification, 3.7.2.1): no vertices are shared.
            self.reserve(count * 3, count, place)?;
            for run in &group.runs {
                let first = self.mesh.indices.len() as u32;
                for corners in run.triangles.iter().map(|t| turned(*t)) {
                    let positions = corners.map(local);
                    let normal = face_normal(positions).unwrap_or(DVec3::Y).as_vec3().to_array();
                    for (v, position) in corners.into_iter().zip(positions) {
                        self.mesh.indices.push(self.mesh.positions.len() as u32);
                        self.mesh.normals.push(normal);
                        write(&mut self.mesh, v, position);
                    }
                }
                self.add_part(first, origin, run.surface);
            }
        }
        Ok(())
    }

    /// The origin for positions in this box, near enough for rounding to f32 to do no harm. Prefers 0, then the origin
    /// of the part before.
    fn origin(&self, bounds: &Aabb) -> DVec3 {
        let size = (bounds.max - bounds.min).max_element();
        let is_near = |origin: &DVec3| {
            let farthest = (bounds.min - origin).abs().max((bounds.max - origin).abs()).max_element();
            farthest <= MOST_SIZES_AWAY * size
        };
        let before = self.mesh.parts.last().map(|part| part.origin);
        [Some(DVec3::ZERO), before].into_iter().flatten().find(is_near).unwrap_or_else(|| bounds.center())
    }

    /// Adds the part from `first_index` to the end; extends the part before if surface and origin are the same.
    fn add_part(&mut self, first_index: u32, origin: DVec3, surface: Surface) {
        let end = self.mesh.indices.len() as u32;
        match self.mesh.parts.last_mut() {
            _ if end == first_index => {}
            Some(last) if last.surface == surface && last.origin == origin => last.indices.end = end,
            _ => self.mesh.parts.push(MeshPart { indices: first_index..end, origin, surface }),
        }
    }

    /// Refuses additions that would exceed the limits of a mesh.
    fn reserve(&self, vertices: usize, triangles: usize, place: &str) -> Result<(), LoadRefusal> {
        if self.mesh.positions.len() + vertices > MAX_VERTICES {
            return Err(LoadRefusal::at(place, format!("makes the mesh larger than {MAX_VERTICES} vertices")));
        }
        if self.mesh.triangle_count() + triangles > MAX_TRIANGLES {
            return Err(LoadRefusal::at(place, format!("makes the mesh larger than {MAX_TRIANGLES} triangles")));
        }
        Ok(())
    }

    fn colors(
        &self,
        primitive: &Primitive,
        vertices: usize,
        place: &str,
    ) -> Result<Option<Vec<[f32; 4]>>, LoadRefusal> {
        let Some(accessor) = primitive.attributes.get("COLOR_0") else { return Ok(None) };
        let place = format!("{place}.attributes.COLOR_0");
        same_count(self.source.count(*accessor), vertices, &place)?;
        let mut colors = self.source.floats::<4>(*accessor, 3, &place)?;
        for (i, color) in colors.iter_mut().enumerate() {
            if color.iter().any(|c| !c.is_finite()) {
                return Err(LoadRefusal::at(place, format!("is not finite at vertex {i}")));
            }
            *color = color.map(|c| c.clamp(0.0, 1.0));
        }
        Ok(Some(colors))
    }

    /// The texture coordinates of each slot, if a texture needs them.
    fn uvs(&self, group: &Group<'_>, vertices: usize) -> Result<[Option<Vec<[f32; 2]>>; 2], LoadRefusal> {
        let mut slots = [None, None];
        for (slot, set) in slots.iter_mut().zip(group.uv_sets) {
            let Some(name) = set.map(|set| format!("TEXCOORD_{set}")) else { continue };
            let Some(accessor) = group.primitive.attributes.get(&name) else { continue };
            let place = format!("{}.attributes.{name}", group.place);
            same_count(self.source.count(*accessor), vertices, &place)?;
            let uvs = self.source.floats::<2>(*accessor, 2, &place)?;
            if let Some(i) = uvs.iter().position(|uv| uv.iter().any(|c| !c.is_finite())) {
                return Err(LoadRefusal::at(place, format!("is not finite at vertex {i}")));
            }
            *slot = Some(uvs);
        }
        Ok(slots)
    }
}

const TRIANGLES: u64 = 4;
const STRIP: u64 = 5;
const FAN: u64 = 6;

/// Greatest distance of a part from its origin, in multiples of its size: rounding to f32 then moves a vertex by at
/// most 4e-6 of the part's size.
const MOST_SIZES_AWAY: f64 = 64.0;

/// The vertices of the triangles, in the order of the file.
struct Used {
    list: Vec<u32>,
    /// The index in the list of each vertex; empty if too few vertices are used for a table to pay.
    table: Vec<u32>,
}

impl Used {
    fn by(runs: &[Run], vertices: usize) -> Self {
        let corners = || runs.iter().flat_map(|run| run.triangles.iter().flatten());
        if corners().count() < vertices / 8 {
            let mut list: Vec<u32> = corners().copied().collect();
            list.sort_unstable();
            list.dedup();
            return Self { list, table: Vec::new() };
        }
        let mut table = vec![u32::MAX; vertices];
        corners().for_each(|v| table[*v as usize] = 0);
        let mut list = Vec::new();
        for (v, number) in table.iter_mut().enumerate().filter(|(_, number)| **number == 0) {
            *number = list.len() as u32;
            list.push(v as u32);
        }
        Self { list, table }
    }

    /// The index in the list of a used vertex.
    fn number(&self, vertex: u32) -> u32 {
        match self.table.get(vertex as usize) {
            Some(number) => *number,
            None => self.list.partition_point(|v| *v < vertex) as u32,
        }
    }
}

/// The bounds of the used vertices.
fn bounds(vertices: &Vertices<'_>, used: &Used, place: &str) -> Result<Aabb, LoadRefusal> {
    let mut bounds = Aabb::EMPTY;
    for v in &used.list {
        let world = vertices.world(*v as usize);
        if !world.is_finite() || world.abs().max_element() > MAX_COORDINATE {
            let place = format!("{place}.attributes.POSITION");
            return Err(LoadRefusal::at(place, format!("puts vertex {v} at {world}, too far away")));
        }
        bounds = bounds.union(&Aabb { min: world, max: world });
    }
    Ok(bounds)
}

/// Unit normals in f32. The mean of the faces around a vertex replaces a zero normal.
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

/// The unit normal on the side from which the corners run counter-clockwise; `None` if the area is zero.
fn face_normal(corners: [[f32; 3]; 3]) -> Option<DVec3> {
    let [a, b, c] = corners.map(point);
    (b - a).cross(c - a).try_normalize()
}

fn point(v: [f32; 3]) -> DVec3 {
    DVec3::from(v.map(f64::from))
}
