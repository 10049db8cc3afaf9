//! The layer between a scripted application and the simulated runtime: on Vulkan under the validation layer, and on
//! OpenGL ES where that differs.

#[path = "../../../core/tests/vulkan/harness.rs"]
#[expect(dead_code, reason = "shared with the core's tests, which use all of it")]
mod harness;

mod client;
mod drawing;
mod scene;
mod world;

use openxr_sys as sys;
use sys::{Handle as _, ViewConfigurationType as ViewsOf};
use yoro::eyes::{DepthRange, Eye, EyePair, Frustum, GuardBand, Pose};
use yoro::vulkan::ash::vk;
use yoro::vulkan::{Frame, Gather, ImageState, Options, SourceImages, TargetImages};
use yoro_openxr_stub::log;
use yoro_openxr_stub::script::{At, Event, Fault, Script, State, What};

use client::{Chain, Client, DEPTH, Failure, Layer, Outcome, Part, Planes, Submitted, View};
use drawing::{Drawing, with_gles};
use harness::{Gpu, READ, WRITTEN};
use world::{Seen, allocations, script, uncounted, watched, with_gpu, with_unwatched_gpu};

const SRGB: vk::Format = vk::Format::R8G8B8A8_SRGB;
const D32: vk::Format = vk::Format::D32_SFLOAT;

/// How an application renders its frames.
#[derive(Clone, Copy, Debug)]
struct Habits {
    /// The name that it gives itself.
    name: &'static str,
    /// The size of its images in recommended sizes.
    scale: f32,
    /// Pixels of the swapchains on each side of the rendered rectangle.
    margin: [u32; 2],
    /// The number of layers of the swapchains, and the rendered one.
    layers: [u32; 2],
    formats: [vk::Format; 2],
    planes: Planes,
    /// Samples along one side of a pixel.
    samples: u32,
    submits_depth: bool,
    frames: u32,
}

impl Habits {
    const PLAIN: Habits = Habits {
        name: "right",
        scale: 1.0,
        margin: [0; 2],
        layers: [1, 0],
        formats: [SRGB, D32],
        planes: Planes::PLAIN,
        samples: 1,
        submits_depth: true,
        frames: 3,
    };

    fn dominant(&self) -> Eye {
        if self.name == "left" { Eye::Left } else { Eye::Right }
    }
}

/// The swapchains of an application with one view.
struct Chains {
    color: Chain,
    depth: Chain,
    part: Part,
}

impl Chains {
    fn new(client: &Client, habits: &Habits) -> Outcome<Chains> {
        let size = client.sizes()?[0].map(|n| (n as f32 * habits.scale) as u32);
        let whole = [0, 1].map(|i| size[i] + 2 * habits.margin[i]);
        let [layers, layer] = habits.layers;
        let [color, depth] = habits.formats;
        let (color, depth) = (client.chain(color, whole, layers)?, client.chain(depth, whole, layers)?);
        let part = Part { chain: color.handle, origin: habits.margin, size, layer };
        Ok(Chains { color, depth, part })
    }

    fn depth_part(&self) -> Part {
        Part { chain: self.depth.handle, ..self.part }
    }
}

/// Renders a view to the swapchains. Returns what is to be submitted.
fn render(client: &mut Client, chains: &Chains, habits: &Habits, view: View) -> Outcome<Submitted> {
    client.paint(view, chains.part.size, habits.samples, habits.formats, habits.planes);
    let image = client.acquire(&chains.color)?;
    uncounted(|| client.copy_color(image, chains.part));
    let mut depth = None;
    if habits.submits_depth {
        let image = client.acquire(&chains.depth)?;
        uncounted(|| client.copy_depth(image, chains.depth_part()));
        client.release(&chains.depth)?;
        depth = Some((chains.depth_part(), habits.planes));
    }
    client.release(&chains.color)?;
    Ok(Submitted { view, color: chains.part, depth })
}

/// Runs one frame. Returns true if it was to be rendered.
fn frame(client: &mut Client, chains: &Chains, habits: &Habits) -> Outcome<bool> {
    client.poll()?;
    let frame = client.begin_frame()?;
    if !frame.should_render {
        client.end_frame(frame, &[])?;
        return Ok(false);
    }
    let view = client.locate(frame)?[0].unwrap();
    let submitted = render(client, chains, habits, view)?;
    client.end_frame(frame, &[Layer::Projection(vec![submitted])])?;
    Ok(true)
}

/// Runs frames until `count` were rendered.
fn frames(client: &mut Client, chains: &Chains, habits: &Habits, count: u32) -> Outcome<()> {
    let mut rendered = 0;
    while rendered < count {
        rendered += u32::from(frame(client, chains, habits)?);
    }
    Ok(())
}

/// Runs an application that renders one view.
fn run<'a>(drawing: impl Into<Drawing<'a>>, habits: &Habits) -> Outcome<Client<'a>> {
    let mut client = Client::new(drawing, habits.name, &[DEPTH])?;
    client.create_session()?;
    client.poll()?;
    let chains = Chains::new(&client, habits)?;
    frames(&mut client, &chains, habits, habits.frames)?;
    client.destroy_session()?;
    Ok(client)
}

