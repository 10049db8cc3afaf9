//! One session: from xrCreateInstance to the last frame.

mod eyes;
mod frame;

use std::rc::Rc;
use std::time::Instant;

use glam::Quat;
use openxr as xr;
use xr::sys;

use self::eyes::to_pose;
use self::frame::Layers;
use super::error::{XrError, call, check, optional};
use super::graphics::{self, Graphics, make_current};
use super::images::{EyeImages, Images, Kind};
use super::input::Input;
use super::mask::Mask;
use super::runtime::Runtime;
use super::storage::{self, Storage};
use crate::eyes::{Eye, EyePair, EyesError};
use crate::gl::Context;
use crate::render::DepthCopy;
use crate::viewer::{
    Action, Event, FrameReport, FrameTiming, Panel, Performance, Settings, Viewer, ViewerError,
};

/// More events than this in one frame are a runtime gone mad.
const MAX_EVENTS: usize = 64;
/// The images of the eyes are multiples of this many pixels, where they are scaled.
const SIZE_STEP: f32 = 16.0;
/// What a session should be like, besides the viewer's settings.
#[derive(Clone, Copy, Debug, Default)]
pub struct Options {
    /// One view in place of two: to find mistakes with.
    pub mono: bool,
    /// The activity.
    #[cfg(target_os = "android")]
    pub android: Option<super::Android>,
}

/// What runtime, system and session are like.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub struct Description {
    /// The runtime's name and version.
    pub runtime: String,
    /// The system's name.
    pub system: String,
    /// `stereo` or `mono`.
    pub views: String,
    /// The size in pixels that the runtime recommends for each eye.
    pub recommended: [u32; 2],
    /// The size in pixels of the images.
    pub size: [u32; 2],
    /// Format of the images.
    pub format: String,
    /// Whether both eyes are layers of one swapchain.
    pub array: bool,
    /// Whether eyes are drawn straight into the runtime's images.
    pub direct: bool,
    /// Format of the depth that is submitted, if any.
    pub depth: Option<String>,
    /// Whether the lenses hide a part of the images.
    pub mask: bool,
    /// Refresh rates that the display offers, in Hz, where the runtime says.
    pub refresh_rates: Vec<f32>,
    /// Whether controllers are used.
    pub input: bool,
}

/// A frame of both eyes as the runtime gets it.
#[derive(Clone, Debug)]
pub struct Capture {
    /// RGBA, rows from the bottom.
    pub eyes: [Vec<u8>; 2],
    /// The eyes in the scene.
    pub pair: EyePair,
}

/// A frame that was handed to the runtime.
#[derive(Clone, Debug)]
pub struct Frame {
    /// What the viewer says of it; none for a frame without images, which the runtime asks for while nobody looks.
    pub report: Option<FrameReport>,
    /// Time that this program's thread worked on it, in milliseconds; waiting for the runtime does not count.
    pub cpu_ms: f64,
    /// Its images, if they were asked for.
    pub capture: Option<Box<Capture>>,
}

/// What a call of [`Session::step`] has led to.
pub(super) enum Progress {
    Idle,
    Frame(Frame),
    Ended,
}

/// The HUD's own images.
struct PanelImages {
    images: Images,
    /// What they show: [`Panel::version`].
    version: Option<u64>,
}

/// Depth of both eyes.
struct Depth {
    copy: DepthCopy,
    images: EyeImages,
    format: u32,
}

/// A session with everything that belongs to it. What has framebuffers goes before the images, and those before the
/// session.
pub(super) struct Session {
    storage: Storage,
    mask: Option<Mask>,
    depth: Option<Depth>,
    eyes: EyeImages,
    panel: Option<PanelImages>,
    input: Option<Input>,
    /// The head.
    head: xr::Space,
    /// Where the runtime says that straight ahead is.
    base: xr::Space,
    /// Where the user says so.
    space: xr::Space,
    waiter: xr::FrameWaiter,
    stream: xr::FrameStream<xr::OpenGlEs>,
    session: xr::Session<xr::OpenGlEs>,
    instance: xr::Instance,

