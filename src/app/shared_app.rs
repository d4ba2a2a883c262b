//! The editor and the device, shared by successive windows.

use std::cell::RefCell;
use std::rc::Rc;

use crate::editor::Editor;
use crate::render::Gpu;

/// State that outlives a window.
#[derive(Clone)]
pub(super) struct SharedApp {
    pub editor: Rc<RefCell<Editor>>,
    /// The device of the current or the last window.
    pub gpu: Rc<RefCell<Option<Gpu>>>,
}
