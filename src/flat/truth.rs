//! The whole picture as it should be: every pixel traced by the twin.

use std::sync::atomic::{AtomicU32, Ordering};

use glam::{DVec2, DVec3, DVec4};
use rayon::prelude::*;

use super::mesh_rays::{Meshes, trace_meshes};
use super::shade::{GpuLight, gpu_lights, shade_background, shade_decode, shade_encode, shade_surface};
use super::trace::{TraceError, Tracer};
use super::twin::{SurfaceMaterial, surface};
use super::{BACKGROUND_DEPTH, Buffers, FlatScene, MESH_BIT, NO_LEAF};
use crate::geometry::{Camera, Ray};
use crate::mesh::{MeshHit, TriangleMesh};

/// A picture, and how sure each pixel of it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Truth {
    /// The picture.
    pub buffers: Buffers,
    /// Per pixel, in pixel footprints: how far its ray is from hitting something else, see
    /// [`super::trace::March::margin`]. A renderer in f32 may differ where this is about 0.
    pub margin: Vec<f32>,
}

/// Renders the scene through the centres of the pixels. `progress` hears the share that is done, from
/// any thread.
pub fn truth(
    flat: &FlatScene,
    meshes: &Meshes,
    camera: &Camera,
    [width, height]: [u32; 2],
    progress: &(dyn Fn(f64) + Sync),
) -> Result<Truth, TraceError> {
    let view = View { flat, meshes, camera, lights: gpu_lights(flat, camera), size: [width, height] };
    let tracer = Tracer::new(flat);
    let done = AtomicU32::new(0);
    let rows: Vec<Vec<Pixel>> = (0..height)
        .into_par_iter()
        .map_with(tracer, |tracer, y| {
            let row = (0..width).map(|x| view.pixel(tracer, x, y)).collect();
            progress(f64::from(done.fetch_add(1, Ordering::Relaxed) + 1) / f64::from(height));
            row
        })
        .collect::<Result<_, _>>()?;
    let mut buffers = Buffers::empty(width, height);
    let mut margin = Vec::with_capacity(buffers.depth.len());
    for (i, pixel) in rows.into_iter().flatten().enumerate() {
        buffers.depth[i] = pixel.depth;
        buffers.leaf[i] = pixel.leaf;
        buffers.normal[i] = pixel.normal.as_vec3().to_array();
        let [r, g, b] = (shade_encode(pixel.color) * 255.0).round().to_array().map(|v| v as u8);
        buffers.color[i] = [r, g, b, 255];
        margin.push(pixel.margin);
    }
    Ok(Truth { buffers, margin })
}

struct View<'a> {
    flat: &'a FlatScene,
    meshes: &'a Meshes,
    camera: &'a Camera,
    lights: Vec<GpuLight>,
    size: [u32; 2],
}

struct Pixel {
    depth: f32,
    leaf: u32,
    normal: DVec3,
    color: DVec3,
    margin: f32,
}

impl View<'_> {
    fn pixel(&self, tracer: &mut Tracer<'_>, x: u32, y: u32) -> Result<Pixel, TraceError> {
        let size = DVec2::new(self.size[0].into(), self.size[1].into());
        let ray = self.camera.ray(DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5), size);
        let mesh = trace_meshes(self.flat, self.meshes, &ray, self.camera.near, self.camera.far);
        let limit = mesh.map_or(self.camera.far, |(_, hit)| hit.t);
        let march = tracer.march(&ray, self.camera.near, limit)?;
        let margin = (march.margin / self.camera.footprint(size.y)) as f32;
        let (t, leaf, normal, material) = if let Some(hit) = march.hit {
            let component = &self.flat.components[hit.component as usize];
            let point = surface(self.flat, component, ray.at(hit.t) - component.origin);
            (hit.t, hit.leaf, point.gradient.try_normalize().unwrap_or(-ray.direction), point.material)
        } else if let Some((index, hit)) = mesh {
            let (normal, material) = self.mesh_surface(index, &hit, ray.direction);
            (hit.t, MESH_BIT | index as u32, normal, material)
        } else {
            let [sky, horizon] = [self.flat.environment.sky, self.flat.environment.horizon].map(DVec3::from);
            let color = shade_background(ray.direction.y, sky, horizon);
            return Ok(Pixel { depth: BACKGROUND_DEPTH, leaf: NO_LEAF, normal: DVec3::ZERO, color, margin });
        };
        let color = self.shade(&ray, t, normal, &material);
        Ok(Pixel { depth: t as f32, leaf, normal, color, margin })
    }

    fn shade(&self, ray: &Ray, t: f64, normal: DVec3, material: &SurfaceMaterial) -> DVec3 {
        let ambient = DVec3::from(self.flat.environment.ambient);
        shade_surface(material, ray.direction * t, normal, -ray.direction, ambient, &self.lights)
    }

    fn mesh_surface(&self, index: usize, hit: &MeshHit, direction: DVec3) -> (DVec3, SurfaceMaterial) {
        let placed = &self.flat.meshes[index];
        let normal_from_local = placed.world_from_local.matrix3.inverse().transpose();
        let normal = (normal_from_local * hit.normal).try_normalize().unwrap_or(-direction);
        // Both sides are shown. The triangle decides which one is seen: near an outline the mixed normal
        // may point away though the triangle faces the eye.
        let face = self.meshes[index].as_ref().map_or(hit.normal, |mesh| mesh.face_normal(hit.triangle));
        let normal = if (normal_from_local * face).dot(direction) > 0.0 { -normal } else { normal };
        let material = match (placed.material, &self.meshes[index]) {
            (Some(material), _) => (&self.flat.materials[material as usize]).into(),
            (None, Some(mesh)) => SurfaceMaterial { albedo: albedo(mesh, hit), ..FILE_MATERIAL },
            (None, None) => FILE_MATERIAL,
        };
        (normal, material)
    }
}

/// What a mesh wears that keeps its file's colours.
pub const FILE_MATERIAL: SurfaceMaterial =
    SurfaceMaterial { albedo: DVec3::ONE, specular: 0.2, emission: DVec3::ZERO, shininess: 32.0 };

/// The mesh's own colour: that of vertices, part and texture.
fn albedo(mesh: &TriangleMesh, hit: &MeshHit) -> DVec3 {
    let linear = |[r, g, b, a]: [u8; 4]| {
        let [r, g, b, a] = [r, g, b, a].map(|c| f64::from(c) / 255.0);
        shade_decode(DVec3::new(r, g, b)).extend(a)
    };
    let color: DVec4 = mesh.color(hit.triangle, hit.weights, linear);
    color.truncate()
}
