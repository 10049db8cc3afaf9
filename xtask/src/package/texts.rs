//! The files of packages that build systems read.

use super::VERSION;

/// Returns the library's soname. A program runs with any version of the library that has the same soname. While the
/// first number is 0, these are the versions that differ only in the last number.
pub fn soname() -> String {
    let mut parts = VERSION.split('.');
    match (parts.next(), parts.next()) {
        (Some("0"), Some(minor)) => format!("libyoro.so.0.{minor}"),
        (major, _) => format!("libyoro.so.{}", major.unwrap_or_default()),
    }
}

/// Returns the file for pkg-config, which works wherever the package is unpacked.
pub fn pkg_config(needs: &[String]) -> String {
    format!(
        "prefix=${{pcfiledir}}/../..\n\
         includedir=${{prefix}}/include\n\
         libdir=${{prefix}}/lib\n\
         \n\
         Name: yoro\n\
         Description: Render one eye, synthesize the other\n\
         Version: {VERSION}\n\
         Cflags: -I${{includedir}}\n\
         Libs: -L${{libdir}} -lyoro\n\
         Libs.private: {}\n",
        needs.join(" ")
    )
}

/// Returns the file for CMake, with the targets yoro::yoro and yoro::static.
pub fn cmake(needs: &[String]) -> String {
    format!(
        "get_filename_component(_yoro_prefix \"${{CMAKE_CURRENT_LIST_DIR}}/../../..\" ABSOLUTE)\n\
         if(NOT TARGET yoro::yoro)\n\
         \x20 add_library(yoro::yoro SHARED IMPORTED)\n\
         \x20 set_target_properties(yoro::yoro PROPERTIES\n\
         \x20   IMPORTED_LOCATION \"${{_yoro_prefix}}/lib/libyoro.so.{VERSION}\"\n\
         \x20   IMPORTED_SONAME {}\n\
         \x20   INTERFACE_INCLUDE_DIRECTORIES \"${{_yoro_prefix}}/include\")\n\
         \x20 add_library(yoro::static STATIC IMPORTED)\n\
         \x20 set_target_properties(yoro::static PROPERTIES\n\
         \x20   IMPORTED_LOCATION \"${{_yoro_prefix}}/lib/libyoro.a\"\n\
         \x20   INTERFACE_INCLUDE_DIRECTORIES \"${{_yoro_prefix}}/include\"\n\
         \x20   INTERFACE_LINK_LIBRARIES \"{}\")\n\
         endif()\n\
         unset(_yoro_prefix)\n",
        soname(),
        needs.join(";")
    )
}

/// Returns the CMake file that checks whether the package satisfies `find_package(yoro VERSION)`.
pub fn cmake_version() -> String {
    let soname = soname();
    let series = soname.trim_start_matches("libyoro.so.");
    format!(
        "set(PACKAGE_VERSION {VERSION})\n\
         if(PACKAGE_FIND_VERSION VERSION_GREATER PACKAGE_VERSION)\n\
         \x20 set(PACKAGE_VERSION_COMPATIBLE FALSE)\n\
         elseif(NOT \"${{PACKAGE_FIND_VERSION}}.\" MATCHES \"^{}\\\\.\" AND PACKAGE_FIND_VERSION)\n\
         \x20 set(PACKAGE_VERSION_COMPATIBLE FALSE)\n\
         else()\n\
         \x20 set(PACKAGE_VERSION_COMPATIBLE TRUE)\n\
         \x20 if(PACKAGE_FIND_VERSION VERSION_EQUAL PACKAGE_VERSION)\n\
         \x20   set(PACKAGE_VERSION_EXACT TRUE)\n\
         \x20 endif()\n\
         endif()\n",
        series.replace('.', "\\\\.")
    )
}

/// Returns the parts of docs/engines.md that concern C: the chapter on C, then those that do not depend on a language.
pub fn manual(text: &str) -> String {
    const CHAPTERS: [&str; 8] = [
        "## C and C++",
        "## Where in a frame",
        "## The guard band",
        "## Colour and depth",
        "## Poses",
        "## Any view",
        "## When two renders are cheaper",
        "## When it looks wrong",
    ];
    let mut manual = String::from("# yoro in C and C++\n");
    for chapter in CHAPTERS {
        let Some(start) = text.find(&format!("\n{chapter}\n")) else { continue };
        let body = &text[start + 1..];
        let end = body.find("\n## ").map_or(body.len(), |end| end + 1);
        manual.push('\n');
        manual.push_str(body[..end].trim_end());
        manual.push('\n');
    }
    manual
}

