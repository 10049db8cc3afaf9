//! Issue slots and bytes of a recorded frame, pass by pass.

use std::collections::BTreeMap;

use crate::costs::Costs;
use crate::gpus::{Device, GPUS};
use crate::lamps::Lamps;
use crate::traffic::{Assumed, fragments, samples, vertex_bytes};
use yoro_gl::{ProgramRecipe, Shape};
use yoro_test_support::record::RecordedPass;

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
        passes: &[RecordedPass],
        size: [u32; 2],
        lamps: &mut Lamps,
        laws: f64,
    ) -> anyhow::Result<Frame> {
        let pixels = f64::from(size[0]) * f64::from(size[1]);
        let mut frame = Frame::new();
        let mut add = |metric: String, value: f64| *frame.entry(metric).or_default() += value / pixels;
        let tiles = Assumed { laws, ..Assumed::default() };
        for (prefix, assumed) in [(BYTES, tiles), (BYTES_16, Assumed { depth_in_16_bits: true, ..tiles })] {
            for pass in passes {
                add(format!("{prefix}{}", pass.declaration.name), assumed.bytes(pass));
                add(format!("{prefix}{VERTICES}"), vertex_bytes(pass));
            }
        }
        let draws = passes.iter().flat_map(|pass| pass.draws.iter().map(move |draw| (pass, draw)));
        for (pass, draw) in draws {
            let name = pass.declaration.name;
            let edges = samples(pass) > 1 && draw.shape != Shape::Screen;
            let count = fragments(pass, draw) * if edges { EDGE_FRAGMENTS } else { 1.0 };
            add(format!("fragments/{name}"), count);
            if name.starts_with(SYNTHESIS) {
                continue;
            }
            for (gpu, costs) in &self.costs {
                let of = |pass: &str| format!("slots/{}/{pass}", gpu.gpu);
                let fragment = costs.fragment(&draw.program)?;
                let lights = if fragment.lamp > 0.0 { lamps.of_wave(fragment.lanes) } else { 0.0 };
                add(of(name), count * (fragment.slots + lights * fragment.lamp));
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
        passes: &[RecordedPass],
        size: [u32; 2],
        lamps: &mut Lamps,
    ) -> anyhow::Result<Frame> {
        let passes: Vec<RecordedPass> = passes.iter().map(with_layers).collect();
        let mut frame = self.frame(&passes, size, lamps, 0.0)?;
        for (gpu, _) in &self.costs {
            let twice = frame.get(&format!("slots/{}/{VERTICES}", gpu.gpu)).copied().unwrap_or(0.0);
            frame.insert(format!("slots/{}/{VERTICES_ONCE}", gpu.gpu), 0.5 * twice);
        }
        Ok(frame)
    }
}

/// Returns a pass as multiview would draw it, with the programs that draw into layers and read them.
fn with_layers(pass: &RecordedPass) -> RecordedPass {
    let rename = |name: &str| match name {
        "CLIP_DISTANCE" | "SEAM_DISCARD" => "MULTIVIEW".to_owned(),
        other => other.to_owned(),
    };
    let mut pass = pass.clone();
    for draw in &mut pass.draws {
        let ProgramRecipe { files, defines } = &*draw.program;
        let defines = defines.iter().map(|(name, value)| (rename(name), value.clone())).collect();
        draw.program = ProgramRecipe { files: files.clone(), defines }.into();
    }
    pass
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::traffic::tests::{MESH, pass};
    use yoro::eyes::{EyeOptions, Pose};

    /// A mesh of 4 vertices without maps, with 30 fragments on 40 pixels, and two screen passes.
    #[test]
    fn slots_are_fragments_times_what_the_compiler_says() {
        let size = [10, 4];
        let passes = [
            pass("surfaces", "render/shadow.frag", MESH, &[]),
            pass("bloom", "render/bloom_up.frag", Shape::Screen, &[]),
            pass("gather march", "synthesis/gather/march.frag", Shape::Screen, &[]),
        ];
        let pair = EyeOptions { size, ..EyeOptions::default() }.pair(Pose::IDENTITY);
        let mut lamps = Lamps::new(&pair.view(pair.dominant), &[pair.depth.clear_value(); 40], &[]);
        let model = FrameModel::new().unwrap();
        let frame = model.frame(&passes, size, &mut lamps, 0.0).unwrap();
        let in_table = |file: &str, stage: &str, column: usize| {
            let table = include_str!("../shader-cost.csv");
            let line = table.lines().find(|line| line.starts_with(&format!("a740,{file},{stage},"))).unwrap();
            line.split(',').nth(column).unwrap().parse::<f64>().unwrap()
        };
        let close = |metric: &str, expected: f64| {
            let value = frame[metric];
            assert!((value - expected).abs() < 1e-9 * expected, "{metric}: {value}, not {expected}");
        };
        close("slots/a740/surfaces", 0.75 * in_table("render/shadow.frag", "fragment", 4));
        close("slots/a740/vertices", 0.1 * in_table("render/shadow.frag", "vertex", 3));
        close("slots/a740/bloom", in_table("render/bloom_up.frag", "fragment", 4));
        close("fragments/surfaces", 0.75);
        close("bytes/surfaces", 4.0);
        close("bytes/vertices", (4.0 * 32.0 + 6.0 * 4.0) / 40.0);
        // The execution of the synthesis is counted elsewhere.
        assert!(!frame.contains_key("slots/a740/gather march") && frame.contains_key("bytes/gather march"));
        // By multiview, each vertex is shaded twice, or once for both eyes.
        let both = model.multiview(&passes, size, &mut lamps).unwrap();
        assert_eq!(both["slots/a740/vertices once"], 0.5 * both["slots/a740/vertices"]);
    }
}
