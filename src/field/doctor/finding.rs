//! What the doctor finds, what it means, and what repairs it.

use glam::DVec3;

use isolith_scene::NodeId;

/// Most findings of one kind: a list of thousands helps nobody.
pub const MAX_FINDINGS: usize = 200;

/// What is wrong with a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum FindingKind {
    /// The field is not a number somewhere, or not finite.
    NotFinite,
    /// The gradient of the field is longer than 1 somewhere.
    Steep,
    /// The field is larger than the distance to the surface somewhere.
    Overstep,
    /// The first operand of a group that needs it is hidden, and with it the whole result.
    HiddenFirst,
    /// A modifier or the flattener refused something.
    Refused,
    /// It has no surface.
    Empty,
    /// It cuts from something that it does not touch.
    CutsNothing,
    /// Its scale is very small, very large, or very uneven.
    ExtremeScale,
    /// Rays take far smaller steps because of it.
    SmallSteps,
    /// It takes a large share of all evaluations.
    Slow,
    /// A part of the solid that is not joined to the rest.
    LoosePart,
    /// A wall below the wanted thickness.
    ThinWall,
}

impl FindingKind {
    /// What it is called.
    pub fn title(self) -> &'static str {
        match self {
            Self::NotFinite => "Field is not finite",
            Self::Steep => "Field is too steep",
            Self::Overstep => "Field oversteps",
            Self::HiddenFirst => "Hidden first operand",
            Self::Refused => "Has no effect",
            Self::Empty => "Empty",
            Self::CutsNothing => "Cuts nothing",
            Self::ExtremeScale => "Extreme scale",
            Self::SmallSteps => "Small steps",
            Self::Slow => "Slow",
            Self::LoosePart => "Loose part",
            Self::ThinWall => "Thin wall",
        }
    }

    /// What it means, in plain words.
    pub fn meaning(self) -> &'static str {
        match self {
            Self::NotFinite => "Rays end anywhere near it: it may show holes, or speckles",
            Self::Steep => "Rays may jump through its surface: it may show holes, or vanish at grazing angles",
            Self::Overstep => "Rays may step over its surface: thin parts of it may be missing",
            Self::HiddenFirst => "Without its first operand there is nothing to cut from, so the whole group is hidden",
            Self::Refused => "It is drawn without what was refused",
            Self::Empty => "It leaves nothing to be seen, and what is intersected with it is gone, too",
            Self::CutsNothing => "It costs time in every picture and changes nothing in it",
            Self::ExtremeScale => "Distances lose their precision, and rays take small steps",
            Self::SmallSteps => "Every ray near it takes more steps, so that the picture takes longer",
            Self::Slow => "Most of the time of a picture goes to few nodes: simplify them first",
            Self::LoosePart => "A print would come out in pieces",
            Self::ThinWall => "A print may break there, or lack the wall",
        }
    }

    /// Whether the picture may be wrong, rather than slow or unprintable.
    pub fn is_grave(self) -> bool {
        self <= Self::Empty
    }
}

/// A change that repairs a finding.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Repair {
    /// Show a hidden node.
    Show(NodeId),
    /// Hide a node that does nothing.
    Hide(NodeId),
    /// Set the scale of a node to 1.
    ResetScale(NodeId),
    /// Delete a node that is nothing.
    Delete(NodeId),
}

impl Repair {
    /// What the button says.
    pub fn label(self) -> &'static str {
        match self {
            Self::Show(_) => "Show it",
            Self::Hide(_) => "Hide it",
            Self::ResetScale(_) => "Reset scale",
            Self::Delete(_) => "Delete it",
        }
    }
}

/// Something that is wrong with a node.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// The node.
    pub node: NodeId,
    /// What is wrong.
    pub kind: FindingKind,
    /// The figures, in words; may be empty.
    pub detail: String,
    /// Where in the world, if at one place.
    pub place: Option<DVec3>,
    /// What would repair it.
    pub repair: Option<Repair>,
}

/// What to look for besides faults of fields.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Checks {
    /// Walls thinner than this, in meters.
    pub wall: Option<f64>,
    /// Parts that are not joined to the rest.
    pub loose_parts: bool,
}