/// Returns the views of a frame's first projection layer.
fn views_of(layers: &[log::Layer]) -> &[log::View] {
    let mut views = layers.iter().filter_map(|layer| match layer {
        log::Layer::Projection { views } => Some(views.as_slice()),
        _ => None,
    });
    views.next().expect("there is a projection layer")
}

fn pose_of(view: &log::View) -> Pose {
    Pose { position: view.position.into(), orientation: glam::Quat::from_array(view.orientation) }
}

fn frustum_of(view: &log::View) -> Frustum {
    let [left, right, up, down] = view.fov_degrees.map(f32::to_radians);
    Frustum::from_fov(left, right, up, down)
}

/// Returns the PSNR in dB over red, green and blue.
fn psnr(a: &[u8], b: &[u8]) -> f64 {
    assert_eq!(a.len(), b.len());
    let color = |i: &usize| i % 4 != 3;
    let squares = (0..a.len()).filter(color).map(|i| f64::from(a[i].abs_diff(b[i])).powi(2));
    10.0 * (255f64.powi(2) * a.len() as f64 * 0.75 / squares.sum::<f64>()).log10()
}

/// Renders the reference of a view that was submitted to the runtime.
fn truth(view: &log::View, samples: u32) -> Vec<u8> {
    let [.., width, height] = view.image.rect.map(|n| n as u32);
    scene::render(pose_of(view), frustum_of(view), [width, height], samples).rgba
}

/// Both eyes' images must be like the references at the submitted poses.
fn assert_seen(seen: &Seen, habits: &Habits, what: &str) {
    let views = seen.views();
    assert_eq!(views.len(), 2, "{what}");
    let (own, other) = (habits.dominant().index(), habits.dominant().other().index());
    let [own, other] = [own, other].map(|eye| psnr(&seen.picture(eye), &truth(&views[eye], habits.samples)));
    println!("{what}: the dominant eye {own:.1} dB, the synthesized one {other:.1} dB");
    assert!(own > 45.0, "{what}: the dominant eye's image is none of that eye: {own} dB");
    assert!(other > 31.0, "{what}: the other eye's image is none of that eye: {other} dB");
}

/// The runtime must have both eyes' depth: in the rectangles of their colour, and like the references.
fn assert_depth(seen: &Seen, habits: &Habits, what: &str) {
    let Planes { near, far, min, max } = habits.planes;
    for (eye, view) in seen.views().iter().enumerate() {
        let depth = view.depth.as_ref().unwrap();
        assert_eq!(depth.image.rect, view.image.rect, "{what}: eye {eye}");
        assert_eq!(depth.range, [min, max], "{what}: eye {eye}");
        assert_eq!(depth.near_far, [near, far].map(|z| z.min(f32::MAX)), "{what}: eye {eye}");
        if habits.formats[1] != D32 {
            continue;
        }
        let [.., width, height] = view.image.rect.map(|n| n as u32);
        let truth = scene::render(pose_of(view), frustum_of(view), [width, height], 1).distance;
        let close = |(stored, distance): (&f32, &f32)| {
            let error = (stored - habits.planes.stored(*distance)).abs();
            // The difference of neighbouring pixels, away from silhouettes.
            error < 0.02 * (max - min) * (habits.planes.stored(0.8) - habits.planes.stored(6.0)).abs()
        };
        let got = seen.depth(eye);
        assert_eq!(got.len(), truth.len(), "{what}: eye {eye}");
        let close = got.iter().zip(&truth).filter(|pair| close(*pair)).count();
        let share = close as f64 / truth.len() as f64;
        println!("{what}: depth of eye {eye}: {share:.4} of the pixels");
        assert!(share > 0.99, "{what}: depth of eye {eye} is that of {share} of the pixels");
    }
}

/// The synthesized eye must be what the core synthesizes from the same source for the submitted views.
fn assert_synthesized(gpu: &Gpu, seen: &Seen, client: &Client, habits: &Habits, what: &str) {
    let views = seen.views();
    let painted = client.painted.as_ref().unwrap();
    let [.., width, height] = views[0].image.rect.map(|n| n as u32);
    let eyes = EyePair {
        poses: [0, 1].map(|i| pose_of(&views[i])),
        frusta: [0, 1].map(|i| frustum_of(&views[i])),
        depth: DepthRange::from_distances(habits.planes.near, habits.planes.far),
        size: [width, height],
        dominant: habits.dominant(),
    };
    let plan = eyes.synthesis(GuardBand::Pixels(16)).unwrap();
    assert_eq!(plan.source.size, painted.picture.size, "{what}");
    let options = Options {
        color_format: habits.formats[0],
        max_source_size: plan.warp.source_size,
        max_target_size: plan.warp.target_size,
        ..Options::default()
    };
    let target = gpu.image(habits.formats[0], plan.warp.target_size, 1);
    // SAFETY: the images live until the commands have ended.
    unsafe {
        let mut gather = Gather::new(&gpu.host(), &options).unwrap();
        let source = SourceImages {
            color: painted.color().layer(0, READ, READ),
            depth: painted.depth().layer(0, READ, READ),
            sample_color: None,
            size: painted.picture.size,
        };
        let source = gather.register_source(&source).unwrap();
        let color = target.layer(0, ImageState::DISCARDED, WRITTEN);
        let target = TargetImages { color, depth: None, size: plan.warp.target_size };
        let target = gather.register_target(&target).unwrap();
        let frame = Frame { source, source_origin: [0; 2], target, target_origin: [0; 2] };
        gpu.run(|commands| gather.record(commands, &frame, &plan.warp).unwrap());
    }
    let (want, got) = (target.read_rgba8(0, WRITTEN), seen.picture(habits.dominant().other().index()));
    let differs = |(a, b): &(&[u8], &[u8])| (0..3).any(|i| a[i].abs_diff(b[i]) > 2);
    let different = want.chunks_exact(4).zip(got.chunks_exact(4)).filter(differs).count();
    // Rounded angles may move pixels at silhouettes.
    assert!(different * 200 <= want.len() / 4, "{what}: {different} pixels are not the core's");
}

