//! Every limit of a scene, by name. Files are checked against them when they are read, edits when they are applied.

/// The range that a value may have (`hard`) and the range that a slider offers (`soft`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Range offered when dragging.
    pub soft: [f64; 2],
    /// Range accepted when typing and in files; both ends included.
    pub hard: [f64; 2],
    /// Unit shown behind the number.
    pub unit: &'static str,
    /// The rule for valid numbers within the range.
    pub rule: Rule,
}

/// A rule for valid numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rule {
    /// All numbers.
    Any,
    /// Whole numbers only.
    Whole,
    /// Numbers whose magnitude is within the range, of either sign.
    Magnitude,
}

impl Limits {
    /// Any number within these ranges.
    pub const fn new(soft: [f64; 2], hard: [f64; 2], unit: &'static str) -> Self {
        Self { soft, hard, unit, rule: Rule::Any }
    }

    /// The same limits for whole numbers.
    pub const fn whole(self) -> Self {
        Self { rule: Rule::Whole, ..self }
    }

    /// The same limits for the magnitude of numbers of either sign.
    pub const fn magnitude(self) -> Self {
        Self { rule: Rule::Magnitude, ..self }
    }

    /// Whether the value is finite and within the hard range.
    pub fn accept(&self, value: f64) -> bool {
        let value = if self.rule == Rule::Magnitude { value.abs() } else { value };
        value.is_finite() && value >= self.hard[0] && value <= self.hard[1]
    }

    /// Whether only whole numbers are valid.
    pub fn is_whole(&self) -> bool {
        self.rule == Rule::Whole
    }

    /// The hard range with its sign: that of a magnitude extends to both sides of 0.
    pub fn signed_range(&self) -> [f64; 2] {
        let [least, most] = self.hard;
        if self.rule == Rule::Magnitude { [-most, most] } else { [least, most] }
    }
}

/// For parameters that are not numbers.
pub const NO_LIMITS: Limits = Limits::new([0.0, 1.0], [f64::MIN, f64::MAX], "");

/// Most nodes in a scene.
pub const MAX_NODES: usize = 100_000;
/// Deepest nesting of nodes.
pub const MAX_DEPTH: usize = 1_024;
/// Most materials in a scene.
pub const MAX_MATERIALS: usize = 10_000;
/// Greatest id of a node or material: every JSON reader keeps integers up to here exactly.
pub const MAX_ID: u64 = (1 << 53) - 1;
/// Longest path of a mesh file, in characters.
pub const MAX_PATH: usize = 1_024;
/// Longest name, in characters.
pub const MAX_NAME: usize = 256;
/// Largest scene file in bytes.
pub const MAX_FILE_BYTES: u64 = 256 << 20;
/// Most values in one node, material or other entry of a file: numbers, texts, and the lists and objects around them.
/// The largest node within all other limits has some 10 000.
pub const MAX_ENTRY_VALUES: usize = 65_536;

/// Fewest and most points of a curve.
pub const POINTS: [usize; 2] = [2, 256];
/// Fewest and most corners of a profile.
pub const CORNERS: [usize; 2] = [3, 256];

/// Most files that are packed into a scene.
pub const MAX_PACKED_FILES: usize = 1_000;
/// Most bytes of the files that are packed into a scene, together. Their text takes a third more, and recovery writes it
/// every few seconds.
pub const MAX_PACKED_BYTES: usize = 64 << 20;

/// Largest file embedded in the scene, in bytes.
pub const MAX_ATTACHMENT_BYTES: usize = 16 << 20;
/// Greatest width and height of an image, in pixels.
pub const MAX_IMAGE_SIDE: u32 = 8_192;
/// Most bytes of an image's pixels while it is decoded.
pub const MAX_IMAGE_BYTES: u64 = 512 << 20;
/// Most pixels of all images of a scene together, each file counted once: decoding so many takes seconds.
pub const MAX_SCENE_PIXELS: u64 = 1 << 27;
/// Most columns of the image of an environment; larger images are reduced.
pub const MAX_ENVIRONMENT_WIDTH: usize = 1_024;
/// Greatest radiance of the image of an environment; brighter pixels are clamped.
pub const MAX_RADIANCE: f32 = 60_000.0;
/// Most heights along a side of a grid; larger images are reduced.
pub const MAX_HEIGHTS: usize = 256;

