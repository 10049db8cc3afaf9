//! An experiment on the page.

use yoro_figures::grid::Table;
use yoro_figures::plot::{Figure, Panel};

/// An experiment on the page.
#[derive(Debug)]
pub struct Section {
    /// Anchor, and beginning of the figures' names.
    pub id: String,
    /// Heading.
    pub title: String,
    /// Description of the measurement, and of the paper's.
    pub intro: String,
    /// Figures in their order on the page.
    pub figures: Vec<Figure>,
    /// Tables in their order on the page.
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
