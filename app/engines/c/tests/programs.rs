//! The samples, compiled as users compile them: with C and C++ compilers, against the header and the built library.
//! C# stands for all other languages.

mod common;
#[path = "programs/direct3d.rs"]
mod direct3d;
#[path = "../kit/files.rs"]
mod kit;

use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

use yoro::eyes::{
    DepthConvention, DepthRange, Eye, EyePair, Foveation, Frustum, Gaze, GuardBand, Ndc, Pose, PoseWarp,
    VectorSpace, VectorsOf, View,
};
use yoro::synthesis::backend::Places;
use yoro::synthesis::{LevelPlaces, LevelUniforms, PoseUniforms, Uniforms};
use yoro_c::*;

/// Compilers, with their language and its standard.
const COMPILERS: [[&str; 3]; 4] =
    [["gcc", "c", "c11"], ["clang", "c", "c11"], ["g++", "c++", "c++17"], ["clang++", "c++", "c++17"]];
const WARNINGS: [&str; 4] = ["-Wall", "-Wextra", "-pedantic", "-Werror"];

fn package() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Returns the folder of the library that cargo built next to this test.
fn library() -> PathBuf {
    let folder = env::current_exe().unwrap().parent().unwrap().to_owned();
    assert!(folder.join("libyoro_c.so").is_file(), "{} has no libyoro_c.so", folder.display());
    folder
}

fn is_here(program: &str) -> bool {
    Command::new(program).arg("--version").output().is_ok_and(|output| output.status.success())
}

/// Runs a command, which must succeed, and returns its output.
fn run(command: &mut Command) -> String {
    let output = command.output().unwrap();
    let text =
        format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{command:?}\n{text}");
    text
}

/// Returns the figure in a line that a sample prints.
fn decibels(printed: &str, line: &str) -> f64 {
    let rest = printed.lines().find_map(|text| text.strip_prefix(line)).unwrap();
    rest.trim().split(' ').next().unwrap().parse().unwrap()
}

/// Compiles a sample with every installed compiler, runs the first result, checks its figures and picture, and returns
/// the picture.
fn sample(source: &str, header: &str, includes: &[&str], libraries: &[&str]) -> Option<image::RgbImage> {
    if !Path::new("/usr/include").join(header).is_file() {
        println!("SKIPPED: {source} is not compiled: {header} is not here");
        return None;
    }
    let work = tempfile::tempdir().unwrap();
    let mut compilers = COMPILERS.into_iter().filter(|[compiler, ..]| is_here(compiler)).peekable();
    if compilers.peek().is_none() {
        println!("SKIPPED: no compiler for C is here");
        return None;
    }
    let program = work.path().join("program");
    for (i, [compiler, language, standard]) in compilers.enumerate() {
        let mut command = Command::new(compiler);
        command.args(["-x", language, &format!("-std={standard}")]).args(WARNINGS);
        for folder in includes {
            command.arg("-I").arg(package().join(folder));
        }
        command.arg(package().join(source)).args(["-x", "none"]);
        match i {
            // Linking is tested once.
            0 => command.arg("-L").arg(library()).args(libraries).arg("-lm").arg("-o").arg(&program),
            _ => command.arg("-fsyntax-only"),
        };
        run(&mut command);
    }
    let picture = work.path().join("picture.png");
    let printed = run(Command::new(&program)
        .arg(&picture)
        .env("YORO_KIT", includes[0])
        .env("LD_LIBRARY_PATH", library()));
    let [synthesized, same] = ["synthesized:", "same image:"].map(|line| decibels(&printed, line));
    println!("{source}: {synthesized} dB, the same image to both eyes {same} dB");
    assert!(synthesized > 30.0 && synthesized > same + 10.0, "{printed}");

    // The halves of the picture are similar but shifted, and neither is empty.
    let image = image::open(&picture).unwrap().to_rgb8();
    assert_eq!(image.dimensions(), (1024, 512));
    let (bright, dark) = image.pixels().fold((0, 255), |(high, low), p| (p[1].max(high), p[1].min(low)));
    assert!(bright > 150 && dark < 80, "{bright} {dark}");
    // The picture is the right way up: the ceiling is darker than the floor, which the sun lights.
    let mean = |rows: std::ops::Range<u32>| {
        let count = rows.len() as f64 * 1024.0;
        rows.flat_map(|y| (0..1024).map(move |x| (x, y)))
            .map(|(x, y)| f64::from(image.get_pixel(x, y)[1]))
            .sum::<f64>()
            / count
    };
    assert!(mean(0..60) + 10.0 < mean(452..512), "{} {}", mean(0..60), mean(452..512));
    Some(image)
}

