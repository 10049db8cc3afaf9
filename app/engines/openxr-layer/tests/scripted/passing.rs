//! Calls that pass through, and what the application is offered.

use openxr_sys as sys;
use sys::ViewConfigurationType as ViewsOf;
use yoro_openxr_stub::log;
use yoro_openxr_stub::script::{At, Event, Script, What};

use crate::checks::{assert_own_eyes, assert_seen, psnr, truth};
use crate::client::{Client, DEPTH, Failure, Layer};
use crate::habits::{
    Chains, Habits, begin_rendered, begin_session, frames, learn_size, render, run, run_shrunk,
    watched_session,
};
use crate::world::{faulty, script, watched, with_gpu};

/// An application that renders both views gets the runtime's own. Its layers and depth arrive unchanged.
#[test]
fn stereo_passes_through() {
    with_gpu(|gpu| {
        let habits = Habits::PLAIN;
        let seen = watched(script(), || {
            let mut client = Client::new(gpu, habits.name, &[DEPTH]).unwrap();
            client.views = ViewsOf::PRIMARY_STEREO;
            assert_eq!(client.sizes().unwrap(), [[128, 128]; 2]);
            client.start_session().unwrap();
            let chains = [Chains::new(&client, &habits).unwrap(), Chains::new(&client, &habits).unwrap()];
            for _ in 0..3 {
                client.poll().unwrap();
                let frame = client.begin_frame().unwrap();
                let views = client.locate(frame).unwrap();
                let mut submitted = Vec::new();
                for (chains, view) in chains.iter().zip(views) {
                    submitted.push(render(&mut client, chains, &habits, view.unwrap()).unwrap());
                }
                client.end_frame(frame, &[Layer::Projection(submitted)]).unwrap();
            }
            client.destroy_session().unwrap();
        });
        assert!(seen.violations().is_empty(), "{:?}", seen.violations());
        assert!(seen.views().iter().all(|view| view.depth.is_some()));
        assert_own_eyes(&seen, &script(), 0.0, "stereo");
        for (i, view) in seen.views().iter().enumerate() {
            assert!(psnr(&seen.picture(i), &truth(view, 1)) > 45.0);
        }
        seen.says_once("passed through: it begins its session with PRIMARY_STEREO");
        assert_eq!(seen.counts(), [[0; 2]; 0]);
    });
}

/// The setting `offer` gives the position of the one view in the list. It replaces the runtime's own configuration with
/// one view. If the runtime does not have two views, only its own configurations are offered.
#[test]
fn one_view_is_offered_where_the_runtime_has_two() {
    use ViewsOf as V;
    let cases = [
        ("right", true, vec![V::PRIMARY_MONO, V::PRIMARY_STEREO]),
        ("last", true, vec![V::PRIMARY_STEREO, V::PRIMARY_MONO]),
        ("only", true, vec![V::PRIMARY_MONO]),
        ("only", false, vec![V::PRIMARY_MONO]),
    ];
    with_gpu(|gpu| {
        for (name, stereo, want) in cases {
            for mono in [true, false] {
                let want = if stereo || mono { want.clone() } else { vec![] };
                watched(Script { stereo, mono, ..script() }, || {
                    let client = Client::new(gpu, name, &[DEPTH]).unwrap();
                    assert_eq!(client.configurations().unwrap(), want);
                    if want.contains(&V::PRIMARY_MONO) {
                        // The layer's view is as wide as both eyes, and the runtime's own is as wide as one.
                        assert_eq!(client.sizes().unwrap()[0][0] > 128, stereo, "{name}");
                    }
                });
            }
        }
    });
}

#[test]
fn the_runtime_fills_what_is_chained_to_views() {
    with_gpu(|gpu| {
        for (name, views, count) in [
            ("right", ViewsOf::PRIMARY_MONO, 1),
            ("left", ViewsOf::PRIMARY_MONO, 1),
            ("shrink", ViewsOf::PRIMARY_STEREO, 2),
        ] {
            watched(script(), || {
                let mut client = Client::new(gpu, name, &[DEPTH]).unwrap();
                client.views = views;
                assert_eq!(client.chained_depth_ranges(count).unwrap(), vec![[0.1, 50.0]; count], "{name}");
                // The rendered view's field of view is that of both eyes.
                let [left, right] = script().eyes.map(|eye| eye.fov_degrees);
                let both = [left[0].min(right[0]), left[1].max(right[1])].map(f32::to_radians);
                assert_eq!(client.chained_fields_of_view(count).unwrap()[count - 1], both, "{name}");
                client.start_session().unwrap();
                let frame = client.begin_frame().unwrap();
                let located = client.chained_to_located(frame, count).unwrap();
                assert_eq!(located, vec![[0.1, 50.0]; count], "{name}: located");
            });
        }
    });
}