    gl: Rc<Context>,
    views: xr::ViewConfigurationType,
    blend: xr::EnvironmentBlendMode,
    state: xr::SessionState,
    is_running: bool,
    /// What was asked of the runtime by extensions.
    applied: Option<(Option<f32>, Performance)>,
    /// Why the eyes are rendered otherwise than the runtime has them.
    realigned: Option<EyesError>,
    recenter: bool,
    events: Vec<Event>,
    last_error: String,
    description: Description,
}

impl Session {
    /// Begins a session with a runtime.
    pub fn open(
        runtime: &Runtime,
        graphics: &dyn Graphics,
        gl: &Rc<Context>,
        settings: &Settings,
        options: &Options,
    ) -> Result<Session, XrError> {
        make_current(graphics)?;
        let instance = create_instance(runtime, options)?;
        let properties = call("xrGetInstanceProperties", instance.properties())?;
        let system = call("xrGetSystem", instance.system(xr::FormFactor::HEAD_MOUNTED_DISPLAY))?;
        let system_properties = call("xrGetSystemProperties", instance.system_properties(system))?;
        let configurations =
            call("xrEnumerateViewConfigurations", instance.enumerate_view_configurations(system))?;
        let wanted = match options.mono {
            true => [xr::ViewConfigurationType::PRIMARY_MONO, xr::ViewConfigurationType::PRIMARY_STEREO],
            false => [xr::ViewConfigurationType::PRIMARY_STEREO, xr::ViewConfigurationType::PRIMARY_MONO],
        };
        let views = wanted
            .into_iter()
            .find(|views| configurations.contains(views))
            .ok_or_else(|| XrError::Nonsense("offers neither one view nor two".into()))?;
        let view_sizes = call(
            "xrEnumerateViewConfigurationViews",
            instance.enumerate_view_configuration_views(system, views),
        )?;
        let recommended = view_sizes.iter().fold([0, 0], |size, view| {
            [size[0].max(view.recommended_image_rect_width), size[1].max(view.recommended_image_rect_height)]
        });
        let most = view_sizes.iter().fold([u32::MAX; 2], |size, view| {
            [size[0].min(view.max_image_rect_width), size[1].min(view.max_image_rect_height)]
        });
        if recommended.contains(&0) || most.contains(&0) {
            return Err(XrError::Nonsense("recommends images without pixels".into()));
        }
        let limit = most.map(|n| n.min(gl.capabilities().max_texture_size / 2));
        let size = image_size(recommended, settings.render_scale, limit);
        let blends = call(
            "xrEnumerateEnvironmentBlendModes",
            instance.enumerate_environment_blend_modes(system, views),
        )?;
        let opaque = xr::EnvironmentBlendMode::OPAQUE;
        let blend = match blends.first() {
            Some(first) if !blends.contains(&opaque) => *first,
            _ => opaque,
        };

        graphics::check_version(&instance, system, gl.capabilities().version)?;
        let (session, waiter, stream) = graphics::create_session(&instance, system, graphics)?;
        let formats = call("xrEnumerateSwapchainFormats", session.enumerate_swapchain_formats())?;
        let format = storage::choose(&storage::COLOR_FORMATS, &formats).ok_or_else(|| {
            XrError::Nonsense("offers no format of images that OpenGL ES can draw to".into())
        })?;
        let color = Kind { format, is_depth: false, size, layers: 2 };
        let eyes = EyeImages::new(graphics, gl, &session, color)?;
        let depth = match instance.exts().khr_composition_layer_depth {
            Some(_) => optional("no depth is submitted", make_depth(graphics, gl, &session, &formats, size))?
                .flatten(),
            None => None,
        };
        let panel = Images::new(graphics, gl, &session, Kind { size: Panel::MAX_SIZE, layers: 1, ..color });
        let panel = optional("there is no HUD", panel)?.map(|images| PanelImages { images, version: None });
        let mut mask = None;
        if instance.exts().khr_visibility_mask.is_some() {
            let mut made = Mask::new(gl)?;
            let count = if views == xr::ViewConfigurationType::PRIMARY_STEREO { 2 } else { 1 };
            for eye in Eye::BOTH.into_iter().take(count) {
                optional("nothing is masked", made.update(&session, views, eye))?;
            }
            mask = Some(made);
        }
        let reference =
            |kind| call("xrCreateReferenceSpace", session.create_reference_space(kind, xr::Posef::IDENTITY));
        let local = xr::ReferenceSpaceType::LOCAL;
        let (head, base, space) =
            (reference(xr::ReferenceSpaceType::VIEW)?, reference(local)?, reference(local)?);
        let input = optional("controllers are not used", Input::new(&instance, &session))?;
        let refresh_rates = match instance.exts().fb_display_refresh_rate {
            Some(_) => optional(
                "refresh rates are not known",
                call("xrEnumerateDisplayRefreshRatesFB", session.enumerate_display_refresh_rates()),
            )?
            .unwrap_or_default(),
            None => Vec::new(),
        };
        make_current(graphics)?;
        let storage = Storage::new(gl, format)?;
        let stereo = views == xr::ViewConfigurationType::PRIMARY_STEREO;
        let description = Description {
            runtime: format!("{} {}", properties.runtime_name, properties.runtime_version),
            system: system_properties.system_name,
            views: if stereo { "stereo" } else { "mono" }.into(),
            recommended,
            size,
            format: storage::format_name(format),
            array: eyes.is_array(),
            direct: storage.is_direct(),
            depth: depth.as_ref().map(|depth| storage::format_name(depth.format)),
            mask: mask.as_ref().is_some_and(Mask::hides),
            refresh_rates,
            input: input.is_some(),
        };
        log_description(&description);
        Ok(Session {
            eyes,
            depth,
            panel,
            storage,
            mask,
            input,
            head,
            base,
            space,
            waiter,
            stream,
            session,
            instance,
            gl: gl.clone(),
            views,
            blend,
            state: xr::SessionState::UNKNOWN,
            is_running: false,
            applied: None,
            realigned: None,
            recenter: false,
            events: Vec::with_capacity(8),
            last_error: String::new(),
            description,
        })
    }

