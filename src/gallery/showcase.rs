//! A rocket that leaves a small planet: the scene that opens first. Every shape and operator in it has a purpose.

use glam::DVec3;

use super::scene_builder::{
    SceneBuilder, blended, capsule, cone, cuboid, cylinder, ellipsoid, group, object, round_cone, sphere, torus,
    turn_x, turn_y, turn_z, v,
};
use isolith_scene::{BlendKernel, Falloff, MaterialId, NodeId, Operator, Scene, Shape};

/// The planet's center and radius.
const PLANET: (DVec3, f64) = (DVec3::new(0.0, -3.3, 0.0), 2.6);

pub(super) fn scene() -> Scene {
    let mut builder = SceneBuilder::new([0.008, 0.012, 0.05], [0.050, 0.018, 0.085], [0.19, 0.19, 0.28]);
    planet(&mut builder);
    crystals(&mut builder);
    smoke(&mut builder);
    rocket(&mut builder);
    sky(&mut builder);

    builder.sun("Sun", [-0.75, 0.65, 0.75], [1.0, 0.90, 0.78], 0.92);
    builder.sun("Planet light", [0.9, 0.15, 0.15], [0.45, 0.50, 1.0], 0.45);
    builder.sun("Back light", [0.35, 0.35, -1.0], [0.75, 0.60, 1.0], 0.8);
    let falloff = Falloff::Attenuation { constant: 1.0, linear: 0.0, quadratic: 1.1, range: 6.0 };
    builder.lamp("Flame light", [0.05, 0.32, 0.65], [1.0, 0.36, 0.08], 1.7, falloff);
    builder.camera([-0.7, 1.55, 7.7], [0.12, 0.68, 0.0], 41.0);
    builder.finish()
}

/// A point above the planet's ground: `tilt` degrees from the top, in the direction `heading` degrees around it.
fn on_planet(tilt: f64, heading: f64, height: f64) -> DVec3 {
    let (radians, around) = (tilt.to_radians(), heading.to_radians());
    let out = v(radians.sin() * around.sin(), radians.cos(), radians.sin() * around.cos());
    PLANET.0 + out * (PLANET.1 + height)
}

fn planet(builder: &mut SceneBuilder) {
    let soil = builder.matte("Soil", [0.30, 0.17, 0.42]);
    let crater = builder.matte("Crater", [0.115, 0.055, 0.23]);
    let planet = builder.add(None, blended("Planet", Operator::Union, BlendKernel::Quadratic, 0.11));
    builder.add(planet, object("Ball", sphere(PLANET.1), soil).at(PLANET.0));
    for (tilt, heading, radius) in
        [(26.0, 200.0, 0.42), (31.0, -38.0, 0.34), (14.0, 78.0, 0.17), (43.0, -75.0, 0.30), (40.0, 150.0, 0.3)]
    {
        builder.add(planet, object("Hill", sphere(radius), soil).at(on_planet(tilt, heading, -radius * 0.45)));
    }
    for (tilt, heading, radius) in
        [(33.0, 22.0, 0.36), (22.0, -78.0, 0.25), (36.0, 68.0, 0.28), (45.0, -20.0, 0.30), (49.0, 47.0, 0.22)]
    {
        let hole = object("Crater", sphere(radius), crater).subtracted();
        builder.add(planet, hole.at(on_planet(tilt, heading, radius * 0.45)));
    }
}

fn crystals(builder: &mut SceneBuilder) {
    let crystal = builder.gem("Crystal", [0.03, 0.46, 0.50], [0.0, 0.06, 0.07]);
    let cluster = builder.add(None, group("Crystals", Operator::Union));
    for (tilt, heading, size, lean) in [
        (24.0, 52.0, 0.30, -14.0),
        (27.5, 61.0, 0.19, 12.0),
        (24.5, 66.0, 0.13, 30.0),
        (28.0, -60.0, 0.24, 10.0),
        (31.0, -68.0, 0.15, -12.0),
    ] {
        let place = on_planet(tilt, heading, size * 0.42);
        let octahedron = object("Crystal", Shape::Octahedron { radius: size }, crystal);
        builder.add(cluster, octahedron.at(place).rotated(turn_z(lean) * turn_y(heading)).scaled(v(0.5, 1.15, 0.5)));
    }
}

