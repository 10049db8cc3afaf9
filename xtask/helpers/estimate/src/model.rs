//! Issue slots and bytes of a recorded frame, pass by pass.

use std::collections::BTreeMap;

use crate::costs::Costs;
use crate::gpus::{Device, GPUS};
use crate::lamps::Lamps;
use crate::traffic::{Assumed, fragments, pieces};
use yoro_gl::{ProgramRecipe, Shape};
use yoro_test_support::record::{Command, Draw};

/// The prefix of the names of synthesis passes. Their execution is counted by [`Counter`](crate::gather::Counter).
pub const SYNTHESIS: &str = "gather ";
/// The size of an eye in pixels, as on a Quest 3.
pub const SIZE: [u32; 2] = [1680, 1760];
/// The name of the frames that are derived from records of [`Method::Instanced`](yoro_render::stereo::Method::Instanced),
/// which draws the same pixels and differs only in vertices.
pub const MULTIVIEW: &str = "multiview";
/// The name under which vertices are counted, like a pass.
pub const VERTICES: &str = "vertices";
/// The same with each vertex shaded once for both eyes, as multiview allows.
pub const VERTICES_ONCE: &str = "vertices once";
/// The prefix of metrics of bytes: OpenGL ES, samples averaged in the tiles.
pub const BYTES: &str = "bytes/";
/// The prefix of the simulated row "16-bit depth, as a Vulkan host resolves it".
pub const BYTES_16: &str = "bytes-16/";
/// The prefix of bytes where `glBlitFramebuffer` averages in memory.
pub const BYTES_BLIT: &str = "bytes-blit/";
/// Fragments shaded per covered pixel of a surface with several samples. This is an assumption: at an edge between
/// triangles, the pixel is shaded once for each triangle.
const EDGE_FRAGMENTS: f64 = 1.05;

/// The costs of a frame per pixel of an eye, by metric: `slots/a740/surfaces`, `bytes/surfaces`, `fragments/surfaces`.
pub type Frame = BTreeMap<String, f64>;

/// Computes the costs of recorded frames.
pub struct FrameModel {
    costs: Vec<(Device, Costs)>,
}

impl FrameModel {
    /// Reads the costs of shaders.
    ///
    /// # Errors
    /// If the table lacks a GPU.
    pub fn new() -> anyhow::Result<FrameModel> {
        let costs = GPUS.into_iter().map(|gpu| Ok((gpu, Costs::of(gpu.gpu)?)));
        Ok(FrameModel { costs: costs.collect::<anyhow::Result<_>>()? })
    }

    /// Returns the costs of a recorded frame whose eyes have this size, without what the synthesis executes. `laws` is
    /// the share of the synthesized pixels whose tile has a law, 0 to 1.
    ///
    /// # Errors
    /// If the table lacks a shader.
    pub fn frame(
        &self,
        commands: &[Command],
        size: [u32; 2],
        lamps: &mut Lamps,
        laws: f64,
    ) -> anyhow::Result<Frame> {
        let pixels = f64::from(size[0]) * f64::from(size[1]);
        let mut frame = Frame::new();
        let mut add = |metric: String, value: f64| *frame.entry(metric).or_default() += value / pixels;
        let tiles = Assumed { laws, ..Assumed::default() };
        for (prefix, assumed) in [
            (BYTES, tiles),
            (BYTES_16, Assumed { depth_in_16_bits: true, ..tiles }),
            (BYTES_BLIT, Assumed { averages_in_memory: true, ..tiles }),
        ] {
            for piece in pieces(commands, &assumed) {
                add(format!("{prefix}{}", piece.passes.join(", ")), piece.bytes());
                add(format!("{prefix}{VERTICES}"), piece.vertex_bytes);
            }
        }
        for command in commands {
            let Command::Draw(draw) = command else { continue };
            let count = shaded(draw);
            add(format!("fragments/{}", draw.pass), count);
            if draw.pass.starts_with(SYNTHESIS) {
                continue;
            }
            for (gpu, costs) in &self.costs {
                let of = |pass: &str| format!("slots/{}/{pass}", gpu.gpu);
                let fragment = costs.fragment(&draw.program)?;
                let lights = if fragment.lamp > 0.0 { lamps.of_wave(fragment.lanes) } else { 0.0 };
                add(of(draw.pass), count * (fragment.slots + lights * fragment.lamp));
                if let Shape::Mesh { vertices, .. } = draw.shape {
                    add(of(VERTICES), vertices as f64 * costs.vertex(&draw.program));
                }
            }
        }
        Ok(frame)
    }

