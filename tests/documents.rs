//! Documents: every edit can be undone and redone, byte for byte, and a refused edit changes nothing.

use glam::{DQuat, DVec3};
use isolith::document::{Document, Edit, MAX_STEPS, RecentFiles};
use isolith::scene::{
    Group, Instancer, Material, MaterialId, Node, NodeId, NodeKind, Object, ParamValue, Scene, SceneError, Shape, file,
};

use crate::random_scene::{Random, random_scene};

fn group(name: &str) -> Node {
    Node::new(name, NodeKind::Group(Group::UNION))
}

fn ball(name: &str) -> Node {
    let shape = Shape::Sphere { radius: 0.5 };
    Node::new(name, NodeKind::Object(Object { shape, material: MaterialId(1) }))
}

fn add(document: &mut Document, parent: Option<NodeId>, node: Node) -> NodeId {
    document.apply(Edit::Insert { parent, position: usize::MAX, node }).expect("can be added")[0]
}

fn names(document: &Document, parent: Option<NodeId>) -> Vec<String> {
    document.scene().children(parent).map(|n| n.name.clone()).collect()
}

fn text(document: &Document) -> String {
    file::to_json(document.scene()).expect("edits keep the limits")
}

fn with_radius(node: &Node, radius: f64) -> Node {
    let mut node = node.clone();
    if let NodeKind::Object(object) = &mut node.kind {
        assert!(object.shape.set_value(0, ParamValue::Scalar(radius)));
    }
    node
}

#[test]
fn parameters_are_set_by_their_paths_undone_and_held_to_their_limits() {
    let mut document = Document::new(Scene::new());
    let id = add(&mut document, None, ball("b"));
    let before = text(&document);
    let set = |document: &mut Document, path: &str, value: ParamValue| {
        document.apply(Edit::SetParam { path: path.parse()?, value })
    };
    for (path, value) in [
        (format!("node.{id}.object.shape.radius").replace('#', ""), ParamValue::Scalar(2.0)),
        (format!("node.{id}.transform.translation[1]").replace('#', ""), ParamValue::Scalar(3.0)),
        ("material.1.specular_weight".into(), ParamValue::Scalar(0.5)),
        ("environment.background.sky".into(), ParamValue::Vector(DVec3::ONE)),
        ("display.exposure".into(), ParamValue::Scalar(1.5)),
    ] {
        let revision = document.revision();
        set(&mut document, &path, value.clone()).expect(&path);
        let parsed: isolith::scene::ParamPath = path.parse().expect("a path");
        assert_eq!(parsed.get(document.scene()).as_ref(), Ok(&value), "{path}");
        assert!(document.revision() > revision);
        // Repeating the edit changes nothing and adds no step.
        let steps = document.undo_labels().count();
        set(&mut document, &path, value).expect(&path);
        assert_eq!(document.undo_labels().count(), steps, "{path}");
    }
    let labels: Vec<_> = document.undo_labels().take(5).map(str::to_owned).collect();
    assert_eq!(labels, ["Change display", "Change environment", "Change material Clay", "Move b", "Change b"]);
    let now = text(&document);
    let radius = format!("node.{}.object.shape.radius", id.0);
    let error = set(&mut document, &radius, ParamValue::Scalar(-1.0)).expect_err("beyond its limits").to_string();
    assert!(error.contains("b #") && error.contains("object.shape.radius: must be 0 to"), "{error}");
    let error = set(&mut document, "node.99.transform.scale", ParamValue::Scalar(1.0)).expect_err("no such node");
    assert_eq!(error, SceneError::NoNode(NodeId(99)));
    let length = format!("node.{}.object.shape.length", id.0);
    let error = set(&mut document, &length, ParamValue::Scalar(1.0)).expect_err("a ball has none").to_string();
    assert!(error.starts_with(&length) && error.contains("there is radius"), "{error}");
    assert_eq!(text(&document), now, "what is refused changes nothing");
    for _ in 0..5 {
        assert!(document.undo());
    }
    assert_eq!(text(&document), before);
}