/// Some systems, such as handheld ones, have only one view.
#[test]
fn a_system_with_one_view_passes_through() {
    with_gpu(|gpu| {
        let habits = Habits::PLAIN;
        let script = Script { stereo: false, ..script() };
        let seen = watched(script, || drop(run(gpu, &habits).unwrap()));
        assert!(seen.violations().is_empty(), "{:?}", seen.violations());
        assert_eq!(seen.views().len(), 1);
        seen.says_once("passed through: the system itself has one view");
        assert!(psnr(&seen.picture(0), &truth(&seen.views()[0], 1)) > 45.0);
    });
}

/// Functions of extensions create swapchains that the layer does not see, such as those for Android surfaces.
#[test]
fn calls_with_unknown_swapchains_reach_the_runtime() {
    with_gpu(|gpu| {
        let seen = watched(script(), || {
            let mut client = Client::new(gpu, Habits::PLAIN.name, &[DEPTH]).unwrap();
            client.create_session().unwrap();
            let unknown = client.chain_below_the_layer().unwrap();
            client.acquire(&unknown).unwrap();
            client.release(&unknown).unwrap();
            client.destroy_chain(unknown).unwrap();
            client.destroy_session().unwrap();
        });
        assert!(seen.violations().is_empty(), "{:?}", seen.violations());
    });
}

/// With `shrink`, the layer cannot tell whether such an image could be shown, so the runtime gets the application's views.
#[test]
fn a_view_to_replace_in_an_unknown_swapchain_reaches_the_runtime() {
    with_gpu(|gpu| {
        let habits = Habits { name: "shrink", ..Habits::PLAIN };
        let seen = watched(script(), || {
            run_shrunk(gpu, &habits, 2, |client, begun, [mut tiny, own]| {
                let unknown = client.chain_below_the_layer()?;
                client.acquire(&unknown)?;
                client.release(&unknown)?;
                tiny.color.chain = unknown.handle;
                client.end_frame(begun, &[Layer::Projection(vec![tiny, own])])
            })
            .unwrap();
        });
        assert!(seen.violations().is_empty(), "{:?}", seen.violations());
        assert_eq!((seen.frames().len(), seen.counts().len()), (2, 0), "{}", seen.layer_log);
        seen.says_once("passed through: the view to replace is in no");
    });
}

/// XR_KHR_vulkan_enable lets the runtime use the queue in xrReleaseSwapchainImage, but not in xrWaitSwapchainImage.
#[test]
fn waiting_for_an_image_releases_no_other_one() {
    with_gpu(|gpu| {
        let failed = sys::Result::ERROR_RUNTIME_FAILURE;
        watched_session(
            gpu,
            faulty("xrReleaseSwapchainImage", 1, failed),
            &Habits::PLAIN,
            |client, chains| {
                client.acquire_only(&chains.color)?;
                client.acquire_only(&chains.color)?;
                client.wait_image(&chains.color)?;
                // The runtime's error shows in which call the release was passed on.
                let released = client.release(&chains.color);
                assert_eq!(released, Err(Failure { call: "xrReleaseSwapchainImage", result: failed }));
                client.release(&chains.color)?;
                client.wait_image(&chains.color)?;
                client.release(&chains.color)
            },
        );
    });
}

/// The layer offers the extension for depth even if the runtime lacks it, and keeps the depth.
#[test]
fn a_runtime_without_depth_gets_two_views() {
    with_gpu(|gpu| {
        let habits = Habits::PLAIN;
        let missing_extensions = vec![DEPTH.to_str().unwrap().to_owned()];
        let seen = watched(Script { missing_extensions, ..script() }, || drop(run(gpu, &habits).unwrap()));
        // The runtime only complains about the extension that it lacks.
        assert!(
            matches!(&seen.violations()[..], [log::Entry::Violation { call, .. }] if call == "xrCreateInstance"),
            "{:?}",
            seen.violations()
        );
        assert_eq!(seen.counts(), [[3, 0]], "{}", seen.layer_log);
        assert_seen(&seen, &habits, "without depth");
        assert!(seen.views().iter().all(|view| view.depth.is_none()));
    });
}

