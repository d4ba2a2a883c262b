//! The contract of every modifier, over asymmetric content.

use glam::{DQuat, DVec3};
use isolith::field::eval::{field, gradient};
use isolith::field::unflattened::SceneField;
use isolith::field::{Component, FlatScene, flatten};
use isolith::gallery;
use isolith::scene::{
    Attachment, Axis, Blend, BlendKernel, Group, MaterialId, Modifier, ModifierKind, Node, NodeId, NodeKind, Object,
    Operator, ParamValue, Scene, Shape,
};

use super::rules::{gradient_is_right, steps_are_safe};
use super::samples::{Random, image, many};

/// Asymmetric content: an L of two boxes, and a ball blended with it.
fn content(scene: &mut Scene, group: Node) -> NodeId {
    let parent = scene.insert(None, usize::MAX, group).unwrap();
    let boxed = |size: [f64; 3]| Shape::Box { size, rounding: 0.05 };
    let parts = [
        (boxed([0.9, 0.3, 0.2]), DVec3::new(0.1, -0.2, 0.0)),
        (boxed([0.2, 0.8, 0.3]), DVec3::new(-0.3, 0.15, 0.05)),
        (Shape::Sphere { radius: 0.2 }, DVec3::new(0.4, 0.1, 0.1)),
    ];
    for (shape, at) in parts {
        let object = Object { shape, material: MaterialId(1) };
        scene.insert(Some(parent), usize::MAX, Node::new("Part", NodeKind::Object(object)).at(at)).unwrap();
    }
    parent
}

fn blended() -> Node {
    let blend = Blend::new(BlendKernel::Circular, 0.1);
    Node::new("Content", NodeKind::Group(Group::new(Operator::Union, blend)))
}

/// A scene of the asymmetric content with these modifiers.
pub fn modified(modifiers: &[Modifier]) -> Scene {
    let mut scene = Scene::new();
    let node = modifiers.iter().fold(blended(), |node, modifier| node.modified(modifier.clone()));
    let turn = DQuat::from_axis_angle(DVec3::new(1.0, 2.0, 0.5).normalize(), 0.7);
    content(&mut scene, node.at(DVec3::new(0.3, -0.2, 0.1)).rotated(turn).scaled(DVec3::splat(1.2)));
    scene
}

/// The default modifier; with an image if it has no effect without one.
pub fn usual(kind: ModifierKind) -> Modifier {
    let (mut modifier, mut random) = (kind.default_modifier(), Random::new(kind as u64));
    for (index, value) in modifier.values().into_iter().enumerate() {
        if let ParamValue::File(file) = value {
            assert!(modifier.set_value(index, ParamValue::File(image(&file, &mut || random.bits() as u16))));
        }
    }
    modifier
}

/// The default, one with random values in the soft range, others at the limits of that range.
pub fn samples(kind: ModifierKind, count: usize) -> Vec<Modifier> {
    let mut random = Random::new(50 + kind as u64);
    let mut all = vec![usual(kind)];
    for i in 0..count {
        let mut modifier = kind.default_modifier();
        for (index, (param, value)) in kind.params().iter().zip(modifier.values()).enumerate() {
            if param.name.starts_with("carve") {
                continue;
            }
            let [low, high] = param.limits.soft;
            let mut number = || if i % 3 == 2 { random.pick(&[low, high]) } else { random.range(low, high) };
            let value = match value {
                ParamValue::Scalar(_) => ParamValue::Scalar(number()),
                ParamValue::Vector(_) => ParamValue::Vector(DVec3::new(number(), number(), number())),
                ParamValue::Count(_) => ParamValue::Count(number().round() as u32),
                ParamValue::Counts(_) => ParamValue::Counts([0, 1, 2].map(|_| random.index(4) as u32)),
                ParamValue::Flag(_) => ParamValue::Flag(random.chance(0.5)),
                ParamValue::Flags(_) => ParamValue::Flags([0, 1, 2].map(|_| random.chance(0.5))),
                ParamValue::Choice(_) => {
                    ParamValue::Choice(&random.pick(&param.choices.iter().collect::<Vec<_>>()).key)
                }
                ParamValue::File(file) => ParamValue::File(image(&file, &mut || random.bits() as u16)),
                other => unreachable!("no modifier has {other:?}"),
            };
            assert!(modifier.set_value(index, value), "{kind:?}.{}", param.name);
        }
        if let Modifier::Repeat { spacing, .. } = &mut modifier {
            *spacing = spacing.map(|s| s.max(0.6));
        }
        all.push(modifier);
    }
    all
}

