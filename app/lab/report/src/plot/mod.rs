//! Figures, drawn as SVG by plotters in the colours of the light page. The page's style sheet replaces them by those of
//! the dark one.

mod axis;
mod draw;
#[cfg(test)]
mod tests;

use std::collections::BTreeSet;

use crate::inference::Interval;

/// A method, whether the figures are the paper's, and the label.
type LegendEntry = (String, bool, String);

/// The error when a figure cannot be drawn.
#[derive(Debug, thiserror::Error)]
#[error("cannot draw the figure {id}: {what}")]
pub struct PlotError {
    id: String,
    what: String,
}

/// One figure.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// The name of its file, and its anchor on the page.
    pub id: String,
    /// Its heading.
    pub title: String,
    /// A note for the reader.
    pub caption: String,
    /// The plot.
    pub panel: Panel,
}

/// The kinds of plots.
#[derive(Clone, Debug, PartialEq)]
pub enum Panel {
    /// One quantity over another.
    Curves {
        /// Horizontal axis.
        x: Axis,
        /// Vertical axis.
        y: Axis,
        /// The curves in the order of drawing, the last on top.
        series: Vec<Series>,
    },
    /// Values over time that lie close together: thin lines without marks, interrupted where a value is not finite.
    Traces {
        /// Horizontal axis.
        x: Axis,
        /// Vertical axis.
        y: Axis,
        /// The curves in the order of drawing, the last on top. Curves with equal labels share one entry of the legend.
        series: Vec<Series>,
    },
    /// Values of the same persons with several methods: a box for each method, and a thin line for each person.
    Paired {
        /// Vertical axis.
        value: Axis,
        /// The methods, from left to right.
        methods: Vec<String>,
        /// The values of each person, one for each method.
        persons: Vec<Vec<f64>>,
    },
    /// A row for each category, with a mark for each method.
    Dots {
        /// Horizontal axis.
        value: Axis,
        /// The rows, from top to bottom.
        rows: Vec<DotRow>,
    },
}

/// The scale of an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scale {
    /// Equal steps are equally far apart.
    #[default]
    Linear,
    /// Equal factors are equally far apart.
    Logarithmic,
}

/// An axis.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Axis {
    /// The quantity and its unit.
    pub name: String,
    /// The scale.
    pub scale: Scale,
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
        Axis { scale: Scale::Logarithmic, ..self }
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

/// A curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// The method that determines colour and mark.
    pub method: String,
    /// True for the paper's figures: dashed, with hollow marks.
    pub papers: bool,
    /// The label in the legend.
    pub label: String,
    /// The points, ordered by x.
    pub points: Vec<(f64, f64)>,
}

/// A row of a dot plot.
#[derive(Clone, Debug, PartialEq)]
pub struct DotRow {
    /// The category.
    pub label: String,
    /// The marks in the order of drawing.
    pub marks: Vec<Mark>,
}

/// A mark of a dot plot.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    /// The method that determines colour and mark.
    pub method: String,
    /// True for the paper's figures: hollow.
    pub papers: bool,
    /// The label in the legend.
    pub label: String,
    /// The value on the axis. If it is not finite, the mark is not drawn.
    pub value: f64,
    /// The interval, drawn as a bar; such a mark gets a lane of its own in its row.
    pub interval: Option<Interval>,
}

impl Mark {
    /// Returns a mark for one of our figures.
    pub fn new(method: impl Into<String>, label: impl Into<String>, value: f64) -> Mark {
        Mark { method: method.into(), papers: false, label: label.into(), value, interval: None }
    }

    /// Returns a mark for one of the paper's figures.
    pub fn papers(method: impl Into<String>, label: impl Into<String>, value: f64) -> Mark {
        Mark { papers: true, ..Mark::new(method, label, value) }
    }
}

impl Figure {
    /// Returns the figure as an SVG document.
    ///
    /// # Errors
    /// [`PlotError`] if plotters refuses.
    pub fn svg(&self) -> Result<String, PlotError> {
        let mut svg = String::new();
        draw::draw(self, &mut svg)
            .map_err(|error| PlotError { id: self.id.clone(), what: error.to_string() })?;
        Ok(svg)
    }

    /// True if there is nothing to see.
    pub fn is_empty(&self) -> bool {
        self.legend().is_empty()
    }

    /// Returns every method once, ours before the paper's. Whatever is drawn last, on top, is listed first.
    fn legend(&self) -> Vec<LegendEntry> {
        let all: Vec<LegendEntry> = match &self.panel {
            Panel::Curves { series, .. } | Panel::Traces { series, .. } => {
                let drawn =
                    series.iter().filter(|s| s.points.iter().any(|p| p.0.is_finite() && p.1.is_finite()));
                drawn.map(|s| (s.method.clone(), s.papers, s.label.clone())).collect()
            }
            Panel::Paired { methods, persons, .. } => {
                let methods = methods.iter().rev().filter(|_| !persons.is_empty());
                methods.map(|method| (method.clone(), false, method.clone())).collect()
            }
            Panel::Dots { rows, .. } => {
                let marks = rows.iter().flat_map(|row| &row.marks).filter(|mark| mark.value.is_finite());
                marks.map(|m| (m.method.clone(), m.papers, m.label.clone())).collect()
            }
        };
        let mut seen = BTreeSet::new();
        let mut unique: Vec<_> = all.into_iter().rev().filter(|entry| seen.insert(entry.clone())).collect();
        unique.sort_by_key(|(_, papers, _)| *papers);
        unique
    }
}
