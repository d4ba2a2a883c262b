//! What lets light through: panes that are blended, lattices cut out by textures, a ball in a ball, and a joint of clear
//! and solid.

use glam::DQuat;

use super::scene_builder::{SceneBuilder, blended, cuboid, object, sphere, turn_x, turn_y, v};
use isolith_scene::{
    Attachment, BlendKernel, ColorSpace, ColorTexture, Material, MaterialId, OpacityTexture, Operator, Scene,
    Shadowing, Shape, TextureImage, TextureSpace, TextureWrap, Textures,
};

/// Opacity of the panes, from left to right.
const PANES: [f64; 3] = [0.25, 0.45, 0.7];

pub(super) fn scene() -> Scene {
    let mut builder = SceneBuilder::new([0.30, 0.40, 0.54], [0.62, 0.62, 0.60], [0.24, 0.26, 0.30]);
    builder.shade(Shadowing::default());
    let floor = builder.material(floor());
    builder.add(None, object("Floor", cuboid(13.0, 0.4, 10.0, 0.0), floor).at(v(0.0, -0.2, -0.5)));
    let clay = builder.matte("Clay", [0.66, 0.30, 0.18]);
    let chalk = builder.matte("Chalk", [0.78, 0.76, 0.72]);
    let steel = builder.metal("Steel", [0.56, 0.57, 0.58], 0.35);
    let tints = [[0.10, 0.34, 0.62], [0.08, 0.44, 0.24], [0.60, 0.30, 0.06]];
    for (at, (opacity, tint)) in (0..).zip(PANES.into_iter().zip(tints)) {
        let glass = builder.material(glass(&format!("Glass {opacity}"), tint, opacity));
        let x = 1.5 * f64::from(at) - 3.4;
        builder
            .add(None, object("Pane", cuboid(1.3, 1.7, 0.06, 0.02), glass).at(v(x, 0.86, 0.9)).rotated(turn_y(14.0)));
        builder.add(None, object("Behind", sphere(0.42), clay).at(v(x - 0.2, 0.42, -0.3)));
    }
    let bubble = builder.material(glass("Bubble", [0.62, 0.70, 0.78], 0.18));
    builder.add(None, object("Bubble", sphere(0.72), bubble).at(v(1.6, 0.73, 0.7)));
    builder.add(None, object("Kernel", sphere(0.3), clay).at(v(1.6, 0.66, 0.7)));

    let lattice = builder.material(lattice());
    let tower = Shape::Cylinder { radius: 0.62, height: 2.2, rounding: 0.05 };
    builder.add(None, object("Lattice", tower, lattice).at(v(3.5, 1.11, -0.4)));
    builder.add(None, object("Core", cuboid(0.34, 2.0, 0.34, 0.04), steel).at(v(3.5, 1.0, -0.4)));
    let plate = builder.material(holes());
    let turned: DQuat = turn_y(-24.0) * turn_x(-12.0);
    builder.add(None, object("Plate", cuboid(2.0, 1.5, 0.08, 0.02), plate).at(v(-0.6, 1.2, -2.4)).rotated(turned));

    let joint = builder.add(None, blended("Joint", Operator::Union, BlendKernel::Cubic, 0.4));
    let clear = builder.material(glass("Clear", [0.70, 0.16, 0.20], 0.2));
    builder.add(joint, object("Solid", cuboid(0.8, 0.9, 0.8, 0.1), chalk).at(v(3.0, 0.46, 2.3)));
    builder.add(joint, object("Clear", sphere(0.45), clear).at(v(3.7, 0.9, 2.4)));
    let sun = isolith_scene::LightKind::Sun { strength: 3.4, angle: 2.0 };
    builder.light("Sun", [[-0.85, 0.75, 0.4], [0.0; 3]], [1.0, 0.94, 0.84], sun);
    builder.camera([0.4, 2.9, 8.4], [0.1, 0.7, -0.2], 46.0);
    builder.finish()
}

/// A tinted glass of this opacity.
fn glass(name: &str, base_color: [f64; 3], geometry_opacity: f64) -> Material {
    Material { geometry_opacity, specular_roughness: 0.05, ..Material::new(MaterialId(0), name, base_color) }
}

fn floor() -> Material {
    let mut textures = Textures::triplanar();
    if let Textures::Triplanar { color, space, sharpness, .. } = &mut textures {
        *color = ColorTexture::Checker { first: [0.58, 0.56, 0.52], second: [0.42, 0.42, 0.42], scale: 1.0 };
        (*space, *sharpness) = (TextureSpace::World, 16.0);
    }
    Material { textures, specular_roughness: 0.5, ..Material::new(MaterialId(0), "Floor", [0.5; 3]) }
}

/// Bars of brass with nothing between them.
fn lattice() -> Material {
    let mut textures = Textures::triplanar();
    if let Textures::Triplanar { opacity, size, sharpness, .. } = &mut textures {
        *opacity = OpacityTexture::Bricks { first: 0.0, second: 1.0, scale: 2.0, row: 0.5, joint: 0.2 };
        (*size, *sharpness) = (1.0, 32.0);
    }
    let brass = Material::new(MaterialId(0), "Brass lattice", [0.91, 0.778, 0.423]);
    Material { textures, opacity_threshold: 0.5, base_metalness: 1.0, specular_roughness: 0.3, ..brass }
}

/// A plate with round holes, by an image.
fn holes() -> Material {
    let mut textures = Textures::triplanar();
    if let Textures::Triplanar { opacity, size, sharpness, .. } = &mut textures {
        *opacity = OpacityTexture::Image {
            image: Attachment::<TextureImage>::painted("hole.png", [64, 64], hole),
            color_space: ColorSpace::Linear,
            wrap: TextureWrap::Repeat,
            scale: 1.0,
        };
        (*size, *sharpness) = (0.4, 32.0);
    }
    let enamel = Material::new(MaterialId(0), "Perforated enamel", [0.05, 0.30, 0.42]);
    Material { textures, opacity_threshold: 0.5, specular_roughness: 0.2, ..enamel }
}

/// White with a soft black disc in the middle.
fn hole(x: u32, y: u32) -> [u8; 3] {
    let from_middle = |at: u32| f64::from(at) - 31.5;
    let away = (from_middle(x).powi(2) + from_middle(y).powi(2)).sqrt();
    [((away - 15.0) * 32.0 + 128.0).clamp(0.0, 255.0) as u8; 3]
}
