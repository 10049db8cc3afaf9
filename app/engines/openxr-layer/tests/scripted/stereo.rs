//! Two views made from one.

use openxr_sys as sys;
use sys::ViewConfigurationType as ViewsOf;
use yoro::vulkan::ash::vk;
use yoro_openxr_stub::log;
use yoro_openxr_stub::script::{Insets, Script};

use crate::checks::{
    assert_counts, assert_depth, assert_own_eyes, assert_seen, assert_sessions, assert_synthesized,
    frustum_of, pose_of, psnr, truth, views_of,
};
use crate::client::{Client, DEPTH, Failure, Layer, Part, Planes, Submitted};
use crate::drawing::{Drawing, with_gles};
use crate::habits::{
    Chains, D32, Habits, SRGB, begin_rendered, frames, learn_size, render, run, run_shrunk, watched_session,
};
use crate::world::{faulty, script, watched, with_gpu};

#[test]
fn one_view_becomes_the_two_views_of_the_runtime() {
    let plain = Habits::PLAIN;
    let depth = |near, far, min, max| Habits { planes: Planes { near, far, min, max }, ..plain };
    let cases = [
        ("plain", plain),
        ("the left eye rendered", Habits { name: "left", ..plain }),
        ("one layer of an array", Habits { layers: [2, 1], ..plain }),
        ("a part of the image", Habits { margin: [13, 7], layers: [3, 2], ..plain }),
        ("another size", Habits { scale: 1.31, ..plain }),
        ("a smaller size", Habits { scale: 0.77, margin: [1, 2], ..plain }),
        ("resolved samples", Habits { samples: 2, ..plain }),
        ("16 bits of depth", Habits { formats: [SRGB, vk::Format::D16_UNORM], ..plain }),
        ("depth with stencil", Habits { formats: [SRGB, vk::Format::D32_SFLOAT_S8_UINT], ..plain }),
        ("linear colour", Habits { formats: [vk::Format::R8G8B8A8_UNORM, D32], ..plain }),
        ("near and far swapped", depth(100.0, 0.1, 0.0, 1.0)),
        ("infinite far", depth(0.1, f32::INFINITY, 0.0, 1.0)),
        ("infinite near", depth(f32::INFINITY, 0.05, 0.0, 1.0)),
        ("a part of the depth's range", depth(0.1, 50.0, 0.25, 0.75)),
        ("a part of it, swapped", depth(f32::INFINITY, 0.1, 0.5, 1.0)),
    ];
    with_gpu(|gpu| {
        ["left", "right"].iter().for_each(|name| learn_size(gpu, name));
        for (what, habits) in cases {
            let mut client = None;
            let script = script();
            let seen = watched(script.clone(), || client = Some(run(gpu, &habits).unwrap()));
            assert_counts(&seen, &[[3, 0]], what);
            let pixels = if habits.scale == 1.0 { 0.0 } else { 1.0 / habits.scale };
            assert_own_eyes(&seen, &script, pixels, what);
            assert_seen(&seen, &habits, what);
            assert_depth(&seen, &habits, what);
            if habits.scale == 1.0 && (habits.planes.min, habits.planes.max) == (0.0, 1.0) {
                assert_synthesized(gpu, &seen, client.as_ref().unwrap(), &habits, what);
            }
        }
    });
}

/// Eyes of headsets may be canted outwards, and have frusta of different heights.
#[test]
fn canted_and_unequal_eyes_are_served_by_parallel_ones() {
    with_gpu(|gpu| {
        for name in ["left", "right"] {
            let habits = Habits { name, ..Habits::PLAIN };
            let mut canted = script();
            canted.eyes.iter_mut().for_each(|eye| eye.cant_degrees = 5.0);
            let mut unequal = script();
            unequal.eyes[1].fov_degrees = [-40.0, 50.0, 44.0, -53.0];
            for (what, script) in [("canted", canted), ("unequal", unequal)] {
                let seen = watched(script.clone(), || drop(run(gpu, &habits).unwrap()));
                assert_sessions(&seen, &habits, &[[3, 0]], what);
                // The submitted view contains that of the runtime's own eye, to a pixel.
                for (i, view) in seen.views().iter().enumerate() {
                    let eye = script.eyes[i];
                    let turn = [1.0, -1.0][i] * eye.cant_degrees.to_radians();
                    let frustum = frustum_of(view);
                    let [left, right, up, down] = eye.fov_degrees.map(|angle| angle.to_radians().tan());
                    for (x, y) in [(left, up), (left, down), (right, up), (right, down)] {
                        let ray = glam::Quat::from_rotation_y(turn) * glam::Vec3::new(x, y, -1.0);
                        let (x, y) = (ray.x / -ray.z, ray.y / -ray.z);
                        let inside = x > frustum.left - 0.02
                            && x < frustum.right + 0.02
                            && y > frustum.bottom - 0.02
                            && y < frustum.top + 0.02;
                        assert!(inside, "{what}: eye {i} does not see {x}, {y}: {frustum:?}");
                    }
                }
            }
        }
    });
}

