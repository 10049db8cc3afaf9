//! The record of a context's passes, from which frames are estimated.

use yoro_gl::{Filter, Format, GlApi, Program, RasterState, RenderTarget, ShaderSource, Shape, Texture};
use yoro_test_support::laws::on_every_backend;
use yoro_test_support::record::Recorder;

/// A record has the pass, the program, images and, with desktop GL, the number of samples drawn.
#[test]
fn a_record_says_what_was_drawn() {
    on_every_backend(|gl| {
        let recorder = Recorder::new(gl);
        let formats = [(Format::Rgba8, Filter::Nearest)];
        let target = RenderTarget::new(gl, [8, 4], &formats, Some(Format::Depth24)).unwrap();
        let source = Texture::new(gl, [16, 2], Format::Rgba8, Filter::Linear).unwrap();
        let program = Program::new(gl, ShaderSource::Screen("render/bloom_down.frag"), &[]).unwrap();
        let draw = || {
            gl.pass("smooth").read("source", &source).write(target.images()).run(|| {
                target.bind();
                gl.set_raster_state(&RasterState::SCREEN);
                program.bind().texture("source", 0, source.raw());
                gl.draw_screen();
            });
        };
        draw();
        assert_eq!(recorder.take(), [], "only what comes after the start");
        recorder.start();
        draw();
        let passes = recorder.take();
        let [pass] = &passes[..] else { panic!("{passes:?}") };
        let [drawn] = &pass.draws[..] else { panic!("{pass:?}") };
        assert_eq!((pass.declaration.name, drawn.area, drawn.shape), ("smooth", [8, 4], Shape::Screen));
        assert_eq!(drawn.program.files, ["screen.vert", "render/bloom_down.frag"]);
        let [read] = &pass.declaration.reads[..] else { panic!("{pass:?}") };
        assert_eq!((read.uniform, read.image.size), ("source", [16, 2]));
        let written: Vec<_> = pass.declaration.writes.iter().map(|write| write.image.format).collect();
        assert_eq!(written, [Format::Rgba8, Format::Depth24]);
        assert!(pass.declaration.writes.iter().all(|write| write.is_stored && !write.is_loaded));
        let counts = gl.capabilities().api == GlApi::Desktop;
        assert_eq!(drawn.samples_passed, counts.then_some(8 * 4));
    });
}
