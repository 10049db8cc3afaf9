//! Results with known figures, checked in tables, plots and the page.

use std::path::Path;

use image::{Rgb, RgbImage};

use super::record::{Header, PassClock, RoundEnd, SceneFacts, Unsupported, VERSION};
use super::{BenchReport, Conditions, Measurement, Record, Results, Writer, metric, picture_folder};
use crate::machine::{Machine, Parameter};
use yoro_assets::ShadingStyle;
use yoro_report::Plot;

fn header(renderer: &str) -> Header {
    Header {
        yoro_bench: VERSION,
        suites: vec!["all".into()],
        quick: false,
        machine: Machine {
            cpu: "Example & Sons CPU".into(),
            gl_renderer: renderer.into(),
            gl_version: "OpenGL ES 3.2 Mesa".into(),
            command: "yoro bench all --out 'a <b>.jsonl'".into(),
            ..Machine::default()
        },
        pass_clock: PassClock::Finish,
        parameters: vec![
            Parameter { name: "rounds".into(), value: "3".into() },
            Parameter { name: "dominant eye".into(), value: "right".into() },
        ],
    }
}

fn conditions(suite: &str, scene: &str, label: Option<&str>, point: Option<f64>) -> Conditions {
    Conditions { suite: suite.into(), scene: scene.into(), label: label.map(str::to_owned), point }
}

/// The values of a contender in one round: `(contender, [(metric, values)])`.
type Figures<'a> = (&'a str, Vec<(&'a str, Vec<f64>)>);

/// Appends rounds of a setting. Multiview is never supported.
fn append<'a>(
    writer: &mut Writer,
    conditions: Conditions,
    rounds: u32,
    figures: impl Fn(u32) -> Vec<Figures<'a>>,
) {
    let scene = SCENES.iter().find(|(scene, ..)| *scene == conditions.scene);
    let (stands_for, triangles) = scene.map_or(("", 117_000), |(_, paper, triangles)| (*paper, *triangles));
    let facts = Record::Scene(SceneFacts {
        conditions: conditions.clone(),
        stands_for: stands_for.into(),
        style: ShadingStyle::Realistic,
        triangles,
        lights: 3,
        frames: vec!["viewpoint 0".into(), "viewpoint 1".into()],
    });
    let refused = Record::Unsupported(Unsupported {
        conditions: conditions.clone(),
        contender: "multiview".into(),
        reason: "this driver has no GL_OVR_multiview2".into(),
    });
    let mut records = vec![facts, refused];
    for round in 0..rounds {
        for (contender, values) in figures(round) {
            let (conditions, contender) = (conditions.clone(), contender.into());
            let mut measurement = Measurement { conditions, contender, round, values: Default::default() };
            for (name, samples) in values {
                samples.into_iter().for_each(|sample| measurement.push(name, sample));
            }
            records.push(Record::Measurement(measurement));
        }
        let end = RoundEnd { conditions: conditions.clone(), round };
        writer.append(std::mem::take(&mut records), end).unwrap();
    }
}

const SCENES: [(&str, &str, u64); 2] =
    [("street <b>&\"café\"</b>", "Bistro", 1_240_000), ("atrium | columns", "Sponza", 365_000)];

const METHODS: [(&str, f64); 5] =
    [("conventional", 1.0), ("mono", 0.5), ("hybrid", 0.8), ("yoro-gather", 0.55), ("yoro-paper", 0.6)];

fn times(ms: f64, round: u32) -> Vec<Figures<'static>> {
    // The machine slows down from round to round, which does not affect ratios within a round.
    let slow = ms * 2f64.powi(round as i32);
    let of = |share: f64| vec![(metric::FRAME_MS, vec![slow * share, slow * share * 1.5])];
    METHODS.iter().map(|(name, share)| (*name, of(*share))).collect()
}

fn qualities(psnr: f64) -> Vec<Figures<'static>> {
    let of = |psnr: f64| {
        vec![
            (metric::PSNR, vec![psnr, psnr + 2.0]),
            (metric::SSIM, vec![1.0 - 1.0 / psnr; 2]),
            (metric::FLIP, vec![1.0 / psnr; 2]),
            (metric::HOLE_SHARE, vec![0.02; 2]),
            (metric::HOLE_PSNR, vec![psnr - 10.0, f64::NAN]),
            (metric::VISIBLE_PSNR, vec![psnr + 3.0; 2]),
        ]
    };
    let methods = METHODS.iter().filter(|(name, _)| *name != "conventional");
    methods.map(|(name, share)| (*name, of(psnr * (1.5 - share)))).collect()
}

