//! One colour and one mark for each method, the same in all plots of all pages.
//!
//! The colours follow Okabe and Ito's palette, which suits all kinds of colour vision, darkened or lightened for
//! contrast with the page. Marks distinguish what colours do not.

/// The outline of a mark.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// A disc.
    Circle,
    /// A square.
    Square,
    /// A square on its corner.
    Diamond,
    /// A triangle that points upwards.
    Up,
    /// A triangle that points downwards.
    Down,
    /// A diagonal cross.
    Cross,
}

/// The colour and mark of a method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Look {
    /// The colour on a light page and in files.
    pub light: u32,
    /// The colour on a dark page.
    pub dark: u32,
    /// The shape of the mark.
    pub shape: Shape,
    /// True if only the outline of the mark is drawn.
    pub hollow: bool,
}

const fn look(light: u32, dark: u32, shape: Shape) -> Look {
    Look { light, dark, shape, hollow: false }
}

/// The background of plots. Here and below: the colour on a light page, then on a dark one.
pub const BACKGROUND: (u32, u32) = (0xFFFFFF, 0x1F2124);
/// The colour of axes and their text.
pub const TEXT: (u32, u32) = (0x1D1E20, 0xE6E6E3);
/// The colour of grid lines.
pub const GRID: (u32, u32) = (0xDCDCD8, 0x383B40);

/// The colour of lines that belong to no method.
pub const NEUTRAL: (u32, u32) = (0x777A80, 0x9DA1A8);

/// The looks of methods and patchers by name. Names that stand for the same thing in different suites share a look.
const LOOKS: [(&[&str], Look); 13] = [
    (&["conventional"], look(0x3D3F44, 0xD2D2CE, Shape::Square)),
    (&["mono", "same image"], Look { hollow: true, ..look(NEUTRAL.0, NEUTRAL.1, Shape::Circle) }),
    (&["instanced"], look(0x9A7400, 0xE0C048, Shape::Up)),
    (&["multiview"], look(0xB3578C, 0xDD92BD, Shape::Down)),
    (&["hybrid"], look(0x009E73, 0x35C79B, Shape::Diamond)),
    (&["shading-reprojection"], look(0x5A4FCF, 0xA39BF5, Shape::Square)),
    (&["yoro-gather", "yoro", "gather"], look(0x0072B2, 0x56B4E9, Shape::Circle)),
    (&["yoro-paper", "paper"], look(0xD55E00, 0xF08A3C, Shape::Diamond)),
    (&["median"], look(0x9A7401, 0xE0C049, Shape::Up)),
    (&["xiao"], look(0x009E74, 0x35C79C, Shape::Square)),
    (&["telea"], look(0xB3578D, 0xDD92BE, Shape::Down)),
    (&["navier-stokes"], look(0x5A4FD0, 0xA39BF6, Shape::Cross)),
    (&["neural"], look(0x6E5A4E, 0xC4AFA2, Shape::Cross)),
];

const OTHERS: [Look; 4] = [
    look(0x6B8E23, 0xA9CC5C, Shape::Cross),
    look(0xA0522E, 0xE0A07A, Shape::Cross),
    look(0x4682B5, 0x8FBCE0, Shape::Cross),
    look(0x8B008C, 0xD98BD9, Shape::Cross),
];

/// Returns the look of the method or patcher with this name. Unknown names share a few looks.
pub fn of(name: &str) -> Look {
    let name = name.strip_prefix("patcher-").unwrap_or(name);
    let known = LOOKS.iter().find(|(names, _)| names.contains(&name)).map(|(_, look)| *look);
    known.unwrap_or_else(|| {
        let hash = name.bytes().fold(0usize, |hash, byte| hash.wrapping_mul(31).wrapping_add(byte.into()));
        OTHERS[hash % OTHERS.len()]
    })
}

/// Returns the style sheet's rules that replace the colours of a light page by those of a dark one.
pub(crate) fn css_rules() -> String {
    let rule = |(light, dark)| {
        format!("[fill=\"#{light:06X}\"]{{fill:#{dark:06X}}}[stroke=\"#{light:06X}\"]{{stroke:#{dark:06X}}}")
    };
    colors().into_iter().map(rule).collect()
}

/// Returns every colour that a plot can have: on a light page and on a dark one.
fn colors() -> Vec<(u32, u32)> {
    let looks = LOOKS.iter().map(|(_, look)| look).chain(&OTHERS).map(|look| (look.light, look.dark));
    let mut all: Vec<(u32, u32)> = [BACKGROUND, TEXT, GRID].into_iter().chain(looks).collect();
    all.sort_unstable();
    all.dedup();
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_light_colour_stands_for_one_dark_colour() {
        let all = colors();
        for pair in all.windows(2) {
            assert_ne!(pair[0].0, pair[1].0, "{:06X} would have two dark colours", pair[0].0);
        }
    }

    #[test]
    fn methods_of_one_table_look_different() {
        let methods = LOOKS.map(|(names, look)| (names[0], look));
        for (i, (name, look)) in methods.iter().enumerate() {
            for (other, other_look) in &methods[i + 1..] {
                assert_ne!(look, other_look, "{name} and {other}");
            }
        }
        assert_eq!(of("gather"), of("yoro-gather"));
        assert_eq!(of("something new").shape, Shape::Cross);
    }

    /// The contrast ratio of WCAG 2 against the background, whose minimum for graphics is 3.
    #[test]
    fn marks_stand_out_from_the_page() {
        let luminance = |rgb: u32| {
            let channel = |shift: u32| {
                let value = f64::from(rgb >> shift & 255) / 255.0;
                if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
            };
            0.2126 * channel(16) + 0.7152 * channel(8) + 0.0722 * channel(0)
        };
        let contrast = |a: u32, b: u32| {
            let (a, b) = (luminance(a), luminance(b));
            (a.max(b) + 0.05) / (a.min(b) + 0.05)
        };
        for (light, dark) in colors() {
            if [BACKGROUND, GRID].contains(&(light, dark)) {
                continue;
            }
            assert!(contrast(light, BACKGROUND.0) >= 3.0, "{light:06X} on white");
            assert!(contrast(dark, BACKGROUND.1) >= 3.0, "{dark:06X} on black");
        }
    }
}
