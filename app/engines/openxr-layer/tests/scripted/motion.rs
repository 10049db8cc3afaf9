//! Motion vectors of one view, of which the layer makes those of both eyes.

use std::cell::Cell;
use std::ffi::CStr;

use glam::Vec3;
use openxr_sys as sys;
use sys::{Handle as _, ViewConfigurationType as ViewsOf};
use yoro::eyes::DepthRange;
use yoro_openxr_stub::log;
use yoro_openxr_stub::script::{Insets, Script};

use crate::checks::{assert_counts, psnr, truth, views_of};
use crate::client::{Chain, Client, DEPTH, Layer, Motion, Outcome, Part, Planes, Submitted, VECTORS, View};
use crate::drawing::{Drawing, with_gles};
use crate::habits::{Chains, D32, Habits, render};
use crate::scene;
use crate::world::{Seen, allocations, faulty, script, watched, with_gpu};

/// An extension for motion vectors.
#[derive(Clone, Copy, Debug, PartialEq)]
enum By {
    FrameSynthesis,
    SpaceWarp,
}

impl By {
    fn name(self) -> &'static CStr {
        match self {
            By::FrameSynthesis => c"XR_EXT_frame_synthesis",
            By::SpaceWarp => c"XR_FB_space_warp",
        }
    }
}

/// The swapchains of an application for a view's motion vectors.
struct Vectors {
    vectors: Chain,
    depth: Chain,
    part: Part,
}

/// The head's velocity in metres a second.
const VELOCITY: Vec3 = Vec3::new(3.0, 1.5, -1.0);
/// Depth is reversed, and stored in a part of its range.
const PLANES: Planes = Planes { near: 100.0, far: 0.1, min: 0.25, max: 1.0 };

/// Returns a headset that moves.
fn moving(drawing: Drawing) -> Script {
    let formats =
        if matches!(drawing, Drawing::Gles(_)) { Script::default().formats } else { script().formats };
    Script { velocity: VELOCITY.to_array(), formats, vector_size: [40, 40], ..script() }
}

impl Vectors {
    fn new(client: &Client, size: [u32; 2]) -> Outcome<Vectors> {
        let (vectors, depth) = (client.chain(VECTORS, size, 1)?, client.chain(D32, size, 1)?);
        let part = Part { chain: vectors.handle, origin: [0; 2], size, layer: 0 };
        Ok(Vectors { vectors, depth, part })
    }

    /// Writes the vectors since a former frame, and their depth. Returns their structure.
    fn render(&self, client: &Client, by: By, view: View, former: View) -> Outcome<Motion> {
        // z of NDC in OpenGL is from -1 to 1, and y points down in Vulkan.
        let (is_gles, depth) = (client.is_gles(), DepthRange::from_distances(PLANES.near, PLANES.far));
        let unit = if is_gles && by == By::SpaceWarp { 2.0 } else { 1.0 };
        let ndc = |view: View, point: Vec3| {
            let seen = view.pose.orientation.inverse() * (point - view.pose.position);
            let (tangents, frustum) = (seen.truncate() / -seen.z, view.frustum);
            let x = 2.0 * (tangents.x - frustum.left) / frustum.width() - 1.0;
            let y = 2.0 * (tangents.y - frustum.bottom) / frustum.height() - 1.0;
            Vec3::new(x, if is_gles { y } else { -y }, unit * depth.depth(-seen.z))
        };
        let [width, height] = self.part.size;
        let distance = scene::render(view.pose, view.frustum, [width, height], 1).distance;
        let vector = |(i, distance): (usize, &f32)| {
            let part = [i as u32 % width, i as u32 / width].map(|n| n as f32 + 0.5);
            let x = view.frustum.left + part[0] / width as f32 * view.frustum.width();
            let y = view.frustum.bottom + part[1] / height as f32 * view.frustum.height();
            let point = view.pose.position + view.pose.orientation * (Vec3::new(x, y, -1.0) * *distance);
            (ndc(view, point) - ndc(former, point)).extend(0.0).to_array()
        };
        let vectors: Vec<[f32; 4]> = distance.iter().enumerate().map(vector).collect();
        let stored: Vec<f32> = distance.iter().map(|distance| PLANES.stored(*distance)).collect();
        let image = client.acquire(&self.vectors)?;
        client.upload_vectors(image, self.part, &vectors);
        client.release(&self.vectors)?;
        let depth = Part { chain: self.depth.handle, ..self.part };
        let image = client.acquire(&self.depth)?;
        client.upload_depth(image, depth, &stored);
        client.release(&self.depth)?;

        let four = |n| sys::Vector4f { x: n, y: n, z: n, w: n };
        let identity = sys::Posef::IDENTITY;
        let (motion_vector_sub_image, depth_sub_image) = (self.part.raw(), depth.raw());
        let Planes { near: near_z, far: far_z, min: min_depth, max: max_depth } = PLANES;
        Ok(match by {
            By::FrameSynthesis => Motion::FrameSynthesis(sys::FrameSynthesisInfoEXT {
                ty: sys::FrameSynthesisInfoEXT::TYPE,
                next: std::ptr::null(),
                layer_flags: sys::FrameSynthesisInfoFlagsEXT::EMPTY,
                motion_vector_sub_image,
                motion_vector_scale: four(1.0),
                motion_vector_offset: four(0.0),
                app_space_delta_pose: identity,
                depth_sub_image,
                min_depth,
                max_depth,
                near_z,
                far_z,
            }),
            By::SpaceWarp => Motion::SpaceWarp(sys::CompositionLayerSpaceWarpInfoFB {
                ty: sys::CompositionLayerSpaceWarpInfoFB::TYPE,
                next: std::ptr::null(),
                layer_flags: sys::CompositionLayerSpaceWarpInfoFlagsFB::EMPTY,
                motion_vector_sub_image,
                app_space_delta_pose: identity,
                depth_sub_image,
                min_depth,
                max_depth,
                near_z,
                far_z,
            }),
        })
    }
}

