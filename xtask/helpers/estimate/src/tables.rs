//! The tables of the estimate.

use crate::gpus::{Device, GPUS};
use crate::model::{BYTES, BYTES_16, Frame, MULTIVIEW, SIZE, VERTICES, VERTICES_ONCE};
use yoro_report::stats::{mean, unique};
use yoro_report::{Cell, Report, Section, Table};

/// The passes whose cost depends on the application's surfaces.
const SURFACES: &str = "surfaces";
/// The prefix of what the synthesis takes by itself, beside its slots.
pub const SYNTHESIS_ALONE: &str = "synthesis ";
/// The method that the others are compared with.
const TWO_RENDERS: &str = "conventional";

/// The costs of a method's frames in a scene.
pub struct Estimate {
    pub scene: &'static str,
    /// With bloom or without.
    pub label: &'static str,
    pub method: &'static str,
    /// One frame for each viewpoint.
    pub frames: Vec<Frame>,
}

/// A method, with bloom or without.
#[derive(Clone, Copy)]
struct Entry<'a> {
    estimates: &'a [Estimate],
    label: &'a str,
    method: &'a str,
    /// True if vertices are shaded once for both eyes.
    once: bool,
}

impl<'a> Entry<'a> {
    fn all(estimates: &'a [Estimate]) -> Vec<Entry<'a>> {
        let mut entries = Vec::new();
        for (label, method) in unique(estimates.iter().map(|estimate| (estimate.label, estimate.method))) {
            let entry = Entry { estimates, label, method, once: false };
            if method == MULTIVIEW {
                entries.push(Entry { once: true, ..entry });
            }
            entries.push(entry);
        }
        entries.sort_by_key(|entry| entry.label);
        entries
    }

    fn title(&self) -> &'a str {
        match (self.method, self.once) {
            (TWO_RENDERS, _) => "two renders",
            (MULTIVIEW, true) => "multiview, vertices once",
            (MULTIVIEW, false) => "multiview, vertices twice",
            ("conventional-medium", _) => "two renders, foveation `medium`",
            ("yoro-gather", _) => "**`yoro`**",
            ("yoro-holes-rendered", _) => "`yoro`, holes rendered",
            ("yoro-medium", _) => "`yoro`, foveation `medium`",
            (name, _) => name,
        }
    }

    fn is_synthesis(&self) -> bool {
        self.method.starts_with("yoro-")
    }

    fn two_renders(&self) -> Entry<'a> {
        Entry { method: TWO_RENDERS, once: false, ..*self }
    }

    fn scenes(&self) -> impl Iterator<Item = &'a Estimate> {
        let Entry { label, method, .. } = *self;
        self.estimates.iter().filter(move |estimate| estimate.label == label && estimate.method == method)
    }

    /// Returns in each scene the sum of the metrics that start with `prefix` and for whose rest `counts` is true.
    fn sums(&self, prefix: &str, counts: impl Fn(&str) -> bool) -> Vec<f64> {
        let of_frame = |frame: &Frame| -> f64 {
            let counted = frame.iter().filter(|(name, _)| name.strip_prefix(prefix).is_some_and(&counts));
            counted.map(|(_, value)| value).sum()
        };
        self.scenes().map(|estimate| average(estimate.frames.iter().map(of_frame))).collect()
    }

    /// Returns the issue slots per pixel of an eye in each scene, for the passes for which `counts` is true.
    fn slots(&self, gpu: &Device, counts: impl Fn(&str) -> bool) -> Vec<f64> {
        let left_out = if self.once { VERTICES } else { VERTICES_ONCE };
        self.sums(&format!("slots/{}/", gpu.gpu), |pass| pass != left_out && counts(pass))
    }

    fn all_slots(&self, gpu: &Device) -> Vec<f64> {
        self.slots(gpu, |_| true)
    }

    /// Returns the bytes per pixel of an eye in each scene, under the assumption that `prefix` stands for.
    fn bytes(&self, prefix: &str) -> Vec<f64> {
        self.sums(prefix, |_| true)
    }

    /// Returns the milliseconds that a GPU needs at least for the frame of each scene.
    fn times(&self, gpu: &Device) -> Vec<f64> {
        let both = self.all_slots(gpu).into_iter().zip(self.bytes(BYTES));
        both.map(|(slots, bytes)| gpu.milliseconds(slots, 0.0, bytes)).collect()
    }

    /// Returns the values of each scene over those of two renders.
    fn over_two(&self, values: impl Fn(&Entry) -> Vec<f64>) -> Vec<f64> {
        values(self).iter().zip(values(&self.two_renders())).map(|(own, base)| own / base).collect()
    }
}

