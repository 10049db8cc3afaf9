//! Plots: values of methods over a quantity or by row, drawn with plotters.

mod draw;
#[cfg(test)]
mod tests;

use anyhow::Context;
use serde_json::{Value, json};

use crate::palette::css_rules;
use crate::stats::unique;

/// A plot.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Plot {
    /// The heading.
    pub title: String,
    /// A note for the reader.
    pub caption: String,
    /// True if lines connect the points of a series.
    lines: bool,
    x: Axis,
    y: Axis,
    /// The names of the rows from top to bottom, in place of a vertical axis.
    rows: Vec<String>,
    /// The points of entries of the legend; the first are drawn last, on top.
    series: Vec<(Entry, Vec<Point>)>,
}

/// An axis.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Axis {
    /// The quantity and its unit.
    pub name: String,
    /// True if equal factors are equally far apart, instead of equal steps.
    logarithmic: bool,
    /// Values that the axis includes in any case.
    include: Vec<f64>,
    /// Values at which a line marks a baseline or a bound.
    lines_at: Vec<f64>,
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
    /// The ends of the interval of x.
    interval: Option<[f64; 2]>,
}

impl Point {
    fn is_finite(&self) -> bool {
        self.x.is_finite() && self.y.is_finite()
    }
}

impl Plot {
    /// Returns a plot without values of one quantity over another. [`Plot::curve`] adds values.
    pub fn curves(title: impl Into<String>, x: Axis, y: Axis) -> Plot {
        Plot { title: title.into(), lines: true, x, y, ..Plot::default() }
    }

    /// Returns a plot without values that has a row for each category. [`Plot::mark`] adds values.
    pub fn rows(title: impl Into<String>, value: Axis) -> Plot {
        Plot { title: title.into(), x: value, ..Plot::default() }
    }

    /// Returns the plot with a note for the reader.
    pub fn caption(self, caption: impl Into<String>) -> Plot {
        Plot { caption: caption.into(), ..self }
    }

    /// Adds the points of a curve, each with its x and y. Curves with equal entries share one entry of the legend.
    pub fn curve(&mut self, entry: Entry, points: impl IntoIterator<Item = (f64, f64)>) {
        let points = points.into_iter().map(|(x, y)| Point { x, y, interval: None });
        self.series.push((entry, points.collect()));
    }

    /// Adds a value to a row, which is appended if it is new. A value that is not finite is not drawn.
    pub fn mark(&mut self, row: &str, entry: Entry, value: f64) {
        self.mark_interval(row, entry, value, None);
    }

    /// Adds a value and its interval, drawn as a bar, to a row.
    pub fn mark_interval(&mut self, row: &str, entry: Entry, value: f64, interval: Option<[f64; 2]>) {
        let at = self.rows.iter().position(|name| name == row).unwrap_or_else(|| {
            self.rows.push(row.to_owned());
            self.rows.len() - 1
        });
        self.series.push((entry, vec![Point { x: value, y: at as f64, interval }]));
    }

    /// True if there is nothing to see.
    pub fn is_empty(&self) -> bool {
        self.legend().is_empty()
    }

    /// Returns every entry once: ours, then the paper's.
    pub fn legend(&self) -> Vec<&Entry> {
        let seen = self.series.iter().filter(|(_, points)| points.iter().any(Point::is_finite));
        let mut entries = unique(seen.map(|(entry, _)| entry));
        entries.sort_by_key(|entry| entry.papers);
        entries
    }

    fn has_intervals(&self) -> bool {
        self.series.iter().flat_map(|(_, points)| points).any(|point| point.interval.is_some())
    }

    /// Returns the plot with its legend as an SVG document, light or dark as its reader prefers.
    ///
    /// # Errors
    /// One sentence, if plotters refuses.
    pub fn to_svg(&self) -> anyhow::Result<String> {
        let style = format!("<style>@media (prefers-color-scheme: dark) {{{}}}</style>", css_rules());
        Ok(self.draw(true)?.0.replacen('>', &format!(">{style}"), 1))
    }

    fn draw(&self, with_legend: bool) -> anyhow::Result<(String, Vec<Value>)> {
        draw::draw(self, with_legend).with_context(|| format!("cannot draw the plot \"{}\"", self.title))
    }

    /// Returns what the page's template and script need: drawing, legend, and the points with their places.
    pub(crate) fn to_page(&self) -> anyhow::Result<Value> {
        let (svg, points) = self.draw(false)?;
        let with_line = self.lines || self.has_intervals();
        let entries = self
            .legend()
            .into_iter()
            .map(|entry| Ok(json!({ "label": entry.label, "swatch": draw::swatch(entry, with_line)? })));
        let data = json!({
            "x": self.x.name,
            "y": self.y.name,
            "rows": self.rows,
            "series": self.legend().iter().map(|entry| &entry.label).collect::<Vec<_>>(),
            "points": points,
        });
        Ok(json!({
            "title": self.title,
            "caption": self.caption,
            "svg": svg,
            "legend": entries.collect::<anyhow::Result<Vec<_>>>()?,
            // A script element ends at the first "</script", wherever it is.
            "data": data.to_string().replace('<', "\\u003c"),
        }))
    }
}
