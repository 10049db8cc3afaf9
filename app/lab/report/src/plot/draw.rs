//! Drawing with plotters, in the colours of the light page.

use std::ops::Range;

use plotters::coord::Shift;
use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged};
use plotters::coord::types::RangedCoordf64;
use plotters::element::DashedPathElement;
use plotters::prelude::*;
use serde_json::{Value, json};

use super::{Axis, Entry, Plot, Point};
use crate::palette::{self, Shape};

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Chart<'a> = ChartContext<'a, SVGBackend<'a>, Cartesian2d<Scaled, Scaled>>;
type DrawingResult<T> = Result<T, DrawingAreaErrorKind<std::io::Error>>;

/// Width of all plots in SVG units: about two per CSS pixel, because plotters rounds to whole units.
const WIDTH: u32 = 840;
const EM: i32 = 24;
const MARK: i32 = 8;
const CURVES_HEIGHT: i32 = 440;
const ROW_HEIGHT: i32 = 42;
/// Distance between the marks of one row that have intervals.
const LANE: i32 = 24;
/// Number of characters that fit to the left of the rows.
const LABEL: usize = 19;

/// The scale of an axis.
#[derive(Clone)]
enum Scaled {
    Linear(RangedCoordf64),
    /// The natural logarithm of the values.
    Logarithmic(RangedCoordf64),
    /// This many rows from top to bottom.
    Rows(usize),
}

impl Scaled {
    /// Returns a scale that fits an axis and the values on it.
    fn of(axis: &Axis, values: impl Iterator<Item = f64>) -> Scaled {
        let drawable = |v: &f64| v.is_finite() && (!axis.logarithmic || *v > 0.0);
        let scaled = |v: f64| if axis.logarithmic { v.ln() } else { v };
        let all = values.chain(axis.include.iter().copied()).filter(drawable).map(scaled);
        let (low, high) = all.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        let (low, high) = if low <= high { (low, high) } else { (0.0, 1.0) };
        let margin = if low < high { 0.06 * (high - low) } else { (0.1 * low.abs()).max(0.1) };
        // An axis that starts or ends at zero does so exactly.
        let is_exact = |end: f64| end == 0.0 && !axis.logarithmic;
        let low = if is_exact(low) { low } else { low - margin };
        let high = if is_exact(high) { high } else { high + margin };
        match axis.logarithmic {
            true => Scaled::Logarithmic((low..high).into()),
            false => Scaled::Linear((low..high).into()),
        }
    }
}

impl Ranged for Scaled {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        match self {
            Scaled::Linear(range) => range.map(value, limit),
            Scaled::Logarithmic(range) => range.map(&value.max(f64::MIN_POSITIVE).ln(), limit),
            Scaled::Rows(count) => {
                RangedCoordf64::from(0.0..(*count).max(1) as f64).map(&(value + 0.5), (limit.1, limit.0))
            }
        }
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        match self {
            Scaled::Linear(range) => range.key_points(hint),
            Scaled::Logarithmic(range) => {
                let Range { start, end } = range.range();
                let steps: &[f64] = if end - start < 4.0 { &[1.0, 2.0, 5.0] } else { &[1.0] };
                let powers = (start / 10f64.ln()).floor() as i32..=(end / 10f64.ln()).ceil() as i32;
                let all = powers.flat_map(|power| steps.iter().map(move |step| step * 10f64.powi(power)));
                all.filter(|value| (start..=end).contains(&value.ln())).collect()
            }
            Scaled::Rows(count) => (0..*count).map(|row| row as f64).collect(),
        }
    }

    fn range(&self) -> Range<f64> {
        match self {
            Scaled::Linear(range) => range.range(),
            Scaled::Logarithmic(range) => range.range().start.exp()..range.range().end.exp(),
            Scaled::Rows(count) => -0.5..*count as f64 - 0.5,
        }
    }
}

impl plotters::coord::ranged1d::ValueFormatter<f64> for Scaled {
    fn format(value: &f64) -> String {
        let text = format!("{value:.6}");
        let text = text.trim_end_matches('0').trim_end_matches('.');
        if text == "-0" { "0".into() } else { text.into() }
    }
}

