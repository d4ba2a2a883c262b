//! A chessboard: two pawns and four squares, repeated.

use super::chess_pawn;
use super::scene_builder::{SceneBuilder, cuboid, group, object, v};
use isolith_scene::{Modifier, Operator, Scene};

/// Side of a square, in meters.
const SQUARE: f64 = 1.0;

pub(super) fn scene() -> Scene {
    let mut builder = SceneBuilder::new([0.20, 0.26, 0.33], [0.42, 0.44, 0.46], [0.30, 0.31, 0.34]);
    let ivory = builder.glossy("Ivory", [0.72, 0.62, 0.45], 0.28);
    let ebony = builder.coated("Ebony", [0.048, 0.034, 0.028], 0.1);
    let light = builder.glossy("Light squares", [0.60, 0.47, 0.29], 0.4);
    let dark = builder.glossy("Dark squares", [0.16, 0.075, 0.035], 0.36);
    let frame = builder.coated("Frame", [0.10, 0.045, 0.022], 0.18);

    let half = 4.0 * SQUARE;
    builder.add(
        None,
        object("Frame", cuboid(2.0 * half + 0.8, 0.3, 2.0 * half + 0.8, 0.08), frame).at(v(0.0, -0.26, 0.0)),
    );
    for (name, material, odd) in [("Light", light, 0.0), ("Dark", dark, 1.0)] {
        // Every other square of a row; each row is offset by one square from the row before.
        for row in 0..2 {
            let shift = (f64::from(row) + odd) % 2.0;
            let node = object(name, cuboid(SQUARE - 0.02, 0.2, SQUARE - 0.02, 0.02), material);
            let at = v((shift + 0.5) * SQUARE - half, -0.12, (f64::from(row) + 0.5) * SQUARE - half);
            builder.add(None, node.at(at).modified(repeated([4, 1, 4], 2.0 * SQUARE)));
        }
    }
    for (name, material, row) in [("White pawns", ivory, 6.5), ("Black pawns", ebony, 1.5)] {
        let at = v(0.5 * SQUARE - half, 0.0, row * SQUARE - half);
        let row = builder.add(None, group(name, Operator::Union).at(at).modified(repeated([8, 1, 1], SQUARE)));
        chess_pawn::pawn(&mut builder, Some(row), ("Pawn", material), v(0.0, -0.02, 0.0));
    }
    builder.sun("Key", [-0.6, 0.9, 0.55], [1.0, 0.95, 0.88], 1.0);
    builder.sun("Fill", [0.8, 0.4, 0.6], [0.72, 0.84, 1.0], 0.3);
    builder.camera([5.2, 6.4, 9.6], [-0.2, -0.35, 0.0], 50.0);
    builder.finish()
}

fn repeated(counts: [u32; 3], spacing: f64) -> Modifier {
    Modifier::Repeat {
        counts,
        spacing: [spacing; 3],
        offset: [0.0; 3],
        turn: 0.0,
        mirrored: [false; 3],
        carve_from: [0; 3],
        carve_to: [0; 3],
    }
}
