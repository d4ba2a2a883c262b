//! Dynamics: motion as a function of time, copy, position and component. On an object or a group they move the node;
//! on an instancer each copy for itself. The table below is the only list of them.
//!
//! To add one: an entry here, `dynamic_name` in `field/copies/dynamics.rs` with its envelope, and its counterpart in
//! `shaders/copy/dynamics.wgsl`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Limits;
use super::limits::{AMPLITUDE, ANGLE, FREQUENCY, POSITION, SPACING, SPEED, UNIT};
use super::params::{param_kinds, slot_params};

/// Most dynamics of one node.
pub const MAX_DYNAMICS: usize = 8;

param_kinds! {
    /// A motion with its parameters, in the space of the node's parent, or of the instancer.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
    pub enum Dynamic;

    /// The kind of a motion, without its parameters. The number is the code that the GPU reads.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
    #[repr(u32)]
    pub enum DynamicKind;

    /// Bends in the wind, about its root. Gusts travel with the wind and never blow against it.
    Wind = "Wind" {
        /// Where to the wind blows; its height is ignored.
        direction: [f64; 3] = [1.0, 0.0, 0.0], POSITION.labeled("Direction");
        /// Greatest tilt, in the strongest gust.
        angle: f64 = 20.0, TILT;
        /// Share of the tilt that is always there; the rest comes and goes with the gusts.
        steady: f64 = 0.3, UNIT;
        /// From one gust to the next.
        gust_size: f64 = 8.0, SPACING;
        /// How fast gusts travel.
        speed: f64 = 4.0, SPEED;
        /// How little the stiffest copies give way: 0 none at all, 1 as far as the softest.
        softness: f64 = 0.6, UNIT;
        /// Tilt by which it quivers besides, across the wind and along it.
        flutter: f64 = 2.0, TILT;
        /// How often it quivers.
        frequency: f64 = 1.5, FREQUENCY;
        /// Distance from the source within which the wind blows; 0 is wind everywhere.
        radius: f64 = 0.0, SPACING_OR_NONE;
        /// Where the source is placed.
        #[serde(default)]
        source: [f64; 3] = [0.0; 3], POSITION;
        /// Share of the radius up to which the wind has its full strength; from there on it falls off to nothing.
        #[serde(default)]
        core: f64 = 0.0, CORE;
        /// How far it blows away from the source instead of in its direction: 0 is along it, 1 outward on all sides.
        #[serde(default)]
        radial: f64 = 0.0, UNIT;
    }
    /// Swings about an axis through its origin.
    Sway = "Sway" {
        /// The axis.
        axis: [f64; 3] = [0.0, 0.0, 1.0], POSITION.labeled("Axis");
        /// How far to either side.
        angle: f64 = 10.0, ANGLE;
        /// How often.
        frequency: f64 = 0.5, FREQUENCY;
        /// Where in the swing it starts.
        phase: f64 = 0.0, ANGLE;
        /// How much copies differ in their phase: 0 not at all, 1 by up to a whole swing.
        spread: f64 = 1.0, UNIT;
    }
    /// Goes up and down.
    Bob = "Bob" {
        /// How far to either side, and in which direction.
        amplitude: [f64; 3] = [0.0, 0.2, 0.0], POSITION.labeled("Amplitude");
        /// How often.
        frequency: f64 = 0.5, FREQUENCY;
        /// Where in the motion it starts.
        phase: f64 = 0.0, ANGLE;
        /// How much copies differ in their phase: 0 not at all, 1 by up to a whole period.
        spread: f64 = 1.0, UNIT;
    }
    /// Circles around its place without turning.
    Orbit = "Orbit" {
        /// The axis.
        axis: [f64; 3] = [0.0, 1.0, 0.0], POSITION.labeled("Axis");
        /// Of the circle.
        radius: f64 = 0.5, AMPLITUDE;
        /// Turns per second; negative is the other way round.
        frequency: f64 = 0.2, FREQUENCY;
        /// Where on the circle it starts.
        phase: f64 = 0.0, ANGLE;
        /// How much copies differ in their phase: 0 not at all, 1 by up to a whole turn.
        spread: f64 = 1.0, UNIT;
    }
    /// Grows and shrinks.
    Pulse = "Pulse" {
        /// By which share of its size to either side.
        amplitude: f64 = 0.2, PULSE;
        /// How often.
        frequency: f64 = 0.5, FREQUENCY;
        /// Where in the motion it starts.
        phase: f64 = 0.0, ANGLE;
        /// How much copies differ in their phase: 0 not at all, 1 by up to a whole period.
        spread: f64 = 1.0, UNIT;
    }
    /// Turns about an axis through its origin.
    Spin = "Spin" {
        /// The axis.
        axis: [f64; 3] = [0.0, 1.0, 0.0], POSITION.labeled("Axis");
        /// Turns per second; negative is the other way round.
        frequency: f64 = 0.2, FREQUENCY;
        /// Where it starts.
        phase: f64 = 0.0, ANGLE;
        /// How much copies differ in their phase: 0 not at all, 1 by up to a whole turn.
        spread: f64 = 1.0, UNIT;
    }
    /// The light that it emits goes down at random.
    Flicker = "Flicker" {
        /// By which share at most.
        amplitude: f64 = 0.8, UNIT;
        /// How often.
        frequency: f64 = 8.0, FREQUENCY;
    }
    /// Its base color goes round the hues.
    ColorCycle = "Color cycle" {
        /// Rounds per second.
        frequency: f64 = 0.1, FREQUENCY;
        /// Where it starts.
        phase: f64 = 0.0, ANGLE;
        /// How much copies differ in their phase: 0 not at all, 1 by up to a whole round.
        spread: f64 = 1.0, UNIT;
    }
    /// Wanders about its place, smoothly and at random.
    RandomWalk = "Random walk" {
        /// How far at most along each axis.
        amplitude: [f64; 3] = [0.3, 0.3, 0.3], POSITION.labeled("Amplitude");
        /// New directions per second.
        frequency: f64 = 0.5, FREQUENCY;
    }
    /// The same with finer and finer motion, half as wide and twice as fast from layer to layer.
    FractionalBrownianMotion = "Fractional Brownian motion" {
        /// How far at most along each axis.
        amplitude: [f64; 3] = [0.3, 0.3, 0.3], POSITION.labeled("Amplitude");
        /// New directions of the widest layer per second.
        frequency: f64 = 0.5, FREQUENCY;
        /// How many layers.
        octaves: u32 = 4, LAYERS;
    }
    /// Drifts with a flow that has no sources: neighbors move alike, as leaves on a stream.
    CurlNoise = "Curl noise" {
        /// How far at most along each axis.
        amplitude: [f64; 3] = [0.4, 0.4, 0.4], POSITION.labeled("Amplitude");
        /// Size of the eddies.
        size: f64 = 3.0, SPACING;
        /// How fast the flow changes.
        frequency: f64 = 0.3, FREQUENCY;
    }
}

