//! The page: one template for all reports, which loads nothing from elsewhere.

use anyhow::Context;
use minijinja::value::Value;
use minijinja::{AutoEscape, Environment, UndefinedBehavior, context};

use crate::palette::css_rules;
use crate::pictures::ENCODINGS;
use crate::{Block, Picture, Report};

/// The largest number of bytes of all pictures on a page.
const PICTURE_BUDGET: usize = 14 << 20;

/// Returns the page of a report.
pub(crate) fn render(report: &Report) -> anyhow::Result<String> {
    render_within(report, PICTURE_BUDGET)
}

fn render_within(report: &Report, budget: usize) -> anyhow::Result<String> {
    let (addresses, picture_note) = encode_pictures(report, budget)?;
    let mut addresses = addresses.into_iter();
    let mut anchors: Vec<String> = Vec::new();
    let mut sections = Vec::new();
    for section in &report.sections {
        let before = anchors.iter().filter(|other| **other == section.anchor()).count();
        anchors.push(section.anchor());
        let number = if before > 0 { format!("-{}", before + 1) } else { String::new() };
        let blocks = section.blocks.iter().map(|block| {
            Ok(match block {
                Block::Text(text) => context! { text },
                Block::Table(table) => context! { table },
                Block::Plot(plot) => context! { plot => plot.to_page()? },
                Block::Pictures(viewer) => {
                    let size = viewer.pictures.first().map_or((1, 1), |first| first.image.dimensions());
                    let addresses: Vec<String> = addresses.by_ref().take(viewer.pictures.len()).collect();
                    context! { viewer, size, addresses }
                }
            })
        });
        sections.push(context! {
            anchor => section.anchor() + &number,
            heading => section.heading,
            place => section.place,
            blocks => blocks.collect::<anyhow::Result<Vec<_>>>()?,
        });
    }
    let page = context! {
        title => report.title,
        summary => report.summary,
        sections,
        picture_note,
        css => include_str!("page.css"),
        dark_plots => css_rules(),
        script => include_str!("page.js"),
    };
    let mut environment = Environment::new();
    environment.set_undefined_behavior(UndefinedBehavior::Strict);
    environment.set_trim_blocks(true);
    environment.set_lstrip_blocks(true);
    environment.set_auto_escape_callback(|_| AutoEscape::Html);
    environment.add_filter("markup", |text: String| markup(&text));
    let html = environment.render_str(include_str!("page.html.j2"), page);
    html.context("cannot fill in the report's template")
}

/// Returns the addresses of all pictures in the order of the page, and a sentence about how they were encoded, which is
/// empty if there are none.
fn encode_pictures(report: &Report, budget: usize) -> anyhow::Result<(Vec<String>, String)> {
    let blocks = report.sections.iter().flat_map(|section| &section.blocks);
    let pictures = blocks.flat_map(|block| match block {
        Block::Pictures(of) => &of.pictures[..],
        _ => &[],
    });
    let pictures: Vec<&Picture> = pictures.collect();
    let (mut addresses, mut note) = (Vec::new(), String::new());
    for (quality, halvings) in ENCODINGS {
        let encoded = pictures.iter().map(|picture| picture.data_uri(quality, halvings));
        addresses = encoded.collect::<Result<_, _>>().context("cannot encode a picture of the report")?;
        let size = if halvings > 0 {
            format!(", shrunk to 1/{} of their size", 1 << halvings)
        } else {
            String::new()
        };
        note = format!(
            "Pictures on this page are JPEG, quality {quality}{size}; error maps are shrunk to half. All figures were \
             measured on the images as rendered."
        );
        if addresses.iter().map(String::len).sum::<usize>() <= budget {
            break;
        }
    }
    Ok((addresses, if pictures.is_empty() { String::new() } else { note }))
}

/// Returns a text as HTML: `**` encloses what is important, a backquote what a computer reads.
fn markup(text: &str) -> Value {
    let escaped = text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
    let bold = |text: &str| enclosed(text, "**", "b", str::to_owned);
    Value::from_safe_string(enclosed(&escaped, "`", "code", bold))
}

/// Returns a text with a tag around every second part between two marks.
fn enclosed(text: &str, mark: &str, tag: &str, others: impl Fn(&str) -> String) -> String {
    let parts = text.split(mark).enumerate();
    parts.map(|(i, part)| if i % 2 == 1 { format!("<{tag}>{part}</{tag}>") } else { others(part) }).collect()
}

#[cfg(test)]
mod tests {
    use image::RgbImage;

    use super::*;
    use crate::{Axis, Cell, Entry, OtherEye, Pictures, Plot, Section, Table, Text};

    fn report() -> Report {
        let mut section = Section::new("A \"café\" & <b>", "See `a <c>`, **not** less.");
        let mut table = Table::new("Costs", &["<what", "ms"]);
        table.push(vec![Cell::plain("<one>"), Cell::ours(Some("1.5"))]);
        section.table(table);
        for title in ["first", "second"] {
            let mut plot = Plot::rows(title, Axis::new("ms"));
            plot.mark("</script>", Entry::ours("yoro"), 1.5);
            section.plot(plot);
        }
        let picture = |label: &str, is_map| Picture {
            label: label.into(),
            caption: format!("This is {label}."),
            image: RgbImage::from_fn(64, 48, |x, y| {
                image::Rgb([(x * 4) as u8, (y * 5) as u8, (x * y) as u8])
            }),
            is_map,
        };
        section.pictures(Pictures {
            title: "street".into(),
            pictures: vec![picture("one", false), picture("two", true)],
            other_eye: Some(OtherEye { picture: 1, is_left: true }),
            ..Pictures::default()
        });
        let summary = vec![Text::warning("Made up.")];
        Report { title: "A <title>".into(), summary, sections: vec![section.clone(), section] }
    }

    #[test]
    fn the_page_is_escaped_and_needs_nothing_from_elsewhere() {
        let html = report().to_html().unwrap();
        let foreign = "<b>\"|<one>|<title>\"|<c>|https://|<link|url(|@import| src=\"/|<script src";
        for foreign in foreign.split('|') {
            assert!(!html.contains(foreign), "{foreign}");
        }
        assert!(html.contains("See <code>a &lt;c&gt;</code>, <b>not</b> less."));
        assert_eq!(html.matches("</script>").count(), 4 + 1, "a row's name ends no script");
        assert!(html.contains("id=\"a-café-b\"") && html.contains("id=\"a-café-b-2\""));
        assert_eq!((html.matches("class=\"plots\"").count(), html.matches("<figure").count()), (2, 4));
        assert_eq!(html.matches("src=\"data:image/jpeg;base64,").count(), 4);
    }

    #[test]
    fn pictures_shrink_to_fit() {
        let large = render_within(&report(), usize::MAX).unwrap();
        let small = render_within(&report(), 100).unwrap();
        assert!(large.contains("JPEG, quality 90;") && small.contains("quality 66, shrunk to 1"));
        assert!(small.len() < large.len());
    }

    #[test]
    fn markdown_has_texts_and_tables() {
        let markdown = report().to_markdown();
        let start = "# A <title>\n\n**Made up.**\n\n## A \"café\" & &lt;b>\n\nSee `a &lt;c>`, **not** less.\n\n**Costs**\n\n";
        assert!(markdown.starts_with(start), "{markdown}");
        assert!(markdown.contains("| &lt;one> | 1.5 |"), "{markdown}");
    }
}
