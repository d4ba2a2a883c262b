//! Every limit of a scene, by name. Files are checked against them on the way in, edits on the way through.

/// The range a value may have (`hard`) and the range that a slider offers (`soft`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Range offered when dragging.
    pub soft: [f64; 2],
    /// Range accepted when typing and in files; both ends included.
    pub hard: [f64; 2],
    /// Unit shown behind the number.
    pub unit: &'static str,
}

impl Limits {
    /// Whether the value is finite and within the hard range.
    pub fn accept(&self, value: f64) -> bool {
        value.is_finite() && value >= self.hard[0] && value <= self.hard[1]
    }
}

/// Most nodes in a scene.
pub const MAX_NODES: usize = 100_000;
/// Deepest nesting of nodes.
pub const MAX_DEPTH: usize = 1_024;
/// Most materials in a scene.
pub const MAX_MATERIALS: usize = 10_000;
/// Greatest id of a node or material: every reader of JSON keeps integers up to here exactly.
pub const MAX_ID: u64 = (1 << 53) - 1;
/// Longest path of a mesh file, in characters.
pub const MAX_PATH: usize = 1_024;
/// Longest name, in characters.
pub const MAX_NAME: usize = 256;
/// Largest scene file in bytes.
pub const MAX_FILE_BYTES: u64 = 256 << 20;

/// Fewest and most points of a curve.
pub const POINTS: [usize; 2] = [2, 256];
/// Fewest and most corners of an outline.
pub const CORNERS: [usize; 2] = [3, 256];

/// Radii, heights, edge lengths.
pub const SIZE: Limits = Limits { soft: [0.0, 5.0], hard: [0.0, 1e6], unit: "m" };
/// Thicknesses and roundings.
pub const THICKNESS: Limits = Limits { soft: [0.0, 1.0], hard: [0.0, 1e6], unit: "m" };
/// Coordinates.
pub const POSITION: Limits = Limits { soft: [-10.0, 10.0], hard: [-1e9, 1e9], unit: "m" };
/// Magnitude of a scale factor; its sign is free, zero is refused.
pub const SCALE: Limits = Limits { soft: [0.01, 10.0], hard: [1e-6, 1e6], unit: "" };
/// Length of a wave or a hill.
pub const WAVELENGTH: Limits = Limits { soft: [0.1, 10.0], hard: [1e-2, 1e6], unit: "m" };
/// Layers of noise, and waves; whole numbers.
pub const OCTAVES: Limits = Limits { soft: [1.0, 10.0], hard: [1.0, 10.0], unit: "" };
/// Seeds of what is random; whole numbers.
pub const SEED: Limits = Limits { soft: [0.0, 100.0], hard: [0.0, 1e6], unit: "" };
/// Angles.
pub const TURN: Limits = Limits { soft: [-180.0, 180.0], hard: [-3600.0, 3600.0], unit: "°" };
/// What is counted or only on or off.
pub const COUNT: Limits = Limits { soft: [0.0, 1.0], hard: [0.0, 1.0], unit: "" };
/// Blend radius.
pub const BLEND_RADIUS: Limits = Limits { soft: [0.0, 1.0], hard: [0.0, 1e6], unit: "m" };
/// Shares and reflectances.
pub const UNIT: Limits = Limits { soft: [0.0, 1.0], hard: [0.0, 1.0], unit: "" };
/// Light intensities and emitted colours.
pub const INTENSITY: Limits = Limits { soft: [0.0, 10.0], hard: [0.0, 1e6], unit: "" };
/// Blinn-Phong exponent.
pub const SHININESS: Limits = Limits { soft: [1.0, 256.0], hard: [1.0, 1e4], unit: "" };
/// Reach of a point or spot light.
pub const RANGE: Limits = Limits { soft: [0.1, 100.0], hard: [1e-3, 1e9], unit: "m" };
/// Attenuation coefficients.
pub const ATTENUATION: Limits = Limits { soft: [0.0, 2.0], hard: [0.0, 1e6], unit: "" };
/// Half angle of a spot light's cone, in degrees.
pub const CONE: Limits = Limits { soft: [0.0, 89.0], hard: [0.0, 89.9], unit: "°" };
/// Vertical angle of view, in degrees.
pub const FOV: Limits = Limits { soft: [10.0, 120.0], hard: [0.1, 170.0], unit: "°" };
/// Near and far limits of a camera.
pub const CLIP: Limits = Limits { soft: [1e-3, 1e4], hard: [1e-6, 1e9], unit: "m" };
