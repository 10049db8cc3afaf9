//! What view synthesis finds hard, each case in a bay of its own along one court.
//!
//! The viewpoints are a walk along +X past the bays, with one viewpoint for each of [`CASES`], from which a bay is seen
//! towards -Z. Inside a bay, positions are in metres from the point on the floor below the eyes. Of the paper's scenes it
//! replaces none. The renderer has neither mirrors nor images that are attached to the head: a polished surface reflects
//! sky and lamps, and the panel hangs still before its viewpoint.

use std::f32::consts::{PI, TAU};

use glam::{Affine3A, EulerRot, Quat, UVec2, Vec2, Vec3, vec2, vec3, vec4};
use rand::Rng;
use rand_pcg::Pcg32;

use super::build::{Railing, SceneBuilder, around, hanging, moved, random};
use super::figure::{Hand, hand};
use super::motion::{Movers, about};
use super::paint::{self, Canvas};
use super::props::{
    self, Tree, foliage, glass, glowing, leaf_card, metal, palette, pictured, plain, textured, tree,
};
use yoro_assets::{Alpha, PointLight, Scene, Sky, TextureImage, Viewpoint};

/// A case: what is looked at from one viewpoint of the scene.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// The name in tables.
    pub name: &'static str,
    /// The point to which the head is turned; as [`Case::center`], in the bay's frame.
    look: [f32; 3],
    /// The point in the middle of the part of the image that shows the case.
    center: [f32; 3],
    /// What one sees in an eye that is synthesized with filled holes.
    pub seen: &'static str,
    build: fn(&mut Bay),
}

/// All cases, in the order of the scene's viewpoints.
pub const CASES: [Case; 12] = [
    Case {
        name: "held tool in a wall",
        look: [0.0, 1.55, -1.0],
        center: [-0.04, 1.57, -0.42],
        seen: "The strip beside the wall is smeared along rows; the handle ends there in a stump.",
        build: held_tool,
    },
    Case {
        name: "hand before the face",
        look: [0.0, 1.55, -1.0],
        center: [0.0, 1.6, -0.34],
        seen: "Beside the hand books become stripes, with a finger's outline in them.",
        build: hand_before_face,
    },
    Case {
        name: "glass",
        look: [0.0, 1.6, -1.0],
        center: [0.35, 1.85, -2.0],
        seen: "Right, but the hill's ridge steps behind a bar.",
        build: window,
    },
    Case {
        name: "polished surface",
        look: [0.0, 1.5, -1.0],
        center: [0.05, 1.42, -1.1],
        seen: "Reflections stay where the rendered eye sees them, ¼° off, with rendered holes, too.",
        build: polished,
    },
    Case {
        name: "wires and leaves",
        look: [0.0, 2.0, -1.0],
        center: [0.1, 2.5, -2.2],
        seen: "Gaps in wires and twigs; sky-coloured dots along branches, with rendered holes, too.",
        build: wires_and_leaves,
    },
    Case {
        name: "fence before a fence",
        look: [0.0, 1.45, -1.0],
        center: [0.0, 1.3, -1.1],
        seen: "Bars that only this eye sees are missing; one has become a block.",
        build: fences,
    },
    Case {
        name: "small text at an angle",
        look: [0.0, 1.3, -1.0],
        center: [0.0, 1.36, -0.6],
        seen: "As legible as rendered.",
        build: page,
    },
    Case {
        name: "chandelier",
        look: [0.0, 1.75, -1.0],
        center: [0.1, 1.95, -1.5],
        seen: "Stripes between the arms; the flames' glow stays where the rendered eye sees it, brighter with rendered holes.",
        build: chandelier,
    },
    Case {
        name: "smoke",
        look: [0.0, 1.5, -1.0],
        center: [-0.3, 1.5, -1.5],
        seen: "As rendered: transparent things are drawn in both eyes.",
        build: smoke,
    },
    Case {
        name: "floating panel",
        look: [0.0, 1.6, -1.0],
        center: [-0.03, 1.6, -0.55],
        seen: "Letters are right; echoes of them appear on the houses.",
        build: floating_panel,
    },
    Case {
        name: "flying past",
        look: [0.0, 1.6, -1.0],
        center: [0.0, 1.6, -0.75],
        seen: "Windows become a stripe along the wing (one moment of the flight).",
        build: flying_past,
    },
    Case {
        name: "edge of the image",
        look: [0.0, 1.6, -1.0],
        center: [-0.6, 1.6, -0.5],
        seen: "The outermost 5 %, nearer than the guard band covers, is smeared.",
        build: edge,
    },
];

