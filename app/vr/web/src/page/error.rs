//! Errors for JavaScript.

use wasm_bindgen::JsError;

/// Converts an error to a sentence for the page, with a capital letter and a full stop.
pub fn sentence(error: impl std::fmt::Display) -> JsError {
    let mut text = error.to_string();
    // A leading file name is not capitalized.
    let word = text.split_whitespace().next().unwrap_or_default();
    if !word.is_empty() && word.bytes().all(|byte| byte.is_ascii_lowercase()) {
        text[..1].make_ascii_uppercase();
    }
    if !text.ends_with('.') {
        text.push('.');
    }
    JsError::new(&text)
}
