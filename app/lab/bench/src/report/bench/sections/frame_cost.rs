//! The cost of whole frames on mobile GPUs.

use super::section::Section;
use crate::report::bench::data::{CONVENTIONAL, Measured, SettingData, Suite};
use yoro_estimate::{self as estimate, Device, SYNTHESIS};
use yoro_report::grid::{Cell, Table};
use yoro_report::stats::{mean, unique};

/// The passes whose cost depends on the application's surfaces.
const SURFACES: [&str; 1] = ["surfaces"];

/// A contender, with bloom or without.
#[derive(Clone, Copy)]
struct Entry<'a> {
    suite: &'a Suite,
    /// With bloom or without.
    label: &'a str,
    name: &'a str,
    /// True if vertices are shaded once for both eyes.
    once: bool,
}

impl<'a> Entry<'a> {
    fn all(suite: &'a Suite) -> Vec<Entry<'a>> {
        let mut entries = Vec::new();
        for label in suite.labels() {
            let of_label = suite.settings.iter().filter(|s| s.conditions.label.as_deref() == Some(label));
            for name in unique(of_label.flat_map(|s| s.contenders.iter().map(|m| m.name.as_str()))) {
                let entry = Entry { suite, label, name, once: false };
                if name == estimate::MULTIVIEW {
                    entries.push(Entry { once: true, ..entry });
                }
                entries.push(entry);
            }
        }
        entries
    }

    fn title(&self) -> String {
        match (self.name, self.once) {
            (CONVENTIONAL, _) => "two renders".into(),
            (estimate::MULTIVIEW, true) => "multiview, vertices once".into(),
            (estimate::MULTIVIEW, false) => "multiview, vertices twice".into(),
            (name, _) => match name.strip_prefix("conventional-") {
                Some(level) => format!("two renders, {level} foveation"),
                None => name.into(),
            },
        }
    }

    fn is_synthesis(&self) -> bool {
        self.name.starts_with("yoro-")
    }

    fn settings(&self) -> impl Iterator<Item = &'a SettingData> {
        let label = self.label;
        self.suite.settings.iter().filter(move |s| s.conditions.label.as_deref() == Some(label))
    }

    /// Returns the value of each scene.
    fn by_scene(&self, value: impl Fn(&Measured) -> f64) -> Vec<f64> {
        self.settings().filter_map(|setting| Some(value(setting.find(self.name)?))).collect()
    }

    /// Returns two renders, with bloom or without as this one.
    fn baseline(&self) -> Entry<'a> {
        Entry { name: CONVENTIONAL, once: false, ..*self }
    }

    /// Returns the issue slots per pixel of an eye in each scene, for the passes for which `counts` is true.
    fn slots(&self, gpu: &str, counts: impl Fn(&str) -> bool) -> Vec<f64> {
        let left_out = if self.once { estimate::VERTICES } else { estimate::VERTICES_ONCE };
        self.sums(&format!("slots/{gpu}/"), |pass| pass != left_out && counts(pass))
    }

    /// Returns the bytes per pixel of an eye in each scene, under the assumption that `prefix` stands for.
    fn bytes(&self, prefix: &str) -> Vec<f64> {
        self.sums(prefix, |_| true)
    }

    /// Returns the values of each scene over those of two renders.
    fn over_two(&self, values: impl Fn(&Entry) -> Vec<f64>) -> Vec<f64> {
        values(self).iter().zip(values(&self.baseline())).map(|(own, base)| own / base).collect()
    }

    /// Returns the milliseconds that a GPU needs at least for the frame of each scene.
    fn times(&self, gpu: &Device) -> Vec<f64> {
        let (slots, bytes) = (self.slots(gpu.gpu, |_| true), self.bytes(estimate::BYTES));
        slots.into_iter().zip(bytes).map(|(slots, bytes)| milliseconds(gpu, slots, bytes)).collect()
    }

    /// Returns in each scene the sum of the metrics that start with `prefix` and for whose rest `counts` is true.
    fn sums(&self, prefix: &str, counts: impl Fn(&str) -> bool) -> Vec<f64> {
        self.by_scene(|measured| {
            let names = unique(measured.metrics()).into_iter();
            let counted = names.filter(|name| name.strip_prefix(prefix).is_some_and(&counts));
            counted.filter_map(|name| value(self.suite, measured, name)).sum()
        })
    }
}