/// Compiles a program against the kit's files with gcc and these options. Returns its output, or `None` without gcc.
fn of_kit(text: &str, options: &[&str]) -> Option<String> {
    if !is_here("gcc") {
        println!("SKIPPED: no gcc here");
        return None;
    }
    let kit = tempfile::tempdir().unwrap();
    kit::write(kit.path()).unwrap();
    let (file, program) = (kit.path().join("text.c"), kit.path().join("program"));
    std::fs::write(&file, text).unwrap();
    let mut command = Command::new("gcc");
    command.arg("-std=c99").args(options).args(WARNINGS);
    run(command.arg(&file).arg("-lm").arg("-o").arg(&program));
    Some(run(&mut Command::new(&program)))
}

/// The header compiles with and without Vulkan, which may be included later, in C from C89 on and in C++.
#[test]
fn the_header_stands_alone() {
    const ALONE: &str = "#include <yoro.h>
        int main(void) { YoroEyes eyes; YoroViews views; YORO_INIT(eyes); YORO_INIT(views);
          return (int)(eyes.width + views.crop_x); }";
    const CREATE: &str =
        "int main(void) { YoroVkInfo info; YORO_INIT(info); return yoro_vk_create(&info, 0); }";
    let mut texts = vec![ALONE.to_owned()];
    if Path::new("/usr/include/vulkan/vulkan.h").is_file() {
        for includes in [
            "#define YORO_USE_VULKAN\n#include <yoro.h>\n",
            "#include <vulkan/vulkan.h>\n#include <yoro.h>\n",
            "#include <yoro.h>\n#include <vulkan/vulkan.h>\n#include <yoro.h>\n",
        ] {
            texts.push(format!("{includes}{CREATE}"));
        }
    } else {
        println!("SKIPPED: the header with Vulkan: vulkan/vulkan.h is not here");
    }
    let work = tempfile::tempdir().unwrap();
    let file = work.path().join("text");
    for (compiler, language, standard) in [("gcc", "c", "c89"), ("gcc", "c", "c11"), ("g++", "c++", "c++98")]
    {
        for text in texts.iter().filter(|_| is_here(compiler)) {
            std::fs::write(&file, text).unwrap();
            let mut command = Command::new(compiler);
            command.args(["-x", language, &format!("-std={standard}"), "-fsyntax-only"]).args(WARNINGS);
            // vulkan.h has 64-bit integers.
            command.args(["-Wno-long-long", "-I"]).arg(package().join("include"));
            run(command.arg(&file));
        }
    }
}

fn gles() -> Option<image::RgbImage> {
    sample("examples/gles.c", "GLES3/gl31.h", &["include"], &["-lyoro_c", "-lEGL", "-lGLESv2"])
}

#[test]
fn the_opengl_es_sample_draws_two_eyes() {
    gles();
}

/// The expected figure reveals a wrong warp: with rotation alone, without depth, the picture has 22 dB, and without the
/// rotation 15 dB.
#[test]
fn the_sample_of_any_view_draws_what_the_new_pose_sees() {
    sample("examples/any_view.c", "GLES3/gl31.h", &["include"], &["-lyoro_c", "-lEGL", "-lGLESv2"]);
}

#[test]
fn the_vulkan_sample_draws_two_eyes() {
    if env::var_os("YORO_TEST_WITHOUT_VULKAN").is_some() {
        println!("LEFT OUT: the sample for Vulkan");
    } else if cfg!(feature = "vulkan") {
        sample("examples/vulkan.c", "vulkan/vulkan.h", &["include"], &["-lyoro_c", "-lvulkan"]);
    }
}

/// Compares the Vulkan sample's shaders, which are in a C header, with a new compilation by the same compiler.
#[test]
fn the_samples_modules_are_compiled_from_its_present_shaders() {
    const COMPILER: &str = "glslangValidator";
    let header = package().join("examples/room_spv.h");
    let kept = std::fs::read_to_string(&header).unwrap_or_default();
    let output = Command::new(COMPILER).arg("--version").output();
    let version = output.ok().filter(|output| output.status.success()).map(|output| {
        String::from_utf8_lossy(&output.stdout).lines().next().unwrap_or_default().trim().to_owned()
    });
    let bless = env::var_os("YORO_BLESS").is_some();
    let Some(version) = version.filter(|version| bless || kept.contains(version)) else {
        println!(
            "LEFT OUT: compiling the sample's shaders again: the {COMPILER} that made room_spv.h is not here"
        );
        return;
    };
    let work = tempfile::tempdir().unwrap();
    let mut made = format!("/* room.vert and room.frag as SPIR-V: {COMPILER} -V -Os -g0, {version}. */\n");
    for stage in ["vert", "frag"] {
        let compiled = work.path().join(stage);
        let mut command = Command::new(COMPILER);
        command.args(["-V", "-Os", "-g0", "--vn", &format!("room_{stage}"), "-o"]).arg(&compiled);
        run(command.arg(package().join("examples").join(format!("room.{stage}"))));
        let text = std::fs::read_to_string(compiled).unwrap();
        let array = text.lines().filter(|line| !line.contains("//") && !line.contains("#pragma"));
        made.extend(array.map(|line| line.replace("const uint32_t", "static const uint32_t") + "\n"));
    }
    if bless {
        std::fs::write(&header, &made).unwrap();
    }
    assert!(
        bless || kept == made,
        "{} is stale: `cargo xtask test modules --bless` renews it",
        header.display()
    );
}