/// Longest text, in letters.
pub const MAX_TEXT: usize = 64;
/// Length of a text, in letters.
pub const LETTERS: Limits = Limits::new([0.0, MAX_TEXT as f64], [0.0, MAX_TEXT as f64], "").whole();
/// Length of the path of a file, in letters.
pub const PATH_LENGTH: Limits = Limits::new([1.0, MAX_PATH as f64], [1.0, MAX_PATH as f64], "").whole();

/// Characters of the name of an animation clip.
pub const CLIP_NAME_LENGTH: Limits = Limits::new([0.0, MAX_NAME as f64], [0.0, MAX_NAME as f64], "").whole();
/// The same where there may be none.
pub const OPTIONAL_PATH_LENGTH: Limits = Limits::new([0.0, MAX_PATH as f64], [0.0, MAX_PATH as f64], "").whole();
/// Voxels along the longest side of a model; 0 leaves the choice to the model.
pub const VOXELS: Limits = Limits::new([0.0, 512.0], [0.0, isolith_bricks::RESOLUTIONS[1] as f64], "").whole();
/// Voxels along the longest side of a baked group; 0 does not bake it.
pub const BAKED_VOXELS: Limits = VOXELS;
/// Size of a voxel of a model; 0 for none.
pub const VOXEL_SIZE: Limits = Limits::new([0.0, 0.05], [0.0, 1e3], "m");
/// Times within an animation clip.
pub const CLIP_TIME: Limits = Limits::new([0.0, 10.0], [-1e6, 1e6], "s");
/// Speeds of animation clips.
pub const CLIP_SPEED: Limits = Limits::new([0.0, 2.0], [-1e3, 1e3], "");

/// Most animated parameters of a scene.
pub const MAX_TRACKS: usize = 10_000;
/// Most keys of one parameter.
pub const MAX_TRACK_KEYS: usize = 4_096;
/// Most keys of a scene.
pub const MAX_KEYS: usize = 1 << 18;
/// The moment of a key, and the ends of the timeline.
pub const KEY_TIME: Limits = Limits::new([0.0, 60.0], [-1e7, 1e7], "s");
/// Frames per second of a timeline.
pub const FRAMES_PER_SECOND: Limits = Limits::new([1.0, 120.0], [0.01, 1e4], "");

