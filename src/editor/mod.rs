//! The editor: the user interface. It names egui only; the picture comes from outside as a texture, and its inputs
//! go out as a [`ViewSettings`] and a flat scene.
//!
//! State below, shell above: a panel gets the state and never calls another panel. Files import each other by file,
//! without circles: types stand below the code that uses them.
//!
//! | file | purpose |
//! |---|---|
//! | `state`, `edit_session`, `view_state` | document with gestures (one drag, one undo step), messages, view |
//! | `panel`, `panels`, `shell` | the trait, the list and the layout of panels |
//! | `root` | the editor: state, shell, and the windows in front |
//! | `commands/` | one table of all commands: menus, toolbar, shortcuts, command palette |
//! | `outliner`, `materials`, `inspector*`, `toolbar`, `status`, `viewport` | the panels |
//! | `material_library`, `thumbnails`, `material_edits`, `preset_picker` | the materials: counts, balls, changes, presets |
//! | `multi_edit`, `widgets`, `numbers`, `color_picker` | fields bound to the selected nodes, and their widgets |
//! | `inspector_params`, `slot_list` | a row for any parameter, and lists of modifiers, dynamics and masks, from their tables |
//! | `instancing`, `instancer_edits`, `seeds` | instancers: shares, counts and problems; commands |
//! | `navigation`, `projection`, `gizmo`, `*overlay` | the camera, the handles and the marks over the picture |
//! | `shading_bar` | the choice of the shading, over the picture |
//! | `legend` | the meaning of the colors of a view mode |
//! | `dialogs`, `dialog_views`, `portal`, `command_palette`, `messages` | the windows in front |
//! | `documents`, `document_jobs`, `choosing` | opening, saving and quitting by jobs; paths of files |
//! | `file_jobs` | files to store in nodes, and the list of recent files |
//! | `input_order` | events in the order of their arrival, however slow the frames are |
//! | `recovery`, `safekeeping` | copies of unsaved work, and their recovery |
//! | `conflict`, `file_watch` | conflicts with another program that changes the file |

mod bounds;
mod choosing;
mod color_picker;
mod command_palette;
mod commands;
mod conflict;
mod dialog_views;
mod dialogs;
mod document_jobs;
mod documents;
mod edit_session;
mod expression;
mod file_jobs;
mod file_watch;
mod framing;
mod gizmo;
mod icons;
mod input_order;
mod insertion;
mod inspector;
mod inspector_blends;
mod inspector_instancer;
mod inspector_kinds;
mod inspector_lists;
mod inspector_material;
mod inspector_palette;
mod inspector_params;
mod inspector_points;
mod inspector_scene;
mod inspector_transform;
mod inspector_types;
mod instancer_edits;
mod instancing;
mod intent;
mod lattice_overlay;
mod legend;
mod material_edits;
mod material_library;
mod materials;
mod messages;
mod multi_edit;
mod navigation;
mod node_picker;
mod numbers;
mod outliner;
mod overlay;
mod panel;
mod panels;
mod picking;
mod portal;
mod preset_picker;
mod projection;
mod recovery;
mod root;
mod safekeeping;
mod seeds;
mod selection;
mod shading_bar;
mod shape_change;
mod shape_icons;
mod shell;
mod slot_list;
mod state;
mod status;
mod theme;
mod thumbnails;
mod toolbar;
mod view_state;
mod viewport;
mod widgets;

pub use commands::command::Command;
pub use documents::new_document;
pub use messages::{Message, Severity};
pub use navigation::{Navigation, Side};
pub use root::Editor;
pub use state::Example;
pub use view_state::{Picture, ViewSettings};
