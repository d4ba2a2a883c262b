//! All methods draw the same picture: equal in hit or miss pixel for pixel, depths within what refinement leaves.

use isolith::flat::{Buffers, flatten};
use isolith::gallery;
use isolith::render::Method;
use isolith::scene::ModifierKind;

use crate::contract::modifiers::{modified, samples};
use crate::contract::trees::{Recipe, tree};
use crate::gpu::{Subject, scenes};

/// Width and height of the pictures, in pixels.
const SIDE: u32 = 48;
/// Largest difference of two depths, in pixel footprints, of all but the most extreme pixels: refinement stops at a
/// thousandth, at grazing angles at three hundredths of a step.
const MAX_DEPTH: f64 = 0.05;
/// Share of the pixels that may differ by more: where a ray meets two surfaces within a footprint of one another,
/// methods may find either.
const MAX_SHARE: f64 = 2e-3;
/// Random trees that are drawn.
const TREES: u64 = 200;

/// What differs between two pictures; nothing where they are equal.
fn difference(a: &Buffers, b: &Buffers, footprint: f64) -> Option<String> {
    let pairs = || a.depth.iter().zip(&b.depth).map(|(a, b)| (f64::from(*a), f64::from(*b)));
    let misses = pairs().filter(|(a, b)| a.is_finite() != b.is_finite()).count();
    let error = |(a, b): (f64, f64)| (a - b).abs() / (footprint * a);
    let far = pairs().filter(|(a, b)| a.is_finite() && b.is_finite()).filter(|pair| error(*pair) > MAX_DEPTH).count();
    let is_equal = misses == 0 && far as f64 <= MAX_SHARE * a.depth.len() as f64;
    (!is_equal).then(|| format!("{misses} pixels differ in hit or miss, {far} in depth"))
}

/// Compares the interpreter's picture with those of the others.
fn compare(subject: &Subject, side: u32, methods: &[Method]) -> Vec<String> {
    let footprint = subject.camera.footprint(f64::from(side));
    let reference = subject.render(side, Method::Interpreted);
    let of = |method: &Method| {
        let found = difference(&reference, &subject.render(side, *method), footprint)?;
        Some(format!("{}, {method:?}: {found}", subject.name))
    };
    methods.iter().filter_map(of).collect()
}

#[test]
fn every_scene_is_the_same_by_every_method() {
    let both = [Method::Pruned, Method::Specialised];
    let faults: Vec<String> = scenes().flat_map(|scene| compare(&scene, 2 * SIDE, &both)).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn crowds_are_the_same_with_pruned_lists() {
    let all =
        [("crowd", gallery::crowd(120, true, 1)), ("boxes", gallery::boxes(60, 2)), ("spheres", gallery::spheres(3))];
    let subject = |(name, scene)| compare(&Subject::new(name, &scene, None), SIDE, &[Method::Pruned]);
    let faults: Vec<String> = all.into_iter().flat_map(subject).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn random_trees_are_the_same_by_every_method() {
    let mut faults = Vec::new();
    for seed in 0..TREES {
        let scene = tree(1000 + seed, Recipe { blends: true, stretching: seed % 2 == 0 });
        let subject = Subject::new(&format!("tree {seed}"), &scene, None);
        // Each structure is compiled; every fourth is enough of them.
        let methods: &[Method] = if seed % 4 == 0 { &[Method::Pruned, Method::Specialised] } else { &[Method::Pruned] };
        faults.extend(compare(&subject, SIDE, methods));
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn what_is_modified_is_the_same_by_every_method() {
    let mut faults = Vec::new();
    for &kind in ModifierKind::ALL {
        for modifier in samples(kind, 1) {
            let scene = modified(&[modifier]);
            if flatten(&scene, 0.0).is_ok() {
                let subject = Subject::new(&format!("{modifier:?}"), &scene, None);
                faults.extend(compare(&subject, SIDE, &[Method::Specialised]));
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn a_different_picture_is_refused() {
    let subject = Subject::new("crowd", &gallery::crowd(20, true, 1), None);
    let picture = subject.render(SIDE, Method::Interpreted);
    let footprint = subject.camera.footprint(f64::from(SIDE));
    assert_eq!(difference(&picture, &picture, footprint), None);
    let mut missing = picture.clone();
    let hit = missing.depth.iter().position(|d| d.is_finite()).expect("something is seen");
    missing.depth[hit] = f32::INFINITY;
    assert!(difference(&picture, &missing, footprint).is_some());
    let mut farther = picture.clone();
    farther.depth.iter_mut().for_each(|d| *d *= 1.0 + 0.1 * footprint as f32);
    assert!(difference(&picture, &farther, footprint).is_some());
}