/// Large blends below modifiers: one of each kind, the later ones on top of a twist.
pub fn modified_crowds() -> Vec<Scene> {
    let of_kind = |(i, &kind): (usize, &ModifierKind)| {
        let mut scene = gallery::crowd(40, true, i as u64);
        let mut node = Node::clone(&scene.nodes()[0]);
        node = node.modified(usual(kind));
        if i % 2 == 1 {
            node = node.modified(Modifier::Twist { angle: 20.0 });
        }
        scene.replace(node).unwrap();
        scene
    };
    let single = |scene: &Scene| flatten(scene, 0.0).is_ok_and(|flat| flat.components.len() == 1);
    ModifierKind::ALL.iter().enumerate().map(of_kind).filter(single).collect()
}

/// Visits every component of every modifier's samples: all samples alone, two of them also on top of a twist.
fn for_each(count: usize, mut visit: impl FnMut(&str, ModifierKind, &FlatScene, &Component)) {
    for &kind in ModifierKind::ALL {
        for (i, modifier) in samples(kind, count).into_iter().enumerate() {
            let lists = [vec![modifier.clone()], vec![Modifier::Twist { angle: 40.0 }, modifier.clone()]];
            for (list, modifiers) in lists.iter().enumerate().take(if i < 2 { 2 } else { 1 }) {
                let flat = match flatten(&modified(modifiers), 0.0) {
                    Ok(flat) => flat,
                    // Flattening refuses copies that reach too far into each other, and names them.
                    Err(error) => {
                        assert!(kind == ModifierKind::Repeat && error.what.contains("copies"), "{modifier:?}: {error}");
                        continue;
                    }
                };
                for component in &flat.components {
                    visit(&format!("{modifier:?}, list {list}"), kind, &flat, component);
                }
            }
        }
    }
}

/// A sphere around the interesting region.
fn surroundings(component: &Component) -> (DVec3, f64) {
    let bounds = component.bounds;
    if bounds.is_finite() && bounds.half().length() < 20.0 {
        (bounds.center(), 0.3 + bounds.half().length())
    } else {
        (DVec3::ZERO, 4.0)
    }
}

#[test]
fn steps_through_modifiers_are_safe() {
    for_each(8, |what, kind, flat, component| {
        if kind == ModifierKind::Repeat {
            // The evaluator selects neighbors by position, so the field may jump far from the surface. The comparison
            // with explicit copies tests that it never exceeds the distance.
            return;
        }
        let (center, reach) = surroundings(component);
        let safe = steps_are_safe(&|p| field(flat, component, p), center, reach, 1_500, 4e-6 * reach);
        safe.unwrap_or_else(|e| panic!("{what}: {e}"));
    });
}

#[test]
fn bounds_enclose_what_is_modified() {
    for_each(8, |what, _, flat, component| {
        let (center, reach) = surroundings(component);
        let mut random = Random::new(9);
        for _ in 0..many(1_500) {
            let p = center + random.point(1.3 * reach);
            let f = field(flat, component, p);
            assert!(f.is_finite(), "{what}: {f} at {p}");
            assert!(component.bounds.contains(p) || f > -1e-5, "{what}: {f} at {p} outside {:?}", component.bounds);
        }
    });
}

#[test]
fn gradients_through_modifiers_are_those_of_central_differences() {
    for_each(3, |what, kind, flat, component| {
        // Layers of noise curve too quickly for differences, and walls fold the field.
        if matches!(kind, ModifierKind::Noise | ModifierKind::Onion | ModifierKind::Recursion | ModifierKind::Waves) {
            return;
        }
        let (center, reach) = surroundings(component);
        let mut random = Random::new(11);
        let points: Vec<DVec3> = (0..60).map(|_| center + random.point(reach)).collect();
        let right = gradient_is_right(&|p| gradient(flat, component, p), points.into_iter(), 1e-5);
        right.unwrap_or_else(|e| panic!("{what}: {e}"));
    });
}