#[test]
fn other_layers_stay_as_they_are_and_in_order() {
    with_gpu(|gpu| {
        let habits = Habits::PLAIN;
        let seen = watched_session(gpu, script(), &habits, |client, chains| {
            let panel = client.chain(SRGB, [32, 16], 1)?;
            frames(client, chains, &habits, 1)?;
            let (frame, submitted) = begin_rendered(client, chains, &habits)?;
            client.acquire(&panel)?;
            client.release(&panel)?;
            let part = |x| Part { chain: panel.handle, origin: [x, 0], size: [8, 16], layer: 0 };
            let layers = [
                Layer::Quad(part(0)),
                Layer::Projection(vec![submitted]),
                Layer::Quad(part(8)),
                // This layer is not synthesized, but shown.
                Layer::Projection(vec![Submitted { depth: None, ..submitted }]),
                Layer::Quad(part(16)),
            ];
            client.end_frame(frame, &layers)
        });
        assert!(seen.violations().is_empty(), "{:?}", seen.violations());
        let frames = seen.frames();
        let found: Vec<_> = frames
            .last()
            .unwrap()
            .iter()
            .map(|layer| match layer {
                log::Layer::Projection { views } if views[0].image == views[1].image => {
                    "the same twice".into()
                }
                log::Layer::Projection { views } => format!("{} views", views.len()),
                log::Layer::Quad { image } => format!("quad {}", image.rect[0]),
            })
            .collect();
        assert_eq!(found, ["quad 0", "2 views", "quad 8", "the same twice", "quad 16"]);
        seen.says_once("submits more than one projection layer");
    });
}

/// With `shrink`, an application that begins in stereo renders one tiny view.
#[test]
fn shrink_replaces_the_tiny_view() {
    with_gpu(|gpu| {
        let habits = Habits { name: "shrink", ..Habits::PLAIN };
        let shrunk = || {
            watched(script(), || {
                let show = |client: &mut Client, frame, both: [Submitted; 2]| {
                    client.end_frame(frame, &[Layer::Projection(both.into())])
                };
                run_shrunk(gpu, &habits, 3, show).unwrap();
            })
        };
        // The first start has an estimate of the size.
        shrunk();
        let seen = shrunk();
        assert_counts(&seen, &[[3, 0]], "a tiny view");
        seen.says_once("renders a tiny image for the left eye");
        assert_own_eyes(&seen, &script(), 0.0, "a tiny view");
        assert_seen(&seen, &habits, "a tiny view");
        assert_depth(&seen, &habits, "a tiny view");
    });
}

