//! Figures, drawn as SVG by plotters. Colours are those of the light page; the page's style sheet exchanges them
//! for the dark one's.

mod axis;
mod draw;
#[cfg(test)]
mod tests;

use std::collections::BTreeSet;

use crate::inference::Interval;

/// Method, whether it is the paper's, and label.
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
    /// Name of its file, and its anchor on the page.
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
    /// A value over another.
    Curves {
        /// Horizontal axis.
        x: Axis,
        /// Vertical axis.
        y: Axis,
        /// One after the other, the last on top.
        series: Vec<Series>,
    },
    /// Values over time, close together: thin lines without marks, broken where a point is not finite.
    Traces {
        /// Horizontal axis.
        x: Axis,
        /// Vertical axis.
        y: Axis,
        /// One after the other, the last on top; of equal labels one is in the legend.
        series: Vec<Series>,
    },
    /// Values of the same persons under several methods: a box for each method, and a thin line for each person.
    Paired {
        /// Vertical axis.
        value: Axis,
        /// Methods, from left to right.
        methods: Vec<String>,
        /// The values of each person, one for each method.
        persons: Vec<Vec<f64>>,
    },
    /// A line for each category with a mark for each method.
    Dots {
        /// Horizontal axis.
        value: Axis,
        /// Rows, from top to bottom.
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
    /// Quantity and unit.
    pub name: String,
    /// The scale of an axis.
    pub scale: Scale,
    /// The axis reaches at least to these.
    pub include: Vec<f64>,
    /// Lines for a baseline, or for bounds.
    pub lines_at: Vec<f64>,
}

impl Axis {
    /// A linear axis that fits the values.
    pub fn new(name: impl Into<String>) -> Axis {
        Axis { name: name.into(), ..Axis::default() }
    }

    /// Reaches at least to zero.
    pub fn from_zero(self) -> Axis {
        Axis { include: vec![0.0], ..self }
    }

    /// Returns the axis with a logarithmic scale.
    pub fn logarithmic(self) -> Axis {
        Axis { scale: Scale::Logarithmic, ..self }
    }

    /// Returns the axis with a line for a baseline, and from zero.
    pub fn baseline(self, value: f64) -> Axis {
        self.from_zero().lines(&[value])
    }

    /// Returns the axis with lines at these values, and reaching at least to them.
    pub fn lines(mut self, values: &[f64]) -> Axis {
        self.lines_at.extend(values);
        self.include.extend(values);
        self
    }
}

/// A curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// The method whose colour and mark it has.
    pub method: String,
    /// The paper's figures: dashed, marks hollow.
    pub papers: bool,
    /// Label in the legend.
    pub label: String,
    /// Points in the order of x.
    pub points: Vec<(f64, f64)>,
}

/// A line of a dot plot.
#[derive(Clone, Debug, PartialEq)]
pub struct DotRow {
    /// The category.
    pub label: String,
    /// Marks in the order of drawing.
    pub marks: Vec<Mark>,
}

/// A mark of a dot plot.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    /// The method whose colour and mark it has.
    pub method: String,
    /// The paper's figure: hollow.
    pub papers: bool,
    /// Label in the legend.
    pub label: String,
    /// Value on the axis; not drawn if it is not finite.
    pub value: f64,
    /// Drawn as a bar, and makes room for itself on its line.
    pub interval: Option<Interval>,
}

impl Mark {
    /// A figure of ours.
    pub fn new(method: impl Into<String>, label: impl Into<String>, value: f64) -> Mark {
        Mark { method: method.into(), papers: false, label: label.into(), value, interval: None }
    }

    /// A figure of the paper's.
    pub fn papers(method: impl Into<String>, label: impl Into<String>, value: f64) -> Mark {
        Mark { papers: true, ..Mark::new(method, label, value) }
    }
}

impl Figure {
    /// The figure as an SVG document.
    ///
    /// # Errors
    /// [`PlotError`] when plotters refuses.
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

    /// Returns every method once: ours first, then the paper's. What is drawn last, on top, is named first.
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