    /// Returns the costs of the same frame by multiview, from the record of [`yoro_render::stereo::Method::Instanced`],
    /// which draws the same pixels.
    ///
    /// # Errors
    /// Those of [`FrameModel::frame`].
    pub fn multiview(
        &self,
        commands: &[Command],
        size: [u32; 2],
        lamps: &mut Lamps,
    ) -> anyhow::Result<Frame> {
        let commands: Vec<Command> = commands.iter().map(with_layers).collect();
        let mut frame = self.frame(&commands, size, lamps, 0.0)?;
        for (gpu, _) in &self.costs {
            let twice = frame.get(&format!("slots/{}/{VERTICES}", gpu.gpu)).copied().unwrap_or(0.0);
            frame.insert(format!("slots/{}/{VERTICES_ONCE}", gpu.gpu), 0.5 * twice);
        }
        Ok(frame)
    }
}

/// Returns the number of fragments that a draw call shades.
fn shaded(draw: &Draw) -> f64 {
    let samples =
        draw.target.as_ref().and_then(|target| target.color.first()).map_or(1, |image| image.samples);
    let edges = samples > 1 && draw.shape != Shape::Screen;
    fragments(draw) * if edges { EDGE_FRAGMENTS } else { 1.0 }
}

/// Returns the draw call as multiview would make it, with the programs that draw into layers and read them.
fn with_layers(command: &Command) -> Command {
    let Command::Draw(draw) = command else { return command.clone() };
    let rename = |name: &str| match name {
        "CLIP_DISTANCE" | "SEAM_DISCARD" => "MULTIVIEW".to_owned(),
        other => other.to_owned(),
    };
    let defines = draw.program.defines.iter().map(|(name, value)| (rename(name), value.clone())).collect();
    let program = ProgramRecipe { files: draw.program.files.clone(), defines };
    Command::Draw(Draw { program: program.into(), ..draw.clone() })
}

#[cfg(test)]
mod tests {
    use std::rc::Rc;

    use super::*;
    use yoro::eyes::{EyeOptions, Pose};
    use yoro_gl::{Attachments, Format, Image};

    /// A mesh of 20 vertices without maps, with 120 fragments on 100 pixels, and a screen pass.
    #[test]
    fn slots_are_fragments_times_what_the_compiler_says() {
        let size = [10, 10];
        let image = Image { format: Format::Rgba8, size, samples: 1 };
        let draw = |pass, file: &str, shape, samples_passed| {
            Command::Draw(Draw {
                pass,
                program: ProgramRecipe { files: vec![file.into()], defines: Vec::new() }.into(),
                target: Some(Rc::new(Attachments { color: vec![image], depth: None })),
                textures: Vec::new(),
                area: size,
                view: size,
                shape,
                blends: false,
                uses_depth: false,
                writes_depth: false,
                masks_samples: false,
                samples_passed,
            })
        };
        let mesh = Shape::Mesh { indices: 30, vertices: 20, vertex_bytes: 32 };
        let commands = [
            draw("surfaces", "render/shadow.frag", mesh, Some(120)),
            draw("bloom", "render/bloom_up.frag", Shape::Screen, None),
            draw("gather march", "synthesis/gather/march.frag", Shape::Screen, None),
        ];
        let pair = EyeOptions { size, ..EyeOptions::default() }.pair(Pose::IDENTITY);
        let mut lamps = Lamps::new(&pair.view(pair.dominant), &[pair.depth.clear_value(); 100], &[]);
        let model = FrameModel::new().unwrap();
        let frame = model.frame(&commands, size, &mut lamps, 0.0).unwrap();
        let told = |file: &str, stage: &str, column: usize| {
            let table = include_str!("../shader-cost.csv");
            let line = table.lines().find(|line| line.starts_with(&format!("a740,{file},{stage},"))).unwrap();
            line.split(',').nth(column).unwrap().parse::<f64>().unwrap()
        };
        let close = |metric: &str, expected: f64| {
            let value = frame[metric];
            assert!((value - expected).abs() < 1e-9 * expected, "{metric}: {value}, not {expected}");
        };
        close("slots/a740/surfaces", 1.2 * told("render/shadow.frag", "fragment", 4));
        close("slots/a740/vertices", 0.2 * told("render/shadow.frag", "vertex", 3));
        close("slots/a740/bloom", told("render/bloom_up.frag", "fragment", 4));
        close("fragments/surfaces", 1.2);
        close("bytes/surfaces", 8.0);
        close("bytes/vertices", (20.0 * 32.0 + 30.0 * 4.0) / 100.0);
        // The execution of the synthesis is counted elsewhere.
        assert!(!frame.contains_key("slots/a740/gather march") && frame.contains_key("bytes/gather march"));
        // By multiview, each vertex is shaded twice, or once for both eyes.
        let both = model.multiview(&commands, size, &mut lamps).unwrap();
        assert_eq!(both["slots/a740/vertices once"], 0.5 * both["slots/a740/vertices"]);
    }
}
