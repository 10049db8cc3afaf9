//! Figures, drawn as SVG by plotters. Colours are those of the light page; the page's style sheet exchanges them
//! for the dark one's.

use std::collections::BTreeSet;

use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::element::DashedPathElement;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::palette::{self, Look, Shape};
use crate::inference::Interval;
use crate::stats::percentile;

/// Why a figure could not be drawn.
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
    /// What it shows.
    pub title: String,
    /// What must be known to read it.
    pub caption: String,
    /// What is drawn.
    pub panel: Panel,
}

/// What a figure consists of.
#[derive(Clone, Debug, PartialEq)]
pub enum Panel {
    /// A value over another.
    Curves {
        /// To the right.
        x: Axis,
        /// Upwards.
        y: Axis,
        /// One after the other, the last on top.
        series: Vec<Series>,
    },
    /// Values over time, close together: thin lines without marks, broken where a point is not finite.
    Traces {
        /// To the right.
        x: Axis,
        /// Upwards.
        y: Axis,
        /// One after the other, the last on top; of equal labels one is in the legend.
        series: Vec<Series>,
    },
    /// Values of the same persons under several methods: a box for each method, and a thin line for each person.
    Paired {
        /// Upwards.
        value: Axis,
        /// From left to right.
        methods: Vec<String>,
        /// For each person a value under each method.
        persons: Vec<Vec<f64>>,
    },
    /// A line for each category with a mark for each method.
    Dots {
        /// To the right.
        value: Axis,
        /// From top to bottom.
        rows: Vec<DotRow>,
    },
}

/// How values become positions.
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
    /// How values become positions.
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

    /// Logarithmic.
    pub fn logarithmic(self) -> Axis {
        Axis { scale: Scale::Logarithmic, ..self }
    }

    /// With a line for a baseline, and from zero.
    pub fn baseline(self, value: f64) -> Axis {
        self.from_zero().lines(&[value])
    }

    /// With lines at these values, and reaching at least to them.
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
    /// In the legend.
    pub label: String,
    /// In the order of x.
    pub points: Vec<(f64, f64)>,
}

/// A line of a dot plot.
#[derive(Clone, Debug, PartialEq)]
pub struct DotRow {
    /// The category.
    pub label: String,
    /// In the order of drawing.
    pub marks: Vec<Mark>,
}

/// A mark of a dot plot.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    /// The method whose colour and mark it has.
    pub method: String,
    /// The paper's figure: hollow.
    pub papers: bool,
    /// In the legend.
    pub label: String,
    /// On the axis; what is not finite is not drawn.
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

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type DrawingResult = Result<(), DrawingAreaErrorKind<std::io::Error>>;

/// Width of all figures in SVG units: two to a CSS pixel at natural size, since plotters rounds to whole units.
const WIDTH: i32 = 1200;
const EM: i32 = 26;
const LINE: i32 = 38;
const MARK: i32 = 9;
const MARGIN: i32 = 24;
const CURVES_HEIGHT: i32 = 560;
const ROW_HEIGHT: i32 = 50;
/// Between the marks of one row that have intervals.
const LANE: i32 = 26;
/// Characters that fit to the left of a dot plot.
const LABEL: usize = 20;

impl Figure {
    /// The figure as an SVG document.
    ///
    /// # Errors
    /// [`PlotError`] when plotters refuses.
    pub fn svg(&self) -> Result<String, PlotError> {
        let mut svg = String::new();
        self.draw(&mut svg).map_err(|error| PlotError { id: self.id.clone(), what: error.to_string() })?;
        // Plotters names no font style; a browser's own sans-serif is right for page and file.
        Ok(svg)
    }

    /// Whether there is anything to see.
    pub fn is_empty(&self) -> bool {
        self.legend().is_empty()
    }

