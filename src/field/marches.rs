//! How the components of a scene are marched: by the settings of the nearest node above them that has some.

use super::arrays::Warning;
use super::collect::is_opened;
use isolith_scene::{MarchSettings, Node, NodeId, NodeKind, Scene};

/// The settings of a scene's nodes.
pub(super) struct Marches<'a> {
    scene: &'a Scene,
    /// Whether some node has other settings than the usual ones.
    has_some: bool,
}

impl<'a> Marches<'a> {
    pub fn new(scene: &'a Scene) -> Self {
        Self { scene, has_some: scene.nodes().iter().any(|node| !node.march.is_usual()) }
    }

    /// The node and those above it, to the top.
    fn path(&self, node: &'a Node) -> impl Iterator<Item = &'a Node> {
        let scene = self.scene;
        std::iter::successors(Some(node), move |node| Some(&**scene.node(node.parent?)?))
    }

    /// The settings of the component whose outermost node is this one.
    pub fn of(&self, outermost: &'a Node) -> MarchSettings {
        if !self.has_some {
            return MarchSettings::default();
        }
        self.path(outermost).map(|node| node.march).find(|march| !march.is_usual()).unwrap_or_default()
    }

    /// The node at the top of the scene that this one is part of.
    pub fn top(&self, node: &'a Node) -> NodeId {
        self.path(node).last().map_or(node.id, |node| node.id)
    }

    /// Settings of nodes that are only a part of what is marched.
    pub fn warnings(&self) -> Vec<Warning> {
        let with_some = self.scene.nodes().iter().filter(|node| self.has_some && !node.march.is_usual());
        let warning = |node: &'a Node| {
            // A type of an instancer may have its own.
            let is_whole =
                |above: &&Node| !is_opened(self.scene, above) && !matches!(above.kind, NodeKind::Instancer(_));
            let whole = self.path(node).skip(1).filter(is_whole).last()?;
            let reason =
                format!("has settings of its march, but is marched as a part of {:?}, whose settings hold", whole.name);
            Some(Warning { node: node.id, name: node.name.clone(), reason })
        };
        with_some.filter_map(|node| warning(node)).collect()
    }
}