/// Unpacks what `cargo xtask package` makes, and types there what its first page says. The library is small: 1,174 kB on
/// x86_64, smaller on arm64 and Android. Making a package does not depend on that, since Rust's part differs by
/// version.
#[test]
fn the_package_is_used_as_its_first_page_says() {
    let Some(package) = env::var_os("YORO_TEST_C_PACKAGE") else {
        let without = env::var_os("YORO_TEST_WITHOUT_C_PACKAGE").is_some();
        assert!(without, "run `cargo xtask test the_package`, or set YORO_TEST_WITHOUT_C_PACKAGE=1");
        println!("LEFT OUT: the C library's package");
        return;
    };
    let work = tempfile::tempdir().unwrap();
    let mut tar = Command::new("tar");
    run(tar
        .arg("--extract")
        .arg("--strip-components=1")
        .arg("--directory")
        .arg(work.path())
        .arg("--file")
        .arg(package));
    let page = std::fs::read_to_string(work.path().join("README.md")).unwrap();
    let (_, rest) = page.split_once("\n```sh\n").unwrap();
    let (commands, _) = rest.split_once("\n```\n").unwrap();
    let vulkan = env::var_os("YORO_TEST_WITHOUT_VULKAN").is_none()
        && Path::new("/usr/include/vulkan/vulkan.h").is_file();
    let commands: Vec<&str> = commands.lines().filter(|line| vulkan || !line.contains("vulkan")).collect();
    let commands = commands.join("\n");
    let printed = run(Command::new("sh").args(["-e", "-c", &commands]).current_dir(work.path()));
    println!("{printed}");
    let decibels = |line: &str| line.strip_prefix("synthesized:")?.split_whitespace().next()?.parse().ok();
    let synthesized: Vec<f64> = printed.lines().filter_map(decibels).collect();
    assert_eq!(synthesized.len(), commands.matches(" && ./").count(), "{printed}");
    assert!(synthesized.iter().all(|&psnr| psnr > 30.0), "{printed}");
    assert!(work.path().join("build/gles").is_file(), "{printed}");
    let notices = std::fs::read_to_string(work.path().join("share/doc/yoro/NOTICES.txt")).unwrap();
    for name in ["\n  ash ", "\n  glam ", "\n  glow "] {
        assert!(notices.contains(name), "{name}: {notices}");
    }
    let size = work.path().join("lib/libyoro.so").metadata().unwrap().len();
    assert!(size < 1_200_000, "{size} bytes");
}

/// What the program in C# needs of an engine.
const ENGINE: &str = "#include \"engine_gles.h\"
    static GLuint program;
    void *engine_begin(void) { make_context(); program = make_program(); return (void *)eglGetProcAddress; }
    Image engine_image(uint32_t width, uint32_t height) { return make_image(width, height); }
    void engine_draw(const float *projection, const float *view, const Image *image) { draw(program, projection, view, image); }
    void engine_report(const char *path, const Image *made, const Image *source, int x, int y, const Image *truth) {
      report(path, made, source, x, y, truth);
    }";