#[test]
fn a_modifier_rises_with_the_distance_from_its_bounds() {
    let mut count = 0;
    for_each(6, |what, _, flat, component| {
        let (center, reach) = surroundings(component);
        let mut random = Random::new(13);
        let first = &flat.nodes[component.first as usize];
        let [blend_params, middle, half] = [0, 1, 2].map(|row| flat.params[first.params as usize + row].map(f64::from));
        if first.modifier().is_none() || first.extent != component.count || blend_params[1] == 0.0 {
            return;
        }
        count += 1;
        let [middle, half] = [middle, half].map(|[x, y, z, _]| DVec3::new(x, y, z));
        for _ in 0..many(400) {
            let p = center + random.point(2.5 * reach);
            let least = blend_params[1] * ((p - middle).abs() - half).max(DVec3::ZERO).length();
            let f = field(flat, component, p);
            assert!(least == 0.0 || f >= least - 2e-6 * reach, "{what}: {f} at {p}, said to be at least {least}");
        }
    });
    assert!(count > 20, "{count}");
}

/// The copies of a repetition as separate nodes.
fn explicit(modifier: &Modifier) -> Scene {
    let Modifier::Repeat { counts, spacing, offset, turn, mirrored, carve_from, carve_to } = *modifier else {
        panic!("a repetition")
    };
    let mut scene = Scene::new();
    for x in 0..counts[0] {
        for y in 0..counts[1] {
            for z in 0..counts[2] {
                let cell = [x, y, z];
                if (0..3).all(|i| cell[i] >= carve_from[i] && cell[i] < carve_to[i]) {
                    continue;
                }
                let [fx, fy, fz] = cell.map(f64::from);
                let mut at = DVec3::new(fx, fy, fz) * DVec3::from(spacing);
                at.y += if counts[1] == 1 { offset[1] * fx } else { 0.0 };
                at.z += if counts[2] == 1 { offset[2] * fx } else { 0.0 };
                at.x += if counts[0] != 1 && counts[1] != 1 { offset[0] * fy } else { 0.0 };
                let flip = |i: usize| if mirrored[i] && cell[i] % 2 == 1 { -1.0 } else { 1.0 };
                let turn = DQuat::from_rotation_y((turn * (fx + fy + fz)).to_radians());
                let node = blended().at(at).rotated(turn).scaled(DVec3::new(flip(0), flip(1), flip(2)));
                content(&mut scene, node);
            }
        }
    }
    scene
}

fn repetitions() -> Vec<Modifier> {
    let repeat = |counts, spacing, offset, turn, mirrored, carve: [[u32; 3]; 2]| Modifier::Repeat {
        counts,
        spacing,
        offset,
        turn,
        mirrored,
        carve_from: carve[0],
        carve_to: carve[1],
    };
    let (none, off, zero) = ([[0; 3]; 2], [false; 3], [0.0; 3]);
    vec![
        // Clear of the walls, touching them, across several cells.
        repeat([4, 1, 1], [2.0; 3], zero, 0.0, off, none),
        repeat([3, 2, 3], [0.9, 1.1, 0.5], zero, 0.0, off, none),
        repeat([9, 1, 1], [0.25, 1.0, 1.0], zero, 0.0, off, none),
        repeat([4, 3, 1], [0.7, 0.6, 1.0], zero, 0.0, [true, true, false], none),
        repeat([5, 1, 1], [0.8, 1.0, 1.0], [0.0, 0.3, -0.2], 25.0, off, none),
        repeat([4, 4, 1], [1.0, 0.7, 1.0], [0.5, 0.0, 0.0], 0.0, off, none),
        repeat([4, 1, 4], [1.1, 1.0, 1.1], zero, 0.0, off, [[1, 0, 1], [3, 1, 3]]),
        repeat([3, 3, 3], [1.3; 3], zero, 90.0, [false, false, true], none),
    ]
}

#[test]
fn a_repetition_is_the_union_of_its_copies() {
    for modifier in repetitions() {
        let mut scene = Scene::new();
        content(&mut scene, blended().modified(modifier.clone()));
        let (one, copies) = (flatten(&scene, 0.0).unwrap(), flatten(&explicit(&modifier), 0.0).unwrap());
        assert!(one.components.len() == 1 && copies.components.len() > 1);
        let bounds = one.components[0].bounds.translated(one.components[0].origin);
        let mut random = Random::new(17);
        let (mut inside, mut short) = (0, 0);
        for _ in 0..many(6_000) {
            let p = bounds.center() + random.point(0.6) * (2.0 * bounds.half() + 0.6);
            let f = field(&one, &one.components[0], p - one.components[0].origin);
            let union = copies.components.iter().map(|c| field(&copies, c, p - c.origin)).fold(f64::INFINITY, f64::min);
            // Outside, never more than the true field; everywhere the same sign.
            assert!(f <= union.max(0.0) + 1e-5, "{modifier:?} at {p}: {f}, the copies say {union}");
            assert!(union.abs() < 1e-5 || (f < 0.0) == (union < 0.0), "{modifier:?} at {p}: {f} {union}");
            inside += usize::from(union < 0.0);
            short += usize::from((f - union).abs() > 1e-5);
        }
        assert!(inside > 20, "{modifier:?}: {inside} points inside");
        // Near the surface it is exact to the last bits, and away from it mostly.
        assert!(4 * short < 3 * many(6_000), "{modifier:?}: {short} points are only a bound");
    }
}