/// The views' poses and fields of view must be the runtime's own eyes.
fn assert_own_eyes(seen: &Seen, script: &Script, pixels: f32, what: &str) {
    for (i, view) in seen.views().iter().enumerate() {
        let side = [-1.0, 1.0][i];
        let distance = (pose_of(view).position - glam::Vec3::X * side * 0.0315).length();
        assert!(distance < 1e-4, "{what}: eye {i} is at {:?}", view.position);
        for (got, want) in view.fov_degrees.iter().zip(script.eyes[i].fov_degrees) {
            // As tangents; a pixel of the headset's is about 0.017 of them.
            let error = got.to_radians().tan() - want.to_radians().tan();
            assert!(error.abs() < 1e-3 + 0.02 * pixels, "{what}: eye {i} sees {:?}", view.fov_degrees);
        }
    }
}

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
        for (what, habits) in cases {
            let mut client = None;
            let script = script();
            let seen = watched(script.clone(), || client = Some(run(gpu, &habits).unwrap()));
            assert!(seen.violations().is_empty(), "{what}: {:?}", seen.violations());
            assert_eq!(seen.counts(), [[3, 0]], "{what}: {}", seen.said);
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

/// Eyes of headsets may be turned outwards, and have frusta of different heights.
#[test]
fn canted_and_unlike_eyes_are_served_by_parallel_ones() {
    with_gpu(|gpu| {
        for name in ["left", "right"] {
            let habits = Habits { name, ..Habits::PLAIN };
            let mut canted = script();
            canted.eyes.iter_mut().for_each(|eye| eye.cant_degrees = 5.0);
            let mut unlike = script();
            unlike.eyes[1].fov_degrees = [-40.0, 50.0, 44.0, -53.0];
            for (what, script) in [("canted", canted), ("unlike", unlike)] {
                let seen = watched(script.clone(), || drop(run(gpu, &habits).unwrap()));
                assert!(seen.violations().is_empty(), "{what}: {:?}", seen.violations());
                assert_eq!(seen.counts(), [[3, 0]], "{what}: {}", seen.said);
                assert_seen(&seen, &habits, what);
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
        let seen = watched(script(), || {
            let mut client = Client::new(gpu, habits.name, &[DEPTH]).unwrap();
            client.create_session().unwrap();
            client.poll().unwrap();
            let chains = Chains::new(&client, &habits).unwrap();
            let panel = client.chain(SRGB, [32, 16], 1).unwrap();
            frames(&mut client, &chains, &habits, 1).unwrap();
            let frame = client.begin_frame().unwrap();
            let view = client.locate(frame).unwrap()[0].unwrap();
            let submitted = render(&mut client, &chains, &habits, view).unwrap();
            client.acquire(&panel).unwrap();
            client.release(&panel).unwrap();
            let part = |x| Part { chain: panel.handle, origin: [x, 0], size: [8, 16], layer: 0 };
            let layers = [
                Layer::Quad(part(0)),
                Layer::Projection(vec![submitted]),
                Layer::Quad(part(8)),
                // This one is not synthesized, but shown.
                Layer::Projection(vec![Submitted { depth: None, ..submitted }]),
                Layer::Quad(part(16)),
            ];
            client.end_frame(frame, &layers).unwrap();
            client.destroy_session().unwrap();
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
                log::Layer::Quad { image, .. } => format!("quad {}", image.rect[0]),
                log::Layer::Other { .. } => "other".into(),
            })
            .collect();
        assert_eq!(found, ["quad 0", "2 views", "quad 8", "the same twice", "quad 16"]);
        assert_eq!(seen.said("submits more than one projection layer"), 1, "{}", seen.said);
    });
}

/// An application that renders both views gets the runtime's own; its layers and depth arrive unchanged.
#[test]
fn stereo_passes_through() {
    with_gpu(|gpu| {
        let habits = Habits::PLAIN;
        let seen = watched(script(), || {
            let mut client = Client::new(gpu, habits.name, &[DEPTH]).unwrap();
            client.views = ViewsOf::PRIMARY_STEREO;
            assert_eq!(client.sizes().unwrap(), [[128, 128]; 2]);
            client.create_session().unwrap();
            client.poll().unwrap();
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
        assert_eq!(
            seen.said("passed through: it begins its session with PRIMARY_STEREO"),
            1,
            "{}",
            seen.said
        );
        assert_eq!(seen.counts(), [[0; 2]; 0]);
    });
}

/// With `shrink`, an application that begins in stereo renders one tiny view.
#[test]
fn shrink_replaces_the_tiny_view() {
    with_gpu(|gpu| {
        let habits = Habits { name: "shrink", ..Habits::PLAIN };
        let seen = watched(script(), || {
            let mut client = Client::new(gpu, habits.name, &[DEPTH]).unwrap();
            client.views = ViewsOf::PRIMARY_STEREO;
            client.create_session().unwrap();
            client.poll().unwrap();
            let sizes = client.sizes().unwrap();
            assert!(sizes[0] == [16; 2] && sizes[1][0] > 128 && sizes[1][1] == 128, "{sizes:?}");
            let (color, depth) =
                (client.chain(SRGB, sizes[1], 1).unwrap(), client.chain(D32, sizes[1], 1).unwrap());
            let part = Part { chain: color.handle, origin: [0; 2], size: sizes[1], layer: 0 };
            let own = Chains { color, depth, part };
            let tiny = client.chain(SRGB, sizes[0], 1).unwrap();
            let part = Part { chain: tiny.handle, size: sizes[0], ..part };
            for _ in 0..3 {
                client.poll().unwrap();
                let frame = client.begin_frame().unwrap();
                let views = client.locate(frame).unwrap().map(Option::unwrap);
                let rendered = render(&mut client, &own, &habits, views[1]).unwrap();
                client.acquire(&tiny).unwrap();
                client.release(&tiny).unwrap();
                let unused = Submitted { view: views[0], color: part, depth: None };
                client.end_frame(frame, &[Layer::Projection(vec![unused, rendered])]).unwrap();
            }
            client.destroy_session().unwrap();
        });
        assert!(seen.violations().is_empty(), "{:?}", seen.violations());
        assert_eq!(seen.counts(), [[3, 0]], "{}", seen.said);
        assert_eq!(seen.said("renders a tiny image for the left eye"), 1, "{}", seen.said);
        assert_own_eyes(&seen, &script(), 0.0, "a tiny view");
        assert_seen(&seen, &habits, "a tiny view");
        assert_depth(&seen, &habits, "a tiny view");
    });
}

/// The setting `offer` says where. It replaces a runtime's own; a runtime without two views offers its own alone.
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
                        // The layer's is as wide as both eyes, the runtime's own as one.
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
            });
        }
    });
}