/// Some ids of the scene, occasionally one that does not exist.
fn some_ids(random: &mut Random, scene: &Scene) -> Vec<NodeId> {
    let count = random.below(4) + usize::from(!random.once_in(10));
    let mut pick = || match scene.nodes().len() {
        0 => NodeId(1),
        _ if random.once_in(40) => NodeId(987_654),
        n => scene.nodes()[random.below(n)].id,
    };
    (0..count).map(|_| pick()).collect()
}

/// A random edit, often one that must be refused.
fn some_edit(random: &mut Random, scene: &Scene) -> Edit {
    let materials: Vec<MaterialId> = scene.materials().iter().map(|m| m.id).collect();
    let parent = some_ids(random, scene).first().copied().filter(|_| !random.once_in(3));
    let position = random.below(5);
    match random.below(if scene.nodes().len() > 150 { 4 } else { 14 }) {
        0 | 1 => Edit::Remove(some_ids(random, scene)),
        2..=4 => Edit::Move { ids: some_ids(random, scene), parent, position },
        5 => Edit::Duplicate(some_ids(random, scene)),
        6 if random.once_in(2) => {
            let node = Node::new("Copies", NodeKind::Instancer(Box::default()));
            Edit::Instance { ids: some_ids(random, scene), node }
        }
        6 => Edit::Group { ids: some_ids(random, scene), group: random.group() },
        7 => {
            let id = MaterialId(random.below(8) as u64);
            Edit::ReplaceMaterial(random.material(id.0))
        }
        8 => {
            let id = random.below(8) as u64;
            Edit::InsertMaterial(random.material(id))
        }
        9 if random.below(2) == 0 => {
            Edit::MoveMaterial { id: MaterialId(random.below(8) as u64), position: random.below(6) }
        }
        9 => Edit::RemoveMaterial(MaterialId(random.below(8) as u64)),
        10 => Edit::SetEnvironment(random.environment()),
        12 if random.once_in(3) => Edit::SetDisplay(random.display()),
        11 => {
            let id = some_ids(random, scene).first().copied().unwrap_or(NodeId(3));
            Edit::Replace(Node { id, ..random.node(&materials) })
        }
        _ => {
            let mut node = random.node(&materials);
            if random.once_in(6) {
                node.transform.translation.y = random.pick(&[f64::NAN, f64::INFINITY, 1e10]);
            }
            Edit::Insert { parent, position, node }
        }
    }
}

#[test]
fn random_edits_keep_the_rules_and_are_undone_byte_for_byte() {
    for seed in 0..8 {
        let mut random = Random::new(seed);
        let mut document = Document::new(random_scene(seed, 30));
        let mut texts = vec![text(&document)];
        let (mut done, mut refused) = (0, 0);
        for _ in 0..500 {
            document.select(some_ids(&mut random, &document.snapshot()));
            let (before, revision, label) = (document.snapshot(), document.revision(), undo_label(&document));
            let edit = some_edit(&mut random, document.scene());
            match document.apply(edit) {
                Ok(added) => {
                    done += 1;
                    assert!(added.iter().all(|id| document.scene().node(*id).is_some()));
                    assert!(added.iter().all(|id| before.node(*id).is_none()));
                }
                Err(_) => {
                    refused += 1;
                    assert_eq!(*document.scene(), *before);
                    assert_eq!((document.revision(), undo_label(&document)), (revision, label));
                }
            }
            document.scene().assert_invariants();
            if *document.scene() != *before {
                assert!(document.revision() > revision);
                texts.push(text(&document));
            }
        }
        assert!(done > 150 && refused > 50, "{done} {refused}");
        undo_and_redo_all(&mut document, &texts);
    }
}

fn undo_label(document: &Document) -> Option<String> {
    document.undo_label().map(str::to_owned)
}

