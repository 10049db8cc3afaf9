//! The committed header is the one that cbindgen generates from the source.

use std::path::Path;

/// Returns cbindgen's text with each constant after its type, instead of before all functions.
fn arranged(made: &str) -> String {
    let mut blocks: Vec<String> = Vec::new();
    let mut constants = Vec::new();
    for block in made.split("\n\n") {
        match block.lines().find_map(|line| line.strip_prefix("#define YORO_")) {
            // A #define of more than one token needs parentheses.
            Some(_) if block.starts_with("/**") => constants.push(negative_in_parentheses(block)),
            _ => blocks.push(block.to_owned()),
        }
    }
    for block in &mut blocks {
        let Some(name) = block.lines().find_map(|line| line.strip_prefix("typedef ")?.strip_suffix(';'))
        else {
            continue;
        };
        let Some(("int32_t" | "uint32_t", name)) = name.split_once(' ') else { continue };
        let belongs = |constant: &String| prefixes(name).iter().any(|prefix| constant.contains(prefix));
        let own: Vec<String> = constants.extract_if(.., |constant| belongs(constant)).collect();
        block.extend(own.iter().map(|constant| format!("\n{constant}")));
    }
    // Constants without a type of this library, such as versions, come first.
    let first = blocks.iter().position(|block| block.starts_with("/**")).unwrap();
    blocks.splice(first..first, constants);
    blocks.join("\n\n")
}

/// Moves everything for Vulkan behind the include guard, with a guard of its own, so that the header can be included
/// again after vulkan.h. Replaces `//` comments, which C89 does not have.
fn vulkan_last(header: &str) -> String {
    const CONDITION: &str = "#if defined(VK_VERSION_1_1)\n";
    let mut rest = header.replace("// __cplusplus", "/* __cplusplus */");
    let (mut types, mut functions) = (String::new(), String::new());
    while let Some(start) = rest.find(CONDITION) {
        let end = start + rest[start..].find("#endif\n").unwrap() + "#endif\n".len();
        let item = rest[start + CONDITION.len()..end - "#endif\n".len()].to_owned();
        let to = if item.contains("YoroResult yoro_") { &mut functions } else { &mut types };
        to.push_str(&format!("\n{item}"));
        rest.replace_range(start..end, "");
    }
    while rest.contains("\n\n\n") {
        rest = rest.replace("\n\n\n", "\n\n");
    }
    format!(
        "{rest}\n#ifdef YORO_USE_VULKAN\n#include <vulkan/vulkan.h>\n#endif\n\n\
         #if defined(VK_VERSION_1_1) && !defined(YORO_VULKAN_H)\n#define YORO_VULKAN_H\n{types}\n\
         #ifdef __cplusplus\nextern \"C\" {{\n#endif\n{functions}\n#ifdef __cplusplus\n}}\n#endif\n\n#endif  /* YORO_VULKAN_H */\n"
    )
}

fn negative_in_parentheses(block: &str) -> String {
    match block.rsplit_once(" -") {
        Some((define, number)) if number.bytes().all(|b| b.is_ascii_digit()) => {
            format!("{define} (-{number})")
        }
        _ => block.to_owned(),
    }
}

/// Returns the prefixes of a type's constants, such as `#define YORO_EYES_` for YoroEyesFlags.
fn prefixes(name: &str) -> Vec<String> {
    if name == "YoroResult" {
        return ["OK ", "ERROR_"].map(|constant| format!("#define YORO_{constant}")).into();
    }
    let mut prefix = String::from("#define ");
    for (i, letter) in name.trim_end_matches("Flags").char_indices() {
        if i > 0 && letter.is_ascii_uppercase() {
            prefix.push('_');
        }
        prefix.push(letter.to_ascii_uppercase());
    }
    vec![prefix + "_"]
}

#[test]
fn the_header_is_that_of_the_source() {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    let config = cbindgen::Config::from_file(package.join("cbindgen.toml")).unwrap();
    let bindings = cbindgen::Builder::new().with_crate(package).with_config(config).generate().unwrap();
    let mut made = Vec::new();
    bindings.write(&mut made);
    let made = vulkan_last(&arranged(&String::from_utf8(made).unwrap()));
    let header = package.join("include/yoro.h");
    if std::env::var_os("YORO_BLESS").is_some() {
        std::fs::write(&header, &made).unwrap();
    }
    let kept = std::fs::read_to_string(&header).unwrap_or_default();
    assert!(kept == made, "{} is stale: `cargo xtask test the_header --bless` renews it", header.display());
}

/// Returns what csbindgen makes of the source, with arrays whose elements it does not know as one field for each eye,
/// and the negative constants, which it leaves out.
fn csharp(source: &Path) -> String {
    // The order of the C header. Vulkan's calls take handles of the engine's native side, and are made there.
    const FILES: &str = "result types views eyes matrices pose motion levels choice context gl gl/compose";
    let work = tempfile::tempdir().unwrap();
    let mut builder = csbindgen::Builder::default();
    let mut errors = String::new();
    for (i, name) in FILES.split(' ').enumerate() {
        let text = std::fs::read_to_string(source.join(format!("{name}.rs"))).unwrap();
        let mut docs = String::new();
        for line in text.lines() {
            match (line.strip_prefix("///"), line.strip_prefix("pub const YORO_ERROR_")) {
                (Some(doc), _) => docs.push_str(doc),
                (_, Some(rest)) => {
                    let (name, code) = rest.trim_end_matches(';').split_once(": YoroResult = ").unwrap();
                    let doc = std::mem::take(&mut docs);
                    let docs = doc.trim();
                    errors.push_str(&format!(
                        "        /// <summary>\n        ///  {docs}\n        /// </summary>\n        public const int YORO_ERROR_{name} = {code};\n"
                    ));
                }
                _ => docs.clear(),
            }
        }
        let file = work.path().join(format!("{i}.rs"));
        std::fs::write(&file, text.replace("[[f32; 16]; 2]", "[f32; 32]")).unwrap();
        builder = builder.input_extern_file(file);
    }
    let made = work.path().join("Yoro.cs");
    let builder = builder.csharp_dll_name("yoro").csharp_class_name("Native").csharp_namespace("Yoro");
    let builder = builder.csharp_class_accessibility("public").csharp_use_function_pointer(false);
    builder.csharp_generate_const_filter(|_| true).generate_csharp_file(&made).unwrap();
    let made = std::fs::read_to_string(made).unwrap();
    let mut lines: Vec<String> = Vec::new();
    for line in made.lines() {
        match line
            .split_once("fixed byte/* ")
            .and_then(|(_, rest)| rest.split_once(", this length is invalid"))
        {
            Some((kind, rest)) => {
                let name = rest.rsplit_once("*/ ").unwrap().1.strip_suffix("[2];").unwrap();
                lines.push(format!("        public {kind} {name}_left, {name}_right;"));
            }
            None => lines.push(line.trim_end().to_owned()),
        }
        if line.contains("YORO_OK = 0") {
            lines.push(errors.trim_end().to_owned());
        }
    }
    lines.join("\n") + "\n"
}

#[test]
fn the_binding_for_csharp_is_that_of_the_source() {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    let made = csharp(&package.join("src"));
    assert!(!made.contains("invalid"), "an array whose elements C# does not know: {made}");
    let binding = package.join("csharp/Yoro.cs");
    if std::env::var_os("YORO_BLESS").is_some() {
        std::fs::write(&binding, &made).unwrap();
    }
    let kept = std::fs::read_to_string(&binding).unwrap_or_default();
    assert!(kept == made, "{} is stale: `cargo xtask test the_binding --bless` renews it", binding.display());
}