/// A handheld system, for example, has one view alone.
#[test]
fn a_system_with_one_view_passes_through() {
    with_gpu(|gpu| {
        let habits = Habits::PLAIN;
        let script = Script { stereo: false, ..script() };
        let seen = watched(script, || drop(run(gpu, &habits).unwrap()));
        assert!(seen.violations().is_empty(), "{:?}", seen.violations());
        assert_eq!(seen.views().len(), 1);
        assert_eq!(seen.said("passed through: the system itself has one view"), 1, "{}", seen.said);
        assert!(psnr(&seen.picture(0), &truth(&seen.views()[0], 1)) > 45.0);
    });
}

/// Functions of extensions create swapchains that the layer does not see, such as those of Android surfaces.
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

/// XR_KHR_vulkan_enable lets the runtime use the queue in xrReleaseSwapchainImage, but not in xrWaitSwapchainImage.
#[test]
fn waiting_for_an_image_releases_no_other_one() {
    with_gpu(|gpu| {
        let failed = sys::Result::ERROR_RUNTIME_FAILURE;
        let fault = Fault {
            call: "xrReleaseSwapchainImage".into(),
            nth: 1,
            and_later: false,
            result: failed.into_raw(),
        };
        watched(Script { faults: vec![fault], ..script() }, || {
            let work = |client: &mut Client, chains: &Chains| {
                client.acquire_only(&chains.color)?;
                client.acquire_only(&chains.color)?;
                client.wait_image(&chains.color)?;
                // The runtime's error shows where it was called.
                let released = client.release(&chains.color);
                assert_eq!(released, Err(Failure { call: "xrReleaseSwapchainImage", result: failed }));
                client.release(&chains.color)?;
                client.wait_image(&chains.color)?;
                client.release(&chains.color)
            };
            with_session(gpu, &Habits::PLAIN, work).unwrap();
        });
    });
}

