//! Scenes built to exhaust memory or time: flattening refuses them with the node, or succeeds, within seconds.

use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use glam::DVec3;
use isolith::field::{
    Cancel, FlatScene, FlattenError, MAX_COMPONENT_NODES, MAX_FLAT_LEVELS, MAX_FLAT_NODES, MAX_LIGHTS, MAX_STACK,
    flatten, flatten_until,
};
use isolith::scene::{Modifier, Node, NodeId, NodeKind, Operator, Scene, Shape, file};

use super::{ALL_AXES, add, around, ball, blended, case, group, load, object};

/// Time limit of each, in test builds too.
const LONGEST: Duration = Duration::from_secs(5);

/// Flattens the scene and asserts the time limit.
fn timed(name: &str, scene: &Scene) -> Result<FlatScene, FlattenError> {
    let started = Instant::now();
    let result = flatten(scene, 0.0);
    assert!(started.elapsed() < LONGEST, "{name} took {:?}", started.elapsed());
    result
}

/// The exceeded limit and the node that exceeded it.
fn refused(name: &str, scene: &Scene) -> (u64, String, usize) {
    match timed(name, scene) {
        Err(FlattenError { node, what, value, limit, .. }) => {
            assert!(value > limit, "{name}: {value}, {limit}");
            (node.0, what.to_string(), value)
        }
        Ok(flat) => panic!("{name} has {} entries and is accepted", flat.nodes.len()),
    }
}

#[test]
fn cases_are_refused_with_the_node_that_multiplies() {
    let expected = [
        ("polar2", 1, "copies included", 1024 * 1024),
        ("polar2-cut", 1, "copies included", 1024 * 512),
        ("polar2-round30", 1, "copies included", 31 * 1024 * 1023),
        ("deep", 132, "the nesting of groups", 160),
        ("apart-nest-20", 55, "copies included", 524_268),
    ];
    for (name, node, what, value) in expected {
        let found = refused(name, &load(&format!("hostile/{name}.json")));
        assert_eq!((found.0, found.2), (node, value), "{name}");
        assert!(found.1.contains(what), "{name}: {found:?}");
    }
}

#[test]
fn copies_of_nothing_are_nothing() {
    let flat = timed("polar-empty", &load("hostile/polar-empty.json")).expect("nothing is within every limit");
    assert!(flat.nodes.is_empty() && flat.warnings.is_empty());
    let nothings: [(&str, Node); 4] = [
        ("empty group", group(Operator::Union)),
        ("no size", object(Shape::Box { size: [0.0; 3], rounding: 0.0 })),
        ("hidden", Node { visible: false, ..ball() }),
        ("negative group", blended(Operator::Pipe).subtracted()),
    ];
    let recursion =
        Modifier::Recursion { count: 12, offset: [0.5; 3], rotation: [10.0; 3], scale: 0.9, mirrored: [true; 3] };
    for (name, nothing) in nothings {
        let mut scene = Scene::new();
        let mut parent = None;
        for depth in 0..200 {
            let chain = [ALL_AXES, around(1024), recursion.clone(), Modifier::Twist { angle: 10.0 }];
            let outer = chain.into_iter().cycle().take(32).fold(blended(Operator::Union), Node::modified);
            parent = Some(add(&mut scene, parent, if depth % 2 == 0 { outer } else { group(Operator::Difference) }));
        }
        add(&mut scene, parent, nothing);
        let flat = timed(name, &scene).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!(flat.nodes.is_empty(), "{name}");
    }
}

#[test]
fn what_turns_out_to_be_nothing_is_not_copied_either() {
    // Letters that no font draws: only evaluation reveals that the text is empty.
    let text = Shape::Text {
        text: "\u{200b}".into(),
        font: isolith::scene::Attachment::NONE,
        size: 1.0,
        depth: 0.2,
        rounding: 0.0,
    };
    let mut scene = Scene::new();
    let cut = blended(Operator::Intersection).modified(around(255)).modified(around(255));
    let parent = add(&mut scene, None, cut);
    add(&mut scene, Some(parent), object(text));
    let started = Instant::now();
    flatten(&scene, 0.0).expect("within every limit");
    assert!(started.elapsed() < LONGEST);
}

