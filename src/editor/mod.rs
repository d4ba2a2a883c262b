//! The editor: what the artist sees and does. Names egui only; the picture comes from outside as a
//! texture, and what it should show goes out as a [`ViewSettings`] and a flat scene.
//!
//! The state is below, the shell above: a panel is given the state and knows nothing of other panels. Files import each
//! other by file, and in no circle: types stand below what the editor does with them.
//!
//! | file | what it does |
//! |---|---|
//! | `state`, `edit_session`, `view_state` | what panels are given: the document with gestures (one drag, one undo step), messages, the view |
//! | `panel`, `panels`, `shell` | what a panel is, all of them, and which stands where |
//! | `root` | the editor: state, shell, and what comes up in front |
//! | `commands/` | one table of everything that can be ordered: menus, toolbar, shortcuts, command palette |
//! | `outliner`, `inspector*`, `toolbar`, `status`, `viewport` | the panels |
//! | `multi_edit`, `widgets`, `numbers`, `color_picker` | fields bound to the selected nodes, and the widgets they are made of |
//! | `inspector_params` | a row for any parameter, from its table |
//! | `navigation`, `projection`, `gizmo`, `overlay` | the camera, the handles and the marks over the picture |
//! | `legend` | what the colors of a picture mean that is not lit |
//! | `dialogs`, `dialog_views`, `portal`, `command_palette`, `messages` | what comes up in front |
//! | `documents`, `document_jobs`, `choosing` | opening, saving and quitting by jobs; paths of files |
//! | `file_jobs` | files that nodes keep, and the list of recent files |
//! | `input_order` | events in the order in which they came, however slow the frames are |
//! | `recovery`, `safekeeping` | unsaved work, kept beside the frames and offered again |
//! | `conflict`, `file_watch` | a file that another program has changed |

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
mod inspector_kinds;
mod inspector_material;
mod inspector_modifiers;
mod inspector_params;
mod inspector_points;
mod inspector_scene;
mod inspector_transform;
mod intent;
mod legend;
mod messages;
mod multi_edit;
mod navigation;
mod numbers;
mod outliner;
mod overlay;
mod panel;
mod panels;
mod picking;
mod portal;
mod projection;
mod recovery;
mod root;
mod safekeeping;
mod selection;
mod shape_change;
mod shape_icons;
mod shell;
mod state;
mod status;
mod theme;
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
