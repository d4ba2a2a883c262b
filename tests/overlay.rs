//! The outline of the selection: around what is selected, wherever that is, and nowhere else.

use std::collections::BTreeSet;
use std::time::Duration;

use isolith::flat::{Buffers, MESH_BIT};
use isolith::render::{Method, OverlaySettings, Slot};
use isolith::scene::NodeId;

use crate::gpu::{Subject, scenes, shared};

/// Width and height of the pictures, in pixels: no multiple of a tile's.
const SIDE: u32 = 150;
/// The colour of the outline, sRGB.
const ORANGE: [u8; 4] = [255, 158, 51, 255];
/// A ring of radius 2 without its corners.
const RING: [[i32; 2]; 12] =
    [[2, 0], [2, 1], [1, 2], [0, 2], [-1, 2], [-2, 1], [-2, 0], [-2, -1], [-1, -2], [0, -2], [1, -2], [2, -1]];

fn draw(subject: &Subject, outline: &[NodeId]) -> Buffers {
    let renderer = &mut shared().renderer;
    renderer.set_method(Method::Interpreted);
    let Subject { flat, meshes, camera, .. } = subject;
    let overlay = OverlaySettings { grid: false, outline: outline.to_vec() };
    let mut frame = renderer.begin(Slot::Full, flat, meshes, camera, [SIDE, SIDE], overlay).expect("a frame");
    renderer.advance(&mut frame, Duration::MAX).expect("a picture");
    renderer.read(&frame).expect("buffers")
}

/// The node that is seen in each pixel.
fn seen(subject: &Subject, buffers: &Buffers) -> Vec<Option<NodeId>> {
    let node = |leaf: &u32| {
        let leaf = *leaf as usize;
        let mesh = leaf.wrapping_sub(MESH_BIT as usize);
        subject.flat.ids.get(leaf).copied().or_else(|| subject.flat.meshes.get(mesh).map(|m| m.id))
    };
    buffers.leaf.iter().map(node).collect()
}

/// The pixels outside of what is selected with one of it within two pixels.
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
    for subject in scenes().filter(|s| ["mesh-and-fields", "pawn", "boolean-operations"].contains(&s.name.as_str())) {
        let plain = draw(&subject, &[]);
        let seen = seen(&subject, &plain);
        let nodes: Vec<NodeId> = seen.iter().flatten().copied().collect::<BTreeSet<_>>().into_iter().collect();
        // Each alone, and the first with the last: components that stand apart.
        let alone = nodes.iter().map(|id| vec![*id]);
        for selected in alone.chain([vec![nodes[0], nodes[nodes.len() - 1]]]) {
            let outlined = draw(&subject, &selected);
            let expected = edges(&seen, &selected);
            for (at, is_edge) in expected.iter().enumerate() {
                let color = if *is_edge { ORANGE } else { plain.color[at] };
                let [x, y] = [at as u32 % SIDE, at as u32 / SIDE];
                assert_eq!(outlined.color[at], color, "{}: {selected:?} at {x}, {y}", subject.name);
            }
            drawn += usize::from(expected.contains(&true));
        }
    }
    assert!(drawn > 30, "{drawn} outlines");
}

#[test]
fn what_is_not_seen_has_no_outline() {
    let mut subject = scenes().find(|s| s.name == "pawn").expect("it is shipped");
    // Looking away from everything.
    let up = subject.camera.rotation;
    subject.camera.rotation = up * glam::DQuat::from_rotation_y(std::f64::consts::PI);
    let all: Vec<NodeId> = subject.flat.ids.clone();
    assert!(draw(&subject, &all).color == draw(&subject, &[]).color);
}