fn average(values: impl IntoIterator<Item = f64>) -> f64 {
    mean(values).unwrap_or(f64::NAN)
}

/// Returns the report of all estimates.
pub fn report(mut estimates: Vec<Estimate>) -> Report {
    // By label, so that scenes of one label follow each other in every table.
    estimates.sort_by_key(|estimate| estimate.label);
    let entries = Entry::all(&estimates);
    let mut section = Section::new(
        "Whole frames on mobile GPUs",
        "An estimate: nothing here was timed on a GPU. Frames are rendered here; the samples that pass each depth test are \
         counted, shaders are sized by Mesa's compilers for these GPUs, and the loops of lamps and of the synthesis are \
         counted by waves. Bytes are those that a tile-based GPU moves between tiles and memory.",
    );
    for entry in entries.iter().filter(|entry| entry.is_synthesis()) {
        section.table(by_scene(entry));
    }
    for table in [ratios(&entries), worth(&entries), break_evens(&entries), alone(&entries), passes(&entries)]
    {
        section.table(table);
    }
    Report { title: "Estimate".into(), sections: vec![section], ..Report::default() }
}

/// Returns a table with columns for each GPU after the first ones, and before the last ones.
fn table(title: impl Into<String>, first: &[&str], last: &[&str]) -> Table {
    let gpus = GPUS.map(|gpu| gpu.name);
    Table::new(title, &[first, &gpus, last].concat())
}

fn ours(text: String) -> Cell {
    Cell::ours(Some(text))
}

/// Returns a row that starts with an entry, and its values on each GPU.
fn row(entry: &Entry, value: impl Fn(&Device) -> String) -> Vec<Cell> {
    let names = [Cell::plain(entry.label), Cell::plain(entry.title())];
    names.into_iter().chain(GPUS.iter().map(|gpu| ours(value(gpu)))).collect()
}

/// Returns bytes, slots and times of synthesis over those of two renders, scene by scene.
fn by_scene(entry: &Entry) -> Table {
    let title = format!("{} with {}, over two renders: slots, then time", entry.title(), entry.label);
    let mut table = table(
        title,
        &["<scene", "<glass", "two renders, bytes a pixel", "yoro, bytes", "bytes", "16-bit depth"],
        &[],
    );
    let [own, base] = [*entry, entry.two_renders()].map(|entry| entry.bytes(BYTES));
    let bytes = [BYTES, BYTES_16].map(|prefix| entry.over_two(|entry| entry.bytes(prefix)));
    let slots = GPUS.map(|gpu| entry.over_two(|entry| entry.all_slots(&gpu)));
    let times = GPUS.map(|gpu| entry.over_two(|entry| entry.times(&gpu)));
    let mut push = |scene: &str, glass: &str, of: &dyn Fn(&[f64]) -> f64| {
        let mut cells = vec![Cell::plain(scene), Cell::plain(glass)];
        cells.extend([Cell::base(Some(format!("{:.1}", of(&base)))), ours(format!("{:.1}", of(&own)))]);
        cells.extend(bytes.iter().map(|ratios| ours(format!("{:.2}", of(ratios)))));
        let both = slots.iter().zip(&times);
        cells.extend(both.map(|(slots, times)| ours(format!("{:.2}; {:.2}", of(slots), of(times)))));
        table.push(cells);
    };
    for (i, estimate) in entry.scenes().enumerate() {
        let has_glass = estimate.frames.iter().any(|frame| frame.contains_key("fragments/transparent"));
        push(estimate.scene, if has_glass { "in view" } else { "" }, &|values| values[i]);
    }
    push("mean", "", &|values| average(values.iter().copied()));
    table.note = "A frame takes as long as its slots or its bytes, whichever take longer at the GPU's rates; `auto` \
                  chooses synthesis where the time is below 1. 16-bit depth is simulated: carried depth is counted with \
                  2 bytes, as a Vulkan host resolves it."
        .into();
    table
}

