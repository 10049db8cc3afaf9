//! Any view and motion vectors have the same colour and depth as on OpenGL.

use yoro_wgpu::wgpu::TextureFormat;
use yoro_wgpu::{AnyView, Motion};

use crate::against_opengl::{Gl, assert_depth_equal, assert_equal, motion_warps, picture, pose_warps};
use crate::harness::with_gpus;
use crate::{Setup, synthesize};

/// Whole textures, parts of larger ones and layers of arrays, drawn by one pipeline.
#[test]
fn any_view_is_that_of_opengl() {
    let gl = Gl::open();
    let numbered = pose_warps().into_iter().zip(0..);
    let pictures: Vec<_> = numbered
        .map(|((warp, range), seed)| {
            let picture = picture(&warp, range, seed);
            (gl.any_view(&picture), picture)
        })
        .collect();
    drop(gl);
    let setup = Setup { target_depth: Some(TextureFormat::Depth32Float), ..Setup::PLAIN };
    let setups = [
        setup,
        Setup { source_layer: 1, source_margins: [[5, 3], [2, 7]], ..setup },
        Setup {
            depth: TextureFormat::Depth32Float,
            source_margins: [[0, 2], [3, 0]],
            target_margins: [[4, 9], [1, 2]],
            ..setup
        },
    ];
    with_gpus(|gpu| {
        let mut any_view = AnyView::new(&gpu.device, &setup.options()).unwrap();
        for (want, picture) in &pictures {
            for setup in &setups {
                let setup = setup.on(gpu);
                let got = synthesize(gpu, &mut any_view, &setup, picture);
                let what = format!("{}, {:?}, {setup:?}", gpu.name, picture.warp);
                assert_equal(&got.rgba, &want.rgba, 4, &what);
                assert_depth_equal(&got.depth.unwrap(), &want.depth, &what);
            }
        }
    });
}

#[test]
fn motion_is_that_of_opengl() {
    let gl = Gl::open();
    let pictures: Vec<_> = (motion_warps().into_iter().zip(90..))
        .map(|((warp, range), seed)| {
            let picture = picture(&warp, range, seed);
            (gl.motion(&picture), picture)
        })
        .collect();
    drop(gl);
    let setup = Setup { target_depth: Some(TextureFormat::Depth32Float), ..Setup::PLAIN };
    with_gpus(|gpu| {
        let mut motion = Motion::new(&gpu.device, &setup.options()).unwrap();
        for (want, picture) in &pictures {
            let setup = setup.on(gpu);
            let got = synthesize(gpu, &mut motion, &setup, picture);
            let what = format!("{}, {:?}", gpu.name, picture.warp);
            assert_equal(&got.rgba, &want.rgba, 4, &what);
            assert_depth_equal(&got.depth.unwrap(), &want.depth, &what);
        }
    });
}