#[test]
fn a_count_of_layers_without_layers_is_the_applications_mistake() {
    with_gpu(|gpu| {
        let habits = Habits::PLAIN;
        let seen = watched(script(), || {
            let work = |client: &mut Client, chains: &Chains| {
                for first in [true, false] {
                    let begun = client.begin_frame()?;
                    let result = sys::Result::ERROR_LAYER_INVALID;
                    let mistake = client.submit(begun, 2, std::ptr::null());
                    assert_eq!(mistake, Err(Failure { call: "xrEndFrame", result }), "first: {first}");
                    client.end_frame(begun, &[])?;
                    frames(client, chains, &habits, 2)?;
                }
                Ok(())
            };
            with_session(gpu, &habits, work).unwrap();
        });
        assert_eq!(seen.counts(), [[4, 0]], "{}", seen.said);
        assert_seen(&seen, &habits, "afterwards");
    });
}

/// The layer offers the extension for depth even if the runtime lacks it, and keeps the depth.
#[test]
fn a_runtime_without_depth_gets_two_views() {
    with_gpu(|gpu| {
        let habits = Habits::PLAIN;
        let missing_extensions = vec![DEPTH.to_str().unwrap().to_owned()];
        let seen = watched(Script { missing_extensions, ..script() }, || drop(run(gpu, &habits).unwrap()));
        // The runtime's only complaint is the extension that it lacks.
        assert!(
            matches!(&seen.violations()[..], [log::Entry::Violation { call, .. }] if call == "xrCreateInstance"),
            "{:?}",
            seen.violations()
        );
        assert_eq!(seen.counts(), [[3, 0]], "{}", seen.said);
        assert_seen(&seen, &habits, "without depth");
        assert!(seen.views().iter().all(|view| view.depth.is_none()));
    });
}

/// The log gives the reason once, and counts the frames.
#[test]
fn a_view_that_cannot_be_synthesized_is_shown_to_both_eyes() {
    type Spoil = fn(Submitted) -> Submitted;
    fn with_planes(submitted: Submitted, planes: Planes) -> Submitted {
        Submitted { depth: submitted.depth.map(|(part, _)| (part, planes)), ..submitted }
    }
    fn with_depth_part(submitted: Submitted, change: impl Fn(Part) -> Part) -> Submitted {
        Submitted { depth: submitted.depth.map(|(part, planes)| (change(part), planes)), ..submitted }
    }
    let plain = Habits::PLAIN;
    let cases: [(&str, Habits, Spoil); 6] = [
        ("it submits no depth", Habits { submits_depth: false, ..plain }, |s| s),
        ("it submits no depth", Habits { submits_depth: false, layers: [2, 1], ..plain }, |s| s),
        ("have different sizes or rectangles", Habits { margin: [4, 4], ..plain }, |s| {
            with_depth_part(s, |part| Part { origin: [3, 4], ..part })
        }),
        ("depth is in a swapchain that cannot be read", plain, |s| {
            with_depth_part(s, |part| Part { chain: sys::Swapchain::NULL, ..part })
        }),
        ("out of order", plain, |s| with_planes(s, Planes { min: 0.5, max: 0.5, ..Planes::PLAIN })),
        ("near", plain, |s| with_planes(s, Planes { near: 0.0, ..Planes::PLAIN })),
    ];
    with_gpu(|gpu| {
        for (reason, habits, spoil) in cases {
            let seen = watched(script(), || {
                let mut client = Client::new(gpu, habits.name, &[DEPTH]).unwrap();
                client.create_session().unwrap();
                client.poll().unwrap();
                let chains = Chains::new(&client, &habits).unwrap();
                frame(&mut client, &chains, &habits).unwrap();
                for _ in 0..3 {
                    let frame = client.begin_frame().unwrap();
                    let view = client.locate(frame).unwrap()[0].unwrap();
                    let submitted = render(&mut client, &chains, &habits, view).unwrap();
                    client.end_frame(frame, &[Layer::Projection(vec![spoil(submitted)])]).unwrap();
                }
                client.destroy_session().unwrap();
            });
            assert!(seen.violations().is_empty(), "{reason}: {:?}", seen.violations());
            assert_eq!(seen.said("the same image for both eyes"), 1, "{reason}: {}", seen.said);
            assert_eq!(seen.said(reason), 1, "{reason}: {}", seen.said);
            assert_eq!(seen.counts(), [[0, 3]], "{reason}: {}", seen.said);
            let views = seen.views();
            assert_eq!(
                (&views[0].image, views[0].position),
                (&views[1].image, views[1].position),
                "{reason}"
            );
            assert!(psnr(&seen.picture(0), &truth(&views[0], 1)) > 45.0, "{reason}");
        }
    });
}

/// Runs an application with a session and swapchains; `work` is what it does with them.
fn with_session<'a>(
    drawing: impl Into<Drawing<'a>>,
    habits: &Habits,
    work: impl FnOnce(&mut Client, &Chains) -> Outcome<()>,
) -> Outcome<()> {
    let mut client = Client::new(drawing, habits.name, &[DEPTH])?;
    client.create_session()?;
    client.poll()?;
    let chains = Chains::new(&client, habits)?;
    frame(&mut client, &chains, habits)?;
    work(&mut client, &chains)?;
    client.destroy_session()
}

