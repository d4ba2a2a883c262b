//! Copies of instancers: fields and rays against the same copies placed one by one.

#![allow(clippy::print_stdout, reason = "the figures are for whoever runs this with `--nocapture`")]

use bytemuck::Zeroable;
use glam::{DQuat, DVec3};

use crate::gpu::shared;
use isolith::field::copies::{
    CopyCone, FlatInstancer, Placement, copies_along, copy_material, copy_of_cell, copy_of_place, nearest_copy,
    world_from_copy,
};
use isolith::field::reference::trace::trace;
use isolith::field::scene_eval::SceneEvaluator;
use isolith::field::{FlatScene, RayLimits, flatten};
use isolith::geometry::Ray;
use isolith::render::copy_probe::{CopyQuery, placed, walked};
use isolith::scene::{
    Attachment, CurvePreset, Dynamic, DynamicKind, Instancer, Lattice, Mask, MaskJoin, MaskKind, MaskSlot, Node,
    NodeId, NodeKind, Object, Points, Scene, Shape, Snap, TextureImage, Variation,
};

/// A scene of one instancer with two types: a box off its origin and a ball.
pub fn scene_of(instancer: Instancer, dynamics: &[DynamicKind]) -> Scene {
    let mut scene = Scene::new();
    let material = scene.materials()[0].id;
    let mut node = Node::new("Copies", NodeKind::Instancer(Box::new(instancer)));
    for kind in dynamics {
        node = node.moving(kind.default_dynamic());
    }
    let top = scene.insert(None, 0, node.at(DVec3::new(0.3, -0.2, 0.1)).rotated(DQuat::from_rotation_y(0.4))).unwrap();
    let shapes = [
        (Shape::Box { size: [0.5, 1.0, 0.4], rounding: 0.05 }, DVec3::Y * 0.5, 2.0),
        (Shape::Sphere { radius: 0.35 }, DVec3::ZERO, 1.0),
    ];
    for (at, (shape, place, weight)) in shapes.into_iter().enumerate() {
        let node = Node::new("Type", NodeKind::Object(Object { shape, material })).at(place).weighted(weight);
        scene.insert(Some(top), at, node).unwrap();
    }
    scene
}

/// The same on a surface.
fn scene_on(instancer: Instancer, ground: Shape) -> Scene {
    let mut scene = scene_of(instancer, &[]);
    let material = scene.materials()[0].id;
    let target = Node::new("Ground", NodeKind::Object(Object { shape: ground, material })).at(DVec3::Y * -0.4);
    let target = scene.insert(None, 0, target).unwrap();
    let top = scene.children(None).find(|node| matches!(node.kind, NodeKind::Instancer(_))).unwrap();
    let mut node = Node::clone(top);
    if let NodeKind::Instancer(instancer) = &mut node.kind {
        instancer.target = Some(target);
    }
    scene.replace(node).unwrap();
    scene
}

/// What varies in all tests.
pub fn varied() -> Variation {
    Variation {
        looseness: 0.8,
        offset_min: [-0.2, 0.0, -0.1],
        offset_max: [0.2, 0.3, 0.1],
        rotation_min: [-20.0, -180.0, -20.0],
        rotation_max: [20.0, 180.0, 20.0],
        scale_min: [0.6; 3],
        scale_max: [1.4; 3],
        uniform: true,
    }
}

/// The same scene without an instancer: every copy is an object with a transform of its own.
fn placed_one_by_one(flat: &FlatScene, source: &Scene) -> Scene {
    let instancer = &flat.instancers[0];
    let mut scene = Scene::new();
    let children: Vec<NodeId> = source.children(Some(instancer.id)).map(|child| child.id).collect();
    let grounds = source.children(None).filter(|node| node.id != instancer.id);
    for node in grounds {
        scene.insert(None, 0, Node { id: NodeId(0), ..Node::clone(node) }).unwrap();
    }
    for copy in all_copies(instancer) {
        let world = world_from_copy(instancer, &copy);
        let (scale, rotation, translation) = world.to_scale_rotation_translation();
        let mut group = Node::new("Copy", NodeKind::Group(isolith::scene::Group::UNION));
        group.transform.translation = translation;
        group.transform.rotation = rotation;
        group.transform.scale = scale;
        let group = scene.insert(None, 0, group).unwrap();
        let child = source.node(children[copy.kind as usize]).unwrap();
        let child = Node { id: NodeId(0), parent: None, ..Node::clone(child) };
        scene.insert(Some(group), 0, child).unwrap();
    }
    scene
}

