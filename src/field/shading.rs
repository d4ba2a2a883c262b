//! Viewport shading: a flat scene under other lights, and in other materials. Geometry and ids stay as they are.

use std::str::FromStr;
use std::sync::{Arc, OnceLock};

use glam::DVec3;

use super::arrays::FlatScene;
use super::flat_material::FlatMaterial;
use super::flat_texture::FlatTextures;
use super::light::environment_map::{EnvironmentMap, PlacedMap};
use super::studio::StudioLook;
use isolith_scene::{DisplaySettings, Environment, EnvironmentKind, Shadowing};

/// How a lit picture shows a scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shading {
    /// Its shapes: one clay for everything, under a studio light.
    Solid,
    /// Its shapes in white glaze, under large soft lights.
    Porcelain,
    /// Its shapes in metal.
    Bronze,
    /// Its shapes in red wax, whose edges shine.
    Wax,
    /// Its materials, under a studio light.
    Material,
    /// Its materials under its own lights.
    #[default]
    Rendered,
}

impl Shading {
    /// Every shading, in the order of menus.
    pub const ALL: [Self; 6] = [Self::Solid, Self::Porcelain, Self::Bronze, Self::Wax, Self::Material, Self::Rendered];
    /// Those that a click reaches at once, and that follow each other.
    pub const MAIN: [Self; 3] = [Self::Solid, Self::Material, Self::Rendered];

    /// The one of [`Shading::MAIN`] that it is a kind of.
    pub fn main(self) -> Self {
        match self {
            Self::Solid | Self::Porcelain | Self::Bronze | Self::Wax => Self::Solid,
            other => other,
        }
    }

    /// What it lights a scene with, unless it is rendered.
    fn studio(self) -> StudioLook {
        match self {
            Self::Porcelain => StudioLook::Porcelain,
            Self::Bronze => StudioLook::Bronze,
            Self::Wax => StudioLook::Wax,
            Self::Material => StudioLook::Preview,
            Self::Solid | Self::Rendered => StudioLook::Clay,
        }
    }

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Solid => "solid",
            Self::Porcelain => "porcelain",
            Self::Bronze => "bronze",
            Self::Wax => "wax",
            Self::Material => "material",
            Self::Rendered => "rendered",
        }
    }

    /// Its name in menus.
    pub fn label(self) -> &'static str {
        match self {
            Self::Solid => "Solid",
            Self::Porcelain => "Solid, porcelain",
            Self::Bronze => "Solid, bronze",
            Self::Wax => "Solid, wax",
            Self::Material => "Material Preview",
            Self::Rendered => "Rendered",
        }
    }

    /// One sentence about what it shows.
    pub fn help(self) -> &'static str {
        match self {
            Self::Porcelain => "Shapes only: white glaze, whose reflections show how smooth a surface is",
            Self::Bronze => "Shapes only: metal, whose highlights show creases and bumps",
            Self::Wax => "Shapes only: red wax, whose edges shine",
            Self::Solid => "Shapes only: clay under a studio light that follows the view",
            Self::Material => "The materials under a studio light that follows the view, without the scene's lights",
            Self::Rendered => "The materials under the lights and the environment of the scene",
        }
    }
}

impl FromStr for Shading {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let names = Self::ALL.map(Self::name).join(", ");
        Self::ALL.into_iter().find(|shading| shading.name() == name).ok_or(format!("it is none of {names}"))
    }
}

impl FlatScene {
    /// The scene as a shading shows it. Without lights of its own it gets the studio light, see [`super::gpu_lights`].
    pub fn shaded(self: &Arc<Self>, shading: Shading) -> Arc<Self> {
        if shading == Shading::Rendered {
            return Arc::clone(self);
        }
        let mut shown = Self::clone(self);
        shown.lights.clear();
        shown.studio = shading.studio();
        shown.environment = shown.studio.environment();
        shown.display = DisplaySettings::default();
        shown.environment_map = None;
        if shading.main() == Shading::Solid {
            shown.wear(shown.studio.material());
        }
        Arc::new(shown)
    }

