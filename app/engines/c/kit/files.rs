//! The files of the shader kit: the gather pipeline and any view, for engines that bring their own passes.

use std::fmt::Write as _;
use std::fs;
use std::io;
use std::path::Path;

use yoro::synthesis::{LevelUniforms, PoseUniforms, Uniforms};

#[path = "hlsl.rs"]
mod hlsl;

/// Each file of the kit, and the file of `yoro-shaders` that it is made from.
const SHADERS: [(&str, &str); 10] = [
    ("screen.vert", "screen.vert"),
    ("march.vert", "synthesis/march.vert"),
    ("tiles.frag", "synthesis/gather/tiles.frag"),
    ("spans.frag", "synthesis/gather/spans.frag"),
    ("march.frag", "synthesis/gather/march.frag"),
    ("guessed_depth.frag", "synthesis/guessed_depth.frag"),
    ("any_view_tiles.frag", "synthesis/any_view/tiles.frag"),
    ("any_view_spans.frag", "synthesis/any_view/spans.frag"),
    ("any_view_march.frag", "synthesis/any_view/march.frag"),
    ("compose.frag", "synthesis/compose.frag"),
];
/// Of anti-aliased depth, which Direct3D 11 does not resolve.
const NEAREST_DEPTH: (&str, &str) = ("nearest_depth.frag", "synthesis/nearest_depth.frag");
/// Names and values of macros.
type Macros = &'static [(&'static str, &'static str)];

/// Folder, GLSL version and macros of each API: the uniform block.
const APIS: [(&str, &str, Macros); 2] = [
    ("gles", "300 es", &[("UNIFORM_BLOCK", "layout(std140)")]),
    ("vulkan", "310 es", &[("UNIFORM_BLOCK", "layout(push_constant, std140)")]),
];

/// Each file for Godot, which has both stages in one, with its two shaders, and its versions by name and macros, if it needs any.
const GODOT: [(&str, &str, &str, Versions); 7] = [
    ("tiles.glsl", "screen.vert", "synthesis/gather/tiles.frag", &[]),
    ("spans.glsl", "screen.vert", "synthesis/gather/spans.frag", &[]),
    (
        "march.glsl",
        "synthesis/march.vert",
        "synthesis/gather/march.frag",
        &[
            ("depth", &["WRITE_DEPTH"]),
            ("open", &["WRITE_DEPTH", "OPEN_HOLES"]),
            ("map", &["WRITE_DEPTH", "SOURCE_MAP"]),
        ],
    ),
    ("any_view_tiles.glsl", "screen.vert", "synthesis/any_view/tiles.frag", &[]),
    ("any_view_spans.glsl", "screen.vert", "synthesis/any_view/spans.frag", &[]),
    ("any_view_march.glsl", "screen.vert", "synthesis/any_view/march.frag", &[("depth", &["WRITE_DEPTH"])]),
    ("compose.glsl", "screen.vert", "synthesis/compose.frag", &[]),
];
type Versions = &'static [(&'static str, &'static [&'static str])];

/// Writes all files into a folder.
///
/// # Errors
/// Fails if a file cannot be written.
pub fn write(folder: &Path) -> io::Result<()> {
    for (api, version, macros) in APIS {
        fs::create_dir_all(folder.join(api))?;
        for (name, source) in SHADERS {
            put(&folder.join(api).join(name), &shader(source, version, macros)?)?;
        }
    }
    fs::create_dir_all(folder.join("hlsl"))?;
    for (name, source) in SHADERS.into_iter().chain([NEAREST_DEPTH]) {
        put(&folder.join(format!("hlsl/{name}.hlsl")), &direct3d(source)?)?;
    }
    fs::create_dir_all(folder.join("godot"))?;
    for (name, vertex, fragment, versions) in GODOT {
        put(&folder.join("godot").join(name), &godot(vertex, fragment, versions)?)?;
    }
    for (name, text) in [
        ("yoro_kit.h", &*header()),
        ("example.c", include_str!("example.c")),
        ("example_d3d11.cpp", include_str!("example_d3d11.cpp")),
        ("example_d3d12.cpp", include_str!("example_d3d12.cpp")),
        ("engine_direct3d.h", include_str!("engine_direct3d.h")),
        ("room.hlsl", include_str!("room.hlsl")),
        ("engine_gles.h", include_str!("../examples/engine_gles.h")),
        ("picture.h", include_str!("../examples/picture.h")),
    ] {
        put(&folder.join(name), text)?;
    }
    let text = include_str!("README.md").replace("POSE_UNIFORMS\n", &table(PoseUniforms::LAYOUT));
    let text = text.replace("LEVEL_UNIFORMS\n", &table(LevelUniforms::LAYOUT));
    put(&folder.join("README.md"), &text.replace("UNIFORMS\n", &table(Uniforms::LAYOUT)))
}