#[test]
fn a_mirror_and_a_ring_are_the_copies_they_stand_for() {
    let mirror = Modifier::Mirror { axes: [true, false, true], blend: 0.0 };
    let ring = Modifier::Polar { count: 5, radius: 1.5, mirrored: false };
    for (modifier, count) in [(mirror, 4), (ring, 5)] {
        let flat = flatten(&modified(std::slice::from_ref(&modifier)), 0.0).unwrap();
        assert_eq!(flat.components.len(), count, "{modifier:?}");
    }
    let seam = Modifier::Mirror { axes: [true, false, false], blend: 0.2 };
    assert_eq!(flatten(&modified(&[seam]), 0.0).unwrap().components.len(), 1);
}

/// A plate with a displaced top: its heights match the image, repeated in mirrored tiles without a jump.
#[test]
fn a_displacement_repeats_its_image_mirrored() {
    const TILE: f64 = 0.5;
    let image = Attachment::drawn("steps.png", [4, 2], |x, y| (10 + 60 * x + 20 * y) as u8);
    let heights = image.content().unwrap().clone();
    for (axis, height) in Axis::ALL.into_iter().flat_map(|axis| [(axis, 0.2), (axis, -0.2)]) {
        let displaced = Modifier::Displacement { image: image.clone(), height, tile: TILE, axis };
        let mut scene = Scene::new();
        let object = Object { shape: Shape::Box { size: [6.0; 3], rounding: 0.0 }, material: MaterialId(1) };
        let node = Node::new("Plate", NodeKind::Object(object)).modified(displaced);
        scene.insert(None, 0, node).unwrap();
        let flat = flatten(&scene, 0.0).unwrap();
        // A point above the face, at these distances right and down in the orientation of the image.
        let at = |right: f64, down: f64, up: f64| match axis {
            Axis::X => DVec3::new(up, -down, -right),
            Axis::Y => DVec3::new(right, up, down),
            Axis::Z => DVec3::new(right, -down, up),
        };
        let inside = |p: DVec3| field(&flat, &flat.components[0], p - flat.components[0].origin) < 0.0;
        let surface = |right: f64, down: f64| {
            let (mut low, mut high) = (2.5, 3.5);
            for _ in 0..50 {
                let middle = 0.5 * (low + high);
                if inside(at(right, down, middle)) { low = middle } else { high = middle }
            }
            low - 3.0
        };
        let side = TILE / 4.0;
        let mut random = Random::new(3);
        for _ in 0..200 {
            // In pixels from the image's upper left corner, mirrored at each border.
            let [x, y] = [random.range(-20.0, 20.0), random.range(-20.0, 20.0)].map(f64::floor);
            let folded = |v: f64, n: f64| {
                let v = v.rem_euclid(2.0 * n);
                (if v < n { v } else { 2.0 * n - 1.0 - v }) as isize
            };
            let place = |x: f64, y: f64| ((x + 0.5) * side - 0.5 * TILE, (y + 0.5) * side - 0.25 * TILE);
            let pixel = |x: f64, y: f64| heights.at(folded(x, 4.0), folded(y, 2.0));
            // The spline at the center of a pixel.
            let weights = [(-1.0, 0.125), (0.0, 0.75), (1.0, 0.125)];
            let mean: f64 = weights.iter().flat_map(|(i, a)| weights.map(|(j, b)| a * b * pixel(x + i, y + j))).sum();
            let (right, down) = place(x, y);
            let found = surface(right, down);
            assert!((found - height * mean).abs() < 1e-6, "{axis:?} at {x} {y}: {found}, not {}", height * mean);
            // No jump at any pixel border.
            let border = right + 0.5 * side;
            let step = surface(border + 1e-7, down) - surface(border - 1e-7, down);
            assert!(step.abs() < 1e-6, "{axis:?} at {x} {y}: {step}");
        }
    }
}

