//! Decoders of other crates, some of which panic on damaged files.

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};

thread_local! {
    static RUNS: Cell<bool> = const { Cell::new(false) };
}

/// Runs the decoder of another crate; a panic of it becomes the error that `failed` makes of the reason. Programs that
/// abort on a panic still do.
///
/// # Errors
/// Those of `decode`, and that of `failed`.
pub fn run<T, E>(decode: impl FnOnce() -> Result<T, E>, failed: impl FnOnce(String) -> E) -> Result<T, E> {
    let outer = RUNS.replace(true);
    // What the decoder has changed before it panicked is dropped with it.
    let decoded = catch_unwind(AssertUnwindSafe(decode));
    RUNS.set(outer);
    decoded.unwrap_or_else(|_| Err(failed("its decoder fails on it".into())))
}

/// True while this thread runs a decoder: its panics are errors of the file, which a panic hook need not tell.
pub fn runs() -> bool {
    RUNS.get()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_of_a_decoder_is_an_error_of_the_file() {
        let failed = |reason: String| format!("a.png is damaged ({reason})");
        let panics = || -> Result<(), String> {
            assert!(runs());
            run(|| Ok(()), failed)?;
            assert!(runs(), "a decoder inside another");
            panic!("range end index 3 out of range")
        };
        assert_eq!(run(panics, failed), Err("a.png is damaged (its decoder fails on it)".into()));
        assert!(!runs());
        assert_eq!(run(|| Ok(1), failed), Ok(1));
        assert_eq!(run(|| Err::<(), _>("no PNG".into()), failed), Err("no PNG".into()));
    }
}
