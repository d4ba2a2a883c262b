//! Shaders from disk, for shader development: with the feature `shaders-from-disk` an edit needs a restart, but no
//! rebuild.

use std::path::Path;

/// The current text of a file of `shaders/`, if it is readable.
pub fn read(root: &Path, name: &str) -> Option<String> {
    std::fs::read_to_string(root.join(name)).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_read_as_they_are_now() {
        let folder = tempfile::tempdir().expect("a folder");
        std::fs::create_dir(folder.path().join("sdf")).expect("a folder below it");
        for text in ["// One.\n", "// Two.\n"] {
            std::fs::write(folder.path().join("sdf/new.wgsl"), text).expect("it can be written");
            assert_eq!(read(folder.path(), "sdf/new.wgsl").as_deref(), Some(text));
        }
        assert_eq!(read(folder.path(), "sdf/old.wgsl"), None);
    }
}