    pub fn description(&self) -> &Description {
        &self.description
    }

    /// Whether the runtime wants frames.
    pub fn is_running(&self) -> bool {
        self.is_running
    }

    /// Does what the user wants in the next frame.
    pub fn event(&mut self, event: Event) {
        self.events.push(event);
    }

    /// Asks the runtime to end the session.
    pub fn request_exit(&self) -> Result<(), XrError> {
        call("xrRequestExitSession", self.session.request_exit())
    }

    /// Takes the runtime's events, and makes a frame if it wants one. New states go to `states`.
    pub fn step(
        &mut self,
        graphics: &dyn Graphics,
        viewer: &mut Viewer,
        states: &mut dyn FnMut(xr::SessionState),
        capture: bool,
    ) -> Result<Progress, XrError> {
        if self.poll_events(viewer, states)? {
            return Ok(Progress::Ended);
        }
        if !self.is_running {
            self.events.clear();
            return Ok(Progress::Idle);
        }
        self.apply_settings(viewer.settings())?;
        let wait = call("xrWaitFrame", self.waiter.wait())?;
        let begin = Instant::now();
        let (time, period) = (wait.predicted_display_time, wait.predicted_display_period.as_nanos());
        let begun = self.stream.begin();
        make_current(graphics)?;
        call("xrBeginFrame", begun)?;
        let timing = FrameTiming {
            now_ns: time.as_nanos(),
            expected_display_ns: time.as_nanos(),
            refresh_hz: if period > 0 { (1e9 / period as f64) as f32 } else { 0.0 },
        };
        self.poll_input(viewer, time)?;
        viewer.begin(&timing);
        let mut layers = Layers { eyes: None, panel: None };
        let mut captured = None;
        if wait.should_render {
            layers = self.render(graphics, viewer, time, capture, &mut captured)?;
        }
        let ended = self.end_frame(time, &layers);
        make_current(graphics)?;
        ended?;
        let cpu_ms = begin.elapsed().as_secs_f64() * 1e3;
        let report = match layers.eyes {
            Some(_) => self.told(viewer.end(&timing)),
            None => None,
        };
        Ok(Progress::Frame(Frame { report, cpu_ms, capture: captured.map(Box::new) }))
    }