#[test]
fn without_an_image_a_displacement_is_nothing() {
    let none = modified(&[ModifierKind::Displacement.default_modifier()]);
    assert_eq!(flatten(&none, 0.0), flatten(&modified(&[]), 0.0));
    let Modifier::Displacement { image, tile, axis, .. } = usual(ModifierKind::Displacement) else { panic!() };
    let flat = modified(&[Modifier::Displacement { image, height: 0.0, tile, axis }]);
    assert_eq!(flatten(&flat, 0.0), flatten(&none, 0.0));
}

/// Noise counts its cells with 32-bit integers, which can overflow.
#[test]
fn noise_has_a_field_however_far_away() {
    let noise = Modifier::Noise { amplitude: 0.1, size: 1e-3, octaves: 3, seed: 4 };
    let flat = flatten(&modified(&[noise]), 0.0).unwrap();
    for far in [1e6, 1e9, 1e15] {
        for direction in [DVec3::ONE, DVec3::NEG_ONE, DVec3::X] {
            assert!(field(&flat, &flat.components[0], direction * far) > 0.0, "{far}");
        }
    }
}

/// So many cells overlap that even counting them along three axes overflows.
#[test]
fn large_content_in_tiny_cells_is_refused_by_its_node() {
    let mut scene = Scene::new();
    let repeat = Modifier::Repeat {
        counts: [0; 3],
        spacing: [1e-6; 3],
        offset: [0.0; 3],
        turn: 0.0,
        mirrored: [false; 3],
        carve_from: [0; 3],
        carve_to: [0; 3],
    };
    let ball = Object { shape: Shape::Sphere { radius: 1e6 }, material: MaterialId(1) };
    let node = Node::new("Ball", NodeKind::Object(ball)).modified(repeat);
    let id = scene.insert(None, 0, node).unwrap();
    let error = flatten(&scene, 0.0).unwrap_err();
    assert_eq!(error.node, id);
}

/// Modifiers that move a surface outward, each by this much at most.
const OUTWARD: f64 = 0.2;

fn outward() -> [Modifier; 5] {
    let mut displacement = usual(ModifierKind::Displacement);
    if let Modifier::Displacement { height, .. } = &mut displacement {
        *height = OUTWARD;
    }
    [
        Modifier::Round { radius: OUTWARD },
        Modifier::Onion { thickness: 2.0 * OUTWARD, walls: 1, spacing: 1.0 },
        Modifier::Waves { amplitude: OUTWARD, length: 0.5, phase: 0.0 },
        Modifier::Noise { amplitude: OUTWARD, size: 0.3, octaves: 2, seed: 1 },
        displacement,
    ]
}

/// Nothing appears between what is deformed or repeated and its bounds when its surface is moved. A deformation
/// stretches or compresses by no more than the factor given here, so its surface may be moved by as many times as much.
#[test]
fn a_surface_that_is_moved_keeps_its_shape() {
    let repeat = Modifier::Repeat {
        counts: [2, 2, 2],
        spacing: [1.5, 1.4, 1.0],
        offset: [0.0; 3],
        turn: 0.0,
        mirrored: [false; 3],
        carve_from: [0; 3],
        carve_to: [0; 3],
    };
    let inner = [
        (Modifier::Twist { angle: 60.0 }, 2.5),
        (Modifier::Bend { angle: 45.0 }, 3.0),
        (Modifier::Taper { change: -0.4 }, 2.5),
        (repeat, 1.0),
    ];
    let (mut faults, mut told) = (Vec::new(), [0; 2]);
    for (deformed, stretch) in inner {
        let tree = SceneField::new(&modified(std::slice::from_ref(&deformed))).unwrap();
        for moved in outward() {
            let scene = modified(&[deformed.clone(), moved.clone()]);
            let flat = flatten(&scene, 0.0).unwrap();
            let component = &flat.components[0];
            let (center, reach) = surroundings(component);
            // The content is 1.2 times as large as its node.
            let by = 1.2 * OUTWARD;
            let mut random = Random::new(3);
            let wrong = (0..many(20_000)).filter(|_| {
                let p = center + random.point(reach);
                let (value, is_inside) = (tree.value(p + component.origin), field(&flat, component, p) < 0.0);
                let is_far = value > 1.001 * stretch * by;
                let is_near = matches!(moved, Modifier::Round { .. }) && value < 0.999 * by / stretch;
                told[0] += usize::from(is_far);
                told[1] += usize::from(is_near);
                (is_far && is_inside) || (is_near && !is_inside)
            });
            let wrong = wrong.count();
            if wrong > 0 {
                faults.push(format!("{deformed:?}, {moved:?}: {wrong} points"));
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    assert!(told[0] > 50_000 && told[1] > 300, "{told:?}");
}
