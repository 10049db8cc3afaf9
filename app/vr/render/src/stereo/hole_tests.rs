//! Rendered holes: against a render of the same eye, and against filled ones.

use super::tests::{Rig, equal_share, local, pair, scene, session_of, smooth};
use super::*;
use crate::view::{DepthCopy, RenderSettings};
use yoro::eyes::{DepthConvention, Eye, EyePair, Foveation, Gaze};
use yoro_assets::{Scene, ShadingStyle};
use yoro_context::{Backend, Headless};
use yoro_gl::{Capabilities, Destination, Format, Profiling, RenderTarget};

/// The eye that is not rendered: by two renders, with filled holes, and with rendered ones.
struct Pictures {
    truth: Vec<u8>,
    filled: Vec<u8>,
    rendered: Vec<u8>,
}

fn options(holes: HoleMethod) -> StereoOptions {
    StereoOptions { holes, policy: None, ..StereoOptions::default() }
}

impl Pictures {
    fn new(rig: &mut Rig, settings: &RenderSettings, pair: &EyePair) -> Pictures {
        let gl = rig.gl();
        let mut draw =
            |method, holes| rig.render(&mut session_of(&gl, method, settings, &options(holes)), pair);
        let dominant = pair.dominant.index();
        let truth = draw(Method::Conventional, HoleMethod::Filled);
        let filled = draw(Method::Synthesized, HoleMethod::Filled);
        let rendered = draw(Method::Synthesized, HoleMethod::Rendered);
        let same = equal_share(&filled[dominant], &rendered[dominant]);
        // Without glass, an eye without a transparent surface is composited in its own target.
        assert!(same == 1.0, "the rendered eye: {same}");
        let [truth, filled, rendered] = [truth, filled, rendered].map(|eyes| eyes[1 - dominant].clone());
        Pictures { truth, filled, rendered }
    }

    /// The pixels that rendering changes: their number, and how many of them have the truth's colour.
    fn changed(&self) -> (usize, usize) {
        let pixels = self.truth.chunks(4).zip(self.filled.chunks(4)).zip(self.rendered.chunks(4));
        let changed = pixels.filter(|((_, filled), rendered)| filled != rendered);
        changed.fold((0, 0), |(all, right), ((truth, _), rendered)| {
            let is_right = (0..3).all(|c| truth[c].abs_diff(rendered[c]) <= 2);
            (all + 1, right + usize::from(is_right))
        })
    }

    /// The squared errors with filled and with rendered holes.
    fn errors(&self) -> [u64; 2] {
        let squares = |image: &[u8]| {
            let pixels = image.chunks(4).zip(self.truth.chunks(4));
            pixels.flat_map(|(a, b)| (0..3).map(|c| u64::from(a[c].abs_diff(b[c])).pow(2))).sum()
        };
        [squares(&self.filled), squares(&self.rendered)]
    }
}

fn of_style(style: ShadingStyle) -> Scene {
    Scene { style, ..scene() }
}

/// Pixels in holes are those of a render, behind glass, too, whatever the driver lacks.
#[test]
fn pixels_in_holes_are_true() {
    let limits: [fn(&mut Capabilities); 3] =
        [|_| {}, |capabilities| capabilities.multisample_textures = false, Capabilities::limit_to_es_300];
    for (i, limit) in limits.into_iter().enumerate() {
        let head = Headless::open_limited(Backend::Egl, limit).unwrap();
        for settings in [local(), smooth()] {
            let mut rig = Rig::new(head.gl(), &settings);
            let conventions =
                [(Eye::Left, DepthConvention::Standard), (Eye::Right, DepthConvention::Reversed)];
            for (dominant, convention) in conventions {
                let pictures = Pictures::new(&mut rig, &settings, &pair(dominant, convention));
                let (changed, right) = pictures.changed();
                let what =
                    format!("limit {i}, {} samples, {dominant:?}: {right} of {changed}", settings.msaa);
                println!("{what}");
                assert!(changed > 150 && right * 100 >= changed * 97, "{what}");
            }
        }
        assert_eq!(head.gl().take_errors(), None);
    }
}

/// Light spreads over what is drawn in holes as over all else, and outlines are drawn there.
#[test]
fn holes_have_bloom_and_outlines() {
    let head = Headless::open(Backend::Egl).unwrap();
    for (style, settings) in [
        (ShadingStyle::Realistic, RenderSettings { bloom: true, ..smooth() }),
        (ShadingStyle::Anime, smooth()),
        (ShadingStyle::Anime, RenderSettings { bloom: true, ..smooth() }),
        (ShadingStyle::Anime, local()),
    ] {
        let mut rig = Rig::of(head.gl(), &settings, of_style(style));
        let eyes = pair(Eye::Right, DepthConvention::Reversed);
        let pictures = Pictures::new(&mut rig, &settings, &eyes);
        let (changed, right) = pictures.changed();
        let [filled, rendered] = pictures.errors();
        let what =
            format!("{style:?}, {} samples: {filled}, {rendered}, {right} of {changed}", settings.msaa);
        println!("{what}");
        assert!(rendered * 3 < filled * 2 && right * 100 > changed * 80, "{what}");
    }
    assert_eq!(head.gl().take_errors(), None);
}

