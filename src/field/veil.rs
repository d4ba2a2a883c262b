//! What a ray may pass: surfaces that are blended, or cut out. Counterpart of `shaders/common/veil.wgsl`.
//!
//! A surface covers a sample of a pixel, or does not, by its opacity there. A ray that meets one that does not goes on
//! behind it: in the solid, to where it leaves that, and then to what lies behind. Numbers and picking take the first
//! surface that has any opacity.

use glam::{DAffine3, DVec3};

use super::copies::{Copy, copy_material, look_mixture, world_from_copy};
use super::coverage::{PixelSample, coverage_hash, coverage_threshold};
use super::flat_texture::{GpuPlacedTextures, OPACITY_SLOT};
use super::light::texture::{mean_texture_opacity, textured_opacity, textured_point};
use super::mixture::Mixture;
use super::textures_in_view::textures_from;
use super::{Component, FlatMaterial, FlatScene};
use isolith_geometry::Ray;

/// Footprint by which a cut-out reads its texture, in pixels: less than one, since only the samples of a pixel may mix what
/// is there with what is not. A filtered hole would be whole or gone.
pub const CUT_FOOTPRINT: f64 = 0.25;

impl FlatScene {
    /// Whether rays may pass surfaces of this material somewhere.
    fn is_veil(&self, material: u32) -> bool {
        self.materials[material as usize].opacity < 1.0 || self.opacity_texture(material).is_some()
    }

    /// The set of the textures of a material, if one of them gives its opacity.
    fn opacity_texture(&self, material: u32) -> Option<usize> {
        let set = self.textures.placed.get(material as usize).copied().flatten()?.set as usize;
        (self.textures.sets[set].slots[OPACITY_SLOT].kind != 0).then_some(set)
    }

    /// Whether a texture gives the opacity of a material.
    pub fn has_opacity_textures(&self) -> bool {
        self.textures.sets.iter().any(|set| set.slots[OPACITY_SLOT].kind != 0)
    }

    /// Share of the light that passes each component, if some passes some; else empty. A component counts as its most
    /// opaque material does on average.
    pub fn translucency(&self) -> Vec<f64> {
        let veiled = self.veiled();
        if veiled.is_empty() {
            return Vec::new();
        }
        let opacities: Vec<f64> = (0..self.materials.len() as u32).map(|at| self.mean_opacity(at)).collect();
        let opacity = |material: &u32| opacities[*material as usize];
        let of = |component: &Component| {
            let range = component.first as usize..(component.first + component.count) as usize;
            let own = self.nodes[range].iter().filter(|node| node.is_leaf()).map(|leaf| opacity(&leaf.material));
            let palette = component.instanced.map_or(&[][..], |of| &self.instancers[of.instancer as usize].palette);
            1.0 - own.chain(palette.iter().map(opacity)).fold(0.0, f64::max)
        };
        self.components.iter().map(of).collect()
    }

    /// The opacity of a material on average, holes cut out.
    fn mean_opacity(&self, material: u32) -> f64 {
        let FlatMaterial { opacity, opacity_threshold, .. } = self.materials[material as usize];
        let threshold = f64::from(opacity_threshold);
        let cut = |opacity: f64| if threshold > 0.0 { f64::from(u8::from(opacity >= threshold)) } else { opacity };
        match self.opacity_texture(material) {
            Some(set) => mean_texture_opacity(&self.textures, set, cut),
            None => cut(opacity.into()),
        }
    }

    /// Of each component whether rays may pass some of its surfaces; empty if none can be passed.
    pub fn veiled(&self) -> Vec<bool> {
        let veils: Vec<bool> = (0..self.materials.len() as u32).map(|at| self.is_veil(at)).collect();
        if !veils.contains(&true) {
            return Vec::new();
        }
        let is_veil = |material: &u32| veils[*material as usize];
        let of = |component: &Component| {
            let range = component.first as usize..(component.first + component.count) as usize;
            let own = self.nodes[range].iter().filter(|node| node.is_leaf()).any(|leaf| is_veil(&leaf.material));
            let instancer = component.instanced.map(|of| &self.instancers[of.instancer as usize]);
            own || instancer.is_some_and(|instancer| instancer.palette.iter().any(is_veil))
        };
        self.components.iter().map(of).collect()
    }
}

