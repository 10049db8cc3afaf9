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
    // SAFETY: the application's arguments.
    let Some(asked) = (unsafe { info.as_ref() }) else { return Ok(unsafe { begin(session.handle, info) }) };
    let kind = asked.primary_view_configuration_type;
    let runtimes = session.runtimes(kind)?;
    let views = match kind {
        ViewsOf::PRIMARY_STEREO if session.shrinks() => 2,
        ViewsOf::PRIMARY_STEREO_WITH_FOVEATED_INSET if session.shrinks() => 4,
        _ => usize::from(kind != runtimes),
    };
    let begun = sys::SessionBeginInfo { primary_view_configuration_type: runtimes, ..*asked };
    // SAFETY: the application's arguments, with the runtime's configuration.
    let result = check(unsafe { begin(session.handle, &begun) })?;
    session.begin(views);
    let other = session.instance.settings.dominant.other().name();
    let what = match (views, kind) {
        (1, _) => format!("renders one view; the {other} eye is synthesized"),
        (2, _) => format!("renders a tiny image for the {other} eye, which is synthesized"),
        (4, _) => format!("renders two tiny images for the {other} eye, which is synthesized"),
        (_, ViewsOf::PRIMARY_MONO) => "passed through: the system itself has one view, not two".to_owned(),
        _ => format!("passed through: it begins its session with {kind:?}, not with one view"),
    };
    log_line(format_args!("{name}: {what}"));
    Ok(result)
}

pub unsafe fn end(live: &LiveSession) -> XrResult<sys::Result> {
    // SAFETY: the application's own call.
    let result = check(unsafe { (live.session.instance.next.end_session)(live.session.handle) })?;
    live.session.begin(0);
    Ok(result)
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
