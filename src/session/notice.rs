//! Messages of a session for its user interface.

/// The severity of a notice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoticeLevel {
    /// For information only.
    Info,
    /// Deserves attention.
    Warning,
    /// An operation failed.
    Error,
}

/// A message of one or two plain sentences.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Notice {
    /// Its severity.
    pub level: NoticeLevel,
    /// The text for the user.
    pub text: String,
}

impl Notice {
    pub(super) fn new(level: NoticeLevel, text: impl Into<String>) -> Self {
        Self { level, text: text.into() }
    }
}
