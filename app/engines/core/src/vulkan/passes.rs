//! The fragment passes of the pipeline, in the order of their recording.

use std::ffi::CStr;

use ash::vk;

use super::barriers::Barriers;
use super::commands::Commands;
use super::objects::Objects;
use super::pipelines::{PipelineFactory, Pipelines};
use super::shaders;
use super::targets::{Attachments, Intermediate, PassKind, Rendering};
use super::timer::{Stamp, Timer};
use super::{ImageState, Options, VulkanError};
use crate::synthesis::{Edges, PassSet, span_tiles, tiles};

/// All passes.
pub(super) struct Passes {
    pub(super) rendering: Rendering,
    /// `None` for hard edges.
    pub(super) split: Option<SplitPass>,
    pub(super) tiles: TilesPass,
    pub(super) spans: SpansPass,
    pub(super) march: MarchPass,
}

/// Finds the one or two surfaces that each source pixel shows.
pub(super) struct SplitPass {
    resolved: Pipelines,
    /// For sources with sample colours.
    samples: Option<Pipelines>,
    pub(super) layers: Intermediate,
}

/// Finds the bounds of the displacements in each tile of the source.
pub(super) struct TilesPass {
    pipelines: Pipelines,
    pub(super) map: Intermediate,
}

/// Finds the source columns to search for each tile of the target.
pub(super) struct SpansPass {
    pipeline: vk::Pipeline,
    pub(super) map: Intermediate,
}

/// Returns the kinds and sizes of the intermediate buffers that [`Passes::new`] creates.
pub(super) fn buffers(options: &Options, any_view: bool) -> impl Iterator<Item = (PassKind, [u32; 2])> {
    let layers = (options.edges != Edges::Hard).then_some((PassKind::Layers, options.max_source_size));
    let map = map_kind(options.edges);
    map_sizes(options, any_view).map(|size| (map, size)).into_iter().chain(layers)
}

/// Returns the kind of the tile map and the span map.
fn map_kind(edges: Edges) -> PassKind {
    if edges == Edges::Hard { PassKind::LawMap } else { PassKind::Map }
}

/// Returns the sizes of the tile map and the span map.
fn map_sizes(options: &Options, any_view: bool) -> [[u32; 2]; 2] {
    let [source, target] = [options.max_source_size, options.max_target_size];
    [tiles(source), span_tiles(any_view, source, target)]
}

/// Searches for each target pixel, and writes the target.
pub(super) struct MarchPass {
    pipelines: Pipelines,
}

impl Passes {
    /// Compiles the passes, and allocates their intermediate buffers for the largest sizes of the options.
    pub(super) fn new(
        objects: &mut Objects,
        rendering: Rendering,
        layout: vk::PipelineLayout,
        memory: &vk::PhysicalDeviceMemoryProperties,
        options: &Options,
        set: PassSet,
    ) -> Result<Passes, VulkanError> {
        // SAFETY: the shader modules of pipelines that are complete are not used by any command.
        let shaders = unsafe { Objects::new(objects.device()) };
        let march_vertex = shaders::march_vertex(set);
        let mut factory =
            PipelineFactory { objects, shaders, rendering: &rendering, layout, options, march_vertex };
        let edges = options.edges;
        let depth = options.depth_format.is_some();
        let map = map_kind(edges);
        let tile_pipelines = factory.pipelines(shaders::tiles(edges, set), map)?;
        let spans_pipeline = factory.pipeline(shaders::spans(edges, set), map, false)?;
        let march =
            factory.pipelines(shaders::march(edges, set, depth, options.history), PassKind::Target)?;
        let resolved =
            shaders::split(edges).map(|shader| factory.pipelines(shader, PassKind::Layers)).transpose()?;
        let samples = (edges == Edges::Multisample)
            .then(|| factory.pipelines(shaders::SPLIT_SAMPLES, PassKind::Layers))
            .transpose()?;
        drop(factory);

        let mut intermediate =
            |kind, size| Intermediate::new(objects, &rendering, memory, kind, options, size);
        let [tile_size, span_size] = map_sizes(options, set == PassSet::AnyView);
        let tile_map = intermediate(map, tile_size)?;
        let span_map = intermediate(map, span_size)?;
        let split = match resolved {
            Some(resolved) => {
                let layers = intermediate(PassKind::Layers, options.max_source_size)?;
                Some(SplitPass { resolved, samples, layers })
            }
            None => None,
        };
        Ok(Passes {
            rendering,
            split,
            tiles: TilesPass { pipelines: tile_pipelines, map: tile_map },
            spans: SpansPass { pipeline: spans_pipeline, map: span_map },
            march: MarchPass { pipelines: march },
        })
    }

