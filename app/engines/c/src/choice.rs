//! The choice between two renders and one with synthesis.

use std::ptr;

use yoro::choice::{Aim, Choice, Chooser, Cost, FrameEnd, Reason, StereoPath};

use crate::result::{Failure, YORO_ERROR_NULL, YoroMessages, YoroResult, catch_errors};
use crate::versioned::{self, versioned};

/// A way to produce both eyes of a frame. The value is also its index in arrays of two.
pub type YoroWay = u32;
/// Both eyes are rendered.
pub const YORO_WAY_TWO_VIEWS: YoroWay = 0;
/// One eye is rendered, the other synthesized.
pub const YORO_WAY_SYNTHESIS: YoroWay = 1;
/// Another way, such as both eyes rendered because synthesis was not possible. The frame counts for neither way.
pub const YORO_WAY_OTHER: YoroWay = 2;

/// The reason for a choice.
pub type YoroReason = u32;
/// Nothing has been measured in this scene yet. The initial way, or the one chosen before, is kept.
pub const YORO_REASON_UNMEASURED: YoroReason = 0;
/// The chosen way costs less.
pub const YORO_REASON_CHEAPER: YoroReason = 1;
/// The chosen way costs more, but too little more to justify a change. It is kept.
pub const YORO_REASON_SIMILAR: YoroReason = 2;
/// The chosen way reaches the display's refresh rate, and the other does not.
pub const YORO_REASON_HOLDS_RATE: YoroReason = 3;
/// Both ways reach the display's refresh rate, which hides their costs, and nothing else is known. The way is kept.
pub const YORO_REASON_BOTH_HOLD_RATE: YoroReason = 4;
/// One of the ways could not be measured. The way is kept.
pub const YORO_REASON_INCOMPARABLE: YoroReason = 5;

/// Finds out whether two renders or one render with synthesis is cheaper on this device. It alternates between them for
/// about a second, chooses, and measures again when the result may have changed.
///
/// Use it from one thread at a time. It needs no YoroContext.
pub struct YoroChooser {
    chooser: Chooser,
}

/// A frame that was submitted to the display.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct YoroFrameEnd {
    /// sizeof(YoroFrameEnd).
    pub struct_size: u32,
    /// The way in which the frame was rendered.
    pub rendered: YoroWay,
    /// The current time of a monotonic clock, in nanoseconds.
    pub now_ns: i64,
    /// Refreshes of the display per second. 0 if unknown, or if the display did not set the pace of this frame, for
    /// example because you waited for the GPU in order to measure it.
    pub refresh_hz: f32,
    /// Milliseconds that a frame took; 0 if none are known yet. This is the GPU time if there is a timer. Otherwise, if
    /// you wait for the GPU, it is the time from the beginning of the frame's work until the GPU has finished it.
    pub cost_ms: f32,
    /// The frame that took cost_ms, as the number of frames that ended after it: 0 for this one, at most 63.
    pub cost_frames_ago: u32,
    /// 1 if `heat` is known.
    pub has_heat: u32,
    /// The device's heat on a scale on which 0.1 matters, such as Android's thermal headroom.
    pub heat: f32,
    /// Must be 0.
    pub reserved: u32,
    /// Receives error messages.
    pub messages: YoroMessages,
}

versioned!(YoroFrameEnd);

/// The way to render the next frame, and the reason.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct YoroChoice {
    /// sizeof(YoroChoice), set by the caller.
    pub struct_size: u32,
    /// The way to render the next frame.
    pub next: YoroWay,
    /// 1 while both ways are being measured. Do not change resolution or quality during this time.
    pub is_measuring: u32,
    /// The way that was chosen last.
    pub chosen: YoroWay,
    /// The reason for that choice.
    pub reason: YoroReason,
    /// The compared times in milliseconds, indexed by way; 0 if there was nothing to compare.
    pub cost_ms: [f32; 2],
}

versioned!(YoroChoice);

fn null(what: &str) -> Failure {
    Failure::new(
        YORO_ERROR_NULL,
        format!("{what} is NULL: give a YoroChooser, or a pointer that receives it"),
    )
}

/// Returns the way for a constant, or `None` for YORO_WAY_OTHER.
fn way(value: YoroWay) -> Result<Option<StereoPath>, Failure> {
    match value {
        YORO_WAY_TWO_VIEWS => Ok(Some(StereoPath::TwoViews)),
        YORO_WAY_SYNTHESIS => Ok(Some(StereoPath::Synthesis)),
        YORO_WAY_OTHER => Ok(None),
        _ => Err(Failure::value(format!("{value} is no way: give a YORO_WAY_ constant"))),
    }
}