/// Returns the mean of a pass's metric. Vertices are scaled to an eye of [`estimate::SIZE`], because their number does not
/// depend on the size of the frame.
fn value(suite: &Suite, measured: &Measured, metric: &str) -> Option<f64> {
    let scale = if metric.contains(estimate::VERTICES) {
        measured_pixels(suite) / pixels(estimate::SIZE)
    } else {
        1.0
    };
    Some(scale * measured.mean(metric)?)
}

fn pixels(size: [u32; 2]) -> f64 {
    f64::from(size[0]) * f64::from(size[1])
}

/// Returns the number of pixels of a measured eye, from `512 x 512` in the header.
fn measured_pixels(suite: &Suite) -> f64 {
    let size = suite.header.parameters.iter().find(|parameter| parameter.name == "size of each eye, pixels");
    let parts =
        size.map(|size| size.value.split(" x ").filter_map(|n| n.parse::<f64>().ok()).product::<f64>());
    parts.unwrap_or(pixels(estimate::SIZE))
}

/// Returns the time of a frame with these slots and bytes for each pixel of an eye: that of the slots alone or of the bytes
/// alone, whichever is longer.
fn milliseconds(gpu: &Device, slots: f64, bytes: f64) -> f64 {
    1e3 * pixels(gpu.size) * (slots / gpu.slots).max(bytes / gpu.bytes)
}

fn average(values: &[f64]) -> f64 {
    mean(values.iter().copied()).unwrap_or(f64::NAN)
}

/// Returns the cost of surfaces, in slots per pixel of one eye, above which a method is cheaper than two renders.
///
/// If surfaces cost `x` times those of the scenes, two renders cost `x * surfaces[0] + rest[0]` and the method `x *
/// surfaces[1] + rest[1]`. `None` if the method is never cheaper.
fn break_even(surfaces: [f64; 2], rest: [f64; 2]) -> Option<f64> {
    let saved = surfaces[0] - surfaces[1];
    (saved > 0.0).then(|| 0.5 * surfaces[0] * (rest[1] - rest[0]) / saved)
}

/// Returns the section of `shader-cost --frame`.
pub fn section(suite: &Suite) -> Section {
    let mut section = Section::new(
        "frame-cost",
        "Whole frames on mobile GPUs",
        "An estimate: nothing here was timed on a GPU. Frames are rendered here; the samples that pass each depth test are \
         counted, shaders are sized by Mesa's compilers for these GPUs, and the loops of lamps and of the synthesis are counted \
         by waves. Bytes are those that a tile-based GPU moves between tiles and memory.",
    );
    let entries = Entry::all(suite);
    for entry in entries.iter().filter(|entry| entry.is_synthesis()) {
        section.table(by_scene(entry));
        section.table(times(entry));
    }
    section.table(ratios(&entries));
    section.table(worth(&entries));
    section.table(break_evens(&entries));
    section.table(passes(&entries));
    section
}

fn gpu_columns<'a>(first: &[&'a str]) -> Vec<&'a str> {
    first.iter().copied().chain(estimate::GPUS.iter().map(|gpu| gpu.name)).collect()
}

