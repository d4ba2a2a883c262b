//! Copies of triangle meshes: pictures against the reference and against meshes placed one by one, picking, and which
//! copies are in view.

use std::path::{Path, PathBuf};

use glam::{DQuat, DVec2, DVec3};

use isolith::field::copies::{
    COUNT_LIMITS, CopiesInView, Placement, ViewLimits, copies_in_view, copy_of_cell, copy_of_place, copy_sphere,
    world_from_copy,
};
use isolith::field::pick::{PickedCopy, pick_copy};
use isolith::field::{FlatScene, MESH_BIT, flatten};
use isolith::geometry::{Camera, Ray};
use isolith::render::EvalStrategy;
use isolith::scene::{
    DynamicKind, Instancer, Lattice, MeshNode, Node, NodeId, NodeKind, Object, Scene, Shape, Variation,
};

use crate::copies::varied;
use crate::copies_pictures::faults;
use crate::gpu::{BenchScene, shared};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes")
}

/// Variations that fit a statue of some meters.
fn moderate() -> Variation {
    Variation { offset_max: [0.3, 0.0, 0.2], scale_min: [0.5; 3], scale_max: [0.8; 3], ..varied() }
}

/// An instancer whose types are a vase of triangles, turned and moved, and a ball.
fn mixed(instancer: Instancer, dynamics: &[DynamicKind]) -> Scene {
    let mut scene = Scene::new();
    let material = scene.materials()[0].id;
    let mut top = Node::new("Copies", NodeKind::Instancer(Box::new(instancer)));
    for kind in dynamics {
        top = top.moving(kind.default_dynamic());
    }
    let top = scene.insert(None, 0, top.at(DVec3::new(0.4, 0.1, -0.3)).rotated(DQuat::from_rotation_y(0.3))).unwrap();
    let vase = Node::new("Vase", NodeKind::Mesh(MeshNode::new("models/vase.glb"))).weighted(2.0);
    let mut vase = vase.at(DVec3::new(0.1, 0.0, 0.2)).rotated(DQuat::from_rotation_x(0.2));
    vase.transform.scale = DVec3::new(2.0, 2.5, 2.0);
    scene.insert(Some(top), 0, vase).unwrap();
    let ball = Object { shape: Shape::Sphere { radius: 0.4 }, material };
    scene.insert(Some(top), 1, Node::new("Ball", NodeKind::Object(ball))).unwrap();
    scene
}

fn grid(counts: [u32; 3]) -> Instancer {
    let lattice = Lattice::Grid { counts, spacing: [2.4, 2.0, 2.2] };
    Instancer { lattice, variation: moderate(), seed: 4, probability: 0.9, ..Instancer::default() }
}

fn bench(name: &str, scene: &Scene) -> BenchScene {
    BenchScene::new(name, scene, Some(folder()))
}

fn mesh_pixels(scene: &BenchScene) -> usize {
    scene.render(64, EvalStrategy::Tape).leaf.iter().filter(|leaf| *leaf & MESH_BIT != 0 && **leaf != u32::MAX).count()
}

#[test]
fn pictures_of_mesh_copies_are_those_of_the_reference() {
    let polar = Lattice::Polar { count: 7, rings: 2, radius: 3.0, spacing: 2.5 };
    let scenes = [
        ("a grid of vases", mixed(grid([4, 1, 4]), &[DynamicKind::Wind])),
        ("rings of vases", mixed(Instancer { lattice: polar, ..grid([1; 3]) }, &[])),
    ];
    for (name, scene) in scenes {
        let mut scene = bench(name, &scene);
        scene.camera = Camera::looking_at(DVec3::new(1.0, 3.0, 8.0), DVec3::new(0.3, 0.4, 0.0), 0.8);
        assert!(mesh_pixels(&scene) > 150, "{name}: {} pixels show a vase", mesh_pixels(&scene));
        assert_eq!(faults(&scene, &scene), [""; 0]);
    }
}