#[test]
fn chains_of_copies_are_counted_before_they_are_made() {
    let chains: [(&str, Vec<Modifier>); 4] = [
        ("mirrors", vec![ALL_AXES; 32]),
        ("rings", vec![around(1024); 32]),
        ("mirrored rings", vec![ALL_AXES, around(512), ALL_AXES, around(512)]),
        ("rings of modified content", [vec![Modifier::Round { radius: 0.01 }; 20], vec![around(128); 2]].concat()),
    ];
    for (name, chain) in chains {
        let mut scene = Scene::new();
        add(&mut scene, None, chain.into_iter().fold(ball(), Node::modified));
        let (node, what, value) = refused(name, &scene);
        assert!(node == 1 && what.contains("copies included") && value > MAX_FLAT_NODES, "{name}: {what} {value}");
    }
    // Too many separate components.
    let mut scene = Scene::new();
    let ring = ball().modified(Modifier::Round { radius: 0.01 }).modified(around(512)).modified(around(255));
    add(&mut scene, None, ring);
    let (node, what, value) = refused("separate parts", &scene);
    assert!(node == 1 && what.contains("hard union") && value == 512 * 255, "{what} {value}");
    // Many rings, each within the limit: the error names the group that contains too many.
    let mut scene = Scene::new();
    let parent = add(&mut scene, None, blended(Operator::Union));
    for _ in 0..400 {
        add(&mut scene, Some(parent), ball().modified(around(1000)));
    }
    assert_eq!(refused("rings in a group", &scene).0, parent.0);
}

#[test]
fn cuts_into_many_components_are_counted() {
    let mut scene = Scene::new();
    add(&mut scene, None, ball().modified(around(512)).modified(around(256)));
    let cut = add(&mut scene, None, ball().modified(around(1024)).subtracted());
    assert_eq!(refused("a ring of cuts", &scene).0, cut.0);
    // As many cuts as components, each reaching one: flattening must not compare all with all.
    let mut scene = Scene::new();
    let place = |i: usize| DVec3::new((i % 200) as f64, 0.0, (i / 200) as f64) * 5.0;
    let pairs = (0..20_000).map(|i| (ball().at(place(i)), ball().at(place(i) + DVec3::Y).subtracted()));
    let (balls, cuts): (Vec<Node>, Vec<Node>) = pairs.unzip();
    let nodes = balls.into_iter().chain(cuts).enumerate().map(|(i, node)| Node { id: NodeId(1 + i as u64), ..node });
    scene.set_nodes(nodes.map(Into::into).collect()).expect("a table");
    let flat = timed("cuts one by one", &scene).expect("within every limit");
    assert_eq!(flat.nodes.iter().filter(|node| node.is_leaf()).count(), 40_000);
    let joined = flat.components.iter().filter(|component| component.count % 2 == 0).count();
    assert_eq!(joined, flat.components.len(), "each ball has its cut");
}

#[test]
fn exclusions_are_counted() {
    // A row of balls, each apart from the previous one: every ball joins all others once more.
    let mut scene = Scene::new();
    let parent = add(&mut scene, None, blended(Operator::Union));
    let mut before = None;
    for i in 0..1500 {
        let node = Node { apart: before.into_iter().collect(), ..ball().at(DVec3::X * f64::from(i)) };
        before = Some(add(&mut scene, Some(parent), node));
    }
    refused("a row", &scene);
    // Exclusions of nodes that do not exist need no comparisons.
    let mut scene = Scene::new();
    let parent = add(&mut scene, None, blended(Operator::Union));
    let apart: Vec<NodeId> = (0..64).map(|i| NodeId(900_000 + i)).collect();
    let children = (0..50_000).map(|i| Node {
        id: NodeId(2 + i),
        parent: Some(parent),
        apart: apart.clone(),
        ..ball().at(DVec3::X * i as f64)
    });
    let group = Node::clone(&scene.nodes()[0]);
    scene.set_nodes(std::iter::once(group).chain(children).map(Into::into).collect()).expect("a table");
    let (node, _, value) = refused("strangers", &scene);
    assert_eq!((node, value > MAX_COMPONENT_NODES), (parent.0, true));
    // Exclusions that double the work at each of sixty levels.
    let mut scene = Scene::new();
    let mut parent = None;
    for _ in 0..60 {
        let id = scene.insert(parent, 0, blended(Operator::Union)).expect("the scene has room");
        let first = add(&mut scene, Some(id), ball());
        add(&mut scene, Some(id), Node { apart: vec![first], ..ball().at(DVec3::X) });
        parent = Some(id);
    }
    refused("levels", &scene);
}

#[test]
fn modifiers_that_can_do_nothing_do_not_double_the_work() {
    let mut scene = Scene::new();
    let mut parent = None;
    for _ in 0..4 {
        let twisted =
            (0..30).fold(blended(Operator::Difference), |node, _| node.modified(Modifier::Twist { angle: 9.0 }));
        parent = Some(add(&mut scene, parent, twisted));
        add(&mut scene, parent, object(Shape::Plane {}));
    }
    let flat = timed("endless twists", &scene).expect("within every limit");
    assert!(flat.components.len() == 1 && flat.warnings.len() == 4, "{:?}", flat.warnings);
}

