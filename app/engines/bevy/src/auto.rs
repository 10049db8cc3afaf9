//! The choice of [`StereoMode::Auto`](crate::StereoMode::Auto): both ways are measured in use.

use std::sync::mpsc::{Receiver, Sender, channel};

use bevy::platform::cell::SyncCell;
use bevy::prelude::*;
use bevy::render::renderer::{
    PendingCommandBuffers, RenderDevice, RenderGraph, RenderGraphSystems, RenderQueue,
};
use bevy::render::{Extract, ExtractSchedule, RenderApp};
use yoro_wgpu::wgpu::{self, BufferUsages, Features};
use yoro_wgpu::yoro::choice::{Aim, Choice, Chooser, Cost, FrameEnd, StereoPath};

/// A frame's number, and the GPU's time for it in milliseconds.
type FrameTime = (u64, f32);

/// The choice of [`StereoMode::Auto`](crate::StereoMode::Auto): one for all cameras in this mode, since a frame's time is
/// that of all of them. [`StereoPath::Synthesis`] stands for [`StereoMode::Opaque`](crate::StereoMode::Opaque).
#[derive(Resource)]
pub struct AutoChoice {
    chooser: Chooser,
    logged: Option<StereoPath>,
    /// The number of the frame in preparation, and what is known of it if a camera counts.
    frame: u64,
    end: Option<FrameEnd>,
    /// From the render world.
    times: (Sender<FrameTime>, SyncCell<Receiver<FrameTime>>),
}

impl AutoChoice {
    /// Returns what chooses: its last choice, and whether it is measuring.
    pub fn chooser(&self) -> &Chooser {
        &self.chooser
    }

    /// Measures again: call it for another scene, or another place in it. Images of another size are noticed.
    pub fn scene_changed(&mut self) {
        self.chooser.scene_changed();
    }

    /// Counts a camera of the frame in preparation. Unless it can be synthesized, the frame counts for no way.
    pub(crate) fn count(&mut self, can_be_synthesized: bool, refresh_hz: f32) {
        let rendered = Some(self.chooser.path());
        let end = self.end.get_or_insert(FrameEnd { rendered, ..default() });
        end.rendered = end.rendered.filter(|_| can_be_synthesized);
        end.refresh_hz = end.refresh_hz.max(refresh_hz);
    }
}

pub(crate) fn build(app: &mut App) {
    let (sender, receiver) = channel();
    app.insert_resource(AutoChoice {
        chooser: Chooser::new(Aim::Cheapest, StereoPath::Synthesis),
        logged: None,
        frame: 0,
        end: None,
        times: (sender, SyncCell::new(receiver)),
    });
    app.add_systems(PreUpdate, end_frame);
    let Some(render) = app.get_sub_app_mut(RenderApp) else { return };
    render
        .add_systems(ExtractSchedule, |mut commands: Commands, auto: Extract<Res<AutoChoice>>| {
            commands.insert_resource(TimedFrame(auto.end.map(|_| (auto.frame, auto.times.0.clone()))));
        })
        .add_systems(
            RenderGraph,
            time_frame.after(RenderGraphSystems::Render).before(RenderGraphSystems::Submit),
        );
}

/// Counts the last frame, and logs a choice that is another one.
fn end_frame(mut auto: ResMut<AutoChoice>, time: Res<Time<Real>>) {
    let Some(end) = auto.end.take() else { return };
    let known = auto.times.1.get().try_recv().ok();
    let cost = known.map(|(frame, ms)| Cost { frames_ago: (auto.frame - frame) as u32, ms });
    auto.chooser.end_frame(&FrameEnd { now_ns: time.elapsed().as_nanos() as i64, cost, ..end });
    auto.frame += 1;
    let Choice { path, reason, costs_ms } = auto.chooser.choice();
    if !auto.chooser.is_measuring() && auto.logged.replace(path) != Some(path) {
        let mode = if path == StereoPath::TwoViews { "Rendered" } else { "Opaque" };
        let times: Vec<f32> = costs_ms.into_iter().flatten().collect();
        info!("StereoMode::Auto takes {mode}: {reason:?}, ms of Rendered and Opaque: {times:.2?}");
    }
}

/// The number of the frame that is rendered, and where its time is sent, if that is of interest.
#[derive(Resource)]
struct TimedFrame(Option<(u64, Sender<FrameTime>)>);

/// Measures the GPU's time for a frame, by the first and the last of its commands.
fn time_frame(
    mut frame: ResMut<TimedFrame>,
    mut stamps: Local<Option<(wgpu::QuerySet, wgpu::Buffer)>>,
    mut pending: ResMut<PendingCommandBuffers>,
    (device, queue): (Res<RenderDevice>, Res<RenderQueue>),
) {
    let needed = Features::TIMESTAMP_QUERY | Features::TIMESTAMP_QUERY_INSIDE_ENCODERS;
    // Bevy's own diagnostics have none on macOS either: pictures flicker with them.
    if !device.features().contains(needed) || cfg!(target_os = "macos") {
        return;
    }
    let Some((frame, times)) = frame.0.take() else { return };
    let device = device.wgpu_device();
    let buffer = |usage| {
        let label = Some("yoro frame time");
        device.create_buffer(&wgpu::BufferDescriptor { label, size: 16, usage, mapped_at_creation: false })
    };
    let (stamps, resolved) = stamps.get_or_insert_with(|| {
        let set = wgpu::QuerySetDescriptor { label: None, ty: wgpu::QueryType::Timestamp, count: 2 };
        (device.create_query_set(&set), buffer(BufferUsages::QUERY_RESOLVE | BufferUsages::COPY_SRC))
    });
    let read = buffer(BufferUsages::COPY_DST | BufferUsages::MAP_READ);
    let [mut begin, mut end] = [(); 2].map(|()| device.create_command_encoder(&default()));
    begin.write_timestamp(stamps, 0);
    end.write_timestamp(stamps, 1);
    end.resolve_query_set(stamps, 0..2, resolved, 0);
    end.copy_buffer_to_buffer(resolved, 0, &read, 0, 16);
    let (mapped, step_ms) = (read.clone(), queue.get_timestamp_period() * 1e-6);
    end.map_buffer_on_submit(&read, wgpu::MapMode::Read, .., move |result| {
        if result.is_ok()
            && let ([begin, end], _) = mapped.get_mapped_range(..).as_chunks()
        {
            let steps = u64::from_le_bytes(*end).wrapping_sub(u64::from_le_bytes(*begin));
            // While the application ends, no one receives it.
            times.send((frame, steps as f32 * step_ms)).ok();
        }
    });
    let commands = pending.take();
    pending.push([begin.finish()].into_iter().chain(commands).chain([end.finish()]));
}
