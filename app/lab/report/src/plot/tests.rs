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
    let (svg, points) = plot.draw(false).unwrap();
    assert!(svg.contains("triangles, millions") && svg.contains("frame time, ms"));
    assert!(!svg.contains("NaN") && !svg.contains(">\nconventional\n</text>"));
    let document = plot.to_svg().unwrap();
    assert!(document.contains(">\nconventional\n</text>") && document.contains("prefers-color-scheme"));
    assert!(group(&svg, 0).contains("#3D3F44") && group(&svg, 1).contains("#D55E00"));
    assert_eq!(points.len(), 4, "three of ours and one of the paper's");
    let at = |i: usize, axis: usize| points[i]["at"][axis].as_f64().unwrap();
    // Equal steps are equally far apart: 10, 20 and 40 ms over 0. The paper's is drawn first.
    let [ten, twenty, forty] = [at(0, 1), at(1, 1), at(2, 1)];
    assert!(((ten - twenty) * 2.0 - (twenty - forty)).abs() <= 2.0, "{points:?}");
}

#[test]
fn rows_have_names_marks_and_lanes() {
    let mut plot = Plot::rows("A test", Axis::new("ratio").baseline(1.0));
    for (row, value) in [("a <b>", 0.5), ("c", 0.25)] {
        plot.mark(row, Entry::ours("mono"), value);
        plot.mark(row, Entry::ours("hybrid"), f64::INFINITY);
    }
    assert_eq!(plot.legend().len(), 1, "what is not finite is not drawn");
    let (svg, points) = plot.draw(false).unwrap();
    assert!(svg.contains("a &lt;b&gt;") && !svg.contains("inf"));
    let row = |point: &Value| point["at"][1].as_f64().unwrap();
    assert!(row(&points[0]) < row(&points[1]), "from top to bottom");
    plot.mark_interval("c", Entry::ours("yoro"), 0.5, Some([0.4, 0.7]));
    let of_c: Vec<f64> = plot.draw(false).unwrap().1.iter().map(row).collect();
    assert!(of_c[0] - of_c[2] >= 20.0, "each method has its lane: {of_c:?}");
    let data = plot.to_page().unwrap()["data"].as_str().unwrap().to_owned();
    assert!(data.contains("[0.4,0.7]") && data.contains("a \\u003cb>"), "{data}");
}

#[test]
fn logarithms_have_few_ticks() {
    let mut plot = Plot::curves("A test", Axis::new("ms").logarithmic(), Axis::new("y"));
    assert!(plot.is_empty() && plot.to_svg().unwrap().contains(">\ny\n</text>"), "without values");
    plot.curve(Entry::ours("yoro"), [(0.35, 5.0), (37142.0, 5.0)]);
    let svg = plot.to_svg().unwrap();
    for tick in ["1", "10", "100", "1000", "10000"] {
        assert!(svg.contains(&format!(">\n{tick}\n</text>")), "{tick}: {svg}");
    }
    assert!(!svg.contains(">\n2\n</text>"), "{svg}");
}
