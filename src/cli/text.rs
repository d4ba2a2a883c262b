//! Printing: file contents never control the terminal, and messages stay short.

use std::borrow::Cow;
use std::io::Write;

use super::failure::Failure;

/// Longest line on standard error, in characters. Names and reasons come from files.
const MAX_MESSAGE: usize = 2_000;

/// Prints one or more lines on standard output. A closed pipe is not a failure.
pub fn say(text: &str) -> Result<(), Failure> {
    match writeln!(std::io::stdout(), "{}", printable(text)) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(Failure::Write { path: "standard output".into(), reason: error.to_string() })
        }
        _ => Ok(()),
    }
}

/// Prints one line on standard error.
pub fn complain(line: &str) {
    let text = printable(line).replace('\n', " ");
    let clipped = match text.char_indices().nth(MAX_MESSAGE) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text,
    };
    // If even this fails, there is no place left to report it.
    let _ = writeln!(std::io::stderr(), "{clipped}");
}

/// The text without control characters and without characters that change the writing direction.
fn printable(text: &str) -> Cow<'_, str> {
    let is_harmful = |c: char| {
        c.is_control() && c != '\n' && c != '\t' || matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
    };
    if text.contains(is_harmful) { Cow::Owned(text.replace(is_harmful, "\u{fffd}")) } else { Cow::Borrowed(text) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn escape_sequences_are_not_printed() {
        let shown = printable("a\u{1b}[2Jb\u{7}\u{9b}c\r\u{202e}d");
        assert_eq!(shown, "a\u{fffd}[2Jb\u{fffd}\u{fffd}c\u{fffd}\u{fffd}d");
        assert_eq!(printable("two\nlines\tand größe"), "two\nlines\tand größe");
    }
}