#[test]
fn nesting_is_limited_before_it_fills_the_stack() {
    let nested = |count: usize, outer: &dyn Fn(usize) -> Node| {
        let mut scene = Scene::new();
        let nodes = (0..count).map(outer).chain([ball(), ball().at(DVec3::X)]).enumerate().map(|(i, node)| {
            let parent = i.min(count).checked_sub(1).map(|above| NodeId(1 + above as u64));
            Node { id: NodeId(1 + i as u64), parent, ..node }
        });
        scene.set_nodes(nodes.map(Into::into).collect()).expect("a table");
        scene
    };
    // One copy at every level.
    let once = |_: usize| (0..32).fold(blended(Operator::Union), |node, _| node.modified(around(1)));
    let (_, what, value) = refused("rings of one", &nested(1000, &once));
    assert!(what.contains("nesting") && value > MAX_FLAT_LEVELS, "{what}: {value}");
    let rounded =
        |_: usize| (0..32).fold(group(Operator::Union), |node, _| node.modified(Modifier::Round { radius: 0.1 }));
    let (node, what, value) = refused("rounds", &nested(136, &rounded));
    assert!(what.contains("nesting") && value > MAX_STACK as usize && node > 100, "{node}, {what}: {value}");
    let (_, what, _) = refused("mirrors", &nested(1000, &|_| blended(Operator::Union).modified(ALL_AXES)));
    assert!(what.contains("copies included"), "{what}");
    // Without modifiers, flattening simplifies all of it.
    for operator in [Operator::Union, Operator::Difference] {
        let flat = timed("deep", &nested(1000, &|_| blended(operator))).expect("within every limit");
        assert_eq!(flat.nodes.len(), 2, "{operator:?}");
    }
    let few =
        nested(900, &|i| if i % 2 == 0 { blended(Operator::Union).modified(around(1)) } else { group(Operator::Xor) });
    assert_eq!(timed("rings of one, fewer", &few).expect("within every limit").nodes.len(), 2);
}

#[test]
fn deep_nesting_that_stays_is_named_and_deep_nesting_around_many_is_quick() {
    // Alternating operators, with a sibling before each, so that no level can be simplified.
    let mut scene = Scene::new();
    let mut parent = None;
    for i in 0..1000 {
        let operator = [Operator::Difference, Operator::Union][i % 2];
        parent = Some(add(&mut scene, parent, blended(operator)));
        add(&mut scene, parent, ball().at(DVec3::X * i as f64));
    }
    let (_, what, value) = refused("alternating", &scene);
    assert!(what.contains("nesting") && value > MAX_STACK as usize, "{what}: {value}");
    let mut scene = load("numerics/deep_nest_100_alternating.json");
    assert!(timed("100 alternating", &scene).is_ok());
    scene = Scene::new();
    let count = 600_u64;
    let outer = (0..count).map(|_| group(Operator::Union));
    let inner = (0..50_000).map(|i| ball().at(DVec3::new(f64::from(i % 200), 0.0, f64::from(i / 200)) * 3.0));
    let nodes = outer.chain(inner).zip(0_u64..).map(|(node, i)| Node {
        id: NodeId(1 + i),
        parent: i.min(count).checked_sub(1).map(|above| NodeId(1 + above)),
        ..node
    });
    scene.set_nodes(nodes.map(Into::into).collect()).expect("a table");
    let flat = timed("50 000 below 600 groups", &scene).expect("within every limit");
    assert_eq!(flat.nodes.iter().filter(|node| node.is_leaf()).count(), 50_000);
}

fn sun() -> Node {
    Node::new("sun", NodeKind::Light(isolith::scene::Light::sun()))
}

#[test]
fn as_many_nodes_as_a_scene_holds_are_flattened() {
    let table = |node: &dyn Fn(u64) -> Node| {
        let mut scene = Scene::new();
        let first = Node { id: NodeId(1), ..group(Operator::Union) };
        let others = (2..=100_000).map(|i| Node { id: NodeId(i), parent: Some(NodeId(1)), ..node(i) });
        scene.set_nodes(std::iter::once(first).chain(others).map(Into::into).collect()).expect("a table");
        scene
    };
    let place = |i: u64| DVec3::new((i % 300) as f64, 0.0, (i / 300) as f64) * 3.0;
    let flat = timed("balls", &table(&|i| ball().at(place(i)))).expect("within every limit");
    assert_eq!(flat.nodes.iter().filter(|node| node.is_leaf()).count(), 99_999);
    let empty = timed("empty groups", &table(&|_| group(Operator::Union))).expect("within every limit");
    assert!(empty.nodes.is_empty());
    let light = |i: u64| if i.is_multiple_of(7) { sun() } else { group(Operator::Union) };
    assert_eq!(timed("lights", &table(&light)).expect("within every limit").lights.len(), 14_285);
    let (_, what, value) = refused("too many lights", &table(&|_| sun()));
    assert!(what.contains("lights") && value == MAX_LIGHTS + 1, "{what}: {value}");
}