/// Decides whether surfaces cover what a ray of an eye shows.
#[derive(Clone, Debug)]
pub struct Veils<'a> {
    flat: &'a FlatScene,
    /// See [`FlatScene::veiled`].
    veiled: Vec<bool>,
    eye: DVec3,
    textures: Vec<GpuPlacedTextures>,
    /// Width of a pixel at distance 1.
    footprint: f64,
    /// The sample; `None` for the first surface that has any opacity.
    pub at: Option<PixelSample>,
}

/// A surface on a ray.
#[derive(Clone, Copy, Debug)]
pub struct VeilPoint<'a> {
    /// Index of the component.
    pub component: u32,
    /// The copy, for types of instancers.
    pub copy: Option<&'a Copy>,
    /// Distance from the eye.
    pub t: f64,
    /// Mixture and normal, this in the world.
    pub materials: Mixture,
    /// Of any length.
    pub gradient: DVec3,
    /// How many surfaces of the component, or of the copy, the ray has passed.
    pub passed: u32,
}

impl<'a> Veils<'a> {
    /// For rays that begin at `eye`.
    pub fn new(flat: &'a FlatScene, eye: DVec3, footprint: f64) -> Self {
        let veiled = flat.veiled();
        let is_textured = !veiled.is_empty() && flat.has_opacity_textures();
        let textures = if is_textured { textures_from(flat, eye) } else { Vec::new() };
        Self { flat, veiled, eye, textures, footprint, at: None }
    }

    /// Whether rays may pass surfaces of the scene.
    pub fn is_on(&self) -> bool {
        !self.veiled.is_empty()
    }

    /// Whether rays may pass surfaces of the component.
    pub fn may_pass(&self, component: u32) -> bool {
        self.veiled.get(component as usize) == Some(&true)
    }

    /// Whether the surface covers the sample.
    pub fn covers(&self, ray: &Ray, point: &VeilPoint<'_>) -> bool {
        let threshold = self.at.map_or(0.0, |at| coverage_threshold(at, veil_layer(point)));
        self.opacity(ray, point) > threshold
    }

    /// The opacity of the surface.
    pub fn opacity(&self, ray: &Ray, point: &VeilPoint<'_>) -> f64 {
        let component = &self.flat.components[point.component as usize];
        let instancer = component.instanced.map(|of| &self.flat.instancers[of.instancer as usize]);
        let copy = instancer.zip(point.copy);
        let look = copy.map(|(instancer, copy)| copy_material(instancer, copy));
        let mixture = look.map_or(point.materials, |look| look_mixture(&look, point.materials));
        let (mut sum, mut whole) = (0.0, 0.0);
        for (id, weight) in mixture.ids.into_iter().zip(mixture.weights).filter(|(_, weight)| *weight > 0.0) {
            let material = &self.flat.materials[id as usize];
            let threshold = f64::from(material.opacity_threshold);
            let mut opacity = f64::from(material.opacity);
            if let Some(placed) = self.textures.get(id as usize) {
                let normal = point.gradient.try_normalize().unwrap_or(-ray.direction);
                let seen = textured_point(ray.direction, point.t, normal, self.footprint);
                let space = copy.map(|(instancer, copy)| world_from_copy(instancer, copy).inverse());
                let space = space.map(|space| space * DAffine3::from_translation(self.eye));
                let detail = if threshold > 0.0 { CUT_FOOTPRINT } else { 1.0 };
                let own = textured_opacity(&self.flat.textures, placed, &seen, space, detail);
                opacity = own.unwrap_or(opacity);
            }
            if threshold > 0.0 {
                opacity = f64::from(u8::from(opacity >= threshold));
            }
            sum += opacity * weight;
            whole += weight;
        }
        sum / whole.max(1e-30)
    }
}

/// The layer of a surface, see [`coverage_threshold`]: the surfaces of a ray are independent of each other.
fn veil_layer(point: &VeilPoint<'_>) -> u32 {
    let of_copy = point.copy.map_or(0, |copy| {
        let [x, y, z] = copy.cell.map(|cell| cell as u32);
        coverage_hash(x.wrapping_add(coverage_hash(y.wrapping_add(coverage_hash(z)))))
    });
    coverage_hash(point.component).wrapping_add(of_copy).wrapping_add(point.passed)
}