/// The width of a bay in metres, from viewpoint to viewpoint.
const BAY: f32 = 3.0;
/// Height of the eyes in metres.
const EYES: f32 = 1.6;
/// Depth of a bay in metres: the place of its back wall.
const BACK: f32 = -4.0;

impl Case {
    /// Returns the point in the middle of the part of the image that shows a case, in metres in the scene.
    pub fn center(index: usize) -> Vec3 {
        Case::floor(index) + Vec3::from(CASES[index].center)
    }

    /// Returns the viewpoint of a case.
    pub fn viewpoint(index: usize) -> Viewpoint {
        let floor = Case::floor(index);
        Viewpoint { position: floor + Vec3::Y * EYES, target: floor + Vec3::from(CASES[index].look) }
    }

    fn floor(index: usize) -> Vec3 {
        Vec3::X * (BAY * index as f32)
    }
}

/// Adds a material that is cut out of a picture, for surfaces that are seen from both sides.
fn cut_out(b: &mut SceneBuilder, image: TextureImage, glow: f32) -> usize {
    let material = pictured(b, image, 0.8, glow);
    b.edit_material(material, |m| (m.alpha, m.double_sided) = (Alpha::Cutout(0.5), true));
    material
}

/// Paints a page of small print.
fn print(rng: &mut Pcg32) -> TextureImage {
    const WORDS: [&str; 12] = [
        "ONE",
        "EYE",
        "IS",
        "RENDERED",
        "THE",
        "OTHER",
        "SYNTHESIZED",
        "FROM",
        "ITS",
        "COLOUR",
        "AND",
        "DEPTH",
    ];
    let mut canvas = Canvas::new([1024, 1280], vec4(0.93, 0.92, 0.88, 1.0));
    let ink = vec4(0.08, 0.08, 0.1, 1.0);
    canvas.text(vec2(90.0, 80.0), 52.0, "HARD CASES", ink);
    for line in 0..38 {
        let mut text = String::new();
        while paint::text_width(20.0, &text) < 700.0 {
            text += WORDS[rng.random_range(0..WORDS.len())];
            text.push(' ');
        }
        canvas.text(vec2(90.0, 170.0 + 28.0 * line as f32), 20.0, &text, ink);
    }
    canvas.into_texture("print")
}

/// Paints a panel as programs fasten it to the head: text, a bar and a frame on nothing.
fn panel() -> TextureImage {
    let color = vec3(0.5, 0.95, 0.75);
    let [ink, nothing] = [1.0, 0.0].map(|alpha| color.extend(alpha));
    let mut canvas = Canvas::new([512, 320], nothing);
    for (corner, size) in [([6.0, 6.0], [500.0, 6.0]), ([6.0, 308.0], [500.0, 6.0])] {
        canvas.rect(corner.into(), Vec2::from(corner) + Vec2::from(size), ink);
    }
    for x in [6.0, 500.0] {
        canvas.rect(vec2(x, 6.0), vec2(x + 6.0, 314.0), ink);
    }
    canvas.text(vec2(40.0, 40.0), 46.0, "AMMO 24/90", ink);
    canvas.text(vec2(40.0, 120.0), 30.0, "NEXT GATE: 140 M", ink);
    canvas.text(vec2(40.0, 170.0), 30.0, "SHIELD", ink);
    canvas.rect(vec2(190.0, 172.0), vec2(440.0, 198.0), ink);
    canvas.text(vec2(40.0, 240.0), 19.0, "LEFT 1 - RIGHT 3 - HEAT 71", ink);
    canvas.into_texture("panel")
}

