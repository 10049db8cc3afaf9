//! A phone in a Cardboard-compatible viewer: a screen behind lenses, and the phone's own motion sensors.

use std::path::PathBuf;
use std::rc::Rc;

use glam::{Quat, Vec2, Vec3};

use super::fence::Fence;
use super::timewarp::PositionalTimewarp;
use crate::error::ViewerError;
use crate::event::{Action, Event};
use crate::frame::{FrameTiming, PresentReport};
use crate::viewer::Viewer;
use yoro::eyes::{DepthRange, Eye, EyePair, FoveationLevel, Pose};
use yoro_gl::{Context, Destination, GlError};
use yoro_lenses::LensPass;
use yoro_lenses::ViewerParams;
use yoro_lenses::{HeadTracker, MotionSample, neck_offset};
use yoro_lenses::{Optics, Screen, flat_hit};
use yoro_render::stereo::{FrameTargets, StereoImages};
use yoro_settings::{FrameRate, Ipd, Settings, Timewarp};

/// Pixels per inch assumed for a screen that does not report any.
const USUAL_DPI: f32 = 400.0;

/// What is logged for `frame-rate=half` where no runtime makes the other frames.
pub(crate) const FULL_RATE: &str =
    "frame-rate=half needs a headset whose runtime makes every second frame: all are rendered";

/// A fixed head pose, used instead of the one that the sensors measure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeldHead {
    /// Rotation from head to world at which frames are rendered.
    pub rendered: Quat,
    /// Rotation from head to world at which frames are shown. Timewarp corrects the difference to `rendered`.
    pub displayed: Quat,
}

/// Objects that live in the GL context.
struct Attached {
    gl: Rc<Context>,
    images: StereoImages,
    lens: LensPass,
    /// A fence after the last frame that was presented.
    presented: Fence,
    /// Present only while the settings ask for positional timewarp.
    timewarp: Option<PositionalTimewarp>,
    /// The head's rotation to the world, and the eyes, of the last frame that was rendered.
    rendered: Option<(Quat, EyePair)>,
}

/// The application on the screen of a phone, behind the lenses of a Cardboard-compatible viewer.
///
/// ```text
/// new ──> attach(gl) ──> [ sensor()* ── event()* ── render() ── wait() ── sensor()* ── present() ]*
/// ```
pub struct Cardboard {
    viewer: Viewer,
    screen: Screen,
    params: ViewerParams,
    optics: Optics,
    tracker: HeadTracker,
    held: Option<HeldHead>,
    attached: Option<Attached>,
}

impl Cardboard {
    /// Creates the application for this screen and starts to load the scene in the background. `folders` are searched
    /// for scenes and viewer files given by name.
    ///
    /// # Errors
    /// [`ViewerError::Params`] and [`ViewerError::NoScene`] for mistakes in the settings.
    pub fn new(settings: Settings, screen: Screen, folders: &[PathBuf]) -> Result<Cardboard, ViewerError> {
        let params = ViewerParams::find_in(&settings.viewer, folders)?;
        if settings.frame_rate == FrameRate::Half {
            log::warn!("{FULL_RATE}");
        }
        let mut viewer = Viewer::new(settings, folders)?;
        viewer.set_native_ipd(Ipd::nearest(params.inter_lens));
        let metres = metres(viewer.settings(), &screen);
        log::info!("viewer: {} {}, screen {:.1?} mm", params.vendor, params.model, metres.map(|m| m * 1e3));
        Ok(Cardboard {
            viewer,
            optics: Optics::new(&params, metres),
            tracker: HeadTracker::new(screen.rotation),
            screen,
            params,
            held: None,
            attached: None,
        })
    }

    /// Returns the application behind the lenses.
    pub fn viewer(&self) -> &Viewer {
        &self.viewer
    }

    /// Returns the application behind the lenses, for what does not depend on the display: telemetry and scenes.
    pub fn viewer_mut(&mut self) -> &mut Viewer {
        &mut self.viewer
    }

    /// See [`Viewer::attach`].
    ///
    /// # Errors
    /// [`ViewerError::Gl`].
    pub fn attach(&mut self, gl: Rc<Context>) -> Result<(), ViewerError> {
        self.viewer.attach(gl.clone())?;
        self.attached = Some(Attached {
            images: StereoImages::new(&gl)?,
            timewarp: self.positional_timewarp(&gl)?,
            lens: self.lens_pass(&gl)?,
            presented: Fence::new(&gl),
            rendered: None,
            gl,
        });
        Ok(())
    }

    /// See [`Viewer::detach`].
    pub fn detach(&mut self) {
        self.attached = None;
        self.viewer.detach();
    }