/// Radii, heights, edge lengths.
pub const SIZE: Limits = Limits::new([0.0, 5.0], [0.0, 1e6], "m");
/// Thicknesses and roundings.
pub const THICKNESS: Limits = Limits::new([0.0, 1.0], [0.0, 1e6], "m");
/// Coordinates.
pub const POSITION: Limits = Limits::new([-10.0, 10.0], [-1e9, 1e9], "m");
/// Magnitude of a scale factor; its sign is free, zero is refused.
pub const SCALE: Limits = Limits::new([0.01, 10.0], [1e-6, 1e6], "").magnitude();
/// Length of a wave or size of a hill.
pub const WAVELENGTH: Limits = Limits::new([0.1, 10.0], [1e-2, 1e6], "m");
/// Layers of noise, and numbers of waves; whole numbers.
pub const OCTAVES: Limits = Limits::new([1.0, 10.0], [1.0, 10.0], "").whole();
/// Seeds of random numbers; whole numbers.
pub const SEED: Limits = Limits::new([0.0, 100.0], [0.0, 1e6], "").whole();
/// Angles.
pub const TURN: Limits = Limits::new([-180.0, 180.0], [-3600.0, 3600.0], "°");
/// Blend radius.
pub const BLEND_RADIUS: Limits = Limits::new([0.0, 1.0], [0.0, 1e6], "m");
/// Steps and columns of a blend.
pub const STEPS: Limits = Limits::new([1.0, 12.0], [1.0, 64.0], "").whole();
/// Most siblings that a node may exclude from blending.
pub const MAX_APART: usize = 64;
/// Weights and reflectances.
pub const UNIT: Limits = Limits::new([0.0, 1.0], [0.0, 1.0], "");
/// Strength of a specular reflection; above 1 a dielectric reflects more than its index of refraction says.
pub const SPECULAR: Limits = Limits::new([0.0, 1.0], [0.0, 1e6], "");
/// Light intensities and emitted colors.
pub const INTENSITY: Limits = Limits::new([0.0, 10.0], [0.0, 1e6], "");
/// Irradiance of a sun.
pub const IRRADIANCE: Limits = Limits::new([0.0, 10.0], [0.0, 1e9], "W/m²");
/// Power of a light.
pub const LIGHT_POWER: Limits = Limits::new([0.0, 1e3], [0.0, 1e9], "W");
/// Angular diameter of a sun, in degrees.
pub const SUN_ANGLE: Limits = Limits::new([0.0, 30.0], [0.0, 90.0], "°");
/// Factor on the colors of an environment's image.
pub const ENVIRONMENT_STRENGTH: Limits = Limits::new([0.0, 4.0], [0.0, 1e4], "");
/// Radius of a light.
pub const LIGHT_RADIUS: Limits = Limits::new([0.0, 1.0], [0.0, 1e6], "m");
/// Sides of a light that is a rectangle.
pub const LIGHT_SIDE: Limits = Limits::new([0.1, 5.0], [1e-3, 1e6], "m");
/// Index of refraction.
pub const IOR: Limits = Limits::new([1.0, 3.0], [1.0, 100.0], "");
/// Strength of emitted light.
pub const LUMINANCE: Limits = Limits::new([0.0, 20.0], [0.0, 1e6], "");
/// Exposure of a picture.
pub const EXPOSURE: Limits = Limits::new([-5.0, 5.0], [-20.0, 20.0], "stops");
/// Blinn-Phong exponent.
pub const SHININESS: Limits = Limits::new([1.0, 256.0], [1.0, 1e4], "");
/// Reach of a point or spot light.
pub const RANGE: Limits = Limits::new([0.1, 100.0], [1e-3, 1e9], "m");
/// Quality of shadows: low, middle, high.
pub const SHADOW_QUALITY: Limits = Limits::new([1.0, 3.0], [1.0, 3.0], "").whole();
/// Reach of occlusion.
pub const OCCLUSION_RADIUS: Limits = Limits::new([0.05, 5.0], [1e-3, 1e4], "m");
/// Attenuation coefficients.
pub const ATTENUATION: Limits = Limits::new([0.0, 2.0], [0.0, 1e6], "");
/// Half angle of a spot light's cone, in degrees.
pub const CONE: Limits = Limits::new([0.0, 89.0], [0.0, 89.9], "°");
/// Half of an arc, in degrees.
pub const ARC: Limits = Limits::new([0.0, 180.0], [0.0, 180.0], "°");
/// Half angle of a part of a ball, in degrees: less than the whole ball, whose sides would meet.
pub const SECTOR: Limits = Limits::new([0.0, 179.0], [0.0, 179.9], "°");
/// Sides of a polygon, points of a star.
pub const SIDES: Limits = Limits::new([3.0, 12.0], [3.0, 64.0], "").whole();
/// Iterations of a fractal.
pub const ITERATIONS: Limits = Limits::new([0.0, 5.0], [0.0, 8.0], "").whole();
/// The power of a Mandelbulb; a whole number.
pub const POWER: Limits = Limits::new([2.0, 12.0], [2.0, 16.0], "").whole();
/// Iterations of a Julia set and of a Mandelbulb.
pub const SQUARES: Limits = Limits::new([0.0, 10.0], [0.0, 16.0], "").whole();
/// Each number of a Julia set's constant.
pub const CONSTANT: Limits = Limits::new([-1.0, 1.0], [-2.0, 2.0], "");
/// Sizes of a Kleinian set, in its own unit.
pub const FOLD: Limits = Limits::new([0.0, 1.5], [0.0, 10.0], "");
/// Size of the visible part of a Kleinian set, in its own unit.
pub const REACH: Limits = Limits::new([0.5, 4.0], [0.1, 10.0], "");
/// Vertical angle of view, in degrees.
pub const FOV: Limits = Limits::new([10.0, 120.0], [0.1, 170.0], "°");
/// Diameter of the opening of a lens.
pub const APERTURE: Limits = Limits::new([0.0, 0.1], [0.0, 100.0], "m");
/// Place of a part of the scene in the order of marching.
pub const MARCH_ORDER: Limits = Limits::new([0.0, 10.0], [0.0, 1_000.0], "").whole();
/// Distance from the eye at which a part of the scene begins or ends; 0 for none.
pub const CUT_OFF: Limits = Limits::new([0.0, 1e3], [0.0, 1e9], "m");
/// How exactly rays find a surface, in relation to the usual.
pub const PRECISION: Limits = Limits::new([0.1, 1.0], [0.01, 10.0], "");
/// Most steps of a ray through a part of the scene; 0 for no limit.
pub const MARCH_STEPS: Limits = Limits::new([0.0, 256.0], [0.0, 65_536.0], "").whole();
/// How long a shutter is open.
pub const SHUTTER: Limits = Limits::new([0.0, 0.2], [0.0, 60.0], "s");
/// Near and far limits of a camera.
pub const CLIP: Limits = Limits::new([1e-3, 1e4], [1e-6, 1e9], "m");
/// Distance from one copy to the next, and lengths of waves.
pub const SPACING: Limits = Limits::new([0.01, 5.0], [1e-6, 1e6], "m");
/// Numbers of copies.
pub const COPIES: Limits = Limits::new([0.0, 16.0], [0.0, 1e6], "").whole();
/// Angles in degrees.
pub const ANGLE: Limits = Limits::new([-180.0, 180.0], [-1e4, 1e4], "°");
/// Angles per length, in degrees per meter.
pub const CURVATURE: Limits = Limits::new([-360.0, 360.0], [-3.6e4, 3.6e4], "°/m");
/// Change of width per meter of height.
pub const TAPER: Limits = Limits::new([-1.0, 1.0], [-1e3, 1e3], "/m");
/// Greatest distance by which a displacement moves the surface.
pub const AMPLITUDE: Limits = Limits::new([0.0, 0.5], [0.0, 1e6], "m");
/// The same, outward or inward.
pub const DISPLACEMENT: Limits = Limits::new([-0.5, 0.5], [-1e6, 1e6], "m");
/// Width of a repeated tile.
pub const TILE: Limits = Limits::new([0.1, 5.0], [1e-4, 1e6], "m");
/// Tiles, images and patterns of a texture per tile.
pub const TEXTURE_SCALE: Limits = Limits::new([0.1, 32.0], [1e-3, 1e3], "");
/// Factor on the width of a texture's tile.
pub const STRETCH: Limits = Limits::new([0.1, 10.0], [1e-3, 1e3], "");
/// The power of the normal that weights projections.
pub const SHARPNESS: Limits = Limits::new([1.0, 64.0], [1.0, 1e3], "");
/// Height of what a texture embosses, outward or inward.
pub const BUMP: Limits = Limits::new([-0.1, 0.1], [-1e3, 1e3], "m");
/// Height of a row of bricks, in lengths of a brick.
pub const PATTERN_SHARE: Limits = Limits::new([0.1, 2.0], [0.01, 100.0], "");
/// How far a pattern wanders, in its own widths; factors on slopes.
pub const TURBULENCE: Limits = Limits::new([0.0, 2.0], [0.0, 100.0], "");
/// Most bytes of all images of textures on the device: beyond it, the largest are shown at half their size.
pub const MAX_TEXTURE_BYTES: usize = 127 << 20;
/// Periods per second; negative runs backward.
pub const FREQUENCY: Limits = Limits::new([0.0, 4.0], [-1e3, 1e3], "/s");
/// Speeds.
pub const SPEED: Limits = Limits::new([0.0, 20.0], [0.0, 1e4], "m/s");
/// How often a type is chosen, in relation to its siblings.
pub const WEIGHT: Limits = Limits::new([0.0, 4.0], [0.0, 1e6], "");
