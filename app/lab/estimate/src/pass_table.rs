//! The table of what each pass reads and writes, made from recorded frames.

use std::fmt::Write as _;

use crate::traffic::{Piece, Traffic};
use yoro_gl::Image;

/// A row of the table: a piece of work, and how often each method does it in a frame.
struct Line {
    text: String,
    methods: Vec<(String, u32)>,
}

/// Returns a table in Markdown with a row for each kind of work on a framebuffer, from frames with the names of their
/// methods.
pub fn pass_table(frames: &[(String, Vec<Piece>)]) -> String {
    let mut lines: Vec<Line> = Vec::new();
    for (method, pieces) in frames {
        for piece in pieces {
            let text =
                format!("{} | {} | {}", piece.passes.join(", "), images(&piece.images), textures(piece));
            let at = lines.iter().position(|line| line.text == text);
            let at = at.unwrap_or_else(|| {
                lines.push(Line { text, methods: Vec::new() });
                lines.len() - 1
            });
            match lines[at].methods.iter_mut().find(|(name, _)| name == method) {
                Some((_, times)) => *times += 1,
                None => lines[at].methods.push((method.clone(), 1)),
            }
        }
    }
    let mut out = "| pass | draws into | reads | times in a frame |\n|---|---|---|---|\n".to_owned();
    for line in &lines {
        let methods: Vec<String> =
            line.methods.iter().map(|(name, times)| format!("{name} {times}")).collect();
        let _ = writeln!(out, "| {} | {} |", line.text, methods.join(", "));
    }
    out
}

/// Lists images and what happens to them, with runs of equal neighbours in one entry.
fn images(all: &[Traffic]) -> String {
    let named = all.iter().map(|traffic| {
        let fate = match (traffic.loaded, traffic.stored) {
            (false, false) => "stays in the tile",
            (false, true) => "written",
            (true, false) => "read",
            (true, true) => "read and written",
        };
        format!("{} {fate}", name(&traffic.image))
    });
    counted(named)
}

fn textures(piece: &Piece) -> String {
    let read = piece.textures.iter().filter(|(.., texels)| *texels > 0.0);
    counted(read.map(|(uniform, image, _)| format!("{uniform} ({})", name(image))))
}

/// Joins texts by commas, with a count in front of repeated ones.
fn counted(texts: impl Iterator<Item = String>) -> String {
    let mut runs: Vec<(String, u32)> = Vec::new();
    for text in texts {
        match runs.last_mut() {
            Some((last, count)) if *last == text => *count += 1,
            _ => runs.push((text, 1)),
        }
    }
    let shown =
        runs.into_iter().map(|(text, count)| if count > 1 { format!("{count} times {text}") } else { text });
    shown.collect::<Vec<_>>().join(", ")
}

fn name(image: &Image) -> String {
    match image.samples {
        1 => format!("{:?}", image.format),
        samples => format!("{samples}x {:?}", image.format),
    }
}