/// The number of frames with motion vectors that [`run`] submits. From the first on, all is made that the layer needs for one
/// image of a swapchain.
const FRAMES: u32 = 6;

/// Runs an application of this many views that submits motion vectors, after a frame without. `change` changes what it submits
/// in a frame, counted from 0. The last one is submitted once more if `again` is true, as what `change` makes of it.
fn run(
    drawing: Drawing,
    script: Script,
    (by, views, again): (By, usize, bool),
    change: impl Fn(u32, Submitted) -> Submitted,
) -> Seen {
    // Of four views, the layer replaces two.
    let habits = Habits { name: if views == 4 { "shrink" } else { "right" }, ..Habits::PLAIN };
    let vector_size = script.vector_size;
    watched(script, || {
        let insets: &[&CStr] = if views == 4 { &[c"XR_VARJO_quad_views"] } else { &[] };
        let extensions = [&[DEPTH, by.name()], insets].concat();
        let mut client = Client::new(drawing, habits.name, &extensions).unwrap();
        client.views = match views {
            1 => ViewsOf::PRIMARY_MONO,
            2 => ViewsOf::PRIMARY_STEREO,
            _ => ViewsOf::PRIMARY_STEREO_WITH_FOVEATED_INSET,
        };
        client.create_session().unwrap();
        client.poll().unwrap();
        // XR_FB_space_warp recommends a size without regard to views.
        let of_vectors = match by {
            By::FrameSynthesis => client.vector_sizes(views).unwrap(),
            By::SpaceWarp => vec![vector_size; views],
        };
        let vectors: Vec<_> =
            of_vectors.into_iter().map(|size| Vectors::new(&client, size).unwrap()).collect();
        let sizes = client.sizes().unwrap();
        let chains: Vec<_> = sizes.iter().map(|size| Chains::of_size(&client, *size).unwrap()).collect();
        let (mut former, mut with) = (None, 0);
        while with < FRAMES {
            client.poll().unwrap();
            let frame = client.begin_frame().unwrap();
            if !frame.should_render {
                client.end_frame(frame, &[]).unwrap();
                continue;
            }
            let located: Vec<View> = client.locate(frame).unwrap().into_iter().flatten().collect();
            let mut submitted = Vec::new();
            for (i, view) in located.iter().enumerate() {
                let one = render(&mut client, &chains[i], &habits, *view).unwrap();
                let Some(former): &Option<Vec<View>> = &former else {
                    submitted.push(one);
                    continue;
                };
                let motion = Some(vectors[i].render(&client, by, *view, former[i]).unwrap());
                submitted.push(change(with, Submitted { motion, ..one }));
            }
            let again = (again && with + 1 == FRAMES)
                .then(|| submitted.iter().map(|one| change(FRAMES, *one)).collect::<Vec<_>>());
            let layers = [Layer::Projection(submitted)];
            let before = allocations();
            client.end_frame(frame, &layers).unwrap();
            // Each swapchain has three images.
            let made = allocations() - before;
            assert!(with < 4 || made == 0, "the layer allocates {made} times in a frame");
            with += u32::from(former.is_some());
            former = Some(located);
            if let Some(again) = again {
                let frame = client.begin_frame().unwrap();
                client.end_frame(frame, &[Layer::Projection(again)]).unwrap();
            }
        }
        client.destroy_session().unwrap();
    })
}

