//! Empty operands, and scenes built to exhaust memory or time.

mod empty;
mod hostile;
mod opening;
mod operations;

use std::path::PathBuf;

use isolith::field::{FlatScene, flatten};
use isolith::scene::{
    Blend, BlendKernel, Group, MaterialId, Modifier, Node, NodeId, NodeKind, Object, Operator, Scene, Shape, file,
};

/// The path of a case.
fn case(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/cases").join(name)
}

fn load(name: &str) -> Scene {
    file::load(&case(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn object(shape: Shape) -> Node {
    Node::new("object", NodeKind::Object(Object { shape, material: MaterialId(1) }))
}

fn ball() -> Node {
    Node { name: "ball".into(), ..object(Shape::Sphere { radius: 1.0 }) }
}

fn group(operator: Operator) -> Node {
    Node::new("group", NodeKind::Group(Group::new(operator, Blend::HARD)))
}

fn blended(operator: Operator) -> Node {
    Node::new("group", NodeKind::Group(Group::new(operator, Blend::new(BlendKernel::Circular, 0.1))))
}

fn add(scene: &mut Scene, parent: Option<NodeId>, node: Node) -> NodeId {
    scene.insert(parent, usize::MAX, node).expect("the scene has room")
}

fn flat(scene: &Scene) -> FlatScene {
    flatten(scene, 0.0).unwrap_or_else(|error| panic!("{error}"))
}

/// A polar repeat of `count` copies around Y.
fn around(count: u32) -> Modifier {
    Modifier::Polar { count, radius: 1.0, mirrored: false }
}

const ALL_AXES: Modifier = Modifier::Mirror { axes: [true; 3], blend: 0.0 };
