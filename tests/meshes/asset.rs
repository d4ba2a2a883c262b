//! The shipped model.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::DVec3;
use isolith::mesh::{MeshLibrary, ReloadOutcome, load};

pub fn scenes() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes")
}

#[test]
fn the_shipped_model_loads_as_it_is_documented() {
    let mesh = load(&scenes().join("models/suzanne.glb")).unwrap();
    assert_eq!((mesh.positions.len(), mesh.triangle_count()), (7503, 14_842));
    assert_eq!(mesh.parts.len(), 1);
    assert_eq!(mesh.parts[0].indices, 0..3 * 14_842);
    assert!(mesh.textures.is_empty() && mesh.warnings.is_empty() && mesh.parts[0].surface.base_color.is_none());
    assert!((mesh.bounds.half() - DVec3::new(0.9297, 0.6690, 0.5605)).length() < 1e-3, "{:?}", mesh.bounds);
    assert!(mesh.bounds.center().length() < 0.02);
    let readme = std::fs::read_to_string(scenes().join("../assets/README.md")).unwrap();
    assert!(readme.contains("suzanne.glb") && readme.contains("CC0") && readme.contains("7 503 vertices"));
}

#[test]
fn the_shipped_model_is_sound() {
    let mesh = load(&scenes().join("models/suzanne.glb")).unwrap();
    let vertices = mesh.positions.len();
    assert!(mesh.normals.len() == vertices && mesh.colors.len() == vertices && mesh.uvs.len() == vertices);
    for normal in &mesh.normals {
        assert!((DVec3::from(normal.map(f64::from)).length() - 1.0).abs() < 1e-5);
    }
    // Face orientation and normals agree on the outside.
    let agreeing = (0..mesh.triangle_count() as u32).filter(|t| {
        let [a, b, c] = mesh.corners(*t);
        let normal = mesh.normals[mesh.indices[*t as usize * 3] as usize];
        (b - a).cross(c - a).dot(DVec3::from(normal.map(f64::from))) > 0.0
    });
    assert!(agreeing.count() > 14_700);
}

#[test]
fn the_library_reads_a_file_once_and_remembers_failures() {
    let mut library = MeshLibrary::new(Some(scenes()));
    let first = library.get("models/suzanne.glb").unwrap();
    assert!(Arc::ptr_eq(&first, &library.get("models/suzanne.glb").unwrap()));
    let missing = library.get("models/nobody.glb").unwrap_err();
    assert!(Arc::ptr_eq(&missing, &library.get("models/nobody.glb").unwrap_err()));
    assert_eq!(missing.file, "models/nobody.glb");
    let source = library.sources().into_iter().find(|source| source.path() == "models/suzanne.glb").unwrap();
    assert!(matches!(library.replace(source.read()), ReloadOutcome::Fresh(_)));
    assert!(!Arc::ptr_eq(&first, &library.get("models/suzanne.glb").unwrap()));
    library.set_folder(None);
    assert!(library.get("models/suzanne.glb").unwrap_err().reason.contains("no folder"));
}
