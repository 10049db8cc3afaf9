//! Sessions and their states.

use std::collections::VecDeque;
use std::ffi::c_void;

use openxr_sys as sys;
use sys::{Handle, Result as Code};

use crate::graphics::{self, Graphics};
use crate::instance::check_system;
use crate::log::Entry;
use crate::script::State;
use crate::world::{
    Answer, Array, DONE, Event, Instance, Refusal, World, forbid_if, forbidden, found, in_output,
};

pub struct Session {
    pub handle: u64,
    pub lost: bool,
    pub loss_pending: bool,
    /// The number of views of the session's configuration; 0 while it is not running.
    pub views: u32,
    pub state: State,
    /// The highest state that the session may reach.
    pub level: State,
    /// The number of polls at which the session becomes `READY` again after its end, or `None` if it becomes `EXITING`.
    put_on_again_at: Option<u32>,
    exiting: bool,
    pub frames: FrameCalls,
    pub graphics: Box<dyn Graphics>,
}

/// The frames of a running session.
#[derive(Default)]
pub struct FrameCalls {
    pub waited: Option<Frame>,
    pub begun: Option<Frame>,
    /// The number of frames that have ended.
    pub ended: u32,
    /// The number of frames that were waited for.
    pub count: u32,
    /// The previous frame, if it had motion vectors.
    pub previous: Option<crate::synthesis::MovingFrame>,
    /// The pose of the last frame's projection layer's space, in the space of the floor.
    pub space: Option<crate::space::Pose>,
}

#[derive(Clone, Copy)]
pub struct Frame {
    pub number: u32,
    pub time: sys::Time,
    pub should_render: bool,
}

impl Session {
    fn go(&mut self, state: State, events: &mut VecDeque<Event>) {
        self.state = state;
        events.push_back(Event::State(state));
    }

    /// Moves from state to state as far as `level` and the ended frames allow.
    pub fn settle(&mut self, events: &mut VecDeque<Event>) {
        const LEVELS: [State; 4] = [State::Ready, State::Synchronized, State::Visible, State::Focused];
        let index = |state| LEVELS.iter().position(|level| *level == state);
        let (true, Some(mut now), Some(highest)) = (self.views > 0, index(self.state), index(self.level))
        else {
            return;
        };
        let target = highest.min(self.frames.ended as usize);
        while now != target {
            now = if now < target { now + 1 } else { now - 1 };
            self.go(LEVELS[now], events);
        }
    }

    /// Ends the session, either for good or until the headset is put on again.
    pub fn stop(&mut self, events: &mut VecDeque<Event>, put_on_again_at: Option<u32>) {
        self.put_on_again_at = put_on_again_at;
        self.exiting = put_on_again_at.is_none();
        if self.views == 0 {
            self.go(State::Idle, events);
            if self.exiting {
                self.go(State::Exiting, events);
            }
            return;
        }
        for state in [State::Visible, State::Synchronized] {
            if self.state > state {
                self.go(state, events);
            }
        }
        self.go(State::Stopping, events);
    }

    /// Makes the session ready again after enough polls.
    pub fn put_on_again(&mut self, polls: u32, events: &mut VecDeque<Event>) {
        if self.state == State::Idle && self.put_on_again_at.is_some_and(|at| at <= polls) {
            self.put_on_again_at = None;
            self.go(State::Ready, events);
        }
    }
}

pub fn get_graphics_requirements(
    world: &mut World,
    instance: sys::Instance,
    system: sys::SystemId,
    requirements: &mut sys::GraphicsRequirementsOpenGLESKHR,
) -> Answer {
    let instance = world.instance(instance)?;
    check_system(system)?;
    instance.requirements_asked = true;
    requirements.min_api_version_supported = sys::Version::new(3, 0, 0);
    requirements.max_api_version_supported = sys::Version::new(3, 2, 0);
    DONE
}

/// Implements the only function for Vulkan: the application creates its instance and device itself.
pub fn get_vulkan_graphics_requirements(
    world: &mut World,
    instance: sys::Instance,
    system: sys::SystemId,
    requirements: &mut sys::GraphicsRequirementsVulkanKHR,
) -> Answer {
    let instance = world.instance(instance)?;
    check_system(system)?;
    instance.requirements_asked = true;
    requirements.min_api_version_supported = sys::Version::new(1, 0, 0);
    requirements.max_api_version_supported = sys::Version::new(1, 4, 0);
    DONE
}