fn all_copies(instancer: &FlatInstancer) -> Vec<isolith::field::copies::Copy> {
    match &instancer.placement {
        Placement::List(list) => (0..list.places.len()).filter_map(|i| copy_of_place(instancer, i)).collect(),
        Placement::Lattice(lattice) => {
            let cells = |axis: usize| lattice.low[axis]..=lattice.high[axis];
            let all = cells(2).flat_map(|z| cells(1).flat_map(move |y| cells(0).map(move |x| [x, y, z])));
            all.filter_map(|cell| copy_of_cell(instancer, cell)).collect()
        }
    }
}

/// Scenes of limited lattices with everything that varies.
pub fn limited() -> Vec<(&'static str, Scene)> {
    let of = |lattice| Instancer { lattice, variation: varied(), probability: 0.8, seed: 3, ..Instancer::default() };
    let grid = Lattice::Grid { counts: [5; 3], spacing: [1.5, 1.8, 1.4] };
    let hexagonal = Lattice::Hexagonal { counts: [6, 1, 5], spacing: 1.3, height: 1.0 };
    let polar = Lattice::Polar { count: 9, rings: 3, radius: 2.0, spacing: 1.4 };
    let mut masked = of(Lattice::Grid { counts: [9, 1, 9], spacing: [1.0; 3] });
    masked.masks = vec![
        Mask::Noise { size: 3.0, threshold: 0.4, softness: 0.3, seed: 2 }.into(),
        Mask::Radius { inner: 2.0, outer: 5.0 }.into(),
    ];
    let mut all = vec![
        ("grid", scene_of(of(grid), &[])),
        ("hexagonal", scene_of(of(hexagonal), &[])),
        ("polar", scene_of(of(polar), &[])),
        ("masked", scene_of(masked, &[])),
    ];
    let terrain = Shape::Terrain {
        size: [9.0, 1.0, 9.0],
        amplitude: 0.8,
        wavelength: 5.0,
        octaves: 3.0,
        roughness: 0.5,
        seed: 4.0,
    };
    let tube = Shape::Tube {
        points: Points::new(vec![[-4.0, 0.0, 0.0, 0.0], [0.0, 1.0, 2.0, 0.0], [4.0, 0.0, -1.0, 0.0]]),
        radius: 0.1,
        closed: false,
    };
    let fallen =
        Instancer { snap: Snap::Down, align: 0.7, ..of(Lattice::Grid { counts: [6, 1, 6], spacing: [1.2; 3] }) };
    let mut steep = of(Lattice::Grid { counts: [0, 1, 0], spacing: [1.2; 3] });
    (steep.snap, steep.masks) = (Snap::Down, vec![Mask::Slope { from: 5.0, to: 15.0 }.into()]);
    let scattered = Instancer { align: 1.0, ..of(Lattice::Scatter { density: 3.0, minimum_distance: 0.4 }) };
    all.extend([
        ("fallen", scene_on(fallen, terrain.clone())),
        ("steep", scene_on(steep, terrain)),
        ("scattered", scene_on(scattered, Shape::Sphere { radius: 2.5 })),
        ("curve", scene_on(of(Lattice::Curve { spacing: 0.9 }), tube)),
    ]);
    all.extend(DynamicKind::ALL.iter().map(|kind| (kind.label(), scene_of(of(grid), &[*kind]))));
    let joined = Instancer { masks: joined_masks(), ..of(Lattice::Grid { counts: [9, 1, 9], spacing: [1.0; 3] }) };
    all.push(("joined masks", scene_of(joined, &[])));
    all.push(("placed wind", with_placed_wind(scene_of(of(grid), &[]))));
    all
}

/// Masks by images, with curves, joined in every way.
pub fn joined_masks() -> Vec<MaskSlot> {
    let image = Attachment::<TextureImage>::painted("dots.png", [6, 5], |x, y| [(37 * x + 60 * y) as u8; 3]);
    let image = |tiled| Mask::Image { image: image.clone(), width: 5.0, length: 6.0, offset: [0.4, 0.0, -0.7], tiled };
    let noise = Mask::Noise { size: 2.0, threshold: 0.5, softness: 0.6, seed: 7 };
    let slot = |mask, join, curve: CurvePreset| MaskSlot { join, curve: curve.curve(), ..MaskSlot::from(mask) };
    let height = Mask::Height { from: -2.0, to: 8.0, softness: 6.0 };
    vec![
        slot(image(true), MaskJoin::Multiply, CurvePreset::Ease),
        slot(noise, MaskJoin::Add, CurvePreset::Terraces),
        MaskSlot { inverted: true, ..slot(image(false), MaskJoin::Subtract, CurvePreset::Sharp) },
        slot(Mask::Radius { inner: 0.0, outer: 6.0 }, MaskJoin::Maximum, CurvePreset::Peak),
        slot(height, MaskJoin::Minimum, CurvePreset::Linear),
    ]
}

