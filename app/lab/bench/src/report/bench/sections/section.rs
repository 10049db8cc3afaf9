//! An experiment on the page.

use yoro_report::grid::Table;
use yoro_report::plot::{Figure, Panel};

/// An experiment on the page.
#[derive(Debug)]
pub struct Section {
    /// The anchor, and the prefix of the figures' names.
    pub id: String,
    /// The heading.
    pub title: String,
    /// A description of our measurement and of the paper's.
    pub intro: String,
    /// The figures in the order of the page.
    pub figures: Vec<Figure>,
    /// The tables in the order of the page.
    pub tables: Vec<Table>,
}

impl Section {
    pub fn new(id: &str, title: &str, intro: &str) -> Section {
        Section {
            id: id.into(),
            title: title.into(),
            intro: intro.into(),
            figures: Vec::new(),
            tables: Vec::new(),
        }
    }

    pub fn figure(&mut self, id: &str, title: &str, caption: &str, panel: Panel) {
        let (id, title, caption) = (format!("{}-{id}", self.id), title.into(), caption.into());
        let figure = Figure { id, title, caption, panel };
        if !figure.is_empty() {
            self.figures.push(figure);
        }
    }

    pub fn table(&mut self, table: Table) {
        if !table.lines.is_empty() {
            self.tables.push(table);
        }
    }
}