/// The application waits for the next frame before the last one ends, and releases images before their frame begins.
#[test]
fn overlapping_frames_are_synthesized() {
    with_gpu(|gpu| {
        let habits = Habits::PLAIN;
        let seen = watched(script(), || {
            let pipelined = |client: &mut Client, chains: &Chains| {
                let mut now = client.begin_frame()?;
                for _ in 0..5 {
                    let view = client.locate(now)?[0].unwrap();
                    let submitted = render(client, chains, &habits, view)?;
                    let next = client.wait_frame()?;
                    client.end_frame(now, &[Layer::Projection(vec![submitted])])?;
                    client.begin_waited()?;
                    now = next;
                }
                let view = client.locate(now)?[0].unwrap();
                client.end_frame(now, &[])?;
                let early = render(client, chains, &habits, view)?;
                let frame = client.begin_frame()?;
                client.end_frame(frame, &[Layer::Projection(vec![early])])
            };
            with_session(gpu, &habits, pipelined).unwrap();
        });
        assert!(seen.violations().is_empty(), "{:?}", seen.violations());
        assert_eq!(seen.counts(), [[6, 0]], "{}", seen.said);
        assert_seen(&seen, &habits, "overlapping frames");
    });
}

/// When the application acquires the next image before the frame ends, the runtime gets the last one, and the layer
/// cannot read it.
#[test]
fn an_image_that_the_runtime_has_is_shown_to_both_eyes() {
    with_gpu(|gpu| {
        let habits = Habits::PLAIN;
        let seen = watched(Script { acquires_ahead: true, ..script() }, || {
            let work = |client: &mut Client, chains: &Chains| {
                let begun = client.begin_frame()?;
                let view = client.locate(begun)?[0].unwrap();
                let submitted = render(client, chains, &habits, view)?;
                let ahead = client.acquire(&chains.color)?;
                client.end_frame(begun, &[Layer::Projection(vec![submitted])])?;
                let begun = client.begin_frame()?;
                client.end_frame(begun, &[Layer::Projection(vec![submitted])])?;
                client.copy_color(ahead, chains.part);
                client.release(&chains.color)?;
                frames(client, chains, &habits, 2)
            };
            with_session(gpu, &habits, work).unwrap();
        });
        assert!(seen.violations().is_empty(), "{:?}", seen.violations());
        assert_eq!(seen.counts(), [[2, 2]], "{}", seen.said);
        assert_eq!(seen.said("was not released since the last frame"), 1, "{}", seen.said);
        assert_seen(&seen, &habits, "afterwards");
    });
}

/// Applications at half the display's rate, and those with static images, submit an image more than once.
#[test]
fn an_image_that_is_shown_again_stays_stereo() {
    with_gpu(|gpu| {
        for name in ["left", "right"] {
            let habits = Habits { name, ..Habits::PLAIN };
            let seen = watched(Script { acquires_ahead: true, ..script() }, || {
                let work = |client: &mut Client, chains: &Chains| {
                    for _ in 0..3 {
                        let begun = client.begin_frame()?;
                        let view = client.locate(begun)?[0].unwrap();
                        let submitted = render(client, chains, &habits, view)?;
                        client.end_frame(begun, &[Layer::Projection(vec![submitted])])?;
                        let begun = client.begin_frame()?;
                        client.end_frame(begun, &[Layer::Projection(vec![submitted])])?;
                    }
                    // The next image is acquired, and the old one is shown at another place.
                    let begun = client.begin_frame()?;
                    let view = client.locate(begun)?[0].unwrap();
                    let submitted = render(client, chains, &habits, view)?;
                    client.end_frame(begun, &[Layer::Projection(vec![submitted])])?;
                    client.acquire(&chains.color)?;
                    let begun = client.begin_frame()?;
                    let moved = Submitted { view: view.at(glam::Vec3::new(0.5, 0.25, 1.0)), ..submitted };
                    client.end_frame(begun, &[Layer::Projection(vec![moved])])?;
                    // With other planes it is another view.
                    let begun = client.begin_frame()?;
                    let planes = Planes { near: 0.2, ..Planes::PLAIN };
                    let depth = submitted.depth.map(|(part, _)| (part, planes));
                    client.end_frame(begun, &[Layer::Projection(vec![Submitted { depth, ..submitted }])])
                };
                with_session(gpu, &habits, work).unwrap();
            });
            assert!(seen.violations().is_empty(), "{:?}", seen.violations());
            assert_eq!(seen.counts(), [[8, 1]], "{}", seen.said);
            let frames: Vec<_> = seen.frames().into_iter().map(|layers| views_of(layers)).collect();
            for pair in frames[..8].chunks_exact(2) {
                let images = |views: &[log::View]| [0, 1].map(|eye| views[eye].image.clone());
                assert_eq!(images(pair[0]), images(pair[1]), "{name}");
                assert_ne!(pair[1][0].image, pair[1][1].image, "{name}");
                assert!(pair[1].iter().all(|view| view.depth.is_some()), "{name}");
            }
            assert_eq!(frames[4], frames[5], "{name}");
            for eye in 0..2 {
                let moved = pose_of(&frames[7][eye]).position - pose_of(&frames[6][eye]).position;
                assert!((moved - glam::Vec3::new(0.5, 0.25, 1.0)).length() < 1e-5, "{name}: {moved}");
            }
        }
    });
}

