//! The passes for three.js: a JavaScript module of texts for `RawShaderMaterial` and GLSL ES 3.0. Pages load it, so only
//! what a pass uses is kept, without comments and spaces, and with short names. glslang preprocesses the shaders.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

use yoro_test_support::compiled::preprocessed;

/// Each constant of the module, and the file of `yoro-shaders` that it is made from.
const TEXTS: [(&str, &str); 6] = [
    ("screenVertex", "screen.vert"),
    ("marchVertex", "synthesis/march.vert"),
    ("guessedDepth", "synthesis/guessed_depth.frag"),
    ("tiles", "synthesis/gather/tiles.frag"),
    ("spans", "synthesis/gather/spans.frag"),
    ("march", "synthesis/gather/march.frag"),
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
         // SPDX-License-Identifier: MIT OR Apache-2.0\n",
        env!("CARGO_PKG_VERSION")
    );
    let mut texts = Vec::new();
    for (name, source) in TEXTS {
        // Objects that come later are hidden by depth. Whoever fills holes leaves out what discards them.
        let defines = ["WRITE_DEPTH", "OPEN_HOLES"].map(|name| (name, String::new()));
        let text = yoro_shaders::assemble(source, "300 es", &defines).unwrap().text;
        let text = preprocessed(name, &text)?;
        let is_code =
            |line: &&str| !line.is_empty() && !line.starts_with(['#']) && !line.starts_with("precision ");
        let lines = without_parts(text.lines().map(str::trim).filter(is_code));
        let text = used(&lines);
        texts.push((name, text.lines().map(with_short_locals).collect::<Vec<_>>().join("\n")));
    }
    inline_constants(&mut texts);
    let names = short_names(texts.iter().map(|(_, text)| text.as_str()));
    let uniforms = take_uniforms(&mut texts);
    writeln!(module, "export const declarations = /* glsl */`{PRECISIONS}{uniforms}`;")?;
    for (name, text) in &texts {
        let text = with_short_numbers(&renamed(text, &names));
        writeln!(module, "export const {name} = /* glsl */`${{declarations}}{text}`;")?;
    }
    Ok(module)
}

/// Takes the uniforms out of the texts, joins the lines of these, and returns the declarations of all uniforms.
fn take_uniforms(texts: &mut [(&str, String)]) -> String {
    let mut uniforms: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for (_, text) in texts {
        let (declared, others): (Vec<_>, Vec<_>) =
            text.lines().partition(|line| line.starts_with("uniform "));
        for line in declared {
            let mut words = words(line).rev().map(str::to_owned);
            let (name, kind) = words.next().zip(words.next()).unwrap();
            uniforms.entry(kind).or_default().insert(name);
        }
        *text = others.concat();
    }
    let declare =
        |(kind, names)| format!("uniform {kind} {};", Vec::from_iter::<BTreeSet<String>>(names).join(","));
    uniforms.into_iter().map(declare).collect()
}

/// Leaves out what is for sources that are parts of their textures, or do not begin at their corners.
fn without_parts<'a>(lines: impl Iterator<Item = &'a str>) -> Vec<String> {
    let mut depth = 0;
    let whole = lines.filter(|line| {
        let is_inside = depth > 0 || line.starts_with("if(PART)");
        depth += if is_inside { braces(line) } else { 0 };
        !is_inside
    });
    whole
        .map(|line| dense(line).replace("float(source_origin.y)+", ""))
        .map(|line| {
            let choice = line.split_once("PART").filter(|(_, rest)| rest.trim_start().starts_with('?'));
            let whole = choice.and_then(|(before, rest)| Some([before, rest.split_once(':')?.1].concat()));
            whole.unwrap_or(line)
        })
        .collect()
}

