//! The shipped scenes: they match the generator, and are presentable.

use std::fs;

use isolith::field::flatten;
use isolith::gallery::{RANDOM_SEED, SHOWCASE, all, random, write_all};
use isolith::mesh::MeshLibrary;
use isolith::scene::{NodeKind, file};

use super::asset::scenes;

#[test]
fn the_shipped_files_are_what_the_generator_makes() {
    let mut names: Vec<String> = Vec::new();
    for (name, scene) in all() {
        let shipped = fs::read_to_string(scenes().join(format!("{name}.json"))).unwrap_or_default();
        assert!(shipped == file::to_json(&scene).unwrap(), "scenes/{name}.json differs; run `isolith gallery scenes`");
        names.push(format!("{name}.json"));
    }
    for entry in fs::read_dir(scenes()).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        assert!(!name.ends_with(".json") || names.contains(&name), "nothing makes scenes/{name}");
    }
    assert_eq!(names[0], format!("{SHOWCASE}.json"));
}

#[test]
fn writing_the_gallery_gives_files_that_read_back() {
    let folder = tempfile::tempdir().unwrap();
    let files = write_all(folder.path()).unwrap();
    assert_eq!(files.len(), all().len());
    for (path, (name, scene)) in files.iter().zip(all()) {
        assert_eq!(file::load(path).unwrap(), scene, "{name}");
    }
}

#[test]
fn every_shipped_scene_can_be_shown() {
    let mut library = MeshLibrary::new(Some(scenes()));
    for (name, scene) in all() {
        scene.assert_invariants();
        let flat = flatten(&scene, 0.0).expect(name);
        assert_eq!(flat.warnings, [], "{name}");
        assert!(flat.cameras.iter().any(|c| c.name == "Camera"), "{name}");
        let is_lit = !flat.lights.is_empty() || flat.environment_map.is_some();
        assert!(is_lit && !flat.components.is_empty(), "{name}");
        for mesh in &flat.meshes {
            assert!(library.get(&mesh.model).is_ok(), "{name}");
        }
    }
}

#[test]
fn random_scenes_have_the_nodes_of_their_names() {
    for (leaves, nodes) in [(32, 37), (128, 145), (512, 577)] {
        let scene = random(leaves, RANDOM_SEED);
        let fields = scene.nodes().iter().filter(|n| n.has_field()).count();
        let shapes = scene.nodes().iter().filter(|n| matches!(n.kind, NodeKind::Object(_))).count();
        assert_eq!((shapes, fields), (leaves, nodes));
        assert_eq!(scene, random(leaves, RANDOM_SEED));
        assert_ne!(scene, random(leaves, RANDOM_SEED + 1));
    }
}

#[test]
fn the_deep_tree_is_deep_and_needs_no_deep_stack() {
    let (_, scene) = all().into_iter().find(|(name, _)| *name == "deep-tree").unwrap();
    assert!(scene.depths().iter().any(|depth| *depth >= 64));
    let flat = flatten(&scene, 0.0).unwrap();
    assert!(flat.components.iter().all(|c| c.stack <= 1));
}