#[test]
fn the_layers_swapchains_follow_new_sizes_and_formats() {
    with_gpu(|gpu| {
        let habits = Habits::PLAIN;
        let seen = watched(script(), || {
            let work = |client: &mut Client, chains: &Chains| {
                frames(client, chains, &habits, 2)?;
                for (scale, format) in
                    [(1.5, SRGB), (0.5, SRGB), (0.5, vk::Format::B8G8R8A8_UNORM), (1.0, SRGB)]
                {
                    let habits = Habits { scale, formats: [format, D32], ..habits };
                    let chains = Chains::new(client, &habits)?;
                    frames(client, &chains, &habits, 2)?;
                    client.destroy_chain(chains.color)?;
                    client.destroy_chain(chains.depth)?;
                }
                frames(client, chains, &habits, 2)
            };
            with_session(gpu, &habits, work).unwrap();
        });
        assert!(seen.violations().is_empty(), "{:?}", seen.violations());
        assert_eq!(seen.counts(), [[12, 0]], "{}", seen.said);
        assert_seen(&seen, &habits, "the first size again");
    });
}

/// Some programs look for a headset with a first instance, and then create another one.
#[test]
fn the_log_outlives_an_instance_but_not_its_descriptor() {
    with_gpu(|gpu| {
        let path = yoro_layer::log::path().unwrap();
        let lines = || {
            let text = std::fs::read_to_string(&path).unwrap_or_default();
            text.matches("renders one view").count()
        };
        let before = lines();
        for _ in 0..2 {
            watched(script(), || drop(run(gpu, &Habits { frames: 1, ..Habits::PLAIN }).unwrap()));
            let open = std::fs::read_dir("/proc/self/fd").unwrap();
            let open = open.filter_map(|entry| std::fs::read_link(entry.unwrap().path()).ok());
            assert_eq!(open.filter(|file| *file == path).count(), 0);
        }
        assert_eq!(lines(), before + 2);
    });
}

#[test]
fn one_session_follows_another() {
    with_gpu(|gpu| {
        let habits = Habits::PLAIN;
        let seen = watched(script(), || {
            let mut client = Client::new(gpu, habits.name, &[DEPTH]).unwrap();
            for _ in 0..2 {
                client.create_session().unwrap();
                client.poll().unwrap();
                let chains = Chains::new(&client, &habits).unwrap();
                frames(&mut client, &chains, &habits, 2).unwrap();
                client.destroy_session().unwrap();
            }
        });
        assert!(seen.violations().is_empty(), "{:?}", seen.violations());
        assert_eq!(seen.counts(), [[2, 0]; 2], "{}", seen.said);
        assert_seen(&seen, &habits, "the second session");
    });
}

