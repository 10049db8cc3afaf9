//! MTL material libraries, statement by statement: keywords in upper or lower case, numbers checked. A value that
//! cannot be read is named in a warning, and the default takes its place.

use std::collections::HashMap;

use glam::{Vec2, Vec3};

use super::model::{Alpha, Material};

/// A picture that a material uses.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct MapStatement {
    /// The file name as written, without options.
    pub file: String,
    /// `-bm`: strength of bumps.
    pub bump: f32,
    /// `-s`, `-o`: texture coordinates are multiplied by `scale`, then moved by `offset`.
    pub scale: Vec2,
    pub offset: Vec2,
    /// `-imfchan`: `r`, `g`, `b`, `m`, `l` or `z`.
    pub channel: Option<char>,
}

/// A material of a library, with the pictures it uses.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct MtlEntry {
    pub material: Material,
    pub diffuse: Option<MapStatement>,
    pub specular: Option<MapStatement>,
    pub emissive: Option<MapStatement>,
    /// A height or normal map.
    pub bump: Option<MapStatement>,
    /// A map that is certainly a normal map.
    pub normal: Option<MapStatement>,
    pub alpha: Option<MapStatement>,
}

/// Reads the text of a library.
pub(super) fn parse(bytes: &[u8]) -> Vec<MtlEntry> {
    let mut materials: Vec<(String, HashMap<String, String>)> = Vec::new();
    for statement in statements(&String::from_utf8_lossy(bytes)) {
        let (keyword, rest) = statement.split_once(char::is_whitespace).unwrap_or((&statement, ""));
        let (keyword, rest) = (keyword.to_ascii_lowercase(), rest.trim().to_owned());
        if keyword == "newmtl" {
            materials.push((if rest.is_empty() { "unnamed".into() } else { rest }, HashMap::new()));
        } else if let Some((_, stated)) = materials.last_mut() {
            stated.insert(keyword, rest);
        }
    }
    materials.into_iter().map(|(name, stated)| entry(name, &stated)).collect()
}

/// Returns the lines without comments and surrounding blanks. A line that ends in a backslash is joined with the next.
fn statements(text: &str) -> Vec<String> {
    let mut all = Vec::new();
    let mut open = String::new();
    for line in text.trim_start_matches('\u{feff}').split(['\n', '\r']) {
        let line = without_comment(line).trim();
        match line.strip_suffix('\\') {
            // No statement is a folder name that ends in a backslash, so nothing is lost.
            Some(start) => {
                open.push_str(start);
                open.push(' ');
            }
            None => {
                open.push_str(line);
                if !open.trim().is_empty() {
                    all.push(open.trim().to_owned());
                }
                open.clear();
            }
        }
    }
    all
}

/// Cuts a line at the first `#` at the start or after a blank, since names may contain one.
pub(super) fn without_comment(line: &str) -> &str {
    let start = line
        .match_indices('#')
        .map(|(i, _)| i)
        .find(|&i| i == 0 || line.as_bytes()[i - 1].is_ascii_whitespace());
    start.map_or(line, |i| &line[..i])
}

/// Returns the beginning of a statement, for messages.
pub(super) fn abridged(statement: &str) -> String {
    let mut s: String = statement.chars().filter(|c| !c.is_control()).take(60).collect();
    if s.len() < statement.len() {
        s.push_str("...");
    }
    s
}