fn both(ms: f64, psnr: f64, round: u32) -> Vec<Figures<'static>> {
    let mut figures = times(ms, round);
    for (name, values) in qualities(psnr) {
        if let Some((_, found)) = figures.iter_mut().find(|(other, _)| *other == name) {
            found.extend(if round == 0 { values } else { Vec::new() });
        }
    }
    let extra = [("cpu_ms", 7.5), ("memory_mib", 300.0), ("pass_ms/lighting", 1.25)];
    for (_, values) in &mut figures {
        values.extend(extra.map(|(name, value)| (name, vec![value])));
    }
    figures
}

/// Returns two modes of the suite `stream` at two quantizers. One eye and depth take 40 % less, then 30 % less.
fn streams() -> Vec<Figures<'static>> {
    let quality = || vec![(metric::PSNR, vec![34.0, 36.0]), (metric::SSIM, vec![0.95; 2])];
    let of = |rate: f64| [quality(), vec![(metric::KBIT_S, vec![rate])]].concat();
    let saving = |rate: f64, saved: f64| [of(rate), vec![(metric::SAVED, vec![saved])]].concat();
    vec![
        ("same image, not encoded", quality()),
        ("two eyes, rotation, QP 20", of(8000.0)),
        ("one eye and depth, QP 20", saving(4800.0, 40.0)),
        ("two eyes, rotation, QP 32", of(2000.0)),
        ("one eye and depth, QP 32", saving(1400.0, 30.0)),
    ]
}

/// Writes results of every suite, with a few settings each.
fn write_results(path: &Path, header: &Header) {
    let (mut writer, _) = Writer::open(path, header).unwrap();
    let w = &mut writer;
    for (i, (scene, ..)) in SCENES.into_iter().enumerate() {
        let ms = 100.0 * (i + 1) as f64;
        append(w, conditions("scenes", scene, None, None), 3, |round| both(ms, 30.0 + i as f64, round));
        append(w, conditions("lights", scene, None, Some(4.0)), 1, |round| times(ms, round));
        append(w, conditions("flicker", scene, None, None), 1, |_| {
            vec![
                ("conventional", vec![(metric::CHANGE, vec![9.0]), (metric::CHANGE_HOLES, vec![12.0])]),
                ("mono", vec![(metric::FLICKER, vec![3.0]), (metric::FLICKER_HOLES, vec![5.0])]),
                ("yoro-gather", vec![(metric::FLICKER, vec![1.0]), (metric::FLICKER_HOLES, vec![2.0])]),
            ]
        });
        append(w, conditions("stream", scene, Some("0 late"), None), 1, |_| streams());
    }
    for i in (1..=5).map(f64::from) {
        append(w, conditions("complexity", "swarm", None, Some(1e6 * i)), 1, |round| times(32.0 * i, round));
    }
    for (style, psnr) in [("realistic", 33.0), ("cartoon", 35.0), ("anime", 31.0)] {
        append(w, conditions("styles", "talk", Some(style), None), 1, |_| qualities(psnr));
    }
    for point in [50.0, 55.0, 60.0, 65.0, 70.0, 75.0] {
        append(w, conditions("ipd", "talk", None, Some(point)), 1, |_| qualities(40.0 - point / 10.0));
    }
    for point in [0.5, 1.0, 2.0, 3.0] {
        append(w, conditions("distance", "hare", None, Some(point)), 1, |_| qualities(30.0 + point));
    }
    append(w, conditions("patchers", "talk", None, None), 1, |_| {
        let of = |psnr: f64, ms: f64| {
            vec![(metric::PSNR, vec![psnr]), (metric::SSIM, vec![psnr / 40.0]), (metric::PATCH_MS, vec![ms])]
        };
        vec![
            ("mono", vec![(metric::PSNR, vec![20.0]), (metric::SSIM, vec![0.5])]),
            ("patcher-paper", of(33.0, 12.0)),
            ("patcher-telea", of(32.0, 95.0)),
            ("patcher-neural", of(31.0, 2500.0)),
        ]
    });
    append(w, conditions("new suite", "talk", None, None), 1, |_| vec![("x", vec![("apples", vec![3.0])])]);
}

fn report(dir: &Path) -> BenchReport {
    let path = dir.join("run.jsonl");
    write_results(&path, &header("llvmpipe"));
    let picture = |shift: u32| {
        RgbImage::from_fn(48, 32, |x, y| {
            Rgb([((x + shift) * 5) as u8, (y * 7) as u8, ((x + shift) * y) as u8])
        })
    };
    let folder = picture_folder(&path, &conditions("scenes", "atrium | columns", None, None));
    for (name, shift) in [("dominant", 4), ("truth", 0), ("yoro-gather", 1)] {
        yoro_media::save_color(&folder.join(format!("{name}.png")), &picture(shift)).unwrap();
    }
    BenchReport::new(vec![Results::read(&path).unwrap()]).unwrap()
}

