//! Drawing with plotters, in the colours of the light page.

use std::ops::Range;

use plotters::coord::Shift;
use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged};
use plotters::coord::types::RangedCoordf64;
use plotters::element::DashedPathElement;
use plotters::prelude::*;
use serde::Serialize;

use super::{Axis, Entry, Plot, Point, Style};
use crate::palette::{self, Look, Shape};

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

/// A plot as drawn.
pub(super) struct Drawing {
    /// The SVG document. The marks of each entry of the legend are a group with the attribute `data-series`.
    pub svg: String,
    /// A small SVG document with the mark of each entry of the legend.
    pub swatches: Vec<String>,
    /// All points.
    pub points: Vec<Place>,
}

/// A point and its place.
#[derive(Serialize)]
pub(super) struct Place {
    /// The number of its entry in the legend.
    series: usize,
    /// The place in SVG units.
    at: (i32, i32),
    x: f64,
    /// The value on the vertical axis, or the number of the row.
    y: f64,
    /// The ends of the interval of x.
    interval: Option<[f64; 2]>,
}

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

/// Draws a plot: axes, then a layer for each entry of the legend, so that the page can hide one.
pub(super) fn draw(plot: &Plot) -> DrawingResult<Drawing> {
    let legend = plot.legend();
    let mut points = Vec::new();
    let mut body = layer(plot, |root, chart| {
        root.fill(&rgb(palette::BACKGROUND.0))?;
        draw_axes(plot, chart)
    })?;
    // The first entry comes last, on top of others with equal figures.
    for (i, entry) in legend.iter().enumerate().rev() {
        let marks = layer(plot, |root, chart| {
            for series in plot.series.iter().filter(|series| series.entry == **entry) {
                let offset = lane_offset(plot, i, legend.len());
                points.extend(draw_points(plot, entry, &series.points, offset, root, chart)?.map(
                    |(point, at)| Place {
                        series: i,
                        at,
                        x: point.x,
                        y: point.y,
                        interval: point.interval.map(|found| [found.low, found.high]),
                    },
                ));
            }
            Ok(())
        })?;
        body += &format!("<g data-series=\"{i}\">\n{marks}</g>\n");
    }
    let height = height(plot);
    let svg = format!(
        "<svg viewBox=\"0 0 {WIDTH} {height}\" width=\"{WIDTH}\" height=\"{height}\" \
         xmlns=\"http://www.w3.org/2000/svg\">\n{body}</svg>\n"
    );
    let swatches = legend.iter().map(|entry| swatch(plot, entry)).collect::<DrawingResult<_>>()?;
    Ok(Drawing { svg, swatches, points })
}

/// Draws a plot with its legend below, in two columns.
pub(super) fn draw_document(plot: &Plot) -> DrawingResult<String> {
    let (drawing, entries) = (draw(plot)?, plot.legend());
    let (above, below) = (height(plot), entries.len().div_ceil(2) as u32 * ROW_HEIGHT as u32);
    let mut legend = String::new();
    {
        let root = SVGBackend::with_string(&mut legend, (WIDTH, below)).into_drawing_area();
        root.fill(&rgb(palette::BACKGROUND.0))?;
        for (i, entry) in entries.iter().enumerate() {
            let (column, row) = ((i % 2) as i32, (i / 2) as i32);
            let (x, y) = (EM + column * WIDTH as i32 / 2, row * ROW_HEIGHT + ROW_HEIGHT / 2);
            draw_mark(&root, (x, y), &palette::of(&entry.method), entry.papers)?;
            root.draw(&Text::new(entry.label.clone(), (x + EM, y - EM / 2), text()))?;
        }
        root.present()?;
    }
    let legend = legend.replacen("<svg ", &format!("<svg y=\"{above}\" "), 1);
    let (plot, height) = (drawing.svg, above + below);
    Ok(format!(
        "<svg viewBox=\"0 0 {WIDTH} {height}\" width=\"{WIDTH}\" height=\"{height}\" \
         xmlns=\"http://www.w3.org/2000/svg\">\n{plot}{legend}</svg>\n"
    ))
}

fn has_intervals(plot: &Plot) -> bool {
    plot.series.iter().flat_map(|series| &series.points).any(|point| point.interval.is_some())
}

/// Returns the height of a row, in which marks with intervals lie below each other.
fn row_height(plot: &Plot) -> i32 {
    let lanes = if has_intervals(plot) { plot.legend().len() as i32 + 1 } else { 0 };
    ROW_HEIGHT.max(lanes * LANE)
}

fn height(plot: &Plot) -> u32 {
    let inside = if plot.rows.is_empty() { CURVES_HEIGHT } else { plot.rows.len() as i32 * row_height(plot) };
    (inside + EM * 4) as u32
}

/// Returns how far below the middle of its row an entry's marks lie, in SVG units.
fn lane_offset(plot: &Plot, entry: usize, entries: usize) -> i32 {
    if !has_intervals(plot) || plot.rows.is_empty() {
        return 0;
    }
    (2 * entry as i32 - entries as i32 + 1) * LANE / 2
}

