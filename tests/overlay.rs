//! The outline of the selection: around the selected nodes wherever they are, and nowhere else.

use std::collections::BTreeSet;
use std::time::Duration;

use isolith::field::{GBuffer, MESH_BIT};
use isolith::render::{EvalStrategy, OverlaySettings, Slot};
use isolith::scene::NodeId;

use crate::gpu::{BenchScene, scenes, shared};

/// Width and height of the pictures, in pixels: not a multiple of a tile's.
const SIDE: u32 = 150;
/// The color of the outline, sRGB.
const ORANGE: [u8; 4] = [255, 158, 51, 255];
/// A ring of radius 2 without its corners.
const RING: [[i32; 2]; 12] =
    [[2, 0], [2, 1], [1, 2], [0, 2], [-1, 2], [-2, 1], [-2, 0], [-2, -1], [-1, -2], [0, -2], [1, -2], [2, -1]];

fn draw(bench_scene: &BenchScene, outline: &[NodeId]) -> GBuffer {
    let renderer = &mut shared().renderer;
    renderer.set_strategy(EvalStrategy::Interpreter);
    let BenchScene { flat, meshes, camera, .. } = bench_scene;
    let overlay = OverlaySettings { outline: outline.to_vec(), ..OverlaySettings::default() };
    let mut frame = renderer.begin(Slot::Full, flat, meshes, camera, [SIDE, SIDE], overlay).expect("a frame");
    renderer.advance(&mut frame, Duration::MAX).expect("a picture");
    renderer.read(&frame).expect("buffers")
}

/// The node visible in each pixel.
fn seen(bench_scene: &BenchScene, buffers: &GBuffer) -> Vec<Option<NodeId>> {
    let node = |leaf: &u32| {
        let leaf = *leaf as usize;
        let mesh = leaf.wrapping_sub(MESH_BIT as usize);
        bench_scene.flat.ids.get(leaf).copied().or_else(|| bench_scene.flat.meshes.get(mesh).map(|m| m.id))
    };
    buffers.leaf.iter().map(node).collect()
}

/// Unselected pixels with a selected one within two pixels.
fn edges(seen: &[Option<NodeId>], selected: &[NodeId]) -> Vec<bool> {
    let side = SIDE as i32;
    let is_selected = |x: i32, y: i32| {
        let inside = (0..side).contains(&x) && (0..side).contains(&y);
        inside && seen[(y * side + x) as usize].is_some_and(|id| selected.contains(&id))
    };
    let pixels = (0..side).flat_map(|y| (0..side).map(move |x| (x, y)));
    pixels.map(|(x, y)| !is_selected(x, y) && RING.iter().any(|[dx, dy]| is_selected(x + dx, y + dy))).collect()
}

#[test]
fn an_outline_is_around_what_is_selected_and_nowhere_else() {
    let mut drawn = 0;
    for bench_scene in scenes().filter(|s| ["mesh-and-fields", "pawn", "boolean-operations"].contains(&s.name.as_str()))
    {
        let plain = draw(&bench_scene, &[]);
        let seen = seen(&bench_scene, &plain);
        let nodes: Vec<NodeId> = seen.iter().flatten().copied().collect::<BTreeSet<_>>().into_iter().collect();
        // Each node alone, and the first with the last: components apart from each other.
        let alone = nodes.iter().map(|id| vec![*id]);
        for selected in alone.chain([vec![nodes[0], nodes[nodes.len() - 1]]]) {
            let outlined = draw(&bench_scene, &selected);
            let expected = edges(&seen, &selected);
            for (at, is_edge) in expected.iter().enumerate() {
                let color = if *is_edge { ORANGE } else { plain.color[at] };
                let [x, y] = [at as u32 % SIDE, at as u32 / SIDE];
                assert_eq!(outlined.color[at], color, "{}: {selected:?} at {x}, {y}", bench_scene.name);
            }
            drawn += usize::from(expected.contains(&true));
        }
    }
    assert!(drawn > 30, "{drawn} outlines");
}