palette! {
    fn palette(b: &mut SceneBuilder, seed: u32, rng: &mut Pcg32) -> Palette {
        let puff = paint::picture("smoke", [256, 256], |uv| {
            let thick = paint::fbm(seed + 9, UVec2::splat(4), 5, uv) - 0.9 * (uv - 0.5).length();
            Vec3::splat(0.8).extend(paint::smoothstep(0.05, 0.45, thick))
        });
        let smoke = pictured(b, puff, 1.0, 0.0);
        b.edit_material(smoke, |m| (m.alpha, m.double_sided) = (Alpha::Blend(0.5), true));
        let letters = vec3(0.9, 0.95, 1.0);
        let mut etched = Canvas::new([384, 128], letters.extend(0.0));
        etched.text(vec2(10.0, 30.0), 64.0, "FRAGILE", letters.extend(1.0));
        let etching = pictured(b, etched.into_texture("etching"), 0.6, 0.0);
        b.edit_material(etching, |m| m.alpha = Alpha::Blend(0.75));
        let page = print(rng);
        let both_sides = plain(b, "paper", vec3(0.92, 0.9, 0.84), 0.8);
        b.edit_material(both_sides, |m| m.double_sided = true);
        let books = paint::book_spines("books", [1024, 256], seed + 11, 28);
        let facade = paint::facade("facade", 512, seed + 12, vec3(0.62, 0.55, 0.47), vec3(0.25, 0.33, 0.42), [6, 6], 0.1);
    }
    paving = textured(b, paint::stone_blocks("paving", 512, seed, vec3(0.55, 0.52, 0.48), [6, 6]), 2.4, 0.85),
    plaster = textured(b, paint::plaster("plaster", 512, seed + 1, vec3(0.8, 0.76, 0.68)), 2.0, 0.9),
    brick = textured(b, paint::bricks("brick", 512, seed + 2, vec3(0.55, 0.32, 0.25), vec3(0.7, 0.68, 0.62), [8, 16]), 2.0, 0.85),
    blocks = textured(b, paint::stone_blocks("blocks", 512, seed + 3, vec3(0.5, 0.48, 0.44), [4, 6]), 2.4, 0.85),
    damask = textured(b, paint::damask("damask", 512, seed + 4, vec3(0.34, 0.09, 0.1), vec3(0.6, 0.42, 0.2), 2), 0.6, 0.8),
    planks = textured(b, paint::planks("planks", 512, seed + 5, vec3(0.5, 0.36, 0.24), 8), 1.6, 0.6),
    grass = textured(b, paint::grass("grass", 512, seed + 6, vec3(0.3, 0.42, 0.16)), 3.0, 0.95),
    facade = textured(b, paint::Surface { color: facade.color, normal: facade.normal }, 16.0, 0.7),
    bark = textured(b, paint::bark("bark", 256, seed + 7, vec3(0.36, 0.27, 0.2)), 0.8, 0.9),
    leaves = foliage(b, "leaves", u64::from(seed) + 8, vec3(0.26, 0.44, 0.14)),
    skin = plain(b, "skin", vec3(0.82, 0.6, 0.48), 0.55),
    sleeve = plain(b, "sleeve", vec3(0.2, 0.26, 0.36), 0.9),
    steel = metal(b, "steel", vec3(0.75, 0.76, 0.78), 0.3),
    polished = metal(b, "polished", vec3(0.9, 0.9, 0.92), 0.05),
    brass = metal(b, "brass", vec3(0.85, 0.64, 0.3), 0.25),
    black = plain(b, "black", vec3(0.06, 0.06, 0.07), 0.5),
    white = plain(b, "white", vec3(0.86, 0.85, 0.82), 0.6),
    flame = glowing(b, "flame", vec3(1.0, 0.85, 0.6), 2.0),
    crystal = glass(b, "crystal", vec3(0.9, 0.93, 1.0), 0.35),
    pane = glass(b, "pane", vec3(0.6, 0.75, 0.78), 0.22),
    books = pictured(b, books, 0.8, 0.0),
    print = pictured(b, page, 0.8, 0.0),
    panel = cut_out(b, panel(), 0.9),
    paper = both_sides,
    smoke = smoke,
    etching = etching,
}

