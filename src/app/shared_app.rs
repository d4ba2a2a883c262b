//! The editor and the device, shared by the windows that follow each other.

use std::cell::RefCell;
use std::rc::Rc;

use crate::editor::Editor;
use crate::render::Gpu;

/// What outlives a window.
#[derive(Clone)]
pub(super) struct SharedApp {
    pub editor: Rc<RefCell<Editor>>,
    /// The device of the window that is open or was last.
    pub gpu: Rc<RefCell<Option<Gpu>>>,
}
