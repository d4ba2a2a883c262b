//! Sculptures made by code: models of a hundred thousand triangles, as glTF files
//! that are written with the scenes.
//!
//! Each is a grid around an axis: its rows are drawn from the bottom to the top by rays from the inside.

mod amphora;
mod bust;
mod column;
mod strip;
mod vase;

use amphora::amphora;
use bust::bust;
use column::column;
use vase::vase;

/// A sculpture: its path beside the scenes, and what makes its file.
type SculptureFile = (&'static str, fn() -> Vec<u8>);

/// The sculptures.
pub const SCULPTURES: [SculptureFile; 4] = [
    ("models/bust.glb", || bust().file()),
    ("models/vase.glb", || vase().file()),
    ("models/column.glb", || column().file()),
    ("models/amphora.glb", amphora),
];

#[cfg(test)]
mod tests {
    use super::*;

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
