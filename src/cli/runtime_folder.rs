//! Vulkan drivers complain on standard error if `XDG_RUNTIME_DIR`, the folder for sockets and the like, is not set.

/// Restarts the program with `XDG_RUNTIME_DIR` if that is missing: otherwise drivers print a line for each instance.
/// Returns if the variable is set, is not needed, or the folder cannot be created.
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
    // The folder may exist already. Then it must belong to this user, and nobody else may enter it.
    let _ = std::fs::DirBuilder::new().mode(0o700).create(&folder);
    let is_private = std::fs::symlink_metadata(&folder)
        .is_ok_and(|found| found.is_dir() && found.uid() == user && found.mode() & 0o077 == 0);
    if is_private {
        let mut arguments = std::env::args_os();
        let name = arguments.next().unwrap_or_else(|| program.clone().into());
        // Returns only on failure; the only consequence is the lines of the driver.
        let _ = std::process::Command::new(program).arg0(name).args(arguments).env(VARIABLE, folder).exec();
    }
}

/// No driver needs the folder on this system.
#[cfg(not(all(unix, not(target_os = "macos"))))]
pub fn provide() {}
