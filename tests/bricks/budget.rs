//! Models that take more room than they may: larger voxels, made anew, and told at the node.

use std::sync::Arc;

use glam::DVec3;
use isolith::bricks::BrickLevels;
use isolith::jobs::Task;
use isolith::mesh::{MeshLibrary, voxelized};
use isolith::scene::{ModelFile, Node, NodeId, NodeKind, Object, Scene, Shape};
use isolith::session::ModelFields;

use super::shapes::Soup;

const FILE: &str = "leaf.glb";

/// A ball with a leaf of no thickness beside it, in a folder.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let leaf = Soup::sheet([0.35, 0.2]).moved(DVec3::X * 0.9);
    std::fs::write(folder.path().join(FILE), Soup::sphere(24, 0.5).with(leaf).glb()).unwrap();
    folder
}

fn scene(resolution: f64) -> (Scene, NodeId) {
    let shape = Shape::MeshField {
        file: ModelFile::new(FILE),
        clip: String::new(),
        clip_time: 0.0,
        resolution,
        voxel_size: 0.0,
        file_materials: false,
    };
    let mut scene = Scene::new();
    let object = NodeKind::Object(Object { shape, material: scene.materials()[0].id });
    let id = scene.insert(None, 0, Node::new("Leaf", object)).unwrap();
    (scene, id)
}

fn levels(fields: &ModelFields, scene: &Scene) -> Arc<BrickLevels> {
    let filled = fields.filled(scene);
    let NodeKind::Object(object) = &filled.nodes()[0].kind else { panic!("an object") };
    let Shape::MeshField { file, .. } = &object.shape else { panic!("a model") };
    file.bricks()
}

fn made(scene: &Scene, folder: &tempfile::TempDir, budget: usize) -> ModelFields {
    let path = Some(folder.path().to_path_buf());
    let mut fields = ModelFields::new(path.clone());
    fields.set_budget(budget);
    assert!(fields.make_all(scene, &mut MeshLibrary::new(path), &Task::new("Making")));
    fields
}

#[test]
fn a_model_beyond_the_budget_is_made_anew_in_larger_voxels_and_told() {
    let folder = folder();
    let (scene, id) = scene(128.0);
    let whole = made(&scene, &folder, usize::MAX);
    assert_eq!(whole.reductions(&scene).next(), None);
    let fine = levels(&whole, &scene);
    let reduced = made(&scene, &folder, fine.texels() - 1);
    let coarse = levels(&reduced, &scene);
    assert!(coarse.texels() < fine.texels(), "{} of {}", coarse.texels(), fine.texels());
    assert_eq!(coarse.finest().voxel(), 2.0 * fine.finest().voxel());
    let told: Vec<_> = reduced.reductions(&scene).collect();
    assert!(matches!(&told[..], [(of, text)] if *of == id && text.contains("2 times as large")), "{told:?}");
    // Not a level of the fine one, in which a sheet is as thin as its own voxels, but made for its own.
    let mut meshes = MeshLibrary::new(Some(folder.path().to_path_buf()));
    let mesh = meshes.get(FILE).unwrap();
    let alone = voxelized(&mesh, coarse.finest().voxel(), &mut |_| true).unwrap().bricks;
    assert!(*coarse.finest() == *alone && *fine.all()[1] != *alone);
    // With room again it is as it was asked for.
    let mut again = reduced;
    again.set_budget(usize::MAX);
    assert!(again.make_all(&scene, &mut meshes, &Task::new("Making")));
    assert!(*levels(&again, &scene).finest() == *fine.finest() && again.reductions(&scene).next().is_none());
}