pub fn create_session(
    world: &mut World,
    instance: sys::Instance,
    info: &sys::SessionCreateInfo,
    out: &mut sys::Session,
) -> Answer {
    let known = world.instance(instance)?;
    check_system(info.system_id)?;
    forbid_if(known.session.is_some(), Code::ERROR_LIMIT_REACHED, "there is a session already")?;
    forbid_if(
        !known.requirements_asked,
        Code::ERROR_GRAPHICS_REQUIREMENTS_CALL_MISSING,
        "the graphics requirements were not asked for",
    )?;
    // SAFETY: a chain of structures.
    let (binding, graphics) = unsafe { graphics::bind(info.next, &known.extensions) }?;
    let handle = world.new_handle();
    world.log.write(&Entry::Session { binding: binding.into() });
    let known = world.instance(instance)?;
    let mut session = Session {
        handle,
        lost: false,
        loss_pending: false,
        views: 0,
        state: State::Idle,
        level: State::Focused,
        put_on_again_at: None,
        exiting: false,
        frames: FrameCalls::default(),
        graphics,
    };
    session.go(State::Idle, &mut known.events);
    session.go(State::Ready, &mut known.events);
    known.session = Some(session);
    *out = sys::Session::from_raw(handle);
    DONE
}

pub fn destroy_session(world: &mut World, session: sys::Session) -> Answer {
    let known = world.instance.as_mut();
    let known = known.filter(|i| i.session.as_ref().is_some_and(|s| s.handle == session.into_raw()));
    let known = found(known, "not a session")?;
    known.session = None;
    known.spaces.clear();
    known.swapchains.clear();
    known.events.retain(|event| !matches!(event, Event::State(_)));
    known.actions.detach();
    world.log.write(&Entry::Destroyed { what: "session".into() });
    DONE
}

pub fn begin_session(world: &mut World, session: sys::Session, info: &sys::SessionBeginInfo) -> Answer {
    let configuration = info.primary_view_configuration_type;
    let views = views_of(world, configuration)?;
    let known = world.session(session)?;
    forbid_if(known.views > 0, Code::ERROR_SESSION_RUNNING, "it is running")?;
    forbid_if(
        known.state != State::Ready,
        Code::ERROR_SESSION_NOT_READY,
        format!("it is {:?}", known.state),
    )?;
    known.views = views;
    known.frames = FrameCalls::default();
    world.log.write(&Entry::Begun { views });
    world.success()
}

/// True if four views are offered to the application.
fn offers_insets(world: &World) -> bool {
    world.script.insets.is_some() && world.instance.as_ref().is_some_and(Instance::has_quad_views)
}

/// Returns the number of views of a configuration.
pub fn views_of(world: &World, configuration: sys::ViewConfigurationType) -> Result<u32, Refusal> {
    match configuration {
        sys::ViewConfigurationType::PRIMARY_STEREO if world.script.stereo => Ok(2),
        sys::ViewConfigurationType::PRIMARY_MONO if world.script.mono => Ok(1),
        sys::ViewConfigurationType::PRIMARY_STEREO_WITH_FOVEATED_INSET if offers_insets(world) => Ok(4),
        other => Err(forbidden(
            Code::ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED,
            format!("{other:?} is not offered"),
        )),
    }
}

pub fn end_session(world: &mut World, session: sys::Session) -> Answer {
    let known = world.session(session)?;
    forbid_if(known.views == 0, Code::ERROR_SESSION_NOT_RUNNING, "it is not running")?;
    forbid_if(
        known.state != State::Stopping,
        Code::ERROR_SESSION_NOT_STOPPING,
        format!("it is {:?}", known.state),
    )?;
    known.views = 0;
    let instance = world.current()?;
    let (events, Some(known)) = (&mut instance.events, &mut instance.session) else { return DONE };
    known.go(State::Idle, events);
    if known.exiting {
        known.go(State::Exiting, events);
    }
    world.success()
}

pub fn request_exit_session(world: &mut World, session: sys::Session) -> Answer {
    forbid_if(world.session(session)?.views == 0, Code::ERROR_SESSION_NOT_RUNNING, "it is not running")?;
    world.log.write(&Entry::Request { what: "exit".into(), value: 1.0 });
    let instance = world.current()?;
    if let Some(known) = instance.session.as_mut().filter(|known| known.state != State::Stopping) {
        known.stop(&mut instance.events, None);
    }
    world.success()
}

