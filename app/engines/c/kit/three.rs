//! The passes for three.js: a JavaScript module of texts for `RawShaderMaterial` and GLSL ES 3.0. Pages load it, so
//! only what a pass uses is kept, without comments and spaces.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io;

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
/// The macros that are defined: browsers have OpenGL ES 3.0, and objects that come later are hidden by depth.
const DEFINED: [&str; 2] = ["WITHOUT_ES_310", "WRITE_DEPTH"];
/// The precisions that these shaders need; three.js adds the version.
const PRECISIONS: &str =
    "precision highp float;precision highp int;precision highp sampler2D;precision highp usampler2D;";

/// Macros by name: `None` as the parameter of those that have none.
type Macros = BTreeMap<String, (Option<String>, String)>;

/// Returns the text of the module.
pub fn module() -> io::Result<String> {
    let mut module = format!(
        "// yoro {}, synthesis passes, written from its GLSL by `cargo xtask maintain renew`. Do not edit.\n\
         // SPDX-License-Identifier: MIT OR Apache-2.0\n\
         export const precisions = '{PRECISIONS}';\n",
        env!("CARGO_PKG_VERSION")
    );
    for (name, source) in TEXTS {
        let assembled = yoro_shaders::assemble(source, "300 es", &[])
            .map_err(|missing| io::Error::other(format!("shader file {} does not exist", missing.0)))?;
        let text = used(&preprocessed(&assembled.text)?);
        // Writing to a string cannot fail.
        let _ = writeln!(module, "export const {name} = /* glsl */`${{precisions}}\n{text}`;");
    }
    Ok(module)
}

/// Returns the lines of a shader that are compiled, with macros replaced, without comments and indentation.
fn preprocessed(text: &str) -> io::Result<Vec<String>> {
    let mut macros: Macros = DEFINED.map(|name| (name.to_owned(), (None, String::new()))).into();
    // True for each open branch that is compiled.
    let mut branches: Vec<bool> = Vec::new();
    let mut lines = Vec::new();
    for line in text.lines() {
        let line = line.split("//").next().unwrap_or_default().trim();
        if let Some(condition) = line.strip_prefix("#if") {
            branches.push(holds(condition, &macros)?);
        } else if line == "#else" {
            branches.last_mut().into_iter().for_each(|branch| *branch = !*branch);
        } else if line == "#endif" {
            branches.pop();
        } else if branches.iter().all(|branch| *branch) {
            if let Some(definition) = line.strip_prefix("#define ") {
                define(definition, &mut macros);
            } else if !["#", "precision "].iter().any(|start| line.starts_with(start)) {
                let line = replaced(line, &macros);
                if !line.trim().is_empty() {
                    lines.push(line.trim().to_owned());
                }
            }
        }
    }
    Ok(without_parts(lines))
}

/// Adds a macro without parameters, or with one.
fn define(definition: &str, macros: &mut Macros) {
    let end = definition.find(|c: char| !is_word(c)).unwrap_or(definition.len());
    let (name, rest) = definition.split_at(end);
    let of_one = rest.strip_prefix('(').and_then(|rest| rest.split_once(')'));
    let (parameter, body) =
        of_one.map_or((None, rest), |(parameter, body)| (Some(parameter.to_owned()), body));
    macros.insert(name.to_owned(), (parameter, body.trim().to_owned()));
}

/// Returns a line with its macros replaced. An argument must end on the same line.
fn replaced(line: &str, macros: &Macros) -> String {
    let mut out = String::new();
    let mut rest = line;
    while let Some(start) = rest.find(is_word) {
        let end = rest[start..].find(|c: char| !is_word(c)).map_or(rest.len(), |length| start + length);
        let word = &rest[start..end];
        out.push_str(&rest[..start]);
        rest = &rest[end..];
        match macros.get(word) {
            None => out.push_str(word),
            Some((None, body)) => out.push_str(&replaced(body, macros)),
            Some((Some(parameter), body)) => {
                let argument = closed(rest);
                // A body names its parameter once, if at all.
                let given = body.replacen(parameter, &rest[1..argument - 1], 1);
                out.push_str(&replaced(&given, macros));
                rest = &rest[argument..];
            }
        }
    }
    out + rest
}

/// Returns the length of the parenthesis at the beginning of a text.
fn closed(text: &str) -> usize {
    let mut depth = 0;
    for (i, c) in text.char_indices() {
        depth += i32::from(c == '(') - i32::from(c == ')');
        if depth == 0 {
            return i + 1;
        }
    }
    text.len()
}

/// Leaves out what is for sources that are parts of their textures.
fn without_parts(lines: Vec<String>) -> Vec<String> {
    let mut depth = 0;
    lines
        .into_iter()
        .filter(|line| {
            let begins = depth == 0 && line == "if (PART) {";
            let is_inside = begins || depth > 0;
            if is_inside {
                depth += braces(line);
            }
            !is_inside
        })
        .collect()
}

/// Returns the declarations that `main` needs, one a line.
fn used(lines: &[String]) -> String {
    let mut declarations: Vec<String> = Vec::new();
    let mut depth = 0;
    for line in lines {
        match declarations.last_mut() {
            Some(last) if depth > 0 || !last.ends_with([';', '}']) => {
                // Words of two lines stay apart.
                last.push(' ');
                last.push_str(line);
            }
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

/// True if a declaration is that of a name: of a function, or of the last word before the value or the end.
fn declares(declaration: &str, name: &str) -> bool {
    let declaration = declaration.trim_start_matches("layout(location = 0)");
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

/// True if a condition holds, given what follows `#if`.
fn holds(condition: &str, macros: &Macros) -> io::Result<bool> {
    let condition = match condition.split_once(' ') {
        Some(("def", name)) => format!("defined({name})"),
        Some(("ndef", name)) => format!("!defined({name})"),
        _ => condition.trim().to_owned(),
    };
    let term = |term: &str| {
        let term = term.trim();
        let (is_negated, rest) = term.strip_prefix('!').map_or((false, term), |rest| (true, rest));
        let name = rest.strip_prefix("defined(").and_then(|rest| rest.strip_suffix(')'));
        match name {
            Some(name) => Ok(macros.contains_key(name) != is_negated),
            None if term == "__VERSION__ == 300" => Ok(true),
            None => Err(io::Error::other(format!("the condition {term} is not understood here"))),
        }
    };
    let mut any = false;
    for terms in condition.split("||") {
        let mut all = true;
        for each in terms.split("&&") {
            all &= term(each)?;
        }
        any |= all;
    }
    Ok(any)
}
