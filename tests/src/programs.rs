//! Every variant of every shader program, built by the library in the same way as for the application.

use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

use anyhow::anyhow;
use glam::Vec3;
use serde::Serialize;
use yoro::opengl::{AnyView, Composer, Gather, GlState, GuessedDepth, Motion, Options, Outputs};
use yoro::synthesis::{HoleMark, Holes};
use yoro_assets::{Scene, ShadingStyle};
use yoro_bench::inpaint::{self, PatcherKind, PatcherOptions};
use yoro_gl::{Context, Program, ProgramRecipe, ShaderSource};
use yoro_render::stereo::{
    HoleMethod, ImBufferSize, Method, Paper, PaperOptions, StereoOptions, StereoSession,
};
use yoro_render::{DepthCopy, PreparedScene, RenderSettings};
use yoro_shaders::{Assembled, MissingFile};
use yoro_test_support::record::Recorder;

use crate::{is_tested, scene};

/// The variants of the renderer's programs to build. Other programs are always built in every variant, except synthesis
/// from parts, from layers of textures and from pairs of depths.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variants {
    /// All combinations of maps, opacity, style, light and settings, and synthesis from every kind of source.
    Every,
    /// With default settings, materials without maps and with all maps: the cost of other materials lies between these.
    /// All methods in the realistic style only.
    Extreme,
}

/// Builds all programs in a context, and returns their files and defines.
///
/// # Errors
/// Fails if the driver rejects a program.
pub fn make(gl: &Rc<Context>, variants: Variants) -> anyhow::Result<BTreeSet<ProgramRecipe>> {
    let recorder = Recorder::new(gl);
    synthesis(gl, variants)?;
    rendering(gl, variants)?;
    vectors(gl)?;
    patchers(gl)?;
    viewer(gl)?;
    Ok(recorder.programs().iter().map(|recipe| recipe.as_ref().clone()).collect())
}

fn synthesis(gl: &Rc<Context>, variants: Variants) -> anyhow::Result<()> {
    let outputs = [(false, false), (false, true), (true, false), (true, true)]
        .map(|(depth, source_map)| Outputs { depth, source_map, ..Outputs::default() });
    for outputs in outputs {
        Gather::new(gl, &Options::default(), outputs)?;
        for (strict, linear_interpolation) in [(false, true), (false, false), (true, false), (true, true)] {
            for divisor in [1, 4] {
                let imbuffer = ImBufferSize::Divisor(divisor);
                Paper::new(gl, outputs, PaperOptions { imbuffer, linear_interpolation, strict })?;
            }
        }
    }
    for depth in [false, true] {
        AnyView::new(gl, &Options::default(), Outputs { depth, ..Outputs::default() })?;
        Motion::new(gl, &Options::default(), Outputs { depth, ..Outputs::default() })?;
    }
    for mark in [HoleMark::Stencil, HoleMark::Depth] {
        let outputs =
            Outputs { depth: mark == HoleMark::Stencil, holes: Holes::Open(mark), ..Outputs::default() };
        Gather::new(gl, &Options::default(), outputs)?;
    }
    Composer::new(gl, GlState::Leave, false)?;
    if variants == Variants::Every {
        let sources = [(true, false, false), (false, true, false), (true, true, false), (false, false, true)];
        for (parts, array_textures, depth_pairs) in sources {
            let options = Options { parts, array_textures, depth_pairs, ..Options::default() };
            Gather::new(gl, &options, Outputs::default())?;
            for depth in [false, true] {
                AnyView::new(gl, &options, Outputs { depth, ..Outputs::default() })?;
            }
        }
    }
    GuessedDepth::new(gl, &Options::default())?;
    // What OpenGL ES 3.0 and WebGL 2 compile.
    let written_out = [("WITHOUT_ES_310", String::new())];
    for pass in ["synthesis/gather/tiles.frag", "synthesis/gather/spans.frag"] {
        Program::new(gl, ShaderSource::Screen(pass), &written_out)?;
    }
    let march =
        ShaderSource::Raster { vertex: "synthesis/march.vert", fragment: "synthesis/gather/march.frag" };
    Program::new(gl, march, &written_out)?;
    // Of samples in a tile.
    for (depth, bloom) in [(false, true), (true, true), (false, false), (true, false)] {
        let options = Options { depth_pairs: true, bloom, ..Options::default() };
        Gather::new(gl, &options, Outputs { depth, ..Outputs::default() })?;
    }
    Ok(())
}