/// The structures of `yoro_kit.h`, with the shaders' layouts.
const BLOCKS: [(&str, hlsl::Layout); 3] = [
    ("YoroKitUniforms", Uniforms::LAYOUT),
    ("YoroKitPoseUniforms", PoseUniforms::LAYOUT),
    ("YoroKitLevelUniforms", LevelUniforms::LAYOUT),
];

/// Returns `yoro_kit.h`, which lets the compiler check its structures against the layouts.
fn header() -> String {
    let text = include_str!("yoro_kit.h");
    let mut header = text.trim_end().trim_end_matches("#endif").to_owned();
    for (block, layout) in BLOCKS {
        for (member, _, offset) in layout {
            let block = if *member == "motion" { "YoroKitMotionUniforms" } else { block };
            // Writing to a string cannot fail.
            let _ = writeln!(header, "YORO_KIT_AT({block}, {member}, {offset});");
        }
    }
    header + "\n#endif\n"
}

/// Returns the text of one file for Direct3D.
fn direct3d(source: &str) -> io::Result<String> {
    let block = match source {
        "synthesis/compose.frag" => BLOCKS[2],
        _ if source.contains("any_view") => BLOCKS[1],
        _ => BLOCKS[0],
    };
    let glsl = shader(source, "310 es", &[("UNIFORM_BLOCK", "")])?;
    let (_, text) = glsl.split_once('\n').unwrap_or_default();
    let (title, body) = text.split_once('\n').unwrap_or_default();
    let body: String = body.lines().filter(|line| !is_setting(line)).flat_map(|line| [line, "\n"]).collect();
    Ok(hlsl::from_glsl(&body, source.ends_with(".vert"), title, block))
}

/// Writes a file so that a reader never sees half of it.
fn put(path: &Path, text: &str) -> io::Result<()> {
    let unfinished = path.with_added_extension("tmp");
    fs::write(&unfinished, text)?;
    fs::rename(unfinished, path)
}

/// Returns the text of one file, with its includes resolved.
fn shader(source: &str, version: &str, macros: Macros) -> io::Result<String> {
    let macros: Vec<_> = macros.iter().map(|&(name, value)| (name, value.to_owned())).collect();
    let assembled = yoro_shaders::assemble(source, version, &macros)
        .map_err(|missing| io::Error::other(format!("shader file {} does not exist", missing.0)))?;
    let (first, rest) = assembled.text.split_once('\n').unwrap_or_default();
    let mut own = format!(
        "{first}\n// yoro, shader kit {}. SPDX-License-Identifier: MIT OR Apache-2.0\n",
        env!("CARGO_PKG_VERSION")
    );
    if source.ends_with("march.frag") {
        own += "//\n// Setting:\n\
                // #define WRITE_DEPTH // The target's depth, too, to gl_FragDepth: for transparent objects.\n\
                // #define OPEN_HOLES // Discards holes and silhouettes, for your scene to be drawn there once more.\n";
    }
    // The lines before the precision statements also contain extensions, which synthesis does not need.
    let begins = |line: &&str| line.starts_with("precision ");
    let macros = rest.lines().take_while(|line| !begins(line)).filter(|line| line.starts_with("#define "));
    let body = rest.lines().skip_while(|line| !begins(line));
    for line in macros.chain(body).filter(|line| !line.starts_with("#line ")) {
        own += line.trim_end();
        own.push('\n');
    }
    Ok(own)
}

/// Returns a file that Godot imports as RDShaderFile: the shaders for Vulkan between markers.
fn godot(vertex: &str, fragment: &str, versions: Versions) -> io::Result<String> {
    let [_, (_, version, macros)] = APIS;
    let mut text = String::new();
    if !versions.is_empty() {
        text += "#[versions]\n";
    }
    for (name, defines) in versions {
        let defines: Vec<String> = defines.iter().map(|name| format!("#define {name}")).collect();
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{name} = \"{}\";", defines.join("\\n"));
    }
    for (stage, source) in [("vertex", vertex), ("fragment", fragment)] {
        let own = shader(source, version, macros)?;
        let (first, rest) = own.split_once('\n').unwrap_or_default();
        let rest: Vec<&str> = rest.lines().filter(|line| !is_setting(line)).collect();
        let _ = write!(text, "\n#[{stage}]\n{first}\n#VERSION_DEFINES\n{}\n", rest.join("\n"));
    }
    Ok(text)
}

/// True for the comment lines that name a shader's setting, which is on in Godot.
fn is_setting(line: &str) -> bool {
    line == "//" || line == "// Setting:" || line.starts_with("// #define ")
}

/// Returns a table of a block's members.
fn table(layout: &[(&str, &str, usize)]) -> String {
    let mut table = String::from("| byte | member | type |\n|---:|---|---|\n");
    for (name, glsl, offset) in layout.iter().filter(|(name, ..)| *name != "padding") {
        // Writing to a string cannot fail.
        let _ = writeln!(table, "| {offset} | `{name}` | {glsl} |");
    }
    table
}
