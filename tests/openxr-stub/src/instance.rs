//! Instances, systems, paths and events.

use std::collections::{HashMap, VecDeque};
use std::ffi::{CStr, c_char};
use std::ptr;

use openxr_sys as sys;
use sys::{Handle, Result as Code};

use crate::log::Entry;
use crate::script::{At, State};
use crate::world::{
    Answer, Array, DONE, Event, Instance, World, forbid_if, forbidden, given, in_chain, in_output,
};

/// The API version that negotiation returns.
pub const NEWEST: sys::Version = sys::Version::new(1, 1, 54);
/// The id of the only system.
pub const SYSTEM: u64 = 1;

/// The extension for layers whose images are upside down.
pub const IMAGE_LAYOUT: &str = "XR_FB_composition_layer_image_layout";

/// The extension for four views in instances of OpenXR 1.0.
pub const QUAD_VIEWS: &str = "XR_VARJO_quad_views";
/// The extensions for frames made of motion vectors.
pub const FRAME_SYNTHESIS: &str = "XR_EXT_frame_synthesis";
pub const SPACE_WARP: &str = "XR_FB_space_warp";
/// The extension for images whose density the runtime can change.
pub const FOVEATION: &str = "XR_FB_foveation";

/// The extensions that can be offered, with their versions.
pub const EXTENSIONS: [(&str, u32); 22] = [
    ("XR_KHR_opengl_es_enable", 8),
    ("XR_KHR_vulkan_enable", 8),
    ("XR_KHR_vulkan_enable2", 2),
    ("XR_MNDX_egl_enable", 2),
    ("XR_KHR_android_create_instance", 3),
    ("XR_KHR_composition_layer_depth", 6),
    ("XR_KHR_visibility_mask", 2),
    ("XR_FB_display_refresh_rate", 1),
    ("XR_EXT_performance_settings", 4),
    ("XR_EXT_local_floor", 1),
    ("XR_KHR_loader_init", 2),
    ("XR_KHR_android_thread_settings", 6),
    ("XR_BD_controller_interaction", 2),
    (IMAGE_LAYOUT, 1),
    ("XR_MSFT_composition_layer_reprojection", 1),
    ("XR_META_recommended_layer_resolution", 1),
    (QUAD_VIEWS, 2),
    (FRAME_SYNTHESIS, 1),
    (SPACE_WARP, 2),
    (FOVEATION, 1),
    ("XR_FB_foveation_configuration", 1),
    ("XR_FB_swapchain_update_state", 3),
];

/// Returns the string in an array of characters.
pub fn text(characters: &[c_char]) -> String {
    let bytes: Vec<u8> = characters.iter().take_while(|c| **c != 0).map(|c| *c as u8).collect();
    String::from_utf8_lossy(&bytes).into_owned()
}

/// Writes a string to an array of characters.
pub fn put_text(target: &mut [c_char], text: &str) {
    target.fill(0);
    for (to, from) in target.iter_mut().zip(text.bytes()) {
        *to = from as c_char;
    }
}

pub fn enumerate_instance_extension_properties(
    world: &mut World,
    layer: *const c_char,
    properties: Array<sys::ExtensionProperties>,
) -> Answer {
    if !layer.is_null() {
        return Err(Code::ERROR_API_LAYER_NOT_PRESENT.into());
    }
    let offered: Vec<sys::ExtensionProperties> = EXTENSIONS
        .iter()
        .filter(|(name, _)| !world.script.missing_extensions.iter().any(|missing| missing == name))
        .filter(|(name, _)| *name != QUAD_VIEWS || world.script.insets.is_some())
        .map(|(name, version)| {
            let mut property = sys::ExtensionProperties {
                ty: sys::ExtensionProperties::TYPE,
                next: ptr::null_mut(),
                extension_name: [0; sys::MAX_EXTENSION_NAME_SIZE],
                extension_version: *version,
            };
            put_text(&mut property.extension_name, name);
            property
        })
        .collect();
    properties.fill(&offered, |to, from| {
        to.extension_name = from.extension_name;
        to.extension_version = from.extension_version;
    })
}

