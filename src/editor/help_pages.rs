//! Help pages: one for each panel, short enough to be read beside the work.

/// A page of help.
pub struct HelpPage {
    /// The id of its panel, or a name of its own.
    pub id: &'static str,
    /// Its title.
    pub title: &'static str,
    /// What the panel is for.
    pub purpose: &'static str,
    /// What one does in it: an action, and how.
    pub actions: &'static [(&'static str, &'static str)],
}

/// All pages, in the order of the list.
pub const PAGES: &[HelpPage] = &[
    HelpPage {
        id: "viewport",
        title: "Viewport",
        purpose: "The scene as it looks, and the place to build it. What is selected has an outline, a gizmo and dots \
                  for its sizes.",
        actions: &[
            ("Turn, move, come closer", "Drag; drag with Shift; wheel, or Alt and the right button"),
            ("Select", "Click: the outermost group, then what lies below it. Double click enters a group"),
            ("Select several", "Shift click, or drag a box with Ctrl"),
            ("Move, rotate, scale", "G, R, S; then X, Y, Z or a number; Enter keeps it, Esc takes it back"),
            ("Change sizes", "Drag the dots on a shape; with Alt both sides move"),
            (
                "Draw a shape",
                "P, choose it in the toolbar, drag; the wheel changes a bevel or an upper radius meanwhile",
            ),
            ("Snap, be precise", "Ctrl, Shift while dragging; the steps are in the bar at the left"),
            ("Look from a side", "1, 3, 7, with Ctrl from the other side; 5 for perspective or orthographic"),
            ("Fly", "Hold the right button: W, A, S, D, Q, E; the wheel changes the speed"),
            ("Keep a view, come back", "Shift F5 to F8, F5 to F8"),
            ("See several sides", "View › Split view: two or four; keys mean the one under the pointer"),
            ("Shade otherwise", "The buttons at the upper right, or Z"),
        ],
    },
    HelpPage {
        id: "outliner",
        title: "Outliner",
        purpose: "All nodes as a tree. The order counts: a group folds over its children from top to bottom, and what \
                  stands first is cut by what follows.",
        actions: &[
            ("Reorder, move into a group", "Drag a row"),
            ("Rename", "F2, or double click"),
            ("Hide, lock", "The signs at the right of a row, or H and L"),
            ("Group, ungroup", "Ctrl G, Ctrl Shift G"),
            ("Find by name", "Type into the search field"),
        ],
    },
    HelpPage {
        id: "inspector",
        title: "Inspector",
        purpose: "Everything about the selection: place, shape, blends, modifiers, dynamics and material. Without a \
                  selection, the scene: light around it, exposure, shadows.",
        actions: &[
            ("Change a number", "Drag it, or click and type; 3*2 works; Backspace resets it"),
            ("Change several nodes", "Select them: a dash stands where they differ"),
            ("Animate", "The diamond in the margin sets a key at the moment that is shown"),
            ("Order modifiers", "Drag their titles: they apply from top to bottom"),
        ],
    },
    HelpPage {
        id: "materials",
        title: "Materials",
        purpose: "The materials of the scene, each with a ball that shows it and how many nodes use it.",
        actions: &[
            ("Edit", "Click it: the inspector shows it"),
            ("Give it to something", "Drag it onto an object in the viewport, or press its bucket"),
            ("Start from a preset", "The buttons above the list"),
            ("Change only what is selected", "Make unique, in the inspector"),
        ],
    },
    HelpPage {
        id: "timeline",
        title: "Timeline",
        purpose: "Which moment is shown, and the keys of what is selected.",
        actions: &[
            ("Play, pause", "Space"),
            ("Show another moment", "Drag on the ruler, or type a frame"),
            ("Move keys, copy keys", "Drag them; drag with Ctrl"),
            ("Delete keys", "Del with the pointer over them"),
            ("Change what is between keys", "Interpolation, above the ruler"),
        ],
    },
    HelpPage {
        id: "toolbar",
        title: "Toolbar and menus",
        purpose: "Every command is in a menu; the most common ones and your favorite shapes have buttons.",
        actions: &[
            ("Find a command by its name", "F3"),
            ("Add something at the pointer", "Shift A"),
            ("Choose favorites", "The stars in the list of Shift A"),
            ("Undo, redo", "Ctrl Z, Ctrl Shift Z"),
        ],
    },
    HelpPage {
        id: "status",
        title: "Status bar",
        purpose: "What the mouse does now, what is being worked on, and what is wrong with the scene.",
        actions: &[
            ("Stop a long task", "Cancel, or Esc"),
            ("Stop drawing", "Stop: the picture stays as it is until something changes"),
            ("Find the node of a warning", "Click the warning"),
        ],
    },
    HelpPage {
        id: "log",
        title: "Log",
        purpose: "All messages so far: what fades in the corner stays here.",
        actions: &[("Open, close", "View › Log")],
    },
    HelpPage {
        id: "render",
        title: "Render dialog",
        purpose: "Pictures in files, while you go on working. They are those of the command that it shows.",
        actions: &[
            ("Render one picture or frames", "F12; Range for frames, with #### for their number"),
            ("Keep light for compositing", "OpenEXR, or OpenEXR with layers: depth, normal, node ids, albedo"),
            ("Cancel", "What is complete stays, and nothing is half written"),
        ],
    },
    HelpPage {
        id: "doctor",
        title: "Field doctor",
        purpose: "Finds nodes whose field is broken or slow, or which do nothing, and offers a repair where there is \
                  one. Cost shows what a picture takes.",
        actions: &[
            ("Look at the scene", "F10; it works beside you"),
            ("See a node", "Click its name: it is selected and framed"),
            ("Repair", "The button of a finding; one step of undo"),
            ("Check for a printer", "Loose parts, and walls below a thickness"),
        ],
    },
];