fn markdown() -> String {
    let dir = tempfile::tempdir().unwrap();
    report(dir.path()).report().to_markdown()
}

/// Returns the cells of the first row with a cell `named` in the Markdown table below a heading.
fn row(markdown: &str, table: &str, named: &str) -> Vec<String> {
    let start = markdown.find(table).unwrap_or_else(|| panic!("no table {table} in {markdown}"));
    let mut lines = markdown[start..].lines().map(|line| line.replace("\\|", "/"));
    let line = lines.find(|line| line.contains(&format!("| {named} |")));
    let line = line.unwrap_or_else(|| panic!("no row {named} below {table}: {}", &markdown[start..]));
    line.split('|').map(|cell| cell.trim().to_owned()).filter(|cell| !cell.is_empty()).collect()
}

#[test]
fn ratios_pair_frames_of_the_same_round() {
    let markdown = markdown();
    let cells = row(&markdown, "**Frame time over two full renders**", "atrium / columns");
    assert_eq!(
        cells[1..7],
        ["365 k", "500 ms", "0.50 (0.50–0.50)", "0.80 (0.80–0.80)", "0.55 (0.55–0.55)", "0.60 (0.60–0.60)"],
        "{cells:?}"
    );
    assert_eq!(cells[7], "*Sponza: 0.46*");
    let cells = row(&markdown, "**Frame times in full**", "yoro-gather");
    assert_eq!(cells[8..], ["0.550", "0.550 – 0.550", "–"], "{cells:?}");
}

#[test]
fn slopes_are_least_squares_beside_the_papers() {
    let markdown = markdown();
    let cells = row(&markdown, "**Slope and ratio**", "yoro-paper");
    assert_eq!(cells[..5], ["yoro-paper", "24.00", "0.00", "0.600", "0.60 (0.60–0.60)"], "{cells:?}");
    // The expected values come from NumPy's polyfit of the paper's nine points.
    assert_eq!(cells[5..], ["*8.26*", "*0.490*", "*0.540*"], "{cells:?}");
    assert!(row(&markdown, "**Slope and ratio**", "multiview")[1].contains("no GL_OVR_multiview2"));
}

#[test]
fn quality_has_the_same_image_and_the_paper_as_baselines() {
    let markdown = markdown();
    let cells = row(&markdown, "**PSNR in dB/SSIM/FLIP**", "street &lt;b>&\"café\"&lt;/b>");
    // 30 dB times 1.5 - share, plus 1 dB in the mean of two frames.
    assert_eq!(
        cells[2..6],
        ["31.00/0.9667/0.033", "22.00/0.9524/0.048", "29.50/0.9649/0.035", "28.00/0.9630/0.037"],
        "{cells:?}"
    );
    assert_eq!(cells.last().unwrap(), "*Bistro: 31.99 / 0.9505*");
    let cells = row(&markdown, "**Holes and the rest", "yoro-gather");
    let holes: f64 = cells[4].parse().unwrap();
    assert!((holes - 18.975).abs() < 0.006, "the PSNR in holes of frames that have some: {cells:?}");
    let cells = row(&markdown, "**Means over the scenes**", "patcher-telea");
    assert_eq!(cells[1..3], ["32.00", "0.8000"]);
    assert_eq!(cells[6..], ["95.00", "*32.25*", "*0.9542*", "*48.80*"], "{cells:?}");
    let cells = row(&markdown, "## Distance between the eyes", "55");
    assert_eq!(cells.last().unwrap(), "*34.16*", "{cells:?}");
}

#[test]
fn bits_are_compared_at_equal_quantizers_and_with_the_papers() {
    let markdown = markdown();
    let table = "**Bit rate in kbit/s, and bits saved against both eyes at the same quantizer**";
    assert_eq!(row(&markdown, table, "two eyes, rotation, QP 20")[1..], ["8000", "8000"]);
    assert_eq!(row(&markdown, table, "one eye and depth, QP 32")[1..], ["1400, 30.0 %", "1400, 30.0 %"]);
    let note = "Mean difference of one eye and depth here -35.0 %; the paper's -39.6 %.";
    assert!(markdown.contains(note), "{markdown}");
}