pub fn enumerate_api_layer_properties(
    _: &mut World,
    _: u32,
    count: &mut u32,
    _: *mut sys::ApiLayerProperties,
) -> Answer {
    *count = 0;
    DONE
}

pub fn create_instance(world: &mut World, info: &sys::InstanceCreateInfo, out: &mut sys::Instance) -> Answer {
    forbid_if(
        info.ty != sys::InstanceCreateInfo::TYPE,
        Code::ERROR_VALIDATION_FAILURE,
        "the structure's type is wrong",
    )?;
    forbid_if(world.instance.is_some(), Code::ERROR_LIMIT_REACHED, "there is an instance already")?;
    let api = info.application_info.api_version;
    if api.major() != 1 || api.minor() > NEWEST.minor() {
        return Err(Code::ERROR_API_VERSION_UNSUPPORTED.into());
    }
    let application = text(&info.application_info.application_name);
    forbid_if(application.is_empty(), Code::ERROR_NAME_INVALID, "the application has no name")?;
    given(info.enabled_extension_count > 0 && info.enabled_extension_names.is_null(), "the extensions")?;
    let mut extensions = Vec::new();
    for i in 0..info.enabled_extension_count as usize {
        // SAFETY: the array has that many strings.
        let name = unsafe { CStr::from_ptr(*info.enabled_extension_names.add(i)) };
        let name = name.to_string_lossy().into_owned();
        let known = EXTENSIONS.iter().any(|(known, _)| *known == name);
        forbid_if(
            !known || world.script.missing_extensions.contains(&name),
            Code::ERROR_EXTENSION_NOT_PRESENT,
            format!("{name} is not offered"),
        )?;
        extensions.push(name);
    }
    let android = sys::StructureType::INSTANCE_CREATE_INFO_ANDROID_KHR;
    // SAFETY: a chain of structures, which begin with this header.
    let android = unsafe { in_chain::<sys::BaseInStructure>(info.next, android) }.is_some();
    let handle = world.new_handle();
    let (api_version, api) = (api, format!("{}.{}.{}", api.major(), api.minor(), api.patch()));
    world.log.write(&Entry::Instance { application, api, extensions: extensions.clone(), android });
    world.instance = Some(Instance {
        handle,
        api: api_version,
        extensions,
        lost: false,
        requirements_asked: false,
        events: VecDeque::new(),
        paths: Vec::new(),
        actions: Default::default(),
        session: None,
        spaces: HashMap::new(),
        swapchains: HashMap::new(),
        foveations: HashMap::new(),
        local_yaw: 0.0,
    });
    *out = sys::Instance::from_raw(handle);
    DONE
}

pub fn destroy_instance(world: &mut World, instance: sys::Instance) -> Answer {
    world.any_instance(instance)?;
    world.instance = None;
    let counts = world.counts();
    world.log.write(&Entry::Destroyed { what: "instance".into() });
    world.log.write(&Entry::Calls { counts });
    DONE
}

pub fn get_instance_properties(
    world: &mut World,
    instance: sys::Instance,
    properties: &mut sys::InstanceProperties,
) -> Answer {
    world.instance(instance)?;
    properties.runtime_version = sys::Version::new(0, 1, 0);
    put_text(&mut properties.runtime_name, "yoro's simulated runtime");
    DONE
}

pub fn get_system(
    world: &mut World,
    instance: sys::Instance,
    info: &sys::SystemGetInfo,
    out: &mut sys::SystemId,
) -> Answer {
    world.instance(instance)?;
    if info.form_factor != sys::FormFactor::HEAD_MOUNTED_DISPLAY {
        return Err(Code::ERROR_FORM_FACTOR_UNSUPPORTED.into());
    }
    if world.unavailable < world.script.unavailable {
        world.unavailable += 1;
        return Err(Code::ERROR_FORM_FACTOR_UNAVAILABLE.into());
    }
    *out = sys::SystemId::from_raw(SYSTEM);
    DONE
}

