//! The samples of the complete picture: they accumulate while nothing changes, up to a number; then the renderer rests.

use std::time::{Duration, Instant};

use crate::render::{Frame, RenderError, Renderer};

/// The complete picture and its samples.
#[derive(Debug, Default)]
pub(super) struct Samples {
    /// The frame of the picture; `None` while there is no complete one, or one of a view mode without samples.
    frame: Option<Frame>,
    /// The artist has stopped it.
    is_stopped: bool,
}

impl Samples {
    /// Forgets the picture: something has changed.
    pub fn reset(&mut self) {
        *self = Self::default();
    }

    /// Takes over a complete picture.
    pub fn start(&mut self, frame: Frame) {
        *self = Self { frame: Some(frame), is_stopped: false };
    }

    /// Keeps the samples so far and adds no more.
    pub fn stop(&mut self) {
        self.is_stopped = true;
    }

    /// Number of samples in the picture, if it has samples.
    pub fn count(&self) -> Option<u32> {
        self.frame.as_ref().map(|frame| frame.samples().max(1))
    }

    /// Whether the hits at hand may be those of a later sample.
    pub fn has_accumulated(&self) -> bool {
        self.frame.as_ref().is_some_and(|frame| frame.samples() > 0)
    }

    /// Whether samples are missing.
    pub fn wants_more(&self, wanted: u32) -> bool {
        !self.is_stopped && self.count().is_some_and(|count| count < wanted)
    }

    /// Works on the samples until `budget` is spent or there are as many as wanted, but for at least one batch of
    /// dispatches.
    pub fn advance(&mut self, renderer: &mut Renderer, wanted: u32, budget: Duration) -> Result<(), RenderError> {
        let start = Instant::now();
        while self.wants_more(wanted) {
            let Some(frame) = &mut self.frame else { break };
            if frame.is_done() && frame.samples() == 0 {
                renderer.accumulate(frame, false);
            } else if frame.is_done() {
                renderer.next_sample(frame)?;
            }
            renderer.advance(frame, budget.saturating_sub(start.elapsed()))?;
            if start.elapsed() >= budget {
                break;
            }
        }
        Ok(())
    }

    /// Goes on with `frame`, the same picture with other marks, which has just begun. Draws it.
    pub fn restyle(&mut self, renderer: &mut Renderer, mut frame: Frame) -> Result<Frame, RenderError> {
        match &self.frame {
            Some(shown) => renderer.resume_samples(&mut frame, shown),
            None => frame.skip_to_shading(),
        }
        renderer.advance(&mut frame, Duration::MAX)?;
        if let Some(shown) = &mut self.frame {
            *shown = frame.clone();
        }
        Ok(frame)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::{FlatScene, flatten};
    use crate::gallery;
    use crate::render::{Gpu, OverlaySettings, Slot};
    use crate::scene::NodeId;

    const SIZE: [u32; 2] = [48, 32];

    struct Viewport {
        renderer: Renderer,
        flat: FlatScene,
        samples: Samples,
    }

    impl Viewport {
        fn new() -> Self {
            let gpu = Gpu::headless().unwrap_or_else(|error| panic!("{error}"));
            let scene = gallery::all().into_iter().find(|(name, _)| *name == "pawn").expect("the pawn").1;
            let flat = flatten(&scene, 0.0).expect("within the limits");
            Self { renderer: Renderer::new(&gpu).expect("a renderer"), flat, samples: Samples::default() }
        }

        fn begin(&mut self, outline: Vec<NodeId>) -> Frame {
            let camera = self.flat.default_camera(&[], 1.5);
            let overlay = OverlaySettings { outline, ..OverlaySettings::default() };
            self.renderer.begin(Slot::Full, &self.flat, &[], &camera, SIZE, overlay).expect("a frame")
        }

        fn draw(&mut self) {
            let mut frame = self.begin(Vec::new());
            self.renderer.advance(&mut frame, Duration::MAX).expect("a picture");
            self.samples.start(frame);
        }

        fn shown(&self) -> Vec<[u8; 4]> {
            self.renderer.read_shown(Slot::Full).expect("a picture")
        }

        /// Works in slices of no time, as a busy window would; returns the number of slices.
        fn accumulate(&mut self, wanted: u32) -> usize {
            let mut slices = 0;
            while self.samples.wants_more(wanted) {
                self.samples.advance(&mut self.renderer, wanted, Duration::ZERO).expect("a slice");
                slices += 1;
                assert!(slices < 10_000, "it never ends");
            }
            slices
        }
    }

    #[test]
    fn samples_accumulate_up_to_the_number_and_then_rest() {
        let mut viewport = Viewport::new();
        assert!(!viewport.samples.wants_more(8), "there is no picture yet");
        viewport.draw();
        let single = viewport.shown();
        assert_eq!(viewport.samples.count(), Some(1));
        assert!(viewport.accumulate(8) >= 8, "more than a sample in a slice of no time");
        assert_eq!(viewport.samples.count(), Some(8));
        let smooth = viewport.shown();
        assert_ne!(smooth, single);
        // A rest: no more work, whatever time there is.
        viewport.samples.advance(&mut viewport.renderer, 8, Duration::MAX).expect("nothing to do");
        assert_eq!((viewport.samples.count(), viewport.shown() == smooth), (Some(8), true));
        // More may be wanted later, or fewer.
        assert!(viewport.samples.wants_more(9) && !viewport.samples.wants_more(4));
    }

    #[test]
    fn a_change_starts_again_with_the_same_single_sample() {
        let mut viewport = Viewport::new();
        viewport.draw();
        let single = viewport.shown();
        viewport.accumulate(3);
        viewport.samples.reset();
        assert!(viewport.samples.count().is_none() && !viewport.samples.wants_more(3));
        viewport.draw();
        assert_eq!((viewport.samples.count(), viewport.shown() == single), (Some(1), true));
        viewport.samples.stop();
        assert!(!viewport.samples.wants_more(3), "stopped by the artist");
    }

    #[test]
    fn other_marks_are_drawn_over_the_samples_at_hand() {
        let mut viewport = Viewport::new();
        viewport.draw();
        viewport.accumulate(5);
        let plain = viewport.shown();
        // Into the middle of a sample, which starts again after the marks.
        viewport.samples.advance(&mut viewport.renderer, 9, Duration::ZERO).expect("a slice");
        let ids = viewport.flat.ids.clone();
        for (outline, has_marks) in [(ids, true), (Vec::new(), false)] {
            let frame = viewport.begin(outline);
            viewport.samples.restyle(&mut viewport.renderer, frame).expect("drawn");
            let count = viewport.samples.count().expect("samples");
            assert!((5..=6).contains(&count), "{count}");
            assert_eq!(viewport.shown() != plain, has_marks || count > 5);
        }
        viewport.accumulate(9);
        assert_eq!(viewport.samples.count(), Some(9));
        let mut other = Viewport::new();
        other.draw();
        other.accumulate(9);
        assert!(viewport.shown() == other.shown(), "the marks have left something behind");
    }
}