/// When a function of the runtime fails, once or from then on, the application's call of the same name may fail, as
/// without the layer, and no other one. After a single failure everything is synthesized again.
#[test]
fn no_fault_of_the_runtime_fails_another_call() {
    with_gpu(|gpu| {
        let habits = Habits { frames: 2, ..Habits::PLAIN };
        let quiet = |faults| Script { faults, pictures: None, ..script() };
        let all = watched(quiet(vec![]), || drop(run(gpu, &habits).unwrap())).calls();
        // Functions that the layer does not intercept, or that come before it.
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
                        assert!(failed == call || late, "{what}: {failed} fails: {}", seen.said);
                        assert_eq!(got.into_raw(), result, "{what}");
                        passed += 1;
                    }
                    Ok(()) => {
                        assert!(seen.violations().is_empty(), "{what}: {:?}", seen.violations());
                        let counts = seen.counts();
                        assert_eq!(counts.iter().flatten().sum::<u64>(), 4, "{what}: {}", seen.said);
                        let synthesized = seen.views()[0].image != seen.views()[1].image;
                        // Swapchains that the layer could not create readable stay so.
                        let lasts = and_later || making.contains(&call.as_str());
                        assert!(synthesized || lasts, "{what}: {}", seen.said);
                        assert_eq!(
                            seen.said("the same image for both eyes") > 0,
                            counts[0][1] > 0,
                            "{}",
                            seen.said
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

/// Views that the runtime refuses are submitted again as the application has rendered them; a late runtime is not
/// waited for.
#[test]
fn a_refused_or_late_runtime_costs_one_frame() {
    with_gpu(|gpu| {
        let cases = [
            ("xrEndFrame", 3, sys::Result::ERROR_LAYER_INVALID, "xrEndFrame fails with ERROR_LAYER_INVALID"),
            ("xrEndFrame", 3, sys::Result::ERROR_POSE_INVALID, "xrEndFrame fails with ERROR_POSE_INVALID"),
            // In each frame the application waits for colour and depth, then the layer does.
            ("xrWaitSwapchainImage", 7, sys::Result::TIMEOUT_EXPIRED, "the GPU or the runtime is late"),
            ("xrWaitSwapchainImage", 8, sys::Result::TIMEOUT_EXPIRED, "the GPU or the runtime is late"),
        ];
        for (call, nth, result, reason) in cases {
            let fault = Fault { call: call.into(), nth, and_later: false, result: result.into_raw() };
            let habits = Habits { frames: 4, ..Habits::PLAIN };
            let seen =
                watched(Script { faults: vec![fault], ..script() }, || drop(run(gpu, &habits).unwrap()));
            assert!(seen.violations().is_empty(), "{reason}: {:?}", seen.violations());
            assert_eq!(seen.counts(), [[3, 1]], "{reason}: {}", seen.said);
            assert_eq!(seen.said(reason), 1, "{}", seen.said);
            assert_seen(&seen, &habits, reason);
        }
    });
}

/// Runs frames until the session is over or lost, `most` at most.
fn until_over(client: &mut Client, chains: &Chains, habits: &Habits, most: u32) -> Outcome<()> {
    for _ in 0..most {
        client.poll()?;
        if client.over {
            break;
        }
        if client.is_running() {
            frame(client, chains, habits)?;
        }
    }
    Ok(())
}

/// The application goes on with a new session.
#[test]
fn sessions_and_instances_can_be_lost_in_every_state() {
    with_gpu(|gpu| {
        let states = [State::Idle, State::Ready, State::Synchronized, State::Visible, State::Focused];
        let ends =
            [What::LoseSession, What::LoseInstance, What::SessionLossPending, What::Exit, What::TakeOff(2)];
        for (state, end) in states.iter().flat_map(|state| ends.iter().map(move |end| (*state, end))) {
            // An application that is to begin and to end at the same time cannot do right.
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
                        client.create_session()?;
                        client.poll()?;
                        let chains = Chains::new(&client, &habits)?;
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
            assert!(*synthesized > 8 && *not == 0, "{what}: {}", seen.said);
        }
    });
}

/// Returns the number of open files, of threads, and the memory in bytes of this process.
fn resources() -> [usize; 3] {
    let count = |folder: &str| std::fs::read_dir(folder).unwrap().count();
    let pages = std::fs::read_to_string("/proc/self/statm").unwrap();
    let resident: usize = pages.split(' ').nth(1).unwrap().parse().unwrap();
    [count("/proc/self/fd"), count("/proc/self/task"), resident * 4096]
}

/// After a hundred frames, `count` more leave nothing behind, and the layer allocates nothing for them.
fn steady(drawing: Drawing, script: Script, habits: &Habits, count: u32) {
    let (mut most, mut grown) = (0, 0);
    let seen = watched(Script { pictures: None, log: None, ..script }, || {
        let work = |client: &mut Client, chains: &Chains| {
            frames(client, chains, habits, 100)?;
            let (before, objects) = (resources(), drawing.objects());
            for _ in 0..count {
                let first = allocations();
                client.poll()?;
                let frame = client.begin_frame()?;
                let view = client.locate(frame)?[0].unwrap();
                let submitted = render(client, chains, habits, view)?;
                let layers = uncounted(|| [Layer::Projection(vec![submitted])]);
                client.end_frame(frame, &layers)?;
                most = most.max(allocations() - first);
            }
            let after = resources();
            assert_eq!((before[0], before[1]), (after[0], after[1]), "open files and threads");
            assert_eq!(objects, drawing.objects(), "objects of OpenGL");
            grown = after[2].saturating_sub(before[2]);
            Ok(())
        };
        with_session(drawing, habits, work).unwrap();
    });
    assert_eq!(seen.counts(), [[u64::from(count) + 100, 0]], "{}", seen.said);
    println!("{count} frames: {most} allocations in the layer in one of them, {grown} bytes more");
    assert_eq!(most, 0, "the layer allocates in a frame");
    // Less than an image or a line for each frame.
    assert!(grown < 1 << 20, "{grown} bytes more");
}

#[test]
fn frames_allocate_nothing_and_leave_nothing_behind() {
    with_unwatched_gpu(|gpu| steady(gpu.into(), script(), &Habits::PLAIN, 300));
}

/// `cargo test -p yoro-layer --test scripted -- --ignored --nocapture`
#[test]
#[ignore = "takes a quarter of a minute"]
fn ten_thousand_frames_leave_nothing_behind() {
    with_unwatched_gpu(|gpu| steady(gpu.into(), script(), &Habits::PLAIN, 10_000));
}

/// On OpenGL ES whole images are read as they are; a part of an image in an array is copied first.
#[test]
fn frames_on_opengl_es_leave_nothing_behind() {
    with_gles(|gles| {
        let part = Habits { margin: [13, 7], layers: [2, 1], ..Habits::PLAIN };
        for (what, habits) in [("whole", Habits::PLAIN), ("part", part)] {
            let script = Script { formats: Script::default().formats, ..script() };
            let seen = watched(script.clone(), || drop(run(gles, &habits).unwrap()));
            assert!(seen.violations().is_empty(), "{what}: {:?}", seen.violations());
            assert_eq!(seen.counts(), [[3, 0]], "{what}: {}", seen.said);
            assert_seen(&seen, &habits, what);
            steady(gles.into(), script, &habits, 300);
        }
    });
}
