//! The materials of the document for panels: use counts, thumbnails, presets, and the material in the foreground.

use std::collections::{HashMap, HashSet};

use super::material_edits::material_of;
use super::thumbnails::Thumbnails;
use isolith_document::Document;
use isolith_scene::{Material, MaterialId, NodeId, material_presets};

/// See the module.
pub struct MaterialLibrary {
    /// The thumbnails.
    pub thumbnails: Thumbnails,
    /// The material in the foreground: that of the active node, or the one chosen in the list.
    pub current: Option<MaterialId>,
    /// The search text of the list of presets.
    pub search: String,
    presets: Vec<Material>,
    preset_names: HashSet<String>,
    uses: HashMap<MaterialId, usize>,
    /// The revision that `uses` belongs to.
    counted: Option<u64>,
    /// The last selection, and the material of its active node.
    seen: (Vec<NodeId>, Option<MaterialId>),
}

impl Default for MaterialLibrary {
    fn default() -> Self {
        let presets: Vec<_> = material_presets().collect();
        Self {
            thumbnails: Thumbnails::default(),
            current: None,
            search: String::new(),
            preset_names: presets.iter().map(|preset| preset.name.clone()).collect(),
            presets,
            uses: HashMap::new(),
            counted: None,
            seen: (Vec::new(), None),
        }
    }
}

impl MaterialLibrary {
    /// How many nodes use a material.
    pub fn uses(&self, id: MaterialId) -> usize {
        self.uses.get(&id).copied().unwrap_or(0)
    }

    /// The ready-made materials.
    pub fn presets(&self) -> &[Material] {
        &self.presets
    }

    /// Their names.
    pub fn preset_names(&self) -> &HashSet<String> {
        &self.preset_names
    }

    /// Brings a material into the foreground. The caller deselects all nodes.
    pub fn choose(&mut self, id: MaterialId) {
        (self.current, self.seen) = (Some(id), (Vec::new(), None));
    }

    /// Counts the uses again if the document has changed, and follows its selection.
    pub fn follow(&mut self, document: &Document) {
        let scene = document.scene();
        if self.counted != Some(document.revision()) {
            self.counted = Some(document.revision());
            self.uses.clear();
            for node in scene.nodes() {
                let used: HashSet<MaterialId> = node.materials().collect();
                used.into_iter().for_each(|id| *self.uses.entry(id).or_default() += 1);
            }
            self.current = self.current.filter(|id| scene.material(*id).is_some());
        }
        let selection = document.selection();
        let active = selection.last().and_then(|id| scene.node(*id)).and_then(|node| material_of(node));
        if self.seen.0 != selection || self.seen.1 != active {
            self.seen = (selection.to_vec(), active);
            self.current = active;
        }
    }

    /// Forgets everything of the document.
    pub fn forget(&mut self) {
        self.thumbnails.forget_scene();
        (self.current, self.counted, self.seen) = (None, None, (Vec::new(), None));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use isolith_document::Edit;
    use isolith_scene::{Node, NodeKind, Object, Scene, ShapeKind};

    #[test]
    fn uses_follow_the_document_and_the_foreground_follows_the_selection() {
        let mut document = Document::new(Scene::new());
        let clay = document.scene().materials()[0].id;
        let mut library = MaterialLibrary::default();
        library.follow(&document);
        assert_eq!((library.uses(clay), library.current), (0, None));
        let object = Object { shape: ShapeKind::Box.default_shape(), material: clay };
        let node = Node::new("Box", NodeKind::Object(object));
        let added = document.apply(Edit::Insert { parent: None, position: 0, node }).unwrap();
        document.select(added);
        library.follow(&document);
        assert_eq!((library.uses(clay), library.current), (1, Some(clay)));
        document.select(Vec::new());
        library.follow(&document);
        assert_eq!(library.current, None);
        library.choose(clay);
        library.follow(&document);
        assert_eq!(library.current, Some(clay), "it stays until something is selected");
        document.undo();
        library.follow(&document);
        assert_eq!(library.uses(clay), 0);
    }
}
