//! The fragment passes of the pipeline, in the order of their recording.

use std::ffi::CStr;

use ash::vk;

use super::barriers::Barriers;
use super::commands::Commands;
use super::objects::Objects;
use super::pipelines::{PipelineFactory, Pipelines};
use super::shaders::Shaders;
use super::targets::{Attachments, Intermediate, PassKind, Rendering};
use super::timer::{Stamp, Timer};
use super::{ImageState, Options, VulkanError};
use crate::synthesis::backend::{HoleMarks, WarpKind, map_sizes};

/// All passes.
pub(super) struct Passes {
    pub(super) rendering: Rendering,
    pub(super) tiles: TilesPass,
    pub(super) spans: SpansPass,
    pub(super) march: MarchPass,
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

/// Searches for each target pixel, and writes the target.
pub(super) struct MarchPass {
    pipelines: Pipelines,
}

impl Passes {
    /// Compiles the passes, and allocates their intermediate buffers for the largest sizes of the options.
    pub(super) fn new<W: WarpKind>(
        objects: &mut Objects,
        rendering: Rendering,
        layout: vk::PipelineLayout,
        memory: &vk::PhysicalDeviceMemoryProperties,
        options: &Options,
    ) -> Result<Passes, VulkanError> {
        // SAFETY: the shader modules of pipelines that are complete are not used by any command.
        let modules = unsafe { Objects::new(objects.device()) };
        let shaders = Shaders::of::<W>();
        let march_vertex = shaders.march_vertex;
        let mut factory =
            PipelineFactory { objects, modules, rendering: &rendering, layout, options, march_vertex };
        let tile_pipelines = factory.pipelines(shaders.tiles, PassKind::Map)?;
        let spans_pipeline = factory.pipeline(shaders.spans, PassKind::Map, false)?;
        let march = factory.pipelines(shaders.march(options)?, PassKind::Target)?;
        drop(factory);

        let mut map = |size| Intermediate::new(objects, &rendering, memory, size);
        let [tile_size, span_size] = map_sizes::<W>([options.max_source_size, options.max_target_size]);
        let (tile_map, span_map) = (map(tile_size)?, map(span_size)?);
        Ok(Passes {
            rendering,
            tiles: TilesPass { pipelines: tile_pipelines, map: tile_map },
            spans: SpansPass { pipeline: spans_pipeline, map: span_map },
            march: MarchPass { pipelines: march },
        })
    }

    pub(super) fn intermediates(&self) -> [&Intermediate; 2] {
        [&self.tiles.map, &self.spans.map]
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
            self.rendering.draw(&self.commands, &into.attachments, pipeline, area([0, 0], size), None);
            let mut barriers = Barriers::new();
            barriers.intermediate(into.image, ImageState::COLOR_ATTACHMENT, ImageState::SAMPLED);
            barriers.record(&self.commands);
        });
    }

    pub(super) fn stamp(&self, stamp: Stamp) {
        if let Some(timer) = self.timer {
            timer.stamp(&self.commands, stamp);
        }
    }
}

pub(super) fn area([x, y]: [u32; 2], [width, height]: [u32; 2]) -> vk::Rect2D {
    vk::Rect2D { offset: vk::Offset2D { x: x as i32, y: y as i32 }, extent: vk::Extent2D { width, height } }
}

impl TilesPass {
    /// `size` is the source's size in tiles.
    pub(super) fn record(&self, recorder: &Recorder, size: [u32; 2]) {
        recorder.intermediate(c"yoro tiles", self.pipelines.get(recorder.part), &self.map, size);
    }
}

impl SpansPass {
    /// `size` is the size of the span map.
    pub(super) fn record(&self, recorder: &Recorder, size: [u32; 2]) {
        recorder.intermediate(c"yoro spans", self.pipeline, &self.map, size);
    }
}

impl MarchPass {
    /// `area` is the target's rectangle in pixels.
    pub(super) fn record(
        &self,
        recorder: &Recorder,
        target: &Attachments,
        area: vk::Rect2D,
        marks: Option<HoleMarks>,
    ) {
        recorder.commands.group(c"yoro march", || {
            let pipeline = self.pipelines.get(recorder.part);
            recorder.rendering.draw(&recorder.commands, target, pipeline, area, marks);
        });
    }
}
