//! The timeline: which part of time is played.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::check::{self, Fault};
use crate::limits::{FRAMES_PER_SECOND, KEY_TIME, NO_LIMITS};
use crate::params::param_struct;

param_struct! {
    /// The part of time that the timeline plays, and how finely it counts.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(deny_unknown_fields, default)]
    pub struct Timeline {
        /// Frames per second of playback and of rendered pictures.
        frames_per_second: f64 = 24.0, FRAMES_PER_SECOND;
        /// The first moment that is played.
        start: f64 = 0.0, KEY_TIME;
        /// The last moment that is played.
        end: f64 = 10.0, KEY_TIME;
        /// Whether playback starts again at its end.
        is_looping: bool = true, NO_LIMITS.labeled("Loop");
    }
}

impl Timeline {
    /// The moment of a frame. Frame 0 is at 0 seconds.
    pub fn time_of(&self, frame: f64) -> f64 {
        frame / self.frames_per_second
    }

    /// The frame of a moment, with its fraction.
    pub fn frame_at(&self, time: f64) -> f64 {
        time * self.frames_per_second
    }

    /// The moment of the nearest whole frame.
    pub fn snapped(&self, time: f64) -> f64 {
        self.time_of(self.frame_at(time).round())
    }

    /// Checks every value.
    pub fn check(&self) -> Result<(), Fault> {
        check::values(self)?;
        match self.start < self.end {
            true => Ok(()),
            false => {
                let reason = format!("must be more than the start of {}, not {}", self.start, self.end);
                Err(Fault { field: "end".into(), reason })
            }
        }
    }
}