fn ratios(entries: &[Entry]) -> Table {
    let title = "Executed slots over two renders: mean of the scenes, least and most";
    let last = ["bytes a pixel", "bytes", "bytes, 16-bit depth"];
    let mut table = table(title, &["<frames", "<method"], &last);
    for entry in entries {
        let mut cells = row(entry, |gpu| match entry.method {
            TWO_RENDERS => format!("{:.0} slots", average(entry.all_slots(gpu))),
            _ => spread(&entry.over_two(|entry| entry.all_slots(gpu))),
        });
        cells.push(ours(format!("{:.0}", average(entry.bytes(BYTES)))));
        for prefix in [BYTES, BYTES_16] {
            cells.push(ours(spread(&entry.over_two(|entry| entry.bytes(prefix)))));
        }
        table.push(cells);
    }
    table.group();
    table
}

/// Formats a mean with the smallest and the largest value.
fn spread(values: &[f64]) -> String {
    let (low, high) = values.iter().fold((f64::INFINITY, 0f64), |(low, high), v| (low.min(*v), high.max(*v)));
    format!("{:.2} ({low:.2}–{high:.2})", average(values.iter().copied()))
}

/// Returns the cost of a view above which synthesis is worth it.
fn worth(entries: &[Entry]) -> Table {
    let title = "Synthesis is worth it when a view costs the GPU more than this, in ms";
    let mut table = table(title, &["<frames", "<method"], &[]);
    for entry in entries.iter().filter(|entry| entry.is_synthesis()) {
        let both = [entry.two_renders(), *entry];
        let [two, wide] = both.map(|entry| average(entry.sums("fragments/", |pass| pass == SURFACES)));
        table.push(row(entry, |gpu| {
            let beyond = |[two_views, own]: [f64; 2]| own - wide / two * two_views;
            let slots = beyond(both.map(|entry| average(entry.all_slots(gpu))));
            let bytes = beyond(both.map(|entry| average(entry.bytes(BYTES))));
            let limit = least_view(gpu.milliseconds(slots, 0.0, bytes), 2.0 * wide / two);
            limit.map_or("never".into(), |limit| format!("{limit:.1}"))
        }));
    }
    let sizes = GPUS.map(|gpu| {
        format!("{} {} x {} pixels an eye, {} GB/s", gpu.name, gpu.size[0], gpu.size[1], gpu.bytes / 1e9)
    });
    table.note = format!(
        "What synthesis costs beyond one view with its guard band, in slots or bytes, whichever take longer. Assumed: {}.",
        sizes.join("; ")
    );
    table
}

/// Returns the time of a view from which on the other eye costs less by synthesis, if synthesis takes `more` and draws
/// `wider` times as much of the first view.
fn least_view(more: f64, wider: f64) -> Option<f64> {
    (wider < 2.0).then(|| (more / (2.0 - wider)).max(0.0))
}

fn break_evens(entries: &[Entry]) -> Table {
    let title = "Synthesis pays if surfaces cost more than this, in slots for each pixel of an eye with overdraw; in these scenes";
    let mut table = table(title, &["<frames", "<method"], &[]);
    for entry in entries.iter().filter(|entry| entry.is_synthesis()) {
        table.push(row(entry, |gpu| {
            let both = [entry.two_renders(), *entry];
            let surfaces = both.map(|entry| average(entry.slots(gpu, |pass| pass == SURFACES)));
            let rest = both.map(|entry| average(entry.slots(gpu, |pass| pass != SURFACES)));
            let slots = break_even(surfaces, rest).map(|slots| format!("{:.0}", slots.max(0.0)));
            format!("{}; {:.0}", slots.unwrap_or_else(|| "never".into()), 0.5 * surfaces[0])
        }));
    }
    table
}

