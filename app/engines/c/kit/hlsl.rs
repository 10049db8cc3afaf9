//! The kit's shaders in HLSL, made from their GLSL by rules that cover what the synthesis uses. Names and comments stay, as
//! do the settings, which the compiler of HLSL gets as macros. A compiler tells if a rule is missing.

use std::fmt::Write as _;
use std::sync::LazyLock;

use regex::{Captures, Regex};

/// The macros that stay in the text, and what they set. All others are resolved here: UNIFORM_BLOCK is set, and no other.
const SETTINGS: [(&str, &str); 6] = [
    ("WRITE_DEPTH", "writes the target's depth, too, for transparent objects"),
    ("MOTION", "makes motion vectors in place of colour; the block is YoroKitMotionUniforms"),
    ("SOURCE_MAP", "writes where each pixel comes from to a second target, R32_UINT"),
    ("OPEN_HOLES", "discards the pixels that the source does not show, instead of filling them"),
    ("REVERSED", "larger depth is nearer"),
    ("SOURCE_PARTS", "takes a rectangle of larger textures (yoro_kit_source_part)"),
];

/// The stages' own inputs and outputs, with semantics in place of numbers.
const VERTEX: &str = "layout(location = SV_VertexID) in uint gl_VertexID;
layout(location = SV_Position) out vec4 gl_Position;
";
const PIXEL: &str = "layout(location = SV_Position) in vec4 gl_FragCoord;\n";
const DEPTH: &str = "layout(location = SV_Depth) out float gl_FragDepth;\n";

/// What HLSL has no words for. Each paragraph is added to the files that call its function.
const FUNCTIONS: &str = include_str!("functions.hlsl");

/// Patterns of whole declarations, in this order, and their replacements.
const DECLARATIONS: [(&str, &str); 11] = [
    (
        r"(?m)^(#version|#line|precision|#define (TEXTURE|BLOCK|VARYING|UNIFORM|UNIFORM_BLOCK|TEXEL_PLACE|TEXTURE_PLACE)\b).*\n",
        "",
    ),
    (r"\bhighp |layout\(constant_id = 0\) ", ""),
    (r"TEXTURE\((\d)\) uniform usampler2D (\w+);", "Texture2D<uint4> $2 : register(t$1);"),
    (
        r"TEXTURE\((\d)\) uniform sampler2D (\w+);",
        "Texture2D<float4> $2 : register(t$1);\nSamplerState ${2}_sampler : register(s$1);",
    ),
    (r"TEXTURE\((\d)\) uniform sampler2DMS (\w+);", "Texture2DMS<float4> $2 : register(t$1);"),
    (r"texelFetch\((sample_\w+), (\w+, \w+)\)", "$1.Load($2)"),
    (r"UNIFORM_BLOCK uniform (\w+) \{", "cbuffer $1 : register(b0) {"),
    (r"(?m)^const ", "static const "),
    (r"= \w+\[\d\]\((.*)\);", "= {$1};"),
    // fxc refuses an output that some way through the function leaves unwritten, even if nobody reads it then.
    (r"\bout (\w+) (\w+)\) \{\n", "out $1 $2) {\n    $2 = ($1)0;\n"),
    (r"\bvoid main\(\) \{", "void shade() {"),
];

/// Functions and their calls in HLSL, with arguments by number.
const CALLS: [(&str, &str); 9] = [
    ("TEXEL_PLACE", "$0"),
    ("TEXTURE_PLACE", "$0"),
    ("texelFetch", "$0.Load(int3($1, $2))"),
    ("textureLod", "$0.SampleLevel($0_sampler, $1, $2)"),
    ("textureGather", "$0.Gather($0_sampler, $1)"),
    ("lessThan", "($0 < $1)"),
    ("lessThanEqual", "($0 <= $1)"),
    ("greaterThan", "($0 > $1)"),
    ("texture", "load_at($0, $1)"),
];

/// Other words and their replacements. HLSL has keywords of its own.
const WORDS: [(&str, &str); 9] = [
    ("fract", "frac"),
    ("roundEven", "round"),
    ("uintBitsToFloat", "asfloat"),
    ("floatBitsToUint", "asuint"),
    ("bitfieldReverse", "reversed"),
    ("findLSB", "firstbitlow"),
    ("textureSamples", "samples_of"),
    ("vector", "motion_vector"),
    ("line", "epipolar_line"),
];

