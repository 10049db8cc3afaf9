//! Runs decoders of other crates, some of which panic on damaged files.

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};

thread_local! {
    static RUNS: Cell<bool> = const { Cell::new(false) };
}

/// Runs a decoder of another crate. If it panics, `failed` makes the error from a reason. Programs that abort on panics
/// still abort.
///
/// # Errors
/// Those of `decode`, and the one of `failed`.
pub fn run<T, E>(decode: impl FnOnce() -> Result<T, E>, failed: impl FnOnce(String) -> E) -> Result<T, E> {
    let outer = RUNS.replace(true);
    // Whatever the decoder changed before it panicked is dropped with it.
    let decoded = catch_unwind(AssertUnwindSafe(decode));
    RUNS.set(outer);
    decoded.unwrap_or_else(|_| Err(failed("its decoder fails on it".into())))
}

/// True while this thread runs a decoder. A panic is then an error of the file, which a panic hook need not report.
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
