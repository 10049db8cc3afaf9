//! Every shader file compiles in every variant.

use std::collections::BTreeSet;
use std::rc::Rc;

use glam::Vec3;
use yoro::gl::{self, Context, Program, ShaderSource};
use yoro::inpaint::{self, PatcherKind, PatcherOptions};
use yoro::render::{DepthCopy, GpuScene, RenderSettings, Renderer};
use yoro::scene::{Scene, ShadingStyle};
use yoro::stereo::{self, AntiAliasing, Method, StereoOptions};
use yoro::synthesis::{self, ImBufferSize, Outputs, PaperOptions, Pipeline, SynthesisOptions};
use yoro_tests::{on_every_backend, scene};

const STYLES: [ShadingStyle; 5] = [
    ShadingStyle::Realistic,
    ShadingStyle::Cartoon,
    ShadingStyle::LowPoly,
    ShadingStyle::Voxel,
    ShadingStyle::Anime,
];

fn synthesis(gl: &Rc<Context>) -> anyhow::Result<()> {
    let mut options = vec![];
    for pipeline in Pipeline::ALL {
        options.push(SynthesisOptions { pipeline, ..Default::default() });
    }
    for (strict, linear_interpolation) in [(false, false), (true, false), (true, true)] {
        for (divisor, kernel_height) in [(1, 1), (4, 15)] {
            let imbuffer = ImBufferSize::Divisor(divisor);
            let paper = PaperOptions { imbuffer, linear_interpolation, kernel_height, strict };
            options.push(SynthesisOptions { pipeline: Pipeline::Paper, paper });
        }
    }
    for options in options {
        for (depth, source_map) in [(false, false), (false, true), (true, false), (true, true)] {
            synthesis::create(gl, &options, Outputs { depth, source_map })?;
        }
    }
    Ok(())
}

/// Compiles what a scene needs by every method that the driver has.
fn methods(gl: &Rc<Context>, settings: &RenderSettings, scene: &GpuScene) -> anyhow::Result<()> {
    let mut renderer = Renderer::new(gl, settings, scene)?;
    for method in Method::ALL {
        match method.supported(gl.capabilities()) {
            Ok(()) => stereo::create(gl, method, settings, &StereoOptions::default())?
                .prepare(&mut renderer, scene)?,
            Err(reason) => eprintln!("SKIPPED: {} is not compiled here: {reason}", method.name()),
        }
    }
    Ok(())
}

/// Compiles what a scene needs under all settings that change a shader.
fn renderer(gl: &Rc<Context>, scene: Scene, all_settings: bool) -> anyhow::Result<()> {
    let scene = GpuScene::upload(gl, scene)?;
    let settings = RenderSettings { shadow_map_size: 64, ..RenderSettings::default() };
    methods(gl, &settings, &scene)?;
    if all_settings {
        methods(gl, &RenderSettings { shadow_map_size: 0, ..settings.clone() }, &scene)?;
        methods(gl, &RenderSettings { ssao: false, bloom: false, ..settings.clone() }, &scene)?;
        methods(gl, &RenderSettings { ssao_half_size: true, ..settings }, &scene)?;
    }
    Ok(())
}

fn rendering(gl: &Rc<Context>) -> anyhow::Result<()> {
    for style in STYLES {
        let mut scene = scene::every_material(style);
        renderer(gl, scene.clone(), false)?;
        // No map and all maps, in every kind of opacity, stand for the combinations under other settings.
        scene::keep_plain_and_full(&mut scene);
        renderer(gl, scene.clone(), true)?;
        scene.sky.sun_color = Vec3::ZERO;
        renderer(gl, scene, true)?;
    }
    Ok(())
}

fn viewer(gl: &Rc<Context>) -> anyhow::Result<()> {
    for defines in [vec![], vec![("CHROMATIC", String::new())]] {
        let source = ShaderSource::Raster { vertex: "viewer/lens.vert", fragment: "viewer/lens.frag" };
        Program::new(gl, source, &defines)?;
    }
    Program::new(gl, ShaderSource::Screen("viewer/hud.frag"), &[])?;
    DepthCopy::new(gl)?;
    Program::new(gl, ShaderSource::Screen("openxr/transfer.frag"), &[])?;
    let hidden = ShaderSource::Raster { vertex: "openxr/hidden.vert", fragment: "openxr/hidden.frag" };
    Program::new(gl, hidden, &[])?;
    Ok(())
}

fn stereo(gl: &Rc<Context>) -> anyhow::Result<()> {
    let settings = RenderSettings::default();
    for anti_aliasing in [AntiAliasing::After, AntiAliasing::Before, AntiAliasing::Off] {
        let options = StereoOptions { anti_aliasing, near_field: Some(1.0), ..StereoOptions::default() };
        for method in Method::ALL.into_iter().filter(|m| m.supported(gl.capabilities()).is_ok()) {
            stereo::create(gl, method, &settings, &options)?;
        }
    }
    Ok(())
}

fn patchers(gl: &Rc<Context>) -> anyhow::Result<()> {
    // The others have no shaders.
    for kind in [PatcherKind::Paper, PatcherKind::Gather, PatcherKind::Median, PatcherKind::Xiao] {
        inpaint::create(gl, kind, &PatcherOptions::default())?;
    }
    Ok(())
}

#[test]
fn every_file_in_every_variant() {
    on_every_backend(|gl| {
        synthesis(gl)?;
        rendering(gl)?;
        stereo(gl)?;
        patchers(gl)?;
        viewer(gl)?;
        // Only the renderer's unit tests read depth back.
        Program::new(gl, ShaderSource::Screen("render/depth_copy.frag"), &[])?;
        let used: BTreeSet<String> = gl.used_shader_files().into_iter().collect();
        let unused: Vec<_> = gl::shader_files().into_iter().filter(|file| !used.contains(*file)).collect();
        anyhow::ensure!(unused.is_empty(), "no construction of this test uses {}", unused.join(", "));
        Ok(())
    })
    .unwrap();
}

#[test]
fn a_mistake_in_a_shader_names_file_and_line() {
    on_every_backend(|gl| {
        let broken = [("SOURCE_MAP", String::new()), ("texelFetch", "nothing_of_this_name".to_owned())];
        let source = ShaderSource::Screen("synthesis/gather/march.frag");
        let message = match Program::new(gl, source, &broken) {
            Ok(_) => anyhow::bail!("a broken shader compiles"),
            Err(error) => error.to_string(),
        };
        let start = "fragment shader synthesis/gather/march.frag failed: ";
        anyhow::ensure!(message.starts_with(start), "{message}");
        anyhow::ensure!(message.contains(".glsl:") || message.contains(".frag:"), "{message}");
        anyhow::ensure!(message.contains("nothing_of_this_name"), "{message}");
        Ok(())
    })
    .unwrap();
}
