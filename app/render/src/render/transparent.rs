//! The forward pass for transparent surfaces.

use std::rc::Rc;

use glam::IVec2;

use super::cluster::Culler;
use super::lighting::shading_defines;
use super::role::RoleKind;
use super::scene::{FREE_UNIT, Features, GpuScene};
use super::settings::RenderSettings;
use super::shadow::ShadowMap;
use super::uniforms::{Lights, eye_to_clip, set_view};
use yoro::eyes::{DepthConvention, View};
use yoro::gl::{
    Blend, Context, DepthTest, Destination, GlError, Program, RasterState, ShaderSource, Texture,
};

/// Draws what is blended, from back to front, over a finished image.
///
/// Reads the window depth of what is there from a texture, so that it works on a rendered eye and on a
/// synthesized one alike; blends into display-referred colour.
pub struct TransparentPass {
    gl: Rc<Context>,
    /// For depth in textures, and for depth in layers of array textures, once that is asked for.
    programs: [Programs; 2],
    /// (distance, batch, cluster) of the blended clusters; allocated once.
    order: Vec<(f32, u32, u32)>,
}

/// By [`Features::index`]; those that the scene uses.
type Programs = [Option<Program>; Features::COMBINATIONS];

/// Window depth of an image.
#[derive(Clone, Copy)]
pub struct DepthImage<'a> {
    /// A depth texture or one with a float channel, not filtered.
    pub texture: &'a Texture,
    /// Pixel of the texture that belongs to the lower left pixel of the destination.
    pub origin: [u32; 2],
    /// The layer, if the texture is an array.
    pub layer: Option<u32>,
}

impl<'a> DepthImage<'a> {
    /// A texture that has the image's size.
    pub fn whole(texture: &'a Texture) -> DepthImage<'a> {
        DepthImage { texture, origin: [0, 0], layer: None }
    }
}

/// What the scene's blended materials need.
fn compile(
    gl: &Rc<Context>,
    scene: &GpuScene,
    settings: &RenderSettings,
    layered: bool,
) -> Result<Programs, GlError> {
    let mut programs = [const { None }; Features::COMBINATIONS];
    for batch in scene.batches.iter().filter(|b| scene.materials[b.material].blended) {
        let features = scene.materials[batch.material].features;
        let slot: &mut Option<Program> = &mut programs[features.index()];
        if slot.is_none() {
            let mut defines = features.defines();
            defines.extend(shading_defines(gl, scene, settings));
            defines.extend(layered.then(|| RoleKind::Layer.define()).flatten());
            let source =
                ShaderSource::Raster { vertex: "render/geometry.vert", fragment: "render/transparent.frag" };
            *slot = Some(Program::new(gl, source, &defines)?);
        }
    }
    Ok(programs)
}

impl TransparentPass {
    /// Compiles the variants that the scene's blended materials need.
    ///
    /// # Errors
    /// As [`Program::new`].
    pub fn new(
        gl: &Rc<Context>,
        scene: &GpuScene,
        settings: &RenderSettings,
    ) -> Result<TransparentPass, GlError> {
        let blended = scene.batches.iter().filter(|b| scene.materials[b.material].blended);
        let count = blended.map(|batch| batch.clusters.len()).sum();
        let programs = [compile(gl, scene, settings, false)?, [const { None }; Features::COMBINATIONS]];
        Ok(TransparentPass { gl: gl.clone(), programs, order: Vec::with_capacity(count) })
    }

    /// Compiles the variants that read depth from layers; nothing is done when they are there.
    ///
    /// # Errors
    /// As [`Program::new`].
    pub fn prepare_layered(&mut self, scene: &GpuScene, settings: &RenderSettings) -> Result<(), GlError> {
        if scene.has_transparent() && self.programs[1].iter().all(Option::is_none) {
            self.programs[1] = compile(&self.gl, scene, settings, true)?;
        }
        Ok(())
    }

    /// Draws into `to` what `culler` lets through and nothing in `depth` hides.
    #[allow(clippy::too_many_arguments, reason = "a pass names what it reads")]
    pub fn run(
        &mut self,
        to: &Destination,
        depth: DepthImage,
        shadow: Option<&ShadowMap>,
        scene: &GpuScene,
        view: &View,
        culler: &Culler,
        lights: &Lights,
        exposure: f32,
    ) {
        let eye = view.pose.position;
        self.order.clear();
        for (b, batch) in scene.batches.iter().enumerate() {
            if scene.materials[batch.material].blended {
                let clusters = batch.clusters.clone().filter(|&c| culler.sees(&scene.clusters[c].bounds));
                self.order.extend(
                    clusters.map(|c| {
                        (scene.clusters[c].bounds.center().distance_squared(eye), b as u32, c as u32)
                    }),
                );
            }
        }
        if self.order.is_empty() {
            return;
        }
        back_to_front(&mut self.order);
        self.gl.pass("transparent", || {
            self.gl.bind_framebuffer(to.framebuffer, to.origin, to.size);
            scene.mesh.bind();
            let matrix = eye_to_clip(view);
            let offset =
                IVec2::from(depth.origin.map(|n| n as i32)) - IVec2::from(to.origin.map(|n| n as i32));
            let nearer = match view.depth.convention {
                DepthConvention::Standard => 1.0,
                DepthConvention::Reversed => -1.0,
            };
            let mut current = u32::MAX;
            for &(_, batch, cluster) in &self.order {
                let material = &scene.materials[scene.batches[batch as usize].material];
                let programs = &self.programs[usize::from(depth.layer.is_some())];
                let Some(program) = &programs[material.features.index()] else { continue };
                if batch != current {
                    current = batch;
                    self.gl.set_raster_state(&RasterState {
                        depth: DepthTest::Off,
                        blend: Blend::Over,
                        cull: !material.double_sided,
                    });
                    program
                        .bind()
                        .set("eye", eye)
                        .set("eye_to_clip", matrix)
                        .set("exposure", exposure)
                        .set("depth_offset", offset)
                        .set("nearer", nearer)
                        .set("view_layer", depth.layer.unwrap_or(0) as i32)
                        .texture_of("depth_map", FREE_UNIT, depth.texture);
                    if let Some(shadow) = shadow {
                        shadow.set(program, FREE_UNIT + 1, eye);
                    }
                    set_view(program, view);
                    lights.set(program, &scene.sky);
                    scene.set_material(program, material);
                }
                let cluster = &scene.clusters[cluster as usize];
                scene.mesh.draw(cluster.start as usize..cluster.end as usize, 1);
            }
        });
    }
}

/// Sorts by distance, farthest first, without allocation.
fn back_to_front(order: &mut [(f32, u32, u32)]) {
    order.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then((a.1, a.2).cmp(&(b.1, b.2))));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn farthest_first_and_equal_distances_in_a_fixed_order() {
        let mut order = [(1.0, 2, 7), (9.0, 0, 1), (4.0, 1, 5), (4.0, 1, 3), (4.0, 0, 2)];
        back_to_front(&mut order);
        assert_eq!(order, [(9.0, 0, 1), (4.0, 0, 2), (4.0, 1, 3), (4.0, 1, 5), (1.0, 2, 7)]);
    }
}
