//! Checks what each pass reads and writes against `tests/golden/passes.txt`.

use std::fs;
use std::path::Path;

use yoro::eyes::EyeOptions;
use yoro_assets::ShadingStyle;
use yoro_bench::bench::{PreparedContender, frame_contenders};
use yoro_context::{Backend, Headless};
use yoro_estimate::{Command, Recorder, pass_table, pieces};
use yoro_gl::{Filter, Format, GlApi, Program, RasterState, RenderTarget, ShaderSource, Shape, Texture};
use yoro_render::PreparedScene;
use yoro_render::stereo::StereoFrame;
use yoro_settings::Settings;
use yoro_tests::{golden::BLESS, on_every_backend, scene};
use yoro_viewer::render_settings;

/// Records frames of every method. Their passes must be those of the table, which YORO_BLESS rewrites.
#[test]
fn every_pass_reads_and_writes_what_the_table_says() {
    let headless = Headless::open(Backend::Egl).unwrap();
    let gl = headless.gl();
    let recorder = Recorder::new(gl);
    let settings = render_settings(&Settings { shadow_map: 64, ..Settings::default() });
    let mut scene = scene::every_material(ShadingStyle::Realistic);
    scene::keep_plain_and_full(&mut scene);
    let mut prepared = PreparedScene::new(gl, scene, &settings).unwrap();
    let options = EyeOptions { size: [96, 64], ..EyeOptions::default() };
    let pair = options.pair(prepared.scene.viewpoints[0].pose());
    let mut frame = StereoFrame::new(gl, pair.size).unwrap();
    let mut frames = Vec::new();
    for contender in frame_contenders() {
        let (method, options) = contender.method().unwrap();
        let mut ready = PreparedContender::new(gl, method, &settings, &options).unwrap();
        recorder.start();
        ready.render(&mut prepared, &pair, &mut frame).unwrap();
        frames.push((contender.name(), pieces(&recorder.take())));
    }
    let table = pass_table(&frames);
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("golden/passes.txt");
    if std::env::var_os(BLESS).is_some() {
        fs::write(&path, table).unwrap();
    } else {
        let there = fs::read_to_string(&path).unwrap();
        assert_eq!(there, table, "run this test with {BLESS}=1, and look at its git diff");
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
        gl.within_columns(Some([2, 5]), draw);
        let commands = recorder.take();
        let [Command::Draw(drawn)] = &commands[..] else { panic!("{commands:?}") };
        assert_eq!((drawn.pass, drawn.area, drawn.shape), ("smooth", [3, 4], Shape::Screen));
        assert_eq!(drawn.program.files, ["screen.vert", "render/bloom_down.frag"]);
        let images = drawn.target.as_ref().unwrap();
        assert_eq!((images.color[0].size, images.depth.unwrap().format), ([8, 4], Format::Depth24));
        let [(name, image)] = &drawn.textures[..] else { panic!("{:?}", drawn.textures) };
        assert_eq!((name.as_str(), image.size), ("source", [16, 2]));
        assert!(drawn.writes_color && !drawn.uses_depth && !drawn.blends);
        let counts = gl.capabilities().api == GlApi::Desktop;
        assert_eq!(drawn.samples_passed, counts.then_some(3 * 4));
        Ok(())
    });
    done.unwrap();
}