#[test]
fn repetitions_of_repetitions_are_limited_by_what_a_point_meets() {
    let recursion = |count| Modifier::Recursion {
        count,
        offset: [0.5, 0.0, 0.0],
        rotation: [0.0; 3],
        scale: 0.9,
        mirrored: [false; 3],
    };
    let mut scene = Scene::new();
    add(&mut scene, None, (0..8).fold(ball(), |node, _| node.modified(recursion(12))));
    let (node, what, value) = refused("recursions of recursions", &scene);
    assert!(node == 1 && what.contains("one point") && value > 1 << 14, "{what}: {value}");
    let repeat = |counts| Modifier::Repeat {
        counts,
        spacing: [2.5; 3],
        offset: [0.0; 3],
        turn: 0.0,
        mirrored: [false; 3],
        carve_from: [0; 3],
        carve_to: [0; 3],
    };
    // The evaluator visits copies one by one at each point, so their number does not matter.
    let mut scene = Scene::new();
    add(&mut scene, None, ball().modified(repeat([1_000_000; 3])));
    let flat = timed("a million cubed", &scene).expect("within every limit");
    assert_eq!(flat.nodes.len(), 2);
    let mut scene = Scene::new();
    add(&mut scene, None, (0..32).fold(ball(), |node, _| node.modified(repeat([1000, 1, 1]))));
    refused("repeats of repeats", &scene);
}

#[test]
fn flattening_is_canceled() {
    let mut scene = Scene::new();
    add(&mut scene, None, ball().modified(around(512)).modified(around(256)));
    let cancel = Cancel::default();
    let (flat, usage) = flatten_until(&scene, 0.0, &cancel).expect("within every limit").expect("nobody says stop");
    let entries = usage.iter().find(|usage| usage.name == "entries").expect("a limit");
    assert_eq!((entries.used, entries.limit, entries.node), (flat.nodes.len(), MAX_FLAT_NODES, Some(NodeId(1))));
    let may_be_none = ["stack", "bytes of images of textures", "texels of bricks of models"];
    assert!(
        usage.iter().all(|usage| usage.used <= usage.limit && usage.used > 0 || may_be_none.contains(&usage.name)),
        "{usage:?}"
    );
    cancel.cancel();
    assert!(flatten_until(&scene, 0.0, &cancel).expect("within every limit").is_none());
}

#[cfg(target_os = "linux")]
#[test]
fn the_program_refuses_within_a_gibibyte_and_five_seconds() {
    for (name, node) in [
        ("polar2", "n1 #1"),
        ("polar2-cut", "n1 #1"),
        ("polar2-round30", "n1 #1"),
        ("deep", "#"),
        ("apart-nest-20", "#"),
        ("polar-empty", ""),
    ] {
        let started = Instant::now();
        let script = "ulimit -v 1048576; exec \"$0\" check \"$1\" --json";
        let scene = case(&format!("hostile/{name}.json"));
        let mut command = Command::new("sh");
        command.args(["-c", script, env!("CARGO_BIN_EXE_isolith")]).arg(scene);
        let output = command.output().expect("a shell");
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        let code = if node.is_empty() { 0 } else { 3 };
        assert_eq!(output.status.code(), Some(code), "{name}: {text} {}", String::from_utf8_lossy(&output.stderr));
        assert!(text.contains(node), "{name}: {text}");
        assert!(started.elapsed() < LONGEST, "{name} took {:?}", started.elapsed());
    }
}

#[cfg(target_os = "linux")]
#[test]
fn preparing_a_picture_obeys_ctrl_c() {
    let mut scene = Scene::new();
    add(&mut scene, None, ball().modified(around(256)).modified(around(256)));
    let folder = tempfile::tempdir().expect("a folder");
    let (from, to) = (folder.path().join("scene.json"), folder.path().join("picture.png"));
    std::fs::write(&from, file::to_json(&scene).expect("a sound scene")).expect("it can be written");
    let mut command = Command::new(env!("CARGO_BIN_EXE_isolith"));
    // Preparing takes seconds in spite of the small size; the program refuses a large picture of so many components at
    // once.
    command.arg("render").arg(&from).args(["--size", "64x48", "-o"]).arg(&to);
    command.env("XDG_RUNTIME_DIR", folder.path());
    let mut child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("the program starts");
    std::thread::sleep(Duration::from_millis(800));
    let interrupted = Instant::now();
    let kill = Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("a signal");
    assert!(kill.success());
    let status = child.wait().expect("it ends");
    let took = interrupted.elapsed();
    // Before the program installs its own handler, the signal ends it.
    let is_interrupted =
        status.code() == Some(130) || std::os::unix::process::ExitStatusExt::signal(&status) == Some(2);
    assert!(is_interrupted && took < LONGEST, "{status}, {took:?}");
    assert!(!to.exists());
}
