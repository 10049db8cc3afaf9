use super::*;

/// Returns the drawing's elements of an entry of the legend.
fn group(svg: &str, entry: usize) -> &str {
    svg.split(&format!("<g data-series=\"{entry}\">")).nth(1).unwrap().split("</g>").next().unwrap()
}

#[test]
fn curves_have_axes_and_correct_points() {
    let axes = (Axis::new("triangles, millions"), Axis::new("frame time, ms").from_zero());
    let mut plot = Plot::curves("A test", axes.0, axes.1);
    plot.curve(Entry::papers("yoro-paper", "the paper's"), [(1.0, 10.0), (2.0, f64::NAN)]);
    plot.curve(Entry::ours("conventional"), [(1.0, 20.0), (2.0, 40.0), (3.0, 40.0)]);
    let labels: Vec<&str> = plot.legend().iter().map(|entry| entry.label.as_str()).collect();
    assert_eq!(labels, ["conventional", "the paper's"], "ours first");
    let drawing = plot.draw().unwrap();
    assert!(drawing.svg.contains("triangles, millions") && drawing.svg.contains("frame time, ms"));
    assert!(!drawing.svg.contains("NaN") && !drawing.svg.contains(">\nconventional\n</text>"));
    let document = plot.to_svg().unwrap();
    assert!(document.contains(">\nconventional\n</text>") && document.contains("prefers-color-scheme"));
    assert!(group(&drawing.svg, 0).contains("#3D3F44") && group(&drawing.svg, 1).contains("#D55E00"));
    let points: Value = serde_json::to_value(&drawing.points).unwrap();
    assert_eq!(points.as_array().unwrap().len(), 4, "three of ours and one of the paper's");
    let at = |i: usize, axis: usize| points[i]["at"][axis].as_i64().unwrap();
    // Equal steps are equally far apart: 10, 20 and 40 ms over 0. The paper's is drawn first.
    let [ten, twenty, forty] = [at(0, 1), at(1, 1), at(2, 1)];
    assert!(((ten - twenty) * 2 - (twenty - forty)).abs() <= 2, "{points}");
}

#[test]
fn rows_have_names_marks_and_lanes() {
    let mut plot = Plot::rows("A test", Axis::new("ratio").baseline(1.0));
    for (row, value) in [("a <b>", 0.5), ("c", 0.25)] {
        plot.mark(row, Entry::ours("mono"), value);
        plot.mark(row, Entry::ours("hybrid"), f64::INFINITY);
    }
    assert_eq!(plot.legend().len(), 1, "what is not finite is not drawn");
    let drawing = plot.draw().unwrap();
    assert!(drawing.svg.contains("a &lt;b&gt;") && !drawing.svg.contains("inf"));
    let row = |drawing: &draw::Drawing, i: usize| {
        serde_json::to_value(&drawing.points[i]).unwrap()["at"][1].as_i64().unwrap()
    };
    assert!(row(&drawing, 0) < row(&drawing, 1), "from top to bottom");
    let interval = Some(Interval { low: 0.4, high: 0.7 });
    plot.mark_interval("c", Entry::ours("yoro"), 0.5, interval);
    let drawing = plot.draw().unwrap();
    let of_c: Vec<i64> = (0..3).map(|i| row(&drawing, i)).collect();
    assert!(of_c[0] - of_c[2] >= 20, "each method has its lane: {of_c:?}");
    let data = plot.to_page().unwrap()["data"].as_str().unwrap().to_owned();
    assert!(data.contains("[0.4,0.7]") && data.contains("a \\u003cb>"), "{data}");
}

#[test]
fn logarithms_have_few_ticks() {
    let mut plot = Plot::points("A test", Axis::new("ms").logarithmic(), Axis::new("y"));
    assert!(plot.is_empty() && plot.draw().is_ok(), "without values");
    plot.curve(Entry::ours("yoro"), [(0.35, 5.0), (37142.0, 5.0)]);
    let svg = plot.draw().unwrap().svg;
    for tick in ["1", "10", "100", "1000", "10000"] {
        assert!(svg.contains(&format!(">\n{tick}\n</text>")), "{tick}: {svg}");
    }
}
