//! The application's mistakes: it gets the runtime's own verdict, as without the layer, and what comes after them is
//! stereo.

use openxr_sys as sys;
use sys::{Handle as _, Result as Code, ViewConfigurationType as ViewsOf};
use yoro_openxr_stub::script::{At, Event, Script, What};

use crate::checks::assert_seen;
use crate::client::{Client, DEPTH, Failure, Layer, Outcome, Part, Planes, Submitted};
use crate::habits::{
    Chains, D32, Habits, SRGB, begin_rendered, begin_session, frames, run, run_shrunk, watched_session,
};
use crate::harness::Gpu;
use crate::world::{faulty, script, watched, with_gpu};

fn refused<T>(call: &'static str, result: Code) -> Outcome<T> {
    Err(Failure { call, result })
}

/// Runs a session with one view, in which two frames follow the mistakes.
fn synthesized_after(gpu: &Gpu, what: &str, mistakes: impl FnOnce(&mut Client, &Chains) -> Outcome<()>) {
    let habits = Habits::PLAIN;
    let seen = watched_session(gpu, script(), &habits, |client, chains| {
        mistakes(client, chains)?;
        frames(client, chains, &habits, 2)
    });
    assert_eq!(seen.counts(), [[2, 0]], "{what}: {}", seen.layer_log);
    assert_seen(&seen, &habits, what);
}

/// While the layer holds a release back, the runtime would accept another one.
#[test]
fn an_image_is_released_once() {
    with_gpu(|gpu| {
        synthesized_after(gpu, "released twice", |client, chains| {
            for chain in [&chains.color, &chains.depth] {
                client.acquire(chain)?;
                client.release(chain)?;
                for _ in 0..2 {
                    assert_eq!(
                        client.release(chain),
                        refused("xrReleaseSwapchainImage", Code::ERROR_CALL_ORDER_INVALID)
                    );
                    assert_eq!(
                        client.wait_image(chain),
                        refused("xrWaitSwapchainImage", Code::ERROR_CALL_ORDER_INVALID)
                    );
                }
            }
            Ok(())
        });
        // Errors of a held release that would return for ever are returned once.
        for result in [Code::ERROR_CALL_ORDER_INVALID, Code::ERROR_HANDLE_INVALID] {
            let seen = watched_session(
                gpu,
                faulty("xrReleaseSwapchainImage", 3, result),
                &Habits::PLAIN,
                |client, chains| {
                    let (begun, submitted) = begin_rendered(client, chains, &Habits::PLAIN)?;
                    assert_eq!(client.show(begun, submitted), refused("xrEndFrame", result));
                    let begun = client.begin_frame()?;
                    client.end_frame(begun, &[])
                },
            );
            assert_eq!(seen.calls().get("xrReleaseSwapchainImage"), Some(&4), "{result:?}");
        }
    });
}

#[test]
fn a_refused_begin_changes_nothing() {
    with_gpu(|gpu| {
        synthesized_after(gpu, "begun again", |client, _| {
            for views in [ViewsOf::PRIMARY_STEREO, ViewsOf::PRIMARY_MONO] {
                assert_eq!(client.begin(views), refused("xrBeginSession", Code::ERROR_SESSION_RUNNING));
            }
            Ok(())
        });
        let habits = Habits::PLAIN;
        let seen = watched(script(), || {
            let mut client = Client::new(gpu, habits.name, &[DEPTH]).unwrap();
            client.create_session().unwrap();
            let other = client.begin(ViewsOf::PRIMARY_STEREO_WITH_FOVEATED_INSET);
            assert_eq!(other, refused("xrBeginSession", Code::ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED));
            client.poll().unwrap();
            let chains = Chains::new(&client, &habits).unwrap();
            frames(&mut client, &chains, &habits, 2).unwrap();
            client.destroy_session().unwrap();
        });
        assert_eq!(
            (seen.counts(), seen.count_in_log("passed through")),
            (vec![[2, 0]], 0),
            "{}",
            seen.layer_log
        );
    });
}