/// Returns the README of a package: its content, and how to compile the samples.
pub fn readme(architecture: &str, (major, minor): (u32, u32)) -> String {
    format!(
        "# yoro {VERSION} for Linux on {architecture}\n\
         \n\
         Render one eye, synthesize the other. Needs glibc {major}.{minor} or newer, and at run time the drivers' libraries.\n\
         \n\
         | | |\n\
         |---|---|\n\
         | [include/yoro.h](include/yoro.h) | step by step, then every function: arguments, threads, errors |\n\
         | [share/doc/yoro/guide.md](share/doc/yoro/guide.md) | colour and depth, poses, when it looks wrong |\n\
         | [share/yoro/examples](share/yoro/examples) | samples, with a `CMakeLists.txt` |\n\
         | `lib` | `libyoro.so`, `libyoro.a`, files for pkg-config and CMake |\n\
         \n\
         The samples, from this folder:\n\
         \n\
         ```sh\n\
         export PKG_CONFIG_PATH=$PWD/lib/pkgconfig\n\
         FLAGS=\"$(pkg-config --cflags --libs yoro) -Wl,-rpath,$PWD/lib\"\n\
         cc share/yoro/examples/gles.c $FLAGS -lEGL -lGLESv2 -lm -o gles && ./gles\n\
         cc share/yoro/examples/any_view.c $FLAGS -lEGL -lGLESv2 -lm -o any_view && ./any_view\n\
         cc share/yoro/examples/vulkan.c $FLAGS -lvulkan -lm -o vulkan && ./vulkan\n\
         cmake -S share/yoro/examples -B build -DCMAKE_PREFIX_PATH=$PWD && cmake --build build    # or all by CMake\n\
         ```\n\
         \n\
         They write `gles.png` and `vulkan.png`, both eyes side by side, and print how close the synthesized eye is to a\n\
         rendered one; `any_view` does so with a view from another pose. A program of your own links `yoro` as they do;\n\
         `lib/libyoro.a` in place of it needs no `-rpath`.\n\
         \n\
         MIT or Apache 2.0, at your option: `share/doc/yoro`, with the notices of others' code in the library.\n"
    )
}

/// Replaces the targets of Markdown links. A link without a new target becomes its label.
pub fn with_links(text: &str, mut target: impl FnMut(&str) -> Option<String>) -> String {
    let (mut out, mut rest) = (String::new(), text);
    while let Some((before, label, link, after)) = next_link(rest) {
        out.push_str(before);
        match target(link) {
            Some(target) => out.push_str(&format!("[{label}]({target})")),
            None => out.push_str(label),
        }
        rest = after;
    }
    out + rest
}

/// Splits a text at its first link: the text before it, the label, the target, and the text after it.
fn next_link(text: &str) -> Option<(&str, &str, &str, &str)> {
    let middle = text.find("](")?;
    let start = text[..middle].rfind('[')?;
    let end = middle + text[middle..].find(')')?;
    Some((&text[..start], &text[start + 1..middle], &text[middle + 2..end], &text[end + 1..]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_are_led_elsewhere_or_end() {
        let text = "See [a](x.md), `b[0]`, [c](y.md#z) and ![d](p.png).";
        let led = with_links(text, |target| target.ends_with("png").then(|| format!("q/{target}")));
        assert_eq!(led, "See a, `b[0]`, c and ![d](q/p.png).");
    }

    #[test]
    fn the_manual_is_about_c() {
        let text = "# All\n\n## Poses\n\nb\n\n## Vulkan\n\nc\n\n## C and C++\n\na\n### Depth\n\n## The shader kit\nd\n";
        assert_eq!(manual(text), "# yoro in C and C++\n\n## C and C++\n\na\n### Depth\n\n## Poses\n\nb\n");
    }

    #[test]
    fn texts_name_this_version() {
        let needs = ["-lm".to_owned(), "-lc".to_owned()];
        let series: Vec<&str> = VERSION.split('.').take(2).collect();
        assert_eq!(soname(), format!("libyoro.so.{}", series.join(".")));
        assert!(pkg_config(&needs).contains(&format!("\nVersion: {VERSION}\n")));
        assert!(pkg_config(&needs).ends_with("Libs.private: -lm -lc\n"));
        assert!(cmake(&needs).contains("INTERFACE_LINK_LIBRARIES \"-lm;-lc\""));
        assert!(cmake(&needs).contains(&format!("IMPORTED_SONAME libyoro.so.{}\n", series.join("."))));
        assert!(cmake_version().contains(&format!("MATCHES \"^{}\\\\.\"", series.join("\\\\."))));
    }
}
