//! The folders for data of this user that persist between runs.

use std::path::PathBuf;

use etcetera::BaseStrategy;

/// The state folder of this program: below `XDG_STATE_HOME` or the system's equivalent. It need not exist yet. `None`
/// if this user has no home.
pub fn state_folder() -> Option<PathBuf> {
    let base = etcetera::choose_base_strategy().ok()?;
    Some(base.state_dir().unwrap_or_else(|| base.data_dir()).join("isolith"))
}

/// The data folder of this program, for files that ship with it: below `XDG_DATA_HOME` or the system's equivalent. It
/// need not exist yet. `None` if this user has no home.
pub fn data_folder() -> Option<PathBuf> {
    Some(etcetera::choose_base_strategy().ok()?.data_dir().join("isolith"))
}