    /// True if there is a GL context.
    pub fn is_attached(&self) -> bool {
        self.attached.is_some()
    }

    /// Adapts to a screen of another size or rotation.
    ///
    /// # Errors
    /// [`ViewerError::Gl`].
    pub fn resize(&mut self, screen: Screen) -> Result<(), ViewerError> {
        if screen == self.screen {
            return Ok(());
        }
        self.screen = screen;
        self.tracker.set_rotation(screen.rotation);
        self.make_optics()?;
        if let Some(attached) = &mut self.attached {
            attached.rendered = None;
        }
        Ok(())
    }

    /// Creates positional timewarp if the settings ask for it.
    fn positional_timewarp(&self, gl: &Rc<Context>) -> Result<Option<PositionalTimewarp>, GlError> {
        let is_wanted = self.viewer.settings().timewarp == Timewarp::Position;
        is_wanted.then(|| PositionalTimewarp::new(gl, self.eye_size())).transpose()
    }

    /// True if frames may have an inset. Positional timewarp moves whole eyes.
    fn is_foveated(&self) -> bool {
        let settings = self.viewer.settings();
        settings.foveation.unwrap_or_default() != FoveationLevel::Off
            && settings.timewarp != Timewarp::Position
    }

    fn lens_pass(&self, gl: &Rc<Context>) -> Result<LensPass, GlError> {
        LensPass::new(gl, &self.optics, self.is_foveated())
    }

    /// Recomputes the lenses.
    fn make_optics(&mut self) -> Result<(), ViewerError> {
        self.optics = Optics::new(&self.params, metres(self.viewer.settings(), &self.screen));
        let Some(gl) = self.attached.as_ref().map(|attached| attached.gl.clone()) else { return Ok(()) };
        let lens = self.lens_pass(&gl)?;
        if let Some(attached) = &mut self.attached {
            attached.lens = lens;
        }
        Ok(())
    }

    /// See [`Viewer::configure`].
    ///
    /// # Errors
    /// Those of [`Viewer::configure`], and [`ViewerError::Params`]. The previous settings stay in effect.
    pub fn configure(&mut self, settings: Settings, folders: &[PathBuf]) -> Result<(), ViewerError> {
        self.change(settings, folders, |viewer, settings| viewer.configure(settings, folders))
    }

    fn change(
        &mut self,
        settings: Settings,
        folders: &[PathBuf],
        change: impl FnOnce(&mut Viewer, Settings) -> Result<(), ViewerError>,
    ) -> Result<(), ViewerError> {
        let before = self.viewer.settings();
        let optics_differ = settings.screen != before.screen;
        let params = if settings.viewer == before.viewer {
            None
        } else {
            Some(ViewerParams::find_in(&settings.viewer, folders)?)
        };
        let timewarp_differs = settings.timewarp != before.timewarp;
        let was_foveated = self.is_foveated();
        change(&mut self.viewer, settings)?;
        let layers_differ = self.is_foveated() != was_foveated;
        if let Some(attached) = self.attached.as_mut().filter(|_| layers_differ) {
            attached.rendered = None;
        }
        if timewarp_differs && let Some(gl) = self.attached.as_ref().map(|attached| attached.gl.clone()) {
            let timewarp = self.positional_timewarp(&gl)?;
            if let Some(attached) = &mut self.attached {
                (attached.timewarp, attached.rendered) = (timewarp, None);
            }
        }
        let lenses_differ = params.is_some() || optics_differ || layers_differ;
        if let Some(params) = params {
            self.params = params;
            self.viewer.set_native_ipd(Ipd::nearest(self.params.inter_lens));
            self.viewer.reset_ipd();
        }
        if lenses_differ {
            self.make_optics()?;
        }
        Ok(())
    }

    /// See [`Viewer::event`].
    ///
    /// # Errors
    /// Those of [`Viewer::event`].
    pub fn event(&mut self, event: Event) -> Result<Action, ViewerError> {
        let action = self.viewer.event(event)?;
        self.follow(action)?;
        Ok(action)
    }

    /// Handles a tap of a finger at a position in pixels from the window's upper left corner, or of a key (`None`).
    /// Returns its action on the start screen or in a corner; `None` elsewhere, where it is an [`Event::Tap`].
    ///
    /// # Errors
    /// Those of [`Viewer::event`].
    pub fn touch(&mut self, at: Option<[f32; 2]>) -> Result<Option<Action>, ViewerError> {
        let side = self.corner() as f32;
        let width = self.screen.size[0] as f32;
        let action = if self.viewer.is_start_screen() {
            let at = at.map(|at| flat_hit(at.into(), self.screen.size).unwrap_or(Vec2::NEG_ONE));
            self.viewer.touch_start_screen(at)
        } else {
            match at.filter(|&[_, y]| y < side && self.viewer.offers_start_screen()) {
                Some([x, _]) if x < side => self.viewer.show_start_screen(""),
                Some([x, _]) if x >= width - side => return self.event(Event::LongPress).map(Some),
                _ => return Ok(None),
            }
        };
        self.follow(action)?;
        Ok(Some(action))
    }