pub fn get_system_properties(
    world: &mut World,
    instance: sys::Instance,
    system: sys::SystemId,
    properties: &mut sys::SystemProperties,
) -> Answer {
    world.instance(instance)?;
    check_system(system)?;
    // SAFETY: the application's chain.
    unsafe {
        in_output(
            properties.next,
            |sizes: &mut sys::SystemSpaceWarpPropertiesFB| {
                sizes.recommended_motion_vector_image_rect_width = world.script.vector_size[0];
                sizes.recommended_motion_vector_image_rect_height = world.script.vector_size[1];
            },
            sys::SystemSpaceWarpPropertiesFB::TYPE,
        );
    }
    properties.system_id = system;
    properties.vendor_id = 0;
    put_text(&mut properties.system_name, "simulated headset");
    properties.graphics_properties = sys::SystemGraphicsProperties {
        max_swapchain_image_height: 4096,
        max_swapchain_image_width: 4096,
        max_layer_count: 16,
    };
    properties.tracking_properties =
        sys::SystemTrackingProperties { orientation_tracking: sys::TRUE, position_tracking: sys::TRUE };
    DONE
}

/// Refuses all systems but the only one.
pub fn check_system(system: sys::SystemId) -> Result<(), crate::world::Refusal> {
    forbid_if(system.into_raw() != SYSTEM, Code::ERROR_SYSTEM_INVALID, "not a system")
}

pub fn string_to_path(
    world: &mut World,
    instance: sys::Instance,
    string: &CStr,
    path: &mut sys::Path,
) -> Answer {
    let instance = world.instance(instance)?;
    let string = string.to_string_lossy().into_owned();
    let good = string.starts_with('/')
        && !string.ends_with('/')
        && string.bytes().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || b"/-_.".contains(&c));
    forbid_if(!good, Code::ERROR_PATH_FORMAT_INVALID, format!("{string:?} is not a path"))?;
    let index = instance.paths.iter().position(|known| *known == string).unwrap_or_else(|| {
        instance.paths.push(string);
        instance.paths.len() - 1
    });
    *path = sys::Path::from_raw(index as u64 + 1);
    DONE
}

impl Instance {
    /// Returns the text of a path, or `None` for the null path.
    pub fn path(&self, path: sys::Path) -> Option<&str> {
        let index = path.into_raw().checked_sub(1)?;
        self.paths.get(index as usize).map(String::as_str)
    }
}

/// Writes an event to the buffer, which has room for every kind of event.
fn write_event<T: Copy>(buffer: &mut sys::EventDataBuffer, event: T) -> Answer {
    const { assert!(size_of::<T>() <= size_of::<sys::EventDataBuffer>()) };
    // SAFETY: there is room, and events are plain data.
    unsafe { ptr::write((&raw mut *buffer).cast::<T>(), event) };
    DONE
}

