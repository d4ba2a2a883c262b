//! How much there is to do, and how fast the device is.

use std::time::Duration;

/// Cost, in evaluations of a leaf, by the kind of pipeline that makes them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cost {
    /// By interpreters and tapes, and everything else.
    pub interpreter: f64,
    /// By straight-line code.
    pub straight_line: f64,
    /// Dispatches, which take their time however little they do.
    pub dispatches: f64,
}

impl Cost {
    /// A dispatch of an amount of one kind.
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

/// How fast the device is, learned from what was measured.
#[derive(Clone, Copy, Debug)]
pub struct CostModel {
    interpreter: f64,
    straight_line: f64,
    /// Not learned: measured on lavapipe, which wakes its threads and waits for them; a guess for graphics cards.
    dispatch: f64,
    /// The last whole frame, and how many seconds it took.
    frame: Option<(Cost, f64)>,
}

/// Seconds.
const LEAST_MEASURED: f64 = 0.001;

impl CostModel {
    /// A first guess.
    pub fn new(software: bool) -> Self {
        if software {
            Self { interpreter: 4e-8, straight_line: 2e-9, dispatch: 25e-6, frame: None }
        } else {
            Self { interpreter: 5e-11, straight_line: 1e-11, dispatch: 3e-6, frame: None }
        }
    }

    /// Seconds that the cost is expected to take.
    pub fn seconds(&self, cost: Cost) -> f64 {
        cost.dispatches * self.dispatch + self.seconds_of_evaluations(cost)
    }

    /// Seconds that a whole frame of this cost is expected to take. What a dispatch is expected to take is wary, a sum of
    /// that would be several times too much: where a frame has been measured, that is what others are compared with.
    pub fn seconds_of_frame(&self, cost: Cost) -> f64 {
        let share = self.frame.map_or(1.0, |(measured, elapsed)| elapsed / self.seconds(measured));
        self.seconds(cost) * share
    }

    /// Learns what a whole frame took.
    pub fn learn_frame(&mut self, cost: Cost, elapsed: Duration) {
        if self.seconds(cost) > 0.0 {
            self.frame = Some((cost, elapsed.as_secs_f64()));
        }
    }

    fn seconds_of_evaluations(&self, cost: Cost) -> f64 {
        cost.interpreter * self.interpreter + cost.straight_line * self.straight_line
    }

    /// Cost of one kind that is expected to take this long.
    pub fn cost_in(&self, time: Duration, straight_line: bool) -> f64 {
        time.as_secs_f64() / if straight_line { self.straight_line } else { self.interpreter }
    }

    /// Learns from a measurement. Slower than expected counts at once, faster bit by bit.
    pub fn learn(&mut self, cost: Cost, elapsed: Duration) {
        let expected = self.seconds_of_evaluations(cost);
        let elapsed = elapsed.as_secs_f64() - cost.dispatches * self.dispatch;
        // Of less it is the submission that is measured, not the work: then all that is known is that it took no more.
        let elapsed = elapsed.max(LEAST_MEASURED);
        if expected <= 0.0 || (elapsed <= LEAST_MEASURED && expected <= elapsed) {
            return;
        }
        // A driver that compiles, or a machine that does something else, takes ten times as long once in a while.
        let ratio = (elapsed / expected).clamp(0.05, 4.0);
        let gain = if ratio > 1.0 { 0.6 } else { 0.3 };
        let of_straight_line = cost.straight_line * self.straight_line / expected;
        self.straight_line *= 1.0 + (ratio - 1.0) * gain * of_straight_line;
        self.interpreter *= 1.0 + (ratio - 1.0) * gain * (1.0 - of_straight_line);
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
    fn the_cost_model_follows_what_is_measured() {
        let mut cost_model = CostModel::new(true);
        let cost = Cost { interpreter: 1e6, straight_line: 1e7, dispatches: 10.0 };
        for _ in 0..60 {
            cost_model.learn(cost, Duration::from_millis(100));
        }
        let expected = cost_model.seconds(cost);
        assert!((expected - 0.1).abs() < 0.01, "{expected}");
        // What takes less than can be measured is known to take no more than that.
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
        // A slow dispatch makes dispatches shorter, and no frame longer.
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