fn smoke(builder: &mut SceneBuilder) {
    let smoke = builder.matte("Smoke", [0.62, 0.55, 0.58]);
    let cloud = builder.add(None, blended("Smoke", Operator::Union, BlendKernel::Quadratic, 0.22));
    builder.add(cloud, object("Column", round_cone(0.30, 0.13, 0.75), smoke).at(v(-0.02, -0.30, 0.0)));
    let puffs = [
        [-0.42, -0.56, 0.22, 0.34],
        [0.40, -0.58, 0.26, 0.31],
        [0.02, -0.60, 0.48, 0.33],
        [-0.80, -0.70, 0.12, 0.27],
        [0.82, -0.74, 0.10, 0.25],
        [-0.36, -0.62, -0.42, 0.34],
        [0.42, -0.62, -0.42, 0.34],
        [-1.10, -0.88, 0.10, 0.17],
        [1.10, -0.92, 0.02, 0.15],
        [-0.58, -0.74, 0.60, 0.20],
        [0.55, -0.74, 0.64, 0.18],
        [0.16, -0.24, 0.20, 0.20],
        [-0.18, -0.12, 0.10, 0.17],
    ];
    for [x, y, z, radius] in puffs {
        builder.add(cloud, object("Puff", sphere(radius), smoke).at(v(x, y, z)));
    }
}

fn rocket(builder: &mut SceneBuilder) {
    let white = builder.coated("Enamel", [0.84, 0.82, 0.78], 0.05);
    let red = builder.coated("Red", [0.86, 0.050, 0.038], 0.05);
    let steel = builder.metal("Steel", [0.562, 0.565, 0.578], 0.32);
    let brass = builder.metal("Brass", [0.92, 0.66, 0.24], 0.25);
    let glass = builder.gem("Glass", [0.02, 0.15, 0.26], [0.02, 0.09, 0.13]);

    let rocket = builder
        .add(None, group("Rocket", Operator::Union).at(v(0.12, 1.62, 0.0)).rotated(turn_z(-9.0) * turn_y(-14.0)));
    let body = builder.add(rocket, blended("Body and fins", Operator::Union, BlendKernel::Circular, 0.10));
    let hull = builder.add(body, blended("Hull", Operator::Intersection, BlendKernel::Circular, 0.04));
    builder.add(hull, object("Shape", ellipsoid(0.50, 1.32, 0.50), white));
    builder.add(hull, object("Cut", cuboid(2.0, 2.4, 2.0, 0.0), white).at(v(0.0, 0.26, 0.0)));
    for heading in [0.0, 120.0, 240.0] {
        fin(builder, body, heading + 60.0, red);
    }
    let nose = builder.add(rocket, group("Nose", Operator::Intersection));
    builder.add(nose, object("Shape", ellipsoid(0.512, 1.335, 0.512), red));
    builder.add(nose, object("Cut", cuboid(2.0, 1.0, 2.0, 0.0), red).at(v(0.0, 1.22, 0.0)));
    builder.add(rocket, object("Needle", capsule([0.0, 1.25, 0.0], [0.0, 1.56, 0.0], 0.018), steel));
    builder.add(rocket, object("Knob", sphere(0.05), brass).at(v(0.0, 1.58, 0.0)));
    let band = builder.add(rocket, group("Band", Operator::Intersection));
    builder.add(band, object("Shape", ellipsoid(0.515, 1.335, 0.515), brass));
    builder.add(band, object("Slab", cylinder(0.7, 0.045, 0.0), brass).at(v(0.0, 0.72, 0.0)));

    window(builder, rocket, v(0.0, 0.30, 0.475), 0.19, [brass, glass]);
    window(builder, rocket, v(0.0, -0.23, 0.49), 0.11, [brass, glass]);

    let nozzle =
        builder.add(rocket, blended("Nozzle", Operator::Union, BlendKernel::Circular, 0.02).at(v(0.0, -1.05, 0.0)));
    builder.add(nozzle, object("Bell", cone(0.27, 0.19, 0.24), steel));
    builder.add(nozzle, object("Inside", cone(0.235, 0.14, 0.24), steel).at(v(0.0, -0.03, 0.0)).subtracted());
    flame(builder, rocket);
}