/// Creates a chooser.
///
/// Call it from any thread.
///
/// @param first   The initial way, which is kept if nothing can be measured: YORO_WAY_TWO_VIEWS or YORO_WAY_SYNTHESIS.
/// @param chooser Receives the chooser, or NULL after an error. Destroy it with yoro_chooser_destroy.
/// @pre chooser can be written to.
/// @return YORO_ERROR_VALUE, YORO_ERROR_NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_chooser_create(first: YoroWay, chooser: *mut *mut YoroChooser) -> YoroResult {
    catch_errors(|_| {
        if chooser.is_null() {
            return Err(null("chooser"));
        }
        // SAFETY: the header requires a writable pointer.
        unsafe { chooser.write(ptr::null_mut()) };
        let first = way(first)?.ok_or_else(|| {
            Failure::value("first is no way to begin with: give YORO_WAY_TWO_VIEWS or YORO_WAY_SYNTHESIS")
        })?;
        let made = Box::new(YoroChooser { chooser: Chooser::new(Aim::Cheapest, first) });
        // SAFETY: as above.
        unsafe { chooser.write(Box::into_raw(made)) };
        Ok(())
    })
}

/// Takes a frame that was submitted to the display, and returns how to render the next one. It allocates nothing.
/// Render the first frame in the way that yoro_chooser_create was given.
///
/// @param chooser The chooser.
/// @param frame   The frame.
/// @param choice  Receives the choice. The caller sets struct_size.
/// @pre chooser is alive, and no other thread uses it. The other pointers point to structures of the sizes that they
///      state.
/// @return YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE; YORO_ERROR_VALUE for an unknown way, negative numbers and numbers
///         that are not finite: such a frame is not counted.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_chooser_end_frame(
    chooser: *mut YoroChooser,
    frame: *const YoroFrameEnd,
    choice: *mut YoroChoice,
) -> YoroResult {
    catch_errors(|messages| {
        // SAFETY: the header requires pointers to structures of the sizes that they state.
        let frame = unsafe { versioned::read(frame, "frame") }?;
        *messages = frame.messages;
        // SAFETY: as above.
        unsafe { versioned::check_output(choice, "choice") }?;
        // SAFETY: the header requires a live chooser that no other thread uses.
        let Some(YoroChooser { chooser }) = (unsafe { chooser.as_mut() }) else {
            return Err(null("chooser"));
        };
        chooser.end_frame(&frame.checked()?);
        // SAFETY: as above.
        unsafe { versioned::write(choice, "choice", &YoroChoice::of(chooser)) }
    })
}

/// Requests a new measurement of both ways, after a change of the scene, the place in it, or the resolution.
///
/// @param chooser The chooser.
/// @pre chooser is alive, and no other thread uses it.
/// @return YORO_ERROR_NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_chooser_scene_changed(chooser: *mut YoroChooser) -> YoroResult {
    catch_errors(|_| {
        // SAFETY: the header requires a live chooser that no other thread uses.
        let Some(YoroChooser { chooser }) = (unsafe { chooser.as_mut() }) else {
            return Err(null("chooser"));
        };
        chooser.scene_changed();
        Ok(())
    })
}

/// Destroys a chooser. Does nothing if it is NULL.
///
/// @param chooser The chooser, or NULL.
/// @pre chooser is alive, and no other thread uses it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn yoro_chooser_destroy(chooser: *mut YoroChooser) {
    if !chooser.is_null() {
        // SAFETY: `yoro_chooser_create` made it, and the header requires that it is alive.
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
        let Choice { path, reason, costs_ms } = chooser.choice();
        let way = |path| if path == StereoPath::TwoViews { YORO_WAY_TWO_VIEWS } else { YORO_WAY_SYNTHESIS };
        YoroChoice {
            struct_size: size_of::<YoroChoice>() as u32,
            next: way(chooser.path()),
            is_measuring: chooser.is_measuring().into(),
            chosen: way(path),
            reason: match reason {
                Reason::Unmeasured => YORO_REASON_UNMEASURED,
                Reason::Cheaper => YORO_REASON_CHEAPER,
                Reason::Similar => YORO_REASON_SIMILAR,
                Reason::HoldsRate => YORO_REASON_HOLDS_RATE,
                Reason::BothHoldRate => YORO_REASON_BOTH_HOLD_RATE,
                Reason::Incomparable => YORO_REASON_INCOMPARABLE,
            },
            cost_ms: [StereoPath::TwoViews, StereoPath::Synthesis]
                .map(|path| costs_ms[path.index()].unwrap_or_default()),
        }
    }
}
