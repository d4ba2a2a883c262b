//! A machine of steel, brass and enamel under the image of a studio: engine block, cylinders, flywheel and pipes.

use super::image_lit::studio_light;
use super::scene_builder::{
    SceneBuilder, blended, capsule, cuboid, cylinder, group, object, sphere, torus, turn_x, turn_y, turn_z, v,
};
use isolith_scene::{BlendKernel, MaterialId, NodeId, Operator, Scene, Shadowing};

/// Cooling fins of a cylinder, spokes of the wheel, bolts of a flange.
const FINS: usize = 7;
const SPOKES: usize = 6;
const BOLTS: usize = 8;

/// What the machine is made of.
#[derive(Clone, Copy)]
struct Metals {
    iron: MaterialId,
    steel: MaterialId,
    brass: MaterialId,
    copper: MaterialId,
    enamel: MaterialId,
}

pub(super) fn scene() -> Scene {
    let mut builder = SceneBuilder::new([0.0; 3], [0.0; 3], [0.0; 3]);
    builder.shade(Shadowing::default());
    builder.environment(studio_light(0.9, 24.0));
    let metals = Metals {
        iron: builder.metal("Cast iron", [0.24, 0.25, 0.27], 0.55),
        steel: builder.metal("Steel", [0.62, 0.63, 0.65], 0.18),
        brass: builder.metal("Brass", [0.86, 0.62, 0.26], 0.22),
        copper: builder.metal("Copper", [0.95, 0.52, 0.36], 0.28),
        enamel: builder.coated("Enamel", [0.05, 0.20, 0.14], 0.06),
    };
    let floor = builder.surface("Bench", [0.13, 0.13, 0.14], 0.0, 0.5);
    builder.add(None, object("Bench", cuboid(9.0, 0.3, 6.0, 0.1), floor).at(v(0.0, -0.15, 0.0)));
    let machine = builder.add(None, group("Machine", Operator::Union).rotated(turn_y(-24.0)));
    block(&mut builder, machine, metals);
    for side in [-0.55, 0.55] {
        stack(&mut builder, machine, side, metals);
    }
    wheel(&mut builder, machine, metals);
    pipes(&mut builder, machine, metals);
    builder.camera([0.3, 2.5, 6.0], [0.1, 0.85, 0.0], 36.0);
    builder.finish()
}

/// The block, with windows cut into its side.
fn block(builder: &mut SceneBuilder, machine: NodeId, metals: Metals) {
    let body = builder.add(machine, blended("Block", Operator::Union, BlendKernel::Circular, 0.07));
    builder.add(body, object("Case", cuboid(2.2, 0.8, 1.1, 0.08), metals.enamel).at(v(0.0, 0.55, 0.0)));
    builder.add(body, object("Foot", cuboid(2.6, 0.16, 1.3, 0.04), metals.iron).at(v(0.0, 0.08, 0.0)));
    for at in [-0.55, 0.55] {
        let window = object("Window", cylinder(0.26, 0.3, 0.02), metals.brass).subtracted();
        builder.add(body, window.at(v(at, 0.55, 0.58)).rotated(turn_x(90.0)));
    }
    let flange = builder.add(machine, group("Flange", Operator::Union).at(v(1.16, 0.55, 0.0)).rotated(turn_z(-90.0)));
    builder.add(flange, object("Plate", cylinder(0.4, 0.1, 0.02), metals.steel));
    for bolt in 0..BOLTS {
        let at = turn_y(360.0 * bolt as f64 / BOLTS as f64) * v(0.32, 0.08, 0.0);
        builder.add(flange, object("Bolt", cylinder(0.045, 0.08, 0.01), metals.brass).at(at));
    }
}

/// A cylinder with its fins and its cap.
fn stack(builder: &mut SceneBuilder, machine: NodeId, x: f64, metals: Metals) {
    builder.add(machine, object("Cylinder", cylinder(0.3, 1.0, 0.03), metals.iron).at(v(x, 1.4, 0.0)));
    for fin in 0..FINS {
        let at = v(x, 1.06 + 0.11 * fin as f64, 0.0);
        builder.add(machine, object("Fin", cylinder(0.44, 0.035, 0.015), metals.iron).at(at));
    }
    builder.add(machine, object("Cap", sphere(0.3), metals.brass).at(v(x, 1.9, 0.0)).scaled(v(1.0, 0.5, 1.0)));
}

fn wheel(builder: &mut SceneBuilder, machine: NodeId, metals: Metals) {
    let wheel = builder.add(machine, group("Wheel", Operator::Union).at(v(-1.42, 0.8, 0.0)).rotated(turn_z(90.0)));
    builder.add(wheel, object("Rim", torus(0.66, 0.09), metals.steel));
    builder.add(wheel, object("Hub", cylinder(0.16, 0.34, 0.03), metals.brass));
    for spoke in 0..SPOKES {
        let end = turn_y(360.0 * spoke as f64 / SPOKES as f64 + 11.0) * v(0.62, 0.0, 0.0);
        let end = [end.x, end.y, end.z].map(|value| (value * 1e6).round() * 1e-6);
        builder.add(wheel, object("Spoke", capsule([0.0; 3], end, 0.045), metals.steel));
    }
    builder.add(machine, object("Shaft", capsule([-1.5, 0.8, 0.0], [-0.9, 0.8, 0.0], 0.09), metals.steel));
}

/// Pipes that grow out of the cylinders and meet.
fn pipes(builder: &mut SceneBuilder, machine: NodeId, metals: Metals) {
    let pipes = builder.add(machine, blended("Pipes", Operator::Union, BlendKernel::Circular, 0.1));
    for x in [-0.55, 0.55] {
        let pipe = capsule([x, 1.72, 0.2], [x, 1.5, 0.62], 0.09);
        builder.add(pipes, object("Outlet", pipe, metals.copper));
    }
    let manifold = capsule([-0.9, 1.5, 0.62], [0.95, 1.5, 0.62], 0.13);
    builder.add(pipes, object("Manifold", manifold, metals.copper));
    builder.add(pipes, object("Exhaust", capsule([0.95, 1.5, 0.62], [1.35, 0.3, 0.66], 0.1), metals.copper));
}