/// Name, GLSL type and offset in bytes of each member of the block.
pub type Layout = &'static [(&'static str, &'static str, usize)];

/// Returns a shader for Direct3D. `glsl` is its text for GLSL 310 es with all includes, and with UNIFORM_BLOCK defined;
/// `title` is the first line, and `block` the structure of yoro_kit.h with this layout.
pub fn from_glsl(glsl: &str, is_vertex: bool, title: &str, (block, layout): (&str, Layout)) -> String {
    let text = with_declarations(&resolve(glsl), layout);
    let own = match (is_vertex, text.contains("gl_FragDepth"), text.contains("#ifdef WRITE_DEPTH")) {
        (true, ..) => VERTEX.to_owned(),
        (_, false, _) => PIXEL.to_owned(),
        (_, true, false) => format!("{PIXEL}{DEPTH}"),
        (_, true, true) => format!("{PIXEL}#ifdef WRITE_DEPTH\n{DEPTH}#endif\n"),
    };
    let text = with_calls(with_constructors(with_entry_point(&(own + &text), is_vertex)));
    let is_called = |function: &&str| {
        let name = function.split('(').next().and_then(|before| before.rsplit(' ').next());
        name.is_some_and(|name| calls(&text, name).next().is_some())
    };
    let added: String = FUNCTIONS.split_inclusive("\n\n").filter(is_called).collect();
    let head = head(&text, is_vertex, title, block);
    replace(&format!("{head}{added}\n{}", text.trim_start()), r"\n{3,}", "\n\n")
}

/// Rewrites declarations. Each member of the block stands where the layout has it.
fn with_declarations(text: &str, layout: Layout) -> String {
    static RULES: LazyLock<Vec<(Regex, &str)>> =
        LazyLock::new(|| DECLARATIONS.iter().map(|&(pattern, to)| (regex(pattern), to)).collect());
    let text =
        RULES.iter().fold(text.to_owned(), |text, (from, to)| from.replace_all(&text, *to).into_owned());
    let text = rewrite(&text, r"(?m)^UNIFORM (\w+ (\w+));", |found| {
        let (.., offset) =
            layout.iter().find(|(name, ..)| *name == &found[2]).expect("a member of the block");
        format!("{} : packoffset(c{}.{});", &found[1], offset / 16, &"xyzw"[offset % 16 / 4..][..1])
    });
    rewrite(&text, r"(?s)(cbuffer .*?)\n\};", |found| found[1].replace('\n', "\n    ") + "\n};")
}

/// Rewrites calls, types and words.
fn with_calls(mut text: String) -> String {
    for (name, call) in CALLS {
        text = rewrite_calls(text, name, |arguments| {
            let put = |call: String, (i, value): (usize, &&str)| call.replace(&format!("${i}"), value);
            arguments.iter().enumerate().fold(call.to_owned(), put)
        });
    }
    for (short, word) in [("", "float"), ("i", "int"), ("u", "uint"), ("b", "bool")] {
        for n in 2..=4 {
            let (glsl, hlsl) = (format!("{short}vec{n}"), format!("{word}{n}"));
            // With one argument it is a conversion, or repeats a number.
            text = rewrite_calls(text, &glsl, |arguments| match arguments {
                [one] => format!("({hlsl})({one})"),
                _ => format!("{hlsl}({})", arguments.join(", ")),
            });
            text = replace_word(&text, &glsl, &hlsl);
        }
    }
    text = replace(&text, r"(\w+) != (\(\w+\)\(0\))", "any($1 != $2)");
    let lines = text.split_inclusive('\n').map(|line| {
        let (code, comment) = line.split_at(line.find("//").unwrap_or(line.len()));
        WORDS.iter().fold(code.to_owned(), |code, (glsl, hlsl)| replace_word(&code, glsl, hlsl)) + comment
    });
    lines.collect()
}