/// Returns the declarations that `main` needs, one a line.
fn used(lines: &[String]) -> String {
    let mut declarations: Vec<String> = Vec::new();
    let mut depth = 0;
    for line in lines {
        match declarations.last_mut() {
            // Words of two lines stay apart.
            Some(last) if depth > 0 || !last.ends_with([';', '}']) => *last = format!("{last} {line}"),
            _ => declarations.push(line.clone()),
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

/// Writes constants of one number where they are used.
fn inline_constants(texts: &mut [(&str, String)]) {
    for (_, text) in texts {
        let is_constant = |line: &&str| {
            ["const float ", "const int ", "const uint "].iter().any(|start| line.starts_with(start))
        };
        let (constants, others): (Vec<_>, Vec<_>) = text.lines().partition(is_constant);
        let values = constants.iter().map(|line| {
            let (name, value) = line[6..]
                .split_once(' ')
                .and_then(|(_, rest)| rest.trim_end_matches(';').split_once('='))
                .unwrap();
            let value = if value.contains('/') { format!("({value})") } else { value.to_owned() };
            (name.to_owned(), value)
        });
        *text = renamed(&others.join("\n"), &values.collect());
    }
}

/// Returns the kinds and names of what a text declares.
fn declared_in(text: &str) -> impl Iterator<Item = (&str, &str)> {
    let phrases = text.split(|c: char| !is_word(c) && c != ' ');
    phrases.flat_map(|phrase| words(phrase).zip(words(phrase).skip(1))).filter(|(kind, name)| {
        let is_kind = kind.starts_with(char::is_uppercase)
            || ["void", "struct", "bool", "int", "uint", "float"].contains(kind)
            || kind.trim_start_matches(['i', 'u', 'b']).strip_prefix("vec").is_some_and(|n| n.len() == 1);
        is_kind && name.starts_with(char::is_alphabetic)
    })
}

/// Returns a declaration; in a function, parameters and variables are a, b, c, ... in their order.
fn with_short_locals(line: &str) -> String {
    let function = line.split_once('(').filter(|_| line.ends_with('}') && !line.starts_with("struct "));
    let Some((head, body)) = function else { return line.to_owned() };
    let mut locals = Vec::new();
    for (_, name) in declared_in(body) {
        if !locals.contains(&name) {
            locals.push(name);
        }
    }
    let others: BTreeSet<&str> = words(body).filter(|word| !locals.contains(word)).collect();
    let letters = ('a'..='z').map(String::from).chain(('a'..='z').map(|letter| format!("{letter}0")));
    let free = letters.filter(|letter| !others.contains(letter.as_str()));
    let names: BTreeMap<&str, String> = locals.iter().copied().zip(free).collect();
    let mut out = format!("{head}(");
    for part in body.split_inclusive(|c: char| !is_word(c)) {
        let word = part.trim_end_matches(|c: char| !is_word(c));
        // Fields keep their names.
        let name = names.get(word).filter(|_| !out.ends_with('.')).map_or(word, String::as_str);
        out += name;
        out += &part[word.len()..];
    }
    out
}

/// Returns a short name, with a capital letter, for each longer one that the texts declare and that no pass shares with
/// other shaders or with three.js: the most frequent one gets the shortest.
fn short_names<'a>(texts: impl Iterator<Item = &'a str> + Clone) -> BTreeMap<String, String> {
    let mut kept = BTreeSet::from(["main"]);
    let mut declared: BTreeMap<&str, usize> = BTreeMap::new();
    for line in texts.clone().flat_map(str::lines) {
        let is_shared = ["uniform ", "in ", "out ", "layout("].iter().any(|start| line.starts_with(start));
        if is_shared {
            kept.extend(words(line).next_back());
        }
        declared.extend(declared_in(line).filter(|(_, name)| name.len() > 2).map(|(_, name)| (name, 0)));
    }
    for word in texts.flat_map(words) {
        declared.entry(word).and_modify(|count| *count += 1);
    }
    let mut names: Vec<_> =
        declared.into_iter().filter(|(name, count)| *count > 0 && !kept.contains(name)).collect();
    names.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    let letters = || 'A'..='Z';
    let pairs = letters().flat_map(|first| ('a'..='z').map(move |second| format!("{first}{second}")));
    names.into_iter().map(|(name, _)| name.to_owned()).zip(letters().map(String::from).chain(pairs)).collect()
}

/// Returns a text with other names.
fn renamed(text: &str, names: &BTreeMap<String, String>) -> String {
    let parts = text.split_inclusive(|c: char| !is_word(c));
    parts
        .map(|part| {
            let word = part.trim_end_matches(|c: char| !is_word(c));
            let name = names.get(word).map_or(word, String::as_str);
            [name, &part[word.len()..]].concat()
        })
        .collect()
}

/// Returns a text with .5 for 0.5, and 1. for 1.0.
fn with_short_numbers(text: &str) -> String {
    let is_end = |c: char| !is_word(c) && c != '.';
    let parts = text.split_inclusive(is_end).map(|part| {
        let (word, end) = part.split_at(part.trim_end_matches(is_end).len());
        let whole = word.strip_suffix(".0").filter(|word| word.starts_with(|c: char| c.is_ascii_digit()));
        match (whole, word.strip_prefix("0.").filter(|digits| !digits.is_empty())) {
            (Some(whole), _) => format!("{whole}.{end}"),
            (None, Some(fraction)) => format!(".{fraction}{end}"),
            (None, None) => part.to_owned(),
        }
    });
    parts.collect()
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
