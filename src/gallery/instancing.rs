//! Scenes of copies: dynamics compared, a meadow in the wind, balloons on the sea, a city, an asteroid belt.

use glam::DVec3;

use super::character::mesh_field;
use super::scene_builder::{
    SceneBuilder, blended, cone, cuboid, cylinder, ellipsoid, group, object, round_cone, sphere, torus,
};
use isolith_scene::{
    BlendKernel, CameraNode, Dynamic, DynamicKind, Instancer, Lattice, Mask, MaterialId, MaterialVariation, Modifier,
    Node, NodeId, NodeKind, Operator, Scene, Shadowing, Shape, Snap, Variation,
};

fn v(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

fn instancer(name: &str, instancer: Instancer) -> Node {
    Node::new(name, NodeKind::Instancer(Box::new(instancer)))
}

/// Cubes in rows, each row with another motion, seen from above; the first stands on the uniform grid.
pub(super) fn dynamics() -> Scene {
    let mut builder = SceneBuilder::new([0.55, 0.62, 0.72], [0.75, 0.78, 0.82], [0.5, 0.52, 0.56]);
    builder.shade(Shadowing::default());
    let ground = builder.matte("Ground", [0.16, 0.17, 0.2]);
    builder.add(None, object("Ground", cuboid(30.0, 0.2, 24.0, 0.0), ground).at(v(0.0, -0.1, 0.0)));
    let kinds: [Option<DynamicKind>; 12] = [
        None,
        Some(DynamicKind::Wind),
        Some(DynamicKind::Sway),
        Some(DynamicKind::Bob),
        Some(DynamicKind::Orbit),
        Some(DynamicKind::Pulse),
        Some(DynamicKind::Spin),
        Some(DynamicKind::Flicker),
        Some(DynamicKind::ColorCycle),
        Some(DynamicKind::RandomWalk),
        Some(DynamicKind::FractionalBrownianMotion),
        Some(DynamicKind::CurlNoise),
    ];
    for (row, kind) in kinds.into_iter().enumerate() {
        let name = kind.map_or("Uniform grid", DynamicKind::label);
        let hue = row as f64 / 12.0;
        let color = [0, 1, 2].map(|i| 0.12 + 0.6 * tint(hue, i));
        let material = if kind == Some(DynamicKind::Flicker) {
            builder.glowing(name, [0.3, 0.2, 0.1], [3.0, 1.4, 0.4])
        } else {
            builder.glossy(name, color, 0.35)
        };
        let z = 1.7 * (row as f64 - 5.5);
        let mut copies = instancer(name, Instancer::grid([14, 1, 1], [1.8, 1.0, 1.0])).at(v(0.9, 0.0, z));
        if let Some(kind) = kind {
            copies = copies.moving(kind.default_dynamic());
        }
        let copies = builder.add(None, copies);
        builder.add(copies, object("Post", cuboid(0.5, 1.1, 0.5, 0.08), material).at(v(0.0, 0.55, 0.0)));
    }
    builder.sun("Sun", [0.5, 1.0, 0.35], [1.0, 0.96, 0.9], 0.9);
    builder.camera([0.0, 24.0, 15.0], [0.0, 0.0, 0.4], 38.0);
    builder.finish()
}

/// The brightness of a primary color in a hue, from 0 to 1: straight lines, the same on every machine.
fn tint(hue: f64, primary: usize) -> f64 {
    let away = (hue - primary as f64 / 3.0).rem_euclid(1.0);
    let away = away.min(1.0 - away);
    (2.0 - 6.0 * away).clamp(0.0, 1.0)
}

/// Hills with trees and grass in the wind, both on the ground.
pub(super) fn terrain() -> Scene {
    let mut builder = SceneBuilder::new([0.22, 0.42, 0.78], [0.72, 0.8, 0.88], [0.38, 0.44, 0.52]);
    // Occlusion among the grass would take more than everything else.
    builder.shade(Shadowing { occlusion: false, ..Shadowing::default() });
    let soil = builder.matte("Soil", [0.1, 0.13, 0.045]);
    let hills = Shape::Terrain {
        size: [120.0, 6.0, 120.0],
        amplitude: 5.0,
        wavelength: 38.0,
        octaves: 4.0,
        roughness: 0.38,
        seed: 11.0,
    };
    let hills = builder.add(None, object("Hills", hills, soil));
    let wind = Dynamic::Wind {
        direction: [1.0, 0.0, 0.35],
        angle: 12.0,
        steady: 0.25,
        gust_size: 14.0,
        speed: 6.0,
        softness: 0.6,
        flutter: 1.5,
        frequency: 0.9,
        radius: 0.0,
        source: [0.0; 3],
        core: 0.0,
        radial: 0.0,
    };
    trees(&mut builder, hills, wind);
    grass(&mut builder, hills, wind);
    stones(&mut builder, hills);
    builder.sun("Sun", [-0.6, 0.55, 0.35], [1.0, 0.93, 0.8], 1.15);
    builder.camera([3.0, 5.2, 34.0], [0.0, 2.0, 8.0], 42.0);
    builder.finish()
}

fn trees(builder: &mut SceneBuilder, hills: NodeId, wind: Dynamic) {
    let bark = builder.matte("Bark", [0.11, 0.065, 0.035]);
    let needles = builder.matte("Needles", [0.025, 0.085, 0.03]);
    let leaves = builder.matte("Leaves", [0.07, 0.16, 0.025]);
    let mut forest = Instancer { target: Some(hills), seed: 7, snap: Snap::Down, ..Instancer::default() };
    forest.lattice = Lattice::Scatter { density: 0.09, minimum_distance: 2.2 };
    forest.masks = vec![
        Mask::Noise { size: 22.0, threshold: 0.42, softness: 0.25, seed: 5 }.into(),
        Mask::Slope { from: 18.0, to: 32.0 }.into(),
    ];
    forest.variation = Variation {
        looseness: 1.0,
        rotation_min: [-4.0, -180.0, -4.0],
        rotation_max: [4.0, 180.0, 4.0],
        scale_min: [0.65; 3],
        scale_max: [1.35; 3],
        ..Variation::default()
    };
    forest.material = MaterialVariation { hue: 0.03, saturation: 0.2, value: 0.35, ..MaterialVariation::default() };
    let forest = builder.add(None, instancer("Forest", forest).moving(wind));
    let fir = builder.add(forest, group("Fir", Operator::Union).weighted(2.0));
    builder.add(fir, object("Trunk", round_cone(0.16, 0.05, 3.0), bark).at(v(0.0, 0.1, 0.0)));
    builder.add(fir, object("Needles", mesh_field("models/fir.glb", 112.0), needles));
    let oak = builder.add(forest, group("Oak", Operator::Union));
    builder.add(oak, object("Wood", mesh_field("models/oak-wood.glb", 112.0), bark));
    builder.add(oak, object("Leaves", mesh_field("models/oak-leaves.glb", 96.0), leaves));
}

fn grass(builder: &mut SceneBuilder, hills: NodeId, wind: Dynamic) {
    let blade = builder.matte("Grass", [0.14, 0.24, 0.05]);
    let mut meadow = Instancer { target: Some(hills), seed: 3, snap: Snap::Down, align: 0.4, ..Instancer::default() };
    meadow.lattice = Lattice::Grid { counts: [130, 1, 110], spacing: [0.28, 1.0, 0.28] };
    meadow.probability = 0.85;
    meadow.variation = Variation {
        looseness: 1.0,
        rotation_min: [-12.0, -180.0, -12.0],
        rotation_max: [12.0, 180.0, 12.0],
        scale_min: [0.6, 0.5, 0.6],
        scale_max: [1.1, 1.3, 1.1],
        uniform: false,
        ..Variation::default()
    };
    meadow.material = MaterialVariation { hue: 0.04, saturation: 0.25, value: 0.4, ..MaterialVariation::default() };
    let meadow = builder.add(None, instancer("Meadow", meadow).at(v(0.0, 0.0, 18.0)).moving(wind));
    let tuft = builder.add(meadow, group("Tuft", Operator::Union));
    builder.add(tuft, object("Blades", mesh_field("models/tuft.glb", 80.0), blade));
}

fn stones(builder: &mut SceneBuilder, hills: NodeId) {
    let granite = builder.matte("Granite", [0.21, 0.2, 0.19]);
    let mut boulders = Instancer { target: Some(hills), seed: 9, snap: Snap::Down, align: 1.0, ..Instancer::default() };
    boulders.lattice = Lattice::Scatter { density: 0.03, minimum_distance: 1.0 };
    boulders.variation = Variation {
        looseness: 1.0,
        rotation_min: [0.0, -180.0, 0.0],
        rotation_max: [0.0, 180.0, 0.0],
        scale_min: [0.3; 3],
        scale_max: [1.4, 0.9, 1.1],
        uniform: false,
        ..Variation::default()
    };
    boulders.material = MaterialVariation { value: 0.3, ..MaterialVariation::default() };
    let boulders = builder.add(None, instancer("Boulders", boulders));
    builder.add(boulders, object("Boulder", ellipsoid(0.7, 0.45, 0.55), granite).at(v(0.0, 0.08, 0.0)));
}

/// A sea that runs with time, and a herd of balloons that it carries.
pub(super) fn ocean() -> Scene {
    let mut builder = SceneBuilder::new([0.16, 0.36, 0.72], [0.75, 0.83, 0.9], [0.4, 0.46, 0.54]);
    builder.shade(Shadowing::default());
    let water = builder.water("Water", [0.01, 0.085, 0.12]);
    let sea = Shape::Ocean {
        size: [160.0, 2.0, 160.0],
        amplitude: 0.65,
        wavelength: 11.0,
        waves: 7.0,
        direction: 25.0,
        spread: 45.0,
        sharpness: 0.6,
        phase: 0.0,
        speed: 0.25,
    };
    let sea = builder.add(None, object("Sea", sea, water));
    let rubber = builder.coated("Rubber", [0.7, 0.08, 0.06], 0.05);
    let others = [[0.85, 0.5, 0.05], [0.05, 0.35, 0.6], [0.75, 0.75, 0.72], [0.1, 0.45, 0.2]];
    let mut palette = vec![rubber];
    palette
        .extend(others.iter().enumerate().map(|(i, color)| builder.coated(&format!("Rubber {}", i + 2), *color, 0.05)));
    let mut herd =
        Instancer { target: Some(sea), seed: 12, snap: Snap::Down, align: 1.0, palette, ..Instancer::default() };
    herd.lattice = Lattice::Hexagonal { counts: [17, 1, 15], spacing: 3.4, height: 1.0 };
    herd.probability = 0.75;
    herd.variation = Variation {
        looseness: 0.7,
        rotation_min: [0.0, -180.0, 0.0],
        rotation_max: [0.0, 180.0, 0.0],
        scale_min: [0.7; 3],
        scale_max: [1.25; 3],
        ..Variation::default()
    };
    let herd = builder.add(None, instancer("Herd", herd).at(v(0.0, 0.0, -4.0)));
    let balloon = builder.add(herd, blended("Balloon", Operator::Union, BlendKernel::Circular, 0.12));
    builder.add(balloon, object("Body", ellipsoid(0.75, 0.7, 0.75), rubber).at(v(0.0, 0.45, 0.0)));
    builder.add(balloon, object("Neck", cone(0.09, 0.16, 0.22), rubber).at(v(0.0, 1.22, 0.0)));
    let ring = builder.add(herd, group("Ring", Operator::Union).weighted(0.35));
    builder.add(ring, object("Ring", torus(0.7, 0.24), rubber).at(v(0.0, 0.1, 0.0)));
    builder.sun("Sun", [0.5, 0.5, -0.65], [1.0, 0.92, 0.78], 1.2);
    builder.camera([0.0, 6.0, 26.0], [0.0, 0.2, 0.0], 42.0);
    builder.finish()
}

/// A city without end.
pub(super) fn city() -> Scene {
    let mut builder = SceneBuilder::new([0.3, 0.45, 0.7], [0.82, 0.78, 0.72], [0.4, 0.42, 0.46]);
    builder.shade(Shadowing { occlusion_radius: 3.0, ..Shadowing::default() });
    let asphalt = builder.matte("Asphalt", [0.07, 0.07, 0.08]);
    builder.add(None, object("Ground", Shape::Plane {}, asphalt));
    let facade = builder.glossy("Facade", [0.42, 0.4, 0.37], 0.4);
    let colors = [[0.35, 0.2, 0.14], [0.5, 0.48, 0.42], [0.22, 0.27, 0.32], [0.45, 0.38, 0.26]];
    let mut palette = vec![facade];
    palette
        .extend(colors.iter().enumerate().map(|(i, color)| builder.glossy(&format!("Facade {}", i + 2), *color, 0.45)));
    let mut blocks = Instancer::grid([0, 1, 0], [13.0, 1.0, 13.0]);
    blocks.seed = 21;
    blocks.probability = 0.93;
    blocks.palette = palette;
    blocks.material = MaterialVariation { value: 0.2, ..MaterialVariation::default() };
    blocks.variation =
        Variation { scale_min: [0.8, 0.35, 0.8], scale_max: [1.1, 1.5, 1.1], uniform: false, ..Variation::default() };
    let blocks = builder.add(None, instancer("Blocks", blocks));
    let tower = builder.add(blocks, group("Tower", Operator::Union));
    builder.add(tower, object("Base", cuboid(8.0, 6.0, 8.0, 0.1), facade).at(v(0.0, 3.0, 0.0)));
    builder.add(tower, object("Shaft", cuboid(5.2, 22.0, 5.2, 0.1), facade).at(v(0.0, 11.0, 0.0)));
    builder.add(tower, object("Crown", cuboid(3.0, 3.0, 3.0, 0.1), facade).at(v(0.0, 23.0, 0.0)));
    let hall = builder.add(blocks, group("Hall", Operator::Union).weighted(1.5));
    builder.add(hall, object("Walls", cuboid(8.5, 9.0, 7.0, 0.15), facade).at(v(0.0, 4.5, 0.0)));
    builder.add(hall, object("Roof", cuboid(7.0, 1.6, 5.6, 0.1), facade).at(v(0.0, 9.6, 0.0)));
    let round = builder.add(blocks, group("Round tower", Operator::Union).weighted(0.6));
    builder.add(round, object("Shaft", cylinder(3.4, 26.0, 0.2), facade).at(v(0.0, 13.0, 0.0)));
    builder.add(round, object("Dome", sphere(3.2), facade).at(v(0.0, 26.0, 0.0)));
    lamps(&mut builder);
    builder.sun("Sun", [-0.7, 0.5, 0.4], [1.0, 0.88, 0.72], 1.0);
    far_camera(&mut builder, [6.5, 34.0, 70.0], [6.5, 4.0, -20.0], 2_000.0);
    builder.finish()
}

fn lamps(builder: &mut SceneBuilder) {
    let iron = builder.metal("Iron", [0.25, 0.25, 0.26], 0.5);
    let glow = builder.glowing("Lamp", [0.3, 0.25, 0.15], [5.0, 3.4, 1.6]);
    let row = Instancer::grid([0, 1, 0], [13.0, 1.0, 6.5]);
    let flicker = Dynamic::Flicker { amplitude: 0.35, frequency: 6.0 };
    let row = builder.add(None, instancer("Street lamps", row).at(v(6.5, 0.0, 0.0)).moving(flicker));
    let lamp = builder.add(row, group("Lamp", Operator::Union));
    builder.add(lamp, object("Post", cylinder(0.08, 4.0, 0.0), iron).at(v(0.0, 2.0, 0.0)));
    builder.add(lamp, object("Light", sphere(0.28), glow).at(v(0.0, 4.1, 0.0)));
}

/// A belt of rocks that drift and spin.
pub(super) fn asteroids() -> Scene {
    let mut builder = SceneBuilder::new([0.006, 0.007, 0.012], [0.012, 0.012, 0.02], [0.05, 0.055, 0.07]);
    // In space hardly any light comes from everywhere.
    builder.shade(Shadowing { occlusion: false, ..Shadowing::default() });
    let rock = builder.matte("Rock", [0.24, 0.21, 0.185]);
    let palette =
        vec![rock, builder.matte("Iron ore", [0.26, 0.16, 0.11]), builder.matte("Carbon", [0.07, 0.07, 0.075])];
    let mut belt = Instancer::grid([0, 5, 0], [5.0, 4.0, 5.0]);
    belt.seed = 4;
    belt.probability = 0.5;
    belt.palette = palette;
    belt.masks =
        vec![Mask::Radius { inner: 88.0, outer: 120.0 }.into(), Mask::Radius { inner: 26.0, outer: 48.0 }.into()];
    belt.masks[1].inverted = true;
    belt.material = MaterialVariation { value: 0.35, roughness: 0.1, ..MaterialVariation::default() };
    belt.variation = Variation {
        looseness: 0.9,
        rotation_min: [-180.0; 3],
        rotation_max: [180.0; 3],
        scale_min: [0.25; 3],
        scale_max: [1.5, 1.2, 1.3],
        uniform: false,
        ..Variation::default()
    };
    let spin = Dynamic::Spin { axis: [0.3, 1.0, 0.2], frequency: 0.05, phase: 0.0, spread: 1.0 };
    let drift = Dynamic::CurlNoise { amplitude: [1.0, 0.6, 1.0], size: 18.0, frequency: 0.05 };
    let belt = builder.add(None, instancer("Belt", belt).moving(spin).moving(drift));
    rocks(&mut builder, belt, rock);
    let planet = builder.glossy("Planet", [0.32, 0.22, 0.13], 0.6);
    builder.add(None, object("Planet", sphere(17.0), planet));
    builder.sun("Sun", [-0.75, 0.35, 0.55], [1.0, 0.95, 0.88], 1.5);
    far_camera(&mut builder, [8.0, 16.0, 92.0], [0.0, -2.0, 0.0], 1_000.0);
    builder.finish()
}

fn rocks(builder: &mut SceneBuilder, belt: NodeId, rock: MaterialId) {
    let noise = |seed| Modifier::Noise { amplitude: 0.16, size: 0.9, octaves: 3, seed };
    builder.add(belt, object("Boulder", ellipsoid(0.9, 0.7, 0.8), rock).modified(noise(3)));
    let shard = builder.add(belt, blended("Shard", Operator::Union, BlendKernel::Circular, 0.25).weighted(0.7));
    builder.add(shard, object("Half", ellipsoid(0.8, 0.5, 0.5), rock).at(v(0.3, 0.0, 0.0)));
    builder.add(shard, object("Half", ellipsoid(0.5, 0.6, 0.7), rock).at(v(-0.35, 0.15, 0.1)));
}

/// A camera that sees farther than usual.
fn far_camera(builder: &mut SceneBuilder, position: [f64; 3], target: [f64; 3], far: f64) {
    let camera = CameraNode { fov_y: 42.0, far, ..CameraNode::default() };
    builder.view(camera, position, target);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tints_are_pure_at_the_primaries() {
        for (hue, pure) in [(0.0, [1.0, 0.0, 0.0]), (0.5, [0.0, 1.0, 1.0])] {
            for (primary, pure) in pure.into_iter().enumerate() {
                assert!((tint(hue, primary) - pure).abs() < 1e-12, "{primary} of {hue}");
            }
        }
    }
}
