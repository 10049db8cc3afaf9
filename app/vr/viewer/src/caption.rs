//! The text of the HUD: frame statistics and the user's last action.

use std::fmt::{self, Write};

use yoro_lenses::COLUMNS;
use yoro_render::stereo::Auto;
use yoro_settings::telemetry::Line;

/// How long a message is shown per line of its text, in nanoseconds.
const MESSAGE_NS: i64 = 2_000_000_000;

/// The application's state that the HUD shows.
#[derive(Clone, Copy, Default)]
pub(crate) struct Status<'a> {
    /// The log line of the last second.
    pub frames: Option<&'a Line>,
    /// The device's temperature in degrees Celsius.
    pub celsius: Option<f32>,
    pub method: &'a str,
    /// The automatic choice of the method, unless the settings name a method.
    pub auto: Option<&'a Auto>,
    pub pipeline: Option<&'a str>,
    /// The name of the scene that is being loaded.
    pub loading: Option<&'a str>,
}

/// The HUD's text, and whether the HUD is shown.
pub(crate) struct Caption {
    /// True if the user wants to see the HUD.
    pub is_shown: bool,
    message: String,
    message_until_ns: i64,
    /// The text that was written last.
    pub text: String,
}

impl Caption {
    pub fn new(is_shown: bool) -> Caption {
        let text = String::with_capacity(3 * COLUMNS);
        Caption { is_shown, message: String::new(), message_until_ns: 0, text }
    }

    /// Shows a message for two seconds per line, even while the HUD is hidden. A message of several lines replaces the
    /// HUD's text. An empty message removes the previous one.
    pub fn announce(&mut self, message: String, now_ns: i64) {
        let lines = message.lines().count() as i64;
        self.message_until_ns = if message.is_empty() { 0 } else { now_ns + lines * MESSAGE_NS };
        self.message = message;
    }

    /// True if the HUD or a message is to be shown.
    pub fn is_in_view(&self, now_ns: i64) -> bool {
        self.is_shown || self.has_message(now_ns)
    }

    fn has_message(&self, now_ns: i64) -> bool {
        now_ns < self.message_until_ns
    }

    /// Writes the known ones of frame rate, frame time and temperature, the method, and the loading scene or message.
    pub fn write_status(&mut self, status: &Status, now_ns: i64) {
        let message = self.has_message(now_ns).then_some(self.message.as_str());
        let text = &mut self.text;
        text.clear();
        if let (None, Some(message)) = (status.loading, message.filter(|message| message.contains('\n'))) {
            return text.push_str(message);
        }
        let mut write = || -> fmt::Result {
            if let Some(Line { fps: Some(fps), frame_ms: Some(ms), refresh_hz, .. }) = status.frames {
                write!(text, "{fps:.0}")?;
                if let Some(hz) = refresh_hz {
                    write!(text, "/{hz:.0}")?;
                }
                write!(text, " FPS {ms:.1} ms")?;
                if let Some(celsius) = status.celsius {
                    write!(text, " {celsius:.0} C")?;
                }
                text.push('\n');
            }
            match status.auto {
                Some(auto) => writeln!(text, "auto:{} {auto}", status.method)?,
                None => writeln!(text, "{} {}", status.method, status.pipeline.unwrap_or_default())?,
            }
            match (status.loading, message) {
                (Some(scene), _) => write!(text, "loading {scene}"),
                (None, Some(message)) => text.write_str(message),
                (None, None) => Ok(()),
            }
        };
        // Writing to a `String` cannot fail.
        let _ = write();
    }

    /// Writes a sentence, wrapped between words to the panel's width.
    pub fn write_sentence(&mut self, sentence: &str) {
        self.text.clear();
        wrap(&mut self.text, sentence, COLUMNS);
    }
}

/// Appends a sentence, wrapped between words into lines of at most `columns` characters.
pub(crate) fn wrap(text: &mut String, sentence: &str, columns: usize) {
    let mut column = 0;
    for word in sentence.split_whitespace() {
        let length = word.chars().count();
        if column == 0 {
            column = length;
        } else if column + 1 + length > columns {
            text.push('\n');
            column = length;
        } else {
            text.push(' ');
            column += 1 + length;
        }
        text.push_str(word);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_caption_shows_rate_method_and_message() {
        let mut caption = Caption::new(true);
        let loading = Status {
            celsius: Some(31.0),
            method: "yoro",
            pipeline: Some("gather"),
            loading: Some("street"),
            ..Status::default()
        };
        caption.write_status(&loading, 0);
        assert_eq!(caption.text, "yoro gather\nloading street");
        let line =
            Line { fps: Some(59.94), refresh_hz: Some(60.0), frame_ms: Some(16.68), ..Line::default() };
        let running =
            Status { frames: Some(&line), celsius: Some(31.2), method: "mono", ..Status::default() };
        caption.write_status(&running, 0);
        assert_eq!(caption.text, "60/60 FPS 16.7 ms 31 C\nmono \n");
        caption.write_sentence("there is no file room.obj: give the path of an .obj, .gltf or .glb file");
        assert_eq!(caption.text, "there is no file room.obj: give\nthe path of an .obj, .gltf or .glb\nfile");
    }

    #[test]
    fn a_message_disappears_by_itself_and_shows_while_the_hud_is_hidden() {
        let mut caption = Caption::new(false);
        assert!(!caption.is_in_view(0));
        caption.announce("recentered".into(), 1);
        caption.write_status(&Status { method: "mono", ..Status::default() }, MESSAGE_NS);
        assert!(caption.is_in_view(MESSAGE_NS) && !caption.is_in_view(MESSAGE_NS + 1));
        assert_eq!(caption.text, "mono \nrecentered");
        caption.announce(String::new(), 1);
        assert!(!caption.is_in_view(1));
        caption.announce("one\ntwo".into(), 1);
        caption.write_status(&Status { method: "mono", ..Status::default() }, 2 * MESSAGE_NS);
        assert_eq!(caption.text, "one\ntwo");
        assert!(caption.is_in_view(2 * MESSAGE_NS) && !caption.is_in_view(2 * MESSAGE_NS + 1));
    }
}
