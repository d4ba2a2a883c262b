//! Where moments stand on the timeline.

use egui::{Rangef, Rect};

use isolith_scene::{Animation, Timeline};

/// Width of the names in points.
pub const NAMES: f32 = 190.0;
/// Room before the first and after the last moment.
const MARGIN: f32 = 10.0;

/// A part of time, and its place on the screen.
pub struct TimeScale {
    /// The first and the last moment, in seconds.
    pub range: [f64; 2],
    /// Where they can be seen.
    pub lane: Rangef,
}

impl TimeScale {
    /// All that is played, and all keys, right of the names in `rect`.
    pub fn of(animation: &Animation, rect: Rect) -> Self {
        let Timeline { start, end, .. } = animation.timeline;
        let ends = animation.tracks().iter().flat_map(|track| [track.keys.first(), track.keys.last()]);
        let range = ends.flatten().fold([start, end], |[least, most], key| [least.min(key.time), most.max(key.time)]);
        let names = NAMES.min(0.3 * rect.width());
        Self { range, lane: Rangef::new(rect.left() + names, rect.right().max(rect.left() + names + 1.0)) }
    }

    fn inner(&self) -> (f64, f64) {
        (f64::from(self.lane.min + MARGIN), f64::from((self.lane.span() - 2.0 * MARGIN).max(1.0)))
    }

    /// The place of a moment.
    pub fn x_of(&self, time: f64) -> f32 {
        let ((left, width), [first, last]) = (self.inner(), self.range);
        (left + (time - first) / (last - first) * width) as f32
    }

    /// The moment of a place.
    pub fn time_at(&self, x: f32) -> f64 {
        let ((left, width), [first, last]) = (self.inner(), self.range);
        first + (f64::from(x) - left) / width * (last - first)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_and_moments_belong_together() {
        let rect = Rect::from_min_size(egui::pos2(7.0, 0.0), egui::vec2(900.0, 20.0));
        let scale = TimeScale::of(&Animation::default(), rect);
        assert_eq!((scale.range, scale.lane.min, scale.lane.max), ([0.0, 10.0], 197.0, 907.0));
        for time in [0.0, 2.5, 10.0] {
            assert!((scale.time_at(scale.x_of(time)) - time).abs() < 1e-3, "{time}");
        }
    }
}
