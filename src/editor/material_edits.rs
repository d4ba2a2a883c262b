//! Changes of materials: each is one undo step.

use std::collections::HashSet;

use super::edit_session::EditSession;
use isolith_document::Edit;
use isolith_scene::{Material, MaterialId, Node, NodeId, NodeKind, Scene};

/// The material of a node; `None` for nodes without one, and for meshes that keep their own.
pub fn material_of(node: &Node) -> Option<MaterialId> {
    match &node.kind {
        NodeKind::Object(object) => Some(object.material),
        NodeKind::Mesh(mesh) => mesh.material,
        _ => None,
    }
}

/// Whether a node can have a material.
pub fn takes_material(node: &Node) -> bool {
    matches!(node.kind, NodeKind::Object(_) | NodeKind::Mesh(_))
}

/// Gives a node a material; `None` leaves a mesh its own.
pub fn set_material(node: &mut Node, id: Option<MaterialId>) {
    match &mut node.kind {
        NodeKind::Object(object) => object.material = id.unwrap_or(object.material),
        NodeKind::Mesh(mesh) => mesh.material = id,
        _ => {}
    }
}

/// The nodes that use a material.
pub fn users(scene: &Scene, id: MaterialId) -> Vec<NodeId> {
    scene.nodes().iter().filter(|node| node.materials().any(|used| used == id)).map(|node| node.id).collect()
}

/// "Used by 4", or that nothing uses it.
pub fn use_text(count: usize) -> String {
    match count {
        0 => "Not used".into(),
        count => format!("Used by {count}"),
    }
}

/// Adds a material with an id and a name of its own; `None` if there are too many.
pub fn insert(session: &mut EditSession, material: Material) -> Option<MaterialId> {
    let scene = session.document.scene();
    let material = Material { id: scene.next_material_id(), name: free_name(scene, &material.name, None), ..material };
    let id = material.id;
    session.apply(Edit::InsertMaterial(material));
    session.document.scene().material(id).map(|_| id)
}

/// Adds a copy.
pub fn duplicate(session: &mut EditSession, id: MaterialId) -> Option<MaterialId> {
    let material = Material::clone(session.document.scene().material(id)?);
    insert(session, material)
}

/// Gives the nodes a material.
pub fn assign(session: &mut EditSession, nodes: &[NodeId], id: Option<MaterialId>) {
    session.together(|session| {
        for node in nodes {
            let Some(node) = session.document.scene().node(*node) else { continue };
            let mut node = Node::clone(node);
            set_material(&mut node, id);
            session.apply(Edit::Replace(node));
        }
    });
}

/// Adds a material and gives it to the nodes.
pub fn insert_for(session: &mut EditSession, nodes: &[NodeId], material: Material) -> Option<MaterialId> {
    session.together(|session| {
        let id = insert(session, material)?;
        assign(session, nodes, Some(id));
        Some(id)
    })
}

/// The materials of these nodes that others use, too.
pub fn shared_by_others(scene: &Scene, nodes: &[NodeId]) -> Vec<MaterialId> {
    let nodes: HashSet<_> = nodes.iter().copied().collect();
    let (mut own, mut of_others) = (Vec::new(), HashSet::new());
    for node in scene.nodes() {
        if !nodes.contains(&node.id) {
            of_others.extend(node.materials());
        } else if let Some(id) = material_of(node).filter(|id| !own.contains(id)) {
            own.push(id);
        }
    }
    own.retain(|id| of_others.contains(id));
    own
}

/// Gives the nodes copies of the materials that others use, too.
pub fn make_unique(session: &mut EditSession, nodes: &[NodeId]) {
    let scene = session.document.snapshot();
    session.together(|session| {
        for shared in shared_by_others(&scene, nodes) {
            let of = |id: &NodeId| scene.node(*id).is_some_and(|node| material_of(node) == Some(shared));
            let wearing: Vec<_> = nodes.iter().copied().filter(of).collect();
            if let Some(copy) = duplicate(session, shared) {
                assign(session, &wearing, Some(copy));
            }
        }
    });
}

/// Gives a material the values of a preset. A name that the artist has chosen stays.
pub fn apply_preset(session: &mut EditSession, id: MaterialId, preset: &Material, names: &HashSet<String>) {
    let Some(old) = session.document.scene().material(id).cloned() else { return };
    let is_ours = names.contains(stem(&old.name)) || stem(&old.name) == NEW;
    let name = if is_ours { free_name(session.document.scene(), &preset.name, Some(id)) } else { old.name.clone() };
    session.apply(Edit::ReplaceMaterial(Material { id, name, ..preset.clone() }));
}

/// Name of a new material.
pub const NEW: &str = "Material";

