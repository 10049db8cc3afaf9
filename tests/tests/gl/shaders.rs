//! Every shader file compiles in every variant.

use yoro_gl::{Program, ShaderSource};
use yoro_test_support::laws::on_every_backend;
use yoro_tests::programs::{self, Variants};

#[test]
fn every_shader_compiles_in_every_variant() {
    on_every_backend(|gl| {
        let made = programs::make(gl, Variants::Every).unwrap();
        // Only unit tests of the renderer use this shader, to read depth back.
        Program::new(gl, ShaderSource::Screen("render/depth_copy.frag"), &[]).unwrap();
        // Only drivers without multisample textures need this one.
        Program::new(gl, ShaderSource::Screen("render/keep_sample.frag"), &[]).unwrap();
        let used = programs::files(&made).unwrap();
        // Only wgpu uses this one, which is not in GLSL ES.
        let others = ["render/depth_copy.frag", "render/keep_sample.frag", "synthesis/nearest_depth.frag"];
        let is_used = |file: &str| used.contains(file) || others.contains(&file);
        let unused: Vec<_> = yoro_shaders::files().filter(|file| !is_used(file)).collect();
        assert!(unused.is_empty(), "no construction of this test uses {}", unused.join(", "));
    });
}

#[test]
fn a_mistake_in_a_shader_names_file_and_line() {
    on_every_backend(|gl| {
        let broken = [("SOURCE_MAP", String::new()), ("texelFetch", "nothing_of_this_name".to_owned())];
        let source = ShaderSource::Screen("synthesis/gather/march.frag");
        let message = match Program::new(gl, source, &broken) {
            Ok(_) => panic!("a broken shader compiles"),
            Err(error) => error.to_string(),
        };
        let start = "fragment shader synthesis/gather/march.frag failed: ";
        assert!(message.starts_with(start), "{message}");
        assert!(message.contains(".glsl:") || message.contains(".frag:"), "{message}");
        assert!(message.contains("nothing_of_this_name"), "{message}");
    });
}
