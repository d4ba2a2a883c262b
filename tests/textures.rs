//! Textures: the pictures of both evaluators agree, and textures stay where they belong.

use glam::{DQuat, DVec3};
use isolith::field::eval::surface;
use isolith::field::light::texture::{textured_mixture, textured_point};
use isolith::field::reference::image::render_reference;
use isolith::field::{FlatScene, flatten, gpu_textures};
use isolith::geometry::Camera;
use isolith::render::EvalStrategy;
use isolith::scene::{
    Attachment, ColorSpace, ColorTexture, Material, MaterialId, Modifier, Node, NodeKind, Object, Scene, Shape,
    TextureImage, TextureSpace, TextureWrap, Textures, file,
};

use crate::gpu::{BenchScene, scenes};

/// A material with this texture of its color.
fn textured(id: u64, color: ColorTexture, in_space: TextureSpace) -> Material {
    let mut textures = Textures::triplanar();
    if let Textures::Triplanar { color: c, space, .. } = &mut textures {
        (*c, *space) = (color, in_space);
    }
    Material { textures, ..Material::new(MaterialId(id), "Textured", [0.5; 3]) }
}

fn marble() -> ColorTexture {
    ColorTexture::Marble { first: [0.9; 3], second: [0.1, 0.2, 0.3], scale: 3.0, turbulence: 1.0, seed: 1 }
}

fn squares() -> ColorTexture {
    ColorTexture::Checker { first: [1.0; 3], second: [0.0; 3], scale: 4.0 }
}

fn image(side: u32, name: &str) -> Attachment<TextureImage> {
    Attachment::<TextureImage>::painted(name, [side, side], |x, y| {
        [(x * 255 / side) as u8, (y * 255 / side) as u8, ((x ^ y) & 255) as u8]
    })
}

fn pictured(image: Attachment<TextureImage>) -> ColorTexture {
    ColorTexture::Image { image, color_space: ColorSpace::Srgb, wrap: TextureWrap::Mirror, scale: 1.5 }
}

/// A scene of one object with this material; `place` moves it.
fn scene(material: Material, shape: Shape, place: impl FnOnce(Node) -> Node) -> Scene {
    let mut scene = Scene::new();
    let id = material.id;
    scene.insert_material(material).expect("a new material");
    let node = place(Node::new("Thing", NodeKind::Object(Object { shape, material: id })));
    scene.insert(None, 0, node).expect("room");
    scene
}

/// The color of the surface at a point of the world, as seen from `eye` with pixels of this width.
fn color_at(flat: &FlatScene, at: DVec3, eye: DVec3, footprint: f64) -> DVec3 {
    let camera = Camera::looking_at(eye, at, 0.7);
    let component = &flat.components[0];
    let point = surface(flat, component, at - component.origin);
    let way = at - eye;
    let there = textured_point(way.normalize(), way.length(), point.gradient.normalize(), footprint);
    let placed = gpu_textures(flat, &camera);
    textured_mixture(&point.materials, flat, &placed, &there, None).0.base_color
}

const BOX: Shape = Shape::Box { size: [1.0, 1.2, 0.8], rounding: 0.1 };

#[test]
fn the_picture_is_that_of_the_reference() {
    const SIDE: u32 = 96;
    let shipped = scenes().find(|scene| scene.name == "textures").expect("it is shipped");
    let picture = shipped.render(SIDE, EvalStrategy::Interpreter);
    let truth =
        render_reference(&shipped.flat, &shipped.meshes, &shipped.camera, [SIDE, SIDE], &|_| ()).expect("an end");
    let same = |i: &usize| picture.leaf[*i] == truth.buffers.leaf[*i] && !truth.turned.contains_key(i);
    let pixels: Vec<usize> = (0..picture.color.len()).filter(same).collect();
    let off = |i: usize| {
        let (a, b) = (picture.color[i], truth.buffers.color[i]);
        a.iter().zip(b).map(|(a, b)| a.abs_diff(b)).max().unwrap_or(0)
    };
    let wrong = pixels.iter().filter(|i| off(**i) > 2).count();
    assert!(pixels.len() > 8_000, "{}", pixels.len());
    assert!(wrong as f64 <= 0.002 * pixels.len() as f64, "{wrong} of {} pixels differ", pixels.len());
}