/// Draws a plot, on request with its legend below in two columns, and returns all points with their places. The marks of
/// each entry of the legend are a group with the attribute `data-series`, so that the page can hide one.
pub(super) fn draw(plot: &Plot, with_legend: bool) -> DrawingResult<(String, Vec<Value>)> {
    let legend = plot.legend();
    let mut places = Vec::new();
    let mut body = layer(plot, |root, chart| {
        root.fill(&rgb(palette::BACKGROUND.0))?;
        draw_axes(plot, chart)
    })?;
    // The first entry comes last, on top of others with equal figures.
    for (i, entry) in legend.iter().enumerate().rev() {
        let marks = layer(plot, |root, chart| {
            for (_, points) in plot.series.iter().filter(|(other, _)| other == *entry) {
                let offset = lane_offset(plot, i, legend.len());
                for (Point { x, y, interval }, at) in draw_points(plot, entry, points, offset, root, chart)? {
                    places.push(json!({ "series": i, "at": at, "x": x, "y": y, "interval": interval }));
                }
            }
            Ok(())
        })?;
        body += &format!("<g data-series=\"{i}\">\n{marks}</g>\n");
    }
    let mut size = (WIDTH, height(plot));
    if with_legend {
        let below = (WIDTH, legend.len().div_ceil(2) as u32 * ROW_HEIGHT as u32);
        let entries = elements(below, |root| {
            root.fill(&rgb(palette::BACKGROUND.0))?;
            for (i, entry) in legend.iter().enumerate() {
                let (column, row) = ((i % 2) as i32, (i / 2) as i32);
                let (x, y) = (EM + column * WIDTH as i32 / 2, row * ROW_HEIGHT + ROW_HEIGHT / 2);
                draw_mark(root, (x, y), entry)?;
                root.draw(&Text::new(entry.label.clone(), (x + EM, y - EM / 2), text()))?;
            }
            Ok(())
        })?;
        body += &format!("<g transform=\"translate(0 {})\">\n{entries}</g>\n", size.1);
        size.1 += below.1;
    }
    Ok((document(&body, size), places))
}

/// Returns a small document with the line and mark of an entry.
pub(super) fn swatch(entry: &Entry, with_line: bool) -> DrawingResult<String> {
    let size = (2 * EM as u32, EM as u32);
    let drawn = elements(size, |root| {
        if with_line {
            draw_stroke(root, vec![(0, EM / 2), (2 * EM, EM / 2)], entry)?;
        }
        draw_mark(root, (EM, EM / 2), entry)
    });
    Ok(document(&drawn?, size))
}

fn document(elements: &str, (width, height): (u32, u32)) -> String {
    format!(
        "<svg viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" \
         xmlns=\"http://www.w3.org/2000/svg\">\n{elements}</svg>\n"
    )
}

/// Returns the elements that `draw` draws, without the document around them.
fn elements(size: (u32, u32), draw: impl FnOnce(&Area) -> DrawingResult<()>) -> DrawingResult<String> {
    let mut svg = String::new();
    let root = SVGBackend::with_string(&mut svg, size).into_drawing_area();
    draw(&root)?;
    root.present()?;
    drop(root);
    let start = svg.find('>').map_or(0, |end| end + 1);
    Ok(svg[start..].trim_end().trim_end_matches("</svg>").trim_start().to_owned())
}

/// Returns the height of a row, in which marks with intervals lie below each other.
fn row_height(plot: &Plot) -> i32 {
    let lanes = if plot.has_intervals() { plot.legend().len() as i32 + 1 } else { 0 };
    ROW_HEIGHT.max(lanes * LANE)
}

fn height(plot: &Plot) -> u32 {
    let inside = if plot.rows.is_empty() { CURVES_HEIGHT } else { plot.rows.len() as i32 * row_height(plot) };
    (inside + EM * 4) as u32
}

/// Returns how far below the middle of its row an entry's marks lie, in SVG units.
fn lane_offset(plot: &Plot, entry: usize, entries: usize) -> i32 {
    if !plot.has_intervals() || plot.rows.is_empty() {
        return 0;
    }
    (2 * entry as i32 - entries as i32 + 1) * LANE / 2
}

/// Returns the elements that `draw` draws on a plot's area.
fn layer(plot: &Plot, draw: impl FnOnce(&Area, &mut Chart) -> DrawingResult<()>) -> DrawingResult<String> {
    let points = || plot.series.iter().flat_map(|(_, points)| points).filter(|point| point.is_finite());
    let ends = points().filter_map(|point| point.interval).flatten();
    let x = Scaled::of(&plot.x, points().map(|point| point.x).chain(ends));
    let (y, left) = match plot.rows.len() {
        0 => (Scaled::of(&plot.y, points().map(|point| point.y)), 4 * EM),
        rows => (Scaled::Rows(rows), LABEL as i32 * EM * 55 / 100),
    };
    elements((WIDTH, height(plot)), |root| {
        let mut chart = ChartBuilder::on(root)
            .margin(EM / 2)
            .margin_right(EM)
            .x_label_area_size(5 * EM / 2)
            .y_label_area_size(left)
            .build_cartesian_2d(x, y)?;
        draw(root, &mut chart)
    })
}

fn rgb(color: u32) -> RGBColor {
    RGBColor((color >> 16) as u8, (color >> 8) as u8, color as u8)
}

fn text() -> TextStyle<'static> {
    // The backend divides font sizes by 1.24.
    let style: TextStyle = ("sans-serif", f64::from(EM) * 1.24).into_text_style(&(0, 0));
    TextStyle { color: rgb(palette::TEXT.0).to_backend_color(), ..style }
}

