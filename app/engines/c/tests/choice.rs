//! The choice between two renders and one with synthesis, as a C program makes it.

mod common;

use std::ptr;

use common::{messages, zeroed};
use yoro_c::*;

/// Runs frames at 90 Hz with these GPU times, which become known three frames later. Returns the last choice.
fn run(chooser: *mut YoroChooser, cost_ms: [f32; 2], first: YoroWay, frames: u32) -> YoroChoice {
    let mut choice: YoroChoice = zeroed(|choice: &mut YoroChoice| &mut choice.struct_size);
    (choice.next, choice.is_measuring) = (first, 1);
    let mut rendered = Vec::new();
    for number in 0..frames {
        let mut end: YoroFrameEnd = zeroed(|end: &mut YoroFrameEnd| &mut end.struct_size);
        rendered.push(choice.next);
        (end.rendered, end.now_ns, end.refresh_hz) = (choice.next, i64::from(number) * 11_111_111, 90.0);
        if number >= 3 {
            end.cost_frames_ago = 3;
            end.cost_ms = cost_ms[rendered[number as usize - 3] as usize];
        }
        // SAFETY: a chooser that is alive, and structures of the sizes that they state.
        assert_eq!(unsafe { yoro_chooser_end_frame(chooser, &end, &mut choice) }, YORO_OK);
    }
    choice
}

#[test]
fn a_program_in_c_learns_which_way_is_cheaper() {
    for (cost_ms, cheaper) in [([8.9, 6.1], YORO_WAY_SYNTHESIS), ([6.1, 8.9], YORO_WAY_TWO_VIEWS)] {
        let mut chooser = ptr::null_mut();
        // SAFETY: the pointer is writable.
        assert_eq!(unsafe { yoro_chooser_create(YORO_WAY_SYNTHESIS, &mut chooser) }, YORO_OK);
        let early = run(chooser, cost_ms, YORO_WAY_SYNTHESIS, 60);
        assert_eq!((early.is_measuring, early.reason, early.cost_ms), (1, YORO_REASON_UNMEASURED, [0.0; 2]));
        // SAFETY: the chooser is alive.
        assert_eq!(unsafe { yoro_chooser_scene_changed(chooser) }, YORO_OK);
        let choice = run(chooser, cost_ms, early.next, 180);
        assert_eq!((choice.is_measuring, choice.reason), (0, YORO_REASON_CHEAPER));
        assert_eq!((choice.next, choice.chosen), (cheaper, cheaper));
        let close = |(a, b): (&f32, f32)| (a - b).abs() < 1e-3;
        assert!(choice.cost_ms.iter().zip(cost_ms).all(close), "{:?}", choice.cost_ms);
        // SAFETY: the chooser is alive, and not used again.
        unsafe { yoro_chooser_destroy(chooser) };
    }
}

#[test]
fn wrong_arguments_are_sentences() {
    // SAFETY: NULL is allowed.
    unsafe { yoro_chooser_destroy(ptr::null_mut()) };
    let mut chooser = ptr::dangling_mut();
    // SAFETY: the pointer is writable, or is NULL.
    unsafe {
        assert_eq!(yoro_chooser_create(YORO_WAY_OTHER, &mut chooser), YORO_ERROR_VALUE);
        assert!(chooser.is_null());
        assert_eq!(yoro_chooser_create(YORO_WAY_SYNTHESIS, ptr::null_mut()), YORO_ERROR_NULL);
        assert_eq!(yoro_chooser_scene_changed(ptr::null_mut()), YORO_ERROR_NULL);
        assert_eq!(yoro_chooser_create(YORO_WAY_SYNTHESIS, &mut chooser), YORO_OK);
    }
    let mut noted = Vec::new();
    let mut told = |change: fn(&mut YoroFrameEnd), chooser: *mut YoroChooser| {
        let mut end: YoroFrameEnd = zeroed(|end: &mut YoroFrameEnd| &mut end.struct_size);
        end.messages = messages(&mut noted);
        change(&mut end);
        let mut choice: YoroChoice = zeroed(|choice: &mut YoroChoice| &mut choice.struct_size);
        // SAFETY: a chooser that is alive or NULL, and structures of the sizes that they state.
        let code = unsafe { yoro_chooser_end_frame(chooser, &end, &mut choice) };
        (code, noted.pop().map(|(_, sentence)| sentence).unwrap_or_default())
    };
    for (change, code, part) in [
        ((|end| end.rendered = 3) as fn(&mut YoroFrameEnd), YORO_ERROR_VALUE, "YORO_WAY_"),
        (|end| end.refresh_hz = f32::NAN, YORO_ERROR_VALUE, "refresh_hz"),
        (|end| end.cost_ms = -1.0, YORO_ERROR_VALUE, "cost_ms"),
        (|end| (end.has_heat, end.heat) = (1, f32::INFINITY), YORO_ERROR_VALUE, "has_heat"),
        (|end| end.reserved = 1, YORO_ERROR_VALUE, "reserved"),
    ] {
        let (got, sentence) = told(change, chooser);
        assert!(got == code && sentence.contains(part), "{got}: {sentence}");
    }
    let (code, sentence) = told(|_| {}, ptr::null_mut());
    assert!(code == YORO_ERROR_NULL && sentence.contains("chooser"), "{code}: {sentence}");
    let stays = told(|end| end.rendered = YORO_WAY_OTHER, chooser);
    assert_eq!(stays, (YORO_OK, String::new()));
    // SAFETY: the chooser is alive, and not used again.
    unsafe { yoro_chooser_destroy(chooser) };
}