/// Returns where a word begins in a text.
fn places<'a>(text: &'a str, word: &'a str) -> impl Iterator<Item = usize> + 'a {
    let is_part = |c: Option<char>| c.is_some_and(|c| c.is_ascii_alphanumeric() || c == '_');
    text.match_indices(word).map(|(at, _)| at).filter(move |at| {
        let (before, after) = (&text[..*at], &text[at + word.len()..]);
        !is_part(before.chars().next_back()) && !is_part(after.chars().next())
    })
}

/// Returns where calls of a function begin.
fn calls<'a>(text: &'a str, name: &'a str) -> impl Iterator<Item = usize> + 'a {
    places(text, name).filter(|at| text[at + name.len()..].starts_with('('))
}

fn replace_word(text: &str, word: &str, replacement: &str) -> String {
    let (mut replaced, mut from) = (String::new(), 0);
    for at in places(text, word) {
        replaced.extend([&text[from..at], replacement]);
        from = at + word.len();
    }
    replaced + &text[from..]
}

/// Compiles a pattern whose classes are those of ASCII, which are far smaller.
fn regex(pattern: &str) -> Regex {
    let classes = [(r"\w", "[A-Za-z0-9_]"), (r"\d", "[0-9]"), (r"\s", "[ \n]"), (r"\b", r"(?-u:\b)")];
    let pattern = classes.iter().fold(pattern.to_owned(), |pattern, (from, to)| pattern.replace(from, to));
    Regex::new(&pattern).expect("a pattern")
}

fn replace(text: &str, pattern: &str, replacement: &str) -> String {
    regex(pattern).replace_all(text, replacement).into_owned()
}

fn rewrite(text: &str, pattern: &str, replacement: impl Fn(&Captures) -> String) -> String {
    regex(pattern).replace_all(text, |found: &Captures| replacement(found)).into_owned()
}

/// A condition of the preprocessor. If it stays in the text, both of its branches do.
#[derive(Clone, Copy)]
struct Condition {
    stays: bool,
    holds: bool,
}

/// Resolves the conditions that contain no setting.
fn resolve(text: &str) -> String {
    let (mut conditions, mut resolved): (Vec<Condition>, String) = Default::default();
    let hold = |conditions: &[Condition]| conditions.iter().all(|condition| condition.holds);
    for line in text.lines() {
        let (word, rest) = line.split_once(' ').unwrap_or((line, ""));
        let mut belongs = hold(&conditions);
        match word {
            "#ifdef" | "#ifndef" | "#if" => {
                let stays = SETTINGS.iter().any(|(setting, _)| rest.contains(setting));
                let is_true = word != "#if" && (word == "#ifdef") == (rest == "UNIFORM_BLOCK");
                conditions.push(Condition { stays, holds: stays || is_true });
                belongs &= stays;
            }
            "#else" | "#endif" => {
                let Condition { stays, holds } = conditions.pop().expect("it ends a condition");
                belongs = stays && hold(&conditions);
                if word == "#else" {
                    conditions.push(Condition { stays, holds: stays || !holds });
                }
            }
            _ => {}
        }
        if belongs {
            resolved.extend([line, "\n"]);
        }
    }
    resolved
}

/// Makes variables of a stage's inputs and outputs, and adds the function that the stage begins with, which copies them.
fn with_entry_point(text: &str, is_vertex: bool) -> String {
    const FIELD: &str = r"(?m)(^#if.*\n)?^(?:layout\(location = |VARYING\()(\w+)\) (in|out) (\w+) (\w+);";
    let (mut arguments, mut members, mut before, mut after) =
        (Vec::new(), String::new(), String::new(), String::new());
    for found in regex(FIELD).captures_iter(text) {
        let [place, direction, kind, name] = [2, 3, 4, 5].map(|i| &found[i]);
        let semantic = match (place.parse::<u32>(), is_vertex || direction == "in") {
            (Err(_), _) => place.to_owned(),
            (Ok(number), true) => format!("TEXCOORD{number}"),
            (Ok(number), false) => format!("SV_Target{number}"),
        };
        let own = |line: String| match found.get(1) {
            Some(condition) => format!("{}    {line}\n#endif\n", condition.as_str()),
            None => format!("    {line}\n"),
        };
        if direction == "in" {
            arguments.push(format!("{kind} in_{name} : {semantic}"));
            before += &own(format!("{name} = in_{name};"));
        } else {
            // The y of Direct3D's clip space is up, and its row 0 is the topmost.
            let flipped = name == "gl_Position";
            let value = if flipped { "vec4(gl_Position.x, -gl_Position.y, gl_Position.zw)" } else { name };
            members += &own(format!("{kind} {name} : {semantic};"));
            after += &own(format!("shaded.{name} = {value};"));
        }
    }
    format!(
        "{}\nstruct Shaded {{\n{members}}};\n\nShaded main({}) {{\n{before}    shade();\n    Shaded shaded;\n{after}    return shaded;\n}}\n",
        replace(text, FIELD, "${1}static $4 $5;"),
        arguments.join(", ")
    )
}