    /// What a viewer's call has led to; an error that comes with every frame is said once.
    fn told<T>(&mut self, result: Result<T, ViewerError>) -> Option<T> {
        match result {
            Ok(value) => Some(value),
            Err(error) => {
                let sentence = error.to_string();
                if sentence != self.last_error {
                    log::error!("{sentence}");
                    self.last_error = sentence;
                }
                None
            }
        }
    }

    /// True when the session is over for good.
    fn poll_events(
        &mut self,
        viewer: &mut Viewer,
        states: &mut dyn FnMut(xr::SessionState),
    ) -> Result<bool, XrError> {
        for _ in 0..MAX_EVENTS {
            let mut buffer = std::mem::MaybeUninit::<sys::EventDataBuffer>::uninit();
            // SAFETY: type and next are all that the runtime reads; the event is looked at only after success, when
            // the runtime has written it.
            let event = unsafe {
                let head = buffer.as_mut_ptr().cast::<sys::BaseInStructure>();
                head.write(sys::BaseInStructure { ty: sys::EventDataBuffer::TYPE, next: std::ptr::null() });
                let result = (self.instance.fp().poll_event)(self.instance.as_raw(), buffer.as_mut_ptr());
                if check("xrPollEvent", result)? == sys::Result::EVENT_UNAVAILABLE {
                    return Ok(false);
                }
                xr::Event::from_raw(&buffer)
            };
            match event {
                Some(xr::Event::SessionStateChanged(change)) if change.session() == self.session.as_raw() => {
                    states(change.state());
                    if self.change_state(change.state(), viewer)? {
                        return Ok(true);
                    }
                }
                Some(xr::Event::InstanceLossPending(_)) => return Err(XrError::Lost),
                Some(xr::Event::ReferenceSpaceChangePending(change))
                    if change.session() == self.session.as_raw()
                        && change.reference_space_type() == xr::ReferenceSpaceType::LOCAL =>
                {
                    log::info!("recentered by the system");
                    self.set_space(xr::Posef::IDENTITY)?;
                }
                Some(xr::Event::VisibilityMaskChangedKHR(change)) => {
                    if let Some(mask) = &mut self.mask {
                        let eye = Eye::BOTH.get(change.view_index() as usize).copied();
                        if let Some(eye) = eye {
                            optional("the mask stays", mask.update(&self.session, self.views, eye))?;
                        }
                    }
                }
                Some(xr::Event::DisplayRefreshRateChangedFB(change)) => {
                    log::info!("refresh rate: {} Hz", change.to_display_refresh_rate());
                }
                Some(xr::Event::PerfSettingsEXT(change)) => {
                    log::info!(
                        "the runtime's level of {:?} performance ({:?}): {:?}, before {:?}",
                        change.domain(),
                        change.sub_domain(),
                        change.to_level(),
                        change.from_level()
                    );
                }
                Some(xr::Event::EventsLost(lost)) => {
                    log::warn!("{} events of the runtime were lost", lost.lost_event_count());
                }
                _ => {}
            }
        }
        Ok(false)
    }

    /// True when the session is over for good.
    fn change_state(&mut self, state: xr::SessionState, viewer: &mut Viewer) -> Result<bool, XrError> {
        log::info!("OpenXR session: {state:?}");
        let is_visible = |state| matches!(state, xr::SessionState::VISIBLE | xr::SessionState::FOCUSED);
        match (is_visible(self.state), is_visible(state)) {
            (false, true) => viewer.resume(),
            (true, false) => viewer.pause(),
            _ => {}
        }
        if state != xr::SessionState::FOCUSED
            && let Some(input) = &mut self.input
        {
            input.forget();
        }
        self.state = state;
        match state {
            xr::SessionState::READY if !self.is_running => {
                call("xrBeginSession", self.session.begin(self.views))?;
                self.is_running = true;
            }
            xr::SessionState::STOPPING if self.is_running => {
                self.is_running = false;
                call("xrEndSession", self.session.end())?;
            }
            xr::SessionState::LOSS_PENDING => return Err(XrError::Lost),
            xr::SessionState::EXITING => return Ok(true),
            _ => {}
        }
        Ok(false)
    }

