//! The kit's samples on Direct3D 11 and 12, under Linux.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use yoro::eyes::{DepthConvention, DepthRange, Eye, EyePair, Frustum, GuardBand, Pose};
use yoro::opengl::{Gather, Options, Outputs, Source};
use yoro_context::{Backend, Headless};
use yoro_gl::{Destination, Filter, Format, RenderTarget, Texture};

use super::{WARNINGS, decibels, is_here, kit, run};

/// Each side of an eye, and the IPD, the planes and the frusta of `engine_direct3d.h`.
const SIDE: u32 = 512;
const IPD: f32 = 0.063;

/// What the test uses of Debian's packages, which are pinned to no version and may move.
const USED: &str = "bin/vkd3d-compiler include/dxvk include/vkd3d lib/x86_64-linux-gnu/libdxvk_d3d11.so \
    lib/x86_64-linux-gnu/libvkd3d-utils.so lib/x86_64-linux-gnu/libvkd3d.so";

/// Compilers, drivers and libraries for Direct3D.
struct Equipment {
    root: PathBuf,
    launcher: PathBuf,
    /// Where everything is compiled, with the kit's files.
    work: tempfile::TempDir,
}

impl Equipment {
    /// Compiles a shader, with the text that `change` makes of it.
    fn compile(&self, file: &str, to: &str, entry: &str, change: impl Fn(String) -> String) {
        let [source, text] = [file, "text.hlsl"].map(|name| self.work.path().join(name));
        fs::write(&text, change(fs::read_to_string(source).unwrap())).unwrap();
        let profile = if to.ends_with(".vert") { "vs_5_0" } else { "ps_5_0" };
        let mut command = Command::new(&self.launcher);
        command.arg(self.root.join("bin/vkd3d-compiler"));
        command.args(["-x", "hlsl", "-b", "dxbc-tpf", "-p", profile, "-e", entry, "-o"]);
        run(command.arg(self.work.path().join(format!("{to}.dxbc"))).arg(text));
    }

    /// Builds a sample, and returns the program.
    fn build(&self, name: &str, headers: &str, libraries: &[&str]) -> PathBuf {
        let program = self.work.path().join(name);
        let mut command = Command::new("g++");
        command
            .arg("-std=gnu++17")
            .args(WARNINGS)
            .arg("-isystem")
            .arg(self.root.join("include").join(headers));
        command.arg(self.work.path().join(format!("example_{name}.cpp"))).arg("-o").arg(&program);
        command.arg("-L").arg(self.root.join("lib/x86_64-linux-gnu"));
        // The libraries' own needs are newer than this machine's.
        run(command.arg("-Wl,--allow-shlib-undefined").args(libraries));
        program
    }

    /// Runs a sample, and returns what it prints and its images.
    fn run(&self, program: &Path) -> (String, impl Fn(&str) -> Vec<u8>) {
        let prefix = program.with_extension("raw");
        let mut command = Command::new(&self.launcher);
        command.arg(program).arg(program.with_extension("png")).arg(&prefix);
        let printed = run(command.env("YORO_KIT", self.work.path()));
        (printed, move |name: &str| fs::read(prefix.with_added_extension(name)).unwrap())
    }
}

fn floats(bytes: &[u8]) -> impl Iterator<Item = f32> {
    bytes.chunks(4).map(|bytes| f32::from_le_bytes(bytes.try_into().unwrap()))
}

/// Returns the peak signal-to-noise ratio of all channels in decibels.
fn psnr(a: &[u8], b: &[u8]) -> f64 {
    assert_eq!(a.len(), b.len());
    let squares: f64 = a.iter().zip(b).map(|(a, b)| f64::from(a.abs_diff(*b)).powi(2)).sum();
    10.0 * (255f64.powi(2) * a.len() as f64 / squares).log10()
}

