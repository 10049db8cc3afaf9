//! The texts in packages: files that build systems read, first pages, and what of a document concerns C.

use super::VERSION;

/// Returns the library's soname. A program runs with any version of the library that has the same soname. While the
/// first number is 0, these are the versions that differ only in the last number.
pub fn soname() -> String {
    format!("libyoro.so.{}", series())
}

fn series() -> String {
    let count = if VERSION.starts_with("0.") { 2 } else { 1 };
    VERSION.split('.').take(count).collect::<Vec<_>>().join(".")
}

/// Returns a template with this version and with a value for each name, which is written `@NAME@` there.
pub fn filled(template: &str, values: &[(&str, &str)]) -> String {
    let with_version = template.replace("@VERSION@", VERSION);
    values.iter().fold(with_version, |text, (name, value)| text.replace(&format!("@{name}@"), value))
}

/// Returns the first page of an archive for Linux from its template.
pub fn readme(template: &str, architecture: &str, (major, minor): (u32, u32)) -> String {
    filled(template, &[("ARCHITECTURE", architecture), ("GLIBC", &format!("{major}.{minor}"))])
}

/// Returns the file for pkg-config, which works wherever the package is unpacked.
pub fn pkg_config(needs: &[String]) -> String {
    filled(include_str!("templates/yoro.pc"), &[("NEEDS", &needs.join(" "))])
}

/// Returns the file for CMake, with the targets yoro::yoro and yoro::static.
pub fn cmake(needs: &[String]) -> String {
    let (soname, needs) = (soname(), needs.join(";"));
    filled(include_str!("templates/yoro-config.cmake"), &[("SONAME", &soname), ("NEEDS", &needs)])
}

/// Returns the CMake file that checks whether the package satisfies `find_package(yoro VERSION)`.
pub fn cmake_version() -> String {
    let series = series().replace('.', "\\\\.");
    filled(include_str!("templates/yoro-config-version.cmake"), &[("SERIES", &series)])
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