/// The scene with wind from a source that is placed near its copies.
fn with_placed_wind(mut scene: Scene) -> Scene {
    let mut wind = DynamicKind::Wind.default_dynamic();
    if let Dynamic::Wind { radius, source, core, radial, angle, .. } = &mut wind {
        (*radius, *source, *core, *radial, *angle) = (4.0, [1.5, 0.5, -1.0], 0.3, 0.8, 50.0);
    }
    let top = Node::clone(scene.children(None).next().expect("the instancer"));
    scene.replace(top.moving(wind)).expect("a valid node");
    scene
}

/// A sequence of numbers from 0 to 1 that fill their range evenly.
fn spread(i: u32, by: f64) -> f64 {
    (f64::from(i) * by).fract()
}

/// How many points or rays a scene gets: a million over all scenes with `ISOLITH_MEASURE_COPIES=all`, and a few else.
fn samples(usual: u32) -> u32 {
    let is_whole = std::env::var("ISOLITH_MEASURE_COPIES").is_ok_and(|value| value == "all");
    if is_whole { (1_000_000_usize.div_ceil(limited().len())) as u32 } else { usual }
}

#[test]
fn fields_are_those_of_copies_placed_one_by_one() {
    let count = samples(1_500);
    for (name, scene) in limited() {
        let flat = flatten(&scene, 1.7).unwrap();
        assert!(flat.warnings.is_empty(), "{name}: {:?}", flat.warnings);
        let single = flatten(&placed_one_by_one(&flat, &scene), 0.0).unwrap();
        let (mut copies, mut singles) = (SceneEvaluator::new(&flat), SceneEvaluator::new(&single));
        let (mut near, mut most) = (0, 0.0_f64);
        for i in 0..count {
            let p = DVec3::new(spread(i, 0.618_034), spread(i, 0.414_214), spread(i, 0.732_051)) * 10.0 - 5.0;
            let [a, b] = [copies.distance(p, f64::INFINITY).value, singles.distance(p, f64::INFINITY).value];
            // Both are lower bounds of the distance; the sign and small values are exact.
            assert_eq!(a < 0.0, b < 0.0, "{name} at {p}: {a}, {b}");
            if b < 0.2 {
                assert!((a - b).abs() < 2e-5, "{name} at {p}: {a}, {b}");
                most = most.max((a - b).abs());
                near += 1;
            }
        }
        assert!(near > 8, "{name}: only {near} points near a surface");
        println!("{name}: {count} points, {near} near a surface, at most {most:.1e} m off");
    }
}

#[test]
fn rays_hit_what_they_hit_when_copies_are_placed_one_by_one() {
    let count = samples(400);
    for (name, scene) in limited() {
        let flat = flatten(&scene, 1.7).unwrap();
        let single = flatten(&placed_one_by_one(&flat, &scene), 0.0).unwrap();
        let mut evaluator = SceneEvaluator::new(&single);
        let (mut hits, mut wrong, mut overstepped) = (0, 0, 0);
        for i in 0..count {
            let [a, b, c] = [0.618_034, 0.414_214, 0.732_051].map(|by| spread(i, by) - 0.5);
            let origin = DVec3::new(12.0 * a, 8.0 * b + 1.0, 9.0);
            let ray = Ray { origin, direction: DVec3::new(0.4 * b, 0.3 * c, -1.0).normalize() };
            let [x, y] = [&flat, &single].map(|flat| trace(flat, &ray, 0.01, 100.0).unwrap().map(|hit| hit.t));
            hits += usize::from(y.is_some());
            // A ray that goes on although it is inside of a copy by more than the rounding of the arrays.
            let end = x.map_or(100.0, |x| x - 1e-3);
            let stretch = y.filter(|y| *y + 1e-3 < end).map(|y| [y, end.min(y + 0.5)]);
            let inside = |[from, to]: [f64; 2]| {
                let mut at = (0..=50).map(|k| from + (to - from) * f64::from(k) / 50.0);
                at.any(|t| evaluator.distance(ray.at(t), f64::INFINITY).value < -1e-4)
            };
            overstepped += usize::from(stretch.is_some_and(inside));
            wrong += usize::from(match (x, y) {
                (Some(x), Some(y)) => (x - y).abs() > 1e-4,
                (None, None) => false,
                _ => true,
            });
        }
        assert!(hits > 20, "{name}: {hits} hits");
        // Rays that graze: arrays are rounded to f32 in other spaces.
        assert!(wrong as f64 <= 1.0 + 1e-4 * f64::from(count), "{name}: {wrong} of {hits}");
        assert_eq!(overstepped, 0, "{name}: rays pass through copies");
        println!("{name}: {count} rays, {hits} hits, {wrong} grazing rays differ, {overstepped} overstepped");
    }
}