    fn draw(&self, svg: &mut String) -> DrawingResult {
        let legend = self.legend();
        let lines = legend_lines(&legend);
        let top = MARGIN + lines.len() as i32 * LINE + LINE / 2;
        let (left, height) = match &self.panel {
            Panel::Curves { .. } | Panel::Traces { .. } | Panel::Paired { .. } => (6 * EM, CURVES_HEIGHT),
            Panel::Dots { rows, .. } => {
                (LABEL as i32 * EM * 6 / 10, rows.iter().map(row_height).sum::<i32>().max(ROW_HEIGHT))
            }
        };
        let bottom = top + height;
        let size = (WIDTH as u32, (bottom + 2 * LINE + MARGIN) as u32);
        let root = SVGBackend::with_string(svg, size).into_drawing_area();
        root.fill(&rgb(palette::BACKGROUND.0))?;
        draw_legend(&root, &lines, !matches!(self.panel, Panel::Traces { .. }))?;
        let frame = Frame { left, right: WIDTH - 2 * MARGIN, top, bottom };
        match &self.panel {
            Panel::Curves { x, y, series } => draw_curves(&root, &frame, x, y, series, true)?,
            Panel::Traces { x, y, series } => draw_curves(&root, &frame, x, y, series, false)?,
            Panel::Paired { value, methods, persons } => {
                draw_paired(&root, &frame, value, methods, persons)?;
            }
            Panel::Dots { value, rows } => draw_dots(&root, &frame, value, rows)?,
        }
        root.present()
    }

