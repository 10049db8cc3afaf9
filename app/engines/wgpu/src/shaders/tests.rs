//! The modules match the present shaders, and every back end accepts them.

use std::fs;
use std::path::Path;

use anyhow::{Context as _, anyhow};
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use yoro_test_support::compiled::{self, Compiled, Source};
use yoro_test_support::modules::{MODULES, Module};

/// The modules that only wgpu needs.
const NEAREST_DEPTH: [Module; 2] = [
    ("nearest-depth", "synthesis/nearest_depth.frag", &[]),
    ("nearest-depth-reversed", "synthesis/nearest_depth.frag", &["REVERSED"]),
];

fn all_modules() -> Vec<Module> {
    [&MODULES[..], &NEAREST_DEPTH].concat()
}

/// Plain SPIR-V for Vulkan 1.0: names and functions are kept, so that a capture can be read.
const ARGUMENTS: [&str; 1] = ["-V"];

fn folder() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/src/wgsl"))
}

fn source((name, file, macros): &Module) -> Source {
    let mut defines = vec![("UNIFORM_BLOCK", "layout(set = 0, binding = 4, std140)".to_owned())];
    defines.extend(macros.iter().map(|name| (*name, String::new())));
    let text = yoro_shaders::assemble(file, "450", &defines).unwrap().text;
    Source { name, vertex: file.ends_with(".vert"), text: for_wgsl(&text) }
}

/// Replaces what WGSL does not have, in three changes.
fn for_wgsl(text: &str) -> String {
    text.lines().map(|line| line_for_wgsl(line) + "\n").collect()
}

fn line_for_wgsl(line: &str) -> String {
    // WGSL separates textures and samplers.
    if let Some((binding, declared)) = line.strip_prefix("TEXTURE(").and_then(|rest| rest.split_once(')')) {
        let declared = declared.trim_start_matches(" uniform ").trim_start_matches("highp ");
        let (kind, name) = declared.trim_end_matches(';').split_once(' ').unwrap();
        let texture = kind.replace("sampler", "texture");
        let is_filtered = ["color_map", "wide_map", "inset_map"].contains(&name);
        let filter = if is_filtered { "linear" } else { "nearest" };
        return format!(
            "layout(set = 0, binding = {binding}) uniform {texture} {name}_texture;\n\
             #define {name} {kind}({name}_texture, {filter}_sampler)"
        );
    }
    match line.trim() {
        // WGSL cannot sample integer textures, so they are fetched instead.
        "layout(constant_id = 0) const bool PART = false;" => {
            "layout(set = 0, binding = 5) uniform sampler nearest_sampler;\n\
             layout(set = 0, binding = 6) uniform sampler linear_sampler;\n\
             const bool PART = true;"
                .to_owned()
        }
        "return texture(span_map, span_at);" => "return uvec4(0u);".to_owned(),
        _ => line.to_owned(),
    }
}

fn validated(module: &naga::Module) -> anyhow::Result<ModuleInfo> {
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::default());
    validator.validate(module).map_err(|error| anyhow!("{}", error.emit_to_string("")))
}

fn wgsl(source: &Source) -> anyhow::Result<Vec<u8>> {
    let spirv = compiled::spirv(source, &ARGUMENTS)?;
    let mut module = naga::front::spv::parse_u8_slice(&spirv, &naga::front::spv::Options::default())
        .map_err(|error| anyhow!("{}", error.emit_to_string("")))
        .with_context(|| source.name)?;
    naga::compact::compact(&mut module, naga::compact::KeepUnused::No);
    // Restores GLSL's names: functions without argument types, and a name for the block, which has none.
    for (_, function) in module.functions.iter_mut() {
        let name = function.name.take().unwrap_or_default();
        function.name = name.split('(').next().map(str::to_owned);
    }
    for (_, variable) in module.global_variables.iter_mut() {
        if variable.space == naga::AddressSpace::Uniform {
            variable.name = Some("synthesis".to_owned());
        }
    }
    let info = validated(&module).with_context(|| source.name)?;
    let flags = naga::back::wgsl::WriterFlags::empty();
    let text = naga::back::wgsl::write_string(&module, &info, flags)?;
    Ok(format!("// Made of yoro's GLSL by `cargo xtask maintain renew`.\n{text}").into_bytes())
}

/// Returns the workspace's version of naga, or `None` without a lock file.
fn naga_version() -> Option<String> {
    let lock = fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../Cargo.lock")).ok()?;
    let version = lock.split("name = \"naga\"\nversion = \"").nth(1)?.split('"').next()?;
    Some(version.to_owned())
}

#[test]
fn modules_are_compiled_from_the_present_shaders() {
    let compiler = compiled::glslang(&ARGUMENTS).zip(naga_version());
    let compiled = Compiled {
        folder: folder().to_owned(),
        ending: "wgsl",
        compiler: compiler.map(|(glslang, naga)| format!("{glslang}, naga {naga}")),
        command: "cargo xtask maintain renew",
        compile: wgsl,
    };
    let sources: Vec<Source> = all_modules().iter().map(source).collect();
    if std::env::var_os("YORO_BLESS_SHADERS").is_some() {
        compiled.renew(&sources).unwrap();
    }
    compiled.check(&sources).unwrap();
}

/// The modules are valid in the languages of drivers: Metal's and HLSL. Tests of pictures cover SPIR-V on Vulkan.
#[test]
fn modules_are_valid_webgpu_metal_and_hlsl() {
    for (name, ..) in all_modules() {
        let text = fs::read_to_string(folder().join(name).with_extension("wgsl")).unwrap();
        let module = naga::front::wgsl::parse_str(&text)
            .unwrap_or_else(|error| panic!("{}", error.emit_to_string(&text)));
        // No capability beyond those of WebGPU.
        let info = Validator::new(ValidationFlags::all(), Capabilities::empty())
            .validate(&module)
            .unwrap_or_else(|error| panic!("{name}: {}", error.emit_to_string(&text)));
        let metal = naga::back::msl::write_string(
            &module,
            &info,
            &naga::back::msl::Options {
                fake_missing_bindings: true,
                lang_version: (2, 0),
                ..Default::default()
            },
            &naga::back::msl::PipelineOptions::default(),
        );
        let metal = metal.unwrap_or_else(|error| panic!("{name}: no Metal: {error}")).0;
        assert!(metal.contains("main_"), "{name}: {metal}");
        let mut hlsl = String::new();
        let (options, pipeline) = Default::default();
        naga::back::hlsl::Writer::new(&mut hlsl, &options, &pipeline)
            .write(&module, &info, None)
            .unwrap_or_else(|error| panic!("{name}: no HLSL: {error}"));
        assert!(hlsl.contains("main"), "{name}: {hlsl}");
    }
}
