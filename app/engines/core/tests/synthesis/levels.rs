//! Levels of a foveated view: the composer against its f64 reference, and the laws of levels.

use std::rc::Rc;

use glam::{Quat, Vec3};

use super::laws::{on_every_backend, scene};
use super::state::{Hostile, clean, snapshot};
use yoro::eyes::{DepthConvention, Eye, Foveation, Gaze, GuardBand, View, ViewLayer};
use yoro::opengl::{
    Composer, Context, Destination, Gather, GlState, InsetImage, LevelImage, LevelImages, Options, Outputs,
    Part, Source,
};
use yoro_gl::{Filter, Format, RenderTarget, Texture};
use yoro_test_support::composed::{Case, LevelPicture, cases, eyes};

/// The textures of a case.
struct Textures {
    wide: Texture,
    inset: Option<Texture>,
    depth: Option<Texture>,
}

fn texture(gl: &Rc<Context>, size: [u32; 2], format: Format, bytes: &[u8]) -> Texture {
    // Filters that must not matter.
    let texture = Texture::new(gl, size, format, Filter::Nearest).unwrap();
    texture.upload(bytes);
    texture
}

fn bytes(depth: &[f32]) -> Vec<u8> {
    depth.iter().flat_map(|z| z.to_ne_bytes()).collect()
}

impl Textures {
    fn new(gl: &Rc<Context>, case: &Case) -> Textures {
        let color = |picture: &LevelPicture| texture(gl, picture.image_size, Format::Rgba8, &picture.rgba);
        let size = case.inset.as_ref().map_or([1, 1], |inset| inset.image_size);
        Textures {
            wide: color(&case.wide),
            inset: case.inset.as_ref().map(color),
            depth: case.depth.as_ref().map(|depth| texture(gl, size, Format::R32F, &bytes(depth))),
        }
    }

    fn images(&self, case: &Case) -> LevelImages {
        let image = |texture: &Texture, picture: &LevelPicture| LevelImage {
            color: texture.raw(),
            part: Some(Part { origin: picture.origin, image_size: picture.image_size }),
        };
        let inset = self.inset.as_ref().zip(case.inset.as_ref()).map(|(texture, picture)| InsetImage {
            image: image(texture, picture),
            depth: self.depth.as_ref().map(Texture::raw),
        });
        LevelImages { wide: image(&self.wide, &case.wide), inset }
    }
}

/// Composes into a rectangle that is not at the corner of its framebuffer.
fn compose(gl: &Rc<Context>, composer: &Composer, case: &Case) -> Vec<u8> {
    let textures = Textures::new(gl, case);
    let size = case.levels.shown.size;
    let formats = [(Format::Rgba8, Filter::Nearest)];
    let target = RenderTarget::new(gl, size.map(|n| n + 9), &formats, None).unwrap();
    let place = Destination { framebuffer: Some(target.raw()), origin: [7, 2], size };
    composer.compose(&textures.images(case), &case.composition(), &place);
    target.read_rgba8(0, [7, 2], size)
}

#[test]
fn a_composed_eye_is_its_reference() {
    on_every_backend(|gl| {
        let composer = Composer::new(gl, GlState::Leave, false).unwrap();
        let mut holes = 0;
        for case in cases() {
            case.check(&compose(gl, &composer, &case), "OpenGL");
            holes += case.border_holes();
        }
        assert!(holes > 500, "{holes}");
    });
}