/// The paper's scheme: only the copy of the point's own cell counts. It has holes and jumps where copies cross cells.
#[test]
fn the_own_cell_alone_is_wrong() {
    let (_, scene) = limited().swap_remove(0);
    let flat = flatten(&scene, 1.7).unwrap();
    let instancer = &flat.instancers[0];
    let Placement::Lattice(lattice) = &instancer.placement else { panic!("a grid") };
    let from_world = instancer.world_from_local.inverse();
    let mut wrong = 0;
    for i in 0..4_000 {
        let p = DVec3::new(spread(i, 0.618_034), spread(i, 0.414_214), spread(i, 0.732_051)) * 6.0 - 3.0;
        let nearest =
            flat.components.iter().map(|c| nearest_copy(&flat, c, p)).min_by(|a, b| a.value.total_cmp(&b.value));
        let Some(nearest) = nearest.filter(|nearest| nearest.value < 0.0) else { continue };
        let own = copy_of_cell(instancer, lattice.nearest(from_world.transform_point3(p)));
        wrong += usize::from(own != nearest.copy);
    }
    assert!(wrong > 20, "{wrong} points inside copies of other cells");
}

/// Limited scenes, and lattices without end that are seen from far away.
fn probed() -> Vec<(String, Scene, DVec3)> {
    let near = DVec3::new(2.0, 3.0, 9.0);
    let mut all: Vec<_> = limited().into_iter().map(|(name, scene)| (name.to_owned(), scene, near)).collect();
    for far in [1e3, 1e6] {
        let lattice = Lattice::Hexagonal { counts: [0, 1, 0], spacing: 1.5, height: 1.0 };
        let masks = vec![Mask::Noise { size: 9.0, threshold: 0.5, softness: 0.3, seed: 2 }.into()];
        let endless = Instancer { lattice, masks, variation: varied(), seed: 4, ..Instancer::default() };
        let dynamics = [DynamicKind::Wind, DynamicKind::CurlNoise, DynamicKind::Bob];
        let eye = DVec3::new(far, 3.0, -far);
        all.push((format!("endless at {far}"), scene_of(endless.clone(), &dynamics), eye));
        // Without the height and the radius, which leave nothing so far away.
        let masks = joined_masks().into_iter().take(2).collect();
        all.push((format!("joined at {far}"), scene_of(Instancer { masks, ..endless }, &[]), eye));
    }
    all
}

