//! Detects whether the system has file dialogs. Without a desktop, over ssh and in containers it often has none; a call
//! for a dialog then ends only after a long time, or at once without an error.

/// Whether the system can show file dialogs. Asks the session bus, which may take [`LONGEST`].
#[cfg(any(target_os = "windows", target_os = "macos"))]
pub fn has_dialogs() -> bool {
    true
}

#[cfg(not(any(target_os = "windows", target_os = "macos")))]
pub use desktop::has_dialogs;

#[cfg(not(any(target_os = "windows", target_os = "macos")))]
mod desktop {
    use std::sync::mpsc::channel;
    use std::time::Duration;

    /// A portal that does not answer within this time counts as missing.
    const LONGEST: Duration = Duration::from_millis(1_500);

    /// Whether the system can show file dialogs. Asks the session bus, which may take [`LONGEST`].
    pub fn has_dialogs() -> bool {
        let (sender, answer) = channel();
        let spawned = std::thread::Builder::new().name("portal".into()).spawn(move || {
            // Ignore an answer after the timeout.
            let _ = sender.send(portal_version().is_ok());
        });
        let has_portal = spawned.is_ok() && answer.recv_timeout(LONGEST) == Ok(true);
        has_portal || is_in_path("zenity")
    }

    fn portal_version() -> zbus::Result<u32> {
        let bus = zbus::blocking::Connection::session()?;
        let (name, path) = ("org.freedesktop.portal.Desktop", "/org/freedesktop/portal/desktop");
        zbus::blocking::Proxy::new(&bus, name, path, "org.freedesktop.portal.FileChooser")?.get_property("version")
    }

    /// The fallback of `rfd` without a portal.
    fn is_in_path(program: &str) -> bool {
        let path = std::env::var_os("PATH").unwrap_or_default();
        std::env::split_paths(&path).any(|folder| folder.join(program).is_file())
    }

    #[cfg(test)]
    mod tests {
        use std::time::Instant;

        use super::*;

        #[test]
        fn the_answer_does_not_keep_anybody_waiting() {
            let since = Instant::now();
            has_dialogs();
            assert!(since.elapsed() < 2 * LONGEST, "{:?}", since.elapsed());
            assert!(is_in_path("sh") && !is_in_path("no-such-program"));
        }
    }
}