/// Every kind of session: with one view, with a tiny one, and passed through.
#[test]
fn null_pointers_and_wrong_types_are_refused() {
    with_gpu(|gpu| {
        let kinds = [
            ("right", ViewsOf::PRIMARY_MONO),
            ("shrink", ViewsOf::PRIMARY_STEREO),
            ("right", ViewsOf::PRIMARY_STEREO),
        ];
        for (name, views) in kinds {
            let what = format!("{name}, {views:?}");
            watched(Script { visibility_mask: true, ..script() }, || {
                let mut client = Client::new(gpu, name, &[DEPTH, c"XR_KHR_visibility_mask"]).unwrap();
                client.views = views;
                client.start_session().unwrap();
                let chain = client.chain(SRGB, [64; 2], 1).unwrap();
                let begun = client.begin_frame().unwrap();
                for (call, result) in client.calls_with_null(begun, &chain) {
                    assert_eq!(result, Code::ERROR_VALIDATION_FAILURE, "{what}: {call}");
                }
                let passed = (name, views) == kinds[2];
                for (call, result) in client.calls_with_wrong_types(begun) {
                    assert_eq!(result, Code::ERROR_VALIDATION_FAILURE, "{what}: {call}");
                }
                // Masks for all views or for none.
                let count = if views == ViewsOf::PRIMARY_MONO { 1 } else { 2 };
                for view in 0..count {
                    assert_eq!(
                        client.mask_size(view, 1),
                        Ok(if passed { 3 } else { 0 }),
                        "{what}: view {view}"
                    );
                }
                for (view, kind) in [(count, 1), (0, 0), (0, 9)] {
                    assert_eq!(client.mask_size(view, kind), Err(Code::ERROR_VALIDATION_FAILURE), "{what}");
                }
                client.end_frame(begun, &[]).unwrap();
            });
        }
    });
}

/// A runtime that takes depth judges it, even if nothing can be synthesized from it. The log gives the reason once.
#[test]
fn the_runtime_judges_depth() {
    type Spoil = fn(Part, Planes) -> (Part, Planes);
    let cases: [(&str, Code, Spoil); 7] = [
        ("depth is in no swapchain", Code::ERROR_HANDLE_INVALID, |part, planes| {
            (Part { chain: sys::Swapchain::NULL, ..part }, planes)
        }),
        ("lies beyond its swapchain", Code::ERROR_SWAPCHAIN_RECT_INVALID, |part, planes| {
            (Part { origin: [1, 0], ..part }, planes)
        }),
        ("lies beyond its swapchain", Code::ERROR_VALIDATION_FAILURE, |part, planes| {
            (Part { layer: 1, ..part }, planes)
        }),
        ("out of order", Code::ERROR_VALIDATION_FAILURE, |part, planes| {
            (part, Planes { min: 0.5, max: 0.5, ..planes })
        }),
        ("out of order", Code::ERROR_VALIDATION_FAILURE, |part, planes| {
            (part, Planes { min: 0.9, max: 0.1, ..planes })
        }),
        ("the depth planes are out of order", Code::ERROR_VALIDATION_FAILURE, |part, planes| {
            (part, Planes { near: 0.0, ..planes })
        }),
        ("the depth planes are out of order", Code::ERROR_VALIDATION_FAILURE, |part, planes| {
            (part, Planes { near: planes.far, ..planes })
        }),
    ];
    with_gpu(|gpu| {
        let habits = Habits::PLAIN;
        for (reason, verdict, spoil) in cases {
            for takes_depth in [true, false] {
                let missing = if takes_depth { vec![] } else { vec![DEPTH.to_str().unwrap().to_owned()] };
                let script = Script { missing_extensions: missing, ..script() };
                let seen = watched_session(gpu, script, &habits, |client, chains| {
                    for _ in 0..2 {
                        let (begun, submitted) = begin_rendered(client, chains, &habits)?;
                        let depth = submitted.depth.map(|(part, planes)| spoil(part, planes));
                        let shown = client.show(begun, Submitted { depth, ..submitted });
                        let expected = if takes_depth { refused("xrEndFrame", verdict) } else { Ok(()) };
                        assert_eq!(shown, expected, "{reason}");
                        if shown.is_err() {
                            client.end_frame(begun, &[])?;
                        }
                    }
                    Ok(())
                });
                seen.says_once("the same image for both eyes");
                seen.says_once(reason);
                assert_eq!(seen.frames().len(), if takes_depth { 0 } else { 2 }, "{reason}");
            }
        }
    });
}

