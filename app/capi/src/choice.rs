//! The choice between two renders and one with synthesis.

use std::ptr;

use yoro::choice::{Choice, Chooser, Cost, FrameEnd, Reason, Way};

use crate::result::{Failure, YORO_ERROR_NULL, YoroMessages, YoroResult, catch_errors};
use crate::versioned::{self, versioned};

/// A way to make both eyes of a frame, which is also its index in arrays of two.
pub type YoroWay = u32;
/// Both eyes are rendered.
pub const YORO_WAY_TWO_VIEWS: YoroWay = 0;
/// One eye is rendered, the other synthesized.
pub const YORO_WAY_SYNTHESIS: YoroWay = 1;
/// Something else, such as both eyes rendered because synthesis was not possible: the frame counts for no way.
pub const YORO_WAY_OTHER: YoroWay = 2;

/// The reason for a choice.
pub type YoroReason = u32;
/// Nothing is measured yet in this scene: it is the way to begin with, or the one before.
pub const YORO_REASON_UNMEASURED: YoroReason = 0;
/// It costs less.
pub const YORO_REASON_CHEAPER: YoroReason = 1;
/// It costs more, but too little for a change: it is the way before.
pub const YORO_REASON_SIMILAR: YoroReason = 2;
/// It holds the display's rate, and the other way does not.
pub const YORO_REASON_HOLDS_RATE: YoroReason = 3;
/// Both ways hold the display's rate, which hides their costs, and nothing more is known: it is the way before.
pub const YORO_REASON_BOTH_HOLD_RATE: YoroReason = 4;
/// One of the ways could not be measured: it is the way before.
pub const YORO_REASON_INCOMPARABLE: YoroReason = 5;

/// Finds out whether two renders are cheaper on this device, or one with synthesis: it renders both in turns for about
/// a second, chooses, and measures again when that may have changed.
///
/// Use it from one thread at a time. It needs no YoroContext.
pub struct YoroChooser {
    chooser: Chooser,
}

/// A frame that was handed to the display.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct YoroFrameEnd {
    /// sizeof(YoroFrameEnd).
    pub struct_size: u32,
    /// The way in which the frame was rendered.
    pub rendered: YoroWay,
    /// The time now, in nanoseconds of a monotonic clock.
    pub now_ns: i64,
    /// Refreshes of the display per second; 0 if unknown, or if the display did not set the pace of this frame, as when
    /// you waited for the GPU to measure it.
    pub refresh_hz: f32,
    /// Milliseconds that a frame has taken; 0 if none are known by now. The GPU's time, if there is a timer; else the
    /// time from the beginning of the frame's work to the end of the GPU's, if you wait for that.
    pub cost_ms: f32,
    /// The frame that took cost_ms, as the number of frames ended since: 0 for this one. 63 at most.
    pub cost_frames_ago: u32,
    /// 1 if heat is known.
    pub has_heat: u32,
    /// The device's heat on a scale on which 0.1 matters, such as Android's thermal headroom.
    pub heat: f32,
    /// Zero.
    pub reserved: u32,
    /// Where the sentences of errors go.
    pub messages: YoroMessages,
}

versioned!(YoroFrameEnd);

/// The way to render, and why.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct YoroChoice {
    /// sizeof(YoroChoice), set by the caller.
    pub struct_size: u32,
    /// The way to render the next frame.
    pub next: YoroWay,
    /// 1 while both ways are being measured. Keep resolution and quality meanwhile.
    pub is_measuring: u32,
    /// The way that was chosen last.
    pub chosen: YoroWay,
    /// Why.
    pub reason: YoroReason,
    /// The compared times in milliseconds, by way; 0 if there was nothing to compare.
    pub cost_ms: [f32; 2],
}

versioned!(YoroChoice);

fn null(what: &str) -> Failure {
    Failure::new(
        YORO_ERROR_NULL,
        format!("{what} is NULL: give a YoroChooser, or a pointer that receives it"),
    )
}

/// Returns the way of a constant; `None` for another one.
fn way(value: YoroWay) -> Result<Option<Way>, Failure> {
    match value {
        YORO_WAY_TWO_VIEWS => Ok(Some(Way::TwoViews)),
        YORO_WAY_SYNTHESIS => Ok(Some(Way::Synthesis)),
        YORO_WAY_OTHER => Ok(None),
        _ => Err(Failure::value(format!("{value} is no way: give a YORO_WAY_ constant"))),
    }
}

