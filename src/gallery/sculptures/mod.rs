//! Sculptures made by code, of a hundred thousand triangles, and plants, as glTF files that are written with the scenes.
//!
//! Each is a grid around an axis: its rows are drawn from the bottom to the top by rays from the inside.

mod bust;
mod column;
mod plants;
mod strip;
mod vase;

use bust::bust;
use column::column;
use plants::{fir, oak_leaves, oak_wood, tuft};
use vase::vase;

/// A sculpture: its path beside the scenes, and what makes its file.
type SculptureFile = (&'static str, fn() -> Vec<u8>);

/// The sculptures and plants.
pub const SCULPTURES: [SculptureFile; 7] = [
    ("models/bust.glb", || bust().file()),
    ("models/vase.glb", || vase().file()),
    ("models/column.glb", || column().file()),
    ("models/fir.glb", || fir().file()),
    ("models/oak-wood.glb", || oak_wood().file()),
    ("models/oak-leaves.glb", || oak_leaves().file()),
    ("models/tuft.glb", || tuft().file()),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plants_are_pieces_that_are_closed_and_turned_outward() {
        for plant in [fir(), oak_wood(), oak_leaves(), tuft()] {
            let volume: f64 = plant.triangles().map(|[a, b, c]| a.dot(b.cross(c)) / 6.0).sum();
            assert!(plant.points.iter().all(|p| p.is_finite() && p.length() < 5.0) && volume > 0.0, "{}", plant.name);
            // Each edge has a triangle on both sides.
            let bits = |p: glam::DVec3| p.to_array().map(|v| (v * 1e7).round() as i64);
            let mut sides = std::collections::HashMap::new();
            for corners in plant.triangles().map(|corners| corners.map(bits)) {
                let [a, b, c] = corners;
                if a == b || b == c || c == a {
                    continue;
                }
                for [from, to] in [[a, b], [b, c], [c, a]] {
                    *sides.entry((from.min(to), from.max(to))).or_insert(0) += if from < to { 1 } else { -1 };
                }
            }
            assert!(sides.values().all(|turn| *turn == 0), "{} is open", plant.name);
            assert!(plant.points.len() < 65_536 && plant.file().len() < 600_000, "{}", plant.name);
        }
    }

    #[test]
    fn sculptures_have_a_hundred_thousand_triangles_in_few_bytes() {
        for (path, sculpture) in
            [bust(), vase(), column()].into_iter().zip(SCULPTURES).map(|(own, (path, _))| (path, own))
        {
            assert!(sculpture.points.iter().all(|p| p.is_finite() && p.length() < 2.0), "{path}");
            let (rows, around) = (sculpture.points.len() / sculpture.around, sculpture.around);
            assert!(2 * around * (rows - 2) >= 100_000, "{path}");
            let file = sculpture.file();
            assert!(file.starts_with(b"glTF") && file.len() < 900_000, "{path}: {} bytes", file.len());
            // The ends are closed: each row there is one point.
            for row in [0, rows - 1] {
                let points = &sculpture.points[row * around..(row + 1) * around];
                assert!(points.iter().all(|p| p.distance(points[0]) < 1e-9), "{path}: row {row}");
            }
        }
    }
}
