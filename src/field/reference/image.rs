//! The reference image: the CPU evaluator traces every pixel.

use std::collections::HashMap;
use std::f64::consts::TAU;
use std::sync::atomic::{AtomicU32, Ordering};

use glam::{DAffine3, DVec2, DVec3};
use rayon::prelude::*;

use super::tolerance::{GRAZING_ANGLE, WRONG_DEPTH};
use super::trace::{March, TraceError, Tracer};
use crate::copies::{copy_from_world, look_at, look_mixture, look_varied, world_surface};
use crate::coverage::PixelSample;
use crate::eval::SurfaceMaterial;
use crate::light::arriving::{Arriving, SeenPoint};
use crate::light::brdf::ShadingPoint;
use crate::light::display::{display_color, display_decode};
use crate::light::environment::{EnvironmentLight, environment_background};
use crate::light::lighting::lighting_surface;
use crate::light::texture::{textured_mixture, textured_point};
use crate::lights::{GpuLight, gpu_lights};
use crate::mesh_material::mesh_material;
use crate::mesh_rays::{MeshRayHit, Meshes, trace_meshes_of_pixel};
use crate::mixture::mixture_material;
use crate::scene_eval::SceneEvaluator;
use crate::veil::Veils;
use crate::{BACKGROUND_DEPTH, FlatScene, GBuffer, GpuPlacedTextures, HitTarget, MESH_BIT, NO_LEAF, gpu_textures};
use isolith_geometry::{Camera, Ray};
use isolith_mesh::{MeshHit, MeshLook, TriangleMesh};
use isolith_scene::NodeId;

/// An image with the certainty of each pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct ReferenceImage {
    /// The image.
    pub buffers: GBuffer,
    /// Per pixel, in pixel footprints: the margin of its ray, see [`super::trace::March::margin`].
    pub margin: Vec<f32>,
    /// The width of a pixel at distance 1, see [`Camera::footprint`].
    pub footprint: f64,
    /// Per pixel the visible node.
    pub nodes: Vec<Option<NodeId>>,
    /// Per pixel whether another node has the same weight in a blend, see [`crate::eval::SurfacePoint::tied`].
    pub tied: Vec<bool>,
    /// For pixels whose ray passes an edge, or runs along a surface, so closely that rounding may matter: the hits of
    /// rays turned to all sides by [`GRAZING_ANGLE`].
    pub turned: HashMap<usize, Vec<Glimpse>>,
}

/// What a ray shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Glimpse {
    /// Distance along the ray; infinite without a hit.
    pub depth: f32,
    /// The node.
    pub node: Option<NodeId>,
}

/// The node for a value in [`GBuffer::leaf`]; `None` for the background.
pub fn node_of(flat: &FlatScene, code: u32) -> Option<NodeId> {
    match HitTarget::from_code(code) {
        HitTarget::Background => None,
        HitTarget::Leaf(leaf) => flat.ids.get(leaf).copied(),
        HitTarget::Mesh(mesh) => flat.meshes.get(mesh).map(|mesh| mesh.id),
    }
}

/// The number of turned rays, evenly around the ray of the pixel.
const TURNS: u32 = 8;
/// Pixels whose margin is less than this many times [`GRAZING_ANGLE`] get turned rays: margins are known within a
/// factor of two.
const NEAR_AN_EDGE: f64 = 2.0;

impl ReferenceImage {
    /// Whether some of the rays turned within rounding hit and others miss.
    pub fn is_undecided(&self, pixel: usize) -> bool {
        let own = self.buffers.depth[pixel].is_finite();
        self.turned.get(&pixel).is_some_and(|seen| seen.iter().any(|seen| seen.depth.is_finite() != own))
    }

