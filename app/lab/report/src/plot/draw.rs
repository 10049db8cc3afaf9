//! Drawing with plotters.

use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::element::DashedPathElement;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::axis::{Range, tick_label};
use super::{Axis, DotRow, Figure, LegendEntry, Panel, Series};
use crate::palette::{self, Look, Shape};
use crate::stats::percentile;

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type DrawingResult = Result<(), DrawingAreaErrorKind<std::io::Error>>;

/// Width of all figures in SVG units: two per CSS pixel at natural size, because plotters rounds to whole units.
const WIDTH: i32 = 1200;
const EM: i32 = 26;
pub(super) const LINE: i32 = 38;
const MARK: i32 = 9;
pub(super) const MARGIN: i32 = 24;
pub(super) const CURVES_HEIGHT: i32 = 560;
const ROW_HEIGHT: i32 = 50;
/// Distance between the marks of one row that have intervals.
pub(super) const LANE: i32 = 26;
/// Number of characters that fit to the left of a dot plot.
const LABEL: usize = 20;

/// Draws a figure as an SVG document.
pub(super) fn draw(figure: &Figure, svg: &mut String) -> DrawingResult {
    let legend = figure.legend();
    let lines = legend_lines(&legend);
    let top = MARGIN + lines.len() as i32 * LINE + LINE / 2;
    let (left, height) = match &figure.panel {
        Panel::Curves { .. } | Panel::Traces { .. } | Panel::Paired { .. } => (6 * EM, CURVES_HEIGHT),
        Panel::Dots { rows, .. } => {
            (LABEL as i32 * EM * 6 / 10, rows.iter().map(row_height).sum::<i32>().max(ROW_HEIGHT))
        }
    };
    let bottom = top + height;
    let size = (WIDTH as u32, (bottom + 2 * LINE + MARGIN) as u32);
    let root = SVGBackend::with_string(svg, size).into_drawing_area();
    root.fill(&rgb(palette::BACKGROUND.0))?;
    draw_legend(&root, &lines, !matches!(figure.panel, Panel::Traces { .. }))?;
    let frame = Frame { left, right: WIDTH - 2 * MARGIN, top, bottom };
    match &figure.panel {
        Panel::Curves { x, y, series } => draw_curves(&root, &frame, x, y, series, true)?,
        Panel::Traces { x, y, series } => draw_curves(&root, &frame, x, y, series, false)?,
        Panel::Paired { value, methods, persons } => {
            draw_paired(&root, &frame, value, methods, persons)?;
        }
        Panel::Dots { value, rows } => draw_dots(&root, &frame, value, rows)?,
    }
    root.present()
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
    // The backend divides font sizes by 1.24.
    let style: TextStyle = ("sans-serif", f64::from(size) * 1.24).into_text_style(&(0, 0));
    let color = rgb(palette::TEXT.0).to_backend_color();
    TextStyle { color, ..style }.pos(Pos::new(horizontal, vertical))
}

fn text_width(text: &str) -> i32 {
    text.chars().count() as i32 * EM * 56 / 100
}

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

/// Draws the line of a method, dashed for the paper's figures.
fn stroke(root: &Area, points: Vec<(i32, i32)>, look: &Look, papers: bool) -> DrawingResult {
    let style = rgb(look.light).stroke_width(4);
    if papers {
        root.draw(&DashedPathElement::new(points, 14, 9, style))
    } else {
        root.draw(&PathElement::new(points, style))
    }
}

/// Draws the mark of a method, hollow for the paper's figures.
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

/// Returns the height of a row, in which marks with intervals lie below each other.
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