fn undo_and_redo_all(document: &mut Document, texts: &[String]) {
    assert!(document.is_changed());
    for expected in texts.iter().rev().skip(1) {
        let revision = document.revision();
        assert!(document.undo());
        assert!(document.revision() > revision);
        document.scene().assert_invariants();
        assert_eq!(text(document), *expected);
    }
    assert!(!document.undo() && document.undo_label().is_none() && !document.is_changed());
    for expected in texts.iter().skip(1) {
        assert!(document.redo());
        assert_eq!(text(document), *expected);
    }
    assert!(!document.redo() && document.redo_label().is_none() && document.is_changed());
}

#[test]
fn a_drag_is_one_step_and_brings_the_selection_back() {
    let mut document = Document::new(Scene::new());
    let id = add(&mut document, None, ball("Ball"));
    document.select(vec![id]);
    let before = text(&document);
    document.begin_gesture();
    for i in 0..50 {
        let node = with_radius(document.scene().node(id).expect("there"), f64::from(i) * 0.01);
        document.apply(Edit::Replace(node)).expect("valid");
    }
    assert_eq!(document.undo_label(), Some("Change Ball"));
    document.end_gesture();
    document.select(Vec::new());
    assert_eq!(document.undo_labels().collect::<Vec<_>>(), ["Change Ball", "Add Ball"]);
    assert!(document.undo());
    assert_eq!(text(&document), before);
    assert_eq!(document.selection(), [id]);
    assert_eq!(document.redo_label(), Some("Change Ball"));
    assert!(document.redo() && document.selection().is_empty());
    assert_eq!(**document.scene().node(id).expect("there"), with_radius(&Node { id, ..ball("Ball") }, 0.49));
}

#[test]
fn gestures_nest_end_with_undo_and_leave_nothing_when_nothing_changed() {
    let mut document = Document::new(Scene::new());
    let id = add(&mut document, None, ball("Ball"));
    let steps = |d: &Document| d.undo_labels().count();
    document.end_gesture();
    assert_eq!(steps(&document), 1);
    // An edit and its undo; the redo history stays.
    document.apply(Edit::Remove(vec![id])).expect("there");
    assert!(document.undo());
    let original = (**document.scene().node(id).expect("there")).clone();
    document.begin_gesture();
    document.apply(Edit::Replace(with_radius(&original, 2.0))).expect("valid");
    document.apply(Edit::Replace(original.clone())).expect("valid");
    document.end_gesture();
    assert_eq!((steps(&document), document.redo_label()), (1, Some("Delete Ball")));
    // Inner gestures belong to the outer one.
    document.begin_gesture();
    document.begin_gesture();
    document.apply(Edit::Replace(with_radius(&original, 2.0))).expect("valid");
    document.end_gesture();
    assert_eq!(steps(&document), 1);
    document.apply(Edit::Replace(with_radius(&original, 3.0))).expect("valid");
    document.end_gesture();
    assert_eq!((steps(&document), document.redo_label()), (2, None));
    // Undo during a gesture undoes the gesture; its late end is harmless.
    document.begin_gesture();
    document.begin_gesture();
    document.apply(Edit::Replace(with_radius(&original, 4.0))).expect("valid");
    assert!(document.undo());
    assert_eq!(**document.scene().node(id).expect("there"), with_radius(&original, 3.0));
    document.end_gesture();
    document.end_gesture();
    assert_eq!(steps(&document), 2);
    // An edit without an effect adds no step.
    document.apply(Edit::Replace(with_radius(&original, 3.0))).expect("valid");
    document.apply(Edit::Remove(Vec::new())).expect("nothing to do");
    assert_eq!(steps(&document), 2);
}