    /// Reads the controllers and does what the user wants.
    fn poll_input(&mut self, viewer: &mut Viewer, time: xr::Time) -> Result<(), XrError> {
        if self.state == xr::SessionState::FOCUSED
            && let Some(input) = &mut self.input
        {
            let polled = input.poll(&self.session, time.as_nanos(), &mut self.events);
            if optional("controllers are not used any more", polled)?.is_none() {
                self.input = None;
            }
        }
        let mut events = std::mem::take(&mut self.events);
        for event in events.drain(..) {
            match viewer.event(event) {
                Ok(Action::Nothing) => {}
                Ok(action) => {
                    log::info!("{action}");
                    self.recenter |= action == Action::Recenter;
                }
                Err(error) => log::error!("{error}"),
            }
        }
        self.events = events;
        if std::mem::take(&mut self.recenter) {
            let place = call("xrLocateSpace", self.head.locate(&self.base, time))?;
            let flags = xr::SpaceLocationFlags::POSITION_VALID | xr::SpaceLocationFlags::ORIENTATION_VALID;
            if place.location_flags.contains(flags) {
                let ahead = to_pose(&place.pose).forward();
                let heading = Quat::from_rotation_y((-ahead.x).atan2(-ahead.z));
                let q = xr::Quaternionf { x: heading.x, y: heading.y, z: heading.z, w: heading.w };
                self.set_space(xr::Posef { orientation: q, position: place.pose.position })?;
            }
        }
        Ok(())
    }

    /// Says where straight ahead is, as seen from where the runtime says so.
    fn set_space(&mut self, pose: xr::Posef) -> Result<(), XrError> {
        let space = self.session.create_reference_space(xr::ReferenceSpaceType::LOCAL, pose);
        self.space = call("xrCreateReferenceSpace", space)?;
        Ok(())
    }

    /// Asks for the refresh rate and the performance of the settings, when they have changed.
    fn apply_settings(&mut self, settings: &Settings) -> Result<(), XrError> {
        let wanted = (settings.refresh_rate, settings.performance);
        let before = self.applied.replace(wanted);
        if before == Some(wanted) {
            return Ok(());
        }
        let rates = &self.description.refresh_rates;
        if let Some(hz) = settings.refresh_rate
            && before.map(|(rate, _)| rate) != Some(settings.refresh_rate)
        {
            let nearest = rates.iter().copied().min_by(|a, b| (a - hz).abs().total_cmp(&(b - hz).abs()));
            match nearest {
                Some(rate) => {
                    let asked = self.session.request_display_refresh_rate(rate);
                    let asked = call("xrRequestDisplayRefreshRateFB", asked);
                    if optional("the refresh rate stays", asked)?.is_some() {
                        log::info!("refresh rate asked for: {rate} Hz");
                    }
                }
                None => log::warn!("the runtime does not let the refresh rate be chosen: it stays"),
            }
        }
        if let Some(extension) = &self.instance.exts().ext_performance_settings
            && before.map(|(_, level)| level) != Some(settings.performance)
        {
            let level = match settings.performance {
                Performance::PowerSaving => xr::PerfSettingsLevelEXT::POWER_SAVINGS,
                Performance::SustainedLow => xr::PerfSettingsLevelEXT::SUSTAINED_LOW,
                Performance::SustainedHigh => xr::PerfSettingsLevelEXT::SUSTAINED_HIGH,
                Performance::Boost => xr::PerfSettingsLevelEXT::BOOST,
            };
            for domain in [xr::PerfSettingsDomainEXT::CPU, xr::PerfSettingsDomainEXT::GPU] {
                // SAFETY: a live session and valid enums.
                let result = unsafe {
                    (extension.perf_settings_set_performance_level)(self.session.as_raw(), domain, level)
                };
                let asked = check("xrPerfSettingsSetPerformanceLevelEXT", result);
                optional("the performance level stays", asked)?;
            }
            log::info!("performance level: {level:?}");
        }
        Ok(())
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        // Whether the context is still current after a swapchain is destroyed is up to the runtime.
        self.eyes.close();
        if let Some(depth) = &mut self.depth {
            depth.images.close();
        }
        if let Some(panel) = &mut self.panel {
            panel.images.close();
        }
    }
}

