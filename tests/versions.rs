//! Files of every version of the format keep their meaning: `tests/versions/N` holds such files.

use std::path::{Path, PathBuf};

use glam::DVec3;
use isolith::field::eval::field;
use isolith::field::flatten;
use isolith::scene::{NodeKind, Scene, file};

/// Meaning of a file: numbers of groups, objects, meshes, lights and cameras; then the field at some points, in meters,
/// to a millimeter.
type Meaning = ([usize; 5], [f64; 5]);

/// Recorded while each version was the present one. Never change them: they exist to catch a change of the
/// reader.
const MEANINGS: [(&str, Meaning); 4] = [
    ("1/mesh-and-fields.json", ([7, 16, 1, 3, 1], [-0.05, 0.076, 0.732, 1.924, 0.212])),
    ("1/showcase.json", ([17, 67, 0, 4, 1], [-0.131, -0.302, 0.805, 1.28, 0.141])),
    ("2/mesh-and-fields.json", ([7, 16, 1, 3, 1], [-0.05, 0.076, 0.73, 1.924, 0.212])),
    ("2/showcase.json", ([17, 67, 0, 4, 1], [-0.131, -0.302, 0.805, 1.28, 0.141])),
];

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/versions")
}

fn meaning(scene: &Scene) -> Meaning {
    let mut counts = [0; 5];
    for node in scene.nodes() {
        counts[match node.kind {
            NodeKind::Group(_) => 0,
            NodeKind::Object(_) => 1,
            NodeKind::Mesh(_) => 2,
            NodeKind::Light(_) => 3,
            NodeKind::Camera(_) => 4,
            NodeKind::Instancer(_) => unreachable!("no file of these versions has one"),
        }] += 1;
    }
    let flat = flatten(scene, 0.0).unwrap();
    let at = |p: DVec3| flat.components.iter().map(|c| field(&flat, c, p - c.origin)).fold(f64::INFINITY, f64::min);
    let points = [[0.0, 0.0, 0.0], [0.0, 2.0, 0.0], [1.0, 0.5, -1.0], [-2.0, 1.0, 1.5], [0.3, 1.4, 0.6]];
    (counts, points.map(|p| (at(p.into()) * 1e3).round() / 1e3))
}

#[test]
fn files_of_every_version_mean_what_they_meant() {
    for (name, expected) in MEANINGS {
        let path = folder().join(name);
        let scene = file::parse(&std::fs::read(&path).unwrap(), &path).unwrap();
        assert_eq!(meaning(&scene), expected, "{name}");
        // Written again, it is a file of the current version with the same meaning.
        let text = file::to_json(&scene).unwrap();
        let version: serde_json::Value = serde_json::from_str(&text).unwrap();
        assert_eq!(version["isolith"], file::VERSION);
        let again = file::parse(text.as_bytes(), &path).unwrap();
        assert_eq!(meaning(&again), expected, "{name}, written anew");
    }
}

#[test]
fn every_version_has_files() {
    for version in 1..=file::VERSION {
        let count = MEANINGS.iter().filter(|(name, _)| name.starts_with(&format!("{version}/"))).count();
        let held = std::fs::read_dir(folder().join(version.to_string())).unwrap().count();
        assert!(count > 0 && count == held, "version {version}: {count} of {held} files are read");
    }
}
