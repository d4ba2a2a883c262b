//! Vulkan drivers complain on standard error where no folder for sockets and the like is named.

/// Starts the program again with `XDG_RUNTIME_DIR` where that is missing: drivers print a line for each instance
/// otherwise. Returns where it is set, is not needed, or cannot be made.
#[cfg(all(unix, not(target_os = "macos")))]
pub fn provide() {
    use std::os::unix::fs::{DirBuilderExt, MetadataExt};
    use std::os::unix::process::CommandExt;

    const VARIABLE: &str = "XDG_RUNTIME_DIR";
    if std::env::var_os(VARIABLE).is_some_and(|folder| !folder.is_empty()) {
        return;
    }
    let Ok(program) = std::env::current_exe() else { return };
    let own = || std::fs::metadata("/proc/self").map(|process| process.uid());
    let Ok(user) = own() else { return };
    let folder = std::env::temp_dir().join(format!("isolith-runtime-{user}"));
    // It may be there already; then it must be a folder of this user that nobody else may enter.
    let _ = std::fs::DirBuilder::new().mode(0o700).create(&folder);
    let is_private = std::fs::symlink_metadata(&folder)
        .is_ok_and(|found| found.is_dir() && found.uid() == user && found.mode() & 0o077 == 0);
    if is_private {
        let mut arguments = std::env::args_os();
        let name = arguments.next().unwrap_or_else(|| program.clone().into());
        // Returns only where it fails; then the driver's lines are all that is lost.
        let _ = std::process::Command::new(program).arg0(name).args(arguments).env(VARIABLE, folder).exec();
    }
}

/// No driver asks for it here.
#[cfg(not(all(unix, not(target_os = "macos"))))]
pub fn provide() {}
