//! Any view and motion vectors on Vulkan: the same as on OpenGL.

use crate::against_opengl::{Gl, assert_depth_equal, assert_equal, motion_warps, picture, pose_warps};
use crate::harness::{Rendering, with_gpu};
use crate::{Setup, synthesize};
use yoro::vulkan::ash::vk;
use yoro::vulkan::{AnyView, ImageState, Motion, Options};

#[test]
fn any_view_is_that_of_opengl() {
    let gl = Gl::open();
    for rendering in Rendering::ALL {
        with_gpu(rendering, |gpu| {
            for (i, (warp, range)) in pose_warps().into_iter().enumerate() {
                let picture = picture(&warp, range, i as u64);
                let setup = Setup { target_depth: Some(vk::Format::D32_SFLOAT), ..Setup::PLAIN };
                // SAFETY: the device outlives the pipeline, and all commands are executed before it is dropped.
                let mut any_view = unsafe { AnyView::new(&gpu.host(), &setup.options(&[warp])).unwrap() };
                let got = synthesize(gpu, &mut any_view, &setup, &picture);
                let want = gl.any_view(&picture);
                let what = format!("{rendering:?}, {warp:?}");
                assert_equal(&got.rgba, &want.rgba, 4, &what);
                assert_depth_equal(&got.depth.unwrap(), &want.depth, &what);
            }
        });
    }
}

/// Parts of larger images and layers of arrays, with one pipeline for several sizes, pass times and other formats.
#[test]
fn any_view_of_parts_and_layers() {
    let gl = Gl::open();
    with_gpu(Rendering::Core, |gpu| {
        let setups = [
            Setup { source_layer: 1, source_margins: [[5, 3], [2, 7]], target_layer: 1, ..Setup::PLAIN },
            Setup {
                source_margins: [[0, 2], [3, 0]],
                target_margins: [[4, 9], [1, 2]],
                target_before: ImageState::COLOR_ATTACHMENT,
                ..Setup::PLAIN
            },
        ];
        let setups = setups.map(|setup| Setup {
            depth: vk::Format::D32_SFLOAT,
            target_depth: Some(vk::Format::D16_UNORM),
            ..setup
        });
        let limits = Options {
            max_source_size: [120, 100],
            max_target_size: [120, 100],
            timed_frames: 1,
            ..setups[0].options(&[pose_warps()[0].0])
        };
        // SAFETY: the device outlives the pipeline, and all commands are executed before it is dropped.
        let mut any_view = unsafe { AnyView::new(&gpu.host(), &limits).unwrap() };
        for (i, (warp, range)) in pose_warps().into_iter().enumerate() {
            let picture = picture(&warp, range, 50 + i as u64);
            let setup = &setups[i % 2];
            let got = synthesize(gpu, &mut any_view, setup, &picture);
            let want = gl.any_view(&picture);
            let what = format!("{warp:?}, {setup:?}");
            assert_equal(&got.rgba, &want.rgba, 4, &what);
            assert_depth_equal(&got.depth.unwrap(), &want.depth, &what);
        }
        // SAFETY: everything is executed.
        let times = unsafe { any_view.pass_times() }.unwrap().unwrap();
        assert!(!times.march.is_zero() && !times.tiles.is_zero(), "{times:?}");
    });
}

#[test]
fn motion_is_that_of_opengl() {
    let gl = Gl::open();
    with_gpu(Rendering::Core, |gpu| {
        for (i, (warp, range)) in motion_warps().into_iter().enumerate() {
            let picture = picture(&warp, range, 90 + i as u64);
            let setup = Setup { target_depth: Some(vk::Format::D32_SFLOAT), ..Setup::PLAIN };
            // SAFETY: the device outlives the pipeline, and all commands are executed before it is dropped.
            let mut motion = unsafe { Motion::new(&gpu.host(), &setup.options(&[warp])).unwrap() };
            let got = synthesize(gpu, &mut motion, &setup, &picture);
            let want = gl.motion(&picture);
            assert_equal(&got.rgba, &want.rgba, 4, &format!("{warp:?}"));
            assert_depth_equal(&got.depth.unwrap(), &want.depth, &format!("{warp:?}"));
        }
    });
}
