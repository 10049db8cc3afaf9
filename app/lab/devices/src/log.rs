//! Parser of logcat lines: time, process, tag and message.

use std::borrow::Cow;

use yoro_settings::telemetry::{LOG_TAG, Pictures, Rating};

/// Tag of the line that Meta's runtime logs once a second.
pub const VRAPI_TAG: &str = "VrApi";
/// Returns the arguments that select logcat's tags: telemetry, Meta's runtime with its clock levels, and the messages
/// of an application that crashes.
pub fn filter() -> [String; 6] {
    let all = |tag: &str| format!("{tag}:V");
    [
        all(LOG_TAG),
        all(VRAPI_TAG),
        all("XrPerformanceManager"),
        "AndroidRuntime:E".into(),
        "DEBUG:F".into(),
        "*:S".into(),
    ]
}

/// The first words of a simulated log.
pub const SIMULATED_MARK: &str = "--------- simulated";

/// One line of logcat.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Entry<'a> {
    /// Time in seconds since 1970 if the log has it so, otherwise only meaningful as differences. `None` without times.
    pub time_s: Option<f64>,
    /// The process's number.
    pub pid: Option<u32>,
    /// The tag.
    pub tag: &'a str,
    /// The message.
    pub message: &'a str,
}

/// The kind of a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind<'a> {
    /// A message.
    Entry(Entry<'a>),
    /// A mark of logcat, such as `--------- beginning of main`, or an empty line.
    Mark,
    /// Not a line of logcat.
    Damaged,
}

/// Returns a line as text, without its line end. Replaces bytes that are not valid UTF-8.
pub fn text(line: &[u8]) -> Cow<'_, str> {
    let end = line.iter().rposition(|byte| !matches!(byte, b'\r' | b'\n')).map_or(0, |last| last + 1);
    String::from_utf8_lossy(&line[..end])
}

/// Parses a line in logcat's formats `threadtime` (with the time as seconds since 1970, or as a date with or without
/// the year) and `raw`.
pub fn parse(line: &str) -> Kind<'_> {
    let line = line.trim_end();
    if line.is_empty() || line.starts_with("--------- ") {
        return Kind::Mark;
    }
    if let Some(tag) = raw_tag(line) {
        return Kind::Entry(Entry { time_s: None, pid: None, tag, message: line });
    }
    thread_time(line).map_or(Kind::Damaged, Kind::Entry)
}

/// Returns the tag of a line that is a bare message.
fn raw_tag(line: &str) -> Option<&'static str> {
    let is_own = line.starts_with("v=") || Rating::is_line(line) || Pictures::is_line(line);
    is_own.then_some(LOG_TAG)
}

/// Parses `1700000000.123  1234  1250 I YORO    : ...`.
fn thread_time(line: &str) -> Option<Entry<'_>> {
    let (time_s, text) = time(line)?;
    let (pid, rest) = word(text)?;
    let (thread, rest) = word(rest)?;
    let (priority, rest) = word(rest)?;
    thread.parse::<u32>().ok()?;
    let (tag, message) = rest.split_once(": ").or_else(|| Some((rest.strip_suffix(':')?, "")))?;
    let is_priority = matches!(priority, "V" | "D" | "I" | "W" | "E" | "F" | "S");
    is_priority.then_some(Entry {
        time_s: Some(time_s),
        pid: Some(pid.parse().ok()?),
        tag: tag.trim(),
        message,
    })
}

/// Returns the first word and the rest.
fn word(text: &str) -> Option<(&str, &str)> {
    text.trim_start().split_once(' ').filter(|(word, _)| !word.is_empty())
}