pub fn enumerate_view_configurations(
    world: &mut World,
    instance: sys::Instance,
    system: sys::SystemId,
    types: Array<sys::ViewConfigurationType>,
) -> Answer {
    world.instance(instance)?;
    check_system(system)?;
    // From the highest preference to the lowest.
    let offered: Vec<_> = [
        (sys::ViewConfigurationType::PRIMARY_STEREO_WITH_FOVEATED_INSET, offers_insets(world)),
        (sys::ViewConfigurationType::PRIMARY_STEREO, world.script.stereo),
        (sys::ViewConfigurationType::PRIMARY_MONO, world.script.mono),
    ]
    .into_iter()
    .filter_map(|(configuration, offered)| offered.then_some(configuration))
    .collect();
    types.fill(&offered, |to, from| *to = *from)
}

/// The recommended planes in metres of XR_EXT_view_configuration_depth_range. The structure is filled in even if the
/// extension is not enabled.
const DEPTH_RANGE: (f32, f32) = (0.1, 50.0);

pub fn enumerate_view_configuration_views(
    world: &mut World,
    instance: sys::Instance,
    system: sys::SystemId,
    configuration: sys::ViewConfigurationType,
    views: Array<sys::ViewConfigurationView>,
) -> Answer {
    world.instance(instance)?;
    check_system(system)?;
    let number = views_of(world, configuration)? as usize;
    views.check_types(number, sys::ViewConfigurationView::TYPE)?;
    let mut sizes: Vec<[u32; 2]> = world.script.eyes.iter().map(|eye| eye.size).collect();
    sizes.extend(world.script.insets.iter().flat_map(|insets| [insets.size; 2]));
    sizes.truncate(number);
    let eyes = world.script.eyes.iter().cycle();
    let sizes: Vec<_> = sizes.into_iter().zip(eyes.map(|eye| eye.fov_degrees.map(f32::to_radians))).collect();
    let vector_size = world.script.vector_size;
    views.fill(&sizes, |view, ([width, height], fov)| {
        view.recommended_image_rect_width = *width;
        view.recommended_image_rect_height = *height;
        view.max_image_rect_width = 4096;
        view.max_image_rect_height = 4096;
        view.recommended_swapchain_sample_count = 1;
        view.max_swapchain_sample_count = 1;
        // SAFETY: the application's chain.
        unsafe {
            fill_depth_range(view.next);
            in_output(
                view.next,
                |chained: &mut sys::ViewConfigurationViewFovEPIC| {
                    (chained.recommended_fov, chained.max_mutable_fov) = (raw_fov(*fov), raw_fov(*fov));
                },
                sys::ViewConfigurationViewFovEPIC::TYPE,
            );
            in_output(
                view.next,
                |sizes: &mut sys::FrameSynthesisConfigViewEXT| {
                    sizes.recommended_motion_vector_image_rect_width = vector_size[0];
                    sizes.recommended_motion_vector_image_rect_height = vector_size[1];
                },
                sys::FrameSynthesisConfigViewEXT::TYPE,
            );
        }
    })
}

/// Returns the field of view of these angles in radians: left, right, up and down.
pub fn raw_fov([angle_left, angle_right, angle_up, angle_down]: [f32; 4]) -> sys::Fovf {
    sys::Fovf { angle_left, angle_right, angle_up, angle_down }
}

/// Fills in the depth range in a chain. It stands for any output structure: it belongs to view configurations, but is
/// filled in for located views too, for which the specification has none yet.
///
/// # Safety
/// The structures of the chain state their types.
pub unsafe fn fill_depth_range(chain: *mut c_void) {
    let fill = |range: &mut sys::ViewConfigurationDepthRangeEXT| {
        (range.recommended_near_z, range.recommended_far_z) = DEPTH_RANGE;
    };
    // SAFETY: same contract.
    unsafe { in_output(chain, fill, sys::ViewConfigurationDepthRangeEXT::TYPE) };
}

pub fn enumerate_environment_blend_modes(
    world: &mut World,
    instance: sys::Instance,
    system: sys::SystemId,
    configuration: sys::ViewConfigurationType,
    modes: Array<sys::EnvironmentBlendMode>,
) -> Answer {
    world.instance(instance)?;
    check_system(system)?;
    views_of(world, configuration)?;
    modes.fill(&[sys::EnvironmentBlendMode::OPAQUE], |to, from| *to = *from)
}
