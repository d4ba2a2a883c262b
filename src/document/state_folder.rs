//! Where this user's programs keep what is to survive between runs.

use std::path::PathBuf;

use etcetera::BaseStrategy;

/// The folder of this program: below `XDG_STATE_HOME` or what the system has instead. It need not be there yet. None
/// where this user has no home.
pub fn state_folder() -> Option<PathBuf> {
    let base = etcetera::choose_base_strategy().ok()?;
    Some(base.state_dir().unwrap_or_else(|| base.data_dir()).join("isolith"))
}

/// The folder of this program for files that it brings along: below `XDG_DATA_HOME` or what the system has instead. It need not
/// be there yet. None where this user has no home.
pub fn data_folder() -> Option<PathBuf> {
    Some(etcetera::choose_base_strategy().ok()?.data_dir().join("isolith"))
}