/// An instance with the extensions that are of use.
fn create_instance(runtime: &Runtime, options: &Options) -> Result<xr::Instance, XrError> {
    let entry = call("xrGetInstanceProcAddr", runtime.entry())?;
    let offered = call("xrEnumerateInstanceExtensionProperties", entry.enumerate_extensions())?;
    let mut enabled = xr::ExtensionSet::default();
    if !offered.khr_opengl_es_enable {
        return Err(XrError::Extension { extension: "XR_KHR_opengl_es_enable" });
    }
    enabled.khr_opengl_es_enable = true;
    #[cfg(target_os = "android")]
    {
        enabled.khr_android_create_instance = true;
    }
    #[cfg(not(target_os = "android"))]
    {
        if !offered.mndx_egl_enable {
            return Err(XrError::Extension { extension: "XR_MNDX_egl_enable" });
        }
        enabled.mndx_egl_enable = true;
    }
    enabled.khr_composition_layer_depth = offered.khr_composition_layer_depth;
    enabled.khr_visibility_mask = offered.khr_visibility_mask;
    enabled.fb_display_refresh_rate = offered.fb_display_refresh_rate;
    enabled.ext_performance_settings = offered.ext_performance_settings;
    let application = xr::ApplicationInfo {
        application_name: "yoro",
        application_version: 1,
        engine_name: "yoro",
        engine_version: 1,
        api_version: xr::Version::new(1, 0, 0),
    };
    #[cfg(target_os = "android")]
    let created = match options.android {
        Some(android) => entry.create_instance(&application, &enabled, &[], &android.platform()),
        None => entry.create_instance(&application, &enabled, &[], &()),
    };
    #[cfg(not(target_os = "android"))]
    let created = {
        let _ = options;
        entry.create_instance(&application, &enabled, &[], &())
    };
    call("xrCreateInstance", created)
}

fn make_depth(
    graphics: &dyn Graphics,
    gl: &Rc<Context>,
    session: &xr::Session<xr::OpenGlEs>,
    formats: &[u32],
    size: [u32; 2],
) -> Result<Option<Depth>, XrError> {
    let Some(format) = storage::choose(&storage::DEPTH_FORMATS, formats) else {
        log::info!("no depth is submitted: the runtime takes none of the formats of OpenGL ES");
        return Ok(None);
    };
    let images = EyeImages::new(graphics, gl, session, Kind { format, is_depth: true, size, layers: 2 })?;
    Ok(Some(Depth { images, copy: DepthCopy::new(gl)?, format }))
}

/// Size of the images: what is recommended, scaled.
fn image_size(recommended: [u32; 2], scale: f32, limit: [u32; 2]) -> [u32; 2] {
    let scaled = |n: u32| match scale == 1.0 {
        true => n,
        false => ((n as f32 * scale / SIZE_STEP).ceil() * SIZE_STEP) as u32,
    };
    [0, 1].map(|i| scaled(recommended[i]).clamp(1, limit[i].max(1)))
}

fn log_description(d: &Description) {
    let [w, h] = d.size;
    let rates: Vec<String> = d.refresh_rates.iter().map(|hz| format!("{hz:.0}")).collect();
    log::info!(
        "OpenXR: {}, system {}, {} views of {w}x{h} ({} as {}, {}), depth {}, hidden part {}, refresh rates {}",
        d.runtime,
        d.system,
        d.views,
        d.format,
        if d.array { "one array" } else { "two swapchains" },
        if d.direct { "drawn straight into" } else { "drawn aside and decoded" },
        d.depth.as_deref().unwrap_or("none"),
        if d.mask { "masked" } else { "unknown" },
        if rates.is_empty() { "unknown".to_owned() } else { format!("{} Hz", rates.join(", ")) },
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn image_sizes_stay_within_limits() {
        assert_eq!(image_size([1833, 1921], 1.0, [4096; 2]), [1833, 1921]);
        assert_eq!(image_size([1000, 1000], 0.5, [4096; 2]), [512, 512]);
        assert_eq!(image_size([1000, 1000], 2.0, [1200, 4096]), [1200, 2000]);
    }
}