/// Builds the court: its floor, the walls between the bays, the walls at their backs, and the land behind those that have
/// none.
fn court(b: &mut SceneBuilder, p: &Palette, rng: &mut Pcg32) {
    let (left, right) = (-0.5 * BAY, BAY * (CASES.len() as f32 - 0.5));
    b.object("floor").with_material(p.paving);
    b.rectangle(vec3(left, 0.0, 1.8), Vec3::X * (right - left), Vec3::Z * (BACK - 1.8));
    b.object("wall behind").with_material(p.plaster);
    b.cuboid(vec3(left, 0.0, 1.8), vec3(right, 2.6, 2.0));
    for i in 0..=CASES.len() {
        let x = left + BAY * i as f32;
        b.object(&format!("wall {i}")).with_material(p.plaster);
        b.cuboid(vec3(x - 0.08, 0.0, BACK), vec3(x + 0.08, 2.6, -1.9));
    }
    b.object("land").with_material(p.grass);
    b.height_field(36, 24, vec2(-40.0, -110.0), vec2(75.0, BACK), |x, z| {
        let away = ((BACK - z - 8.0) / 90.0).clamp(0.0, 1.0);
        away * (9.0 + 5.0 * (x * 0.09).sin() + 3.0 * (x * 0.05 + z * 0.08).sin()) - 0.05
    });
    for i in 0..18 {
        let at = vec3(-24.0 + 4.6 * i as f32, -1.0, around(rng, -42.0, 14.0));
        let size = vec3(around(rng, 4.0, 1.0), around(rng, 9.0, 5.0), around(rng, 4.0, 1.0));
        b.object(&format!("house {i}")).with_material(p.facade).cuboid_on(at, size);
    }
}

/// What a case builds with, in its bay's frame.
struct Bay<'a> {
    b: &'a mut SceneBuilder,
    p: &'a Palette,
    rng: &'a mut Pcg32,
    /// The origin of the frame in the scene.
    floor: Vec3,
    movers: &'a mut Movers,
    lights: &'a mut Vec<PointLight>,
}

/// Builds the wall at the back of a bay.
fn back(b: &mut SceneBuilder, material: usize) {
    b.object("backs").with_material(material).cuboid(vec3(-1.5, 0.0, BACK - 0.1), vec3(1.5, 2.6, BACK));
}

/// Builds a low wall at the back of a bay, above which the land is seen.
fn parapet(b: &mut SceneBuilder, p: &Palette) {
    b.object("parapets").with_material(p.plaster).cuboid(vec3(-1.5, 0.0, BACK - 0.1), vec3(1.5, 0.35, BACK));
}

/// Builds a hand that holds a hammer, which goes through a thin wall 0.42 m away and comes out beside it.
fn held_tool(Bay { b, p, .. }: &mut Bay) {
    back(b, p.blocks);
    b.object("thin wall").with_material(p.brick).cuboid(vec3(-0.06, 0.0, -0.46), vec3(0.7, 2.4, -0.42));
    let (grip, head) = (vec3(0.12, 1.45, -0.31), vec3(-0.16, 1.66, -0.57));
    b.object("tool").with_material(p.planks).cylinder(grip, head, 0.011, 0.013, 14, true);
    b.with_material(p.steel);
    let across = (head - grip).cross(Vec3::Z).normalize() * 0.055;
    b.cylinder(head - across, head + across, 0.022, 0.022, 18, true);
    let wrist = vec3(0.141, 1.412, -0.324);
    b.object("holding hand").with_material(p.skin);
    let held = Hand {
        wrist,
        along: vec3(-0.45, 0.9, -0.1),
        palm: vec3(-0.8, -0.4, -0.2),
        curl: 1.0,
        thumb: 1.0,
        scale: 1.0,
    };
    hand(b, &held, 0.004);
    b.with_material(p.sleeve).cylinder(vec3(0.25, 1.1, -0.27), wrist, 0.05, 0.032, 20, true);
}

/// Builds an open hand a third of a metre before the eyes, in front of shelves.
fn hand_before_face(Bay { b, p, .. }: &mut Bay) {
    back(b, p.planks);
    b.object("open hand").with_material(p.skin);
    let wrist = vec3(0.02, 1.46, -0.34);
    let open =
        Hand { wrist, along: vec3(-0.1, 1.0, -0.1), palm: Vec3::Z, curl: 0.05, thumb: -1.0, scale: 1.0 };
    hand(b, &open, 0.004);
    b.with_material(p.sleeve).cylinder(vec3(0.12, 1.1, -0.3), wrist, 0.05, 0.034, 20, true);
    b.object("shelves");
    shelves(b, p, [-1.4, 1.4], -2.25);
}