/// Returns the elements that `draw` draws on a plot's area, without the document around them.
fn layer(plot: &Plot, draw: impl FnOnce(&Area, &mut Chart) -> DrawingResult<()>) -> DrawingResult<String> {
    let mut svg = String::new();
    let root = SVGBackend::with_string(&mut svg, (WIDTH, height(plot))).into_drawing_area();
    let points = || plot.series.iter().flat_map(|series| &series.points).filter(|point| point.is_finite());
    let ends = points().filter_map(|point| point.interval).flat_map(|found| [found.low, found.high]);
    let x = Scaled::of(&plot.x, points().map(|point| point.x).chain(ends));
    let (y, left) = match plot.rows.len() {
        0 => (Scaled::of(&plot.y, points().map(|point| point.y)), 4 * EM),
        rows => (Scaled::Rows(rows), LABEL as i32 * EM * 55 / 100),
    };
    let mut chart = ChartBuilder::on(&root)
        .margin(EM / 2)
        .margin_right(EM)
        .x_label_area_size(5 * EM / 2)
        .y_label_area_size(left)
        .build_cartesian_2d(x, y)?;
    draw(&root, &mut chart)?;
    root.present()?;
    drop(chart);
    drop(root);
    let start = svg.find('>').map_or(0, |end| end + 1);
    Ok(svg[start..].trim_end().trim_end_matches("</svg>").trim_start().to_owned())
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
    let look = palette::of(&entry.method);
    let at = |x: f64, y: f64| {
        let (x, y) = chart.backend_coord(&(x, y));
        (x, y + offset)
    };
    let finite: Vec<_> = points.iter().filter(|p| p.is_finite()).map(|p| (p, at(p.x, p.y))).collect();
    if plot.style == Style::Curves && finite.len() > 1 {
        draw_stroke(root, finite.iter().map(|(_, at)| *at).collect(), &look, entry.papers)?;
    }
    for (point, place) in &finite {
        if let Some(interval) = point.interval {
            let bar = vec![at(interval.low, point.y), at(interval.high, point.y)];
            draw_stroke(root, bar, &look, entry.papers)?;
        }
        draw_mark(root, *place, &look, entry.papers)?;
    }
    Ok(finite.into_iter())
}

/// Draws the line of a method, dashed for the paper's figures.
fn draw_stroke(root: &Area, points: Vec<(i32, i32)>, look: &Look, papers: bool) -> DrawingResult<()> {
    let style = rgb(look.light).stroke_width(4);
    match papers {
        true => root.draw(&DashedPathElement::new(points, 14, 9, style)),
        false => root.draw(&PathElement::new(points, style)),
    }
}

fn style(look: &Look, papers: bool) -> ShapeStyle {
    if papers || look.hollow { rgb(palette::BACKGROUND.0).filled() } else { rgb(look.light).filled() }
}

/// Draws the mark of a method, hollow for the paper's figures.
fn draw_mark(root: &Area, at: (i32, i32), look: &Look, papers: bool) -> DrawingResult<()> {
    let mut outline = outline(look, at);
    root.draw(&Polygon::new(outline.clone(), style(look, papers)))?;
    outline.extend_from_within(..2);
    root.draw(&PathElement::new(outline, rgb(look.light).stroke_width(4)))
}

fn outline(look: &Look, (x, y): (i32, i32)) -> Vec<(i32, i32)> {
    let circle = || (0..20).map(|i| (f64::from(i) * std::f64::consts::PI / 10.0).sin_cos());
    let corners: Vec<(f64, f64)> = match look.shape {
        Shape::Circle => circle().map(|(sin, cos)| (1.1 * sin, 1.1 * cos)).collect(),
        Shape::Square => vec![(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)],
        Shape::Diamond => vec![(0.0, -1.45), (1.45, 0.0), (0.0, 1.45), (-1.45, 0.0)],
        Shape::Up => vec![(0.0, -1.35), (1.35, 1.0), (-1.35, 1.0)],
        Shape::Down => vec![(0.0, 1.35), (1.35, -1.0), (-1.35, -1.0)],
        Shape::Cross => [
            (-1, -3),
            (0, -1),
            (1, -3),
            (3, -1),
            (1, 0),
            (3, 1),
            (1, 3),
            (0, 1),
            (-1, 3),
            (-3, 1),
            (-1, 0),
            (-3, -1),
        ]
        .map(|(x, y)| (0.42 * f64::from(x), 0.42 * f64::from(y)))
        .to_vec(),
    };
    let scaled = |value: f64| (value * f64::from(MARK)).round() as i32;
    corners.into_iter().map(|(dx, dy)| (x + scaled(dx), y + scaled(dy))).collect()
}

/// Returns a small document with the line and mark of an entry.
fn swatch(plot: &Plot, entry: &Entry) -> DrawingResult<String> {
    let (mut svg, look) = (String::new(), palette::of(&entry.method));
    {
        let root = SVGBackend::with_string(&mut svg, (2 * EM as u32, EM as u32)).into_drawing_area();
        if plot.style != Style::Points || has_intervals(plot) {
            draw_stroke(&root, vec![(0, EM / 2), (2 * EM, EM / 2)], &look, entry.papers)?;
        }
        draw_mark(&root, (EM, EM / 2), &look, entry.papers)?;
        root.present()?;
    }
    Ok(svg)
}

fn shortened(text: &str) -> String {
    if text.chars().count() <= LABEL {
        return text.to_owned();
    }
    text.chars().take(LABEL - 1).chain(['…']).collect()
}