/// Returns the bytes and slots of synthesis over those of two renders, scene by scene.
fn by_scene(entry: &Entry) -> Table {
    let first =
        ["<scene", "<glass", "two renders", "yoro", "bytes", "bytes, 16-bit depth", "bytes, blits in memory"];
    let title = format!(
        "{} with {}: bytes a pixel of an eye, bytes and slots over two renders",
        entry.title(),
        entry.label
    );
    let mut table = Table::new(&title, &gpu_columns(&first));
    let (own, base) = (entry.bytes(estimate::BYTES), entry.baseline().bytes(estimate::BYTES));
    let mut ratios: Vec<Vec<f64>> = [estimate::BYTES, estimate::BYTES_16, estimate::BYTES_BLIT]
        .map(|prefix| entry.over_two(|entry| entry.bytes(prefix)))
        .to_vec();
    ratios.extend(estimate::GPUS.map(|gpu| entry.over_two(|entry| entry.slots(gpu.gpu, |_| true))));
    let cells = |name: &str, glass: &str, bytes: [f64; 2], ratios: Vec<f64>| {
        let mut cells = vec![Cell::plain(name), Cell::plain(glass)];
        cells.push(Cell::base(Some(format!("{:.1}", bytes[0]))));
        cells.push(Cell::ours(Some(format!("{:.1}", bytes[1]))));
        cells.extend(ratios.iter().map(|ratio| Cell::ours(Some(format!("{ratio:.2}")))));
        cells
    };
    let measured = entry.settings().filter_map(|setting| Some((setting, setting.find(entry.name)?)));
    for (i, (setting, measured)) in measured.enumerate() {
        let glass = if measured.mean("fragments/transparent").is_some() { "in view" } else { "" };
        let of_scene = ratios.iter().map(|ratios| ratios[i]).collect();
        table.push(cells(&setting.conditions.scene, glass, [base[i], own[i]], of_scene));
    }
    let means = ratios.iter().map(|ratios| average(ratios)).collect();
    table.push_grouped(cells("mean", "", [average(&base), average(&own)], means), true);
    table.note = "16-bit depth is simulated: carried depth is counted with 2 bytes, as a Vulkan host resolves it. With blits in memory, glBlitFramebuffer writes and reads all samples.".into();
    table
}

/// Returns the times of synthesis over those of two renders, scene by scene.
fn times(entry: &Entry) -> Table {
    let title = format!(
        "{} with {}: time over two renders. `auto` chooses synthesis where it is below 1",
        entry.title(),
        entry.label
    );
    let mut table = Table::new(&title, &gpu_columns(&["<scene"]));
    let ratios = estimate::GPUS.map(|gpu| entry.over_two(|entry| entry.times(&gpu)));
    let cells = |name: &str, ratios: Vec<f64>| {
        let ratios = ratios.into_iter().map(|ratio| Cell::ours(Some(format!("{ratio:.2}"))));
        [Cell::plain(name)].into_iter().chain(ratios).collect::<Vec<_>>()
    };
    for (i, setting) in entry.settings().filter(|setting| setting.find(entry.name).is_some()).enumerate() {
        table.push(cells(&setting.conditions.scene, ratios.iter().map(|ratios| ratios[i]).collect()));
    }
    table.push_grouped(cells("mean", ratios.iter().map(|ratios| average(ratios)).collect()), true);
    table.note =
        "A frame takes as long as its slots or its bytes, whichever take longer at the GPU's rates.".into();
    table
}

fn ratios(entries: &[Entry]) -> Table {
    let mut columns = gpu_columns(&["<frames", "<method"]);
    columns.extend(["bytes a pixel", "bytes, ratio", "bytes, 16-bit depth", "bytes, blits in memory"]);
    let mut table =
        Table::new("Executed slots over two renders: mean of the scenes, least and most", &columns);
    for (i, entry) in entries.iter().enumerate() {
        let mut cells = vec![Cell::plain(entry.label), Cell::plain(entry.title())];
        for gpu in estimate::GPUS {
            cells.push(if entry.name == CONVENTIONAL {
                Cell::base(Some(format!("{:.0} slots", average(&entry.slots(gpu.gpu, |_| true)))))
            } else {
                Cell::ours(Some(spread(&entry.over_two(|entry| entry.slots(gpu.gpu, |_| true)))))
            });
        }
        cells.push(Cell::ours(Some(format!("{:.0}", average(&entry.bytes(estimate::BYTES))))));
        for prefix in [estimate::BYTES, estimate::BYTES_16, estimate::BYTES_BLIT] {
            cells.push(Cell::ours(Some(spread(&entry.over_two(|entry| entry.bytes(prefix))))));
        }
        table.push_grouped(cells, i > 0 && entries[i - 1].label != entry.label);
    }
    table
}

/// Formats a mean with the smallest and the largest value.
fn spread(values: &[f64]) -> String {
    let (low, high) = values.iter().fold((f64::INFINITY, 0f64), |(low, high), v| (low.min(*v), high.max(*v)));
    format!("{:.2} ({low:.2}–{high:.2})", average(values))
}

