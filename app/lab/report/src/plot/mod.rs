//! Plots: values of methods over a quantity or by row, drawn as SVG by plotters.

mod draw;
#[cfg(test)]
mod tests;

use serde_json::{Value, json};

use crate::Interval;
use crate::palette::css_rules;
use crate::stats::unique;

/// The error when a plot cannot be drawn.
#[derive(Debug, thiserror::Error)]
#[error("cannot draw the plot \"{title}\": {what}")]
pub struct PlotError {
    title: String,
    what: String,
}

/// A plot.
#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    /// The heading.
    pub title: String,
    /// A note for the reader.
    pub caption: String,
    style: Style,
    x: Axis,
    y: Axis,
    /// The names of the rows from top to bottom, in place of a vertical axis.
    rows: Vec<String>,
    /// The series; the first is drawn last, on top.
    series: Vec<Series>,
}

/// How the points of a series are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Style {
    /// A mark for each point, and lines between them.
    Curves,
    /// A mark for each point.
    Points,
}

/// An axis.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Axis {
    /// The quantity and its unit.
    pub name: String,
    /// True if equal factors are equally far apart, instead of equal steps.
    pub logarithmic: bool,
    /// Values that the axis includes in any case.
    pub include: Vec<f64>,
    /// Values at which a line marks a baseline or a bound.
    pub lines_at: Vec<f64>,
}

impl Axis {
    /// Returns a linear axis that fits the values.
    pub fn new(name: impl Into<String>) -> Axis {
        Axis { name: name.into(), ..Axis::default() }
    }

    /// Returns the axis extended to zero.
    pub fn from_zero(self) -> Axis {
        Axis { include: vec![0.0], ..self }
    }

    /// Returns the axis with a logarithmic scale.
    pub fn logarithmic(self) -> Axis {
        Axis { logarithmic: true, ..self }
    }

    /// Returns the axis with a line at a baseline, extended to zero.
    pub fn baseline(self, value: f64) -> Axis {
        self.from_zero().lines(&[value])
    }

    /// Returns the axis with lines at these values, extended to them.
    pub fn lines(mut self, values: &[f64]) -> Axis {
        self.lines_at.extend(values);
        self.include.extend(values);
        self
    }
}

/// What the points of a series have in common: an entry of the legend.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entry {
    /// The method that determines colour and mark.
    pub method: String,
    /// The label in the legend.
    pub label: String,
    /// True for the paper's figures: dashed, with hollow marks.
    pub papers: bool,
}

impl Entry {
    /// Returns the entry of our figures of a method.
    pub fn ours(method: impl Into<String>) -> Entry {
        let method = method.into();
        Entry { label: method.clone(), method, papers: false }
    }

    /// Returns the entry of the paper's figures of the system that corresponds to a method.
    pub fn papers(method: impl Into<String>, label: impl Into<String>) -> Entry {
        Entry { method: method.into(), label: label.into(), papers: true }
    }
}

/// A value and its interval.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Point {
    x: f64,
    /// The value on the vertical axis, or the number of the row.
    y: f64,
    /// The interval of x.
    interval: Option<Interval>,
}

impl Point {
    fn is_finite(&self) -> bool {
        self.x.is_finite() && self.y.is_finite()
    }
}

#[derive(Clone, Debug, PartialEq)]
struct Series {
    entry: Entry,
    points: Vec<Point>,
}

impl Plot {
    fn new(title: impl Into<String>, style: Style, x: Axis, y: Axis) -> Plot {
        let title = title.into();
        Plot { title, caption: String::new(), style, x, y, rows: Vec::new(), series: Vec::new() }
    }

    /// Returns a plot without values of one quantity over another. [`Plot::curve`] adds values.
    pub fn curves(title: impl Into<String>, x: Axis, y: Axis) -> Plot {
        Plot::new(title, Style::Curves, x, y)
    }

