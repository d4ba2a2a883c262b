//! The example scenes, made by code: the same on every machine and every run.
//!
//! They are shipped as files in `scenes/`; a test holds the files to what stands here. Each is an
//! example for artists, a golden test and a bench at once.

mod blend_kernels;
mod boolean_operations;
mod chess_pawn;
mod deep_tree;
mod ellipsoid_and_plane;
mod mesh_and_fields;
mod random_groups;
mod showcase;
mod stage;

use std::path::{Path, PathBuf};

use crate::scene::{Scene, file};

pub use random_groups::random;

/// The scene that opens first.
pub const SHOWCASE: &str = "showcase";
/// The seed of the shipped random scenes.
pub const RANDOM_SEED: u64 = 2;

/// Every shipped scene with its file's name, without `.json`.
pub fn all() -> Vec<(&'static str, Scene)> {
    vec![
        (SHOWCASE, showcase::scene()),
        ("pawn", chess_pawn::scene()),
        ("boolean-operations", boolean_operations::scene()),
        ("blend-kernels", blend_kernels::scene()),
        ("ellipsoid-and-plane", ellipsoid_and_plane::scene()),
        ("deep-tree", deep_tree::scene()),
        ("mesh-and-fields", mesh_and_fields::scene()),
        ("random-37", random(32, RANDOM_SEED)),
        ("random-145", random(128, RANDOM_SEED)),
        ("random-577", random(512, RANDOM_SEED)),
    ]
}

/// Writes every scene as `NAME.json` into `folder`, which must exist, and returns the files.
///
/// # Errors
/// The first file that cannot be written.
pub fn write_all(folder: &Path) -> Result<Vec<PathBuf>, file::FileError> {
    all()
        .into_iter()
        .map(|(name, scene)| {
            let path = folder.join(format!("{name}.json"));
            file::save(&scene, &path).map(|()| path)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flat::flatten;
    use crate::mesh::MeshLibrary;
    use crate::scene::NodeKind;

    fn folder() -> PathBuf {
        Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes")
    }

    #[test]
    fn the_files_in_scenes_are_what_stands_here() {
        let mut names: Vec<String> = Vec::new();
        for (name, scene) in all() {
            let shipped = std::fs::read_to_string(folder().join(format!("{name}.json"))).unwrap_or_default();
            let made = file::to_json(&scene).expect("example scenes are within every limit");
            assert!(shipped == made, "scenes/{name}.json is not what gallery makes; run `isolith gallery scenes`");
            names.push(format!("{name}.json"));
        }
        for entry in std::fs::read_dir(folder()).expect("scenes/ is shipped").flatten() {
            let name = entry.file_name().to_string_lossy().into_owned();
            assert!(!name.ends_with(".json") || names.contains(&name), "nothing makes scenes/{name}");
        }
    }

    #[test]
    fn every_scene_can_be_shown() {
        let mut library = MeshLibrary::new(Some(folder()));
        for (name, scene) in all() {
            scene.assert_invariants();
            let flat = flatten(&scene, 0.0).expect(name);
            assert_eq!(flat.warnings, [], "{name}");
            assert!(flat.cameras.iter().any(|c| c.name == "Camera"), "{name}");
            assert!(!flat.lights.is_empty() && !flat.components.is_empty(), "{name}");
            for mesh in &flat.meshes {
                assert!(library.get(&mesh.path).is_ok(), "{name}");
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
            assert_ne!(scene, random(leaves, RANDOM_SEED + 1));
        }
    }

    #[test]
    fn the_deep_tree_is_deep() {
        let depth = deep_tree::scene().depths().iter().max().copied();
        assert!(depth.is_some_and(|d| d >= 64));
    }
}
