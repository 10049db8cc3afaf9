use super::axis::{Range, tick_label, tick_step};
use super::draw::{CURVES_HEIGHT, LANE, LINE, MARGIN};
use super::*;

fn curve(method: &str, papers: bool, points: &[(f64, f64)]) -> Series {
    Series { method: method.into(), papers, label: method.into(), points: points.to_vec() }
}

fn figure(panel: Panel) -> Figure {
    Figure { id: "test".into(), title: "A test".into(), caption: String::new(), panel }
}

#[test]
fn curves_have_axes_legend_and_correct_points() {
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
    // The curve runs from the middle of the frame, 20 ms, to its top, 40 ms. The first line belongs to the legend.
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
    let centres: Vec<&str> = svg.lines().filter(|l| l.contains("<circle") && l.contains("#777A80")).collect();
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
    // One mark is in the legend and one in the row, where the bars have different heights.
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
    let persons = svg
        .lines()
        .filter(|l| l.starts_with("<polyline") && l.contains("stroke-width=\"2\"") && l.contains("#777A80"));
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
    let labels: Vec<String> = range.ticks.iter().map(|t| tick_label(*t, &range.ticks, range.scale)).collect();
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
    let many = (0..12).map(|i| curve(&format!("a method with number {i}"), false, &[(0.0, 1.0)])).collect();
    let svg = figure(Panel::Curves { x: axes().0, y: axes().1, series: many }).svg().unwrap();
    for i in 0..12 {
        assert!(svg.contains(&format!("number {i}")));
    }
}
