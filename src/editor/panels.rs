//! The registry of panels: a new panel is a file and a line here.

use super::inspector::Inspector;
use super::log_panel::Log;
use super::materials::Materials;
use super::outliner::Outliner;
use super::panel::Panel;
use super::side_viewport::SideViewport;
use super::status::StatusBar;
use super::timeline::TimelinePanel;
use super::toolbar::Toolbar;
use super::viewport::Viewport;

/// All panels.
pub fn all() -> Vec<Box<dyn Panel>> {
    vec![
        Box::new(Toolbar),
        Box::new(StatusBar),
        Box::<TimelinePanel>::default(),
        Box::new(Log),
        Box::<Outliner>::default(),
        Box::<Materials>::default(),
        Box::<Inspector>::default(),
        Box::<Viewport>::default(),
        Box::new(SideViewport::new(0)),
        Box::new(SideViewport::new(1)),
        Box::new(SideViewport::new(2)),
    ]
}