/// A fin that sweeps outward and down, `heading` degrees around the hull.
fn fin(builder: &mut SceneBuilder, body: NodeId, heading: f64, red: MaterialId) {
    let fin =
        builder.add(body, blended("Fin", Operator::Difference, BlendKernel::Circular, 0.03).rotated(turn_y(heading)));
    let blade = object("Blade", ellipsoid(0.085, 0.62, 0.46), red);
    builder.add(fin, blade.at(v(0.0, -0.83, 0.45)).rotated(turn_x(-24.0)));
    builder.add(fin, object("Cut", ellipsoid(0.5, 0.52, 0.42), red).at(v(0.0, -1.42, 0.26)));
}

fn window(builder: &mut SceneBuilder, rocket: NodeId, at: DVec3, radius: f64, [brass, glass]: [MaterialId; 2]) {
    let window = builder.add(rocket, group("Window", Operator::Union).at(at).rotated(turn_x(90.0)));
    builder.add(window, object("Ring", torus(radius, radius * 0.2), brass));
    builder.add(window, object("Pane", ellipsoid(radius, radius * 0.32, radius), glass));
}

fn flame(builder: &mut SceneBuilder, rocket: NodeId) {
    let outer = builder.glowing("Flame", [0.5, 0.12, 0.02], [0.85, 0.22, 0.025]);
    let inner = builder.glowing("Flame core", [0.6, 0.4, 0.1], [1.0, 0.72, 0.22]);
    let flame = builder.add(rocket, blended("Flame", Operator::Union, BlendKernel::Cubic, 0.05).at(v(0.0, -1.42, 0.0)));
    builder.add(flame, object("Mantle", round_cone(0.05, 0.17, 0.42), outer));
    builder.add(flame, object("Core", round_cone(0.03, 0.13, 0.2), inner).at(v(0.0, 0.16, 0.04)));
}

/// A ringed moon and stars.
fn sky(builder: &mut SceneBuilder) {
    let moon = builder.glossy("Moon", [0.83, 0.50, 0.24], 0.6);
    let ring = builder.glossy("Ring", [0.66, 0.56, 0.62], 0.5);
    let star = builder.glowing("Star", [0.4, 0.4, 0.4], [0.80, 0.76, 0.62]);
    let saturn = builder
        .add(None, group("Ringed moon", Operator::Union).at(v(3.1, 3.35, -4.2)).rotated(turn_z(-22.0) * turn_x(20.0)));
    builder.add(saturn, object("Ball", sphere(0.62), moon));
    builder.add(saturn, object("Ring", torus(1.0, 0.14), ring).scaled(v(1.0, 0.16, 1.0)));
    let stars = builder.add(None, group("Stars", Operator::Union));
    let places = [
        [-4.2, 4.1, -5.0, 0.050],
        [-3.0, 2.6, -6.0, 0.036],
        [-2.1, 4.6, -6.0, 0.060],
        [-1.2, 3.3, -5.0, 0.034],
        [1.4, 4.7, -6.0, 0.046],
        [1.7, 2.5, -5.0, 0.032],
        [4.6, 1.5, -6.0, 0.048],
        [5.2, 4.9, -6.0, 0.040],
        [-4.9, 1.3, -6.0, 0.046],
        [-2.7, 0.9, -5.0, 0.034],
        [2.7, 0.9, -5.0, 0.036],
        [-5.3, 3.0, -6.0, 0.034],
        [0.2, 5.2, -6.0, 0.036],
    ];
    for [x, y, z, radius] in places {
        builder.add(stars, object("Star", Shape::Octahedron { radius }, star).at(v(x, y, z)).rotated(turn_y(15.0)));
    }
}
