//! The panel with all messages so far.

use egui::Ui;

use super::panel::{Panel, PanelPlace};
use super::state::EditorState;
use super::widgets;

/// The id of the panel, for the command that opens it.
pub const LOG: &str = "log";

/// The panel of the log.
pub struct Log;

impl Panel for Log {
    fn id(&self) -> &'static str {
        LOG
    }

    fn title(&self) -> &'static str {
        "Log"
    }

    fn place(&self) -> PanelPlace {
        PanelPlace::Lower(190.0)
    }

    fn ui(&mut self, state: &mut EditorState, ui: &mut Ui) {
        widgets::fixed(ui, |ui| state.session.messages.show_all(ui));
    }
}