/// Returns the material of which a library states these values by their keywords.
fn entry(name: String, stated: &HashMap<String, String>) -> MtlEntry {
    let numbers = |keyword: &str| -> Vec<f32> {
        let value = stated.get(keyword).map_or("", |value| value.trim_start_matches("-halo"));
        let words = value.split_whitespace().map_while(|word| word.parse().ok());
        let numbers: Vec<f32> = words.filter(|n: &f32| n.is_finite()).collect();
        if numbers.is_empty() && !value.is_empty() {
            log::warn!("material {name}: {keyword} {:?} is no number, the default is used", abridged(value));
        }
        numbers
    };
    let number = |keyword: &str| numbers(keyword).first().copied();
    let color = |keyword: &str| match *numbers(keyword).as_slice() {
        [grey] => Some(Vec3::splat(grey).max(Vec3::ZERO)),
        [r, g, b, ..] => Some(Vec3::new(r, g, b).max(Vec3::ZERO)),
        _ => None,
    };
    let map = |keywords: &[&str]| keywords.iter().find_map(|keyword| map_statement(stated.get(*keyword)?));
    let entry = MtlEntry {
        diffuse: map(&["map_kd"]),
        specular: map(&["map_ks"]),
        emissive: map(&["map_ke"]),
        bump: map(&["map_bump", "bump"]),
        normal: map(&["norm", "map_norm", "map_kn"]),
        alpha: map(&["map_d"]),
        ..MtlEntry::default()
    };
    let default = Material::default();
    let mut kd = color("kd").unwrap_or(if entry.diffuse.is_some() { Vec3::ONE } else { default.diffuse });
    kd = kd.min(Vec3::ONE);
    // Exporters that leave Kd black beside a map mean the map's colour.
    if entry.diffuse.is_some() && kd == Vec3::ZERO {
        kd = Vec3::ONE;
    }
    let specular = color("ks");
    let mut ks = specular.unwrap_or(default.specular).min(Vec3::ONE);
    if specular.is_none() && number("illum").is_some_and(|model| model < 2.0) {
        ks = Vec3::ZERO;
    }
    let metallic = number("pm").unwrap_or(0.0).clamp(0.0, 1.0);
    if metallic > 0.0 && specular.is_none() {
        ks = ks.lerp(kd, metallic);
        kd *= 1.0 - metallic;
    }
    let mut ke = color("ke").unwrap_or(Vec3::ZERO);
    if entry.emissive.is_some() && ke == Vec3::ZERO {
        ke = Vec3::ONE;
    }
    let roughness = match (number("pr"), number("ns")) {
        (Some(pr), _) => pr.clamp(0.0, 1.0),
        (None, Some(ns)) => (2.0 / (ns.max(0.0) + 2.0)).sqrt(),
        (None, None) => default.roughness,
    };
    let opacity = number("d").or_else(|| number("tr").map(|t| 1.0 - t)).unwrap_or(1.0);
    // Opacity 0 is taken as opaque: nobody models the invisible, and some exporters swap the meaning of d and Tr.
    let alpha = if opacity > 0.0 && opacity < 1.0 { Alpha::Blend(opacity) } else { Alpha::Opaque };
    let own = Material { name, diffuse: kd, specular: ks, emissive: ke, roughness, alpha, ..obj_default() };
    MtlEntry { material: own, ..entry }
}

/// Returns the material of faces without one. It is double-sided, because OBJ does not say which side of a face is
/// visible, and many files mix windings or have walls without thickness.
pub(super) fn obj_default() -> Material {
    Material { double_sided: true, ..Material::default() }
}

/// Splits a map statement's value into options, before or after the name, and the name, which may contain blanks.
pub(super) fn map_statement(value: &str) -> Option<MapStatement> {
    let mut map =
        MapStatement { file: String::new(), bump: 1.0, scale: Vec2::ONE, offset: Vec2::ZERO, channel: None };
    let mut rest = value.trim();
    while let Some(after) = option(rest, &mut map) {
        rest = after;
    }
    // Options after the name count only if nothing follows them: ` -s` may be part of a name.
    for (i, _) in rest.match_indices(" -") {
        let mut with_tail = map.clone();
        let mut tail = rest[i..].trim_start();
        while let Some(after) = option(tail, &mut with_tail) {
            tail = after;
        }
        if tail.is_empty() {
            map = with_tail;
            rest = &rest[..i];
            break;
        }
    }
    map.file = rest.trim().trim_matches('"').trim().to_owned();
    (!map.file.is_empty()).then_some(map)
}