/// Builds shelves between two places along X, whose books' backs are at `z`.
fn shelves(b: &mut SceneBuilder, p: &Palette, [left, right]: [f32; 2], z: f32) {
    for row in 0..8 {
        let y = 0.1 + 0.3 * row as f32;
        b.with_material(p.black).cuboid(vec3(left, y - 0.03, z - 0.1), vec3(right, y, z + 0.02));
        let corners =
            [vec3(left, y, z), vec3(right, y, z), vec3(right, y + 0.25, z), vec3(left, y + 0.25, z)];
        b.with_material(p.books).picture(corners);
    }
}

/// Builds a window with bars in front of the land.
fn window(Bay { b, p, .. }: &mut Bay) {
    parapet(b, p);
    b.object("window frame").with_material(p.black);
    for x in [-1.42, -0.5, 0.42, 1.38] {
        b.cuboid(vec3(x - 0.025, 0.6, -2.03), vec3(x + 0.025, 2.5, -1.98));
    }
    for y in [0.6, 1.7, 2.5] {
        b.cuboid(vec3(-1.42, y - 0.02, -2.02), vec3(1.42, y + 0.02, -1.99));
    }
    b.object("window pane").with_material(p.pane);
    b.rectangle(vec3(-1.42, 0.6, -2.0), Vec3::X * 2.84, Vec3::Y * 1.9);
    b.object("etching").with_material(p.etching).card(
        vec3(0.5, 1.95, -1.995),
        Vec3::X * 0.45,
        Vec3::Y * 0.15,
        Vec3::Z,
    );
}

/// Builds polished balls and a polished plate below two lamps.
fn polished(Bay { b, p, floor, lights, .. }: &mut Bay) {
    back(b, p.blocks);
    b.object("shelf").with_material(p.planks).cuboid(vec3(-0.8, 1.2, -1.35), vec3(0.8, 1.25, -0.9));
    b.object("balls").with_material(p.polished);
    for (x, z, radius) in [(0.05, -1.1, 0.17), (-0.32, -1.2, 0.12), (0.38, -1.15, 0.13)] {
        b.ellipsoid(vec3(x, 1.25 + radius, z), Vec3::splat(radius), 28, 44);
    }
    b.object("plate").with_material(p.polished);
    b.rectangle(vec3(-0.9, 1.3, -1.9), Vec3::X * 1.8, Vec3::Y * 0.9);
    let lamps = [vec3(-0.5, 2.15, -0.9), vec3(0.4, 2.2, -1.2)];
    b.object("lamps");
    for lamp in lamps {
        b.with_material(p.flame).ellipsoid(lamp, Vec3::splat(0.05), 12, 18);
        b.with_material(p.black).cylinder(lamp + Vec3::Y * 0.05, lamp.with_y(2.6), 0.006, 0.006, 6, false);
    }
    lights.extend(lamps.map(|at| lamp(*floor + at, 1.0)));
}

/// Builds a young tree below wires, against the sky.
fn wires_and_leaves(Bay { b, p, rng, .. }: &mut Bay) {
    parapet(b, p);
    b.object("young tree");
    let young = Tree {
        height: 3.1,
        trunk: 1.7,
        spread: 0.85,
        cards: 170,
        card_size: 0.1,
        bark: p.bark,
        leaves: p.leaves,
    };
    b.within(moved(-0.55, 0.0, -2.3), |b| tree(b, &young, rng));
    b.object("branch").with_material(p.bark);
    let branch: Vec<Vec3> = (0..=8)
        .map(|i| hanging(vec3(0.9, 3.0, -1.6), vec3(0.05, 2.35, -1.5), 0.12, i as f32 / 8.0))
        .collect();
    b.tapered_tube(&branch, &|t| 0.014 * (1.0 - 0.8 * t), 7, false);
    b.with_material(p.leaves);
    for i in 0..26 {
        leaf_card(b, branch[i % 9] + props::random_direction(rng) * 0.08, vec3(0.0, 0.6, 0.8), 0.07, rng);
    }
    b.object("wires").with_material(p.black);
    for x in [-1.38, 1.38] {
        b.cylinder(vec3(x, 0.0, -2.3), vec3(x, 3.1, -2.3), 0.03, 0.025, 12, true);
        b.cuboid(vec3(x - 0.02, 2.9, -2.7), vec3(x + 0.02, 2.95, -1.9));
    }
    for i in 0..5 {
        let z = -1.95 - 0.17 * i as f32;
        b.wire(vec3(-1.38, 2.95, z), vec3(1.38, 2.95, z), 0.3 + 0.04 * i as f32, 0.005, 24);
    }
}