/// With `shrink`, an application that begins with four views renders two of them tiny, and the insets follow the gaze.
#[test]
fn shrink_replaces_the_two_tiny_views_of_four() {
    with_gpu(|gpu| {
        for (what, cant_degrees) in [("two of four", 0.0), ("two of four that are canted", 5.0)] {
            let habits = Habits { name: "shrink", ..Habits::PLAIN };
            // At last the insets are in the corner of the eyes' views.
            let gaze = vec![(0, [0.0, 0.0]), (4, [18.0, -9.0]), (6, [60.0, 20.0])];
            let insets = Some(Insets { size: [96; 2], radius_degrees: 15.0, gaze });
            let mut script = Script { insets, ..script() };
            script.eyes.iter_mut().for_each(|eye| eye.cant_degrees = cant_degrees);
            let seen = watched(script, || {
                let mut client = Client::new(gpu, habits.name, &[DEPTH, c"XR_VARJO_quad_views"]).unwrap();
                client.views = ViewsOf::PRIMARY_STEREO_WITH_FOVEATED_INSET;
                client.start_session().unwrap();
                let sizes = client.sizes().unwrap();
                assert_eq!([sizes[0], sizes[2]], [[16; 2]; 2], "{what}");
                assert!(sizes[1][0] > 128 && sizes[1][1] >= 128, "{what}: {sizes:?}");
                assert!(sizes[3][0] > 96 && sizes[3][1] >= 96, "{what}: {sizes:?}");
                let chains: Vec<Chains> =
                    sizes.iter().map(|size| Chains::of_size(&client, *size).unwrap()).collect();
                for _ in 0..8 {
                    client.poll().unwrap();
                    let frame = client.begin_frame().unwrap();
                    let views = client.locate(frame).unwrap().map(Option::unwrap).into_iter();
                    let all = views
                        .zip(&chains)
                        .map(|(view, chains)| render(&mut client, chains, &habits, view).unwrap())
                        .collect();
                    client.end_frame(frame, &[Layer::Projection(all)]).unwrap();
                }
                client.destroy_session().unwrap();
            });
            assert_counts(&seen, &[[8, 0]], what);
            seen.says_once("renders two tiny images for the left eye");
            let views = seen.views();
            assert_eq!(views.len(), 4, "{what}");
            for (i, view) in views.iter().enumerate() {
                let quality = psnr(&seen.picture(i), &truth(view, 1));
                println!("{what}: view {i}: {:?}: {quality:.1} dB", view.fov_degrees);
                assert!(quality > [31.0, 45.0][i % 2], "{what}: view {i}: {quality} dB");
            }
            assert_depth(&seen, &habits, what);
            let gazes: Vec<f32> =
                seen.frames().iter().map(|layers| views_of(layers)[3].fov_degrees[0]).collect();
            assert!(gazes.windows(2).filter(|two| two[0] < two[1]).count() >= 5, "{what}: {gazes:?}");
        }
    });
}

/// The log gives the reason once, and counts the frames.
#[test]
fn a_view_that_cannot_be_synthesized_is_shown_to_both_eyes() {
    let plain = Habits::PLAIN;
    let cases = [
        ("it submits no depth", Habits { submits_depth: false, ..plain }, [0; 2]),
        ("have different sizes or rectangles", Habits { margin: [4, 4], ..plain }, [1, 0]),
    ];
    with_gpu(|gpu| {
        for (reason, habits, left) in cases {
            let seen = watched_session(gpu, script(), &habits, |client, chains| {
                for _ in 0..3 {
                    let (frame, submitted) = begin_rendered(client, chains, &habits)?;
                    let depth = submitted.depth.map(|(part, planes)| {
                        let origin = [0, 1].map(|i| part.origin[i] - left[i]);
                        (Part { origin, ..part }, planes)
                    });
                    client.show(frame, Submitted { depth, ..submitted })?;
                }
                Ok(())
            });
            assert!(seen.violations().is_empty(), "{reason}: {:?}", seen.violations());
            seen.says_once("the same image for both eyes");
            seen.says_once(reason);
            assert_eq!(seen.counts(), [[0, 3]], "{reason}: {}", seen.layer_log);
            let views = seen.views();
            assert_eq!(
                (&views[0].image, views[0].position),
                (&views[1].image, views[1].position),
                "{reason}"
            );
            // The runtime gets whatever depth there is.
            assert!(views.iter().all(|view| view.depth.is_some() == habits.submits_depth), "{reason}");
            assert!(psnr(&seen.picture(0), &truth(&views[0], 1)) > 45.0, "{reason}");
        }
    });
}

/// The application waits for the next frame before the last one ends, and releases images before their frame begins.
#[test]
fn overlapping_frames_are_synthesized() {
    with_gpu(|gpu| {
        let habits = Habits::PLAIN;
        let seen = watched_session(gpu, script(), &habits, |client, chains| {
            let mut now = client.begin_frame()?;
            for _ in 0..5 {
                let view = client.locate(now)?[0].unwrap();
                let submitted = render(client, chains, &habits, view)?;
                let next = client.wait_frame()?;
                client.show(now, submitted)?;
                client.begin_waited()?;
                now = next;
            }
            let view = client.locate(now)?[0].unwrap();
            client.end_frame(now, &[])?;
            let early = render(client, chains, &habits, view)?;
            let frame = client.begin_frame()?;
            client.show(frame, early)
        });
        assert_sessions(&seen, &habits, &[[6, 0]], "overlapping frames");
    });
}

