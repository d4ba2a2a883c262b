//! The example of the renderer crate: inside another program's device, the renderer draws the same picture as on its
//! own.

#[allow(dead_code, reason = "`main` is for who runs the example")]
#[path = "../src/render/examples/embed.rs"]
mod example;

use std::time::Duration;

use isolith::field::flatten;
use isolith::render::{EvalStrategy, OverlaySettings, Renderer, Slot};

use crate::gpu::shared;

#[test]
fn the_renderer_draws_on_a_device_that_another_program_owns() {
    let foreign = example::render_on_foreign_device().expect("the example renders");
    let mut renderer = Renderer::new(&shared().gpu).unwrap();
    renderer.set_strategy(EvalStrategy::Tape);
    let flat = flatten(&example::scene().unwrap(), 0.0).unwrap();
    let settings = OverlaySettings::default();
    let mut frame = renderer.begin(Slot::Full, &flat, &[], &example::camera(), example::SIZE, settings).unwrap();
    while !frame.is_done() {
        renderer.advance(&mut frame, Duration::from_millis(10)).unwrap();
    }
    let own: Vec<u8> = renderer.read_shown(Slot::Full).unwrap().concat();
    assert_eq!(foreign, own);
    let mut colors: Vec<&[u8]> = own.chunks(4).collect();
    colors.sort_unstable();
    colors.dedup();
    assert!(colors.len() > 100, "the picture shows nothing");
}