#[test]
fn what_is_not_seen_has_no_outline() {
    let mut bench_scene = scenes().find(|s| s.name == "pawn").expect("it is shipped");
    // A camera that faces away from everything.
    let up = bench_scene.camera.rotation;
    bench_scene.camera.rotation = up * glam::DQuat::from_rotation_y(std::f64::consts::PI);
    let all: Vec<NodeId> = bench_scene.flat.ids.clone();
    assert!(draw(&bench_scene, &all).color == draw(&bench_scene, &[]).color);
}

/// The pixels that the outline changes in a picture of this size, scaled to [`SIDE`].
fn marked(bench_scene: &BenchScene, size: u32, selected: &[NodeId]) -> Vec<bool> {
    let renderer = &mut shared().renderer;
    renderer.set_strategy(EvalStrategy::Interpreter);
    let BenchScene { flat, meshes, camera, .. } = bench_scene;
    let mut shown = |outline: &[NodeId]| {
        let shown_at = Some([SIDE, SIDE]);
        let grid = true;
        let overlay = OverlaySettings { outline: outline.to_vec(), shown_at, grid, ..OverlaySettings::default() };
        let mut frame = renderer.begin(Slot::Preview, flat, meshes, camera, [size, size], overlay).expect("a frame");
        renderer.advance(&mut frame, Duration::MAX).expect("a picture");
        assert_eq!(renderer.picture(Slot::Preview).expect("a picture").1, [SIDE, SIDE]);
        renderer.read_shown(Slot::Preview).expect("colors")
    };
    let (plain, outlined) = (shown(&[]), shown(selected));
    // Half a pixel of antialiasing on either side does not count.
    let differs = |(a, b): (&[u8; 4], &[u8; 4])| a.iter().zip(b).any(|(a, b)| a.abs_diff(*b) > 60);
    plain.iter().zip(&outlined).map(differs).collect()
}

/// The longest run of marked pixels in a row, as the median over the rows that have any: the width of the outline at a
/// vertical edge.
fn thickness(marked: &[bool]) -> usize {
    let mut runs: Vec<usize> = marked
        .chunks(SIDE as usize)
        .flat_map(|row| row.split(|is_marked| !is_marked).map(<[bool]>::len).filter(|length| *length > 0))
        .collect();
    runs.sort_unstable();
    runs[runs.len() / 2]
}

#[test]
fn the_outline_in_coarse_pictures_is_as_thin_as_in_fine_ones() {
    let bench_scene = scenes().find(|s| s.name == "pawn").expect("it is shipped");
    let all: Vec<NodeId> = bench_scene.flat.ids.clone();
    let fine = marked(&bench_scene, SIDE, &all);
    let of_fine = fine.iter().filter(|is_marked| **is_marked).count();
    assert!((1..=3).contains(&thickness(&fine)), "{}", thickness(&fine));
    for size in [SIDE / 2, SIDE / 4, SIDE / 7] {
        let coarse = marked(&bench_scene, size, &all);
        assert!((1..=3).contains(&thickness(&coarse)), "{size}: {}", thickness(&coarse));
        let of_coarse = coarse.iter().filter(|is_marked| **is_marked).count();
        let ratio = of_coarse as f64 / of_fine as f64;
        assert!((0.6..1.6).contains(&ratio), "{size}: {of_coarse} pixels, {of_fine} in the fine picture");
        // Both outlines follow the same line: near each pixel of one there is a pixel of the other.
        let side = SIDE as i32;
        let far = (0..side * side).filter(|at| coarse[*at as usize]).filter(|at| {
            let reach = side / size as i32 + 3;
            let near = |dx: i32, dy: i32| {
                let (x, y) = (at % side + dx, at / side + dy);
                (0..side).contains(&x) && (0..side).contains(&y) && fine[(y * side + x) as usize]
            };
            !(-reach..=reach).any(|dy| (-reach..=reach).any(|dx| near(dx, dy)))
        });
        let far = far.count();
        assert!(far * 20 < of_coarse, "{size}: {far} of {of_coarse} pixels are elsewhere");
    }
}