/// Returns a structure's bytes as the program in C# prints them.
fn hex<T>(value: &T) -> String {
    // SAFETY: these structures have no padding.
    let bytes = unsafe { std::slice::from_raw_parts(std::ptr::from_ref(value).cast::<u8>(), size_of::<T>()) };
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

fn hex_of_views(views: &YoroViews) -> String {
    let images = [&views.source, &views.rendered, &views.synthesized].map(hex).concat();
    hex(&views.crop_x) + &hex(&views.crop_y) + &images + &hex(&views.warp)
}

/// What C# gets is what C gets, bit for bit, and its picture is that of the sample in C.
#[test]
fn csharp_calls_the_library() {
    if !is_here("mcs") || !is_here("mono") {
        let without = env::var_os("YORO_TEST_WITHOUT_MONO").is_some();
        assert!(without, "run `cargo xtask test csharp`, or set YORO_TEST_WITHOUT_MONO=1");
        println!("SKIPPED: no mono here");
        return;
    }
    let work = tempfile::tempdir().unwrap();
    let at = |name: &str| work.path().join(name);
    let mut compiler = Command::new("mcs");
    compiler.args(["-unsafe", "-warnaserror", "-warn:4"]).arg(format!("-out:{}", at("calls.exe").display()));
    run(compiler
        .args(["csharp/Yoro.cs", "csharp/Safe.cs", "tests/calls.cs"].map(|file| package().join(file))));
    std::os::unix::fs::symlink(library().join("libyoro_c.so"), at("libyoro.so")).unwrap();
    let mut mono = Command::new("mono");
    mono.arg(at("calls.exe")).env("LD_LIBRARY_PATH", work.path());
    let expected = gles();
    if expected.is_some() {
        std::fs::write(at("engine.c"), ENGINE).unwrap();
        let mut gcc = Command::new("cc");
        gcc.args(["-shared", "-fPIC", "-I"]).arg(package().join("examples")).arg(at("engine.c"));
        run(gcc.args(["-lEGL", "-lGLESv2", "-lm", "-o"]).arg(at("libengine.so")));
        mono.arg(at("picture.png"));
    }
    let printed = run(&mut mono);

    let mut eyes = common::good_eyes();
    (eyes.width, eyes.height) = (512, 512);
    for (eye, (pose, fov)) in eyes.poses.iter_mut().zip(&mut eyes.fovs).enumerate() {
        pose.position = [[-0.0315, 0.0315][eye], 1.6, 2.0];
        let [left, right] = [[-0.7, 0.6], [-0.6, 0.7]][eye];
        *fov = YoroFov { angle_left: left, angle_right: right, angle_up: 0.65, angle_down: -0.65 };
    }
    let views = common::views_of(&eyes).unwrap();
    let mut matrices = common::matrices_of(&views, &eyes);
    matrices.guard_band = eyes.guard_band;
    matrices.view.iter_mut().for_each(|view| view[8..12].iter_mut().for_each(|z| *z = -*z));
    let of_matrices = common::views_of_matrices(&matrices).unwrap();
    let ([wide, inset], compositions) = common::levels_of(&eyes, &common::medium()).unwrap();
    let mut ways = String::new();
    let mut chooser = std::ptr::null_mut();
    // SAFETY: the chooser is created first and destroyed last.
    unsafe {
        assert_eq!(yoro_chooser_create(YORO_WAY_SYNTHESIS, &mut chooser), YORO_OK);
        for frame in 0..200 {
            let mut end: YoroFrameEnd = common::zeroed(|e: &mut YoroFrameEnd| &mut e.struct_size);
            (end.rendered, end.now_ns, end.refresh_hz) = (YORO_WAY_OTHER, frame * 11_111_111, 90.0);
            let mut choice: YoroChoice = common::zeroed(|c: &mut YoroChoice| &mut c.struct_size);
            assert_eq!(yoro_chooser_end_frame(chooser, &end, &mut choice), YORO_OK);
            ways += &choice.next.to_string();
        }
        yoro_chooser_destroy(chooser);
    }
    for (name, expected) in [
        ("version", yoro_version().to_string()),
        ("eyes", hex_of_views(&views)),
        ("matrices", hex_of_views(&of_matrices)),
        ("wide", hex_of_views(&wide)),
        ("inset", hex_of_views(&inset)),
        ("composition", hex(&compositions[0])),
        ("composition", hex(&compositions[1])),
        ("ways", ways),
    ] {
        let line = format!("{name} {expected}");
        assert!(printed.lines().any(|printed| printed == line), "{line}\n{printed}");
    }
    if let Some(expected) = expected {
        let drawn = image::open(at("picture.png")).unwrap().to_rgb8();
        assert!(drawn == expected, "the picture is not that of the sample in C");
    }
}

/// A program with only the shader kit draws the same picture as the library.
#[test]
fn the_kit_draws_the_librarys_picture() {
    let kit = tempfile::tempdir().unwrap();
    kit::write(kit.path()).unwrap();
    let folder = kit.path().to_str().unwrap();
    // Uses only the kit's own files.
    let example = kit.path().join("example.c");
    let example = example.to_str().unwrap();
    let Some(drawn) = sample(example, "GLES3/gl31.h", &[folder], &["-lEGL", "-lGLESv2"]) else { return };
    let Some(expected) = gles() else { return };
    let largest = drawn.iter().zip(expected.iter()).map(|(a, b)| a.abs_diff(*b)).max().unwrap();
    let different = drawn.iter().zip(expected.iter()).filter(|(a, b)| a != b).count();
    assert!(largest <= 1 && different * 1000 < drawn.len(), "{largest} {different}");
}

/// Numbers out of range are refused, and nothing overflows on the way.
#[test]
fn the_kit_refuses_what_cannot_be() {
    const TEXT: &str = "#include \"yoro_kit.h\"
        #include <limits.h>
        #include <stdio.h>
        static const YoroKitEyes GOOD = {{{-1, 1, 1, -1}, {-1, 1, 1, -1}}, 0.063f, 0.1f, INFINITY, 1, 1, 512, 512, 1.0f, 0};
        static int served(YoroKitEyes eyes) { YoroKitViews views; return yoro_kit_views(&eyes, 0, 0, &views); }
        #define WITH(change) { YoroKitEyes e = GOOD; change; if (served(e)) { puts(#change); failed = 1; } }
        int main(void) {
          int failed = !served(GOOD);
          YoroKitEyes giant = GOOD;
          giant.ipd = 63, giant.near_z = 100, giant.guard_band = 1000;
          failed |= !served(giant);
          WITH(e.guard_band = 1e-30f) WITH(e.guard_band = NAN) WITH(e.ipd = 1e30f) WITH(e.ipd = INFINITY) WITH(e.ipd = NAN)
          WITH(e.width = INT_MAX) WITH(e.height = 70000) WITH(e.width = 0) WITH(e.near_z = 1e-30f) WITH(e.near_z = NAN)
          WITH(e.frusta[0].left = NAN) WITH(e.frusta[1].up = INFINITY) WITH((e.frusta[0].left = -1e9f, e.frusta[0].right = -1e9f + 128))
          return failed;
        }";
    of_kit(TEXT, &["-fsanitize=undefined,float-cast-overflow", "-fno-sanitize-recover=all"]);
}

/// All files of the kit but Godot's, in all variants.
#[test]
fn the_kits_shaders_compile() {
    const COMPILER: &str = "glslangValidator";
    const APIS: [(&str, &[&str]); 3] =
        [("gles", &[]), ("vulkan", &["-V", "-o"]), ("hlsl", &["-D", "-V", "-e", "main", "-o"])];
    const LAST_PASSES: [&[&str]; 5] = [
        &[],
        &["-DWRITE_DEPTH"],
        &["-DMOTION", "-DWRITE_DEPTH"],
        &["-DOPEN_HOLES", "-DSOURCE_MAP"],
        &["-DSOURCE_PARTS", "-DWRITE_DEPTH"],
    ];
    if !is_here(COMPILER) {
        println!("SKIPPED: {COMPILER} is not here");
        return;
    }
    let kit = tempfile::tempdir().unwrap();
    kit::write(kit.path()).unwrap();
    let mut count = 0;
    for (api, options) in APIS {
        for file in std::fs::read_dir(kit.path().join(api)).unwrap() {
            let path = file.unwrap().path();
            let is_last = path.file_name().unwrap().to_str().unwrap().contains("march.frag");
            // OpenGL ES gets what Vulkan gets.
            for macros in &LAST_PASSES[..if is_last && api != "gles" { LAST_PASSES.len() } else { 1 }] {
                let compiled = options.contains(&"-o").then(|| kit.path().join("compiled"));
                run(Command::new(COMPILER).args(options).args(compiled).args(*macros).arg(&path));
                count += 1;
            }
        }
    }
    assert_eq!(count, 10 + 18 + 19);
}

/// The kit's uniforms of any view are the core's, with rows from the bottom and from the top.
#[test]
fn the_kit_and_the_core_find_the_same_place_of_any_view() {
    const TEXT: &str = "#include \"yoro_kit.h\"
        #include <stdio.h>
        int main(void) {
          YoroKitView source = {{{0, 0.0998334f, 0, 0.9950042f}, {1, 1.6f, -20}}, {-0.8f, 0.7f, 0.6f, -0.5f}, 320, 240};
          YoroKitView target = {{{0.0499792f, 0, 0, 0.9987503f}, {1.02f, 1.55f, -20.3f}}, {-0.6f, 0.6f, 0.5f, -0.5f}, 300, 200};
          YoroKitPoseUniforms block;
          int maps[2][2], failed = sizeof block != 112;
          for (int rows_down = 0; rows_down < 2; ++rows_down) {
            const int served = yoro_kit_any_view(&source, &target, 0.1f, 50, rows_down, rows_down, 7, 9, maps, &block);
            failed |= !served || maps[0][0] != 20 || maps[0][1] != 30 || maps[1][0] != 19 || maps[1][1] != 25;
            const uint32_t *words = (const uint32_t *)&block;
            for (int i = 0; i < 28; ++i) printf(\"%lu\\n\", (unsigned long)words[i]);
          }
          YoroKitView behind = target;
          behind.pose.orientation[0] = 0.8f, behind.pose.orientation[3] = 0.6f;
          failed |= yoro_kit_any_view(&source, &behind, 0.1f, 50, 0, 0, 0, 0, maps, &block);
          failed |= yoro_kit_any_view(&source, &target, 0.1f, NAN, 0, 0, 0, 0, maps, &block);
          target.width = 0;
          failed |= yoro_kit_any_view(&source, &target, 0.1f, 50, 0, 0, 0, 0, maps, &block);
          return failed;
        }";
    let Some(printed) = of_kit(TEXT, &[]) else { return };
    let words: Vec<u32> = printed.lines().map(|line| line.parse().unwrap()).collect();
    for (down, own) in words.chunks(28).enumerate() {
        let convention = [DepthConvention::Standard, DepthConvention::Reversed][down];
        let view =
            |orientation: glam::Quat, position: [f32; 3], [left, right, bottom, top]: [f32; 4], size| View {
                pose: Pose { orientation, position: position.into() },
                frustum: Frustum { left, right, bottom, top },
                depth: DepthRange { near: 0.1, far: 50.0, convention },
                size,
            };
        let source =
            view(glam::Quat::from_rotation_y(0.2), [1.0, 1.6, -20.0], [-0.8, 0.7, -0.5, 0.6], [320, 240]);
        let target =
            view(glam::Quat::from_rotation_x(0.1), [1.02, 1.55, -20.3], [-0.6, 0.6, -0.5, 0.5], [300, 200]);
        let warp = PoseWarp::new(&source, &target).unwrap();
        let warp = if down == 1 { warp.rows_from_top() } else { warp };
        let places =
            Places { source_origin: [0, 0], image_size: [320, 240], target_origin: [7, 9], part: false };
        let core = PoseUniforms::new(&warp, &places);
        let expected: &[u32] = bytemuck::cast_slice(bytemuck::bytes_of(&core));
        compare_blocks(PoseUniforms::LAYOUT, own, expected);
    }
}

/// Compares blocks of a layout, without what is beyond the first one's end. Orientations are given with seven digits.
fn compare_blocks(layout: &[(&str, &str, usize)], own: &[u32], expected: &[u32]) {
    for (name, glsl, offset) in layout.iter().filter(|(.., offset)| offset / 4 < own.len()) {
        let count = match *glsl {
            "float" | "int" | "bool" => 1,
            "vec4" => 4,
            _ => 2,
        };
        for i in offset / 4..offset / 4 + count {
            let [got, want] = [own[i], expected[i]];
            if glsl.starts_with(['i', 'b']) {
                assert_eq!(got, want, "{name}");
            } else {
                let [got, want] = [got, want].map(f32::from_bits);
                let off = (got - want).abs();
                assert!(off <= 1e-5 * want.abs().max(1.0) + 1e-7, "{name}: {got}, {want}");
            }
        }
    }
}

/// The kit's uniforms of a source that is a part of its textures are the core's, for both eyes, with rows from the bottom
/// and from the top.
#[test]
fn the_kit_and_the_core_find_the_same_part() {
    const TEXT: &str = "#include \"yoro_kit.h\"
        #include <stdio.h>
        int main(void) {
          for (int i = 0; i < 2; ++i) {
            YoroKitEyes eyes = {{{-1.2f, 0.9f, 1.0f, -1.1f}, {-0.9f, 1.2f, 1.0f, -1.1f}}, 0.063f, 0.1f, 50, i, i, 300, 280, 1.0f, i};
            YoroKitViews views;
            YoroKitUniforms block;
            if (!yoro_kit_views(&eyes, 7, 9, &views)) return 1;
            yoro_kit_source_part(&views, 11, 13, 500, 400, &block);
            const uint32_t *words = (const uint32_t *)&block;
            for (int k = 0; k < 28; ++k) printf(\"%lu\\n\", (unsigned long)words[k]);
          }
          return 0;
        }";
    let Some(printed) = of_kit(TEXT, &[]) else { return };
    let words: Vec<u32> = printed.lines().map(|line| line.parse().unwrap()).collect();
    for (down, own) in words.chunks(28).enumerate() {
        let frustum = |left: f32| Frustum { left, right: left + 2.1, bottom: -1.1, top: 1.0 };
        let convention = [DepthConvention::Standard, DepthConvention::Reversed][down];
        let depth = DepthRange { near: 0.1, far: 50.0, convention };
        let dominant = [Eye::Left, Eye::Right][down];
        let mut pair = EyePair::parallel(Pose::IDENTITY, frustum(0.0), 0.063, depth, [300, 280], dominant);
        pair.frusta = [frustum(-1.2), frustum(-0.9)];
        let warp = pair.synthesis_views(GuardBand::Distance(1.0)).unwrap().warp;
        let warp = if down == 1 { warp.rows_from_top() } else { warp };
        let places =
            Places { source_origin: [11, 13], image_size: [500, 400], target_origin: [7, 9], part: true };
        let core = Uniforms::of_part(&warp, &places);
        compare_blocks(Uniforms::LAYOUT, own, bytemuck::cast_slice(bytemuck::bytes_of(&core)));
    }
}

/// The kit's law of motion vectors is the core's, for both eyes, with frusta, planes and distance that change.
#[test]
fn the_kit_and_the_core_have_one_law_of_motion() {
    const TEXT: &str = "#include \"yoro_kit.h\"
        #include <stdio.h>
        int main(void) {
          for (int i = 0; i < 2; ++i) {
            YoroKitEyes now = {{{-1.2f, 0.9f, 1.0f, -1.1f}, {-0.9f, 1.2f, 1.0f, -1.1f}}, 0.063f, 0.1f, 50, i, i, 300, 280, 1.0f, i};
            YoroKitEyes then = {{{-1.1f, 1.0f, 1.0f, -1.1f}, {-0.8f, 1.3f, 1.0f, -1.1f}}, 0.06f, 0.2f, 60, i, i, 300, 280, 1.0f, i};
            float motion[4];
            yoro_kit_motion(&now, &then, i, motion);
            for (int k = 0; k < 4; ++k) printf(\"%.9g\\n\", motion[k]);
          }
          return sizeof(YoroKitMotionUniforms) != 128;
        }";
    let Some(printed) = of_kit(TEXT, &[]) else { return };
    let numbers: Vec<f64> = printed.lines().map(|line| line.parse().unwrap()).collect();
    for (i, got) in numbers.chunks(4).enumerate() {
        let views = |shift: f32, ipd: f32, near: f32, far: f32| {
            let frustum = |left: f32| Frustum { left, right: left + 2.1, bottom: -1.1, top: 1.0 };
            let convention = [DepthConvention::Standard, DepthConvention::Reversed][i];
            let depth = DepthRange { near, far, convention };
            let dominant = [Eye::Left, Eye::Right][i];
            let mut pair = EyePair::parallel(Pose::IDENTITY, frustum(0.0), ipd, depth, [300, 280], dominant);
            pair.frusta = [frustum(-1.2 + shift), frustum(-0.9 + shift)];
            pair.synthesis_views(GuardBand::Distance(1.0)).unwrap()
        };
        let space = VectorSpace { ndc: [Ndc::ZeroToOne, Ndc::MinusOneToOne][i], of: VectorsOf::Eye };
        let law = views(0.0, 0.063, 0.1, 50.0).motion(&views(0.1, 0.06, 0.2, 60.0), space).unwrap().law;
        let want = [law.per_z, law.per_depth, law.constant, 0.0];
        assert!(got.iter().zip(want).all(|(got, want)| (got - want).abs() < 1e-5), "{got:?}, {want:?}");
    }
}

/// The kit's levels and their composition are the core's, for both eyes, with rows from the bottom and from the top.
#[test]
fn the_kit_and_the_core_compose_the_same_eye() {
    const TEXT: &str = "#include \"yoro_kit.h\"
        #include <stdio.h>
        int main(void) {
          const YoroKitFoveation foveation = {0.35f, 0.5f, 0.5f, {0.2f, -0.1f}};
          const YoroKitPart wide_part = {3, 5, 170, 160}, inset_part = {2, 1, 200, 210};
          int failed = sizeof(YoroKitLevelUniforms) != 128;
          for (int down = 0; down < 2; ++down) for (int eye = 0; eye < 2; ++eye) {
            YoroKitEyes eyes = {{{-1.2f, 0.9f, 1.0f, -1.1f}, {-0.9f, 1.2f, 1.0f, -1.1f}}, 0.063f, 0.1f, 50, down, down, 300, 280, 1.0f, down};
            YoroKitEyes wide, inset;
            YoroKitViews views;
            YoroKitLevelUniforms block;
            failed |= !yoro_kit_levels(&eyes, &foveation, &wide, &inset) || !yoro_kit_views(&inset, 0, 0, &views);
            failed |= wide.width != 150 || wide.height != 140;
            yoro_kit_compose(&eyes, &wide, &inset, eye, &wide_part, &inset_part, &views, 7, 9, &block);
            const float *numbers = (const float *)&block;
            printf(\"%d %d\", inset.width, inset.height);
            for (int i = 0; i < 30; ++i) printf(\" %.9g\", numbers[i]);
            printf(\"\\n\");
            YoroKitFoveation other = foveation;
            other.radius = 1.2f;
            failed |= yoro_kit_levels(&eyes, &other, &wide, &inset);
            other = foveation, other.density = NAN;
            failed |= yoro_kit_levels(&eyes, &other, &wide, &inset);
          }
          return failed;
        }";
    let Some(printed) = of_kit(TEXT, &[]) else { return };
    let mut lines = printed.lines();
    for (down, eye) in [(false, 0), (false, 1), (true, 0), (true, 1)] {
        let (dominant, convention) = match down {
            false => (Eye::Left, DepthConvention::Standard),
            true => (Eye::Right, DepthConvention::Reversed),
        };
        let eyes = EyePair {
            poses: [-0.0315, 0.0315].map(|x| Pose { position: glam::Vec3::X * x, ..Pose::IDENTITY }),
            frusta: [[-1.2, 0.9], [-0.9, 1.2]].map(|[left, right]| Frustum {
                left,
                right,
                bottom: -1.1,
                top: 1.0,
            }),
            depth: DepthRange { near: 0.1, far: 50.0, convention },
            size: [300, 280],
            dominant,
        };
        let foveation = Foveation { radius: 0.35, ..Foveation::MEDIUM };
        let gaze = Gaze::Direction(glam::Vec3::new(0.2, -0.1, -1.0));
        let levels = eyes.stereo_views(Some(&foveation), gaze).unwrap();
        let places = LevelPlaces {
            target: [7, 9],
            wide: [3, 5],
            wide_image: [170, 160],
            inset: [2, 1],
            inset_image: [200, 210],
            depth: true,
        };
        let composition = levels.composition(Eye::BOTH[eye]);
        let core = match down {
            false => LevelUniforms::new(&composition, &places),
            true => LevelUniforms::rows_from_top(&composition, &places),
        };
        let core: &[f32] = bytemuck::cast_slice(bytemuck::bytes_of(&core));
        let own: Vec<f32> = lines.next().unwrap().split(' ').map(|word| word.parse().unwrap()).collect();
        assert_eq!([own[0] as u32, own[1] as u32], levels.inset.unwrap().eyes.size);
        for (i, (got, want)) in own[2..].iter().zip(core).enumerate() {
            // The kit has no column to spare in the source, so that one number may differ by a column.
            let columns = if (24..27).contains(&i) { 0.02 } else { 2e-5 };
            assert!((got - want).abs() <= columns * want.abs().max(1.0), "{down} {eye}, {i}: {got}, {want}");
        }
    }
}

/// Compiles both stages of Godot's files, in every version, split as Godot splits them.
#[test]
fn the_kits_shaders_for_godot_compile() {
    const COMPILER: &str = "glslangValidator";
    let kit = tempfile::tempdir().unwrap();
    kit::write(kit.path()).unwrap();
    let mut count = 0;
    for name in ["tiles", "spans", "march", "any_view_tiles", "any_view_spans", "any_view_march", "compose"] {
        let text = std::fs::read_to_string(kit.path().join(format!("godot/{name}.glsl"))).unwrap();
        let (versions, stages) = text.split_once("\n#[vertex]\n").unwrap();
        let (vertex, fragment) = stages.split_once("\n#[fragment]\n").unwrap();
        // Without versions there is one of no name.
        let lines = versions.lines().skip(1).chain(versions.is_empty().then_some(" = \"\";"));
        for line in lines {
            let (version, defines) = line.split_once(" = \"").unwrap();
            let defines = defines.strip_suffix("\";").unwrap().replace("\\n", "\n");
            for (stage, text) in [("vert", vertex), ("frag", fragment)] {
                assert_eq!(text.matches("#VERSION_DEFINES\n").count(), 1, "{name} {stage}");
                assert!(!text.contains("// #define "), "{name} {stage}");
                count += 1;
                if is_here(COMPILER) {
                    let file = kit.path().join(format!("{name}-{version}.{stage}"));
                    std::fs::write(&file, text.replace("#VERSION_DEFINES", &defines)).unwrap();
                    let mut command = Command::new(COMPILER);
                    run(command.args(["-V", "-o"]).arg(kit.path().join("compiled")).arg(file));
                }
            }
        }
    }
    assert_eq!(count, 18);
    if !is_here(COMPILER) {
        println!("SKIPPED: {COMPILER} is not here");
    }
}