/// A view configuration that is offered can be located in a session of another. With `offer = "only"` no other is known.
#[test]
fn what_is_offered_can_be_located() {
    with_gpu(|gpu| {
        let [one, two] = [ViewsOf::PRIMARY_MONO, ViewsOf::PRIMARY_STEREO];
        for (name, mono) in [("right", false), ("shrink", false), ("right", true), ("shrink", true)] {
            watched(Script { mono, ..script() }, || {
                let mut client = Client::new(gpu, name, &[DEPTH]).unwrap();
                client.views = two;
                client.start_session().unwrap();
                let frame = client.begin_frame().unwrap();
                client.views = one;
                let width = client.locate(frame).unwrap()[0].unwrap().frustum.width();
                // The layer's view is wider than the runtime's own, whether that has one or not.
                let [left, right, ..] = script().eyes[0].fov_degrees.map(|angle| angle.to_radians().tan());
                assert!(width > 1.01 * (right - left), "{name}: {width}");
            });
        }
        let seen = watched(script(), || {
            let refused =
                |call| Failure { call, result: sys::Result::ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED };
            let mut client = Client::new(gpu, "only", &[DEPTH]).unwrap();
            client.create_session().unwrap();
            assert_eq!(client.begin(two), Err(refused("xrBeginSession")));
            client.poll().unwrap();
            let frame = client.begin_frame().unwrap();
            client.views = two;
            assert_eq!(client.locate(frame), Err(refused("xrLocateViews")));
            assert_eq!(client.sizes(), Err(refused("xrEnumerateViewConfigurationViews")));
        });
        assert!(seen.violations().is_empty(), "{:?}", seen.violations());
    });
}

/// With `offer = "off"` an application is left alone, whatever the other settings are: the runtime receives the
/// application's calls and no others.
#[test]
fn an_application_can_be_left_alone() {
    with_gpu(|gpu| {
        use ViewsOf as V;
        let seen = watched(script(), || {
            let mut client = Client::new(gpu, "off", &[DEPTH]).unwrap();
            assert_eq!(client.configurations().unwrap(), [V::PRIMARY_STEREO, V::PRIMARY_MONO]);
            client.views = V::PRIMARY_STEREO;
            assert_eq!(client.sizes().unwrap(), [[128, 128]; 2]);
            client.start_session().unwrap();
            let chain = client.chain(crate::habits::SRGB, [128; 2], 1).unwrap();
            client.destroy_chain(chain).unwrap();
            client.destroy_session().unwrap();
        });
        assert!(seen.violations().is_empty(), "{:?}", seen.violations());
        seen.says_once("passed through: its settings say offer = off");
        for call in
            ["xrCreateReferenceSpace", "xrEnumerateSwapchainImages", "xrEnumerateViewConfigurationViews"]
        {
            assert_eq!(seen.calls().get(call), Some(&1), "{call}");
        }
        assert_eq!(seen.calls().get("xrLocateViews"), None);
    });
}

/// Functions and events of extensions that refer to a view configuration or to a layer of views.
#[test]
fn extensions_know_the_offered_view() {
    with_gpu(|gpu| {
        let habits = Habits::PLAIN;
        learn_size(gpu, habits.name);
        let event = Event { at: At::Frame(3), what: What::MaskChanged };
        let seen = watched(Script { mono: false, events: vec![event], ..script() }, || {
            let extensions =
                [DEPTH, c"XR_MSFT_composition_layer_reprojection", c"XR_META_recommended_layer_resolution"];
            let mut client = Client::new(gpu, habits.name, &extensions).unwrap();
            let [one, two] = [ViewsOf::PRIMARY_MONO, ViewsOf::PRIMARY_STEREO];
            assert_eq!(client.reprojection_modes(one).unwrap(), client.reprojection_modes(two).unwrap());
            let chains = begin_session(&mut client, &habits).unwrap();
            frames(&mut client, &chains, &habits, 1).unwrap();
            let (begun, submitted) = begin_rendered(&mut client, &chains, &habits).unwrap();
            client.show(begun, submitted).unwrap();
            // The runtime recommends three quarters of an eye's size.
            let [width, height] = client.sizes().unwrap()[0].map(|n| (n * 3).div_ceil(4) as i32);
            assert!(width > 128 * 3 / 4);
            assert_eq!(client.recommended_layer_size(begun, submitted).unwrap(), [width, height]);
            frames(&mut client, &chains, &habits, 2).unwrap();
            client.poll().unwrap();
            assert_eq!(client.masks, [(one, 0)]);
            client.destroy_session().unwrap();
        });
        assert!(seen.violations().is_empty(), "{:?}", seen.violations());
    });
}

#[test]
fn a_function_that_is_not_found_is_null() {
    with_gpu(|gpu| {
        watched(script(), || {
            let client = Client::new(gpu, Habits::PLAIN.name, &[DEPTH]).unwrap();
            let (result, function) = client.function_without_an_instance(c"xrWaitFrame");
            assert_eq!(result, sys::Result::ERROR_HANDLE_INVALID);
            assert!(function.is_none());
        });
    });
}