/// With `shrink`, mistakes in the view that the layer would replace reach the runtime.
#[test]
fn the_runtime_judges_the_replaced_view() {
    type Spoil = fn(&mut Submitted, &Client);
    let cases: [(Code, Spoil); 5] = [
        (Code::ERROR_HANDLE_INVALID, |tiny, _| tiny.color.chain = sys::Swapchain::NULL),
        (Code::ERROR_LAYER_INVALID, |tiny, client| {
            tiny.color.chain = client.chain(SRGB, tiny.color.size, 1).unwrap().handle;
        }),
        (Code::ERROR_SWAPCHAIN_RECT_INVALID, |tiny, _| tiny.color.size[0] += 1),
        (Code::ERROR_VALIDATION_FAILURE, |tiny, _| tiny.color.layer = 1),
        (Code::ERROR_POSE_INVALID, |tiny, _| tiny.view = tiny.view.without_orientation()),
    ];
    with_gpu(|gpu| {
        for (verdict, spoil) in cases {
            let habits = Habits { name: "shrink", ..Habits::PLAIN };
            let seen = watched(script(), || {
                run_shrunk(gpu, &habits, 2, |client, begun, [tiny, own]| {
                    let mut wrong = tiny;
                    spoil(&mut wrong, client);
                    let shown = client.end_frame(begun, &[Layer::Projection(vec![wrong, own])]);
                    assert_eq!(shown, refused("xrEndFrame", verdict));
                    // The releases have been passed on.
                    client.end_frame(begun, &[Layer::Projection(vec![tiny, own])])
                })
                .unwrap();
            });
            assert_eq!(seen.frames().len(), 2, "{verdict:?}: {}", seen.layer_log);
        }
    });
}

/// Static images are acquired once, an ended session has no frames, and an instance that fails does not block the next.
#[test]
fn the_order_of_calls_is_the_runtimes() {
    with_gpu(|gpu| {
        let habits = Habits::PLAIN;
        let ends = Event { at: At::Frame(3), what: What::Exit };
        watched(Script { events: vec![ends], ..script() }, || {
            let mut client = Client::new(gpu, habits.name, &[DEPTH]).unwrap();
            let chains = begin_session(&mut client, &habits).unwrap();
            let still = client.static_chain(D32, [64; 2]).unwrap();
            client.acquire(&still).unwrap();
            client.release(&still).unwrap();
            assert_eq!(
                client.acquire(&still),
                refused("xrAcquireSwapchainImage", Code::ERROR_CALL_ORDER_INVALID)
            );
            let mut last = None;
            while client.is_running() {
                let (begun, submitted) = begin_rendered(&mut client, &chains, &habits).unwrap();
                client.show(begun, submitted).unwrap();
                last = Some((begun, submitted));
                client.poll().unwrap();
            }
            let (begun, submitted) = last.unwrap();
            for count in [1, 2] {
                let shown = client.end_frame(begun, &[Layer::Projection(vec![submitted; count])]);
                assert_eq!(shown, refused("xrEndFrame", Code::ERROR_SESSION_NOT_RUNNING), "{count} views");
            }
            client.destroy_session().unwrap();
        });
        watched(faulty("xrGetInstanceProcAddr", 5, Code::ERROR_FUNCTION_UNSUPPORTED), || {
            let made = Client::new(gpu, habits.name, &[DEPTH]).err();
            assert_eq!(
                made,
                Some(Failure { call: "xrCreateInstance", result: Code::ERROR_FUNCTION_UNSUPPORTED })
            );
            drop(run(gpu, &habits).unwrap());
        });
    });
}