/// Adds a function that makes a structure of its members, for each that the text makes so.
fn with_constructors(mut text: String) -> String {
    let member = regex(r"(?m)^\s+(\w+) (\w+);");
    let structures = regex(r"(?s)\nstruct (\w+) \{\n(.*?)\n\};\n");
    let found: Vec<_> =
        structures.captures_iter(&text).map(|found| [0, 1, 2].map(|i| found[i].to_owned())).collect();
    for [whole, name, members] in found {
        if calls(&text, &name).next().is_none() {
            continue;
        }
        text = rewrite_calls(text, &name, |arguments| format!("make_{name}({})", arguments.join(", ")));
        let members: Vec<_> =
            member.captures_iter(&members).map(|found| [1, 2].map(|i| found[i].to_owned())).collect();
        let arguments: Vec<_> = members.iter().map(|member| member.join(" ")).collect();
        let copies: String = members.iter().map(|[_, name]| format!("    made.{name} = {name};\n")).collect();
        let function = format!(
            "\n{name} make_{name}({}) {{\n    {name} made;\n{copies}    return made;\n}}\n",
            arguments.join(", ")
        );
        text = text.replace(&whole, &format!("{whole}{function}"));
    }
    text
}

/// Rewrites all calls of a function, the innermost first.
fn rewrite_calls(mut text: String, name: &str, call: impl Fn(&[&str]) -> String) -> String {
    let starts: Vec<_> = calls(&text, name).collect();
    for start in starts.into_iter().rev() {
        let first = start + name.len() + 1;
        let (mut depth, mut from, mut arguments) = (0, first, Vec::new());
        for (i, c) in text[first..].char_indices().map(|(i, c)| (first + i, c)) {
            match c {
                '(' => depth += 1,
                ')' if depth > 0 => depth -= 1,
                ',' | ')' if depth == 0 => {
                    arguments.push(text[from..i].trim());
                    from = i + 1;
                    if c == ')' {
                        break;
                    }
                }
                _ => {}
            }
        }
        let made = call(&arguments);
        text.replace_range(start..from, &made);
    }
    text
}

/// Returns the comment at a file's beginning: what its caller binds and may set.
fn head(text: &str, is_vertex: bool, title: &str, block: &str) -> String {
    let stage = if is_vertex { "Vertex" } else { "Pixel" };
    let mut head = format!("{title}\n//\n// {stage} shader, Shader Model 5.0 or newer. Entry point: main.\n");
    for found in regex(r"(?m)^(\w+)(?:<.*>)? (\w+) : register\((\w\d)\)").captures_iter(text) {
        let what = match (&found[1], found[2].contains("depth")) {
            ("cbuffer", _) => format!(", {block} of yoro_kit.h"),
            ("SamplerState", true) => ": point, clamp".to_owned(),
            ("SamplerState", false) => ": linear, clamp".to_owned(),
            _ => String::new(),
        };
        // Writing to a string cannot fail.
        let _ = writeln!(head, "// {} {}{what}", &found[3], &found[2]);
    }
    let uses_parts = text.contains(" PART ?") || text.contains("if (PART)");
    // Every file declares the block and PART.
    let functions = text.rsplit_once("packoffset").map_or(text, |(_, functions)| functions);
    for (name, about) in SETTINGS {
        if if name == "SOURCE_PARTS" { uses_parts } else { functions.contains(name) } {
            let _ = writeln!(head, "// #define {name} // {about}");
        }
    }
    head + "\n"
}