/// Parses the time at the beginning of a line. Returns seconds and the rest of the line.
fn time(line: &str) -> Option<(f64, &str)> {
    let (first, rest) = word(line)?;
    if let Ok(seconds) = first.parse::<f64>() {
        return (first.contains('.') && seconds.is_finite()).then_some((seconds, rest));
    }
    let (clock, rest) = word(rest)?;
    let mut date = first.split('-').map(str::parse::<u32>);
    let date = (date.next()?.ok()?, date.next()?.ok()?, date.next());
    let (year, month, day) = match date {
        (year, month, Some(day)) => (year, month, day.ok()?),
        // Any leap year works, since only differences matter.
        (month, day, None) => (2000, month, day),
    };
    let (clock, fraction) = clock.split_once('.')?;
    if fraction.is_empty() || !fraction.bytes().all(|byte| byte.is_ascii_digit()) {
        return None;
    }
    let text = format!("{year:04}-{month:02}-{day:02}T{clock}.{}Z", &fraction[..fraction.len().min(9)]);
    let seconds = humantime::parse_rfc3339(&text).ok()?;
    Some((seconds.duration_since(std::time::UNIX_EPOCH).ok()?.as_secs_f64(), rest))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn entry(line: &str) -> Entry<'_> {
        match parse(line) {
            Kind::Entry(entry) => entry,
            kind => panic!("{kind:?}: {line}"),
        }
    }

    #[test]
    fn all_logcat_formats_are_parsed() {
        let of = |line| {
            let e = entry(line);
            (e.pid, e.tag, e.message)
        };
        let expected = (Some(4242), "YORO", "v=2,t=1.0s");
        for line in [
            "1700000000.123456  4242  4260 I YORO    : v=2,t=1.0s",
            "1700000000.123  4242  4260 I YORO: v=2,t=1.0s",
            "11-14 22:13:20.123  4242  4260 I YORO    : v=2,t=1.0s",
            "2023-11-14 22:13:20.123456  4242  4260 I YORO    : v=2,t=1.0s\r",
            "         1700000000.123  4242  4260 I YORO    : v=2,t=1.0s",
        ] {
            assert_eq!(of(line), expected, "{line}");
        }
        assert_eq!(of("v=2,t=1.0s"), (None, "YORO", "v=2,t=1.0s"));
        assert_eq!(of("11-14 22:13:20.123  1  2 E AndroidRuntime: FATAL: a (b): c").2, "FATAL: a (b): c");
        assert_eq!(of("11-14 22:13:20.123  1  2 E libc:").2, "");
    }

    #[test]
    fn log_times_have_correct_differences() {
        let at = |line| entry(line).time_s.unwrap();
        assert_eq!(at("1700000000.250000 1 2 I A: b"), 1_700_000_000.25);
        assert_eq!(at("2023-11-14 22:13:20.250 1 2 I A: b"), 1_700_000_000.25);
        let over_midnight = at("03-01 00:00:01.000 1 2 I A: b") - at("02-29 23:59:59.000 1 2 I A: b");
        assert_eq!(over_midnight, 2.0);
    }

    #[test]
    fn marks_and_damaged_lines_are_told_apart() {
        assert_eq!(parse("--------- beginning of main"), Kind::Mark);
        assert_eq!(parse(""), Kind::Mark);
        for line in [
            "1700000000.1234",
            "1700000000.123456  42",
            "hello",
            "11-14 22:13:20.123  1  2 I YORO",
            "13-45 22:13:20.1 1 2 I A: b",
        ] {
            assert_eq!(parse(line), Kind::Damaged, "{line}");
        }
    }

    proptest! {
        #[test]
        fn no_line_makes_the_parser_panic(line in ".{0,80}") {
            let _ = parse(&line);
        }

        #[test]
        fn a_line_cut_anywhere_is_damaged_or_shorter(cut in 0usize..200, message in "[ -~]{0,60}") {
            let line = format!("1700000000.123456  4242  4260 I YORO    : {message}");
            let cut = cut.min(line.len());
            if let Kind::Entry(entry) = parse(&line[..cut]) {
                prop_assert!(message.starts_with(entry.message.trim_end()) || cut < 20);
            }
        }
    }
}