    /// Returns the edge in pixels of the corners that take touches: 48 density-independent pixels, 7.6 mm.
    fn corner(&self) -> u32 {
        let dpi = self.screen.dpi[0];
        (0.3 * if dpi.is_finite() && dpi > 0.0 { dpi } else { USUAL_DPI }) as u32
    }

    /// See [`Viewer::choose_viewer`].
    ///
    /// # Errors
    /// Those of [`Cardboard::configure`].
    pub fn choose_viewer(&mut self, viewer: &str) -> Result<(), ViewerError> {
        let action = self.viewer.choose_viewer(viewer);
        self.follow(action)
    }

    /// Performs the display's part of an action.
    fn follow(&mut self, action: Action) -> Result<(), ViewerError> {
        if matches!(action, Action::Recenter | Action::StartScreen(false)) {
            self.tracker.recenter();
        }
        if let Some(settings) = self.viewer.take_settings() {
            let folders = self.viewer.folders.clone();
            self.change(settings, &folders, |viewer, settings| viewer.change(settings, &folders))?;
            self.viewer.write_menu();
            self.viewer.write_start_screen();
        }
        Ok(())
    }

    /// Adds a sample of a motion sensor with its own timestamp in nanoseconds.
    pub fn sensor(&mut self, sample: MotionSample, timestamp_ns: i64) {
        self.tracker.add(sample, timestamp_ns);
    }

    /// Holds the head in a fixed pose whatever the sensors measure; `None` releases it.
    pub fn hold_head(&mut self, head: Option<HeldHead>) {
        self.held = head;
    }

    /// See [`Viewer::pause`]; head tracking pauses, too.
    pub fn pause(&mut self) {
        self.tracker.pause();
        self.viewer.pause();
    }

    /// See [`Viewer::resume`].
    pub fn resume(&mut self) {
        self.viewer.resume();
    }

    /// Calls [`Cardboard::render`] and [`Cardboard::present`].
    ///
    /// # Errors
    /// Those of the calls above.
    pub fn frame(
        &mut self,
        window: &Destination,
        timing: &FrameTiming,
    ) -> Result<PresentReport, ViewerError> {
        self.render(timing)?;
        self.present(window, timing)
    }

    /// Renders both eyes for the head pose predicted for the time at which the frame is seen. Until the scene is
    /// loaded, this is a progress bar.
    ///
    /// # Errors
    /// Those of [`Viewer::render`].
    pub fn render(&mut self, timing: &FrameTiming) -> Result<(), ViewerError> {
        let up = self.tracker.head_from_world(0.0) * Vec3::Y;
        if self.viewer.tilt(up, self.screen.rotation, timing.now_ns) {
            log::info!("{}", Action::StartScreen(true));
        }
        if self.viewer.is_start_screen() {
            return Ok(());
        }
        self.viewer.begin(timing);
        let head = self.head(timing).0;
        let action = self.viewer.look(relative(head), [None; 2])?;
        if action != Action::Nothing {
            log::info!("{action}");
        }
        self.follow(action)?;
        let pair = self.eyes(head);
        let attached = self.attached.as_mut().ok_or(ViewerError::NoContext)?;
        match &mut attached.timewarp {
            // Panels are drawn over the eyes once these are moved.
            Some(timewarp) => {
                timewarp.resize(pair.size)?;
                self.viewer.render(&pair.into(), FrameTargets::Eyes(timewarp.targets()))?;
            }
            None => {
                let views = self.viewer.stereo_views(&pair, pair.axes());
                self.viewer.render(&views, FrameTargets::Images(&mut attached.images))?;
                if views.inset.is_none() {
                    self.viewer.draw_panels(&pair, attached.images.wide())?;
                } else {
                    // The HUD is drawn once the levels are composed.
                    for (frame, layer) in attached.images.layers() {
                        self.viewer.draw_menu(layer, &frame.colors());
                    }
                }
            }
        }
        attached.rendered = Some((head, pair));
        Ok(())
    }