/// If the application acquires the next image before the frame ends, the runtime receives the last one, and the layer
/// cannot read it.
#[test]
fn an_image_that_the_runtime_has_is_shown_to_both_eyes() {
    with_gpu(|gpu| {
        let habits = Habits::PLAIN;
        let seen =
            watched_session(gpu, Script { acquires_ahead: true, ..script() }, &habits, |client, chains| {
                let (begun, submitted) = begin_rendered(client, chains, &habits)?;
                let ahead = client.acquire(&chains.color)?;
                client.show(begun, submitted)?;
                let begun = client.begin_frame()?;
                client.show(begun, submitted)?;
                client.copy_color(ahead, chains.part);
                client.release(&chains.color)?;
                frames(client, chains, &habits, 2)
            });
        assert_counts(&seen, &[[2, 2]], "acquired ahead");
        seen.says_once("was not released since the last frame");
        assert_seen(&seen, &habits, "afterwards");
    });
}

/// Applications that run at half the display's rate, and those with static images, submit an image more than once.
#[test]
fn an_image_that_is_shown_again_stays_stereo() {
    with_gpu(|gpu| {
        for name in ["left", "right"] {
            let habits = Habits { name, ..Habits::PLAIN };
            let seen = watched_session(
                gpu,
                Script { acquires_ahead: true, ..script() },
                &habits,
                |client, chains| {
                    for _ in 0..3 {
                        let (begun, submitted) = begin_rendered(client, chains, &habits)?;
                        client.show(begun, submitted)?;
                        let begun = client.begin_frame()?;
                        client.show(begun, submitted)?;
                    }
                    // The next image is acquired, and the old one is shown at another place.
                    let (begun, submitted) = begin_rendered(client, chains, &habits)?;
                    client.show(begun, submitted)?;
                    client.acquire(&chains.color)?;
                    let begun = client.begin_frame()?;
                    let moved =
                        Submitted { view: submitted.view.at(glam::Vec3::new(0.5, 0.25, 1.0)), ..submitted };
                    client.show(begun, moved)?;
                    // Different planes make it a different view.
                    let begun = client.begin_frame()?;
                    let planes = Planes { near: 0.2, ..Planes::PLAIN };
                    let depth = submitted.depth.map(|(part, _)| (part, planes));
                    client.show(begun, Submitted { depth, ..submitted })
                },
            );
            assert_counts(&seen, &[[8, 1]], name);
            let frames: Vec<_> = seen.frames().into_iter().map(|layers| views_of(layers)).collect();
            for pair in frames[..8].chunks_exact(2) {
                let images = |views: &[log::View]| [0, 1].map(|eye| views[eye].image.clone());
                assert_eq!(images(pair[0]), images(pair[1]), "{name}");
                assert_ne!(pair[1][0].image, pair[1][1].image, "{name}");
                assert!(pair[1].iter().all(|view| view.depth.is_some()), "{name}");
            }
            assert_eq!(frames[4], frames[5], "{name}");
            for (from, to) in frames[6].iter().zip(frames[7]) {
                let moved = pose_of(to).position - pose_of(from).position;
                assert!((moved - glam::Vec3::new(0.5, 0.25, 1.0)).length() < 1e-5, "{name}: {moved}");
            }
        }
    });
}

#[test]
fn the_layers_swapchains_follow_new_sizes_and_formats() {
    with_gpu(|gpu| {
        let habits = Habits::PLAIN;
        let seen = watched_session(gpu, script(), &habits, |client, chains| {
            frames(client, chains, &habits, 2)?;
            for (scale, format) in [(1.5, SRGB), (0.5, SRGB), (0.5, vk::Format::B8G8R8A8_UNORM), (1.0, SRGB)]
            {
                let habits = Habits { scale, formats: [format, D32], ..habits };
                let chains = Chains::new(client, &habits)?;
                frames(client, &chains, &habits, 2)?;
                client.destroy_chain(chains.color)?;
                client.destroy_chain(chains.depth)?;
            }
            frames(client, chains, &habits, 2)
        });
        assert_sessions(&seen, &habits, &[[12, 0]], "the first size again");
    });
}

/// Runs applications whose images are flipped by their fields of view, by an extension, or by both.
fn flipped(drawing: Drawing, script: &Script, name: &'static str) {
    let plain = Habits { name, margin: [3, 5], ..Habits::PLAIN };
    let upside_down = Habits { upside_down: true, ..plain };
    for (what, habits) in [
        ("to the sides", Habits { flips: [true, false], ..plain }),
        ("upside down", Habits { flips: [false, true], ..plain }),
        ("both", Habits { flips: [true, true], ..plain }),
        ("by the layer", upside_down),
        ("by the layer and to the sides", Habits { flips: [true, false], ..upside_down }),
        ("upside down twice", Habits { flips: [false, true], ..upside_down }),
    ] {
        let what = format!("{name}, {what}");
        let mut script = script.clone();
        // The field of view is not vertically symmetric.
        script.eyes.iter_mut().for_each(|eye| eye.fov_degrees[2] = 35.0);
        let seen = watched(script, || drop(run(drawing, &habits).unwrap()));
        assert_counts(&seen, &[[3, 0]], &what);
        for view in seen.views() {
            let [left, right, up, down] = view.fov_degrees;
            assert_eq!([left > right, down > up], habits.flips, "{what}");
        }
        assert_seen(&seen, &habits, &what);
        if matches!(drawing, Drawing::Vulkan(_)) {
            assert_depth(&seen, &habits, &what);
        }
    }
}

