//! A report: sections of text, tables, plots and pictures, as a page and as Markdown.

use std::fmt;
use std::path::{Path, PathBuf};

use serde::Serialize;

use crate::text::slug;
use crate::{Pictures, Plot, Table, page};

/// A report. It is written as one page that loads nothing from elsewhere, and as Markdown without plots and pictures.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// The heading of the page.
    pub title: String,
    /// What a reader who reads nothing else should know.
    pub summary: Vec<Text>,
    /// The sections in the order of the page.
    pub sections: Vec<Section>,
}

/// A section of a report.
#[derive(Clone, Debug, Default)]
pub struct Section {
    /// The heading.
    pub heading: String,
    /// What tells the section from another one with the same heading, such as the machine; mostly empty.
    pub place: String,
    /// What the section consists of, in the order of the page.
    pub blocks: Vec<Block>,
}

/// A part of a section.
#[derive(Clone, Debug)]
pub enum Block {
    /// A paragraph.
    Text(Text),
    /// A table, which readers can copy as CSV.
    Table(Table),
    /// A plot, whose values the page shows under the pointer.
    Plot(Plot),
    /// Pictures of one view, which the page shows in turn.
    Pictures(Pictures),
}

/// How much attention a paragraph asks for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Tone {
    /// As much as any other.
    #[default]
    Plain,
    /// Less: a note.
    Quiet,
    /// More: the figures are not what they seem.
    Warning,
}

/// A paragraph, in which `**` encloses what is important and a backquote what a computer reads.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Text {
    /// The text.
    pub text: String,
    /// How much attention it asks for.
    pub tone: Tone,
}

impl Text {
    /// Returns a note.
    pub fn quiet(text: impl Into<String>) -> Text {
        Text { text: text.into(), tone: Tone::Quiet }
    }

    /// Returns a warning.
    pub fn warning(text: impl Into<String>) -> Text {
        Text { text: text.into(), tone: Tone::Warning }
    }

    fn markdown(&self) -> String {
        let text = self.text.replace('<', "&lt;");
        if self.tone == Tone::Warning { format!("**{text}**") } else { text }
    }
}

impl<T: Into<String>> From<T> for Text {
    fn from(text: T) -> Text {
        Text { text: text.into(), tone: Tone::Plain }
    }
}

impl Section {
    /// Returns a section that begins with a paragraph; an empty one is left out.
    pub fn new(heading: impl Into<String>, introduction: impl Into<String>) -> Section {
        let mut section = Section { heading: heading.into(), ..Section::default() };
        section.text(introduction.into());
        section
    }

    /// Appends a paragraph, unless it is empty.
    pub fn text(&mut self, text: impl Into<Text>) {
        let text = text.into();
        if !text.text.is_empty() {
            self.blocks.push(Block::Text(text));
        }
    }

    /// Appends a table, unless it has no rows.
    pub fn table(&mut self, table: Table) {
        if !table.lines.is_empty() {
            self.blocks.push(Block::Table(table));
        }
    }

    /// Appends a plot, unless there is nothing to see on it.
    pub fn plot(&mut self, plot: Plot) {
        if !plot.is_empty() {
            self.blocks.push(Block::Plot(plot));
        }
    }

    /// Appends pictures, unless there are none.
    pub fn pictures(&mut self, pictures: Pictures) {
        if !pictures.pictures.is_empty() {
            self.blocks.push(Block::Pictures(pictures));
        }
    }

    /// Returns the tables in the order of the page.
    pub fn tables(&self) -> impl Iterator<Item = &Table> {
        self.blocks.iter().filter_map(|block| match block {
            Block::Table(table) => Some(table),
            _ => None,
        })
    }

    /// Returns the plots in the order of the page.
    pub fn plots(&self) -> impl Iterator<Item = &Plot> {
        self.blocks.iter().filter_map(|block| match block {
            Block::Plot(plot) => Some(plot),
            _ => None,
        })
    }

    /// True if there is nothing but text.
    pub fn is_empty(&self) -> bool {
        self.blocks.iter().all(|block| matches!(block, Block::Text(_)))
    }

    /// Returns the heading, with the place in parentheses if there is one.
    pub fn full_heading(&self) -> String {
        let Section { heading, place, .. } = self;
        if place.is_empty() { heading.clone() } else { format!("{heading} ({place})") }
    }

    /// Returns the name of the section's anchor on the page.
    pub fn anchor(&self) -> String {
        slug(&self.full_heading())
    }
}

impl Report {
    /// Returns the page.
    ///
    /// # Errors
    /// One sentence if a picture cannot be encoded.
    pub fn to_html(&self) -> anyhow::Result<String> {
        page::render(self)
    }

    /// Returns all texts and tables as Markdown.
    pub fn to_markdown(&self) -> String {
        let mut out = format!("# {}\n", self.title);
        let mut paragraph = |text: &str| out += &format!("\n{text}\n");
        self.summary.iter().for_each(|text| paragraph(&text.markdown()));
        for section in &self.sections {
            paragraph(&format!("## {}", section.full_heading().replace('<', "&lt;")));
            for block in &section.blocks {
                match block {
                    Block::Text(text) => paragraph(&text.markdown()),
                    Block::Table(table) => paragraph(table.markdown().trim_end()),
                    Block::Plot(_) | Block::Pictures(_) => {}
                }
            }
        }
        out
    }

    /// Writes `NAME.html` and `NAME.md` into `folder`, and `NAME.json` if there is a text for it.
    ///
    /// # Errors
    /// One sentence. All files are made before the first one is written.
    pub fn write(&self, folder: &Path, name: &str, json: Option<&str>) -> anyhow::Result<ReportFiles> {
        let html = self.to_html()?;
        let write = |ending: &str, text: &str| {
            let path = folder.join(format!("{name}.{ending}"));
            yoro_files::write(&path, text.as_bytes()).map(|()| path)
        };
        // The page comes last, since it is what people open.
        let json = json.map(|json| write("json", json)).transpose()?;
        let markdown = write("md", &self.to_markdown())?;
        Ok(ReportFiles { page: write("html", &html)?, markdown, json })
    }
}

/// The files of a report.
#[derive(Debug)]
pub struct ReportFiles {
    /// The HTML page.
    pub page: PathBuf,
    /// Texts and tables as Markdown.
    pub markdown: PathBuf,
    /// All figures as JSON, for a report that is not made from such a file.
    pub json: Option<PathBuf>,
}

impl fmt::Display for ReportFiles {
    /// Writes a line for each file: what it is, and its path.
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let (page, markdown) = (self.page.display(), self.markdown.display());
        writeln!(f, "page:   {page}\ntables: {markdown}")?;
        self.json.iter().try_for_each(|json| writeln!(f, "json:   {}", json.display()))
    }
}