    /// Waits until the GPU has finished the frame that was presented last; meanwhile the GPU starts on the one that was
    /// rendered since. Without this, a GPU slower than the display builds up a queue of frames, each showing an old
    /// head pose. Waits for at most a quarter of a second.
    pub fn wait(&mut self) {
        if let Some(attached) = &mut self.attached {
            attached.presented.wait();
        }
    }

    /// Draws the last rendered frame onto the screen, through the lenses. Depending on the settings, timewarp turns it
    /// to the head's newest direction or moves it to the head's newest pose.
    ///
    /// # Errors
    /// Those of [`Viewer::end`].
    pub fn present(
        &mut self,
        window: &Destination,
        timing: &FrameTiming,
    ) -> Result<PresentReport, ViewerError> {
        let displayed = self.head(timing).1;
        let now = self.eyes(displayed);
        let corner = self.corner();
        let attached = self.attached.as_mut().ok_or(ViewerError::NoContext)?;
        if self.viewer.is_start_screen() {
            self.viewer.draw_start_screen(window);
            attached.presented.set();
            // Not a frame of the session.
            return Ok(PresentReport { scene: self.viewer.scene_state(), ..PresentReport::default() });
        }
        let Attached { images, timewarp, lens, .. } = attached;
        let mut turn = Quat::IDENTITY;
        if let Some((rendered, _)) =
            attached.rendered.filter(|_| self.viewer.settings().timewarp != Timewarp::Off)
        {
            turn = rendered.inverse() * displayed;
        }
        match timewarp.as_mut().zip(attached.rendered.as_ref()) {
            Some((timewarp, (_, pair))) => {
                let now = EyePair { poses: now.poses, ..*pair };
                let (frame, shown) = match timewarp.run(pair, &now)? {
                    Some(moved) => {
                        turn = Quat::IDENTITY;
                        (moved, &now)
                    }
                    None => (timewarp.frame(), pair),
                };
                self.viewer.draw_panels(shown, frame)?;
                lens.run(&frame.levels(), None, turn, window);
            }
            None => {
                let eyes = images.eye(Eye::Left).zip(images.eye(Eye::Right));
                let eyes = eyes.map_or_else(|| images.wide().levels(), |(left, right)| [left, right]);
                let pair = attached.rendered.map(|(_, pair)| pair);
                // Over eyes without an inset it is drawn already. As on headsets, the menu takes the HUD's place.
                let is_drawn = eyes[0].0.inset.is_none() || self.viewer.menu_place().is_some();
                let panel = if is_drawn { None } else { self.viewer.hud()? };
                lens.run(&eyes, panel.as_ref().zip(pair.as_ref()), turn, window);
            }
        }
        self.viewer.draw_corners(corner, window);
        attached.presented.set();
        self.viewer.end(timing)
    }

    /// Returns the viewer's parameters combined with the screen.
    pub fn optics(&self) -> &Optics {
        &self.optics
    }

    /// Returns the tracker of the head's direction.
    pub fn tracker(&self) -> &HeadTracker {
        &self.tracker
    }

    /// Returns the size in pixels of each eye's image.
    pub fn eye_size(&self) -> [u32; 2] {
        self.viewer.eye_size(self.optics.full_size(self.screen.size))
    }

    /// Returns the rotations from head to world at which to render and at which to show.
    fn head(&self, timing: &FrameTiming) -> (Quat, Quat) {
        if let Some(held) = self.held {
            return (held.rendered, held.displayed);
        }
        let head = self.tracker.world_from_head(timing.now_ns, timing.expected_display_ns);
        (head, head)
    }

    /// Returns the eyes of a head with this rotation, at the scene's viewpoint.
    fn eyes(&self, head: Quat) -> EyePair {
        let head = self.viewer.place(relative(head));
        let half = self.viewer.ipd().metres() / 2.0;
        EyePair {
            poses: Eye::BOTH.map(|eye| head.translated_local(Vec3::X * (eye.side() * half))),
            frusta: Eye::BOTH.map(|eye| self.optics.frustum(eye)),
            depth: DepthRange::PAPER,
            size: self.eye_size(),
            dominant: self.viewer.settings().dominant,
        }
    }
}

/// Returns the pose of a head with this rotation, relative to the viewpoint.
fn relative(head: Quat) -> Pose {
    // For a head looking straight ahead the eyes are exactly at the viewpoint that the scene's author chose.
    Pose { position: neck_offset(head) - neck_offset(Quat::IDENTITY), orientation: head }
}

/// Returns width and height in metres of the screen behind the lenses: those of the settings, or else of the device.
fn metres(settings: &Settings, screen: &Screen) -> [f32; 2] {
    settings.screen.map_or_else(|| screen.metres(), |size| size.metres())
}