/// Returns the cost of a view above which synthesis is worth it.
fn worth(entries: &[Entry]) -> Table {
    let title = "Synthesis is worth it when a view costs the GPU more than this, in ms";
    let mut table = Table::new(title, &gpu_columns(&["<frames", "<method"]));
    for entry in entries.iter().filter(|entry| entry.is_synthesis()) {
        let both = [entry.baseline(), *entry];
        let [two, wide] =
            both.map(|entry| average(&entry.sums("fragments/", |pass| SURFACES.contains(&pass))));
        let mut cells = vec![Cell::plain(entry.label), Cell::plain(entry.title())];
        for gpu in estimate::GPUS {
            let slots = both.map(|entry| average(&entry.slots(gpu.gpu, |_| true)));
            let bytes = both.map(|entry| average(&entry.bytes(estimate::BYTES)));
            let [slots, bytes] = [slots, bytes].map(|[two_views, own]| own - wide / two * two_views);
            let limit = least_view(milliseconds(&gpu, slots, bytes), 2.0 * wide / two);
            cells.push(Cell::ours(Some(limit.map_or("never".into(), |limit| format!("{limit:.1}")))));
        }
        table.push(cells);
    }
    let sizes = estimate::GPUS.map(|gpu| {
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
    let mut table = Table::new(title, &gpu_columns(&["<frames", "<method"]));
    for entry in entries.iter().filter(|entry| entry.is_synthesis()) {
        let mut cells = vec![Cell::plain(entry.label), Cell::plain(entry.title())];
        for gpu in estimate::GPUS {
            let both = [entry.baseline(), *entry];
            let surfaces = both.map(|entry| average(&entry.slots(gpu.gpu, |pass| SURFACES.contains(&pass))));
            let rest = both.map(|entry| average(&entry.slots(gpu.gpu, |pass| !SURFACES.contains(&pass))));
            let here = 0.5 * surfaces[0];
            let text = match break_even(surfaces, rest) {
                Some(slots) if slots > 0.0 => format!("{slots:.0}; {here:.0}"),
                Some(_) => format!("0; {here:.0}"),
                None => format!("never; {here:.0}"),
            };
            cells.push(Cell::ours(Some(text)));
        }
        table.push(cells);
    }
    table
}

fn passes(entries: &[Entry]) -> Table {
    let mut columns = gpu_columns(&["<frames", "<method", "<pass", "fragments"]);
    columns.push("bytes");
    let title = "Pass by pass: fragments, slots and bytes for each pixel of an eye, means of the scenes";
    let mut table = Table::new(title, &columns);
    for entry in entries.iter().filter(|entry| entry.is_synthesis() || entry.name == CONVENTIONAL) {
        let measured = entry.settings().filter_map(|setting| setting.find(entry.name));
        let names = unique(measured.flat_map(Measured::metrics).filter_map(|metric| {
            let (kind, rest) = metric.split_once('/')?;
            match kind {
                "slots" => Some(rest.split_once('/')?.1),
                "bytes" | "fragments" => Some(rest),
                _ => None,
            }
        }));
        for (i, name) in names.into_iter().filter(|name| *name != estimate::VERTICES_ONCE).enumerate() {
            let mean = |metric: String| {
                let of = |measured: &Measured| value(entry.suite, measured, &metric).unwrap_or(0.0);
                average(&entry.by_scene(of))
            };
            let shown =
                |value: f64, digits: usize| Cell::ours((value > 0.0).then(|| format!("{value:.digits$}")));
            let mut cells = vec![Cell::plain(entry.label), Cell::plain(entry.title()), Cell::plain(name)];
            cells.push(shown(mean(format!("fragments/{name}")), 2));
            let slots = estimate::GPUS.map(|gpu| shown(mean(format!("slots/{}/{name}", gpu.gpu)), 1));
            cells.extend(slots);
            cells.push(shown(mean(format!("bytes/{name}")), 1));
            table.push_grouped(cells, i == 0);
        }
    }
    let [width, height] = estimate::SIZE;
    table.note = format!(
        "Passes of the synthesis begin with {}. Vertices do not depend on the size: the figures are for eyes of {width} x {height} pixels.",
        SYNTHESIS.trim_end()
    );
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