/// The same scene with a node for each copy.
fn placed_one_by_one(flat: &FlatScene, source: &Scene) -> Scene {
    let instancer = &flat.instancers[0];
    let types: Vec<NodeId> = source.children(Some(instancer.id)).map(|child| child.id).collect();
    let Placement::Lattice(lattice) = &instancer.placement else { panic!("a grid") };
    let mut scene = Scene::new();
    for z in lattice.low[2]..=lattice.high[2] {
        for x in lattice.low[0]..=lattice.high[0] {
            let Some(copy) = copy_of_cell(instancer, [x, 0, z]) else { continue };
            let (scale, rotation, translation) = world_from_copy(instancer, &copy).to_scale_rotation_translation();
            let mut group = Node::new("Copy", NodeKind::Group(isolith::scene::Group::UNION));
            (group.transform.translation, group.transform.rotation, group.transform.scale) =
                (translation, rotation, scale);
            let group = scene.insert(None, 0, group).unwrap();
            let child = source.node(types[copy.kind as usize]).unwrap();
            scene.insert(Some(group), 0, Node { id: NodeId(0), parent: None, ..Node::clone(child) }).unwrap();
        }
    }
    scene
}

#[test]
fn mesh_copies_stand_where_meshes_placed_one_by_one_do() {
    let source = mixed(grid([4, 1, 4]), &[]);
    let mut copies = bench("copies", &source);
    copies.camera = Camera::looking_at(DVec3::new(1.0, 3.0, 8.0), DVec3::new(0.3, 0.4, 0.0), 0.8);
    let mut single = bench("one by one", &placed_one_by_one(&copies.flat, &source));
    single.camera = copies.camera;
    let [a, b] = [&copies, &single].map(|scene| scene.render(96, EvalStrategy::Tape));
    let differs = |i: &usize| {
        let [a, b] = [a.depth[*i], b.depth[*i]];
        a.is_finite() != b.is_finite() || a.is_finite() && (a - b).abs() > 1e-4 * b
    };
    let wrong = (0..a.depth.len()).filter(differs).count();
    // Rounding of the places moves edges of triangles.
    assert!(wrong <= 12, "{wrong} pixels differ");
}

#[test]
fn picking_tells_which_copy_of_a_mesh() {
    let scene = bench("picked", &mixed(grid([0, 1, 0]), &[]));
    let (instancer, mut found) = (&scene.flat.instancers[0], 0);
    for cell in (-3..3).flat_map(|x| (-3..3).map(move |z| [x, 0, z])) {
        let Some(copy) = copy_of_cell(instancer, cell).filter(|copy| copy.kind == 0) else { continue };
        let mesh = scene.meshes[0].as_ref().expect("it is read");
        let middle = scene.flat.meshes[0].world_from_local.transform_point3(mesh.bounds.center());
        let middle = world_from_copy(instancer, &copy).transform_point3(middle);
        // From the side a vase is in front of its own middle.
        let ray = Ray { origin: middle + DVec3::new(0.0, 0.0, 1.0), direction: DVec3::NEG_Z };
        let picked = pick_copy(&scene.flat, &scene.meshes, &ray, 1e-3, 1.0);
        let is_own = |picked: &isolith::field::pick::Picked| {
            picked.copy == Some(PickedCopy { instancer: instancer.id, cell }) && picked.node == scene.flat.meshes[0].id
        };
        found += usize::from(picked.as_ref().is_some_and(is_own));
    }
    // Some are hidden by a neighbor, or hollow where the ray passes.
    assert!(found > 10, "{found} vases are picked by their cell");
}

#[test]
fn only_the_nearest_copies_of_a_mesh_without_end_are_drawn_and_that_is_told() {
    let lattice = Lattice::Grid { counts: [0, 1, 0], spacing: [0.7, 1.0, 0.7] };
    let mut scene = bench("a sea of vases", &mixed(Instancer { lattice, ..grid([1; 3]) }, &[]));
    let eye = DVec3::new(0.0, 6.0, 0.0);
    scene.camera = Camera { far: 1e4, ..Camera::looking_at(eye, eye + DVec3::new(0.2, -0.3, -1.0), 0.9) };
    let mut shared = shared();
    let picture = shared.renderer.render(&scene.flat, &scene.meshes, &scene.camera, [48; 2], &mut |_| true);
    let (_, warnings) = picture.expect("a picture");
    let told = warnings.iter().find(|warning| warning.reason.contains("only the nearest are drawn"));
    assert_eq!(told.map(|warning| warning.node), Some(scene.flat.meshes[0].id), "{warnings:?}");
    let varied = Instancer { palette: vec![isolith::scene::MaterialId(1)], ..grid([2, 1, 2]) };
    let flat = flatten(&mixed(varied, &[]), 0.0).expect("within the limits");
    assert!(flat.warnings.iter().any(|warning| warning.reason.contains("the palette")), "{:?}", flat.warnings);
}