/// One level is the identity, and so are all pixels of an inset with a hard seam, to the last bit.
#[test]
fn pixels_of_full_density_are_not_changed() {
    on_every_backend(|gl| {
        let composer = Composer::new(gl, GlState::Leave, false).unwrap();
        let mut checked = 0;
        for case in cases().into_iter().filter(|case| case.depth.is_none() && case.levels.fade[0] == 0.0) {
            let got = compose(gl, &composer, &case);
            let eye = case.eye.index();
            let (shown, level) = (&case.levels.shown, case.levels.inset.unwrap_or(case.levels.wide));
            let picture = case.inset.as_ref().unwrap_or(&case.wide);
            let [x0, y0] = corner(&level, &shown.view(case.eye), eye);
            for y in 0..picture.size[1] as i32 {
                for x in 0..picture.size[0] as i32 {
                    let ([ex, ey], [w, h]) = ([x0 + x, y0 + y], shown.size.map(|n| n as i32));
                    if (0..w).contains(&ex) && (0..h).contains(&ey) {
                        let at = (y as u32 + picture.origin[1]) * picture.image_size[0] + picture.origin[0];
                        let want = &picture.rgba[(at as usize + x as usize) * 4..][..4];
                        assert_eq!(&got[(ey * w + ex) as usize * 4..][..4], want, "{}: {x} {y}", case.name);
                        checked += 1;
                    }
                }
            }
        }
        assert!(checked > 50_000, "{checked}");
    });
}

/// Returns the lower left corner of a level in its eye's image, in pixels.
fn corner(level: &ViewLayer, shown: &View, eye: usize) -> [i32; 2] {
    let (own, all) = (&level.eyes.frusta[eye], &shown.frustum);
    let pixels = |tangents: f32, extent: f32, size: u32| (tangents / extent * size as f32).round() as i32;
    [
        pixels(own.left - all.left, all.width(), shown.size[0]),
        pixels(own.bottom - all.bottom, all.height(), shown.size[1]),
    ]
}

/// Returns a rectangle of an image with rows from the bottom.
fn cut<T: Copy>(all: &[T], width: u32, [x, y]: [i32; 2], [w, h]: [u32; 2], channels: usize) -> Vec<T> {
    let row = |row: i32| {
        let first = ((y + row) * width as i32 + x) as usize * channels;
        &all[first..][..w as usize * channels]
    };
    (0..h as i32).flat_map(row).copied().collect()
}

/// The inset, synthesized alone from its own part of a rendered picture, is what synthesis makes there of the whole
/// picture: the fovea loses nothing.
#[test]
fn the_fovea_loses_nothing() {
    on_every_backend(|gl| {
        for (seed, dominant) in Eye::BOTH.into_iter().enumerate() {
            let eyes = eyes([300, 200], dominant, DepthConvention::Reversed);
            let foveation = Foveation { radius: 0.35, ..Foveation::MEDIUM };
            let gaze = Gaze::Direction(Quat::from_rotation_y(0.15) * Vec3::NEG_Z);
            let views = eyes.stereo_views(Some(&foveation), gaze).unwrap();
            let inset = views.inset.unwrap();
            let own = inset.synthesis_views(GuardBand::None).unwrap();
            let whole = eyes.synthesis_views(GuardBand::Distance(foveation.nearest)).unwrap();
            let (rgba, depth) = scene(whole.source.size, eyes.depth, seed as u64);
            let place = corner(&inset, &eyes.view(dominant), dominant.index());
            let in_source =
                [0, 1].map(|i| whole.dominant_crop[i] as i32 + place[i] - own.dominant_crop[i] as i32);
            let [width, size] = [whole.source.size[0], own.source.size[0]];
            assert!(in_source[0] >= 0 && in_source[0] as u32 + size <= width);
            let part = |channels: usize, all: &[u8]| cut(all, width, in_source, own.source.size, channels);
            let depths = cut(&depth, width, in_source, own.source.size, 1);
            let run =
                |rgba: &[u8], depth: &[f32], warp| super::subject().in_memory(gl).run(rgba, depth, warp);
            let all = run(&rgba, &depth, &whole.warp).rgba;
            let got = run(&part(4, &rgba), &depths, &own.warp).rgba;
            let other = dominant.other();
            let place = corner(&inset, &eyes.view(other), other.index());
            let want = cut(&all, 300, place, inset.eyes.size, 4);
            // Laws of tiles may differ by an eighth of a pixel, where tiles begin elsewhere; colours are noise.
            let off = |(a, b): (&[u8], &[u8])| (0..4).any(|c| a[c].abs_diff(b[c]) > 40);
            let different = got.chunks(4).zip(want.chunks(4)).filter(|&pair| off(pair)).count();
            println!("{dominant:?}: {different} of {} pixels", got.len() / 4);
            assert!(different * 2000 <= got.len() / 4, "{dominant:?}: {different} of {}", got.len() / 4);
        }
    });
}