/// Returns the cost of surfaces, in slots per pixel of one eye, above which a method is cheaper than two renders.
///
/// If surfaces cost `x` times those of the scenes, two renders cost `x * surfaces[0] + rest[0]` and the method `x *
/// surfaces[1] + rest[1]`. `None` if the method is never cheaper.
fn break_even(surfaces: [f64; 2], rest: [f64; 2]) -> Option<f64> {
    let saved = surfaces[0] - surfaces[1];
    (saved > 0.0).then(|| 0.5 * surfaces[0] * (rest[1] - rest[0]) / saved)
}

/// Returns what the synthesis takes by itself.
fn alone(entries: &[Entry]) -> Table {
    let title = "The synthesis alone: slots, texture fetches and bytes a pixel, and milliseconds of a frame";
    let mut table = table(title, &["<frames", "<method"], &[]);
    for entry in entries.iter().filter(|entry| entry.is_synthesis()) {
        table.push(row(entry, |gpu| {
            let slots = average(entry.slots(gpu, |pass| pass.starts_with("gather ")));
            let [fetches, bytes] = ["fetches", "traffic"]
                .map(|what| average(entry.bytes(&format!("{SYNTHESIS_ALONE}{what}/{}", gpu.gpu))));
            let ms = gpu.milliseconds(slots, fetches, bytes);
            format!("{slots:.0}; {fetches:.1}; {bytes:.1}; {ms:.2} ms")
        }));
    }
    table
}

fn passes(entries: &[Entry]) -> Table {
    let title = "Pass by pass: fragments, slots and bytes for each pixel of an eye, means of the scenes";
    let mut table = table(title, &["<frames", "<method", "<pass", "fragments"], &["bytes"]);
    for entry in entries.iter().filter(|entry| entry.is_synthesis() || entry.method == TWO_RENDERS) {
        let metrics = entry.scenes().flat_map(|scene| &scene.frames).flat_map(|frame| frame.keys());
        let names = unique(metrics.filter_map(|metric| match metric.split_once('/')? {
            ("slots", rest) => Some(rest.split_once('/')?.1),
            ("bytes" | "fragments", pass) => Some(pass),
            _ => None,
        }));
        for (i, name) in names.into_iter().filter(|name| *name != VERTICES_ONCE).enumerate() {
            let shown = |prefix: &str, digits: usize| {
                let value = average(entry.sums(prefix, |pass| pass == name));
                Cell::ours((value > 0.0).then(|| format!("{value:.digits$}")))
            };
            let mut cells = vec![Cell::plain(entry.label), Cell::plain(entry.title()), Cell::plain(name)];
            cells.push(shown("fragments/", 2));
            cells.extend(GPUS.iter().map(|gpu| shown(&format!("slots/{}/", gpu.gpu), 1)));
            cells.push(shown(BYTES, 1));
            if i == 0 { table.push_first(cells) } else { table.push(cells) }
        }
    }
    let [width, height] = SIZE;
    table.note = format!("Eyes have {width} x {height} pixels.");
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Surfaces cost 300 slots, drawn twice or 1.1 times; the rest costs 100 per eye, and the synthesis 180.
    #[test]
    fn costs_are_equal_at_the_break_even() {
        let (surfaces, rest) = ([600.0, 330.0], [200.0, 380.0]);
        let slots = break_even(surfaces, rest).unwrap();
        assert!((slots - 200.0).abs() < 1e-9, "{slots}");
        let x = slots / 300.0;
        assert!((x * surfaces[0] + rest[0] - x * surfaces[1] - rest[1]).abs() < 1e-9);
        assert_eq!(break_even([600.0, 600.0], rest), None);
    }

    /// A view of 5 ms: two take 10, and one with a guard band and 4.5 ms of synthesis takes as long.
    #[test]
    fn a_view_at_the_limit_costs_as_much_by_synthesis() {
        let least = least_view(4.5, 1.1).unwrap();
        assert!((least - 5.0).abs() < 1e-12 && (2.0 * least - (1.1 * least + 4.5)).abs() < 1e-12, "{least}");
        assert_eq!(least_view(1.0, 2.0), None);
    }
}
