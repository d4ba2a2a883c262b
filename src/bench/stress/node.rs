//! The node of a stress case as a scene: a shape, a blend or a modifier with certain parameters.

use glam::{DQuat, DVec3};

use crate::geometry::Camera;
use crate::scene::{
    Blend, BlendKernel, Group, Light, LightKind, MaterialId, Modifier, Node, NodeKind, Object, Operator, RadiusUnit,
    Scene, Shape,
};

/// The node of a stress case.
#[derive(Clone, Debug)]
pub(super) enum StressNode {
    /// A shape alone.
    Shape(Shape),
    /// A group of a box and a ball that reaches out of it.
    Blend(Group),
    /// A modifier over asymmetric content.
    Modified(Modifier),
}

/// The placement of the node in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct StressPlacement {
    /// The position of its origin.
    pub at: DVec3,
    /// Its scale.
    pub scale: f64,
}

impl StressPlacement {
    /// At the origin, at scale 1.
    pub const PLAIN: Self = Self { at: DVec3::ZERO, scale: 1.0 };

    /// The rotation of every node, which 32-bit numbers cannot represent exactly.
    pub fn turn() -> DQuat {
        DQuat::from_axis_angle(DVec3::new(1.0, 2.0, 0.5).normalize(), 0.7)
    }
}

/// A blend whose radius is relative to the size of the operands, so that it scales with them.
pub(super) fn usual_blend(kernel: BlendKernel) -> Blend {
    Blend { unit: RadiusUnit::Size, ..Blend::new(kernel, 0.3) }
}

impl StressNode {
    /// The name of the node.
    pub fn name(&self) -> String {
        match self {
            Self::Shape(shape) => shape.kind().label().into(),
            Self::Blend(group) if group.operator.has_kernel() => {
                format!("{}, {}", group.operator.label(), group.blend.kernel.label().to_lowercase())
            }
            Self::Blend(group) => group.operator.label().into(),
            Self::Modified(modifier) => modifier.kind().label().into(),
        }
    }

    /// A scene of this node and a light.
    pub fn scene(&self, place: StressPlacement) -> Scene {
        let mut scene = Scene::new();
        let from = DVec3::new(-0.5, 0.8, 0.6);
        let sun = Light::new(LightKind::Sun { strength: 2.5, angle: 0.0 });
        let sun = Node::new("Sun", NodeKind::Light(sun)).rotated(Camera::looking_at(from, DVec3::ZERO, 1.0).rotation);
        let (node, parts) = match self {
            Self::Shape(shape) => (object(shape.clone()), vec![]),
            Self::Blend(group) => {
                let parts = [(cuboid([0.9, 0.6, 0.8]), DVec3::ZERO), (ball(0.42), DVec3::new(0.1, 0.33, 0.16))];
                (Node::new("Blend", NodeKind::Group(*group)), parts.to_vec())
            }
            Self::Modified(modifier) => {
                let group = Group::new(Operator::Union, usual_blend(BlendKernel::Circular));
                let parts = [
                    (cuboid([0.9, 0.3, 0.2]), DVec3::new(0.1, -0.2, 0.0)),
                    (cuboid([0.2, 0.8, 0.3]), DVec3::new(-0.3, 0.15, 0.05)),
                    (ball(0.2), DVec3::new(0.4, 0.1, 0.1)),
                ];
                (Node::new("Modified", NodeKind::Group(group)).modified(modifier.clone()), parts.to_vec())
            }
        };
        let node = node.at(place.at).rotated(StressPlacement::turn()).scaled(DVec3::splat(place.scale));
        let mut put = |parent, node| scene.insert(parent, usize::MAX, node).expect("a few nodes within the limits");
        put(None, sun);
        let parent = put(None, node);
        for (shape, at) in parts {
            put(Some(parent), object(shape).at(at));
        }
        scene
    }
}

fn object(shape: Shape) -> Node {
    Node::new("Part", NodeKind::Object(Object { shape, material: MaterialId(1) }))
}

fn cuboid(size: [f64; 3]) -> Shape {
    Shape::Box { size, rounding: 0.05 }
}

fn ball(radius: f64) -> Shape {
    Shape::Sphere { radius }
}
