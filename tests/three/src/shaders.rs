//! The passes for three.js: a JavaScript module of texts for `RawShaderMaterial` and GLSL ES 3.0. Pages load it, so only
//! what a pass uses is kept, without comments and spaces. glslang preprocesses the shaders.

use std::fmt::Write as _;

use yoro_test_support::compiled::preprocessed;

/// Each constant of the module, and the file of `yoro-shaders` that it is made from.
const TEXTS: [(&str, &str); 7] = [
    ("screenVertex", "screen.vert"),
    ("marchVertex", "synthesis/march.vert"),
    ("guessedDepth", "synthesis/guessed_depth.frag"),
    ("tiles", "synthesis/gather/tiles.frag"),
    ("spans", "synthesis/gather/spans.frag"),
    ("march", "synthesis/gather/march.frag"),
    ("nearFraction", "stereo/near_fraction.frag"),
];
/// The precisions that these shaders need; three.js adds the version.
const PRECISIONS: &str =
    "precision highp float;precision highp int;precision highp sampler2D;precision highp usampler2D;";

/// Returns the text of the module.
///
/// # Errors
/// Fails without glslang.
pub fn module() -> anyhow::Result<String> {
    let mut module = format!(
        "// yoro {}, synthesis passes, written from its GLSL by `cargo xtask maintain renew`. Do not edit.\n\
         // SPDX-License-Identifier: MIT OR Apache-2.0\n\
         export const precisions = '{PRECISIONS}';\n",
        env!("CARGO_PKG_VERSION")
    );
    for (name, source) in TEXTS {
        // Objects that come later are hidden by depth.
        let text = yoro_shaders::assemble(source, "300 es", &[("WRITE_DEPTH", String::new())]).unwrap().text;
        let text = preprocessed(name, &text)?;
        let is_code =
            |line: &&str| !line.is_empty() && !line.starts_with(['#']) && !line.starts_with("precision ");
        let lines = without_parts(text.lines().map(str::trim).filter(is_code));
        writeln!(module, "export const {name} = /* glsl */`${{precisions}}\n{}`;", used(&lines))?;
    }
    Ok(module)
}

/// Leaves out what is for sources that are parts of their textures.
fn without_parts<'a>(lines: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let mut depth = 0;
    lines
        .filter(|line| {
            let is_inside = depth > 0 || line.starts_with("if(PART)");
            depth += if is_inside { braces(line) } else { 0 };
            !is_inside
        })
        .collect()
}

/// Returns the declarations that `main` needs, one a line.
fn used(lines: &[&str]) -> String {
    let mut declarations: Vec<String> = Vec::new();
    let mut depth = 0;
    for line in lines {
        match declarations.last_mut() {
            // Words of two lines stay apart.
            Some(last) if depth > 0 || !last.ends_with([';', '}']) => *last = format!("{last} {line}"),
            _ => declarations.push((*line).to_owned()),
        }
        depth += braces(line);
    }
    let mut needed = vec![false; declarations.len()];
    let mut wanted = vec!["main"];
    while let Some(name) = wanted.pop() {
        for (declaration, needed) in declarations.iter().zip(&mut needed) {
            if !*needed && declares(declaration, name) {
                *needed = true;
                wanted.extend(words(declaration));
            }
        }
    }
    let kept = declarations.iter().zip(needed).filter(|(_, needed)| *needed);
    kept.map(|(declaration, _)| dense(declaration)).collect::<Vec<_>>().join("\n")
}

/// True if a declaration is that of a name: of a function, or of the last word before the value or the end.
fn declares(declaration: &str, name: &str) -> bool {
    let declaration = declaration
        .split_once("layout(")
        .map_or(declaration, |(_, rest)| rest.split_once(')').map_or(rest, |(_, rest)| rest));
    let head = declaration.split(['=', '{', ';', '(', '[']).next().unwrap_or_default();
    words(head).next_back() == Some(name)
}

fn words(text: &str) -> impl DoubleEndedIterator<Item = &str> {
    text.split(|c: char| !is_word(c)).filter(|word| !word.is_empty())
}

/// Returns a text without spaces that separate nothing.
fn dense(text: &str) -> String {
    let mut out = String::new();
    let mut characters = text.chars().peekable();
    while let Some(c) = characters.next() {
        let before = out.chars().next_back().unwrap_or(' ');
        let after = *characters.peek().unwrap_or(&' ');
        let is_sign = |c| c == '+' || c == '-';
        let separates = is_word(before) && is_word(after) || is_sign(before) && is_sign(after);
        if c != ' ' || separates {
            out.push(c);
        }
    }
    out
}

fn is_word(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_'
}

fn braces(line: &str) -> i32 {
    line.chars().map(|c| i32::from(c == '{') - i32::from(c == '}')).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_module_is_made_of_the_present_shaders() {
        if yoro_test_support::compiled::glslang(&[]).is_none() {
            return println!("LEFT OUT: the shaders of three.js: no glslang is here");
        }
        let made = module().unwrap();
        let file = crate::package().join("src/shaders.js");
        if std::env::var_os("YORO_BLESS_SHADERS").is_some() {
            std::fs::write(&file, &made).unwrap();
        }
        let kept = std::fs::read_to_string(&file).unwrap_or_default();
        assert!(kept == made, "{} is not of these shaders: cargo xtask maintain renew", file.display());
    }
}
