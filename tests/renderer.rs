//! What the renderer promises beside its pictures: it can be stopped, survives the loss of its device,
//! uploads what has changed and nothing else.

use std::time::Duration;

use isolith::flat::Buffers;
use isolith::gallery;
use isolith::render::{Gpu, Method, OverlaySettings, RenderError, Renderer, Slot};

use crate::gpu::{Subject, shared};

const SIDE: u32 = 96;

fn subject() -> Subject {
    let (name, scene) = gallery::all().into_iter().find(|(name, _)| *name == "pawn").expect("the pawn is shipped");
    Subject::new(name, &scene, None)
}

fn draw(renderer: &mut Renderer, subject: &Subject) -> Result<Buffers, RenderError> {
    let Subject { flat, meshes, camera, .. } = subject;
    renderer.render(flat, meshes, camera, [SIDE, SIDE], &mut |_| true).map(|(buffers, _)| buffers)
}

fn own_renderer() -> (Gpu, Renderer) {
    let gpu = Gpu::headless().unwrap_or_else(|error| panic!("{error}"));
    let mut renderer = Renderer::new(&gpu).unwrap_or_else(|error| panic!("{error}"));
    renderer.set_method(Method::Interpreted);
    (gpu, renderer)
}

#[test]
fn a_device_lost_in_the_middle_of_a_frame_is_an_error_and_the_next_one_draws_the_same() {
    let subject = subject();
    let (_, mut renderer) = own_renderer();
    let whole = draw(&mut renderer, &subject).expect("a picture");
    for batches in 0..3 {
        let (gpu, mut renderer) = own_renderer();
        let Subject { flat, meshes, camera, .. } = &subject;
        let none = OverlaySettings::default();
        let mut frame = renderer.begin(Slot::Full, flat, meshes, camera, [SIDE, SIDE], none).expect("a frame");
        for _ in 0..batches {
            if !frame.is_done() {
                renderer.advance(&mut frame, Duration::ZERO).expect("a batch");
            }
        }
        gpu.device.destroy();
        let error = draw(&mut renderer, &subject).expect_err("the device is gone");
        assert!(matches!(error, RenderError::Gpu(_)), "{error}");
        assert!(gpu.is_lost());
        let (_, mut renderer) = own_renderer();
        assert!(draw(&mut renderer, &subject).expect("a picture") == whole, "after {batches} batches");
    }
}

#[test]
fn a_frame_can_be_cancelled_between_dispatches() {
    let subject = subject();
    let renderer = &mut shared().renderer;
    let mut asked = 0;
    let result = renderer.render(&subject.flat, &subject.meshes, &subject.camera, [SIDE, SIDE], &mut |share| {
        assert!((0.0..=1.0).contains(&share));
        asked += 1;
        false
    });
    assert!(matches!(result, Err(RenderError::Cancelled)));
    assert_eq!(asked, 1);
}

#[test]
fn what_has_not_changed_is_not_uploaded() {
    let subject = subject();
    let (_, mut renderer) = own_renderer();
    draw(&mut renderer, &subject).expect("a picture");
    let (uploaded, built) = (renderer.uploaded(), renderer.kernels().built());
    assert!(uploaded > 0);
    draw(&mut renderer, &subject).expect("a picture");
    assert_eq!(renderer.uploaded(), uploaded);
    assert_eq!(renderer.kernels().built(), built);
}

#[test]
fn a_picture_larger_than_the_device_allows_is_refused_with_the_limit() {
    let subject = subject();
    let renderer = &mut shared().renderer;
    for size in [[0, 10], [10, 1 << 20]] {
        let result = renderer.render(&subject.flat, &subject.meshes, &subject.camera, size, &mut |_| true);
        assert!(matches!(result, Err(RenderError::Size(..))), "{size:?}");
    }
}