/// Returns what OpenGL draws of a source whose rows are from the top.
fn with_opengl(color: &[u8], depth: &[u8]) -> Vec<u8> {
    let headless = Headless::open(Backend::Egl).unwrap();
    let gl = headless.gl();
    let [up, out, inner] = [0.65f32, 0.7, 0.6].map(f32::tan);
    let frustum = |left, right| Frustum { left, right, bottom: -up, top: up };
    let planes = DepthRange { near: 0.1, far: f32::INFINITY, convention: DepthConvention::Reversed };
    let mut pair =
        EyePair::parallel(Pose::IDENTITY, frustum(-out, inner), IPD, planes, [SIDE; 2], Eye::Right);
    pair.frusta[1] = frustum(-inner, out);
    let views = pair.synthesis_views(GuardBand::Distance(1.0)).unwrap();
    let image = |format, bytes| {
        let texture = Texture::new(gl, views.source.size, format, Filter::Nearest).unwrap();
        texture.upload(bytes);
        texture
    };
    let (color, depth) = (image(Format::Rgba8, color), image(Format::R32F, depth));
    let target = RenderTarget::new(gl, [SIDE; 2], &[(Format::Rgba8, Filter::Nearest)], None).unwrap();
    let mut gather = Gather::new(gl, &Options::default(), Outputs::default()).unwrap();
    let source = Source::new(color.raw(), depth.raw());
    gather.synthesize(source, &views.warp.rows_from_top(), &Destination::whole(&target)).unwrap();
    target.read_rgba8(0, [0, 0], [SIDE; 2])
}

/// Both samples draw what OpenGL draws of the same source, and write the depth of what they show. A picture that was made
/// without the flip of clip space is far from it.
#[test]
fn direct3d_draws_the_picture_of_opengl() {
    let Some(folder) = std::env::var_os("YORO_TEST_DIRECT3D").map(PathBuf::from) else {
        let without = std::env::var_os("YORO_TEST_WITHOUT_DIRECT3D").is_some();
        assert!(without, "run `cargo xtask test direct3d`, or set YORO_TEST_WITHOUT_DIRECT3D=1");
        println!("LEFT OUT: the kit on Direct3D");
        return;
    };
    if !is_here("g++") {
        println!("SKIPPED: the kit on Direct3D: no g++ here");
        return;
    }
    let (root, launcher) = (folder.join("root/usr"), folder.join("run"));
    let at = Equipment { root, launcher, work: tempfile::tempdir().unwrap() };
    if let Some(missing) = USED.split_whitespace().find(|path| !at.root.join(path).exists()) {
        println!("SKIPPED: the kit on Direct3D: the packages have no {missing}");
        return;
    }
    kit::write(at.work.path()).unwrap();
    for name in ["screen.vert", "march.vert", "tiles.frag", "spans.frag"] {
        at.compile(&format!("hlsl/{name}.hlsl"), name, "main", |text| text);
    }
    at.compile("hlsl/march.frag.hlsl", "march.frag", "main", |text| format!("#define WRITE_DEPTH\n{text}"));
    at.compile("room.hlsl", "room.vert", "room_vertex", |text| text);
    at.compile("room.hlsl", "room.frag", "room_pixel", |text| text);
    // The other passes are only compiled, so that two compilers take them.
    for name in
        ["guessed_depth", "nearest_depth", "any_view_tiles", "any_view_spans", "any_view_march", "compose"]
    {
        at.compile(&format!("hlsl/{name}.frag.hlsl"), name, "main", |text| text);
    }
    at.compile("hlsl/march.frag.hlsl", "variant", "main", |text| {
        format!("#define MOTION\n#define OPEN_HOLES\n#define SOURCE_MAP\n#define SOURCE_PARTS\n{text}")
    });
    let eleven = at.build("d3d11", "dxvk", &["-ldxvk_d3d11"]);
    let twelve = at.build("d3d12", "vkd3d", &["-lvkd3d-utils", "-lvkd3d"]);
    for program in [&eleven, &twelve] {
        let (printed, image) = at.run(program);
        let expected = with_opengl(&image("source"), &image("source_depth"));
        let same = psnr(&image("other"), &expected);
        let (own, truth) = (image("other_depth"), image("truth_depth"));
        let near = floats(&own).zip(floats(&truth)).filter(|(a, b)| (a - b).abs() < 0.01 * b).count();
        let near = near as f64 / f64::from(SIDE * SIDE);
        println!("{}: {same:.1} dB to OpenGL, {near:.3} of depth right\n{printed}", program.display());
        assert!(same >= 65.0 && near > 0.95, "{same} {near}");
        let [synthesized, same] = ["synthesized:", "same image:"].map(|line| decibels(&printed, line));
        assert!(synthesized > 30.0 && synthesized > same + 10.0, "{printed}");
    }
    at.compile("hlsl/march.vert.hlsl", "march.vert", "main", |text| {
        assert_eq!(text.matches("-gl_Position.y").count(), 1);
        text.replace("-gl_Position.y", "gl_Position.y")
    });
    let (_, image) = at.run(&twelve);
    let upside_down = psnr(&image("other"), &with_opengl(&image("source"), &image("source_depth")));
    println!("without the flip: {upside_down:.1} dB");
    assert!(upside_down < 45.0, "{upside_down}");
}