    /// Returns the result of the first pass; `None` for hard edges.
    pub(super) fn layers(&self) -> Option<&Intermediate> {
        self.split.as_ref().map(|split| &split.layers)
    }

    pub(super) fn intermediates(&self) -> impl Iterator<Item = &Intermediate> {
        [self.layers(), Some(&self.tiles.map), Some(&self.spans.map)].into_iter().flatten()
    }
}

/// Records one frame's passes.
pub(super) struct Recorder<'a> {
    pub(super) commands: Commands<'a>,
    pub(super) rendering: &'a Rendering,
    pub(super) timer: Option<&'a Timer>,
    /// False if the source fills its images and the intermediate buffers.
    pub(super) part: bool,
}

impl Recorder<'_> {
    /// Records a pass whose result the next passes read.
    fn intermediate(&self, name: &CStr, pipeline: vk::Pipeline, into: &Intermediate, size: [u32; 2]) {
        self.commands.group(name, || {
            self.rendering.draw(&self.commands, &into.attachments, pipeline, area([0, 0], size));
            let mut barriers = Barriers::new();
            for &image in &into.images {
                barriers.intermediate(image, ImageState::COLOR_ATTACHMENT, ImageState::SAMPLED);
            }
            barriers.record(&self.commands);
        });
    }

    pub(super) fn stamp(&self, stamp: Stamp) {
        if let Some(timer) = self.timer {
            timer.stamp(&self.commands, stamp);
        }
    }
}

fn area([x, y]: [u32; 2], [width, height]: [u32; 2]) -> vk::Rect2D {
    vk::Rect2D { offset: vk::Offset2D { x: x as i32, y: y as i32 }, extent: vk::Extent2D { width, height } }
}

impl SplitPass {
    /// `size` is the source's size in pixels; `with_samples` is true for sources with sample colours.
    pub(super) fn record(&self, recorder: &Recorder, size: [u32; 2], with_samples: bool) {
        let pipelines = self.samples.filter(|_| with_samples).unwrap_or(self.resolved);
        recorder.intermediate(c"yoro split", pipelines.get(recorder.part), &self.layers, size);
    }
}

impl TilesPass {
    /// `size` is the source's size in tiles.
    pub(super) fn record(&self, recorder: &Recorder, size: [u32; 2]) {
        recorder.intermediate(c"yoro tiles", self.pipelines.get(recorder.part), &self.map, size);
    }
}

impl SpansPass {
    /// `size` is the size that [`span_tiles`] returns.
    pub(super) fn record(&self, recorder: &Recorder, size: [u32; 2]) {
        recorder.intermediate(c"yoro spans", self.pipeline, &self.map, size);
    }
}

impl MarchPass {
    /// `origin` and `size` are the target's rectangle in pixels.
    pub(super) fn record(&self, recorder: &Recorder, target: &Attachments, origin: [u32; 2], size: [u32; 2]) {
        recorder.commands.group(c"yoro march", || {
            let pipeline = self.pipelines.get(recorder.part);
            recorder.rendering.draw(&recorder.commands, target, pipeline, area(origin, size));
        });
    }
}