    /// Whether a ray turned within rounding sees this depth, and this node if it is known. The depths between those
    /// of the node's hits count as seen too, with a footprint of tolerance.
    pub fn may_show(&self, pixel: usize, depth: f32, node: Option<Option<NodeId>>) -> bool {
        let Some(seen) = self.turned.get(&pixel) else { return false };
        let own = Glimpse { depth: self.buffers.depth[pixel], node: self.nodes[pixel] };
        let all = seen.iter().chain([&own]).filter(|seen| node.is_none_or(|node| node == seen.node));
        let depths: Vec<f64> = all.map(|seen| f64::from(seen.depth)).collect();
        if !depth.is_finite() {
            return depths.iter().any(|depth| !depth.is_finite());
        }
        let finite = || depths.iter().copied().filter(|depth| depth.is_finite());
        let room = 1.0 + WRONG_DEPTH * self.footprint;
        let (least, most) = (finite().fold(f64::INFINITY, f64::min), finite().fold(0.0, f64::max));
        let depth = f64::from(depth);
        if node.is_some() {
            return (least / room..=most * room).contains(&depth);
        }
        // The node is unknown: only the depths of hits count, not those between.
        finite().any(|seen| (seen / room..=seen * room).contains(&depth))
    }
}

/// Renders the scene through the centers of the pixels. Any thread may call `progress` with the completed fraction.
pub fn render_reference(
    flat: &FlatScene,
    meshes: &Meshes,
    camera: &Camera,
    size: [u32; 2],
    progress: &(dyn Fn(f64) + Sync),
) -> Result<ReferenceImage, TraceError> {
    render_reference_at(DVec2::ZERO, flat, meshes, camera, size, progress)
}

/// The same beside the centers of the pixels, by `jitter` pixels.
pub fn render_reference_at(
    jitter: DVec2,
    flat: &FlatScene,
    meshes: &Meshes,
    camera: &Camera,
    [width, height]: [u32; 2],
    progress: &(dyn Fn(f64) + Sync),
) -> Result<ReferenceImage, TraceError> {
    let center = jitter + 0.5;
    let (lights, textures) = (gpu_lights(flat, camera, [width, height]), gpu_textures(flat, camera));
    let view = View { flat, meshes, camera, lights, textures, size: [width, height], center };
    let footprint = camera.footprint(f64::from(height));
    let tracer = Tracer::new(flat).through(Veils::new(flat, camera.position, footprint));
    let done = AtomicU32::new(0);
    let rows: Vec<Vec<Pixel>> = (0..height)
        .into_par_iter()
        .map_with(tracer, |tracer, y| {
            let row = (0..width).map(|x| view.pixel(tracer, x, y)).collect();
            progress(f64::from(done.fetch_add(1, Ordering::Relaxed) + 1) / f64::from(height));
            row
        })
        .collect::<Result<_, _>>()?;
    let mut buffers = GBuffer::empty(width, height);
    let mut margin = Vec::with_capacity(buffers.depth.len());
    let mut tied = Vec::with_capacity(buffers.depth.len());
    let mut turned = HashMap::new();
    for (i, pixel) in rows.into_iter().flatten().enumerate() {
        buffers.depth[i] = pixel.depth;
        buffers.leaf[i] = pixel.leaf;
        buffers.normal[i] = pixel.normal.as_vec3().to_array();
        let [r, g, b] = (display_color(pixel.color, &flat.display) * 255.0).round().to_array().map(|v| v as u8);
        buffers.color[i] = [r, g, b, 255];
        buffers.radiance.push(pixel.color.as_vec3().extend(1.0).to_array());
        margin.push(pixel.margin);
        tied.push(pixel.tied);
        if !pixel.turned.is_empty() {
            turned.insert(i, pixel.turned);
        }
    }
    let nodes = buffers.leaf.iter().map(|code| node_of(flat, *code)).collect();
    Ok(ReferenceImage { buffers, margin, footprint, nodes, tied, turned })
}

struct View<'a> {
    flat: &'a FlatScene,
    meshes: &'a Meshes,
    camera: &'a Camera,
    lights: Vec<GpuLight>,
    textures: Vec<GpuPlacedTextures>,
    size: [u32; 2],
    /// The place within each pixel.
    center: DVec2,
}

struct Pixel {
    depth: f32,
    leaf: u32,
    normal: DVec3,
    color: DVec3,
    margin: f32,
    tied: bool,
    turned: Vec<Glimpse>,
}