pub fn poll_event(world: &mut World, instance: sys::Instance, buffer: &mut sys::EventDataBuffer) -> Answer {
    world.any_instance(instance)?;
    forbid_if(
        buffer.ty != sys::EventDataBuffer::TYPE,
        Code::ERROR_VALIDATION_FAILURE,
        "the buffer's type is wrong",
    )?;
    let (now, frames) = (world.time(), world.frame());
    let known = world.any_instance(instance)?;
    // A lost instance has no event other than its loss.
    if known.lost {
        known.events.retain(|event| matches!(event, Event::InstanceLoss));
        if known.events.is_empty() {
            return Err(Code::ERROR_INSTANCE_LOST.into());
        }
    }
    let session = sys::Session::from_raw(known.session.as_ref().map_or(0, |session| session.handle));
    let next = ptr::null();
    let Some(event) = known.events.pop_front() else {
        world.idle_polls += 1;
        let polls = world.idle_polls;
        let known = world.any_instance(instance)?;
        if let Some(session) = &mut known.session {
            session.put_on_again(polls, &mut known.events);
        }
        return Ok(Code::EVENT_UNAVAILABLE);
    };
    match event {
        Event::State(state) => {
            world.happen(|at| matches!(at, At::State(s) if *s == state));
            let ty = sys::EventDataSessionStateChanged::TYPE;
            let state = raw_state(state);
            write_event(buffer, sys::EventDataSessionStateChanged { ty, next, session, state, time: now })
        }
        Event::InstanceLoss => {
            let ty = sys::EventDataInstanceLossPending::TYPE;
            write_event(buffer, sys::EventDataInstanceLossPending { ty, next, loss_time: now })
        }
        Event::ReferenceSpace(yaw) => {
            let turn = glam::Quat::from_rotation_y(yaw);
            write_event(
                buffer,
                sys::EventDataReferenceSpaceChangePending {
                    ty: sys::EventDataReferenceSpaceChangePending::TYPE,
                    next,
                    session,
                    reference_space_type: sys::ReferenceSpaceType::LOCAL,
                    change_time: now,
                    pose_valid: sys::TRUE,
                    pose_in_previous_space: crate::space::raw_pose((turn, glam::Vec3::ZERO)),
                },
            )
        }
        Event::Profile => {
            let ty = sys::EventDataInteractionProfileChanged::TYPE;
            write_event(buffer, sys::EventDataInteractionProfileChanged { ty, next, session })
        }
        Event::RefreshRate(from, to) => write_event(
            buffer,
            sys::EventDataDisplayRefreshRateChangedFB {
                ty: sys::EventDataDisplayRefreshRateChangedFB::TYPE,
                next,
                from_display_refresh_rate: from,
                to_display_refresh_rate: to,
            },
        ),
        Event::Mask => write_event(
            buffer,
            sys::EventDataVisibilityMaskChangedKHR {
                ty: sys::EventDataVisibilityMaskChangedKHR::TYPE,
                next,
                session,
                view_configuration_type: match known.session.as_ref().map(|session| session.views) {
                    Some(4) => sys::ViewConfigurationType::PRIMARY_STEREO_WITH_FOVEATED_INSET,
                    _ => sys::ViewConfigurationType::PRIMARY_STEREO,
                },
                view_index: frames % 2,
            },
        ),
        Event::Lost => {
            let ty = sys::EventDataEventsLost::TYPE;
            write_event(buffer, sys::EventDataEventsLost { ty, next, lost_event_count: 1 })
        }
    }
}

fn raw_state(state: State) -> sys::SessionState {
    match state {
        State::Idle => sys::SessionState::IDLE,
        State::Ready => sys::SessionState::READY,
        State::Synchronized => sys::SessionState::SYNCHRONIZED,
        State::Visible => sys::SessionState::VISIBLE,
        State::Focused => sys::SessionState::FOCUSED,
        State::Stopping => sys::SessionState::STOPPING,
        State::LossPending => sys::SessionState::LOSS_PENDING,
        State::Exiting => sys::SessionState::EXITING,
    }
}

pub fn initialize_loader(world: &mut World, info: &sys::LoaderInitInfoBaseHeaderKHR) -> Answer {
    let ty = info.ty;
    let refuse = |what: &str| Err(forbidden(Code::ERROR_VALIDATION_FAILURE, what));
    if ty != sys::StructureType::LOADER_INIT_INFO_ANDROID_KHR {
        return refuse("not Android's structure");
    }
    // The specification does not define a second call: some loaders keep the first context, others fail.
    if std::mem::replace(&mut world.is_initialized, true) {
        return refuse("it is initialised already");
    }
    DONE
}