/// Reads one option with its arguments. Returns the text after it, or `None` if there is no option.
fn option<'a>(text: &'a str, map: &mut MapStatement) -> Option<&'a str> {
    let word = |s: &'a str| {
        let s = s.trim_start();
        let end = s.find(char::is_whitespace).unwrap_or(s.len());
        (&s[..end], &s[end..])
    };
    let number = |s: &'a str| {
        let (w, rest) = word(s);
        w.parse::<f32>().ok().filter(|n| n.is_finite()).map(|n| (n, rest))
    };
    let (name, mut rest) = word(text);
    match name.to_ascii_lowercase().as_str() {
        "-blendu" | "-blendv" | "-cc" | "-clamp" | "-type" | "-texres" | "-colorspace" => rest = word(rest).1,
        "-boost" => rest = number(rest)?.1,
        "-mm" => rest = number(number(rest)?.1)?.1,
        "-bm" => (map.bump, rest) = number(rest)?,
        "-imfchan" => {
            let (channel, after) = word(rest);
            (map.channel, rest) = (channel.chars().next(), after);
        }
        "-s" | "-o" | "-t" => {
            let mut values = Vec::new();
            while let Some((n, after)) = number(rest).filter(|_| values.len() < 3) {
                values.push(n);
                rest = after;
            }
            let pair = |fill: f32| {
                Vec2::new(values.first().copied().unwrap_or(fill), values.get(1).copied().unwrap_or(fill))
            };
            match name {
                "-s" => map.scale = pair(1.0),
                "-o" => map.offset = pair(0.0),
                _ => {}
            }
        }
        _ => return None,
    }
    Some(rest.trim_start())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn one(text: &str) -> MtlEntry {
        let mut all = parse(text.as_bytes());
        assert_eq!(all.len(), 1, "{all:?}");
        all.remove(0)
    }

    #[test]
    fn colours_and_roughness() {
        let e = one("newmtl a b\r\nKd 0.5 0.25 1\r\nKs .1 .1 .1\r\nKe 2 0 0\r\nNs 6\r\n");
        assert_eq!(e.material.name, "a b");
        assert_eq!(e.material.diffuse, Vec3::new(0.5, 0.25, 1.0));
        assert_eq!(e.material.emissive, Vec3::new(2.0, 0.0, 0.0));
        assert_eq!(e.material.roughness, 0.5);
        assert!(e.material.double_sided);
        assert_eq!(one("newmtl a\nNs 6\nPr 0.3").material.roughness, 0.3);
        assert_eq!(one("newmtl a\nNs -9").material.roughness, 1.0);
    }

    #[test]
    fn opacity_in_both_spellings() {
        assert_eq!(one("newmtl a\nd 0.4").material.alpha, Alpha::Blend(0.4));
        assert_eq!(one("newmtl a\nd -halo 0.4").material.alpha, Alpha::Blend(0.4));
        assert_eq!(one("newmtl a\nTr 0.25").material.alpha, Alpha::Blend(0.75));
        assert_eq!(one("newmtl a\nd 1\nTr 0.5").material.alpha, Alpha::Opaque);
        assert_eq!(one("newmtl a\nTr 1").material.alpha, Alpha::Opaque);
    }

    #[test]
    fn maps_in_any_spelling() {
        let e = one(
            "newmtl a\nmap_kd a.png\nMAP_KS s.png\nmap_Ke e.png\nmap_Bump -bm 0.3 b.png\nnorm n.png\nmap_d d.png # mask",
        );
        let file = |m: &Option<MapStatement>| m.as_ref().unwrap().file.clone();
        assert_eq!(
            [&e.diffuse, &e.specular, &e.emissive, &e.bump, &e.normal, &e.alpha].map(file),
            ["a.png", "s.png", "e.png", "b.png", "n.png", "d.png"]
        );
        assert_eq!(e.bump.unwrap().bump, 0.3);
        assert_eq!((e.material.diffuse, e.material.emissive), (Vec3::ONE, Vec3::ONE));
        assert_eq!(one("newmtl a\nKd 0 0 0\nmap_Kd a.png").material.diffuse, Vec3::ONE);
    }

    #[test]
    fn map_options_before_and_after_the_name() {
        let map = |s: &str| map_statement(s).unwrap();
        let m = map("-s 2 3 1 -o 0.5 0 0 -clamp on -blendu off -mm 0 1 my wall 2.png");
        assert_eq!(
            (m.file.as_str(), m.scale, m.offset),
            ("my wall 2.png", Vec2::new(2.0, 3.0), Vec2::new(0.5, 0.0))
        );
        let m = map(r"C:\tex\a -b.png -bm 0.2 -imfchan r");
        assert_eq!((m.file.as_str(), m.bump, m.channel), (r"C:\tex\a -b.png", 0.2, Some('r')));
        assert_eq!(map("\"quoted name.png\"").file, "quoted name.png");
        assert_eq!(map("-s 2 4tiles.png").file, "4tiles.png");
        assert_eq!(map("wood -s.png").file, "wood -s.png");
        assert_eq!(map_statement("-clamp on"), None);
    }

    proptest! {
        #[test]
        fn any_statements_do(words in proptest::collection::vec(
            prop_oneof!["newmtl|Kd|Ks|Ke|Ns|d|Tr|illum|map_Kd|bump|-bm|-s|-o|-clamp|norm|Pr|Pm", "[0-9.e+-]{0,6}", "nan|inf|\\\\|#|a b", Just("\n".to_owned())], 0..60)) {
            for e in parse(words.join(" ").as_bytes()) {
                let m = e.material;
                prop_assert!(m.diffuse.is_finite() && m.specular.is_finite() && m.emissive.is_finite() && (0.0..=1.0).contains(&m.roughness));
            }
        }
    }
}
