//! The record of a context's commands, from which frames are estimated.

use yoro_gl::{Filter, Format, GlApi, Program, RasterState, RenderTarget, ShaderSource, Shape, Texture};
use yoro_test_support::record::{Command, Recorder};
use yoro_tests::on_every_backend;

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
