//! Faults of the runtime, and lost sessions and instances.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, mpsc};
use std::thread;
use std::time::Duration;

use openxr_sys as sys;
use yoro_openxr_stub::log::Entry;
use yoro_openxr_stub::script::{At, Event, Fault, Script, State, What};

use crate::checks::{assert_counts, assert_seen, assert_sessions};
use crate::client::{Client, DEPTH, Failure, Outcome};
use crate::habits::{Habits, SRGB, begin_session, frames, run, until_over, watched_session};
use crate::world::{faulty, script, watched, with_gpu};

/// When a function of the runtime fails, once or from then on, only the application's call of the same name may fail,
/// as without the layer. After a single failure everything is synthesized again.
#[test]
fn no_fault_of_the_runtime_fails_another_call() {
    with_gpu(|gpu| {
        let habits = Habits { frames: 2, ..Habits::PLAIN };
        let quiet = |faults| Script { faults, pictures: None, ..script() };
        let all = watched(quiet(vec![]), || drop(run(gpu, &habits).unwrap())).calls();
        // Functions that the layer does not intercept, or that are called before it exists.
        let not = [
            "xrCreateInstance",
            "xrDestroyInstance",
            "xrGetInstanceProcAddr",
            "xrGetSystem",
            "xrGetVulkanGraphicsRequirements2KHR",
            "xrPollEvent",
        ];
        let making = ["xrCreateSwapchain", "xrEnumerateSwapchainImages"];
        let (mut own, mut passed) = (0, 0);
        for (call, count) in all.iter().filter(|(call, _)| !not.contains(&call.as_str())) {
            for (nth, and_later) in (1..=*count).flat_map(|nth| [(nth, false), (nth, true)]) {
                let result = sys::Result::ERROR_RUNTIME_FAILURE.into_raw();
                let fault = Fault { call: call.clone(), nth, and_later, result };
                let what = format!("{call}, {nth}{}", if and_later { " and later" } else { "" });
                let mut outcome = Ok(());
                let seen = watched(quiet(vec![fault]), || {
                    outcome = run(gpu, &Habits { frames: 4, ..habits }).map(|_| ());
                });
                match outcome {
                    Err(Failure { call: failed, result: got }) => {
                        // A release that is held back returns its error in xrEndFrame.
                        let late = call == "xrReleaseSwapchainImage" && failed == "xrEndFrame";
                        assert!(failed == call || late, "{what}: {failed} fails: {}", seen.layer_log);
                        assert_eq!(got.into_raw(), result, "{what}");
                        passed += 1;
                    }
                    Ok(()) => {
                        assert!(seen.violations().is_empty(), "{what}: {:?}", seen.violations());
                        let counts = seen.counts();
                        assert_eq!(counts.iter().flatten().sum::<u64>(), 4, "{what}: {}", seen.layer_log);
                        let synthesized = seen.views()[0].image != seen.views()[1].image;
                        // Swapchains that the layer could not create in a readable form remain unreadable.
                        let lasts = and_later || making.contains(&call.as_str());
                        assert!(synthesized || lasts, "{what}: {}", seen.layer_log);
                        assert_eq!(
                            seen.count_in_log("the same image for both eyes") > 0,
                            counts[0][1] > 0,
                            "{}",
                            seen.layer_log
                        );
                        own += 1;
                    }
                }
            }
        }
        println!("{own} faults that the application does not notice, {passed} that are its own");
        assert!(own > 20 && passed > 20, "{own} {passed}");
    });
}

/// If the runtime refuses the two views, the layers are submitted again as the application rendered them. A late
/// runtime is not waited for.
#[test]
fn a_refused_or_late_runtime_costs_one_frame() {
    with_gpu(|gpu| {
        let cases = [
            ("xrEndFrame", 3, sys::Result::ERROR_LAYER_INVALID, "xrEndFrame fails with ERROR_LAYER_INVALID"),
            ("xrEndFrame", 3, sys::Result::ERROR_POSE_INVALID, "xrEndFrame fails with ERROR_POSE_INVALID"),
            // In each frame, the application waits for colour and depth, and then the layer does.
            ("xrWaitSwapchainImage", 7, sys::Result::TIMEOUT_EXPIRED, "the GPU or the runtime is late"),
            ("xrWaitSwapchainImage", 8, sys::Result::TIMEOUT_EXPIRED, "the GPU or the runtime is late"),
        ];
        for (call, nth, result, reason) in cases {
            let habits = Habits { frames: 4, ..Habits::PLAIN };
            let seen = watched(faulty(call, nth, result), || drop(run(gpu, &habits).unwrap()));
            assert_counts(&seen, &[[3, 1]], reason);
            seen.says_once(reason);
            assert_seen(&seen, &habits, reason);
        }
    });
}