/// Builds a fence of palings before one of bars.
fn fences(Bay { b, p, rng, .. }: &mut Bay) {
    parapet(b, p);
    b.object("palings").with_material(p.white);
    for i in 0..20 {
        let x = -1.35 + 0.14 * i as f32;
        let lean = Quat::from_rotation_z(around(rng, 0.0, 0.03));
        b.within(Affine3A::from_rotation_translation(lean, vec3(x, 0.0, -1.1)), |b| {
            b.cuboid(vec3(-0.035, 0.05, -0.01), vec3(0.035, around(rng, 1.5, 0.03), 0.01));
        });
    }
    for y in [0.5, 1.2] {
        b.cuboid(vec3(-1.4, y, -1.13), vec3(1.4, y + 0.06, -1.11));
    }
    b.object("bars").with_material(p.black);
    let rail = Railing { height: 1.7, bar_spacing: 0.12, bar_radius: 0.01, ..Railing::default() };
    b.railing(&[vec3(-1.4, 0.0, -2.2), vec3(1.4, 0.0, -2.0)], &rail);
}

/// Builds a page on a stand, turned away from the eyes.
fn page(Bay { b, p, .. }: &mut Bay) {
    back(b, p.planks);
    let turn = Quat::from_euler(EulerRot::YXZ, 0.75, -0.6, 0.0);
    b.within(Affine3A::from_rotation_translation(turn, vec3(0.0, 1.36, -0.6)), |b| {
        b.object("stand").with_material(p.planks).cuboid(vec3(-0.2, -0.25, -0.03), vec3(0.2, 0.24, -0.005));
        let corner = |x: f32, y: f32| vec3(0.16 * x, 0.2 * y, 0.0);
        b.object("page").with_material(p.print);
        b.picture([corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)]);
    });
    b.object("stand's post").with_material(p.steel).cylinder(
        vec3(0.0, 0.0, -0.7),
        vec3(0.0, 1.3, -0.65),
        0.02,
        0.02,
        12,
        false,
    );
}

/// Builds a chandelier with arms, candles, strings of crystals and a chain.
fn chandelier(Bay { b, p, floor, lights, .. }: &mut Bay) {
    back(b, p.damask);
    let center = vec3(0.0, 1.95, -1.5);
    lights.push(lamp(*floor + center, 1.6));
    b.object("chandelier");
    b.within(Affine3A::from_translation(center), |b| {
        b.with_material(p.brass);
        b.lathe(
            &[
                (0.0, -0.16),
                (0.03, -0.14),
                (0.05, -0.08),
                (0.02, 0.0),
                (0.035, 0.08),
                (0.012, 0.16),
                (0.0, 0.17),
            ],
            20,
        );
        b.cylinder(Vec3::Y * 0.16, Vec3::Y * 1.2, 0.006, 0.006, 8, false);
        for i in 0..9 {
            let turn = i as f32 / 9.0 * TAU + 0.2;
            let out = vec3(turn.cos(), 0.0, turn.sin());
            let next = vec3((turn + TAU / 9.0).cos(), 0.0, (turn + TAU / 9.0).sin());
            let tip = out * 0.36 + Vec3::Y * 0.03;
            let arm: Vec<Vec3> =
                (0..=12).map(|k| hanging(Vec3::Y * 0.02, tip, 0.1, k as f32 / 12.0)).collect();
            b.with_material(p.brass).tube(&arm, 0.006, 8, false);
            b.cylinder(tip, tip + Vec3::Y * 0.02, 0.012, 0.028, 14, true);
            b.with_material(p.white).cylinder(
                tip + Vec3::Y * 0.02,
                tip + Vec3::Y * 0.12,
                0.011,
                0.011,
                12,
                true,
            );
            b.with_material(p.flame).ellipsoid(tip + Vec3::Y * 0.14, vec3(0.008, 0.02, 0.008), 8, 10);
            b.with_material(p.crystal);
            for k in 1..9 {
                let bead = hanging(tip, next * 0.36 + Vec3::Y * 0.03, 0.12, k as f32 / 9.0);
                b.ellipsoid(bead, vec3(0.008, 0.012, 0.008), 5, 7);
            }
        }
    });
}