#[test]
fn every_section_has_its_place_and_no_row_is_silently_empty() {
    let dir = tempfile::tempdir().unwrap();
    let report = report(dir.path()).report();
    let headings: Vec<&str> = report.sections.iter().map(|section| section.heading.as_str()).collect();
    let expected = "Frame time, Image quality, Overhead, Complexity, Shading styles, Distance between the eyes, \
        Distance of the object, Patchers, Few lights, Flicker, Streaming, New suite, Pictures, How it was measured";
    assert_eq!(headings.join(", "), expected);
    for section in &report.sections {
        for table in section.tables() {
            for line in &table.lines {
                let cells: usize = line.cells.iter().map(|cell| cell.span).sum();
                assert_eq!(cells, table.columns.len(), "{}: {line:?}", table.title);
            }
            let named =
                table.lines.iter().any(|line| line.cells[0].text == "multiview" && line.cells[1].span > 0);
            let with_reasons =
                !["Time of each pass", "Quality of both eyes"].iter().any(|t| table.title.starts_with(t));
            assert!(named || !with_reasons, "{} says nothing of multiview", table.title);
        }
    }
    let plots = |heading: &str| -> Vec<&str> {
        let section = report.sections.iter().find(|section| section.heading == heading).unwrap();
        section.plots().map(|plot: &Plot| plot.title.as_str()).collect()
    };
    let quality = ["PSNR, dB", "SSIM, gaussian 11x11", "FLIP, 0 to 1"];
    let ratio = "Frame time over two full renders";
    assert_eq!(plots("Frame time"), [ratio, "Frame time here"]);
    assert_eq!(plots("Complexity"), ["Frame time", ratio]);
    for heading in ["Image quality", "Shading styles", "Distance between the eyes"] {
        assert_eq!(plots(heading), quality, "{heading}");
    }
    assert_eq!(plots("Patchers"), ["PSNR", "SSIM", "Time"]);
}

#[test]
fn machines_stand_side_by_side_and_files_of_one_are_merged() {
    let dir = tempfile::tempdir().unwrap();
    let written = |name: &str, header: &Header| {
        let path = dir.path().join(format!("{name}.jsonl"));
        write_results(&path, header);
        Results::read(&path).unwrap()
    };
    let [a, b, c] = [("a", "llvmpipe"), ("b", "a GPU"), ("c", "llvmpipe")]
        .map(|(name, renderer)| written(name, &header(renderer)));
    let mut newer = header("llvmpipe");
    newer.machine.gl_version = "OpenGL ES 3.2 Mesa 25".into();
    let d = written("d", &newer);
    let read = |files: [&Results; 2]| BenchReport::new(files.map(Results::clone).into()).unwrap().report();
    let html = read([&a, &b]).to_html().unwrap();
    assert!(html.contains("id=\"complexity-llvmpipe\"") && html.contains("id=\"complexity-a-gpu\""));
    let markdown = read([&a, &d]).to_markdown();
    assert!(markdown.contains("(llvmpipe, OpenGL ES 3.2 Mesa)\n"));
    assert!(markdown.contains("(llvmpipe, OpenGL ES 3.2 Mesa 25)\n"));
    let markdown = read([&a, &c]).to_markdown();
    assert_eq!(markdown.matches("## Complexity").count(), 1);
    let cells = row(&markdown, "**Frame times in full**", "yoro-gather");
    assert_eq!(cells[2], "12", "three rounds of two frames, twice: {cells:?}");
    // The command of a part would measure a part.
    let [one, two] = ["1", "2"].map(|part| {
        let mut header = header("llvmpipe");
        header.machine.command = format!("yoro bench complexity --shard {part}/2 --quick");
        written(part, &header)
    });
    let markdown = read([&one, &two]).to_markdown();
    assert!(markdown.contains("`yoro bench complexity --quick`") && !markdown.contains("--shard"));
}

#[test]
fn a_report_is_a_page_and_its_tables() {
    let dir = tempfile::tempdir().unwrap();
    let written = report(dir.path()).write(&dir.path().join("docs")).unwrap();
    let read = |path: &Path| std::fs::read_to_string(path).unwrap();
    let page = read(&written.page);
    // The truth, the method, the same image, and two error maps.
    assert_eq!(page.matches("src=\"data:image/jpeg;base64,").count(), 5);
    assert!(page.matches("<svg viewBox").count() > 20);
    let tables = read(&written.markdown);
    assert!(tables.contains("## Image quality\n") && tables.contains("## Distance between the eyes"));
    assert!(tables.contains("`yoro bench all") && tables.contains("Example & Sons"));
}
