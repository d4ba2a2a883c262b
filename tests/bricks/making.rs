//! Making bricks: progress, cancel, sheets, and what is refused.

use glam::DVec3;
use isolith::bricks::{BrickError, RESOLUTIONS};
use isolith::mesh::{bricks_of, usual_resolution, voxel_for, voxelized};

use super::SHARES;
use super::shapes::Soup;

#[test]
fn progress_grows_and_a_cancel_stops_it() {
    let mesh = Soup::knot(40).mesh();
    let voxel = voxel_for(&mesh.bounds, 384.0);
    let mut told = Vec::new();
    voxelized(&mesh, voxel, &mut |share| {
        told.push(share);
        true
    })
    .unwrap();
    assert!(told.is_sorted() && told.iter().all(|share| SHARES.contains(share)), "{told:?}");
    let mut calls = 0;
    let canceled = voxelized(&mesh, voxel, &mut |_| {
        calls += 1;
        false
    });
    assert_eq!((canceled.unwrap_err(), calls > 0), (BrickError::Canceled, true));
}

#[test]
fn what_cannot_be_bricks_is_refused_with_the_reason() {
    let ball = Soup::sphere(8, 1.0).mesh();
    let refused = |voxel: f64| voxelized(&ball, voxel, &mut |_| true).unwrap_err().to_string();
    assert!(refused(1e-5).contains("at most 1024"), "{}", refused(1e-5));
    for voxel in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(refused(voxel), BrickError::Voxel.to_string());
    }
    let line = Soup { points: vec![DVec3::ZERO, DVec3::X, DVec3::X * 2.0], triangles: vec![[0, 1, 2], [0, 1, 1]] };
    assert_eq!(bricks_of(&line.mesh(), 0.01, &mut |_| true).unwrap_err(), BrickError::Empty);
    // The finest that is allowed, of little.
    let dot = Soup::sphere(4, 0.01).with(Soup::sphere(4, 0.01).moved(DVec3::X)).mesh();
    let finest = f64::from(RESOLUTIONS[1]);
    assert!(bricks_of(&dot, voxel_for(&dot.bounds, finest), &mut |_| true).unwrap().count() > 0);
}

#[test]
fn sheets_get_a_thickness_wherever_they_lie() {
    let mut whole = Soup::default();
    // A leaf, at heights between two layers of samples and on one.
    for (i, height) in [0.0, 0.131, 0.25, 0.377].into_iter().enumerate() {
        let corner = DVec3::new(i as f64 * 1.2, height, 0.0);
        let first = whole.points.len() as u32;
        whole.points.extend([DVec3::ZERO, DVec3::Z, DVec3::new(1.0, 0.0, 1.0), DVec3::X].map(|p| p + corner));
        whole.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
    }
    let mesh = whole.mesh();
    let made = voxelized(&mesh, voxel_for(&mesh.bounds, 100.0), &mut |_| true).unwrap();
    assert!(made.remarks.len() == 1 && made.remarks[0].contains("thickness"), "{:?}", made.remarks);
    let voxel = made.bricks.voxel();
    for (i, height) in [0.0, 0.131, 0.25, 0.377].into_iter().enumerate() {
        for at in [[0.5, 0.5], [0.1, 0.9], [0.77, 0.2]] {
            let at = |off: f64| {
                let p = DVec3::new(i as f64 * 1.2 + at[0], height + off * voxel, at[1]);
                made.bricks.interpolated(p).unwrap() / voxel
            };
            assert!(at(0.0) < -0.2, "{}", at(0.0));
            assert!((at(1.7) - 0.95).abs() < 0.1 && (at(-1.7) - 0.95).abs() < 0.1, "{} {}", at(1.7), at(-1.7));
        }
    }
    // What encloses a space has none.
    let ball = Soup::sphere(16, 1.0).mesh();
    assert!(voxelized(&ball, 0.02, &mut |_| true).unwrap().remarks.is_empty());
}

#[test]
fn the_usual_resolution_follows_the_edges() {
    let of = |soup: Soup| usual_resolution(&soup.mesh());
    assert_eq!(of(Soup::cuboid(DVec3::ONE)), 64.0);
    let (some, many) = (of(Soup::sphere(40, 1.0)), of(Soup::knot(160)));
    assert!((64.0..=128.0).contains(&some) && many > some && many <= 512.0, "{some} and {many}");
}

/// Two made of the same mesh are the same, on whichever threads.
#[test]
fn bricks_do_not_depend_on_threads() {
    let mesh = Soup::torus(24).mesh();
    let made = || voxelized(&mesh, 0.02, &mut |_| true).unwrap().bricks;
    assert_eq!(made(), made());
}