#[test]
fn the_gpu_places_copies_where_the_cpu_does() {
    for (name, scene, eye) in probed() {
        let flat = flatten(&scene, 4_321.7).unwrap();
        let instancer = &flat.instancers[0];
        let (anchor, place) = match &instancer.placement {
            Placement::List(_) => ([0; 3], DVec3::ZERO),
            Placement::Lattice(lattice) => {
                let anchor = lattice.nearest(instancer.world_from_local.inverse().transform_point3(eye));
                (anchor, lattice.place(anchor))
            }
        };
        let of = |i: i32| match &instancer.placement {
            Placement::List(list) => [i % list.places.len() as i32, 0, 0],
            Placement::Lattice(lattice) => {
                let relative = [i % 61 - 30, if lattice.is_long(1) { i % 5 - 2 } else { 0 }, i / 61 % 61 - 30];
                [0, 1, 2].map(|axis| {
                    let cell = i64::from(relative[axis]) + i64::from(anchor[axis]);
                    let cell = cell.clamp(lattice.low[axis].into(), lattice.high[axis].into());
                    (cell - i64::from(anchor[axis])) as i32
                })
            }
        };
        let queries: Vec<CopyQuery> =
            (0..4_000).map(|i| CopyQuery { cell: of(i), kind: i as u32 % 2, ..Zeroable::zeroed() }).collect();
        let answers = placed(&shared().gpu, instancer, eye, &queries).unwrap();
        let mut found = 0;
        for (query, answer) in queries.iter().zip(&answers) {
            let copy = match &instancer.placement {
                Placement::List(_) => copy_of_place(instancer, query.cell[0] as usize),
                Placement::Lattice(_) => copy_of_cell(instancer, [0, 1, 2].map(|i| query.cell[i] + anchor[i])),
            };
            let copy = copy.filter(|copy| copy.kind == query.kind);
            assert_eq!(copy.is_some(), answer.kind != u32::MAX, "{name}: {query:?}");
            let Some(copy) = copy else { continue };
            found += 1;
            let off = DVec3::from(answer.position.map(f64::from)) - (copy.position - place);
            assert!(off.length() < 2e-5, "{name}: {off} for {query:?}");
            let turned =
                copy.rotation.to_array().iter().zip(answer.rotation).map(|(a, b)| a * f64::from(b)).sum::<f64>();
            assert!(turned.abs() > 1.0 - 1e-6, "{name}: {turned} for {query:?}");
            let scaled = DVec3::from(answer.scale.map(f64::from)) - copy.scale;
            assert!(scaled.length() < 1e-5, "{name}: {scaled}");
            let look = copy_material(instancer, &copy);
            let mine = [look.hue, look.saturation, look.value, look.roughness, look.emission];
            let [a, b, c, d] = answer.color;
            for (mine, theirs) in mine.iter().zip([a, b, c, d, answer.glow]) {
                assert!((mine - f64::from(theirs)).abs() < 1e-5, "{name}: {mine}, {theirs}");
            }
        }
        assert!(found > 30, "{name}: {found} copies");
    }
}

#[test]
fn the_gpu_walks_past_the_copies_that_the_cpu_walks_past() {
    for (name, scene, eye) in probed() {
        let flat = flatten(&scene, 1.7).unwrap();
        let instancer = &flat.instancers[0];
        let from_world = instancer.world_from_local.inverse();
        let mut queries = Vec::new();
        for i in 0..600 {
            let [a, b, c] = [0.618_034, 0.414_214, 0.732_051].map(|by| (spread(i, by) - 0.5) as f32);
            let direction = DVec3::new(2.0 * f64::from(a), f64::from(b) - 0.2, -1.0 + f64::from(c)).normalize();
            let wide = if i % 3 == 0 { 0.05 } else { 0.0 };
            queries.push(CopyQuery {
                origin: [3.0 * c, a, b],
                direction: direction.to_array().map(|v| v as f32),
                kind: i % 2,
                far: 25.0,
                spread: wide,
                ..Zeroable::zeroed()
            });
        }
        let answers = walked(&shared().gpu, instancer, eye, &queries).unwrap();
        let (mut visits, mut off) = (0, 0);
        for (query, answer) in queries.iter().zip(&answers) {
            let [origin, direction] = [query.origin, query.direction].map(|v| DVec3::from(v.map(f64::from)));
            let axis = Ray {
                origin: from_world.transform_point3(eye + origin),
                direction: from_world.transform_vector3(direction),
            };
            let limits = RayLimits { near: 0.0, far: query.far.into() };
            let (mut count, mut entries) = (0, 0.0);
            let cone = CopyCone { axis, limits, spread: query.spread.into() };
            copies_along(instancer, cone, &mut |visit, _| {
                if visit.copy.kind == query.kind {
                    (count, entries) = (count + 1, entries + visit.entry);
                }
                std::ops::ControlFlow::Continue(())
            });
            assert_ne!(answer.visits, u32::MAX, "{name}: a walk was not at its end");
            visits += count;
            let is_same =
                count == answer.visits && (entries - f64::from(answer.entries)).abs() < 2e-3 * f64::from(count);
            off += u32::from(!is_same && count > 0 || count == 0 && answer.visits > 0);
        }
        // Rays that only touch a sphere.
        assert!(visits > 60 && off <= 6, "{name}: {off} of 600 differ; {visits} visits");
    }
}