/// Builds the programs of a scene with every method that the driver supports.
fn methods(gl: &Rc<Context>, settings: &RenderSettings, scene: &Scene) -> anyhow::Result<()> {
    let mut scene = PreparedScene::new(gl, scene.clone(), settings)?;
    for method in Method::ALL {
        if is_tested(method, settings, gl) {
            prepare(gl, method, settings, &mut scene)?;
        }
    }
    Ok(())
}

/// Builds the programs of a scene with a method, which renders holes if it can.
fn prepare(
    gl: &Rc<Context>,
    method: Method,
    settings: &RenderSettings,
    scene: &mut PreparedScene,
) -> anyhow::Result<()> {
    let options = StereoOptions { holes: HoleMethod::Rendered, ..StereoOptions::default() };
    Ok(StereoSession::new(gl, method.into(), settings, &options)?.prepare(scene, false)?)
}

/// Returns settings with small shadow maps, whose size no shader depends on.
fn settings() -> RenderSettings {
    RenderSettings { shadow_map_size: 64, ..RenderSettings::default() }
}

/// Builds the programs of a scene with all settings that affect a shader.
fn renderer(gl: &Rc<Context>, scene: Scene, all_settings: bool) -> anyhow::Result<()> {
    let settings = settings();
    methods(gl, &settings, &scene)?;
    if all_settings {
        methods(gl, &RenderSettings { shadow_map_size: 0, ..settings.clone() }, &scene)?;
        methods(gl, &RenderSettings { msaa: 1, ..settings.clone() }, &scene)?;
        methods(gl, &RenderSettings { shadow_map_size: 0, bloom: false, ..settings }, &scene)?;
    }
    Ok(())
}

/// Builds the programs of motion vectors, in the variants of materials and of depth.
fn vectors(gl: &Rc<Context>) -> anyhow::Result<()> {
    let define = |name: &&'static str| (*name, String::new());
    let moving = ShaderSource::Raster { vertex: "render/motion.vert", fragment: "render/motion.frag" };
    for names in [&[][..], &["CUTOUT"], &["CUTOUT", "DIFFUSE_MAP"]] {
        Program::new(gl, moving, &names.iter().map(define).collect::<Vec<_>>())?;
    }
    for names in [&[][..], &["DEPTH_PAIRS"]] {
        let defines: Vec<_> = names.iter().map(define).collect();
        Program::new(gl, ShaderSource::Screen("render/vectors.frag"), &defines)?;
    }
    Ok(())
}

fn rendering(gl: &Rc<Context>, variants: Variants) -> anyhow::Result<()> {
    let every = variants == Variants::Every;
    for style in ShadingStyle::ALL {
        let mut scene = scene::every_material(style);
        if every {
            renderer(gl, scene.clone(), false)?;
        }
        // Materials without and with all maps, in every kind of opacity, represent all others under other settings.
        scene::keep_plain_and_full(&mut scene);
        if !every && style != ShadingStyle::Realistic {
            // Outlines have programs of their own where holes are rendered.
            let mut scene = PreparedScene::new(gl, scene, &settings())?;
            prepare(gl, Method::Synthesized, &settings(), &mut scene)?;
            continue;
        }
        renderer(gl, scene.clone(), every)?;
        if every {
            scene.sky.sun_color = Vec3::ZERO;
            renderer(gl, scene, true)?;
        }
    }
    Ok(())
}

fn viewer(gl: &Rc<Context>) -> anyhow::Result<()> {
    for names in [&[][..], &["LEVELS"]] {
        let source = ShaderSource::Raster { vertex: "viewer/lens.vert", fragment: "viewer/lens.frag" };
        let defines: Vec<_> = names.iter().map(|name| (*name, String::new())).collect();
        Program::new(gl, source, &defines)?;
    }
    Program::new(gl, ShaderSource::Screen("viewer/decoded.frag"), &[])?;
    Program::new(gl, ShaderSource::Screen("viewer/decoded.frag"), &[("RGB", String::new())])?;
    Program::new(gl, ShaderSource::Screen("viewer/hud.frag"), &[])?;
    Program::new(gl, ShaderSource::Screen("viewer/menu.frag"), &[])?;
    for define in [None, Some("ANAGLYPH"), Some("DIFFERENCE"), Some("WITH_DEPTH"), Some("PACKED_DEPTH")] {
        let defines: Vec<_> = define.into_iter().map(|name| (name, String::new())).collect();
        Program::new(gl, ShaderSource::Screen("viewer/show.frag"), &defines)?;
    }
    DepthCopy::new(gl)?;
    Program::new(gl, ShaderSource::Screen("openxr/transfer.frag"), &[])?;
    let hidden = ShaderSource::Raster { vertex: "openxr/hidden.vert", fragment: "openxr/hidden.frag" };
    Program::new(gl, hidden, &[])?;
    Ok(())
}