#[test]
fn refused_values_name_the_node_and_the_field() {
    let mut document = Document::new(Scene::new());
    let id = add(&mut document, None, ball("Ball"));
    let node = document.scene().node(id).expect("there").clone();
    let mut unnamed = (*node).clone();
    unnamed.name = "x".repeat(300);
    let mut flat = (*node).clone();
    flat.transform.scale.z = 0.0;
    for (bad, field) in
        [(with_radius(&node, f64::NAN), "object.shape.radius"), (unnamed, "name"), (flat, "transform.scale[2]")]
    {
        let error = document.apply(Edit::Replace(bad)).expect_err("refused");
        let SceneError::Invalid { subject, field: found, .. } = &error else { panic!("{error}") };
        assert!(found == field && subject.ends_with("#1"), "{error}");
    }
    let mut gold = Material::new(MaterialId(9), "Gold", [1.5, 0.5, 0.5]);
    let error = document.apply(Edit::InsertMaterial(gold.clone())).expect_err("refused").to_string();
    assert_eq!(error, "material Gold #9: base_color[0]: must be 0 to 1, not 1.5");
    gold.base_color[0] = 1.0;
    document.apply(Edit::InsertMaterial(gold)).expect("valid");
    assert_eq!(document.apply(Edit::RemoveMaterial(MaterialId(1))), Err(SceneError::MaterialInUse(MaterialId(1), id)));
    let nothing = Edit::Group { ids: Vec::new(), group: Group::UNION };
    assert_eq!(document.apply(nothing), Err(SceneError::Nothing));
}

#[test]
fn nodes_stay_in_the_world_when_they_change_groups() {
    let mut document = Document::new(Scene::new());
    let turned = DQuat::from_euler(glam::EulerRot::XYZ, 0.4, 1.0, -0.2);
    let a =
        add(&mut document, None, group("a").at(DVec3::new(1.0, 2.0, 3.0)).rotated(turned).scaled(DVec3::splat(2.0)));
    let b = add(&mut document, None, group("b").at(DVec3::Y).scaled(DVec3::splat(-0.5)));
    let sheared = add(&mut document, Some(a), group("c").scaled(DVec3::new(1.0, 2.0, 1.0)));
    let ball =
        add(&mut document, Some(a), ball("ball").at(DVec3::X).rotated(turned).scaled(DVec3::new(1.0, -2.0, 3.0)));
    let world = document.scene().world_from_local(ball);
    let before = document.scene().node(ball).expect("there").transform;
    let to = |d: &mut Document, parent| d.apply(Edit::Move { ids: vec![ball], parent, position: 0 }).expect("moves");
    for parent in [Some(b), None, Some(a), Some(b), Some(a)] {
        to(&mut document, parent);
        let now = document.scene().world_from_local(ball);
        assert!(now.abs_diff_eq(world, 1e-12), "{now}");
    }
    let after = document.scene().node(ball).expect("there").transform;
    assert!(after.scale.abs_diff_eq(before.scale, 1e-12) && after.translation.abs_diff_eq(before.translation, 1e-12));
    // Translation, rotation and scale cannot express a shear: the node keeps its own transform.
    to(&mut document, Some(sheared));
    assert_eq!(document.scene().node(ball).expect("there").transform, after);
}

#[test]
fn grouping_takes_the_place_of_the_first_and_keeps_order_and_world() {
    let mut document = Document::new(Scene::new());
    let [a, b] = ["a", "b"].map(|n| add(&mut document, None, ball(n)));
    let g = add(&mut document, None, group("g").at(DVec3::new(0.0, 5.0, 0.0)));
    let c = add(&mut document, Some(g), ball("c").at(DVec3::X));
    let d = add(&mut document, None, ball("d"));
    let ids = vec![d, c, b];
    let new = document.apply(Edit::Group { ids, group: Group::UNION }).expect("grouped")[0];
    assert_eq!(names(&document, None), ["a", "Group", "g"]);
    assert_eq!(names(&document, Some(new)), ["b", "c", "d"]);
    let c = document.scene().world_from_local(c).translation;
    assert_eq!(c, DVec3::new(1.0, 5.0, 0.0));
    // A group selected together with one of its children moves as a whole.
    let outer = document.apply(Edit::Group { ids: vec![b, new, a], group: Group::UNION }).expect("grouped")[0];
    assert_eq!(
        (names(&document, None), names(&document, Some(outer))),
        (strings(["Group", "g"]), strings(["a", "Group"]))
    );
    // A group cannot move into itself.
    let inside = Edit::Move { ids: vec![outer], parent: Some(new), position: 0 };
    assert_eq!(document.apply(inside), Err(SceneError::Cycle(outer)));
}

