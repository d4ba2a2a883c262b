//! Cost model: the work of a frame, and the speed of the device.

use std::time::Duration;

/// Cost in evaluations of a leaf, by the kind of pipeline that evaluates it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cost {
    /// Evaluations by interpreters and tapes, and everything else.
    pub interpreter: f64,
    /// Evaluations by straight-line code.
    pub straight_line: f64,
    /// Dispatches. Each has a fixed cost, however little it does.
    pub dispatches: f64,
}

impl Cost {
    /// The cost of one dispatch with `amount` of one kind of work.
    pub fn new(straight_line: bool, amount: f64) -> Self {
        let [interpreter, straight_line] = if straight_line { [0.0, amount] } else { [amount, 0.0] };
        Self { interpreter, straight_line, dispatches: 1.0 }
    }
}

impl std::ops::Add for Cost {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            interpreter: self.interpreter + other.interpreter,
            straight_line: self.straight_line + other.straight_line,
            dispatches: self.dispatches + other.dispatches,
        }
    }
}

/// The speed of the device, learned from measurements.
#[derive(Clone, Copy, Debug)]
pub struct CostModel {
    interpreter: f64,
    straight_line: f64,
    /// Not learned: measured on lavapipe, which wakes its threads and waits for them. For graphics cards it is a guess.
    dispatch: f64,
    /// Cost of the last whole frame, and the seconds that it took.
    frame: Option<(Cost, f64)>,
}

/// Shortest measurable time, in seconds.
const LEAST_MEASURED: f64 = 0.001;

impl CostModel {
    /// An initial guess, before any measurement.
    pub fn new(software: bool) -> Self {
        if software {
            Self { interpreter: 4e-8, straight_line: 2e-9, dispatch: 25e-6, frame: None }
        } else {
            Self { interpreter: 5e-11, straight_line: 1e-11, dispatch: 3e-6, frame: None }
        }
    }

    /// Expected time of this cost, in seconds.
    pub fn seconds(&self, cost: Cost) -> f64 {
        cost.dispatches * self.dispatch + self.seconds_of_evaluations(cost)
    }

    /// Expected time of a whole frame of this cost, in seconds. The estimate of a single dispatch is cautious, and a
    /// sum of such estimates is several times too large. So once a frame has been measured, its time scales the
    /// estimate.
    pub fn seconds_of_frame(&self, cost: Cost) -> f64 {
        let share = self.frame.map_or(1.0, |(measured, elapsed)| elapsed / self.seconds(measured));
        self.seconds(cost) * share
    }

    /// Learns from the time of a whole frame.
    pub fn learn_frame(&mut self, cost: Cost, elapsed: Duration) {
        if self.seconds(cost) > 0.0 {
            self.frame = Some((cost, elapsed.as_secs_f64()));
        }
    }

    fn seconds_of_evaluations(&self, cost: Cost) -> f64 {
        cost.interpreter * self.interpreter + cost.straight_line * self.straight_line
    }

    /// Cost of one kind of work that is expected to take this time.
    pub fn cost_in(&self, time: Duration, straight_line: bool) -> f64 {
        time.as_secs_f64() / if straight_line { self.straight_line } else { self.interpreter }
    }

    /// Learns from a measurement. A slower result counts at once, a faster one gradually.
    pub fn learn(&mut self, cost: Cost, elapsed: Duration) {
        let expected = self.seconds_of_evaluations(cost);
        let elapsed = elapsed.as_secs_f64() - cost.dispatches * self.dispatch;
        // Below this the submission dominates the measurement. It then gives only an upper bound for the work.
        let elapsed = elapsed.max(LEAST_MEASURED);
        if expected <= 0.0 || (elapsed <= LEAST_MEASURED && expected <= elapsed) {
            return;
        }
        // A driver that compiles, or a busy machine, occasionally makes a dispatch ten times as slow.
        let ratio = (elapsed / expected).clamp(0.05, 4.0);
        let gain = if ratio > 1.0 { 0.6 } else { 0.3 };
        let of_straight_line = cost.straight_line * self.straight_line / expected;
        self.straight_line *= 1.0 + (ratio - 1.0) * gain * of_straight_line;
        self.interpreter *= 1.0 + (ratio - 1.0) * gain * (1.0 - of_straight_line);
    }
}

/// Largest side of a coarse pixel, in pixels of the full picture.
const COARSEST: f64 = 8.0;

/// Size of a picture that fits into `time`, when a picture of `size` takes `full`. Never less than an eighth of each
/// side. Successive sizes differ by a factor of two in time, so that a drag does not create new targets for each of its
/// pictures.
pub fn coarse_size(size: [u32; 2], full: Duration, time: Duration) -> [u32; 2] {
    let halvings = (full.as_secs_f64() / time.as_secs_f64().max(1e-9)).log2().ceil();
    let factor = (0.5 * halvings).exp2().clamp(1.0, COARSEST);
    size.map(|side| ((f64::from(side) / factor).ceil() as u32).max(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cost_model_follows_what_is_measured() {
        let mut cost_model = CostModel::new(true);
        let cost = Cost { interpreter: 1e6, straight_line: 1e7, dispatches: 10.0 };
        for _ in 0..60 {
            cost_model.learn(cost, Duration::from_millis(100));
        }
        let expected = cost_model.seconds(cost);
        assert!((expected - 0.1).abs() < 0.01, "{expected}");
        // A time below the measurable minimum only says that the work takes no longer than that.
        for _ in 0..60 {
            cost_model.learn(cost, Duration::from_micros(30));
        }
        let expected = cost_model.seconds_of_evaluations(cost);
        assert!((expected - LEAST_MEASURED).abs() < 0.1 * LEAST_MEASURED, "{expected}");
    }

    #[test]
    fn a_frame_is_compared_with_the_last_one() {
        let mut cost_model = CostModel::new(true);
        let cost = Cost { interpreter: 1e6, straight_line: 1e7, dispatches: 10.0 };
        assert_eq!(cost_model.seconds_of_frame(cost), cost_model.seconds(cost));
        cost_model.learn_frame(cost, Duration::from_millis(7));
        // A slow dispatch shortens the next dispatches, but never lengthens the expected frame.
        cost_model.learn(cost, Duration::from_millis(900));
        assert!((cost_model.seconds_of_frame(cost) - 0.007).abs() < 1e-12 && cost_model.seconds(cost) > 0.1);
        assert!((cost_model.seconds_of_frame(cost + cost) - 0.014).abs() < 1e-12);
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