#[test]
fn textures_move_and_turn_with_their_object_and_scale_unless_fixed() {
    let turn = DQuat::from_rotation_y(0.7) * DQuat::from_rotation_x(0.4);
    let shift = DVec3::new(3.0, -2.0, 5.0);
    for color in [marble(), squares(), pictured(image(32, "a.png"))] {
        for space in TextureSpace::ALL {
            let still = scene(textured(7, color.clone(), space), BOX, |node| node);
            let moved = scene(textured(7, color.clone(), space), BOX, |node| node.at(shift).rotated(turn));
            let scaled = scene(textured(7, color.clone(), space), BOX, |mut node| {
                node.transform.scale = DVec3::splat(2.0);
                node
            });
            let [still, moved, scaled] =
                [still, moved, scaled].map(|scene| flatten(&scene, 0.0).expect("within limits"));
            let mut differences = [0.0_f64; 2];
            for i in 0..40 {
                let side = f64::from(i % 8) / 8.0 - 0.44;
                let local = DVec3::new(side, f64::from(i / 8) / 6.0 - 0.31, 0.4);
                let eye = local + DVec3::new(0.2, 0.3, 2.0);
                let seen = color_at(&still, local, eye, 1e-3);
                let other = color_at(&moved, turn * local + shift, turn * eye + shift, 1e-3);
                // Twice the size from twice the distance.
                let larger = color_at(&scaled, local * 2.0, eye * 2.0, 1e-3);
                differences[0] = differences[0].max((seen - other).abs().max_element());
                differences[1] = differences[1].max((seen - larger).abs().max_element());
            }
            let stays = [space != TextureSpace::World, space == TextureSpace::Object];
            for (difference, stays) in differences.into_iter().zip(stays) {
                assert!(if stays { difference < 1e-3 } else { difference > 0.1 }, "{space:?} {color:?}: {difference}");
            }
        }
    }
}

#[test]
fn textures_are_steady_far_from_the_origin() {
    for space in TextureSpace::ALL {
        let colors = [10_000.0, 0.0].map(|far: f64| {
            // A whole number of tiles, so that those of the world are the same.
            let shift = DVec3::new(far, 0.0, -far);
            let flat =
                flatten(&scene(textured(7, squares(), space), BOX, |node| node.at(shift)), 0.0).expect("within limits");
            let color = |i: u32| {
                let local = DVec3::new(f64::from(i) * 0.0101 - 0.4, 0.07, 0.4);
                color_at(&flat, local + shift, local + shift + DVec3::new(0.1, 0.1, 1.0), 1e-3)
            };
            (0..80).map(color).collect::<Vec<_>>()
        });
        let off = colors[0].iter().zip(&colors[1]).map(|(a, b)| (*a - *b).abs().max_element()).fold(0.0, f64::max);
        assert!(off < 0.02, "{space:?}: {off}");
    }
}

