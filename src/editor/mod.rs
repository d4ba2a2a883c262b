//! The editor: the user interface. It names egui only; the picture comes from outside as a texture, and its inputs
//! go out as a [`ViewSettings`] and a flat scene.
//!
//! State below, shell above: a panel gets the state and never calls another panel. Files import each other by file,
//! without circles: types stand below the code that uses them.
//!
//! | file | purpose |
//! |---|---|
//! | `state`, `edit_session`, `view_state` | document with gestures (one drag, one undo step), messages, view |
//! | `panel`, `panels` | the trait and the list of panels |
//! | `shell`, `dock`, `dock_tabs` | the layout of panels: bars, and rows and columns of tabs |
//! | `root` | the editor: state, shell, and the windows in front |
//! | `commands/` | one table of all commands: menus, toolbar, shortcuts, command palette |
//! | `outliner`, `materials`, `inspector*`, `toolbar`, `status`, `viewport`, `log_panel` | the panels |
//! | `material_library`, `thumbnails`, `material_edits`, `preset_picker` | the materials: counts, balls, changes, presets |
//! | `multi_edit`, `widgets`, `numbers`, `color_picker` | fields bound to the selected nodes, and their widgets |
//! | `inspector_params`, `slot_list` | a row for any parameter, and lists of modifiers, dynamics and masks, from their tables |
//! | `instancing`, `instancer_edits`, `seeds` | instancers: shares, counts and problems; commands |
//! | `navigation`, `projection`, `gizmo`, `*overlay` | the camera, the handles and the marks over the picture |
//! | `timeline`, `dope_sheet`, `time_scale` | the timeline with the keys of the selection |
//! | `playback`, `keying` | the clock of the timeline; marks and keys of parameters |
//! | `handles/` | the handles on the selected shape, light, camera or group, by a table |
//! | `viewport_click`, `viewport_drag`, `viewport_modal`, `viewport_surface` | clicks, drags and transforms in the picture |
//! | `transforms/` | moving, rotating and scaling, by the gizmo or by keys |
//! | `keymap` | which keys run the commands |
//! | `preferences_window`, `preferences_view`, `key_editor` | the window of the preferences, with the list of all keys |
//! | `palette`, `theme`, `appearance`, `units` | colors by role, style, what the preferences say about both, units |
//! | `choice_walk`, `below_list` | what a click selects, the list of what lies below |
//! | `selection`, `relations` | actions on the selection; selecting by relation, isolating, dropping |
//! | `clipboard`, `arrange`, `arrangement` | copy and paste between scenes; aligning, distributing, origins |
//! | `ghosts`, `hover` | lines on selected nodes that are cut away or hidden; the node under the pointer |
//! | `drag_in`, `dropped_files` | what is dragged into the picture, and files dropped on the window |
//! | `history_list` | all steps of undo |
//! | `add_palette`, `placement` | what can be added, and where it goes |
//! | `camera_view` | looking through a camera, its frame; bookmarks of views |
//! | `fly`, `grid_labels` | flying with the right button and keys; the measures of the grid |
//! | `node_warnings` | what is wrong with single nodes |
//! | `packing`, `bringing` | the files of models within the scene, and beside it again; models from elsewhere |
//! | `view_slots`, `side_views`, `side_viewport`, `dock_split` | several viewports: which one is active, its panel, layouts with them |
//! | `steps` | round numbers for what is dragged |
//! | `shading_bar` | the choice of the shading, over the picture |
//! | `legend` | the meaning of the colors of a view mode |
//! | `dialogs`, `dialog_views`, `portal`, `command_palette`, `messages` | the windows in front |
//! | `documents`, `document_jobs`, `choosing` | opening, saving and quitting by jobs; paths of files |
//! | `file_jobs` | files to store in nodes, and the list of recent files |
//! | `rendering`, `render_view` | the render dialog: settings, and the job that renders into files |
//! | `doctor`, `doctor_view` | the field doctor: jobs that examine and measure the scene, repairs, costs |
//! | `first_run`, `welcome`, `tour` | what helps at the start |
//! | `help`, `help_pages`, `changelog` | the help window: pages about panels, keys, what is new |
//! | `input_order` | events in the order of their arrival, however slow the frames are |
//! | `recovery`, `safekeeping` | copies of unsaved work, and their recovery |
//! | `conflict`, `file_watch` | conflicts with another program that changes the file |

mod add_palette;
mod appearance;
mod arrange;
mod arrangement;
mod below_list;
mod bounds;
mod bringing;
mod camera_view;
mod changelog;
mod choice_walk;
mod choosing;
mod clipboard;
mod color_picker;
mod command_palette;
mod commands;
mod conflict;
mod curve_editor;
mod dialog_views;
mod dialogs;
mod dock;
mod dock_split;
mod dock_tabs;
mod doctor;
mod doctor_view;
mod document_jobs;
mod documents;
mod dope_sheet;
mod drag_in;
mod drawing;
mod dropped_files;
mod edit_session;
mod expression;
mod file_jobs;
mod file_watch;
mod first_run;
mod fly;
mod framing;
mod ghosts;
mod gizmo;
mod grid_labels;
mod handles;
mod help;
mod help_pages;
mod history_list;
mod hover;
mod icons;
mod input_order;
mod insertion;
mod inspector;
mod inspector_blends;
mod inspector_instancer;
mod inspector_kinds;
mod inspector_lists;
mod inspector_material;
mod inspector_model;
mod inspector_palette;
mod inspector_params;
mod inspector_points;
mod inspector_scene;
mod inspector_transform;
mod inspector_types;
mod instancer_edits;
mod instancing;
mod intent;
mod key_editor;
mod keying;
mod keymap;
mod lattice_overlay;
mod legend;
mod log_panel;
mod material_edits;
mod material_library;
mod materials;
mod mesh_conversion;
mod messages;
mod multi_edit;
mod navigation;
mod node_picker;
mod node_warnings;
mod numbers;
mod outliner;
mod outliner_drop;
mod outliner_filter;
mod overlay;
mod packing;
mod palette;
mod panel;
mod panels;
mod pass_step;
mod pass_view;
mod picking;
mod placement;
mod playback;
mod portal;
mod preferences_view;
mod preferences_window;
mod preset_picker;
mod projection;
mod recovery;
mod relations;
mod render_view;
mod rendering;
mod root;
mod safekeeping;
mod seeds;
mod selection;
mod shading_bar;
mod shape_change;
mod shape_icons;
mod shell;
mod side_viewport;
mod side_views;
mod slot_list;
mod snapping;
mod state;
mod status;
mod steps;
mod theme;
mod thumbnails;
mod time_scale;
mod timeline;
mod toolbar;
mod tour;
mod transforms;
mod units;
mod view_slots;
mod view_state;
mod viewport;
mod viewport_click;
mod viewport_drag;
mod viewport_modal;
mod viewport_surface;
mod welcome;
mod widgets;

pub use commands::command::Command;
pub use documents::new_document;
pub use keymap::Keymap;
pub use messages::{Message, Severity};
pub use navigation::{Navigation, Side};
pub use root::Editor;
pub use state::Example;
pub use view_slots::VIEWS;
pub use view_state::{GridView, Picture, ViewSettings};