fn draw_axes(plot: &Plot, chart: &mut Chart) -> DrawingResult<()> {
    let grid = rgb(palette::GRID.0);
    let name = |row: &f64| shortened(plot.rows.get(*row as usize).map_or("", String::as_str));
    let mut mesh = chart.configure_mesh();
    mesh.x_desc(&plot.x.name)
        .x_labels(7)
        .y_labels(7)
        .max_light_lines(1)
        .light_line_style(TRANSPARENT)
        .bold_line_style(grid.stroke_width(2))
        .axis_style(grid.stroke_width(2))
        .set_all_tick_mark_size(6)
        .label_style(text())
        .axis_desc_style(text());
    if plot.rows.is_empty() {
        mesh.y_desc(&plot.y.name);
    } else {
        mesh.y_labels(plot.rows.len()).y_label_formatter(&name);
    }
    mesh.draw()?;
    let ([x, y], line) = ([chart.x_range(), chart.y_range()], rgb(palette::TEXT.0).stroke_width(3));
    let across = |value: &f64| PathElement::new(vec![(*value, y.start), (*value, y.end)], line);
    chart.draw_series(plot.x.lines_at.iter().map(across))?;
    let along = |value: &f64| PathElement::new(vec![(x.start, *value), (x.end, *value)], line);
    chart.draw_series(plot.y.lines_at.iter().map(along))?;
    Ok(())
}

/// Draws the points of a series, and returns those that are finite with their places in SVG units.
fn draw_points<'p>(
    plot: &Plot,
    entry: &Entry,
    points: &'p [Point],
    offset: i32,
    root: &Area,
    chart: &Chart,
) -> DrawingResult<impl Iterator<Item = (&'p Point, (i32, i32))> + use<'p>> {
    let at = |x: f64, y: f64| {
        let (x, y) = chart.backend_coord(&(x, y));
        (x, y + offset)
    };
    let finite: Vec<_> = points.iter().filter(|p| p.is_finite()).map(|p| (p, at(p.x, p.y))).collect();
    if plot.lines && finite.len() > 1 {
        draw_stroke(root, finite.iter().map(|(_, at)| *at).collect(), entry)?;
    }
    for (point, place) in &finite {
        if let Some(ends) = point.interval {
            draw_stroke(root, ends.map(|end| at(end, point.y)).to_vec(), entry)?;
        }
        draw_mark(root, *place, entry)?;
    }
    Ok(finite.into_iter())
}

/// Draws the line of a method, dashed for the paper's figures.
fn draw_stroke(root: &Area, points: Vec<(i32, i32)>, entry: &Entry) -> DrawingResult<()> {
    let style = rgb(palette::of(&entry.method).light).stroke_width(4);
    match entry.papers {
        true => root.draw(&DashedPathElement::new(points, 14, 9, style)),
        false => root.draw(&PathElement::new(points, style)),
    }
}

/// Draws the mark of a method, hollow for the paper's figures.
fn draw_mark(root: &Area, at: (i32, i32), entry: &Entry) -> DrawingResult<()> {
    let look = palette::of(&entry.method);
    let mut outline = outline(look.shape, at);
    let fill = if entry.papers || look.hollow { palette::BACKGROUND.0 } else { look.light };
    root.draw(&Polygon::new(outline.clone(), rgb(fill).filled()))?;
    outline.extend_from_within(..2);
    root.draw(&PathElement::new(outline, rgb(look.light).stroke_width(4)))
}

fn outline(shape: Shape, (x, y): (i32, i32)) -> Vec<(i32, i32)> {
    let corners: Vec<(f64, f64)> = match shape {
        Shape::Circle => {
            let angles = (0..20).map(|i| f64::from(i) * std::f64::consts::PI / 10.0);
            angles.map(|angle| (1.1 * angle.sin(), 1.1 * angle.cos())).collect()
        }
        Shape::Square => vec![(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)],
        Shape::Diamond => vec![(0.0, -1.45), (1.45, 0.0), (0.0, 1.45), (-1.45, 0.0)],
        Shape::Up => vec![(0.0, -1.35), (1.35, 1.0), (-1.35, 1.0)],
        Shape::Down => vec![(0.0, 1.35), (1.35, -1.0), (-1.35, -1.0)],
        Shape::Cross => {
            let x = [-1, 0, 1, 3, 1, 3, 1, 0, -1, -3, -1, -3].map(|x| 0.42 * f64::from(x));
            (0..12).map(|i| (x[i], x[(i + 9) % 12])).collect()
        }
    };
    let scaled = |value: f64| (value * f64::from(MARK)).round() as i32;
    corners.into_iter().map(|(dx, dy)| (x + scaled(dx), y + scaled(dy))).collect()
}

fn shortened(text: &str) -> String {
    if text.chars().count() <= LABEL {
        return text.to_owned();
    }
    text.chars().take(LABEL - 1).chain(['…']).collect()
}