/// Returns the PSNR of the frames that the runtime made for each view, and of those before, which a runtime without vectors
/// shows again.
fn between(seen: &Seen, script: &Script) -> Vec<[f64; 2]> {
    let of_view = |(eye, view): (usize, &log::View)| {
        // The application renders every second frame.
        let later = VELOCITY / script.refresh_rates[0];
        let position = (Vec3::from(view.position) + later).to_array();
        let truth = truth(&log::View { position, ..view.clone() }, 1);
        [psnr(&seen.between(eye), &truth), psnr(&seen.picture(eye), &truth)]
    };
    seen.views().iter().enumerate().map(of_view).collect()
}

/// The frame between, as the runtime makes it for both eyes of one view's vectors, is what they see then: as good as of two
/// views with vectors.
fn the_frames_between(drawing: Drawing) {
    let script = moving(drawing);
    for by in [By::FrameSynthesis, By::SpaceWarp] {
        let two = between(&run(drawing, script.clone(), (by, 2, false), |_, submitted| submitted), &script);
        let seen = run(drawing, script.clone(), (by, 1, false), |_, submitted| submitted);
        assert_counts(&seen, &[[u64::from(FRAMES) + 1, 0]], by.name().to_str().unwrap());
        assert_eq!(seen.said("motion vectors"), 0, "{}", seen.said);
        let made = between(&seen, &script);
        println!("{by:?}: left and right {made:.2?} dB, of two views {two:.2?}");
        for eye in 0..2 {
            assert!(made[eye][0] > made[eye][1] + 3.0, "{by:?}: eye {eye}: {made:?}");
            assert!(made[eye][0] > two[eye][0] - 1.5, "{by:?}: eye {eye}: {made:?}, {two:?}");
        }
        for (eye, view) in seen.views().iter().enumerate() {
            let synthesis = view.synthesis.as_ref().unwrap();
            assert_eq!(synthesis.is_space_warp, by == By::SpaceWarp);
            assert_eq!(synthesis.depth.near_far, [PLANES.near, PLANES.far], "{by:?}");
            assert_eq!(synthesis.depth.range, [PLANES.min, PLANES.max], "{by:?}");
            // A view's size times a factor is rounded up, and an eye's part of it to the next texel.
            let [.., width, height] = synthesis.vectors.rect;
            let narrower = if by == By::SpaceWarp { 31 } else { 40 };
            assert!((narrower..=41).contains(&width) && height == 40, "{by:?}: eye {eye}: {width}x{height}");
        }
    }
}

#[test]
fn both_eyes_have_motion_vectors() {
    with_gpu(|gpu| the_frames_between(gpu.into()));
}

#[test]
fn both_eyes_have_motion_vectors_on_opengl_es() {
    with_gles(|gles| the_frames_between(gles.into()));
}

/// Views that the layer replaces have vectors, whatever the application says of theirs, and all views of a layer or none.
#[test]
fn the_insets_of_both_eyes_have_motion_vectors() {
    with_gles(|gles| {
        let insets = Some(Insets { size: [96; 2], radius_degrees: 25.0, gaze: vec![(0, [0.0; 2])] });
        let script = Script { insets, ..moving(gles.into()) };
        let seen = run(gles.into(), script.clone(), (By::FrameSynthesis, 4, false), |_, submitted| submitted);
        assert_counts(&seen, &[[u64::from(FRAMES) + 1, 0]], "insets");
        let made = between(&seen, &script);
        println!("wide and inset, left and right: {made:.2?} dB");
        assert!(made.len() == 4 && made.iter().all(|[made, last]| *made > last + 3.0), "{made:?}");

        let of_insets = Cell::new(0);
        let seen = run(gles.into(), script, (By::FrameSynthesis, 4, false), |_, submitted| {
            of_insets.set(of_insets.get() + 1);
            if of_insets.get() % 4 > 1 { submitted } else { Submitted { motion: None, ..submitted } }
        });
        assert_counts(&seen, &[[u64::from(FRAMES) + 1, 0]], "some insets");
        assert!(seen.views().iter().all(|view| view.synthesis.is_none()), "{:?}", seen.views());
    });
}