    /// The scene in such light and matter that the light of each pixel is the base color of what is seen: diffuse
    /// surfaces in white surroundings.
    pub fn in_base_colors(&self) -> Arc<Self> {
        let mut shown = Self::clone(self);
        shown.lights.clear();
        shown.environment =
            Environment { background: EnvironmentKind::Color { color: [1.0; 3] }, shadowing: Shadowing::off() };
        // Pictures share it: to compute one takes longer than a small picture.
        static WHITE: OnceLock<Option<PlacedMap>> = OnceLock::new();
        let white = WHITE.get_or_init(|| {
            // Light from everywhere alike is the first harmonic alone; the sum over texels has it to three digits.
            let mut white = PlacedMap::of(&shown.environment)?;
            let mut harmonics = [DVec3::ZERO; 9];
            harmonics[0] = DVec3::ONE;
            white.map = Arc::new(EnvironmentMap { harmonics, ..EnvironmentMap::clone(&white.map) });
            Some(white)
        });
        shown.environment_map = white.clone();
        for material in &mut shown.materials {
            let base_color = material.base_color;
            *material =
                FlatMaterial { base_color, phong_weight: 1.0, phong_specular: 0.0, emission: [0.0; 3], ..*material };
        }
        Arc::new(shown)
    }

    /// Gives everything one material.
    fn wear(&mut self, material: FlatMaterial) {
        if self.materials.is_empty() && !self.meshes.is_empty() {
            self.materials.push(material);
        }
        self.materials.fill(material);
        self.textures = FlatTextures::default();
        for mesh in &mut self.meshes {
            mesh.material = Some(0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{flatten, gpu_lights};
    use isolith_geometry::Camera;
    use isolith_scene::{Light, Material, MaterialId, Node, NodeKind, Object, Scene, ShapeKind};

    /// Balls of two materials and a sun.
    fn scene() -> Arc<FlatScene> {
        let mut scene = Scene::new();
        let red = Material { emission_luminance: 2.0, ..Material::new(MaterialId(2), "Red", [0.9, 0.1, 0.1]) };
        scene.insert_material(red).unwrap();
        for id in [1, 2] {
            let object = Object { shape: ShapeKind::Sphere.default_shape(), material: MaterialId(id) };
            let node = Node::new("Ball", NodeKind::Object(object)).at(DVec3::X * 3.0 * id as f64);
            scene.insert(None, 0, node).unwrap();
        }
        scene.insert(None, 0, Node::new("Sun", NodeKind::Light(Light::sun()))).unwrap();
        Arc::new(flatten(&scene, 0.0).unwrap())
    }

    #[test]
    fn only_light_and_matter_differ() {
        let flat = scene();
        let camera = Camera::looking_at(DVec3::Z * 9.0, DVec3::ZERO, 0.7);
        assert!(Arc::ptr_eq(&flat, &flat.shaded(Shading::Rendered)));
        let [solid, material] = [Shading::Solid, Shading::Material].map(|shading| flat.shaded(shading));
        for shown in [&solid, &material] {
            assert!((&shown.nodes, &shown.params, &shown.ids) == (&flat.nodes, &flat.params, &flat.ids));
            assert_eq!((&shown.components, &shown.cameras), (&flat.components, &flat.cameras));
            assert_ne!(gpu_lights(shown, &camera, [64, 64]), gpu_lights(&flat, &camera, [64, 64]));
        }
        assert_eq!(material.materials, flat.materials);
        assert_eq!(solid.materials.len(), flat.materials.len());
        assert!(solid.materials.iter().all(|m| *m == StudioLook::Clay.material() && m.emission == [0.0; 3]));
    }

    #[test]
    fn the_studio_light_follows_the_view() {
        let solid = scene().shaded(Shading::Solid);
        let [front, back] = [DVec3::Z, DVec3::NEG_Z]
            .map(|at| gpu_lights(&solid, &Camera::looking_at(at * 9.0, DVec3::ZERO, 0.7), [64, 64])[0].direction[2]);
        assert!(front < 0.0 && back > 0.0, "{front} {back}");
    }

    #[test]
    fn kinds_of_solid_differ_in_material_and_light() {
        let camera = Camera::looking_at(DVec3::Z * 9.0, DVec3::ZERO, 0.7);
        let solids: Vec<_> = Shading::ALL.into_iter().filter(|shading| shading.main() == Shading::Solid).collect();
        assert_eq!(solids.len(), 4);
        let shown = solids.iter().map(|shading| scene().shaded(*shading));
        let looks: Vec<_> = shown.map(|flat| (flat.materials[0], gpu_lights(&flat, &camera, [64, 64]))).collect();
        for (at, look) in looks.iter().enumerate() {
            assert!(looks[at + 1..].iter().all(|other| other.0 != look.0 && other.1 != look.1), "{:?}", solids[at]);
        }
    }

    #[test]
    fn names_are_read_back() {
        for shading in Shading::ALL {
            assert_eq!(shading.name().parse(), Ok(shading));
        }
        assert_eq!(
            "matcap".parse::<Shading>(),
            Err("it is none of solid, porcelain, bronze, wax, material, rendered".to_owned())
        );
    }
}