/// Nothing is allocated and nothing compiled when a gaze moves.
#[test]
fn a_gaze_that_moves_allocates_and_compiles_nothing() {
    on_every_backend(|gl| {
        let eyes = eyes([160, 150], Eye::Right, DepthConvention::Standard);
        let levels = |turn: f32| {
            let gaze = Gaze::Direction(
                Quat::from_rotation_y(turn) * Quat::from_rotation_x(turn / 2.0) * Vec3::NEG_Z,
            );
            eyes.stereo_views(Some(&Foveation::MEDIUM), gaze).unwrap()
        };
        let first = levels(0.0);
        let make = |level: &ViewLayer| {
            let size = level.synthesis_views(GuardBand::Distance(1.0)).unwrap().source.size;
            let (rgba, depth) = scene(size, eyes.depth, 5);
            let images =
                [texture(gl, size, Format::Rgba8, &rgba), texture(gl, size, Format::R32F, &bytes(&depth))];
            let formats = [(Format::Rgba8, Filter::Nearest)];
            let depth = Some(Format::Depth32F);
            let target = RenderTarget::new(gl, level.eyes.size, &formats, depth).unwrap();
            let outputs = Outputs { depth: true, ..Outputs::default() };
            (images, target, Gather::new(gl, &Options::default(), outputs).unwrap())
        };
        let (mut wide, mut inset) = (make(&first.wide), make(&first.inset.unwrap()));
        let composer = Composer::new(gl, GlState::Leave, false).unwrap();
        let shown = RenderTarget::new(gl, eyes.size, &[(Format::Rgba8, Filter::Nearest)], None).unwrap();
        let mut held = None;
        for i in 0..40 {
            let levels = levels(0.04 * (i - 20) as f32);
            let synthesize =
                |level: &ViewLayer, (images, target, gather): &mut ([Texture; 2], RenderTarget, Gather)| {
                    let source = Source::new(images[0].raw(), images[1].raw());
                    let warp = level.synthesis_views(GuardBand::Distance(1.0)).unwrap().warp;
                    gather.synthesize(source, &warp, &Destination::whole(target)).unwrap();
                };
            synthesize(&levels.wide, &mut wide);
            synthesize(&levels.inset.unwrap(), &mut inset);
            let depth = Some(inset.1.depth().raw());
            let images = LevelImages {
                wide: LevelImage::new(wide.1.color(0).raw()),
                inset: Some(InsetImage { image: LevelImage::new(inset.1.color(0).raw()), depth }),
            };
            composer.compose(&images, &levels.composition(Eye::Left), &Destination::whole(&shown));
            let now = (gl.object_count(), gl.texture_bytes());
            assert_eq!(*held.get_or_insert(now), now, "gaze {i}");
        }
    });
}

/// The picture does not depend on the host's state, which is preserved if asked for.
#[test]
fn composing_keeps_the_hosts_state() {
    on_every_backend(|gl| {
        let case = &cases()[5];
        let textures = Textures::new(gl, case);
        let size = case.levels.shown.size;
        let target = RenderTarget::new(gl, size, &[(Format::Rgba8, Filter::Nearest)], None).unwrap();
        let place = Destination::whole(&target);
        let hostile = Hostile::new(gl);
        clean(gl);
        for gl_state in [GlState::Leave, GlState::Preserve] {
            hostile.set(gl);
            let before = snapshot(gl);
            let composer = Composer::new(gl, gl_state, false).unwrap();
            composer.compose(&textures.images(case), &case.composition(), &place);
            if gl_state == GlState::Preserve {
                assert_eq!(snapshot(gl), before);
            }
            clean(gl);
            case.check(&target.read_rgba8(0, [0, 0], size), &format!("{gl_state:?}"));
            target.bind();
            gl.clear(None);
        }
        hostile.delete(gl);
    });
}