/// A field of view whose left edge is to the right of its right edge, or whose lower edge is above its upper edge,
/// flips the image, and so does an extension.
#[test]
fn flipped_views_are_synthesized() {
    with_gpu(|gpu| ["left", "right"].into_iter().for_each(|name| flipped(gpu.into(), &script(), name)));
}

/// In OpenGL, rows are counted from the bottom.
#[test]
fn flipped_views_are_synthesized_on_opengl_es() {
    let script = Script { formats: Script::default().formats, ..script() };
    with_gles(|gles| flipped(gles.into(), &script, "right"));
}

/// The application gets the error of a mistake from xrEndFrame, as without the layer, and can end the frame again.
#[test]
fn a_frame_that_is_ended_again_is_still_stereo() {
    with_gpu(|gpu| {
        let habits = Habits::PLAIN;
        let refused = |result| Err(Failure { call: "xrEndFrame", result });
        let seen = watched_session(gpu, script(), &habits, |client, chains| {
            // A count of layers without layers, in the first frame and in a later one.
            for _ in 0..2 {
                let begun = client.begin_frame()?;
                let mistake = client.submit(begun, 2, std::ptr::null());
                assert_eq!(mistake, refused(sys::Result::ERROR_LAYER_INVALID));
                client.end_frame(begun, &[])?;
                frames(client, chains, &habits, 2)?;
            }
            // A layer of two views in a session of one.
            let (begun, submitted) = begin_rendered(client, chains, &habits)?;
            let mistake = client.end_frame(begun, &[Layer::Projection(vec![submitted; 2])]);
            assert_eq!(mistake, refused(sys::Result::ERROR_VALIDATION_FAILURE));
            client.show(begun, submitted)?;
            // The runtime refuses it for another reason than its layers.
            let (begun, submitted) = begin_rendered(client, chains, &habits)?;
            let mistake = client.show(begun.at_another_time(), submitted);
            assert_eq!(mistake, refused(sys::Result::ERROR_TIME_INVALID));
            client.show(begun, submitted)
        });
        assert_eq!(seen.counts(), [[7, 0]], "{}", seen.layer_log);
        assert_seen(&seen, &habits, "ended again");
    });
}

/// If depth is impossible in one swapchain format, it still works in others.
#[test]
fn depth_that_fails_in_one_format_goes_on_in_another() {
    with_gpu(|gpu| {
        let habits = Habits::PLAIN;
        // The application creates two swapchains, then the layer creates one for colour and one for depth.
        let refused = faulty("xrCreateSwapchain", 4, sys::Result::ERROR_RUNTIME_FAILURE);
        let seen = watched_session(gpu, refused, &habits, |client, chains| {
            frames(client, chains, &habits, 2)?;
            let other = Habits { formats: [SRGB, vk::Format::D16_UNORM], ..habits };
            let others = Chains::new(client, &other)?;
            frames(client, &others, &other, 2)?;
            frames(client, chains, &habits, 2)
        });
        assert_counts(&seen, &[[6, 0]], "two formats of depth");
        let frames = seen.frames();
        let with_depth = frames.iter().map(|layers| views_of(layers).iter().all(|view| view.depth.is_some()));
        assert_eq!(with_depth.collect::<Vec<_>>(), [false, false, true, true, false, false]);
        seen.says_once("does not go on to the runtime");
    });
}

/// A subsampled image needs a special sampler.
#[test]
fn subsampled_images_are_shown_to_both_eyes() {
    with_gpu(|gpu| {
        let habits = Habits::PLAIN;
        let seen = watched_session(gpu, script(), &habits, |client, chains| {
            let color = client.subsampled_chain(SRGB, chains.part.size)?;
            let part = Part { chain: color.handle, ..chains.part };
            let depth = client.chain(D32, part.size, 1)?;
            frames(client, &Chains { color, depth, part }, &habits, 2)
        });
        assert_counts(&seen, &[[0, 2]], "subsampled");
        seen.says_once("subsampled");
    });
}
