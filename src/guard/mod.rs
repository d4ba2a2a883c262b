//! Guards work that may panic: a panic in a decoder, a worker or a job becomes an error, and its caller goes on.

use std::panic::{AssertUnwindSafe, catch_unwind};

/// Runs the work; the error is the panic message. State that the work was changing must not be used after a panic.
///
/// # Errors
/// The work panicked.
pub fn guarded<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(work)).map_err(|panic| {
        let text = panic.downcast_ref::<&str>().map(ToString::to_string);
        let text = text.or_else(|| panic.downcast_ref::<String>().cloned());
        format!("an internal error: {}", text.unwrap_or_else(|| "a panic without words".into()))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_comes_back_as_words() {
        assert_eq!(guarded(|| 7), Ok(7));
        assert_eq!(guarded(|| panic!("no {}", "glyph")), Err::<(), _>("an internal error: no glyph".into()));
        assert_eq!(guarded(|| panic!("no glyph")), Err::<(), _>("an internal error: no glyph".into()));
        let wordless = guarded(|| std::panic::panic_any(7));
        assert_eq!(wordless, Err::<(), _>("an internal error: a panic without words".into()));
    }
}
