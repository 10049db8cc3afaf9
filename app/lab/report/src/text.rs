//! Names and numbers as text.

/// Returns the text in lower case, with dashes for everything but letters and digits: for anchors and file names.
pub fn slug(text: &str) -> String {
    let plain = text.chars().map(|c| if c.is_alphanumeric() { c.to_ascii_lowercase() } else { '-' });
    plain.collect::<String>().split('-').filter(|part| !part.is_empty()).collect::<Vec<_>>().join("-")
}

/// Formats a count: `19.6 k`, `2.80 M`.
pub fn short_count(count: u64) -> String {
    match count {
        0..1_000 => count.to_string(),
        1_000..100_000 => format!("{:.1} k", count as f64 / 1e3),
        100_000..1_000_000 => format!("{:.0} k", count as f64 / 1e3),
        _ => format!("{:.2} M", count as f64 / 1e6),
    }
}

/// Formats a number with this many decimals.
pub fn fixed(value: Option<f64>, decimals: usize) -> Option<String> {
    value.map(|value| format!("{value:.decimals$}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_short() {
        assert_eq!([999, 19_640, 264_000, 2_804_000].map(short_count), ["999", "19.6 k", "264 k", "2.80 M"]);
    }
}