/// Whether the middle of a copy is in the picture.
fn is_shown(flat: &FlatScene, copy: &isolith::field::copies::Copy, camera: &Camera) -> bool {
    let instancer = &flat.instancers[0];
    let (center, _) = copy_sphere(instancer, copy);
    let center = instancer.world_from_local.transform_point3(center);
    let size = DVec2::new(160.0, 90.0);
    camera.project(center, size).is_some_and(|(at, depth)| {
        at.cmpge(DVec2::ZERO).all()
            && at.cmple(size).all()
            && depth > 0.0
            && center.distance(camera.position) < camera.far
    })
}

#[test]
fn all_copies_in_view_are_found_up_to_the_limits() {
    let limits = ViewLimits { copies: 1_000_000, cells: 10_000_000 };
    let polar = Lattice::Polar { count: 9, rings: 20, radius: 2.0, spacing: 2.0 };
    let hexagonal = Lattice::Hexagonal { counts: [60, 3, 70], spacing: 1.7, height: 2.0 };
    for lattice in [grid([50, 4, 60]).lattice, polar, hexagonal] {
        let flat = flatten(&mixed(Instancer { lattice, ..grid([1; 3]) }, &[DynamicKind::CurlNoise]), 2.0).unwrap();
        let instancer = &flat.instancers[0];
        let all: Vec<_> = match &instancer.placement {
            Placement::List(list) => (0..list.places.len()).filter_map(|at| copy_of_place(instancer, at)).collect(),
            Placement::Lattice(l) => (l.low[2]..=l.high[2])
                .flat_map(|z| (l.low[1]..=l.high[1]).flat_map(move |y| (l.low[0]..=l.high[0]).map(move |x| [x, y, z])))
                .filter_map(|cell| copy_of_cell(instancer, cell))
                .collect(),
        };
        let within = (DVec3::new(3.0, 4.0, 9.0), DVec3::new(-1.0, -0.3, -1.0), 1e3);
        let beside = (DVec3::new(90.0, 30.0, 0.0), DVec3::new(-1.0, -0.5, 0.0), 80.0);
        for (eye, to, far) in [within, beside] {
            let camera = Camera { far, ..Camera::looking_at(eye, eye + to, 0.7) };
            let CopiesInView { all: found, cut } = copies_in_view(instancer, 0.0, &camera, 16.0 / 9.0, limits);
            assert_eq!(cut, None);
            let shown = all.iter().filter(|copy| is_shown(&flat, copy, &camera));
            let missing = shown.clone().filter(|copy| !found.iter().any(|one| one.cell == copy.cell)).count();
            let count = shown.count();
            assert!(count > 5 && missing == 0, "{lattice:?}: {missing} of {count} copies are missing");
            assert!(found.len() < all.len(), "{lattice:?}: nothing is out of view");
        }
    }
}

#[test]
fn a_search_that_ends_early_finds_all_up_to_the_depth_that_it_tells() {
    let flat = flatten(&mixed(grid([0, 1, 0]), &[]), 0.0).unwrap();
    let instancer = &flat.instancers[0];
    let eye = DVec3::new(1e5, 3.0, -2e5);
    let camera = Camera { far: 1e6, ..Camera::looking_at(eye, eye + DVec3::new(1.0, -0.1, 0.4), 0.8) };
    let CopiesInView { all, cut } = copies_in_view(instancer, 0.0, &camera, 16.0 / 9.0, COUNT_LIMITS);
    let cut = cut.expect("there is no end");
    assert!(all.len() > 2_000 && all.len() <= COUNT_LIMITS.copies && cut > 50.0, "{} up to {cut} m", all.len());
    let Placement::Lattice(lattice) = &instancer.placement else { panic!("a grid") };
    let home = lattice.nearest(instancer.world_from_local.inverse().transform_point3(eye));
    let forward = camera.rotation * DVec3::NEG_Z;
    let near = (-40..40).flat_map(|z| (-40..40).map(move |x| [home[0] + x, 0, home[2] + z]));
    let mut count = 0;
    for copy in near.filter_map(|cell| copy_of_cell(instancer, cell)) {
        let at = instancer.world_from_local.transform_point3(copy.position);
        if is_shown(&flat, &copy, &camera) && (at - eye).dot(forward) < 0.8 * cut {
            assert!(all.iter().any(|one| one.cell == copy.cell), "{:?} is missing", copy.cell);
            count += 1;
        }
    }
    assert!(count > 50, "{count} copies compared");
}
