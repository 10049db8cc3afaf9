//! Tables for the page and as Markdown.

use serde::Serialize;

/// The kind of a cell, which decides how it looks on the page.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// A name or a fact.
    #[default]
    Plain,
    /// A text that may take several lines.
    Long,
    /// One of our figures.
    Ours,
    /// A baseline that our figures are compared with.
    Base,
    /// One of the paper's figures.
    Paper,
}

/// A cell.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Cell {
    /// The text; empty if there is nothing to show.
    pub text: String,
    /// The kind.
    pub kind: Kind,
    /// The number of columns that the cell spans.
    pub span: usize,
}

impl Cell {
    fn new(kind: Kind, text: impl Into<String>) -> Cell {
        Cell { text: text.into(), kind, span: 1 }
    }

    /// Returns a cell with a name or a fact.
    pub fn plain(text: impl Into<String>) -> Cell {
        Cell::new(Kind::Plain, text)
    }

    /// Returns a cell with a text that may take several lines.
    pub fn long(text: impl Into<String>) -> Cell {
        Cell::new(Kind::Long, text)
    }

    /// Returns a cell with one of our figures, or a dash if it is `None`.
    pub fn ours(value: Option<impl Into<String>>) -> Cell {
        Cell::new(Kind::Ours, value.map_or("–".into(), Into::into))
    }

    /// Returns a cell with a baseline, or a dash if it is `None`.
    pub fn base(value: Option<impl Into<String>>) -> Cell {
        Cell::new(Kind::Base, value.map_or("–".into(), Into::into))
    }

    /// Returns a cell with one of the paper's figures, or a dash if it is `None`.
    pub fn paper(value: Option<impl Into<String>>) -> Cell {
        Cell::new(Kind::Paper, value.map_or("–".into(), Into::into))
    }
}

/// The head of a column.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Column {
    /// The quantity and its unit.
    pub name: String,
    /// True if the column holds text, which is aligned to the left, rather than numbers.
    pub left: bool,
}

/// A row.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Line {
    /// The cells. Their spans add up to the number of columns.
    pub cells: Vec<Cell>,
    /// True if a rule above the row separates it from the rows before.
    pub first: bool,
}

/// A table.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Table {
    /// The heading.
    pub title: String,
    /// The heads of the columns.
    pub columns: Vec<Column>,
    /// The rows, from top to bottom.
    pub lines: Vec<Line>,
    /// A note for the reader.
    pub note: String,
}

impl Table {
    /// Returns a table without rows. A column name that starts with `<` marks a column of text.
    pub fn new(title: impl Into<String>, columns: &[impl AsRef<str>]) -> Table {
        let column =
            |name: &str| Column { name: name.trim_start_matches('<').into(), left: name.starts_with('<') };
        let columns = columns.iter().map(|name| column(name.as_ref())).collect();
        Table { title: title.into(), columns, lines: Vec::new(), note: String::new() }
    }

    /// Appends a row.
    pub fn push(&mut self, cells: Vec<Cell>) {
        self.lines.push(Line { cells, first: false });
    }

    /// Appends a row with a rule above it.
    pub fn push_first(&mut self, cells: Vec<Cell>) {
        self.lines.push(Line { cells, first: true });
    }

    /// Puts a rule above each row whose first cell differs from that of the row before.
    pub fn group(&mut self) {
        for i in 0..self.lines.len() {
            self.lines[i].first = i == 0 || self.lines[i - 1].cells[0] != self.lines[i].cells[0];
        }
    }

    /// Appends a row whose figures are replaced by the reason for their absence.
    pub fn push_reason(&mut self, mut cells: Vec<Cell>, reason: &str) {
        let span = self.columns.len().saturating_sub(cells.len()).max(1);
        cells.push(Cell { text: format!("not measured: {reason}"), kind: Kind::Base, span });
        self.push(cells);
    }

    /// Returns the table in GitHub's Markdown.
    pub fn markdown(&self) -> String {
        let escape = |text: &str| text.replace('|', "\\|").replace(['\n', '\r'], " ").replace('<', "&lt;");
        let row = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
        let mut out = format!("**{}**\n\n", escape(&self.title));
        out += &row(self.columns.iter().map(|column| escape(&column.name)).collect());
        let rules = self.columns.iter().map(|column| if column.left { "---|" } else { "---:|" });
        out += &format!("|{}\n", rules.collect::<String>());
        for line in &self.lines {
            let cell = |cell: &Cell| {
                let text = escape(&cell.text);
                let text = if cell.kind == Kind::Paper && text != "–" { format!("*{text}*") } else { text };
                text + &" |".repeat(cell.span.saturating_sub(1))
            };
            out += &row(line.cells.iter().map(cell).collect());
        }
        if !self.note.is_empty() {
            out += &format!("\n{}\n", escape(&self.note));
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_markdown_row_has_as_many_cells_as_columns() {
        let mut table = Table::new("Frame | time", &["<method", "ms", "the paper's"]);
        table.push(vec![Cell::plain("a|b"), Cell::ours(Some("1.0")), Cell::paper(Some("2"))]);
        table.push(vec![Cell::plain("c"), Cell::ours(None::<String>), Cell::paper(None::<String>)]);
        table.push_reason(vec![Cell::plain("multiview")], "no GL_OVR_multiview2");
        let markdown = table.markdown();
        let lines: Vec<&str> = markdown.lines().skip(2).collect();
        for line in &lines {
            assert_eq!(line.replace("\\|", "").matches('|').count(), 4, "{line}");
        }
        assert_eq!(lines[1], "|---|---:|---:|");
        assert_eq!(lines[2], "| a\\|b | 1.0 | *2* |");
        assert_eq!(lines[4], "| multiview | not measured: no GL_OVR_multiview2 | |");
    }
}
