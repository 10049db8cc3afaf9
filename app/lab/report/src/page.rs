//! The page: one template for all reports, which loads nothing from elsewhere.

use minijinja::value::Value;
use minijinja::{AutoEscape, Environment, UndefinedBehavior, context};
use serde_json::json;

use crate::palette::css_rules;
use crate::pictures::{ENCODINGS, Encoding};
use crate::{Block, Pictures, Report, ReportError, Section, Text, Tone};

/// The largest number of bytes of all pictures on a page.
const PICTURE_BUDGET: usize = 14 << 20;

/// Returns the page of a report.
pub(crate) fn render(report: &Report) -> Result<String, ReportError> {
    render_within(report, PICTURE_BUDGET)
}

fn render_within(report: &Report, budget: usize) -> Result<String, ReportError> {
    let encoded = encode_pictures(report, budget)?;
    let mut pictures = encoded.addresses.into_iter();
    let mut anchors: Vec<String> = Vec::new();
    let sections = report.sections.iter().map(|section| {
        let anchor = section.anchor();
        let before = anchors.iter().filter(|other| **other == anchor).count();
        anchors.push(anchor.clone());
        let anchor = if before > 0 { format!("{anchor}-{}", before + 1) } else { anchor };
        Ok(context! {
            anchor => anchor,
            heading => section.heading,
            place => section.place,
            blocks => blocks(section, &mut pictures)?,
        })
    });
    let page = context! {
        title => report.title,
        summary => report.summary.iter().map(text).collect::<Vec<_>>(),
        sections => sections.collect::<Result<Vec<_>, ReportError>>()?,
        picture_note => encoded.note,
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
    environment.add_template("page", include_str!("page.html.j2"))?;
    Ok(environment.get_template("page")?.render(page)?)
}

fn text(text: &Text) -> Value {
    let class = match text.tone {
        Tone::Plain => "plain",
        Tone::Quiet => "quiet",
        Tone::Warning => "warning",
    };
    context! { kind => "text", class => class, text => text.text }
}

/// Returns the blocks of a section. Plots that follow each other are one block, side by side.
fn blocks(
    section: &Section,
    pictures: &mut impl Iterator<Item = Vec<String>>,
) -> Result<Vec<Value>, ReportError> {
    let mut blocks = Vec::new();
    let mut plots = Vec::new();
    for block in &section.blocks {
        if let Block::Plot(plot) = block {
            plots.push(plot.to_page()?);
            continue;
        }
        if !plots.is_empty() {
            blocks.push(context! { kind => "plots", plots => std::mem::take(&mut plots) });
        }
        blocks.push(match block {
            Block::Text(of) => text(of),
            Block::Table(table) => context! { kind => "table", table => table },
            Block::Pictures(of) => viewer(of, pictures.next().unwrap_or_default()),
            Block::Plot(_) => continue,
        });
    }
    if !plots.is_empty() {
        blocks.push(context! { kind => "plots", plots => plots });
    }
    Ok(blocks)
}

fn viewer(of: &Pictures, addresses: Vec<String>) -> Value {
    let (width, height) = of.pictures.first().map_or((1, 1), |first| first.image.dimensions());
    let pictures = of.pictures.iter().zip(addresses).map(
        |(picture, address)| json!({ "label": picture.label, "caption": picture.caption, "address": address }),
    );
    context! {
        kind => "pictures",
        title => of.title,
        note => of.note,
        width => width,
        height => height,
        other => of.other_eye.map(|other| other.picture),
        other_is_left => of.other_eye.is_some_and(|other| other.is_left),
        pictures => pictures.collect::<Vec<_>>(),
    }
}

/// The pictures of a page as addresses, for each of its blocks of pictures.
struct Encoded {
    addresses: Vec<Vec<String>>,
    /// A sentence about how they were encoded; empty if there are none.
    note: String,
}

fn encode_pictures(report: &Report, budget: usize) -> Result<Encoded, ReportError> {
    let all = report.sections.iter().flat_map(|section| &section.blocks).filter_map(|block| match block {
        Block::Pictures(pictures) => Some(pictures),
        _ => None,
    });
    let all: Vec<&Pictures> = all.collect();
    if all.is_empty() {
        return Ok(Encoded { addresses: Vec::new(), note: String::new() });
    }
    let encode = |encoding: Encoding| -> image::ImageResult<Encoded> {
        let addresses = all.iter().map(|of| of.pictures.iter().map(|p| p.data_uri(encoding)).collect());
        Ok(Encoded { addresses: addresses.collect::<Result<_, _>>()?, note: encoding.note() })
    };
    let (last, others) = ENCODINGS.split_last().expect("there are encodings");
    for encoding in others {
        let encoded = encode(*encoding)?;
        if encoded.addresses.iter().flatten().map(String::len).sum::<usize>() <= budget {
            return Ok(encoded);
        }
    }
    Ok(encode(*last)?)
}

/// Returns a text as HTML: `**` encloses what is important, a backquote what a computer reads.
fn markup(text: &str) -> Value {
    let escaped = text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
    let mut html = String::new();
    for (i, code) in escaped.split('`').enumerate() {
        if i % 2 == 1 {
            html += &format!("<code>{code}</code>");
            continue;
        }
        for (i, part) in code.split("**").enumerate() {
            html += &if i % 2 == 1 { format!("<b>{part}</b>") } else { part.to_owned() };
        }
    }
    Value::from_safe_string(html)
}

#[cfg(test)]
mod tests {
    use image::RgbImage;

    use super::*;
    use crate::{Axis, Cell, Entry, OtherEye, Picture, Plot, Table};

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
        for foreign in [
            "<b>\"",
            "<one>",
            "<title>\"",
            "<c>",
            "https://",
            "<link",
            "url(",
            "@import",
            " src=\"/",
            "<script src",
        ] {
            assert!(!html.contains(foreign), "{foreign}");
        }
        assert!(html.contains("See <code>a &lt;c&gt;</code>, <b>not</b> less."));
        assert_eq!(
            html.matches("</script>").count(),
            4 + 1,
            "a row named like the end of a script ends none"
        );
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
