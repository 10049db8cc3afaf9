//! The forward pass for transparent surfaces.

use std::cell::RefCell;
use std::rc::Rc;

use glam::IVec2;

use super::cluster::{Batch, Culler};
use super::light_tiles::LightTiles;
use super::lighting::shading_defines;
use super::role::RoleKind;
use super::scene::{FREE_UNIT, Features, GpuScene};
use super::settings::RenderSettings;
use super::uniforms::{depth_test, eye_to_clip, nearer};
use yoro::eyes::View;
use yoro_gl::{Blend, Context, DepthTest, Destination, GlError, Program, RasterState, ShaderSource, Texture};

/// Draws blended surfaces over an image, from back to front.
///
/// With the deferred renderer it reads the window depth of the image from a texture, so that it works on rendered and
/// synthesized eyes alike. With the forward renderer it is tested against the depth of each sample. Blends into
/// display-referred colour.
pub struct TransparentPass {
    gl: Rc<Context>,
    /// First the programs that test against depth in textures or in the depth buffer, depending on the renderer. Then,
    /// once requested, those for depth in layers of array textures.
    programs: [Programs; 2],
    /// (distance, batch, cluster) of the blended clusters. Allocated once.
    order: RefCell<Vec<(f32, u32, u32)>>,
}

/// Programs by [`Features::index`], for the combinations that the scene uses.
type Programs = [Option<Program>; Features::COMBINATIONS];

/// Window depth of an image.
#[derive(Clone, Copy)]
pub struct DepthImage<'a> {
    /// A depth texture, or a texture with a float channel, without filtering.
    pub texture: &'a Texture,
    /// Pixel of the texture that corresponds to the destination's lower left pixel.
    pub origin: [u32; 2],
    /// The layer, if the texture is an array.
    pub layer: Option<u32>,
}

impl<'a> DepthImage<'a> {
    /// Wraps a texture of the image's own size.
    pub fn whole(texture: &'a Texture) -> DepthImage<'a> {
        DepthImage { texture, origin: [0, 0], layer: None }
    }
}

/// The image that transparent surfaces are drawn over.
#[derive(Clone, Copy)]
pub enum Onto<'a> {
    /// An image whose depth is a texture.
    Image(&'a Destination, DepthImage<'a>),
    /// The bound framebuffer with its depth buffer.
    Bound,
}

/// Compiles the variants that the scene's blended materials need.
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
            if settings.is_forward() {
                defines.extend(LightTiles::defines());
                defines.push(("DEPTH_BUFFER", String::new()));
            }
            let source =
                ShaderSource::Raster { vertex: "render/geometry.vert", fragment: "render/transparent.frag" };
            *slot = Some(Program::new(gl, source, &defines)?);
        }
    }
    Ok(programs)
}

impl TransparentPass {
    /// Compiles the variants that the scene's blended materials need.
    pub fn new(
        gl: &Rc<Context>,
        scene: &GpuScene,
        settings: &RenderSettings,
    ) -> Result<TransparentPass, GlError> {
        let blended = scene.batches.iter().filter(|b| scene.materials[b.material].blended);
        let count = blended.map(|batch| batch.clusters.len()).sum();
        let programs = [compile(gl, scene, settings, false)?, [const { None }; Features::COMBINATIONS]];
        Ok(TransparentPass { gl: gl.clone(), programs, order: RefCell::new(Vec::with_capacity(count)) })
    }

    /// Compiles the variants that read depth from layers, unless they are compiled already.
    pub fn prepare_layered(&mut self, scene: &GpuScene, settings: &RenderSettings) -> Result<(), GlError> {
        if scene.has_transparent() && self.programs[1].iter().all(Option::is_none) {
            self.programs[1] = compile(&self.gl, scene, settings, true)?;
        }
        Ok(())
    }

    /// Draws the surfaces that `culler` lets through and nothing hides. `light` sets the uniforms of
    /// `include/shade.glsl`, for positions relative to the view's.
    pub fn run(&self, onto: Onto, scene: &GpuScene, view: &View, culler: &Culler, light: impl Fn(&Program)) {
        let eye = view.pose.position;
        let mut order = self.order.borrow_mut();
        order.clear();
        for (b, batch) in scene.batches.iter().enumerate() {
            if scene.materials[batch.material].blended {
                let clusters = batch.clusters.clone().filter(|&c| culler.sees(&scene.clusters[c].bounds));
                order.extend(
                    clusters.map(|c| {
                        (scene.clusters[c].bounds.center().distance_squared(eye), b as u32, c as u32)
                    }),
                );
            }
        }
        if order.is_empty() {
            return;
        }
        back_to_front(&mut order);
        let (depth, layer) = match onto {
            Onto::Image(_, depth) => (DepthTest::Off, depth.layer),
            Onto::Bound => (depth_test(view.depth.convention), None),
        };
        self.gl.pass("transparent", || {
            if let Onto::Image(to, _) = onto {
                self.gl.bind_framebuffer(to.framebuffer, to.origin, to.size);
            }
            let mut bound = None;
            let matrix = eye_to_clip(view);
            let mut current = u32::MAX;
            for &(_, batch, cluster) in order.iter() {
                let Batch { material, moves, .. } = scene.batches[batch as usize];
                let material = &scene.materials[material];
                let programs = &self.programs[usize::from(layer.is_some())];
                let Some(program) = &programs[material.features.index()] else { continue };
                if batch != current {
                    current = batch;
                    let cull = !material.double_sided;
                    self.gl.set_raster_state(&RasterState { depth, blend: Blend::Over, cull });
                    self.gl.mask_depth();
                    program.bind().set("eye", eye).set("eye_to_clip", matrix);
                    if let Onto::Image(to, depth) = onto {
                        set_depth_image(program, to, depth, view);
                    }
                    light(program);
                    scene.set_material(program, material);
                }
                let cluster = &scene.clusters[cluster as usize];
                let mesh = scene.bind_mesh(moves, &mut bound);
                mesh.draw(cluster.start as usize..cluster.end as usize, 1);
            }
            self.gl.set_raster_state(&RasterState::SCREEN);
        });
    }
}

/// Sets the depth image that `render/transparent.frag` tests against.
fn set_depth_image(program: &Program, to: &Destination, depth: DepthImage, view: &View) {
    let offset = IVec2::from(depth.origin.map(|n| n as i32)) - IVec2::from(to.origin.map(|n| n as i32));
    program
        .set("depth_offset", offset)
        .set("nearer", nearer(view.depth.convention))
        .set("view_layer", depth.layer.unwrap_or(0) as i32)
        .texture_of("depth_map", FREE_UNIT, depth.texture);
}

/// Sorts by distance, farthest first, without allocating.
fn back_to_front(order: &mut [(f32, u32, u32)]) {
    order.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then((a.1, a.2).cmp(&(b.1, b.2))));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn transparent_clusters_sort_farthest_first_with_ties_fixed() {
        let mut order = [(1.0, 2, 7), (9.0, 0, 1), (4.0, 1, 5), (4.0, 1, 3), (4.0, 0, 2)];
        back_to_front(&mut order);
        assert_eq!(order, [(9.0, 0, 1), (4.0, 0, 2), (4.0, 1, 3), (4.0, 1, 5), (1.0, 2, 7)]);
    }
}