fn patchers(gl: &Rc<Context>) -> anyhow::Result<()> {
    // The other patchers have no shaders.
    for kind in [PatcherKind::Paper, PatcherKind::Gather, PatcherKind::Median, PatcherKind::Xiao] {
        inpaint::create(gl, kind, &PatcherOptions::default())?;
    }
    Ok(())
}

/// A program in the form that a driver gets.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct ProgramText {
    /// The file of the last stage and the macros, such as `synthesis/gather/march.frag WRITE_DEPTH`.
    pub name: String,
    /// A vertex and a fragment shader, or a compute shader.
    pub stages: Vec<StageText>,
}

/// A stage of a program.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct StageText {
    /// The name of the stage's file in [`yoro_shaders::files`].
    pub file: String,
    /// GLSL ES 3.10 with includes and macros resolved.
    pub text: String,
}

/// The macros for drivers with other extensions: multiview instead of views in layers of an array, and `discard`
/// instead of clip distances.
const COUNTERPARTS: [(&str, &str); 2] = [("CLIP_DISTANCE", "MULTIVIEW"), ("CLIP_DISTANCE", "SEAM_DISCARD")];

/// Returns the texts of the [made](make) programs and of their counterparts for other drivers, sorted by name.
///
/// # Errors
/// Fails if a program refers to a file that does not exist.
pub fn texts(made: &BTreeSet<ProgramRecipe>) -> anyhow::Result<Vec<ProgramText>> {
    let mut recipes: BTreeSet<ProgramRecipe> = BTreeSet::new();
    for recipe in made {
        for (from, to) in COUNTERPARTS {
            if let Some(at) = recipe.defines.iter().position(|(name, _)| name == from) {
                let mut counterpart = recipe.clone();
                to.clone_into(&mut counterpart.defines[at].0);
                recipes.insert(counterpart);
            }
        }
        recipes.insert(recipe.clone());
    }
    let mut texts = BTreeMap::new();
    for recipe in recipes {
        let text = text(recipe)?;
        texts.insert(text.name.clone(), text);
    }
    Ok(texts.into_values().collect())
}

/// Returns the files of the [made](make) programs, including the included ones.
///
/// # Errors
/// Fails if a file does not exist.
pub fn files(made: &BTreeSet<ProgramRecipe>) -> anyhow::Result<BTreeSet<String>> {
    let mut files = BTreeSet::new();
    for recipe in made {
        for file in &recipe.files {
            files.extend(assemble(file, &[])?.files().iter().cloned());
        }
    }
    Ok(files)
}

fn assemble(file: &str, defines: &[(&str, String)]) -> anyhow::Result<Assembled> {
    let missing = |MissingFile(file)| anyhow!("shader file {file} does not exist");
    yoro_shaders::assemble(file, "310 es", defines).map_err(missing)
}

/// Returns the text of a program. Omits macros that none of its files mentions, since they do not make another program.
fn text(recipe: ProgramRecipe) -> anyhow::Result<ProgramText> {
    let bare = recipe.files.iter().map(|file| assemble(file, &[])).collect::<anyhow::Result<Vec<_>>>()?;
    let mut defines = recipe.defines;
    defines.retain(|(name, _)| bare.iter().any(|bare| bare.text.contains(name.as_str())));
    let mut words: Vec<String> = recipe.files.last().cloned().into_iter().collect();
    words.extend(defines.iter().map(|(name, value)| match value.as_str() {
        "" => name.clone(),
        value => format!("{name}={value}"),
    }));
    let defines: Vec<(&str, String)> =
        defines.iter().map(|(name, value)| (name.as_str(), value.clone())).collect();
    let stage = |file: String| Ok(StageText { text: assemble(&file, &defines)?.text, file });
    let stages = recipe.files.into_iter().map(stage).collect::<anyhow::Result<_>>()?;
    Ok(ProgramText { name: words.join(" "), stages })
}