/// The name without its number.
fn stem(name: &str) -> &str {
    let stem = name.trim_end_matches(|c: char| c.is_ascii_digit());
    if stem.len() < name.len() && stem.ends_with(' ') { stem.trim_end() } else { name }
}

/// The name itself, or with the first free number. The material `own` does not count.
fn free_name(scene: &Scene, base: &str, own: Option<MaterialId>) -> String {
    let others = scene.materials().iter().filter(|material| Some(material.id) != own);
    let taken: HashSet<&str> = others.map(|material| material.name.as_str()).collect();
    if !taken.contains(base) {
        return base.to_owned();
    }
    let numbered = (2..).map(|n| format!("{} {n}", stem(base)));
    numbered.into_iter().find(|name| !taken.contains(name.as_str())).unwrap_or_default()
}

/// Pleasant colors that differ from each other: the next one for each material.
pub fn next_color(scene: &Scene) -> [f64; 3] {
    const COLORS: [[f64; 3]; 10] = [
        [0.70, 0.18, 0.10],
        [0.07, 0.27, 0.55],
        [0.82, 0.52, 0.08],
        [0.10, 0.38, 0.22],
        [0.42, 0.16, 0.45],
        [0.04, 0.42, 0.44],
        [0.75, 0.30, 0.33],
        [0.36, 0.42, 0.10],
        [0.20, 0.22, 0.50],
        [0.55, 0.30, 0.15],
    ];
    // The color that the fewest materials have; the first of these.
    let count = |color: &[f64; 3]| scene.materials().iter().filter(|material| material.base_color == *color).count();
    COLORS.into_iter().min_by_key(count).unwrap_or([0.6; 3])
}

#[cfg(test)]
mod tests {
    use super::*;
    use isolith_document::Document;
    use isolith_scene::{Object, ShapeKind};

    /// Three balls of one material, and its id.
    fn session() -> (EditSession, Vec<NodeId>, MaterialId) {
        let mut scene = Scene::new();
        let material = scene.materials()[0].id;
        let object = || NodeKind::Object(Object { shape: ShapeKind::Sphere.default_shape(), material });
        let nodes = (0..3).map(|_| scene.insert(None, 0, Node::new("Ball", object())).unwrap()).collect();
        (EditSession::new(Document::new(scene)), nodes, material)
    }

    fn names(session: &EditSession) -> Vec<String> {
        session.document.scene().materials().iter().map(|material| material.name.clone()).collect()
    }

    #[test]
    fn a_copy_for_some_nodes_is_one_step_and_only_where_others_use_the_material() {
        let (mut session, nodes, clay) = session();
        let before = session.document.snapshot();
        assert_eq!(shared_by_others(&before, &nodes), []);
        make_unique(&mut session, &nodes);
        assert!(session.document.undo_label().is_none(), "nobody else uses it");
        make_unique(&mut session, &nodes[..2]);
        let scene = session.document.snapshot();
        assert_eq!(names(&session), ["Clay", "Clay 2"]);
        assert_eq!(users(&scene, clay), [nodes[2]]);
        assert_eq!(users(&scene, scene.materials()[1].id).len(), 2, "both get the same copy");
        assert!(session.document.undo());
        assert_eq!(session.document.snapshot(), before);
        assert!(!session.document.undo(), "one step");
    }

    #[test]
    fn names_are_free_and_numbered() {
        let (mut session, _, clay) = session();
        for name in ["Clay 2", "Clay 3", "Clay 4"] {
            let id = duplicate(&mut session, clay).unwrap();
            assert_eq!(session.document.scene().material(id).unwrap().name, name);
        }
        let last = session.document.scene().materials()[3].id;
        duplicate(&mut session, last);
        assert_eq!(names(&session)[4], "Clay 5", "not Clay 4 2");
    }

    #[test]
    fn a_preset_keeps_a_name_that_was_chosen() {
        let (mut session, _, clay) = session();
        let gold = Material::new(MaterialId(9), "Gold", [0.9, 0.6, 0.2]);
        let presets = HashSet::from(["Gold".to_owned(), "Clay".to_owned()]);
        let own = insert(&mut session, Material::new(MaterialId(0), "Hull", [0.5; 3])).unwrap();
        for id in [clay, own] {
            apply_preset(&mut session, id, &gold, &presets);
        }
        assert_eq!(names(&session), ["Gold", "Hull"]);
        assert!(session.document.scene().materials().iter().all(|material| material.base_color == gold.base_color));
    }

    #[test]
    fn new_colors_differ() {
        let (mut session, ..) = session();
        let mut seen = Vec::new();
        for _ in 0..10 {
            let color = next_color(session.document.scene());
            assert!(!seen.contains(&color), "{color:?} twice");
            seen.push(color);
            insert(&mut session, Material::new(MaterialId(0), NEW, color));
        }
    }
}