/// Each stands where it should: on the surface, with the angle that `align` asks for, and no nearer than allowed.
#[test]
fn copies_stand_on_the_surface() {
    let scenes = limited();
    let scene = |name: &str| &scenes.iter().find(|(other, _)| *other == name).unwrap().1;
    for name in ["fallen", "steep", "scattered"] {
        let flat = flatten(scene(name), 0.0).unwrap();
        let instancer = &flat.instancers[0];
        let Placement::List(list) = &instancer.placement else { panic!("{name} is a list") };
        let ground = flat.components.iter().find(|component| component.instanced.is_none()).unwrap();
        for place in &list.places {
            let world = instancer.world_from_local.transform_point3(place.position);
            let (value, gradient) = isolith::field::eval::gradient(&flat, ground, world - ground.origin);
            assert!(value.abs() < 1e-5, "{name}: {value} off the ground");
            let up = instancer.world_from_local.transform_vector3(place.rotation * DVec3::Y);
            let angle = |v: DVec3| v.angle_between(gradient).to_degrees();
            match name {
                "scattered" => assert!(angle(up) < 0.1, "{name}: {} degrees off", angle(up)),
                "steep" => assert!(angle(DVec3::Y) < 15.0, "{name}: on a slope of {} degrees", angle(DVec3::Y)),
                _ => assert!((angle(up) - 0.3 * angle(DVec3::Y)).abs() < 0.5, "{name}: {} degrees off", angle(up)),
            }
        }
    }
    let flat = flatten(scene("scattered"), 0.0).unwrap();
    let Placement::List(list) = &flat.instancers[0].placement else { panic!("a list") };
    // Of 78.5 m² with 3 copies each, those that no nearer one prunes; a fifth does not exist.
    assert!((70..200).contains(&list.places.len()), "{} copies", list.places.len());
    for (i, a) in list.places.iter().enumerate() {
        for b in &list.places[i + 1..] {
            assert!(a.position.distance(b.position) >= 0.4);
        }
    }
}

#[test]
fn bad_input_is_told_with_the_node() {
    let told = |scene: &Scene, says: &str| {
        let flat = flatten(scene, 0.0).unwrap();
        let found = flat.warnings.iter().any(|warning| warning.reason.contains(says));
        assert!(found, "{says:?} is not in {:?}", flat.warnings);
    };
    let change = |scene: &mut Scene, change: &dyn Fn(&mut Instancer, &mut Vec<NodeId>)| {
        let top = scene.children(None).find(|node| matches!(node.kind, NodeKind::Instancer(_))).unwrap();
        let mut children = scene.children(Some(top.id)).map(|child| child.id).collect();
        let mut node = Node::clone(top);
        if let NodeKind::Instancer(instancer) = &mut node.kind {
            change(instancer, &mut children);
        }
        scene.replace(node).unwrap();
    };
    let scatter =
        Instancer { lattice: Lattice::Scatter { density: 1.0, minimum_distance: 0.0 }, ..Instancer::default() };
    told(&scene_of(scatter.clone(), &[]), "stands on no surface");
    let mut itself = scene_of(scatter.clone(), &[]);
    change(&mut itself, &|instancer, children| instancer.target = Some(children[0]));
    told(&itself, "cannot stand on itself");
    let mut gone = scene_of(scatter, &[]);
    change(&mut gone, &|instancer, _| instancer.target = Some(NodeId(999)));
    told(&gone, "does not exist any more");
    let plain = Instancer::grid([2; 3], [2.0; 3]);
    let mut empty = Scene::new();
    empty.insert(None, 0, Node::new("Copies", NodeKind::Instancer(Box::new(plain.clone())))).unwrap();
    told(&empty, "has no children");
    let mut weightless = scene_of(plain.clone(), &[]);
    let ids: Vec<NodeId> = weightless.nodes().iter().filter(|node| node.has_field()).map(|node| node.id).collect();
    for id in ids {
        let node = Node::clone(weightless.node(id).unwrap()).weighted(0.0);
        weightless.replace(node).unwrap();
    }
    told(&weightless, "weight 0");
    let mut endless = scene_of(plain, &[]);
    let top = endless.nodes()[0].id;
    let material = endless.materials()[0].id;
    let plane = Node::new("Plane", NodeKind::Object(Object { shape: Shape::Plane {}, material }));
    endless.insert(Some(top), 0, plane).unwrap();
    told(&endless, "has no end");
    let mut missing = Instancer::grid([2; 3], [2.0; 3]);
    missing.masks = vec![MaskKind::Noise.default_mask().into(), MaskKind::Image.default_mask().into()];
    let missing = scene_of(missing, &[]);
    told(&missing, "has no image for its mask 2");
    let flat = flatten(&missing, 0.0).unwrap();
    assert_eq!(flat.warnings[0].node, flat.instancers[0].id);
    assert!(!flat.components.is_empty(), "the rest is drawn");
}
