//! Checks what each pass reads, loads and stores against what it declares.

use std::collections::BTreeSet;
use std::rc::Rc;

use yoro::eyes::{Eye, EyeOptions, EyePair, Ndc};
use yoro_assets::motion::{Carrier, MovingMesh, Node, Track};
use yoro_assets::{Motion, Scene, ShadingStyle};
use yoro_bench::bench::Contender;
use yoro_context::{Backend, Headless};
use yoro_estimate::{Assumed, Command, Piece, Recorder, pieces};
use yoro_gl::{
    Capabilities, Context, Destination, Filter, Format, GlApi, Program, RasterState, RenderTarget,
    ShaderSource, Shape, Texture,
};
use yoro_render::stereo::{
    self, DepthTarget, Method, MotionTarget, NearFieldPolicy, Pipeline, StereoFrame,
    StereoOptions,
};
use yoro_render::{DepthCopy, DepthResolve, PASSES, PreparedScene, RenderSettings, TilePart};
use yoro_tests::{on_every_backend, scene};

/// A part of a declaration that was seen: the pass, and what it read, loaded or stored.
type Seen = BTreeSet<(&'static str, String)>;

/// Takes away what a lesser driver lacks.
type Limit = fn(&mut Capabilities);

/// Records frames of every method in each style, with each way to get depth. No pass may read, load or store what it does
/// not declare, and no declaration may be broader than what is done.
#[test]
fn passes_do_what_they_declare() {
    let mut seen = Seen::new();
    let limits: [(Limit, DepthResolve); 3] = [
        (|capabilities| capabilities.multisample_textures = false, DepthResolve::InColor),
        (|capabilities| capabilities.tile_samples = false, DepthResolve::Samples),
        (Capabilities::limit_to_es_300, DepthResolve::SingleSample),
    ];
    for (limit, way) in limits {
        let headless = Headless::open_limited(Backend::Egl, limit).unwrap();
        let gl = headless.gl();
        let recorder = Recorder::new(gl);
        for style in [ShadingStyle::Realistic, ShadingStyle::Anime] {
            for msaa in [4, 1] {
                let settings = RenderSettings { msaa, shadow_map_size: 64, ..RenderSettings::default() };
                let mut scene = scene::every_material(style);
                scene::keep_plain_and_full(&mut scene);
                if style == ShadingStyle::Anime {
                    move_squares(&mut scene);
                }
                recorder.start();
                let mut prepared = PreparedScene::new(gl, scene, &settings).unwrap();
                let made = pieces(&recorder.take(), &Assumed::default());
                made.iter().for_each(|piece| check(piece, false, &mut seen));
                if msaa > 1 && style == ShadingStyle::Realistic {
                    assert_eq!(prepared.renderer.nearest_depth(), way);
                }
                let reads_samples = prepared.renderer.nearest_depth() == DepthResolve::Samples;
                for (method, options) in frames() {
                    if settings.supports(method, gl.capabilities()).is_err() {
                        continue;
                    }
                    for piece in record(gl, &recorder, &mut prepared, method, &settings, &options) {
                        check(&piece, reads_samples, &mut seen);
                    }
                }
            }
        }
    }
    let mut idle = Vec::new();
    for pass in PASSES {
        let loads = pass.loads.iter().map(|part| format!("loads {part:?}"));
        let stores = pass.stores.iter().map(|part| format!("stores {part:?}"));
        let reads = pass.reads.iter().map(|name| format!("reads {name}"));
        idle.extend(
            reads.chain(loads).chain(stores).map(|what| (pass.name, what)).filter(|it| !seen.contains(it)),
        );
    }
    assert!(idle.is_empty(), "declared, and never done: {idle:?}");
}

/// Returns every method, and synthesis with each option that adds a pass. The pipeline of the paper is measured, not built
/// upon.
fn frames() -> Vec<(Method, StereoOptions)> {
    let paper = Contender::Synthesized(Pipeline::Paper);
    let methods = Contender::methods().into_iter().filter(|contender| *contender != paper);
    let mut frames: Vec<_> = methods.filter_map(Contender::method).collect();
    let synthesis = StereoOptions { policy: None, ..StereoOptions::default() };
    for method in [Method::Conventional, Method::Synthesized] {
        frames.push((method, StereoOptions { motion_vectors: true, ..synthesis }));
    }
    frames.push((Method::Synthesized, StereoOptions { near_field: Some(3.0), ..synthesis }));
    frames
        .push((Method::Synthesized, StereoOptions { policy: Some(NearFieldPolicy::default()), ..synthesis }));
    frames
}

/// Moves all squares of a scene but its floor.
fn move_squares(scene: &mut Scene) {
    let vertices = 0..scene.model.vertices.len() - 4;
    let rest = scene.model.vertices[vertices.clone()].to_vec();
    let values = vec![0.0, 0.0, 0.0, 0.1, 0.0, 0.0];
    let moves = Track { times: vec![0.0, 1.0], values, ..Track::default() };
    let nodes = vec![Node { moves: Some(moves), ..Node::default() }];
    let meshes = vec![MovingMesh { vertices, rest, carrier: Carrier::Node(0), morph: None }];
    scene.motion = Motion { loops: vec![1.0], nodes, meshes, ..Motion::default() };
}

/// Returns what a method's third frame does, plainly, with depth for a compositor, and with motion vectors.
fn record(
    gl: &Rc<Context>,
    recorder: &Recorder,
    prepared: &mut PreparedScene,
    method: Method,
    settings: &RenderSettings,
    options: &StereoOptions,
) -> Vec<Piece> {
    let eyes = EyeOptions { size: [96, 64], ..EyeOptions::default() };
    let pair: EyePair = eyes.pair(prepared.scene.viewpoints[0].pose());
    let frame = StereoFrame::new(gl, pair.size).unwrap();
    let depth = RenderTarget::new(gl, pair.size, &[], Some(Format::Depth24)).unwrap();
    let copy = DepthCopy::new(gl).unwrap();
    let mut method = stereo::create(gl, method, settings, options).unwrap();
    let mut all = Vec::new();
    let formats = [(Format::Rgba16F, Filter::Nearest)];
    let vectors = RenderTarget::new(gl, [24, 16], &formats, Some(Format::Depth32F)).unwrap();
    let motion =
        |eye| MotionTarget { to: Destination::whole(&vectors), former: pair.view(eye), ndc: Ndc::ZeroToOne };
    for more in 0..3 {
        let mut to = frame.targets();
        for (eye, to) in Eye::BOTH.into_iter().zip(&mut to) {
            to.depth = (more == 1).then(|| DepthTarget { to: Destination::whole(&depth), copy: &copy });
            to.motion = (more == 2).then(|| motion(eye));
        }
        for _ in 0..2 {
            method.render_to(&mut prepared.renderer, &prepared.scene, &pair, &to).unwrap();
        }
        recorder.start();
        method.render_to(&mut prepared.renderer, &prepared.scene, &pair, &to).unwrap();
        all.extend(pieces(&recorder.take(), &Assumed::default()));
    }
    all
}

/// Notes what a piece of work reads, loads and stores, which its passes must declare.
fn check(piece: &Piece, reads_samples: bool, seen: &mut Seen) {
    // The pipeline of the paper is measured, not built upon.
    if piece.passes.iter().any(|name| name.starts_with("paper ")) {
        return;
    }
    let passes: Vec<_> = piece
        .passes
        .iter()
        // What has no name is done once.
        .filter(|name| !name.is_empty())
        .map(|name| {
            let found = PASSES.iter().find(|pass| pass.name == *name);
            found.unwrap_or_else(|| panic!("{name:?} is not declared in app/vr/render/src/view/declared.rs"))
        })
        .collect();
    let Some(first) = passes.first() else { return };
    for (name, ..) in piece.textures.iter().filter(|(.., bytes)| *bytes > 0.0) {
        let readers: Vec<_> = passes.iter().filter(|pass| pass.reads.contains(&name.as_str())).collect();
        assert!(!readers.is_empty(), "{:?} do not declare to read {name}", piece.passes);
        seen.extend(readers.iter().map(|pass| (pass.name, format!("reads {name}"))));
    }
    for traffic in &piece.images {
        let part = match (traffic.image.samples > 1, traffic.image.format.is_depth()) {
            (true, _) => TilePart::Samples,
            (false, true) => TilePart::Depth,
            (false, false) => TilePart::Color,
        };
        if traffic.loaded {
            assert!(
                first.loads.contains(&part),
                "{} does not declare to load {part:?}: {piece:?}",
                first.name
            );
            seen.insert((first.name, format!("loads {part:?}")));
        }
        if traffic.stored {
            let storers: Vec<_> = passes.iter().filter(|pass| pass.stores.contains(&part)).collect();
            assert!(!storers.is_empty(), "{:?} do not declare to store {part:?}: {piece:?}", piece.passes);
            seen.extend(storers.iter().map(|pass| (pass.name, format!("stores {part:?}"))));
            assert!(part != TilePart::Samples || reads_samples, "samples leave the tile: {piece:?}");
        }
    }
}

/// A record has the pass, the program, images and textures and, with desktop GL, the number of samples drawn.
#[test]
fn a_record_says_what_was_drawn() {
    let done = on_every_backend(|gl| {
        let recorder = Recorder::new(gl);
        let formats = [(Format::Rgba8, Filter::Nearest)];
        let target = RenderTarget::new(gl, [8, 4], &formats, Some(Format::Depth24))?;
        let source = Texture::new(gl, [16, 2], Format::Rgba8, Filter::Linear)?;
        let program = Program::new(gl, ShaderSource::Screen("render/bloom_down.frag"), &[])?;
        let draw = || {
            gl.pass("smooth", || {
                target.bind();
                gl.set_raster_state(&RasterState::SCREEN);
                program.bind().texture("source", 0, source.raw()).texture("unused", 1, source.raw());
                gl.draw_screen();
            });
        };
        draw();
        assert_eq!(recorder.take(), [], "only what comes after the start");
        recorder.start();
        draw();
        let commands = recorder.take();
        let [Command::Draw(drawn)] = &commands[..] else { panic!("{commands:?}") };
        assert_eq!((drawn.pass, drawn.area, drawn.shape), ("smooth", [8, 4], Shape::Screen));
        assert_eq!(drawn.program.files, ["screen.vert", "render/bloom_down.frag"]);
        let images = drawn.target.as_ref().unwrap();
        assert_eq!((images.color[0].size, images.depth.unwrap().format), ([8, 4], Format::Depth24));
        let [(name, image)] = &drawn.textures[..] else { panic!("{:?}", drawn.textures) };
        assert_eq!((name.as_str(), image.size), ("source", [16, 2]));
        assert!(!drawn.uses_depth && !drawn.blends);
        let counts = gl.capabilities().api == GlApi::Desktop;
        assert_eq!(drawn.samples_passed, counts.then_some(8 * 4));
        Ok(())
    });
    done.unwrap();
}