#[test]
fn far_patterns_tend_to_their_mean() {
    let noise = ColorTexture::Noise { first: [0.0; 3], second: [1.0; 3], scale: 4.0, layers: 6, seed: 0 };
    let bricks = ColorTexture::Bricks { first: [1.0; 3], second: [0.0; 3], scale: 4.0, row: 0.4, joint: 0.1 };
    let lines = Attachment::<TextureImage>::painted("lines.png", [64, 64], |x, _| [(255 * (x & 1)) as u8; 3]);
    for (color, mean) in [(squares(), 0.5), (noise, 0.5), (bricks, 0.9 * 0.75), (pictured(lines), 0.5)] {
        let flat = flatten(&scene(textured(7, color.clone(), TextureSpace::Object), Shape::Plane {}, |node| node), 0.0);
        let flat = flat.expect("within limits");
        let values = |height: f64| {
            let at = |i: u32| DVec3::new(f64::from(i) * 0.377, 0.0, f64::from(i * i % 97) * 0.211);
            (0..200)
                .map(|i| color_at(&flat, at(i), at(i) + DVec3::new(0.1, 1.0, 0.2) * height, 1e-3).x)
                .collect::<Vec<_>>()
        };
        let spread = |values: &[f64]| {
            let middle = values.iter().sum::<f64>() / values.len() as f64;
            let variance = values.iter().map(|v| (v - middle).powi(2)).sum::<f64>() / values.len() as f64;
            (middle, variance.sqrt())
        };
        let ((_, near), (middle, far)) = (spread(&values(3.0)), spread(&values(2_000.0)));
        assert!(near > 0.08, "{color:?}: {near} near");
        assert!((middle - mean).abs() < 0.03 && far < 0.03, "{color:?}: {middle} ± {far} far, not {mean}");
    }
}

#[test]
fn textures_repeat_with_arrays() {
    let array = Modifier::Repeat {
        counts: [4, 3, 0],
        spacing: [2.1, 1.7, 3.3],
        offset: [0.35, 0.0, 0.0],
        turn: 0.0,
        mirrored: [false; 3],
        carve_from: [0; 3],
        carve_to: [0; 3],
    };
    for color in [marble(), squares(), pictured(image(32, "a.png"))] {
        let material = textured(7, color, TextureSpace::Object);
        let turn = DQuat::from_rotation_y(0.7);
        let shift = DVec3::new(3.0, -2.0, 5.0);
        let place = |node: Node| node.at(shift).rotated(turn).modified(array.clone());
        let flat = flatten(&scene(material, BOX, place), 0.0).expect("within limits");
        // From the cell of the eye to copies before and behind it; Z has no end.
        let first = |i: u32| DVec3::new(f64::from(i) * 0.05 - 0.4, 0.17, 0.4);
        let seen = |i: u32, cell: DVec3| {
            let local = first(i) + cell * DVec3::new(2.1, 1.7, 3.3) + DVec3::X * (0.35 * cell.y);
            let at = turn * local + shift;
            color_at(&flat, at, at + turn * DVec3::new(0.2, 0.3, 0.9), 1e-3)
        };
        for cell in [DVec3::new(3.0, 0.0, 0.0), DVec3::new(1.0, 2.0, -5.0), DVec3::new(0.0, 1.0, 900.0)] {
            let off = (0..16).map(|i| (seen(i, cell) - seen(i, DVec3::ZERO)).abs().max_element()).fold(0.0, f64::max);
            assert!(off < 1e-3, "{cell}: {off}");
        }
        let differs = (0..15).map(|i| (seen(i, DVec3::ZERO) - seen(i + 1, DVec3::ZERO)).length()).fold(0.0, f64::max);
        assert!(differs > 0.02, "{differs}");
    }
}