/// Tilts by wind.
const TILT: Limits = Limits::new([0.0, 45.0], [0.0, 80.0], "°");
/// Shares of a radius without falloff.
const CORE: Limits = Limits::new([0.0, 0.95], [0.0, 0.95], "");
/// Shares of the size by which something pulses.
const PULSE: Limits = Limits::new([0.0, 0.5], [0.0, 0.99], "");
/// Layers of noise over time.
const LAYERS: Limits = Limits::new([1.0, 6.0], [1.0, 8.0], "").whole();
/// A distance, or 0 for none.
const SPACING_OR_NONE: Limits = Limits::new([0.0, 20.0], [0.0, 1e6], "m");

impl DynamicKind {
    /// The motion with its default parameters.
    pub fn default_dynamic(self) -> Dynamic {
        self.with_defaults()
    }
}

/// A motion in a node's list.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DynamicSlot {
    /// Whether it does anything.
    #[serde(default = "yes", skip_serializing_if = "is_true")]
    pub enabled: bool,
    /// What it does.
    pub dynamic: Dynamic,
}

impl From<Dynamic> for DynamicSlot {
    fn from(dynamic: Dynamic) -> Self {
        Self { enabled: true, dynamic }
    }
}

slot_params!(DynamicSlot, dynamic, {
    /// Whether it does anything.
    enabled: bool = true;
});

fn yes() -> bool {
    true
}

fn is_true(value: &bool) -> bool {
    *value
}
