//! Sessions and their frames. Each function has the contract of its OpenXR counterpart.

use std::sync::Arc;
use std::time::Instant;

use openxr_sys as sys;
use sys::ViewConfigurationType as ViewsOf;

use crate::binding::Binding;
use crate::dispatch::{XrResult, check};
use crate::instance::Instance;
use crate::objects::{self, LiveSession};
use crate::session::Session;
use crate::{frame, lock, log_line};

pub unsafe fn create(
    instance: &Arc<Instance>,
    info: *const sys::SessionCreateInfo,
    created: *mut sys::Session,
) -> XrResult<sys::Result> {
    // SAFETY: the application's arguments. After a success, the runtime has read and written them.
    unsafe {
        let result = check((instance.next.create_session)(instance.handle, info, created))?;
        let binding = Binding::of(&*info);
        objects::add_session(Session::new(*created, Arc::clone(instance), binding, (*info).system_id));
        Ok(result)
    }
}

/// Drops everything that was created for a session, before the runtime destroys it.
pub fn forget(live: &LiveSession) {
    lock(&live.frames).end(&live.session);
    objects::remove_session(live.session.handle);
}

pub unsafe fn destroy(live: &LiveSession) -> XrResult<sys::Result> {
    forget(live);
    // SAFETY: the application's own call.
    Ok(unsafe { (live.session.instance.next.destroy_session)(live.session.handle) })
}

pub unsafe fn begin(live: &LiveSession, info: *const sys::SessionBeginInfo) -> XrResult<sys::Result> {
    let session = &live.session;
    let (begin, name) = (session.instance.next.begin_session, &session.instance.application);
    let other = session.instance.settings.dominant.other().name();
    // SAFETY: the application's arguments.
    unsafe {
        let kind = (*info).primary_view_configuration_type;
        let (two, four) = (ViewsOf::PRIMARY_STEREO, ViewsOf::PRIMARY_STEREO_WITH_FOVEATED_INSET);
        if [two, four].contains(&kind) && session.shrinks() {
            let result = check(begin(session.handle, info))?;
            session.begin(if kind == two { 2 } else { 4 });
            let images = if kind == two { "a tiny image" } else { "two tiny images" };
            log_line(format_args!("{name}: renders {images} for the {other} eye, which is synthesized"));
            return Ok(result);
        }
        if kind != ViewsOf::PRIMARY_MONO || !session.offers_mono {
            if kind == ViewsOf::PRIMARY_MONO {
                log_line(format_args!("{name}: passed through: the system itself has one view, not two"));
            } else {
                log_line(format_args!(
                    "{name}: passed through: it begins its session with {kind:?}, not with one view"
                ));
            }
            session.begin(0);
            return Ok(begin(session.handle, info));
        }
        let stereo =
            sys::SessionBeginInfo { primary_view_configuration_type: ViewsOf::PRIMARY_STEREO, ..*info };
        let result = check(begin(session.handle, &stereo))?;
        session.begin(1);
        log_line(format_args!("{name}: renders one view; the {other} eye is synthesized"));
        Ok(result)
    }
}

pub unsafe fn begin_frame(live: &LiveSession, info: *const sys::FrameBeginInfo) -> XrResult<sys::Result> {
    let session = &live.session;
    // SAFETY: the application's own call.
    let result = unsafe { (session.instance.next.begin_frame)(session.handle, info) };
    *lock(&session.begun) = Some(Instant::now());
    Ok(result)
}

pub unsafe fn end_frame(live: &LiveSession, info: *const sys::FrameEndInfo) -> XrResult<sys::Result> {
    // SAFETY: the application's arguments.
    unsafe {
        let info = info.as_ref().ok_or(sys::Result::ERROR_VALIDATION_FAILURE)?;
        let swapchains = objects::swapchains_of(live.session.handle);
        frame::end_frame(&live.session, &live.frames, &swapchains, info)
    }
}