fn strings<const N: usize>(texts: [&str; N]) -> Vec<String> {
    texts.map(str::to_owned).to_vec()
}

#[test]
fn several_nodes_move_together_to_a_place_counted_without_them() {
    let mut document = Document::new(Scene::new());
    let ids = ["a", "b", "c", "d", "e"].map(|n| add(&mut document, None, ball(n)));
    let mut to = |ids: &[NodeId], position| {
        document.apply(Edit::Move { ids: ids.to_vec(), parent: None, position }).expect("moves");
        names(&document, None).concat()
    };
    assert_eq!(to(&[ids[3], ids[0]], 1), "badce");
    assert_eq!(to(&[ids[1]], 99), "adceb");
    assert_eq!(to(&[ids[0]], 0), "adceb");
    assert_eq!(to(&[ids[2], ids[2]], 3), "adecb");
}

#[test]
fn copies_have_new_ids_numbered_names_and_stand_behind() {
    let mut document = Document::new(Scene::new());
    let g = add(&mut document, None, group("Pawn"));
    add(&mut document, Some(g), ball("Head"));
    let last = add(&mut document, None, ball("Last 7"));
    let copies = document.apply(Edit::Duplicate(vec![g, last])).expect("copied");
    assert_eq!(names(&document, None), ["Pawn", "Pawn 2", "Last 7", "Last 8"]);
    assert_eq!(names(&document, Some(copies[0])), ["Head"]);
    document.apply(Edit::Duplicate(vec![g])).expect("copied");
    assert_eq!(names(&document, None), ["Pawn", "Pawn 3", "Pawn 2", "Last 7", "Last 8"]);
    document.scene().assert_invariants();
}

#[test]
fn what_is_copied_together_names_the_copies() {
    let mut document = Document::new(Scene::new());
    let ground = add(&mut document, None, ball("Ground"));
    let instancer = |target| Instancer { target: Some(target), ..Instancer::default() };
    let trees = Node::new("Trees", NodeKind::Instancer(Box::new(instancer(ground))));
    let trees = add(&mut document, None, trees);
    let pair = add(&mut document, None, group("Pair"));
    let first = add(&mut document, Some(pair), ball("First"));
    add(&mut document, Some(pair), Node { apart: vec![first], ..ball("Second") });
    let target = |document: &Document, id| match &document.scene().node(id).expect("is there").kind {
        NodeKind::Instancer(instancer) => instancer.target,
        _ => None,
    };
    let alone = document.apply(Edit::Duplicate(vec![trees])).expect("copied")[0];
    assert_eq!(target(&document, alone), Some(ground), "the target was not copied");
    let both = document.apply(Edit::Duplicate(vec![ground, trees])).expect("copied");
    assert_eq!(target(&document, both[1]), Some(both[0]));
    assert_eq!(target(&document, trees), Some(ground), "the original keeps its own");
    let copy = document.apply(Edit::Duplicate(vec![pair])).expect("copied")[0];
    let inside: Vec<_> = document.scene().children(Some(copy)).cloned().collect();
    assert_eq!(inside[1].apart, [inside[0].id]);
}

