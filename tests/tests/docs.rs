//! Checks that files named in documents exist.

use std::fs;
use std::path::{Path, PathBuf};

/// Extensions that make a word in backticks a file of this repository.
const ENDINGS: [&str; 9] = [".rs", ".toml", ".md", ".frag", ".vert", ".comp", ".glsl", ".py", ".json"];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap()
}

/// Finds all Markdown files except build results.
fn documents(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if path.is_dir() {
            if !name.starts_with('.') && !["target", "out"].contains(&name.as_str()) {
                documents(&path, found);
            }
        } else if name.ends_with(".md") {
            found.push(path);
        }
    }
}

/// Returns file and anchor of links, `](file#anchor)`. Omits links to other sites.
fn links(text: &str) -> impl Iterator<Item = (&str, Option<&str>)> {
    let targets = text.split("](").skip(1).filter_map(|rest| rest.split_once(')')).map(|(target, _)| target);
    targets.filter(|target| !target.contains("://")).map(|target| match target.split_once('#') {
        Some((file, anchor)) => (file, Some(anchor)),
        None => (target, None),
    })
}

/// True if a document has a heading of this anchor: its words in lower case, without punctuation, joined by `-`.
fn has_heading(text: &str, anchor: &str) -> bool {
    let mut in_code = false;
    text.lines().any(|line| {
        in_code ^= line.starts_with("```");
        let heading = line.trim_start_matches('#').trim().to_lowercase();
        let kept = heading.chars().filter(|c| c.is_alphanumeric() || [' ', '-', '_'].contains(c));
        !in_code && line.starts_with('#') && kept.map(|c| if c == ' ' { '-' } else { c }).eq(anchor.chars())
    })
}

/// Returns the words in backticks that are paths from the root: they begin with one of its folders and end like a file.
fn paths(text: &str) -> impl Iterator<Item = &str> {
    let folders = ["app/", "android/", "docs/", "scenes/", "shaders-glsl/", "tests/", "xtask/"];
    let words = text.split('`').skip(1).step_by(2);
    words.filter(move |word| {
        folders.iter().any(|folder| word.starts_with(folder))
            && ENDINGS.iter().any(|ending| word.ends_with(ending))
            && !word.contains(['*', '<', ' ', 'N'])
    })
}

#[test]
fn every_link_and_path_leads_somewhere() {
    let mut files = Vec::new();
    documents(root(), &mut files);
    assert!(files.len() > 10, "the documents are gone");
    let mut lost = Vec::new();
    for file in &files {
        let text = fs::read_to_string(file).unwrap();
        let folder = file.parent().unwrap();
        let name = file.strip_prefix(root()).unwrap().display();
        for (target, anchor) in links(&text) {
            let path = if target.is_empty() { file.clone() } else { folder.join(target) };
            if !path.exists() {
                lost.push(format!("{name}: {target}"));
            } else if let Some(anchor) = anchor
                && !has_heading(&fs::read_to_string(path).unwrap(), anchor)
            {
                lost.push(format!("{name}: {target}#{anchor}"));
            }
        }
        let named = paths(&text).filter(|path| !root().join(path).exists());
        lost.extend(named.map(|path| format!("{name}: {path}")));
    }
    assert!(lost.is_empty(), "these do not exist:\n{}", lost.join("\n"));
}

/// Returns the cells of the table with a scene in each row that follows a line of a document.
fn cells(text: &str, before: &str) -> Vec<Vec<String>> {
    let (_, table) = text.split_once(before).unwrap();
    let rows =
        table.lines().skip_while(|line| !line.starts_with('|')).take_while(|line| line.starts_with('|'));
    let cell = |cell: &str| cell.trim().trim_matches('*').trim_matches('`').to_owned();
    rows.map(|row| row.split('|').map(cell).collect()).collect()
}

/// The picture's marks have the figures of the tables, and are where these figures lie.
#[test]
fn the_picture_of_scenes_shows_the_tables() {
    let read = |file: &str| fs::read_to_string(root().join("docs").join(file)).unwrap();
    let (text, picture) = (read("results.md"), read("pictures/scenes.svg"));
    let times = cells(&text, "Frame time over two renders");
    let qualities = cells(&text, "PSNR / SSIM on the same GPU");
    let of = |table: &[Vec<String>], scene: &str, method: &str| {
        let name = if method == "same image" { "mono" } else { method };
        let column = table[0].iter().position(|cell| cell == name).unwrap();
        table.iter().find(|row| row[1] == scene).unwrap()[column].clone()
    };
    let attribute = |mark: &str, name: &str| -> f32 {
        let (_, value) = mark.split_once(&format!(" {name}=\"")).unwrap();
        value.split_once('"').unwrap().0.parse().unwrap()
    };
    let (mut marks, mut placed) = (0, 0);
    for line in picture.lines().filter(|line| line.contains(": ")) {
        let Some((mark, title)) = line.split_once("<title>") else { continue };
        let (name, told) = title.split_once("</title>").unwrap().0.split_once(": ").unwrap();
        let (method, scene) = name.split_once(", ").unwrap();
        let time = of(&times, scene, method);
        let quality = of(&qualities, scene, method);
        let (psnr, ssim) = quality.split_once('/').unwrap();
        let both = format!("{time}, {psnr} dB, SSIM {}", ssim.trim_start_matches('0'));
        assert!(told == time || told == both, "{name}: {told}, but the tables have {both}");
        marks += 1;
        if told == both && mark.contains("<circle") {
            let [x, y] = [time, psnr.to_owned()].map(|value| value.parse::<f32>().unwrap());
            // The scales: 659 pixels from .5 to 1.5, and 54 for 10 dB.
            let [dx, dy] =
                [attribute(mark, "cx") - 659.0 * (x - 0.5), attribute(mark, "cy") + 5.4 * (y - 10.0)];
            assert!((dx - 96.9).abs() < 0.2 && (dy - 336.0).abs() < 0.2, "{name} is elsewhere: {dx}, {dy}");
            placed += 1;
        }
    }
    assert_eq!((marks, placed), (63, 16), "marks and circles");
}