/// A compositor that reads depth gets that of what is drawn in holes, and the picture does not change.
#[test]
fn depth_in_holes_is_true() {
    let head = Headless::open(Backend::Egl).unwrap();
    let gl = head.gl();
    let copy = DepthCopy::new(gl).unwrap();
    let eyes = pair(Eye::Right, DepthConvention::Standard);
    for settings in [local(), smooth()] {
        let mut rig = Rig::new(gl, &settings);
        let image = RenderTarget::new(gl, eyes.size, &[], Some(Format::Depth32F)).unwrap();
        let mut depth = |method, holes| {
            let mut session = session_of(gl, method, &settings, &options(holes));
            let plain = rig.render(&mut session, &eyes);
            let to = Destination::whole(&image);
            let target = |eye, to_eye| EyeTarget {
                depth: (eye == Eye::Left).then_some(DepthTarget { to, copy: &copy }),
                ..to_eye
            };
            rig.render_with(&mut session, &eyes, target);
            let [left, _] = rig.images();
            (plain[0] == left, super::tests::distances(gl, &image, &eyes))
        };
        let (_, truth) = depth(Method::Conventional, HoleMethod::Filled);
        let (_, filled) = depth(Method::Synthesized, HoleMethod::Filled);
        let (is_same, rendered) = depth(Method::Synthesized, HoleMethod::Rendered);
        assert!(is_same, "{} samples", settings.msaa);
        // A pixel of several surfaces has the depth of one of them.
        let width = eyes.size[0] as usize;
        let surfaces = |i: usize| {
            let around = [0, width - 1, width, width + 1, 2 * width].map(|n| (i + n).checked_sub(width));
            around.into_iter().flatten().filter_map(|at| truth.get(at))
        };
        // A tenth of a pixel of disparity.
        let tolerance = 0.1 / (eyes.focal_length_pixels() * eyes.ipd());
        let differ = |a: f32, b: f32| (1.0 / a - 1.0 / b).abs() > tolerance;
        let changed: Vec<usize> = (0..truth.len()).filter(|i| differ(filled[*i], rendered[*i])).collect();
        let right = changed.iter().filter(|i| surfaces(**i).any(|depth| !differ(rendered[**i], *depth)));
        let (right, changed) = (right.count(), changed.len());
        println!("{} samples: {right} of {changed}", settings.msaa);
        assert!(changed > 100 && right * 100 >= changed * 98, "{right} of {changed}");
    }
    assert_eq!(gl.take_errors(), None);
}

/// Of eyes with an inset, only the inset's holes are rendered; and no frame after the first ones allocates anything.
#[test]
fn only_the_insets_holes_are_rendered() {
    let head = Headless::open(Backend::Egl).unwrap();
    let (gl, settings) = (head.gl(), smooth());
    for style in [ShadingStyle::Realistic, ShadingStyle::Anime] {
        let mut rig = Rig::of(gl, &settings, of_style(style));
        let mut session = session_of(gl, Method::Synthesized, &settings, &options(HoleMethod::Rendered));
        let eyes = pair(Eye::Right, DepthConvention::Reversed);
        let foveation = Foveation { radius: 0.2, ..Foveation::MEDIUM };
        let foveated = eyes.stereo_views(Some(&foveation), Gaze::Axes(eyes.axes())).unwrap();
        let mut shown = StereoFrame::new(gl, eyes.size).unwrap();
        let mut held = None;
        for i in 0..6 {
            for views in [eyes.into(), foveated] {
                gl.set_profiling(Profiling::Finish);
                rig.frame(&mut session, &views, shown.fit(eyes.size).unwrap());
                let drawn = gl.take_pass_times().iter().filter(|pass| pass.name == "holes").count();
                gl.set_profiling(Profiling::Off);
                // First with one sample in each pixel, if there are outlines.
                assert_eq!(drawn, if style == ShadingStyle::Anime { 2 } else { 1 });
            }
            let now = (gl.object_count(), gl.texture_bytes());
            assert!(i < 2 || *held.get_or_insert(now) == now, "{style:?}, frame {i}");
        }
    }
    assert_eq!(gl.take_errors(), None);
}

#[test]
fn the_papers_pipeline_cannot_leave_holes_open() {
    let head = Headless::open(Backend::Egl).unwrap();
    let synthesis = PipelineOptions { pipeline: Pipeline::Paper, ..PipelineOptions::default() };
    let options = StereoOptions { synthesis, ..options(HoleMethod::Rendered) };
    let refused = StereoSession::new(head.gl(), Method::Synthesized.into(), &local(), &options).err();
    assert!(refused.unwrap().to_string().contains("holes=filled"));
}
