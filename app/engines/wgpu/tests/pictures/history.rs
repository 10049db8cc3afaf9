//! Disocclusions that are looked up in a history look the same as on OpenGL.

use yoro::synthesis::{Edges, PassSet};
use yoro_wgpu::wgpu::{TextureAspect, TextureFormat};
use yoro_wgpu::{Gather, History, Options, Source, Target};

use crate::Setup;
use crate::against_opengl::{Gl, RecalledScene, assert_equal, recalled_scenes};
use crate::harness::{Gpu, depth_of, one_layer, with_gpus};

#[test]
fn what_is_recalled_is_what_opengl_recalls() {
    let (gl, scenes) = (Gl::new(), recalled_scenes());
    // All are drawn before wgpu's OpenGL makes its own context current.
    let cases = [(Edges::Hard, 0), (Edges::Hard, 1), (Edges::Nearest, 0)].map(|(edges, number)| {
        let mut opengl = gl.recalling(edges, number);
        (edges, number, scenes.iter().map(|scene| opengl.both(scene)).collect::<Vec<_>>())
    });
    with_gpus(|gpu| {
        for (edges, number, wanted) in &cases {
            let options = Options { edges: *edges, history: true, ..Setup::PLAIN.options() };
            let mut gather = Gather::with_passes(&gpu.device, &options, PassSet::GATHER[*number]).unwrap();
            for (scene, [want, plain]) in scenes.iter().zip(wanted) {
                let what = format!("{}, {edges:?}, {:?}, {}", gpu.name, PassSet::GATHER[*number], scene.what);
                let [with, without] = synthesize(gpu, &mut gather, scene);
                let changed = want.chunks(4).zip(plain.chunks(4)).filter(|(a, b)| a != b).count();
                assert!(changed > 100, "{what}: {changed} pixels are recalled");
                assert_equal(&with, want, 4, *number, &what);
                assert_equal(&without, plain, 4, *number, &format!("{what}, nothing"));
            }
        }
    });
}

/// Returns the other eye with the scene's history and without it, recorded one after the other.
fn synthesize(gpu: &Gpu, gather: &mut Gather, scene: &RecalledScene) -> [Vec<u8>; 2] {
    let warp = &scene.source.warp;
    let upload = |rgba: &[u8], depth: &[f32], size| {
        let [color, depths] =
            [TextureFormat::Rgba8Unorm, TextureFormat::R32Float].map(|format| gpu.texture(format, size, 1));
        gpu.upload_rgba8(&color, 0, rgba);
        gpu.upload_depth(&depths, 0, depth);
        [one_layer(&color, 0, TextureAspect::All), depth_of(&depths, 0)]
    };
    let [color, depth] = upload(&scene.source.rgba, &scene.source.depth, warp.source_size);
    let [former_color, former_depth] = upload(&scene.former.rgba, &scene.former.depth, scene.former_size);
    let targets = [0; 2].map(|_| gpu.texture(TextureFormat::Rgba8Unorm, warp.target_size, 1));
    let views = targets.each_ref().map(|target| one_layer(target, 0, TextureAspect::All));
    let strips = scene.strips_from_top();
    let history = Some(History { color: &former_color, depth: &former_depth, strips });
    let plain = Source::new(&color, &depth);
    let record = |gather: &mut Gather, source: &Source, target: usize| {
        let target = Target::new(&views[target]);
        gpu.run(|encoder| gather.record(&gpu.device, &gpu.queue, encoder, source, warp, &target))
    };
    record(gather, &Source { history, ..plain }, 0).unwrap();
    record(gather, &plain, 1).unwrap();
    targets.each_ref().map(|target| gpu.read_rgba8(target, 0))
}
