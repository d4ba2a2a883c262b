//! What is done to the selection, along which axes, in which tool.

/// What is done to the selection.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TransformKind {
    /// Changes the position.
    #[default]
    Move,
    /// Turns around the pivot.
    Rotate,
    /// Changes the size.
    Scale,
}

impl TransformKind {
    /// Every kind.
    pub const ALL: [Self; 3] = [Self::Move, Self::Rotate, Self::Scale];

    /// Display name.
    pub fn label(self) -> &'static str {
        match self {
            Self::Move => "Move",
            Self::Rotate => "Rotate",
            Self::Scale => "Scale",
        }
    }

    /// What cannot be done to a locked node.
    pub fn done(self) -> &'static str {
        match self {
            Self::Move => "moved",
            Self::Rotate => "rotated",
            Self::Scale => "scaled",
        }
    }
}

/// What the gizmo in the viewport does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tool {
    /// There is no gizmo.
    Select,
    /// It moves, rotates or scales.
    Transform(TransformKind),
    /// There is none: a drag draws a new shape.
    Draw,
}

impl Tool {
    /// Every tool, in the order of the bar.
    pub const ALL: [Self; 5] = [
        Self::Select,
        Self::Transform(TransformKind::Move),
        Self::Transform(TransformKind::Rotate),
        Self::Transform(TransformKind::Scale),
        Self::Draw,
    ];

    /// Display name.
    pub fn label(self) -> &'static str {
        match self {
            Self::Select => "Select tool",
            Self::Transform(TransformKind::Move) => "Move tool",
            Self::Transform(TransformKind::Rotate) => "Rotate tool",
            Self::Transform(TransformKind::Scale) => "Scale tool",
            Self::Draw => "Draw tool",
        }
    }

    /// The help text.
    pub fn help(self) -> &'static str {
        match self {
            Self::Select => "The selection has no gizmo",
            Self::Transform(TransformKind::Move) => "Arrows along the axes, squares in their planes",
            Self::Transform(TransformKind::Rotate) => "Rings around the axes, and one around the view",
            Self::Transform(TransformKind::Scale) => "Cubes along the axes; the one in the middle for all",
            Self::Draw => "A drag draws a shape: from a side its outline, else its size on the ground or on a surface",
        }
    }
}

/// The axes of a transform.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Orientation {
    /// Those of the world.
    #[default]
    World,
    /// Those of the active node.
    Local,
    /// Those of its group.
    Parent,
    /// Those of the screen.
    View,
}

impl Orientation {
    /// Every orientation, in the order of the menu.
    pub const ALL: [Self; 4] = [Self::World, Self::Local, Self::Parent, Self::View];

    /// Display name.
    pub fn label(self) -> &'static str {
        match self {
            Self::World => "World",
            Self::Local => "Local",
            Self::Parent => "Parent",
            Self::View => "View",
        }
    }

    /// The help text.
    pub fn help(self) -> &'static str {
        match self {
            Self::World => "Along the axes of the world",
            Self::Local => "Along the axes of the active node",
            Self::Parent => "Along the axes of the active node's group",
            Self::View => "Along the sides of the screen, and into it",
        }
    }
}

/// The point around which the selection turns and scales.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PivotPoint {
    /// The mean of the origins of the selected nodes.
    #[default]
    Median,
    /// The origin of each node for itself.
    Individual,
    /// The origin of the active node.
    Active,
    /// The origin of the world.
    World,
}

impl PivotPoint {
    /// Every pivot, in the order of the menu.
    pub const ALL: [Self; 4] = [Self::Median, Self::Individual, Self::Active, Self::World];

    /// Display name.
    pub fn label(self) -> &'static str {
        match self {
            Self::Median => "Median",
            Self::Individual => "Individual origins",
            Self::Active => "Active node",
            Self::World => "World origin",
        }
    }

    /// The help text.
    pub fn help(self) -> &'static str {
        match self {
            Self::Median => "Turns and scales around the middle of all selected origins",
            Self::Individual => "Turns and scales each node around its own origin",
            Self::Active => "Turns and scales around the origin of the active node",
            Self::World => "Turns and scales around the origin of the world",
        }
    }
}

/// What a transform is limited to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Constraint {
    /// Nothing: the plane that faces the eye, the axis toward it, all axes alike.
    #[default]
    Free,
    /// One axis.
    Axis(usize),
    /// The plane across an axis.
    Plane(usize),
}

impl Constraint {
    /// Its axes in letters.
    pub fn letters(self) -> &'static str {
        match self {
            Self::Free => "",
            Self::Axis(axis) => ["X", "Y", "Z"][axis.min(2)],
            Self::Plane(axis) => ["YZ", "XZ", "XY"][axis.min(2)],
        }
    }
}
