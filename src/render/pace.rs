//! How much there is to do, and how fast the device is.

use std::time::Duration;

/// Effort, in evaluations of a leaf, by the kind of kernel that makes them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Effort {
    /// By interpreted kernels, and everything else.
    pub interpreted: f64,
    /// By specialised kernels.
    pub specialised: f64,
    /// Dispatches, which take their time however little they do.
    pub dispatches: f64,
}

impl Effort {
    /// A dispatch of an amount of one kind.
    pub fn new(specialised: bool, amount: f64) -> Self {
        let [interpreted, specialised] = if specialised { [0.0, amount] } else { [amount, 0.0] };
        Self { interpreted, specialised, dispatches: 1.0 }
    }
}

impl std::ops::Add for Effort {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            interpreted: self.interpreted + other.interpreted,
            specialised: self.specialised + other.specialised,
            dispatches: self.dispatches + other.dispatches,
        }
    }
}

/// How fast the device is, learnt from what was measured.
#[derive(Clone, Copy, Debug)]
pub struct Pace {
    interpreted: f64,
    specialised: f64,
    /// Not learnt: measured on lavapipe, which wakes its threads and waits for them; a guess for graphics cards.
    dispatch: f64,
    /// The last whole frame, and how many seconds it took.
    frame: Option<(Effort, f64)>,
}

/// Seconds.
const LEAST_MEASURED: f64 = 0.001;

impl Pace {
    /// A first guess.
    pub fn new(software: bool) -> Self {
        if software {
            Self { interpreted: 4e-8, specialised: 2e-9, dispatch: 25e-6, frame: None }
        } else {
            Self { interpreted: 5e-11, specialised: 1e-11, dispatch: 3e-6, frame: None }
        }
    }

    /// Seconds that the effort is expected to take.
    pub fn seconds(&self, effort: Effort) -> f64 {
        effort.dispatches * self.dispatch + self.seconds_of_work(effort)
    }

    /// Seconds that a whole frame of this effort is expected to take. What a dispatch is expected to take is wary, a sum of
    /// that would be several times too much: where a frame has been measured, that is what others are compared with.
    pub fn seconds_of_frame(&self, effort: Effort) -> f64 {
        let share = self.frame.map_or(1.0, |(measured, took)| took / self.seconds(measured));
        self.seconds(effort) * share
    }

    /// Learns what a whole frame took.
    pub fn learn_frame(&mut self, effort: Effort, took: Duration) {
        if self.seconds(effort) > 0.0 {
            self.frame = Some((effort, took.as_secs_f64()));
        }
    }

    fn seconds_of_work(&self, effort: Effort) -> f64 {
        effort.interpreted * self.interpreted + effort.specialised * self.specialised
    }

    /// Effort of one kind that is expected to take this long.
    pub fn effort_in(&self, time: Duration, specialised: bool) -> f64 {
        time.as_secs_f64() / if specialised { self.specialised } else { self.interpreted }
    }

    /// Learns from a measurement. Slower than expected counts at once, faster bit by bit.
    pub fn learn(&mut self, effort: Effort, took: Duration) {
        let expected = self.seconds_of_work(effort);
        let took = took.as_secs_f64() - effort.dispatches * self.dispatch;
        // Of less it is the submission that is measured, not the work: then all that is known is that it took no more.
        let took = took.max(LEAST_MEASURED);
        if expected <= 0.0 || (took <= LEAST_MEASURED && expected <= took) {
            return;
        }
        // A driver that compiles, or a machine that does something else, takes ten times as long once in a while.
        let ratio = (took / expected).clamp(0.05, 4.0);
        let gain = if ratio > 1.0 { 0.6 } else { 0.3 };
        let of_special = effort.specialised * self.specialised / expected;
        self.specialised *= 1.0 + (ratio - 1.0) * gain * of_special;
        self.interpreted *= 1.0 + (ratio - 1.0) * gain * (1.0 - of_special);
    }
}

/// Pixels of a full picture to a side of a coarse pixel, at most.
const COARSEST: f64 = 8.0;

/// Size of the picture that is to be had in this time where one of `size` takes as long as `full`; never less than an eighth
/// of a side. Between sizes lies half the time each, so that a drag does not make new targets for each of its pictures.
pub fn coarse_size(size: [u32; 2], full: Duration, time: Duration) -> [u32; 2] {
    let halvings = (full.as_secs_f64() / time.as_secs_f64().max(1e-9)).log2().ceil();
    let factor = (0.5 * halvings).exp2().clamp(1.0, COARSEST);
    size.map(|side| ((f64::from(side) / factor).ceil() as u32).max(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pace_follows_what_is_measured() {
        let mut pace = Pace::new(true);
        let effort = Effort { interpreted: 1e6, specialised: 1e7, dispatches: 10.0 };
        for _ in 0..60 {
            pace.learn(effort, Duration::from_millis(100));
        }
        let expected = pace.seconds(effort);
        assert!((expected - 0.1).abs() < 0.01, "{expected}");
        // What takes less than can be measured is known to take no more than that.
        for _ in 0..60 {
            pace.learn(effort, Duration::from_micros(30));
        }
        let expected = pace.seconds_of_work(effort);
        assert!((expected - LEAST_MEASURED).abs() < 0.1 * LEAST_MEASURED, "{expected}");
    }

    #[test]
    fn a_frame_is_compared_with_the_last_one() {
        let mut pace = Pace::new(true);
        let effort = Effort { interpreted: 1e6, specialised: 1e7, dispatches: 10.0 };
        assert_eq!(pace.seconds_of_frame(effort), pace.seconds(effort));
        pace.learn_frame(effort, Duration::from_millis(7));
        // A slow dispatch makes dispatches shorter, and no frame longer.
        pace.learn(effort, Duration::from_millis(900));
        assert!((pace.seconds_of_frame(effort) - 0.007).abs() < 1e-12 && pace.seconds(effort) > 0.1);
        assert!((pace.seconds_of_frame(effort + effort) - 0.014).abs() < 1e-12);
    }

    #[test]
    fn a_coarse_picture_is_no_coarser_than_it_must_be() {
        let at = |full| coarse_size([800, 600], Duration::from_millis(full), Duration::from_millis(60));
        assert_eq!(
            [at(0), at(60), at(61), at(120), at(121)],
            [[800, 600], [800, 600], [566, 425], [566, 425], [400, 300]]
        );
        assert_eq!([at(1_000), at(1_000_000)], [[142, 107], [100, 75]]);
        assert_eq!(coarse_size([1, 3], Duration::from_secs(9), Duration::ZERO), [1, 1]);
    }
}