/// The nearest hits of a ray: on a field, if any, and on a mesh that is not behind it, if any.
type Met = (March, Option<MeshRayHit>);

impl View<'_> {
    fn pixel(&self, tracer: &mut Tracer<'_>, x: u32, y: u32) -> Result<Pixel, TraceError> {
        let size = DVec2::new(self.size[0].into(), self.size[1].into());
        let ray = self.camera.ray(DVec2::new(x.into(), y.into()) + self.center, size);
        let at = PixelSample { pixel: [x, y], sample: 0 };
        let (march, mesh) = self.meet(tracer, &ray, at)?;
        let footprint = self.camera.footprint(size.y);
        let margin = (march.margin / footprint) as f32;
        let mut is_close = march.margin <= NEAR_AN_EDGE * GRAZING_ANGLE;
        let mut tied = false;
        let (mut shading_normal, mut to_eye) = (None, -ray.direction);
        let (t, leaf, normal, material, occlusion) = if let Some(hit) = march.hit {
            let component = &self.flat.components[hit.component as usize];
            let point = world_surface(self.flat, component, ray.at(hit.t));
            tied = point.tied;
            let normal = point.gradient.try_normalize().unwrap_or(-ray.direction);
            // Rays that pass surfaces meet others from within, and see the light of the side without.
            if tracer.passes_surfaces() && normal.dot(ray.direction) > 0.0 {
                to_eye -= normal * (2.0 * to_eye.dot(normal));
            }
            let look = look_at(self.flat, component, ray.at(hit.t));
            let mixture = look.map_or(point.materials, |look| look_mixture(&look, point.materials));
            let mut material = point.material;
            if look.is_some_and(|look| look.replaced.is_some()) {
                material = mixture_material(&mixture, &self.flat.materials);
            }
            if !self.textures.is_empty() {
                let at = textured_point(ray.direction, hit.t, normal, footprint);
                let copy = copy_from_world(self.flat, component, ray.at(hit.t));
                let copy_from_eye = copy.map(|copy| copy * DAffine3::from_translation(self.camera.position));
                let (textured, bent) = textured_mixture(&mixture, self.flat, &self.textures, &at, copy_from_eye);
                (material, shading_normal) = (textured, Some(bent));
            }
            material = look.map_or(material, |look| look_varied(material, &look));
            (hit.t, hit.leaf, normal, material, 1.0)
        } else if let Some(found) = mesh {
            let (normal, material, occlusion) = self.mesh_surface(&found, ray.direction);
            (found.hit.t, MESH_BIT | found.index as u32, normal, material, occlusion)
        } else {
            let color = environment_background(ray.direction, &EnvironmentLight::of(self.flat));
            let turned = if is_close { self.turned(tracer, &ray, at)? } else { Vec::new() };
            let (depth, leaf, normal) = (BACKGROUND_DEPTH, NO_LEAF, DVec3::ZERO);
            return Ok(Pixel { depth, leaf, normal, color, margin, tied, turned });
        };
        // A turn by the angle moves the depth along a surface at this angle by more than a footprint.
        is_close |= normal.dot(ray.direction).abs() <= NEAR_AN_EDGE * GRAZING_ANGLE / footprint;
        let turned = if is_close { self.turned(tracer, &ray, at)? } else { Vec::new() };
        let point =
            ShadingPoint { material, position: ray.direction * t, normal: shading_normal.unwrap_or(normal), to_eye };
        let color = self.shade(&point, occlusion, normal, [x, y])?;
        Ok(Pixel { depth: t as f32, leaf, normal, color, margin, tied, turned })
    }

    fn meet(&self, tracer: &mut Tracer<'_>, ray: &Ray, at: PixelSample) -> Result<Met, TraceError> {
        let range = [self.camera.near, self.camera.far];
        let mesh = trace_meshes_of_pixel(self.flat, self.meshes, ray, range, at);
        let limit = mesh.as_ref().map_or(self.camera.far, |found| found.hit.t);
        tracer.set_sample(at);
        Ok((tracer.march(ray, self.camera.near, limit)?, mesh))
    }

    /// What rays turned by [`GRAZING_ANGLE`] to all sides show.
    fn turned(&self, tracer: &mut Tracer<'_>, ray: &Ray, at: PixelSample) -> Result<Vec<Glimpse>, TraceError> {
        let (right, up) = ray.direction.any_orthonormal_pair();
        let glimpse = |i: u32| {
            let (sine, cosine) = (TAU * f64::from(i) / f64::from(TURNS)).sin_cos();
            let direction = ray.direction + (right * cosine + up * sine) * GRAZING_ANGLE;
            let (march, mesh) = self.meet(tracer, &Ray { direction: direction.normalize(), ..*ray }, at)?;
            Ok(match (march.hit, mesh) {
                (Some(hit), _) => Glimpse { depth: hit.t as f32, node: node_of(self.flat, hit.leaf) },
                (None, Some(found)) => {
                    Glimpse { depth: found.hit.t as f32, node: Some(self.flat.meshes[found.index].id) }
                }
                (None, None) => Glimpse { depth: BACKGROUND_DEPTH, node: None },
            })
        };
        (0..TURNS).map(glimpse).collect()
    }

    /// The light of a point. `open`: see [`lighting_surface`]. `normal` is that of the surface without bumps.
    fn shade(&self, point: &ShadingPoint, open: f64, normal: DVec3, pixel: [u32; 2]) -> Result<DVec3, TraceError> {
        let arriving = if self.flat.environment.shadowing.is_on() {
            let footprint = self.camera.footprint(self.size[1].into()) * point.position.length();
            let (eye, position) = (self.camera.position, point.position);
            let seen = SeenPoint { eye, position, normal, footprint, pixel, sample: 0 };
            Arriving::at(&mut SceneEvaluator::new(self.flat), self.meshes, &self.lights, &seen)?
        } else {
            Arriving::all(point.normal)
        };
        Ok(lighting_surface(point, &EnvironmentLight::of(self.flat), open, &self.lights, &arriving))
    }

    /// Normal, material and the share of the ambient light at a hit on a mesh.
    fn mesh_surface(&self, found: &MeshRayHit, direction: DVec3) -> (DVec3, SurfaceMaterial, f64) {
        let MeshRayHit { index, ref hit, world_from_local, .. } = *found;
        let placed = &self.flat.meshes[index];
        let normal_from_local = world_from_local.matrix3.inverse().transpose();
        let normal = found.normal().unwrap_or(-direction);
        let mesh = self.meshes[index].as_ref().expect("it was hit");
        let own = placed.material.map(|material| SurfaceMaterial::from(&self.flat.materials[material as usize]));
        let (normal, material, occlusion) = match own {
            Some(material) => (normal, material, 1.0),
            None => {
                let normal = mesh.mapped_normal(hit.triangle, hit.weights, normal, &world_from_local.matrix3);
                let (material, occlusion) = mesh_look(mesh, hit);
                (normal, material, occlusion)
            }
        };
        // Both sides are visible. The triangle decides which side the ray sees: near a silhouette the interpolated
        // normal may point away though the triangle faces the eye.
        let face = normal_from_local * mesh.face_normal(hit.triangle);
        (if face.dot(direction) > 0.0 { -normal } else { normal }, material, occlusion)
    }
}

/// The file's own material at a hit, and the share of the ambient light that it lets arrive.
fn mesh_look(mesh: &TriangleMesh, hit: &MeshHit) -> (SurfaceMaterial, f64) {
    let linear = |[r, g, b, a]: [u8; 4]| {
        let [r, g, b, a] = [r, g, b, a].map(|c| f64::from(c) / 255.0);
        display_decode(DVec3::new(r, g, b)).extend(a)
    };
    let surface = &mesh.part(hit.triangle).surface;
    let plain = SurfaceMaterial::from(&mesh_material(surface));
    let MeshLook { color, metalness, roughness, occlusion, emission } = mesh.look(hit.triangle, hit.weights, linear);
    let color = color.truncate();
    if surface.is_unlit {
        return (SurfaceMaterial { emission: color, ..plain }, 1.0);
    }
    (SurfaceMaterial { base_color: color, metalness, roughness, emission, ..plain }, occlusion)
}