    /// Every method once: ours first, then the paper's. What is drawn last, on top, is named first.
    fn legend(&self) -> Vec<(String, bool, String)> {
        let all: Vec<(String, bool, String)> = match &self.panel {
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

/// The plotting area in SVG units.
struct Frame {
    left: i32,
    right: i32,
    top: i32,
    bottom: i32,
}

fn rgb(color: u32) -> RGBColor {
    RGBColor((color >> 16) as u8, (color >> 8) as u8, color as u8)
}

fn text(size: i32, horizontal: HPos, vertical: VPos) -> TextStyle<'static> {
    // The backend divides by 1.24.
    let style: TextStyle = ("sans-serif", f64::from(size) * 1.24).into_text_style(&(0, 0));
    let color = rgb(palette::TEXT.0).to_backend_color();
    TextStyle { color, ..style }.pos(Pos::new(horizontal, vertical))
}

fn text_width(text: &str) -> i32 {
    text.chars().count() as i32 * EM * 56 / 100
}

type LegendEntry = (String, bool, String);

fn legend_lines(legend: &[LegendEntry]) -> Vec<Vec<(i32, LegendEntry)>> {
    let mut lines = vec![Vec::new()];
    let mut x = MARGIN;
    for entry in legend {
        let width = 3 * EM + text_width(&entry.2) + EM;
        if x + width > WIDTH - MARGIN && x > MARGIN {
            lines.push(Vec::new());
            x = MARGIN;
        }
        if let Some(line) = lines.last_mut() {
            line.push((x, entry.clone()));
        }
        x += width;
    }
    lines
}

fn draw_legend(root: &Area, lines: &[Vec<(i32, LegendEntry)>], marks: bool) -> DrawingResult {
    for (i, line) in lines.iter().enumerate() {
        let y = MARGIN + i as i32 * LINE + LINE / 2;
        for (x, (method, papers, label)) in line {
            let look = palette::of(method);
            stroke(root, vec![(*x, y), (x + 2 * EM, y)], &look, *papers)?;
            if marks {
                mark(root, (x + EM, y), &look, *papers)?;
            }
            root.draw_text(label, &text(EM, HPos::Left, VPos::Center), (x + 2 * EM + EM / 2, y))?;
        }
    }
    Ok(())
}

/// A line of a method; dashed for the paper's.
fn stroke(root: &Area, points: Vec<(i32, i32)>, look: &Look, papers: bool) -> DrawingResult {
    let style = rgb(look.light).stroke_width(4);
    if papers {
        root.draw(&DashedPathElement::new(points, 14, 9, style))
    } else {
        root.draw(&PathElement::new(points, style))
    }
}

/// A mark of a method; hollow for the paper's.
fn mark(root: &Area, (x, y): (i32, i32), look: &Look, papers: bool) -> DrawingResult {
    let hollow = papers || look.hollow;
    let (color, background) = (rgb(look.light), rgb(palette::BACKGROUND.0));
    let outline = |r: i32| -> Vec<(i32, i32)> {
        let corners: &[(i32, i32)] = match look.shape {
            Shape::Circle => &[],
            Shape::Square => &[(-9, -9), (9, -9), (9, 9), (-9, 9)],
            Shape::Diamond => &[(0, -13), (13, 0), (0, 13), (-13, 0)],
            Shape::Up => &[(0, -12), (12, 9), (-12, 9)],
            Shape::Down => &[(0, 12), (12, -9), (-12, -9)],
            Shape::Cross => &[
                (-10, -5),
                (-5, -10),
                (0, -5),
                (5, -10),
                (10, -5),
                (5, 0),
                (10, 5),
                (5, 10),
                (0, 5),
                (-5, 10),
                (-10, 5),
                (-5, 0),
            ],
        };
        corners.iter().map(|(dx, dy)| (x + dx * r / MARK, y + dy * r / MARK)).collect()
    };
    if look.shape == Shape::Circle {
        root.draw(&Circle::new((x, y), MARK + 3, background.filled()))?;
        let style = if hollow { color.stroke_width(4) } else { color.filled() };
        return root.draw(&Circle::new((x, y), MARK + 1, style));
    }
    root.draw(&Polygon::new(outline(MARK + 3), background.filled()))?;
    if !hollow {
        return root.draw(&Polygon::new(outline(MARK), color.filled()));
    }
    let mut closed = outline(MARK);
    closed.extend(closed.clone().into_iter().take(2));
    root.draw(&PathElement::new(closed, color.stroke_width(4)))
}

/// Where the values of an axis go, between 0 and 1 of its length, and its ticks.
struct Range {
    scale: Scale,
    low: f64,
    high: f64,
    ticks: Vec<f64>,
}

impl Range {
    fn of(axis: &Axis, values: impl Iterator<Item = f64>, snap: bool) -> Range {
        let drawable = |v: &f64| v.is_finite() && (axis.scale == Scale::Linear || *v > 0.0);
        let all = values.chain(axis.include.iter().copied()).filter(drawable);
        let (low, high) = all.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        let (low, high) = if low <= high { (low, high) } else { (1.0, 2.0) };
        match axis.scale {
            Scale::Linear => {
                let spare = if low < high { 0.0 } else { (low.abs() * 0.1).max(1e-3) };
                let (low, high) = (low - spare, high + spare);
                let step = tick_step(high - low);
                let (first, last) = ((low / step + 1e-6).floor(), (high / step - 1e-6).ceil());
                let ticks: Vec<f64> = (first as i64..=last as i64).map(|i| i as f64 * step).collect();
                if snap {
                    return Range { scale: axis.scale, low: first * step, high: last * step, ticks };
                }
                let margin = (high - low) * 0.03;
                let (low, high) = (low - margin, high + margin);
                let ticks = ticks.into_iter().filter(|t| (low..=high).contains(t)).collect();
                Range { scale: axis.scale, low, high, ticks }
            }
            Scale::Logarithmic => {
                let (low, high) = (low / 1.2, high * 1.2);
                let powers = low.log10().floor() as i32..=high.log10().ceil() as i32;
                let steps: &[f64] = match high / low {
                    0.0..=12.0 => &[1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0],
                    0.0..=1e3 => &[1.0, 2.0, 5.0],
                    _ => &[1.0],
                };
                let ticks = powers.flat_map(|p| steps.iter().map(move |s| s * 10f64.powi(p)));
                let ticks = ticks.filter(|t| (low..=high).contains(t)).collect();
                Range { scale: axis.scale, low, high, ticks }
            }
        }
    }

    /// As drawn: logarithmic axes in powers of ten.
    fn drawn(&self, value: f64) -> f64 {
        match self.scale {
            Scale::Linear => value,
            Scale::Logarithmic => value.max(f64::MIN_POSITIVE).log10(),
        }
    }

    fn coordinate(&self) -> std::ops::Range<f64> {
        self.drawn(self.low)..self.drawn(self.high)
    }
}

/// 1, 2 or 5 times a power of ten: three to eight steps in `range`.
fn tick_step(range: f64) -> f64 {
    let power = 10f64.powf((range / 3.0).log10().floor());
    [5.0, 2.0, 1.0].into_iter().map(|m| m * power).find(|step| range / step >= 3.0).unwrap_or(power)
}

/// As short as it can be told apart from its neighbours.
fn tick_label(value: f64, ticks: &[f64], scale: Scale) -> String {
    let decimals = |step: f64| (-step.abs().log10().floor()).clamp(0.0, 6.0) as usize;
    let label = match (scale, ticks) {
        (Scale::Linear, [a, b, ..]) => return format!("{:.1$}", value + 0.0, decimals(b - a)),
        // Two digits are enough: 1.5, 20, 0.3.
        _ => format!("{value:.0$}", decimals(value) + 1),
    };
    if label.contains('.') { label.trim_end_matches('0').trim_end_matches('.').to_owned() } else { label }
}

fn draw_grid(
    root: &Area,
    frame: &Frame,
    x: Option<&Range>,
    y: Option<&Range>,
    at: impl Fn(f64, f64) -> (i32, i32),
) -> DrawingResult {
    let grid = rgb(palette::GRID.0).stroke_width(2);
    if let Some(x) = x {
        for tick in &x.ticks {
            let px = at(*tick, f64::NAN).0;
            root.draw(&PathElement::new(vec![(px, frame.top), (px, frame.bottom)], grid))?;
            let label = tick_label(*tick, &x.ticks, x.scale);
            root.draw_text(&label, &text(EM, HPos::Center, VPos::Top), (px, frame.bottom + EM / 3))?;
        }
    }
    if let Some(y) = y {
        for tick in &y.ticks {
            let py = at(f64::NAN, *tick).1;
            root.draw(&PathElement::new(vec![(frame.left, py), (frame.right, py)], grid))?;
            let label = tick_label(*tick, &y.ticks, y.scale);
            root.draw_text(&label, &text(EM, HPos::Right, VPos::Center), (frame.left - EM / 2, py))?;
        }
    }
    Ok(())
}

fn draw_curves(
    root: &Area,
    frame: &Frame,
    x: &Axis,
    y: &Axis,
    series: &[Series],
    marks: bool,
) -> DrawingResult {
    let finite = |p: &&(f64, f64)| p.0.is_finite() && p.1.is_finite();
    let points = || series.iter().flat_map(|s| &s.points).filter(finite);
    let xs = Range::of(x, points().map(|p| p.0), false);
    let ys = Range::of(y, points().map(|p| p.1), true);
    let pixels = (frame.left..frame.right, frame.bottom..frame.top);
    let coordinates =
        Cartesian2d::<RangedCoordf64, RangedCoordf64>::new(xs.coordinate(), ys.coordinate(), pixels);
    let area = root.clone().apply_coord_spec(coordinates);
    let at = |px: f64, py: f64| {
        let inside = |value: f64, range: &Range| if value.is_nan() { range.low } else { value };
        area.map_coordinate(&(xs.drawn(inside(px, &xs)), ys.drawn(inside(py, &ys))))
    };
    draw_grid(root, frame, Some(&xs), Some(&ys), at)?;
    let line = rgb(palette::TEXT.0).stroke_width(3);
    for value in &y.lines_at {
        let py = at(f64::NAN, *value).1;
        root.draw(&PathElement::new(vec![(frame.left, py), (frame.right, py)], line))?;
    }
    root.draw_text(
        &x.name,
        &text(EM, HPos::Center, VPos::Top),
        ((frame.left + frame.right) / 2, frame.bottom + LINE + EM / 4),
    )?;
    let vertical = text(EM, HPos::Center, VPos::Top).transform(FontTransform::Rotate270);
    root.draw_text(&y.name, &vertical, (MARGIN / 2, (frame.top + frame.bottom) / 2))?;
    for series in series {
        let look = palette::of(&series.method);
        if !marks {
            let thin = rgb(look.light).stroke_width(2);
            for piece in series.points.split(|p| !finite(&p)) {
                let piece: Vec<(i32, i32)> = piece.iter().map(|p| at(p.0, p.1)).collect();
                root.draw(&PathElement::new(piece, thin))?;
            }
            continue;
        }
        let points: Vec<(i32, i32)> = series.points.iter().filter(finite).map(|p| at(p.0, p.1)).collect();
        if points.len() > 1 {
            stroke(root, points.clone(), &look, series.papers)?;
        }
        for point in points {
            mark(root, point, &look, series.papers)?;
        }
    }
    Ok(())
}

/// Marks with intervals do not lie over each other.
fn row_height(row: &DotRow) -> i32 {
    let lanes = row.marks.iter().filter(|mark| mark.interval.is_some()).count() as i32;
    ROW_HEIGHT.max((lanes + 1) * LANE)
}

fn draw_paired(
    root: &Area,
    frame: &Frame,
    value: &Axis,
    methods: &[String],
    persons: &[Vec<f64>],
) -> DrawingResult {
    let ys = Range::of(value, persons.iter().flatten().copied(), true);
    let coordinates = Cartesian2d::<RangedCoordf64, RangedCoordf64>::new(
        0.0..methods.len().max(1) as f64,
        ys.coordinate(),
        (frame.left..frame.right, frame.bottom..frame.top),
    );
    let area = root.clone().apply_coord_spec(coordinates);
    let at = |column: usize, value: f64| area.map_coordinate(&(column as f64 + 0.5, ys.drawn(value)));
    draw_grid(root, frame, None, Some(&ys), |_, value| at(0, if value.is_nan() { ys.low } else { value }))?;
    let vertical = text(EM, HPos::Center, VPos::Top).transform(FontTransform::Rotate270);
    root.draw_text(&value.name, &vertical, (MARGIN / 2, (frame.top + frame.bottom) / 2))?;
    for person in persons {
        let line = person.iter().enumerate().map(|(column, value)| at(column, *value)).collect::<Vec<_>>();
        root.draw(&PathElement::new(line, rgb(palette::NEUTRAL.0).stroke_width(2)))?;
    }
    for (column, method) in methods.iter().enumerate() {
        let look = palette::of(method);
        let values: Vec<f64> = persons.iter().filter_map(|person| person.get(column).copied()).collect();
        let center = at(column, ys.low).0;
        root.draw_text(method, &text(EM, HPos::Center, VPos::Top), (center, frame.bottom + EM / 3))?;
        let height = |percent| percentile(&values, percent).map(|value| at(column, value).1);
        let (Some(low), Some(first), Some(median), Some(third), Some(high)) =
            (height(0.0), height(25.0), height(50.0), height(75.0), height(100.0))
        else {
            continue;
        };
        let (left, right) = (center - 2 * EM, center + 2 * EM);
        let style = rgb(look.light).stroke_width(4);
        let corners =
            [(left, first), (right, first), (right, third), (left, third), (left, first), (right, first)];
        root.draw(&PathElement::new(corners.to_vec(), style))?;
        root.draw(&PathElement::new(vec![(left, median), (right, median)], style.stroke_width(8)))?;
        for whisker in [(first, low), (third, high)] {
            root.draw(&PathElement::new(vec![(center, whisker.0), (center, whisker.1)], style))?;
        }
        for value in values {
            root.draw(&Circle::new(at(column, value), MARK / 2, rgb(look.light).filled()))?;
        }
    }
    Ok(())
}

fn draw_dots(root: &Area, frame: &Frame, value: &Axis, rows: &[DotRow]) -> DrawingResult {
    let marks = rows.iter().flat_map(|row| &row.marks);
    let values = marks.flat_map(|mark| {
        let interval = mark.interval.map(|interval| [interval.low, interval.high]);
        std::iter::once(mark.value).chain(interval.into_iter().flatten())
    });
    let range = Range::of(value, values, true);
    let coordinates = Cartesian2d::<RangedCoordf64, RangedCoordf64>::new(
        range.coordinate(),
        0.0..rows.len().max(1) as f64,
        (frame.left..frame.right, frame.top..frame.bottom),
    );
    let area = root.clone().apply_coord_spec(coordinates);
    let at = |value: f64, row: f64| area.map_coordinate(&(range.drawn(value), row));
    draw_grid(root, frame, Some(&range), None, |value, _| at(value, 0.0))?;
    let line = rgb(palette::TEXT.0).stroke_width(3);
    for value in &value.lines_at {
        let px = at(*value, 0.0).0;
        root.draw(&PathElement::new(vec![(px, frame.top), (px, frame.bottom)], line))?;
    }
    let middle = (frame.left + frame.right) / 2;
    let below = frame.bottom + LINE + EM / 4;
    root.draw_text(&value.name, &text(EM, HPos::Center, VPos::Top), (middle, below))?;
    let grid = rgb(palette::GRID.0).stroke_width(2);
    let mut top = frame.top;
    for row in rows {
        let height = row_height(row);
        let y = top + height / 2;
        top += height;
        root.draw(&PathElement::new(vec![(frame.left, y), (frame.right, y)], grid))?;
        let label = shortened(&row.label, LABEL);
        root.draw_text(&label, &text(EM, HPos::Right, VPos::Center), (frame.left - EM / 2, y))?;
        let lanes = row.marks.iter().filter(|m| m.interval.is_some()).count() as i32;
        let mut lane = 0;
        for m in row.marks.iter().filter(|m| m.value.is_finite()) {
            let px = |value: f64| at(value, 0.0).0.clamp(frame.left, frame.right);
            let (look, mut y) = (palette::of(&m.method), y);
            if let Some(interval) = m.interval {
                y += (2 * lane - lanes + 1) * LANE / 2;
                lane += 1;
                stroke(root, vec![(px(interval.low), y), (px(interval.high), y)], &look, m.papers)?;
            }
            mark(root, (px(m.value), y), &look, m.papers)?;
        }
    }
    Ok(())
}

fn shortened(text: &str, length: usize) -> String {
    if text.chars().count() <= length {
        return text.to_string();
    }
    text.chars().take(length - 1).chain(['…']).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(method: &str, papers: bool, points: &[(f64, f64)]) -> Series {
        Series { method: method.into(), papers, label: method.into(), points: points.to_vec() }
    }

    fn figure(panel: Panel) -> Figure {
        Figure { id: "test".into(), title: "A test".into(), caption: String::new(), panel }
    }

    #[test]
    fn curves_have_axes_with_units_a_legend_and_points_in_place() {
        let series = vec![
            curve("conventional", false, &[(1.0, 20.0), (2.0, 40.0)]),
            curve("yoro-paper", true, &[(1.0, 10.0), (2.0, f64::NAN)]),
        ];
        let axes = (Axis::new("triangles, millions"), Axis::new("frame time, ms").from_zero());
        let svg = figure(Panel::Curves { x: axes.0, y: axes.1, series }).svg().unwrap();
        for needed in
            ["triangles, millions", "frame time, ms", "conventional", "yoro-paper", "#3D3F44", "#D55E00"]
        {
            assert!(svg.contains(needed), "{needed}: {svg}");
        }
        assert!(!svg.contains("NaN") && svg.trim_end().ends_with("</svg>"));
        // From the middle of the frame, 20 ms, up to its top, 40 ms; the first line is the legend's.
        let mut lines = svg.lines().filter(|l| l.starts_with("<polyline") && l.contains("#3D3F44"));
        let points = lines.next_back().unwrap().split("points=\"").nth(1).unwrap();
        let heights: Vec<i32> = points.split(' ').filter_map(|p| p.split(',').nth(1)?.parse().ok()).collect();
        let top = MARGIN + LINE + LINE / 2;
        let off = |height: i32, expected: i32| (height - expected).abs();
        assert!(off(heights[0], top + CURVES_HEIGHT / 2) <= 1 && off(heights[1], top) <= 1, "{heights:?}");
    }

    #[test]
    fn dots_sit_on_their_rows() {
        let mark = |method: &str, value| Mark::new(method, method, value);
        let row = |label: &str, value| DotRow {
            label: label.into(),
            marks: vec![mark("mono", value), mark("hybrid", f64::INFINITY)],
        };
        let panel = Panel::Dots {
            value: Axis::new("ratio").baseline(1.0),
            rows: vec![row("a <b>", 0.5), row("c", 0.25)],
        };
        let svg = figure(panel).svg().unwrap();
        assert!(svg.contains("a &lt;b&gt;") && !svg.contains("hybrid") && !svg.contains("inf"));
        let centres: Vec<&str> =
            svg.lines().filter(|l| l.contains("<circle") && l.contains("#777A80")).collect();
        assert_eq!(centres.len(), 3, "one in the legend, two on rows: {svg}");
    }

    #[test]
    fn intervals_get_a_lane_each_and_bounds_a_line() {
        let mark = |method: &str, value: f64, reach: f64| Mark {
            interval: Some(Interval { low: value - reach, high: value + reach }),
            ..Mark::new(method, method, value)
        };
        let rows = vec![DotRow {
            label: "street".into(),
            marks: vec![mark("hybrid", 1.0, 2.0), mark("mono", 0.5, 0.1)],
        }];
        let value = Axis::new("difference").lines(&[-3.0, 3.0]);
        let svg = figure(Panel::Dots { value, rows }).svg().unwrap();
        let bars = |color: &str| {
            let lines = svg.lines().filter(|l| l.starts_with("<polyline") && l.contains(color));
            lines.map(|l| l.split("points=\"").nth(1).unwrap().to_owned()).collect::<Vec<_>>()
        };
        // One in the legend, one on the row; on the row the bars have different heights.
        let height =
            |line: &str| line.split(',').nth(1).unwrap().split(' ').next().unwrap().parse::<i32>().unwrap();
        let (hybrid, mono) = (bars("#009E73"), bars("#777A80"));
        assert!(hybrid.len() >= 2 && mono.len() >= 2, "{svg}");
        assert_eq!((height(hybrid.last().unwrap()) - height(mono.last().unwrap())).abs(), LANE);
    }

    #[test]
    fn traces_break_at_gaps_and_pairs_have_boxes() {
        let (x, y) = (Axis::new("s"), Axis::new("power, mW"));
        let series =
            vec![curve("hybrid", false, &[(0.0, 1.0), (1.0, 2.0), (2.0, f64::NAN), (3.0, 1.0), (4.0, 2.0)])];
        let svg = figure(Panel::Traces { x, y, series }).svg().unwrap();
        let lines = svg.lines().filter(|l| l.starts_with("<polyline") && l.contains("#009E73")).count();
        assert_eq!(lines, 3, "one in the legend, two pieces: {svg}");
        let panel = Panel::Paired {
            value: Axis::new("rating"),
            methods: vec!["hybrid".into(), "mono".into()],
            persons: vec![vec![1.0, 2.0], vec![3.0, 4.0], vec![2.0, 5.0]],
        };
        let svg = figure(panel).svg().unwrap();
        let persons = svg.lines().filter(|l| {
            l.starts_with("<polyline") && l.contains("stroke-width=\"2\"") && l.contains("#777A80")
        });
        assert_eq!(persons.count(), 3, "{svg}");
        assert!(svg.contains("rating") && svg.contains("hybrid"));
    }

    #[test]
    fn ticks_are_round_and_few() {
        for (range, step) in [(1.0, 0.2), (0.35, 0.1), (20.0, 5.0), (8.0, 2.0), (0.04, 0.01)] {
            assert!((tick_step(range) - step).abs() < 1e-12, "{range}: {}", tick_step(range));
        }
        let axis = Axis::new("ms").logarithmic();
        let range = Range::of(&axis, [0.35, 37142.0, -1.0].into_iter(), true);
        assert_eq!(range.ticks, [1.0, 10.0, 100.0, 1e3, 1e4]);
        let labels: Vec<String> =
            range.ticks.iter().map(|t| tick_label(*t, &range.ticks, range.scale)).collect();
        assert_eq!(labels, ["1", "10", "100", "1000", "10000"]);
        let label = |value: f64| tick_label(value, &[], Scale::Logarithmic);
        assert_eq!([1.5, 0.3, 20.0, 3e-2].map(label), ["1.5", "0.3", "20", "0.03"]);
    }

    #[test]
    fn one_value_none_and_long_legends_are_drawn_too() {
        let one = vec![curve("mono", false, &[(5.0, 5.0)])];
        let axes = || (Axis::new("x"), Axis::new("y"));
        assert!(figure(Panel::Curves { x: axes().0, y: axes().1, series: one }).svg().is_ok());
        let nothing = figure(Panel::Dots { value: Axis::new("x"), rows: Vec::new() });
        assert!(nothing.is_empty() && nothing.svg().is_ok());
        let many =
            (0..12).map(|i| curve(&format!("a method with number {i}"), false, &[(0.0, 1.0)])).collect();
        let svg = figure(Panel::Curves { x: axes().0, y: axes().1, series: many }).svg().unwrap();
        for i in 0..12 {
            assert!(svg.contains(&format!("number {i}")));
        }
    }
}