/// Changes the structure of an extension.
fn synthesis(submitted: Submitted, change: impl Fn(&mut sys::FrameSynthesisInfoEXT)) -> Submitted {
    let Some(Motion::FrameSynthesis(mut info)) = submitted.motion else { panic!("another extension") };
    change(&mut info);
    Submitted { motion: Some(Motion::FrameSynthesis(info)), ..submitted }
}

/// What the application says of its vectors holds for both eyes: scale, offset and flags.
#[test]
fn what_is_said_of_vectors_is_said_of_both_eyes() {
    with_gles(|gles| {
        let (drawing, script) = (gles.into(), moving(gles.into()));
        let right = between(&run(drawing, script.clone(), (By::FrameSynthesis, 1, false), |_, s| s), &script);
        let seen = run(drawing, script.clone(), (By::FrameSynthesis, 1, false), |_, submitted| {
            synthesis(submitted, |info| {
                info.motion_vector_scale.x = -1.0;
                info.motion_vector_offset.y = 0.25;
            })
        });
        let wrong = between(&seen, &script);
        println!("left and right {right:.2?} dB, with a wrong sign {wrong:.2?}");
        for eye in 0..2 {
            assert!(right[eye][0] > wrong[eye][0] + 6.0, "eye {eye}: {right:?}, {wrong:?}");
            let said = seen.views()[eye].synthesis.as_ref().unwrap();
            assert!(said.scale[0] < -1.0 && said.scale[1..] == [1.0; 2], "{said:?}");
            assert_eq!(said.offset, [0.0, 0.25, 0.0], "{said:?}");
        }

        let skips = |frame, submitted: Submitted| {
            let Some(Motion::SpaceWarp(mut info)) = submitted.motion else { panic!("another extension") };
            if frame == FRAMES - 1 {
                info.layer_flags = sys::CompositionLayerSpaceWarpInfoFlagsFB::FRAME_SKIP;
            }
            Submitted { motion: Some(Motion::SpaceWarp(info)), ..submitted }
        };
        let seen = run(drawing, script, (By::SpaceWarp, 1, false), skips);
        assert_counts(&seen, &[[u64::from(FRAMES) + 1, 0]], "skipped");
        let skipped = seen.views().iter().map(|view| view.synthesis.as_ref().unwrap().is_skipped);
        assert_eq!(skipped.collect::<Vec<_>>(), [true, true]);
    });
}

/// The frame is shown in stereo, and the log gives the reason once.
#[test]
fn vectors_that_cannot_be_moved_are_left_out() {
    type Spoil = fn(&mut sys::FrameSynthesisInfoEXT);
    let cases: [(&str, Spoil); 5] = [
        ("motion vectors of two components do not tell", |info| {
            info.layer_flags = sys::FrameSynthesisInfoFlagsEXT::USE_2D_MOTION_VECTOR;
        }),
        ("the image of motion vectors and the depth of motion vectors have different sizes", |info| {
            info.depth_sub_image.image_rect.extent.width -= 1;
        }),
        ("the image of motion vectors is in a swapchain that cannot be read", |info| {
            info.motion_vector_sub_image.swapchain = sys::Swapchain::NULL;
        }),
        ("motionVectorScale.x is 0", |info| info.motion_vector_scale.x = 0.0),
        ("out of order", |info| info.min_depth = info.max_depth),
    ];
    with_gles(|gles| {
        for (reason, spoil) in cases {
            let script = Script { pictures: None, ..moving(gles.into()) };
            let seen = run(gles.into(), script, (By::FrameSynthesis, 1, false), |_, s| synthesis(s, spoil));
            assert_counts(&seen, &[[u64::from(FRAMES) + 1, 0]], reason);
            assert_eq!(seen.said("shown without its motion vectors"), 1, "{reason}: {}", seen.said);
            assert_eq!(seen.said(reason), 1, "{reason}: {}", seen.said);
            assert!(seen.views().iter().all(|view| view.synthesis.is_none() && view.depth.is_some()));
        }
    });
}