    /// Returns a plot without values of one quantity over another, without lines between them. [`Plot::curve`] adds
    /// values.
    pub fn points(title: impl Into<String>, x: Axis, y: Axis) -> Plot {
        Plot::new(title, Style::Points, x, y)
    }

    /// Returns a plot without values that has a row for each category. [`Plot::mark`] adds values.
    pub fn rows(title: impl Into<String>, value: Axis) -> Plot {
        Plot::new(title, Style::Points, value, Axis::default())
    }

    /// Returns the plot with a note for the reader.
    pub fn caption(self, caption: impl Into<String>) -> Plot {
        Plot { caption: caption.into(), ..self }
    }

    /// Adds the points of a curve, each with its x and y. Curves with equal entries share one entry of the legend.
    pub fn curve(&mut self, entry: Entry, points: impl IntoIterator<Item = (f64, f64)>) {
        let points = points.into_iter().map(|(x, y)| Point { x, y, interval: None });
        self.series.push(Series { entry, points: points.collect() });
    }

    /// Adds a value to a row, which is appended if it is new. A value that is not finite is not drawn.
    pub fn mark(&mut self, row: &str, entry: Entry, value: f64) {
        self.mark_interval(row, entry, value, None);
    }

    /// Adds a value and its interval, drawn as a bar, to a row.
    pub fn mark_interval(&mut self, row: &str, entry: Entry, value: f64, interval: Option<Interval>) {
        let at = self.rows.iter().position(|name| name == row).unwrap_or_else(|| {
            self.rows.push(row.to_owned());
            self.rows.len() - 1
        });
        let point = Point { x: value, y: at as f64, interval };
        match self.series.iter_mut().find(|series| series.entry == entry) {
            Some(series) => series.points.push(point),
            None => self.series.push(Series { entry, points: vec![point] }),
        }
    }

    /// True if there is nothing to see.
    pub fn is_empty(&self) -> bool {
        self.legend().is_empty()
    }

    /// Returns every entry once: ours, then the paper's.
    pub fn legend(&self) -> Vec<&Entry> {
        let seen = self.series.iter().filter(|series| series.points.iter().any(Point::is_finite));
        let mut entries = unique(seen.map(|series| &series.entry));
        entries.sort_by_key(|entry| entry.papers);
        entries
    }

    /// Returns the plot with its legend as an SVG document, light or dark as its reader prefers.
    ///
    /// # Errors
    /// [`PlotError`] if plotters refuses.
    pub fn to_svg(&self) -> Result<String, PlotError> {
        let svg = draw::draw_document(self).map_err(|error| self.error(&error))?;
        let style = format!("<style>@media (prefers-color-scheme: dark) {{{}}}</style>", css_rules());
        Ok(svg.replacen('>', &format!(">{style}"), 1))
    }

    fn draw(&self) -> Result<draw::Drawing, PlotError> {
        draw::draw(self).map_err(|error| self.error(&error))
    }

    fn error(&self, what: &impl ToString) -> PlotError {
        PlotError { title: self.title.clone(), what: what.to_string() }
    }

    /// Returns what the page's template and script need: drawing, legend, and the points with their places.
    pub(crate) fn to_page(&self) -> Result<Value, PlotError> {
        let drawing = self.draw()?;
        let legend = self.legend();
        let entries = legend.iter().zip(&drawing.swatches);
        let entries = entries.map(|(entry, swatch)| json!({ "label": entry.label, "swatch": swatch }));
        let data = json!({
            "x": self.x.name,
            "y": self.y.name,
            "rows": self.rows,
            "series": legend.iter().map(|entry| &entry.label).collect::<Vec<_>>(),
            "points": drawing.points,
        });
        Ok(json!({
            "title": self.title,
            "caption": self.caption,
            "svg": drawing.svg,
            "legend": entries.collect::<Vec<_>>(),
            // A script element ends at the first "</script", wherever it is.
            "data": data.to_string().replace('<', "\\u003c"),
        }))
    }
}