#[test]
fn two_hundred_textures_of_many_sizes_are_each_shown() {
    let mut scene = Scene::new();
    for i in 0..200_u32 {
        let [r, g] = [(i % 15) as u8 * 17, (i / 15) as u8 * 17];
        let image =
            Attachment::<TextureImage>::painted(&format!("{i}.png"), [1 + i % 40, 1 + i / 3], |_, _| [r, g, 90]);
        let material = textured(u64::from(i) + 2, pictured(image), TextureSpace::Object);
        let object = Object { shape: Shape::Sphere { radius: 0.4 }, material: material.id };
        scene.insert_material(material).expect("a new material");
        let place = DVec3::new(f64::from(i % 20) - 9.5, f64::from(i / 20) - 4.5, 0.0);
        scene.insert(None, usize::MAX, Node::new("Ball", NodeKind::Object(object)).at(place)).expect("room");
    }
    let mut drawn = BenchScene::new("many textures", &scene, None);
    assert_eq!((drawn.flat.textures.sets.len(), drawn.flat.textures.images.len()), (200, 200));
    assert_eq!(drawn.flat.warnings, []);
    drawn.camera = Camera::looking_at(DVec3::new(0.0, 0.0, 24.0), DVec3::ZERO, 0.85);
    let picture = drawn.render(160, EvalStrategy::Interpreter);
    let truth = render_reference(&drawn.flat, &drawn.meshes, &drawn.camera, [160, 160], &|_| ()).expect("an end");
    let mut seen = std::collections::HashSet::new();
    for i in
        (0..picture.color.len()).filter(|i| picture.leaf[*i] == truth.buffers.leaf[*i] && !truth.turned.contains_key(i))
    {
        let off = picture.color[i].iter().zip(truth.buffers.color[i]).map(|(a, b)| a.abs_diff(b)).max();
        assert!(off <= Some(2), "{:?} {:?}", picture.color[i], truth.buffers.color[i]);
        seen.extend(truth.nodes[i]);
    }
    assert_eq!(seen.len(), 200);
}

#[test]
fn images_beyond_the_budget_are_reduced_with_a_warning() {
    let large =
        Attachment::<TextureImage>::painted("large.png", [8192, 4500], |x, y| [(x & 255) as u8, (y & 255) as u8, 0]);
    let flat = flatten(&scene(textured(7, pictured(large), TextureSpace::Object), BOX, |node| node), 0.0);
    let flat = flat.expect("within limits");
    let [warning] = &flat.warnings[..] else { panic!("{:?}", flat.warnings) };
    let meant = "shows the image \"large.png\" of its material \"Textured\" at 1/2 of its size: the images of textures \
                 take more than 127 MiB";
    assert_eq!((&*warning.name, &*warning.reason), ("Thing", meant));
    assert!(flat.textures.image_bytes() < 127 << 20);
}

#[test]
fn a_moved_object_gives_the_same_textures_as_a_fresh_start() {
    let mut scene = scene(textured(7, squares(), TextureSpace::Object), BOX, |node| node);
    let object = Object { shape: Shape::Sphere { radius: 0.5 }, material: MaterialId(7) };
    let ring = Modifier::Polar { count: 3, radius: 2.0, mirrored: false };
    let ball = Node::new("Balls", NodeKind::Object(object)).modified(ring);
    let id = scene.insert(None, 1, ball).expect("room");
    let mut flattener = isolith::field::Flattener::default();
    let placed = flattener.flatten(&scene, 0.0).expect("within limits").textures.placed.len();
    assert_eq!(placed, 4, "one for the box, three for the copies of the ball");
    for x in [0.5, 0.8] {
        let mut node = Node::clone(scene.node(id).expect("it is there"));
        node.transform.translation.x = x;
        scene.replace(node).expect("valid");
        let again = flattener.flatten(&scene, 0.0).expect("within limits");
        assert_eq!(*again, flatten(&scene, 0.0).expect("within limits"));
    }
}

#[test]
fn a_material_without_textures_costs_nothing() {
    let text = |material| {
        let scene = scene(material, BOX, |node| node);
        let text = file::to_json(&scene).expect("valid");
        assert_eq!(file::parse(text.as_bytes(), "a.json".as_ref()).expect("it was written"), scene);
        text
    };
    assert!(!text(Material::new(MaterialId(7), "Plain", [0.5; 3])).contains("textures"));
    assert!(text(textured(7, pictured(image(4, "a.png")), TextureSpace::FixedSize)).contains("\"textures\""));
    let flat = flatten(&scene(Material::new(MaterialId(7), "Plain", [0.5; 3]), BOX, |node| node), 0.0);
    assert_eq!(flat.expect("within limits").textures, isolith::field::FlatTextures::default());
}