/// A runtime that refuses vectors, or images for them, gets the frame in stereo without them.
#[test]
fn a_runtime_that_refuses_vectors_gets_none() {
    let failure = sys::Result::ERROR_RUNTIME_FAILURE;
    // Two frames are empty, and the third has no vectors. The application makes four swapchains, the layer two for the other
    // eye, and then two for each eye's vectors.
    let refused = sys::Result::ERROR_LAYER_INVALID;
    let cases: [(_, &[u32], _, _); 5] = [
        ("xrEndFrame", &[5], sys::Result::ERROR_VALIDATION_FAILURE, [0, 2, 0, 2, 2, 2, 2]),
        ("xrEndFrame", &[4], refused, [0, 0, 2, 2, 2, 2, 2]),
        // Each refused frame is ended twice. A runtime that refuses three in a row is not asked again.
        ("xrEndFrame", &[4, 6, 8], refused, [0; 7]),
        ("xrCreateSwapchain", &[7], failure, [0, 0, 2, 2, 2, 2, 2]),
        ("xrCreateSwapchain", &[10], failure, [0, 0, 2, 2, 2, 2, 2]),
    ];
    with_gles(|gles| {
        for (call, calls, result, expected) in cases {
            let faults = calls.iter().flat_map(|nth| faulty(call, *nth, result).faults).collect();
            let script = Script { faults, pictures: None, ..moving(gles.into()) };
            let seen = run(gles.into(), script, (By::SpaceWarp, 1, false), |_, submitted| submitted);
            assert_counts(&seen, &[[u64::from(FRAMES) + 1, 0]], call);
            let reason = format!("without its motion vectors: {call} fails with {result:?}");
            assert_eq!(seen.said(&reason), 1, "{}", seen.said);
            let frames = seen.frames();
            let with = frames
                .iter()
                .map(|layers| views_of(layers).iter().filter(|view| view.synthesis.is_some()).count());
            assert_eq!(with.collect::<Vec<_>>(), expected, "{call}, {calls:?}: {}", seen.said);
        }
        // Without its vectors, the frame is refused as well.
        let faults = [4, 5].into_iter().flat_map(|nth| faulty("xrEndFrame", nth, refused).faults).collect();
        let script = Script { faults, pictures: None, ..moving(gles.into()) };
        let seen = run(gles.into(), script, (By::SpaceWarp, 1, false), |_, submitted| submitted);
        assert_counts(&seen, &[[u64::from(FRAMES), 1]], "refused for another reason");
        assert_eq!(seen.said("motion vectors"), 0, "{}", seen.said);
    });
}

/// Applications at half the display's rate may submit each image twice.
#[test]
fn an_image_that_is_shown_again_has_its_vectors() {
    with_gles(|gles| {
        let script = Script { pictures: None, ..moving(gles.into()) };
        let seen = run(gles.into(), script, (By::SpaceWarp, 1, true), |_, submitted| submitted);
        assert_counts(&seen, &[[u64::from(FRAMES) + 2, 0]], "shown again");
        let frames = seen.frames();
        let [.., last, again] = frames.as_slice() else { panic!("{} frames", frames.len()) };
        let vectors = |layers| views_of(layers).iter().map(|view| view.synthesis.clone()).collect::<Vec<_>>();
        assert!(vectors(again).iter().all(Option::is_some), "{}", seen.said);
        assert_eq!(vectors(last), vectors(again));

        // Other vectors than those of which both eyes' were made.
        let script = Script { pictures: None, ..moving(gles.into()) };
        let seen = run(gles.into(), script, (By::FrameSynthesis, 1, true), |frame, submitted| {
            synthesis(submitted, |info| {
                for image in [&mut info.motion_vector_sub_image, &mut info.depth_sub_image] {
                    image.image_rect.extent.height -= i32::from(frame == FRAMES);
                }
            })
        });
        assert_counts(&seen, &[[u64::from(FRAMES) + 2, 0]], "with other vectors");
        let with =
            seen.frames().iter().map(|layers| views_of(layers)[0].synthesis.is_some()).collect::<Vec<_>>();
        assert_eq!(with, [false, true, true, true, true, true, true, false]);
        assert_eq!(seen.said("without its motion vectors: colour was not released"), 1, "{}", seen.said);
    });
}
