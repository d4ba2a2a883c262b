//! The example scenes, made by code: the same on every machine and every run.
//!
//! They are shipped as files in `scenes/`; a test holds the files to what stands here. Each is an
//! example for artists, a golden test and a bench at once.

mod blend_kernels;
mod boolean_operations;
mod chess_pawn;
mod chessboard;
mod crowds;
mod deep_tree;
mod drawn;
mod ellipsoid_and_plane;
mod fractals;
mod mesh_and_fields;
mod modifiers;
mod operators;
mod random_groups;
mod scene_builder;
mod shapes;
mod showcase;
mod write;

use isolith_scene::Scene;

pub use crowds::{boxes, crowd, spheres};
pub use random_groups::random;
pub use write::{install, write_all};

/// The scene that opens first.
pub const SHOWCASE: &str = "showcase";
/// The seed of the shipped random scenes.
pub const RANDOM_SEED: u64 = 2;

/// Shipped scenes that check the program and show nothing that an artist would make.
const TEST_SCENES: [&str; 6] =
    ["blend-kernels", "deep-tree", "ellipsoid-and-plane", "random-37", "random-145", "random-577"];

/// Whether the shipped scene of this name only checks the program.
pub fn is_test_scene(name: &str) -> bool {
    TEST_SCENES.contains(&name)
}

/// Every shipped scene with its file's name, without `.json`.
pub fn all() -> Vec<(&'static str, Scene)> {
    vec![
        (SHOWCASE, showcase::scene()),
        ("pawn", chess_pawn::scene()),
        ("boolean-operations", boolean_operations::scene()),
        ("blend-kernels", blend_kernels::scene()),
        ("operators", operators::scene()),
        ("ellipsoid-and-plane", ellipsoid_and_plane::scene()),
        ("shapes", shapes::scene()),
        ("deep-tree", deep_tree::scene()),
        ("modifiers", modifiers::scene()),
        ("fractals", fractals::scene()),
        ("chessboard", chessboard::scene()),
        ("drawn", drawn::scene()),
        ("mesh-and-fields", mesh_and_fields::scene()),
        ("random-37", random(32, RANDOM_SEED)),
        ("random-145", random(128, RANDOM_SEED)),
        ("random-577", random(512, RANDOM_SEED)),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn test_scenes_are_shipped_and_the_first_scene_is_none_of_them() {
        let names: Vec<_> = all().into_iter().map(|(name, _)| name).collect();
        for name in TEST_SCENES {
            assert!(names.contains(&name), "{name}");
        }
        assert!(!is_test_scene(SHOWCASE));
    }
}
