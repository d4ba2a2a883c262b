//! Options of the pipelines, and the tolerance of the march.

/// How code skips entries without influence.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum SkipMode {
    /// By `if`: cheap where the device skips a branch that no lane takes.
    #[default]
    Branches,
    /// No branches within straight-line code, which computes all values and selects. lavapipe executes the body of
    /// every `if` and the first iteration of every loop, and uniform reads within either cost 25 times as much.
    Selects,
    /// No skipping: every node at every step, as in the baselines of the benches.
    Never,
}

/// What rays may pass of a component.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Veil {
    /// Nothing.
    #[default]
    None,
    /// Surfaces whose materials say so.
    Plain,
    /// The same, and textures may say so.
    Textured,
}

/// Tolerance of the march at the surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Quality {
    /// A tenth of a pixel's footprint.
    Draft,
    /// A thousandth of the footprint.
    #[default]
    Default,
    /// A hundred-thousandth of the footprint.
    Fine,
}

impl Quality {
    /// All qualities.
    pub const ALL: [Self; 3] = [Self::Draft, Self::Default, Self::Fine];

    /// Its name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Draft => "draft",
            Self::Default => "default",
            Self::Fine => "fine",
        }
    }

    /// Tolerances of the march, relative to the default.
    pub(super) fn fineness(self) -> f32 {
        match self {
            Self::Draft => 100.0,
            Self::Default => 1.0,
            Self::Fine => 0.01,
        }
    }
}

/// Options of the pipelines: counting, and the algorithms in use.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Options {
    /// Whether they count steps and evaluations.
    pub counting: bool,
    /// How they skip entries out of reach.
    pub skip_mode: SkipMode,
    /// Whether the cone pass over tiles precedes the rays.
    pub cones: bool,
    /// Whether rays take steps longer than sphere tracing, where they expect empty space.
    pub relaxed: bool,
    /// Tolerance of the march at the surface.
    pub quality: Quality,
    /// Whether materials may have the layers of OpenPBR. Without them, shading knows Blinn and Phong only.
    pub layers: bool,
    /// Whether a light has a size.
    pub area_lights: bool,
    /// Whether the environment is not a gradient.
    pub image_lit: bool,
    /// Whether light is shadowed or occluded.
    pub shadowed: bool,
    /// Whether the components are types of instancers.
    pub copies: bool,
    /// What rays may pass of the components.
    pub veil: Veil,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            counting: false,
            skip_mode: SkipMode::default(),
            cones: true,
            relaxed: true,
            quality: Quality::default(),
            layers: true,
            area_lights: false,
            image_lit: false,
            shadowed: false,
            copies: false,
            veil: Veil::None,
        }
    }
}