/// Builds a brazier with sheets of smoke above it.
fn smoke(Bay { b, p, rng, .. }: &mut Bay) {
    back(b, p.brick);
    b.object("brazier").with_material(p.black);
    b.within(moved(0.05, 0.0, -1.5), |b| {
        b.lathe(&[(0.2, 0.0), (0.03, 0.06), (0.03, 0.7), (0.18, 0.85), (0.2, 0.92)], 24);
    });
    b.with_material(p.flame).ellipsoid(vec3(0.05, 0.86, -1.5), vec3(0.17, 0.05, 0.17), 8, 20);
    for i in 0..9 {
        // The sheets are drawn from the farthest to the nearest.
        let at = vec3(around(rng, 0.05, 0.15), 1.15 + 0.1 * i as f32, -1.9 + 0.1 * i as f32);
        let turn = Quat::from_rotation_z(around(rng, 0.0, PI));
        let size = 0.32 + 0.02 * i as f32;
        b.object(&format!("smoke {i}")).with_material(p.smoke);
        b.card(at, turn * Vec3::X * size, turn * Vec3::Y * size, Vec3::Z);
    }
}

/// Builds a panel half a metre before the eyes.
fn floating_panel(Bay { b, p, .. }: &mut Bay) {
    parapet(b, p);
    b.object("panel").with_material(p.panel).card(
        vec3(0.0, EYES, -0.55),
        Vec3::X * 0.2,
        Vec3::Y * 0.125,
        Vec3::Z,
    );
}

/// Builds a paper plane that circles in the bay.
fn flying_past(Bay { b, p, floor, movers, .. }: &mut Bay) {
    parapet(b, p);
    b.object("paper plane").with_material(p.paper);
    b.within(Affine3A::from_rotation_translation(about(Vec3::X, 0.25), vec3(0.0, EYES, -0.75)), |b| {
        let [nose, keel] = [vec3(-0.16, 0.0, 0.0), vec3(0.14, -0.04, 0.0)];
        for side in [-1.0, 1.0] {
            let [inner, outer] = [vec3(0.14, 0.0, side * 0.012), vec3(0.14, 0.02, side * 0.1)];
            b.fan(&[nose, inner, outer], (inner - nose).cross(outer - nose).normalize());
            b.fan(&[nose, keel, inner], (keel - nose).cross(inner - nose).normalize());
        }
    });
    let circling = movers.turn(None, *floor + vec3(0.0, EYES, -1.5), 3.0, |t| about(Vec3::Y, TAU * t));
    movers.carry(circling, &["paper plane"]);
}

/// Builds shelves at the left edge of the view, nearer than the guard band covers.
fn edge(Bay { b, p, .. }: &mut Bay) {
    back(b, p.planks);
    b.object("near shelves");
    shelves(b, p, [-1.3, -0.17], -0.5);
}

/// Generates the scene; see [`super::BUILTINS`].
pub fn build(seed: u64, mut b: SceneBuilder) -> Scene {
    let rng = &mut random(seed, "hard-cases");
    let noise = rng.random::<u32>() >> 8;
    let p = &palette(&mut b, noise, rng);
    let mut movers = Movers::default();
    let mut lights = Vec::new();
    court(&mut b, p, rng);
    for (index, case) in CASES.iter().enumerate() {
        let floor = Case::floor(index);
        b.within(Affine3A::from_translation(floor), |b| {
            (case.build)(&mut Bay { b, p, rng, floor, movers: &mut movers, lights: &mut lights });
        });
    }
    let mut model = b.finish();
    Scene {
        motion: movers.finish(&mut model),
        model,
        sky: Sky { sun_direction: vec3(0.35, 0.75, 0.55).normalize(), ..Sky::default() },
        lights,
        viewpoints: (0..CASES.len()).map(Case::viewpoint).collect(),
        ..Scene::default()
    }
}

fn lamp(position: Vec3, strength: f32) -> PointLight {
    PointLight { position, color: vec3(1.2, 1.0, 0.75) * strength, range: 3.0 }
}
