//! Checks what each pass reads and writes against docs/performance.md.

use std::fs;
use std::path::Path;

use yoro::eyes::EyeOptions;
use yoro_assets::ShadingStyle;
use yoro_bench::bench::PreparedContender;
use yoro_bench::bench::frame::{contenders, pass_table, pieces};
use yoro_context::{Backend, Headless};
use yoro_gl::{
    Command, Filter, Format, GlApi, Program, RasterState, RenderTarget, ShaderSource, Shape, Texture,
};
use yoro_render::stereo::StereoFrame;
use yoro_render::{PreparedScene, RendererKind};
use yoro_settings::Settings;
use yoro_tests::{golden::BLESS, on_every_backend, scene};
use yoro_viewer::render_settings;

const BEGIN: &str = "<!-- passes: begin -->\n";
const END: &str = "<!-- passes: end -->";

/// Records frames of every method. Their passes must be those of the table, which YORO_BLESS rewrites.
#[test]
fn every_pass_reads_and_writes_what_the_documents_say() {
    let headless = Headless::open(Backend::Egl).unwrap();
    let gl = headless.gl();
    let mut frames = Vec::new();
    for renderer in RendererKind::ALL {
        let settings = Settings { renderer, shadow_map: 64, ..Settings::default() };
        let settings = render_settings(&settings);
        let mut scene = scene::every_material(ShadingStyle::Realistic);
        scene::keep_plain_and_full(&mut scene);
        let mut prepared = PreparedScene::new(gl, scene, &settings).unwrap();
        let options = EyeOptions { size: [96, 64], ..EyeOptions::default() };
        let pair = options.pair(prepared.scene.viewpoints[0].pose());
        let mut frame = StereoFrame::new(gl, pair.size).unwrap();
        for contender in contenders(renderer) {
            let (method, options) = contender.method().unwrap();
            let mut ready = PreparedContender::new(gl, method, &settings, &options).unwrap();
            gl.record();
            ready.render(&mut prepared, &pair, &mut frame).unwrap();
            frames.push((renderer, contender.name(), pieces(&gl.take_record())));
        }
    }
    let table = pass_table(&frames);
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/performance.md");
    let text = fs::read_to_string(&path).unwrap();
    let (before, rest) = text.split_once(BEGIN).expect("the mark before the table");
    let (there, after) = rest.split_once(END).expect("the mark behind the table");
    if std::env::var_os(BLESS).is_some() {
        fs::write(&path, format!("{before}{BEGIN}{table}{END}{after}")).unwrap();
    } else {
        assert_eq!(there, table, "run this test with {BLESS}=1, and look at git diff docs/performance.md");
    }
}

/// A record has the pass, the program, images and textures and, with desktop GL, the number of samples drawn.
#[test]
fn a_record_says_what_was_drawn() {
    let done = on_every_backend(|gl| {
        let formats = [(Format::Rgba8, Filter::Nearest)];
        let target = RenderTarget::new(gl, [8, 4], &formats, Some(Format::Depth24))?;
        let source = Texture::new(gl, [16, 2], Format::Rgba8, Filter::Linear)?;
        let program = Program::new(gl, ShaderSource::Screen("render/fxaa.frag"), &[])?;
        let draw = || {
            gl.pass("smooth", || {
                target.bind();
                gl.set_raster_state(&RasterState::SCREEN);
                program.bind().texture("source", 0, source.raw()).texture("unused", 1, source.raw());
                gl.draw_screen();
            });
        };
        draw();
        assert_eq!(gl.take_record(), [], "only what comes after the start");
        gl.record();
        gl.within_columns(Some([2, 5]), draw);
        let commands = gl.take_record();
        let [Command::Draw(drawn)] = &commands[..] else { panic!("{commands:?}") };
        assert_eq!((drawn.pass, drawn.area, drawn.shape), ("smooth", [3, 4], Shape::Screen));
        assert_eq!(drawn.program.files, ["screen.vert", "render/fxaa.frag"]);
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