#[test]
fn titles_paths_and_changes_follow_saving_and_undo() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut document = Document::new(Scene::new());
    assert_eq!((document.title(), document.path()), ("Untitled".to_owned(), None));
    assert!(document.save().is_err());
    add(&mut document, None, ball("Ball"));
    assert_eq!(document.title(), "Untitled *");
    let path = folder.path().join("pawn.json");
    document.save_as(&path).expect("saved");
    assert_eq!((document.title(), document.is_changed()), ("pawn.json".to_owned(), false));
    document.undo();
    assert_eq!(document.title(), "pawn.json *");
    document.redo();
    assert!(!document.is_changed());
    add(&mut document, None, ball("Ball"));
    document.save().expect("saved");
    let opened = Document::open(&path).expect("opens");
    assert_eq!(opened.scene(), document.scene());
    assert_eq!((opened.title(), opened.undo_label()), ("pawn.json".to_owned(), None));
}

#[test]
fn the_history_is_bounded() {
    let mut document = Document::new(Scene::new());
    let id = add(&mut document, None, ball("Ball"));
    let node = document.scene().node(id).expect("there").clone();
    for i in 0..MAX_STEPS + 10 {
        document.apply(Edit::Replace(with_radius(&node, i as f64))).expect("valid");
    }
    assert_eq!(document.undo_labels().count(), MAX_STEPS);
    let steps = std::iter::from_fn(|| document.undo().then_some(())).count();
    assert_eq!(steps, MAX_STEPS);
    assert_eq!(**document.scene().node(id).expect("there"), with_radius(&node, 9.0));
}

#[test]
fn a_snapshot_of_ten_thousand_nodes_costs_next_to_nothing() {
    let mut document = Document::new(Scene::new());
    let mut nodes = vec![Node { id: NodeId(1), ..group("all") }];
    nodes.extend((2..=10_000).map(|i| Node { id: NodeId(i), parent: Some(NodeId(1)), ..ball("Ball") }));
    let materials = document.scene().materials().iter().map(|m| Material::clone(m)).collect();
    document = Document::new(Scene::from_tables(nodes, materials, Default::default(), 1).expect("a table"));
    let node = document.scene().node(NodeId(5_000)).expect("there").clone();
    let mut times: Vec<f64> = (0..200)
        .map(|i| {
            let edit = Edit::Replace(with_radius(&node, f64::from(i) * 0.01));
            let start = std::time::Instant::now();
            document.apply(edit).expect("valid");
            start.elapsed().as_secs_f64() * 1e3
        })
        .collect();
    times.sort_by(f64::total_cmp);
    eprintln!("one step at 10 000 nodes: {:.3} ms", times[100]);
    assert!(times[100] < 1.0, "{} ms", times[100]);
}

#[test]
fn recent_files_are_kept_in_order_and_forgive_everything() {
    let folder = tempfile::tempdir().expect("a folder");
    let store = folder.path().join("state/recent.json");
    let mut recent = RecentFiles::load_from(&store);
    let paths = ["/a.json", "/b.json", "/a.json", "/c.json"].map(std::path::PathBuf::from);
    paths.iter().for_each(|p| recent.add(p));
    let again = RecentFiles::load_from(&store);
    assert_eq!(again.paths(), [&paths[3], &paths[0], &paths[1]].map(Clone::clone));
    (0..100).for_each(|i| recent.add(std::path::Path::new(&format!("/{i}.json"))));
    assert_eq!(RecentFiles::load_from(&store).paths().len(), isolith::document::MAX_RECENT);
    for text in ["", "{", "[1, 2]", "{\"a\": 1}", "[\"relative.json\"]"] {
        std::fs::write(&store, text).expect("written");
        assert!(RecentFiles::load_from(&store).paths().is_empty(), "{text}");
    }
    // A folder at the path of the list: the list stays in memory only.
    let mut recent = RecentFiles::load_from(folder.path());
    recent.add(&paths[0]);
    assert_eq!(recent.paths(), &paths[..1]);
}