/// The application continues with a new session.
#[test]
fn sessions_and_instances_can_be_lost_in_every_state() {
    with_gpu(|gpu| {
        let states = [State::Idle, State::Ready, State::Synchronized, State::Visible, State::Focused];
        let ends =
            [What::LoseSession, What::LoseInstance, What::SessionLossPending, What::Exit, What::TakeOff(2)];
        for (state, end) in states.iter().flat_map(|state| ends.iter().map(move |end| (*state, end))) {
            // An application that has to begin and to end at the same time cannot do both correctly.
            if matches!(end, What::Exit | What::TakeOff(_)) && state < State::Synchronized {
                continue;
            }
            let what = format!("{end:?} in {state:?}");
            let habits = Habits::PLAIN;
            let event = Event { at: At::State(state), what: end.clone() };
            let seen = watched(Script { events: vec![event], pictures: None, ..script() }, || {
                for session in 0..2 {
                    let mut client = Client::new(gpu, habits.name, &[DEPTH]).unwrap();
                    let mut life = || -> Outcome<()> {
                        let chains = begin_session(&mut client, &habits)?;
                        until_over(&mut client, &chains, &habits, 12)
                    };
                    if let Err(Failure { result, .. }) = life() {
                        let loss = [sys::Result::ERROR_SESSION_LOST, sys::Result::ERROR_INSTANCE_LOST];
                        assert!(session == 0 && loss.contains(&result), "{what}: {result:?}");
                    }
                    // A lost session must still be destroyed.
                    client.destroy_session().unwrap();
                }
            });
            assert!(seen.violations().is_empty(), "{what}: {:?}", seen.violations());
            let counts = seen.counts();
            let [synthesized, not] = counts.last().unwrap();
            assert!(*synthesized > 8 && *not == 0, "{what}: {}", seen.layer_log);
        }
    });
}

/// If a session will be lost soon, every call says so and succeeds.
#[test]
fn a_session_stays_stereo_until_it_is_lost() {
    with_gpu(|gpu| {
        let habits = Habits::PLAIN;
        let event = Event { at: At::Frame(1), what: What::SessionLossPending };
        let seen =
            watched_session(gpu, Script { events: vec![event], ..script() }, &habits, |client, chains| {
                frames(client, chains, &habits, 5)
            });
        assert_sessions(&seen, &habits, &[[5, 0]], "before the loss");
    });
}

/// A release that the layer held back fails in xrEndFrame. The frame ends, and the image is released later.
#[test]
fn a_release_that_fails_late_costs_one_frame() {
    with_gpu(|gpu| {
        let habits = Habits::PLAIN;
        let failed = sys::Result::ERROR_RUNTIME_FAILURE;
        // The layer releases its own two images first.
        let seen =
            watched_session(gpu, faulty("xrReleaseSwapchainImage", 3, failed), &habits, |client, chains| {
                let first = frames(client, chains, &habits, 1);
                assert_eq!(first, Err(Failure { call: "xrEndFrame", result: failed }));
                frames(client, chains, &habits, 3)
            });
        assert!(seen.violations().is_empty(), "{:?}", seen.violations());
        let ends = seen.log.iter().filter(|entry| matches!(entry, Entry::Frame { .. })).count();
        assert_eq!(
            (ends, seen.frames().len()),
            (6, 3),
            "two before there is a view, one without layers, three"
        );
        assert_eq!(seen.counts(), [[4, 0]], "{}", seen.layer_log);
        assert_seen(&seen, &habits, "afterwards");
    });
}

/// While the runtime is in xrEndFrame, which may wait for the compositor, another thread can destroy a swapchain.
#[test]
fn no_lock_is_held_in_the_runtimes_end_of_a_frame() {
    with_gpu(|gpu| {
        let habits = Habits::PLAIN;
        let seen = watched_session(gpu, script(), &habits, |client, chains| {
            let unused = client.chain(SRGB, [64; 2], 1)?;
            let destroy = Arc::new(client.destroyer(unused));
            let (sender, receiver) = mpsc::channel();
            let (sender, receiver) = (Mutex::new(Some(sender)), Mutex::new(receiver));
            let ended = Arc::new(AtomicBool::new(false));
            let noted = Arc::clone(&ended);
            yoro_openxr_stub::watch(Some(Arc::new(move |call: &str| {
                if call != "xrEndFrame" {
                    return;
                }
                let Some(sender) = sender.lock().unwrap().take() else { return };
                let destroy = Arc::clone(&destroy);
                thread::spawn(move || sender.send(destroy()));
                let result = receiver.lock().unwrap().recv_timeout(Duration::from_secs(10));
                noted.store(result == Ok(sys::Result::SUCCESS), Ordering::Relaxed);
            })));
            let result = frames(client, chains, &habits, 1);
            yoro_openxr_stub::watch(None);
            assert!(ended.load(Ordering::Relaxed), "the swapchain waits for the end of the frame");
            result
        });
        assert_counts(&seen, &[[1, 0]], "another thread");
    });
}
