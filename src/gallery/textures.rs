//! Textures: one image projected onto rounded cubes with several powers of the normal, balls with every pattern, and a
//! joint of two textures at three moments of a movement.

use glam::DQuat;

use super::scene_builder::{SceneBuilder, blended, cuboid, object, sphere, turn_x, turn_y, v};
use isolith_scene::{
    Attachment, BlendKernel, ColorSpace, ColorTexture, HeightTexture, Material, MaterialId, Operator, RoughnessTexture,
    Scene, TextureImage, TextureSpace, TextureWrap, Textures,
};

/// The powers of the normal.
const POWERS: [f64; 4] = [1.0, 4.0, 16.0, 64.0];

pub(super) fn scene() -> Scene {
    let mut builder = SceneBuilder::new([0.10, 0.14, 0.22], [0.40, 0.42, 0.46], [0.30, 0.31, 0.34]);
    let floor = builder.material(floor());
    let slab = cuboid(11.0, 0.2, 9.0, 0.02);
    builder.add(None, object("Floor", slab, floor).at(v(0.0, -0.1, -1.0)));

    let image = Attachment::<isolith_scene::TextureImage>::painted("tile.png", [64, 64], tile);
    for (at, power) in (0..).zip(POWERS) {
        let material = builder.material(projected(&image, power));
        let cube = object(&format!("Power {power}"), cuboid(1.2, 1.2, 1.2, 0.45), material);
        let turned: DQuat = turn_y(35.0) * turn_x(20.0);
        builder.add(None, cube.at(v(1.7 * f64::from(at) - 2.55, 0.85, -2.2)).rotated(turned));
    }
    for (at, material) in (0..).zip(patterns()) {
        let name = material.name.clone();
        let material = builder.material(material);
        let ball = object(&name, sphere(0.55), material).rotated(turn_y(30.0) * turn_x(-25.0));
        builder.add(None, ball.at(v(1.4 * f64::from(at) - 2.8, 0.56, -0.5)));
    }
    let [stone, veined] = [bricks(), marble()].map(|material| builder.material(material));
    for moment in 0..3 {
        let x = 2.4 * f64::from(moment) - 2.7;
        let joint = builder.add(None, blended("Joint", Operator::Union, BlendKernel::Cubic, 0.35));
        builder.add(joint, object("Post", cuboid(1.0, 1.1, 0.9, 0.06), stone).at(v(x - 0.3, 0.5, 1.2)));
        let moved = 0.3 + 0.25 * f64::from(moment);
        builder.add(joint, object("Ball", sphere(0.5), veined).at(v(x + moved, 0.75, 1.35)));
    }
    builder.sun("Sun", [-0.6, 1.0, 0.7], [1.0, 0.95, 0.86], 1.5);
    builder.sun("Fill", [1.0, 0.4, 0.5], [0.6, 0.75, 1.0], 0.4);
    builder.camera([0.0, 4.6, 8.6], [0.0, 0.25, -0.5], 38.0);
    builder.finish()
}

/// A mapping with these textures.
fn textured(name: &str, textures: Textures) -> Material {
    Material { textures, specular_roughness: 0.45, ..Material::new(MaterialId(0), name, [0.5; 3]) }
}

/// A copy of the default mapping with other textures, tile size and space.
fn mapped(color: ColorTexture, other: [f64; 2], in_space: TextureSpace) -> Textures {
    let mut textures = Textures::triplanar();
    if let Textures::Triplanar { color: c, size, sharpness, space, .. } = &mut textures {
        (*c, *size, *sharpness, *space) = (color, other[0], other[1], in_space);
    }
    textures
}

fn floor() -> Material {
    let squares = ColorTexture::Checker { first: [0.30, 0.29, 0.27], second: [0.12, 0.13, 0.15], scale: 1.0 };
    textured("Floor", mapped(squares, [1.0, 16.0], TextureSpace::World))
}

fn projected(image: &Attachment<TextureImage>, power: f64) -> Material {
    let color = ColorTexture::Image {
        image: image.clone(),
        color_space: ColorSpace::Srgb,
        wrap: TextureWrap::Repeat,
        scale: 1.0,
    };
    textured(&format!("Projected, power {power}"), mapped(color, [0.8, power], TextureSpace::Object))
}

/// The image of the cubes: a bright frame, and a letter that shows which way is up.
fn tile(x: u32, y: u32) -> [u8; 3] {
    let edge = x < 4 || y < 4 || x >= 60 || y >= 60;
    let stem = (20..28).contains(&x) && (12..52).contains(&y);
    let arms = (20..46).contains(&x) && ((12..20).contains(&y) || (28..36).contains(&y) && x < 40);
    match (edge, stem || arms) {
        (true, _) => [236, 226, 200],
        (_, true) => [250, 246, 236],
        _ => [(30 + 2 * x) as u8, (70 + y) as u8, (150 - x) as u8],
    }
}

fn bricks() -> Material {
    let (first, second) = ([0.42, 0.13, 0.07], [0.55, 0.52, 0.47]);
    let (scale, row, joint) = (3.0, 0.4, 0.06);
    let color = ColorTexture::Bricks { first, second, scale, row, joint };
    let mut textures = mapped(color, [1.0, 16.0], TextureSpace::Object);
    if let Textures::Triplanar { height, bump, .. } = &mut textures {
        *height = HeightTexture::Bricks { first: 1.0, second: 0.0, scale, row, joint };
        *bump = 0.01;
    }
    textured("Bricks", textures)
}

fn marble() -> Material {
    let color = ColorTexture::Marble {
        first: [0.74, 0.72, 0.68],
        second: [0.07, 0.10, 0.13],
        scale: 3.0,
        turbulence: 1.4,
        seed: 3,
    };
    textured("Marble", mapped(color, [1.0, 4.0], TextureSpace::Object))
}

/// A material for each pattern.
fn patterns() -> Vec<Material> {
    let rust =
        ColorTexture::Noise { first: [0.08, 0.03, 0.02], second: [0.62, 0.26, 0.09], scale: 5.0, layers: 6, seed: 1 };
    let mut rough = mapped(rust, [1.0, 4.0], TextureSpace::Object);
    if let Textures::Triplanar { roughness, height, bump, .. } = &mut rough {
        *roughness = RoughnessTexture::Noise { first: 0.25, second: 0.9, scale: 5.0, layers: 6, seed: 1 };
        *height = HeightTexture::Noise { first: 0.0, second: 1.0, scale: 5.0, layers: 4, seed: 1 };
        *bump = 0.06;
    }
    let squares = ColorTexture::Checker { first: [0.75, 0.72, 0.66], second: [0.05, 0.16, 0.30], scale: 3.0 };
    let wood =
        ColorTexture::Wood { first: [0.50, 0.28, 0.12], second: [0.22, 0.10, 0.04], scale: 9.0, turbulence: 0.7 };
    vec![
        textured("Rust", rough),
        textured("Squares", mapped(squares, [1.0, 8.0], TextureSpace::Object)),
        bricks(),
        textured("Wood", mapped(wood, [1.0, 4.0], TextureSpace::Object)),
        marble(),
    ]
}