/// Creates a chooser.
///
/// Call it from any thread.
///
/// @param first   The way to begin with, which stays if nothing can be measured: YORO_WAY_TWO_VIEWS or
/// YORO_WAY_SYNTHESIS. @param chooser Receives the chooser; NULL after an error. @pre chooser can be written. @return
/// YORO_ERROR_VALUE, YORO_ERROR_NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_chooser_create(first: YoroWay, chooser: *mut *mut YoroChooser) -> YoroResult {
    catch_errors(|_| {
        if chooser.is_null() {
            return Err(null("chooser"));
        }
        // SAFETY: the header asks for a pointer that can be written.
        unsafe { chooser.write(ptr::null_mut()) };
        let first = way(first)?.ok_or_else(|| {
            Failure::value("first is no way to begin with: give YORO_WAY_TWO_VIEWS or YORO_WAY_SYNTHESIS")
        })?;
        let made = Box::new(YoroChooser { chooser: Chooser::new(first) });
        // SAFETY: as above.
        unsafe { chooser.write(Box::into_raw(made)) };
        Ok(())
    })
}

/// Takes a frame that was handed to the display, and says how to render the next one. It allocates nothing. The first
/// frame is rendered in the way that yoro_chooser_create was given.
///
/// @param chooser The chooser. @param frame   The frame. @param choice  Filled in; the caller sets struct_size. @pre
/// chooser is alive, and no other thread uses it. The others lead to structures of the size that they state. @return
/// YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE; YORO_ERROR_VALUE for an unknown way, negative numbers and numbers that are
/// not finite: such a frame is not counted.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_chooser_end_frame(
    chooser: *mut YoroChooser,
    frame: *const YoroFrameEnd,
    choice: *mut YoroChoice,
) -> YoroResult {
    catch_errors(|messages| {
        // SAFETY: the header asks for pointers to structures of the size that they state.
        let frame = unsafe { versioned::read(frame, "frame") }?;
        *messages = frame.messages;
        // SAFETY: as above.
        unsafe { versioned::check_output(choice, "choice") }?;
        // SAFETY: the header asks for a chooser that is alive and used by no other thread.
        let Some(YoroChooser { chooser }) = (unsafe { chooser.as_mut() }) else {
            return Err(null("chooser"));
        };
        chooser.end_frame(&frame.checked()?);
        // SAFETY: as above.
        unsafe { versioned::write(choice, "choice", &YoroChoice::of(chooser)) }
    })
}

/// Has both ways measured again: there is another scene, another place in it, or another resolution.
///
/// @param chooser The chooser.
/// @pre chooser is alive, and no other thread uses it.
/// @return YORO_ERROR_NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_chooser_scene_changed(chooser: *mut YoroChooser) -> YoroResult {
    catch_errors(|_| {
        // SAFETY: the header asks for a chooser that is alive and used by no other thread.
        let Some(YoroChooser { chooser }) = (unsafe { chooser.as_mut() }) else {
            return Err(null("chooser"));
        };
        chooser.scene_changed();
        Ok(())
    })
}

/// Destroys a chooser. NULL is allowed, and does nothing.
///
/// @param chooser The chooser, or NULL.
/// @pre chooser is alive, and no other thread uses it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_chooser_destroy(chooser: *mut YoroChooser) {
    if !chooser.is_null() {
        // SAFETY: `yoro_chooser_create` has made it, and the header asks that it is alive.
        drop(unsafe { Box::from_raw(chooser) });
    }
}

impl YoroFrameEnd {
    fn checked(&self) -> Result<FrameEnd, Failure> {
        versioned::check_reserved("frame", &[self.reserved])?;
        for (name, number) in [("refresh_hz", self.refresh_hz), ("cost_ms", self.cost_ms)] {
            if !(number >= 0.0 && number.is_finite()) {
                return Err(Failure::value(format!(
                    "{name} is {number}: give a number from 0, or 0 if it is unknown"
                )));
            }
        }
        if self.has_heat > 1 || (self.has_heat == 1 && !self.heat.is_finite()) {
            return Err(Failure::value("has_heat is 1 for a heat that is a number, else 0"));
        }
        let cost = Cost { frames_ago: self.cost_frames_ago, ms: self.cost_ms };
        Ok(FrameEnd {
            now_ns: self.now_ns,
            refresh_hz: self.refresh_hz,
            rendered: way(self.rendered)?,
            cost: (self.cost_ms > 0.0).then_some(cost),
            heat: (self.has_heat == 1).then_some(self.heat),
        })
    }
}

impl YoroChoice {
    fn of(chooser: &Chooser) -> YoroChoice {
        let Choice { way, reason, costs_ms } = chooser.choice();
        YoroChoice {
            struct_size: size_of::<YoroChoice>() as u32,
            next: chooser.way().index() as YoroWay,
            is_measuring: chooser.is_measuring().into(),
            chosen: way.index() as YoroWay,
            reason: match reason {
                Reason::Unmeasured => YORO_REASON_UNMEASURED,
                Reason::Cheaper => YORO_REASON_CHEAPER,
                Reason::Similar => YORO_REASON_SIMILAR,
                Reason::HoldsRate => YORO_REASON_HOLDS_RATE,
                Reason::BothHoldRate => YORO_REASON_BOTH_HOLD_RATE,
                Reason::Incomparable => YORO_REASON_INCOMPARABLE,
            },
            cost_ms: costs_ms.unwrap_or_default(),
        }
    }
}
