//! Groups that are drawn from bricks.

use glam::DVec3;
use isolith::field::eval::field;
use isolith::field::{FlatScene, flatten};
use isolith::jobs::Task;
use isolith::mesh::MeshLibrary;
use isolith::scene::{
    Blend, BlendKernel, DynamicKind, Group, Light, Material, MaterialId, Node, NodeId, NodeKind, Object, Operator,
    Scene, Shape, ShapeKind,
};
use isolith::session::ModelFields;

use super::Dice;

const BAKED: NodeId = NodeId(1);

fn object(shape: Shape, material: u64) -> Node {
    Node::new("object", NodeKind::Object(Object { shape, material: MaterialId(material) }))
}

/// A blended body of two materials with a hole, beside a ball that is no part of it.
fn scene(bake: f64) -> Scene {
    let mut scene = Scene::new();
    scene.insert_material(Material { id: MaterialId(7), base_color: [0.9, 0.1, 0.1], ..Material::default() }).unwrap();
    let blend = Blend::new(BlendKernel::Circular, 0.2);
    let group = NodeKind::Group(Group { bake, ..Group::new(Operator::Union, blend) });
    let parent = scene.insert(None, 0, Node::new("Body", group).at(DVec3::new(0.3, 0.2, -0.1))).unwrap();
    assert_eq!(parent, BAKED);
    let ball = |x: f64, material| object(Shape::Sphere { radius: 0.5 }, material).at(DVec3::X * x);
    let hole = object(Shape::Box { size: [0.3, 2.0, 0.3], rounding: 0.0 }, 1).at(DVec3::X * -0.5).subtracted();
    for node in [ball(-0.5, 1), ball(0.5, 7), hole] {
        scene.insert(Some(parent), usize::MAX, node).unwrap();
    }
    scene.insert(None, usize::MAX, ball(0.0, 1).at(DVec3::Y * 3.0)).unwrap();
    scene
}

fn made(scene: &Scene) -> ModelFields {
    let mut fields = ModelFields::new(None);
    assert!(fields.make_all(scene, &mut MeshLibrary::new(None), &Task::new("Making")));
    fields
}

fn value(flat: &FlatScene, p: DVec3) -> f64 {
    flat.components.iter().map(|c| field(flat, c, p - c.origin)).fold(f64::INFINITY, f64::min)
}

#[test]
fn a_baked_group_has_the_surface_of_its_content() {
    let voxel = 2.0 / 64.0;
    let plain = flatten(&scene(0.0), 0.0).unwrap();
    let baked = scene(64.0);
    let fields = made(&baked);
    assert_eq!(fields.problems(&baked).next(), None);
    let filled = fields.filled(&baked);
    // The content is gone from the arrays, not from the document; the group keeps its id.
    assert_eq!((filled.nodes().len(), baked.nodes().len()), (2, 5));
    assert_eq!(filled.nodes()[0].id, BAKED);
    let flat = flatten(&filled, 0.0).unwrap();
    assert_eq!(flat.nodes.iter().filter(|node| node.is_leaf()).count(), 2);
    let mut dice = Dice(5);
    let (mut near, mut worst) = (0, 0.0_f64);
    for _ in 0..20_000 {
        let p = (dice.point() - 0.5) * 3.0 + DVec3::new(0.3, 0.2, -0.1);
        let (exact, of_bricks) = (value(&plain, p), value(&flat, p));
        if exact.abs() > 0.7 * voxel {
            assert_eq!(exact < 0.0, of_bricks < 0.0, "{p}: {exact} and {of_bricks}");
        } else {
            near += 1;
            worst = worst.max((exact - of_bricks).abs());
        }
        assert!(of_bricks <= exact.abs() + voxel, "{p}: {exact} and {of_bricks}");
    }
    assert!(near > 200 && worst < 0.7 * voxel, "{near} {worst}");
    // A group that is not to be baked is left as it is.
    assert_eq!(fields.filled(&scene(0.0)).nodes().len(), 5);
}

#[test]
fn edited_content_is_shown_until_its_bricks_are_made() {
    let mut scene = scene(48.0);
    let mut fields = made(&scene);
    // Its place, its name and what stands beside it are no part of the content.
    for id in [BAKED, NodeId(5)] {
        let node = Node::clone(scene.node(id).unwrap()).at(DVec3::splat(2.0));
        scene.replace(Node { name: "other".into(), ..node }).unwrap();
        assert_eq!(fields.filled(&scene).nodes().len(), 2);
    }
    let revision = fields.revision();
    let moved = Node::clone(scene.node(NodeId(3)).unwrap()).at(DVec3::X * 0.6);
    scene.replace(moved).unwrap();
    assert_eq!(fields.filled(&scene).nodes().len(), 5, "these are bricks of something else");
    assert!(fields.make_all(&scene, &mut MeshLibrary::new(None), &Task::new("Making")));
    assert_eq!(fields.filled(&scene).nodes().len(), 2);
    assert!(fields.revision() != revision);
}

#[test]
fn what_bricks_cannot_hold_is_drawn_as_it_is_and_told() {
    type Change = fn(&mut Scene);
    let changes: [(&str, Change); 4] = [
        ("light #6 is neither an object nor a group", |scene| {
            let light = Node::new("light", NodeKind::Light(Light::default()));
            scene.insert(Some(BAKED), usize::MAX, light).unwrap();
        }),
        ("object #2 moves with time", |scene| {
            let node = Node::clone(scene.node(NodeId(2)).unwrap());
            scene.replace(node.moving(DynamicKind::Spin.default_dynamic())).unwrap();
        }),
        ("has no end", |scene| {
            scene.insert(Some(BAKED), usize::MAX, object(ShapeKind::Plane.default_shape(), 1)).unwrap();
        }),
        ("is a model", |scene| {
            scene.insert(Some(BAKED), usize::MAX, object(ShapeKind::MeshField.default_shape(), 1)).unwrap();
        }),
    ];
    for (reason, change) in changes {
        let mut scene = scene(48.0);
        change(&mut scene);
        let fields = made(&scene);
        assert_eq!(fields.filled(&scene).nodes().len(), scene.nodes().len(), "{reason}");
        let problems: Vec<_> = fields.problems(&scene).collect();
        assert!(
            matches!(&problems[..], [(BAKED, text)] if text.contains(reason) && text.contains("is not baked")),
            "{reason}: {problems:?}"
        );
    }
}
