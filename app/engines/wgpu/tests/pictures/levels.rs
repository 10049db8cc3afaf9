//! The composer on wgpu: its f64 reference.

use yoro_test_support::composed::{LevelPicture, cases};
use yoro_test_support::table::cut;
use yoro_wgpu::wgpu::{TextureAspect, TextureFormat};
use yoro_wgpu::{Composer, InsetImage, LevelImage, LevelImages, Target};

use crate::harness::{depth_of, one_layer, with_gpus};

#[test]
fn a_composed_eye_is_its_reference() {
    with_gpus(|gpu| {
        let format = TextureFormat::Rgba8Unorm;
        let mut composer = Composer::new(&gpu.device, format).unwrap();
        for case in cases() {
            let level = |picture: &LevelPicture| {
                let texture = gpu.texture(format, picture.image_size, 1);
                gpu.upload_rgba8(&texture, 0, &picture.rgba);
                one_layer(&texture, 0, TextureAspect::All)
            };
            let (wide, inset) = (level(&case.wide), case.inset.as_ref().map(level));
            let depth = case.depth.as_ref().zip(case.inset.as_ref()).map(|(values, picture)| {
                let texture = gpu.texture(TextureFormat::Depth32Float, picture.image_size, 1);
                gpu.upload_depth(&texture, 0, values);
                depth_of(&texture, 0)
            });
            let size = case.levels.shown.size;
            let image_size = size.map(|n| n + 9);
            let target = gpu.texture(format, image_size, 1);
            let target_view = one_layer(&target, 0, TextureAspect::All);
            let images = LevelImages {
                wide: LevelImage { color: &wide, origin: case.wide.origin_from_top() },
                inset: inset.as_ref().zip(case.inset.as_ref()).map(|(color, picture)| InsetImage {
                    image: LevelImage { color, origin: picture.origin_from_top() },
                    depth: depth.as_ref(),
                }),
            };
            let to = Target { origin: [7, 2], ..Target::new(&target_view) };
            gpu.run(|encoder| {
                composer.record(&gpu.device, &gpu.queue, encoder, &images, &case.composition(), &to)
            })
            .unwrap();
            let got = cut(&gpu.read_rgba8(&target, 0), image_size, [7, 2], size, 4);
            case.check(&got, &gpu.name);
        }
    });
}
