//! What pipelines prove about the field ahead on a ray holds: the CPU evaluator is nowhere negative in that interval.

use super::*;

/// Number of samples along the interval.
const LOOKS: usize = 24;

/// Counts the proofs that go farther than the distance, all proofs, and those that cover more of the ray behind than
/// the distance does.
fn proofs_hold(what: &str, flat: &FlatScene, index: usize, evaluator: &Evaluator, random: &mut Random) -> [usize; 3] {
    let pairs: Vec<DVec3> = (0..POINTS)
        .flat_map(|i| {
            let from = random.point(if i % 2 == 0 { 1.5 } else { 0.7 }).as_vec3().as_dvec3();
            let way = random.point(1.0) * if i % 3 == 0 { 0.3 } else { 0.03 };
            [from, (from + way).as_vec3().as_dvec3()]
        })
        .collect();
    let options = Options { skip_mode: SkipMode::Selects, ..Options::default() };
    let found = probe::lookahead(&shared().gpu, flat, index, &pairs, evaluator, options).unwrap();
    let mut farther = [0, 0, 0];
    for (pair, [f, proven, least, first]) in
        pairs.as_chunks::<2>().0.iter().zip(found).filter(|(_, found)| found[0] > 1e-3)
    {
        let direction = (pair[1] - pair[0]).normalize();
        for i in 0..=LOOKS {
            let p = pair[1] + direction * (f64::from(proven) * i as f64 / LOOKS as f64);
            let there = field(flat, &flat.components[index], p);
            assert!(
                there > -1e-5,
                "{what}: from {} to {} is {f}, then {there} at {p}, within {proven}",
                pair[0],
                pair[1]
            );
        }
        let window = 4.0 * pair[0].distance(pair[1]);
        let least = f64::from(least.min(first));
        for i in 0..=LOOKS {
            let p = pair[0] - direction * (window * i as f64 / LOOKS as f64);
            let there = field(flat, &flat.components[index], p);
            assert!(
                there > least - 1e-5,
                "{what}: before {}, from {}, at {p} it is {there}, at least {least} was said",
                pair[0],
                pair[1]
            );
        }
        farther[2] += usize::from(least > f64::from(first) - 0.8 * window);
        farther[0] += usize::from(proven > 1.2 * f);
        farther[1] += 1;
    }
    farther
}

#[test]
fn what_is_proven_ahead_is_so() {
    let kinds = &[
        ShapeKind::Sphere,
        ShapeKind::Box,
        ShapeKind::Torus,
        ShapeKind::Capsule,
        ShapeKind::Cylinder,
        ShapeKind::CappedCone,
        ShapeKind::RoundCone,
        ShapeKind::InfiniteCylinder,
        ShapeKind::Ellipsoid,
    ];
    let trees = (300..310).map(|seed| tree(seed, Recipe { blends: true, stretching: seed % 2 == 0, kinds }));
    let [mut farther, mut all, mut behind] = [0, 0, 0];
    for (seed, scene) in trees.chain([gallery::random(4, 1), long_rows(&mut Random::new(1))]).enumerate() {
        let flat = flatten(&scene, 0.0).unwrap();
        let used = flat.nodes.iter().filter(|node| node.is_leaf()).map(|n| ShapeKind::ALL[(n.code & 0xffff) as usize]);
        let used = ShapeSet::of(used);
        for (index, component) in flat.components.iter().enumerate().take(3) {
            let structures = [Structure::of(&flat, component), Structure::template(&flat, component, used)];
            for evaluator in structures.into_iter().flatten().map(Evaluator::StraightLine) {
                let mut random = Random::new(seed as u64);
                let [more, of, more_behind] =
                    proofs_hold(&format!("scene {seed}"), &flat, index, &evaluator, &mut random);
                farther += more;
                all += of;
                behind += more_behind;
            }
        }
    }
    assert!(behind > all / 20, "only {behind} of {all} proofs say more of the way behind");
    assert!(all > 20_000 && farther > all / 20, "only {farther} of {all} proofs go farther than the distance");
}
