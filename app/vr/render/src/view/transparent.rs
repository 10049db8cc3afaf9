//! The pass for transparent surfaces.

use std::cell::RefCell;
use std::rc::Rc;

use super::cluster::{Batch, Culler};
use super::geometry::{Eyes, Programs, Variant};
use super::passes::Illumination;
use super::rectangle::Rectangle;
use super::scene::{Features, GpuScene};
use super::uniforms::depth_test;
use yoro::eyes::View;
use yoro_gl::{Blend, Context, GlError, Program, RasterState, ShaderSource};

/// Draws blended surfaces from back to front, tested against the depth buffer of the bound framebuffer. Blends into
/// display-referred colour; writes no depth.
pub struct TransparentPass {
    gl: Rc<Context>,
    /// Variants with their programs.
    made: Vec<(Variant, Programs)>,
    /// (distance, batch, cluster) of the blended clusters. Allocated once.
    order: RefCell<Vec<(f32, u32, u32)>>,
}

impl TransparentPass {
    /// Makes the pass without programs.
    pub fn new(gl: &Rc<Context>, scene: &GpuScene) -> TransparentPass {
        let count = scene.blended().map(|batch| batch.clusters.len()).sum();
        TransparentPass { gl: gl.clone(), made: Vec::new(), order: RefCell::new(Vec::with_capacity(count)) }
    }

    /// Compiles the programs that the scene's blended materials need, unless they are compiled already. `shading` are the
    /// defines of `include/shade.glsl`.
    pub fn prepare(
        &mut self,
        scene: &GpuScene,
        variant: Variant,
        shading: &[(&'static str, String)],
    ) -> Result<(), GlError> {
        if self.made.iter().any(|(made, _)| *made == variant) {
            return Ok(());
        }
        let mut programs = [const { None }; Features::COMBINATIONS];
        for batch in scene.blended() {
            let features = scene.materials[batch.material].features;
            let slot: &mut Option<Program> = &mut programs[features.index()];
            if slot.is_none() {
                let mut defines = features.defines();
                defines.extend_from_slice(shading);
                defines.extend(variant.defines());
                let source = ShaderSource::Raster {
                    vertex: "render/geometry.vert",
                    fragment: "render/transparent.frag",
                };
                *slot = Some(Program::new(&self.gl, source, &defines)?);
            }
        }
        self.made.push((variant, programs));
        Ok(())
    }

    /// Draws what is seen in any of the views and hidden by nothing, with the light for positions relative to the first
    /// view's, over what the pass before has drawn; in this part of the image alone, if one is given.
    pub fn run(
        &self,
        variant: Variant,
        scene: &GpuScene,
        views: &[View],
        light: &Illumination,
        part: Option<&Rectangle>,
    ) {
        let (Some((_, programs)), Some(view)) =
            (self.made.iter().find(|(v, _)| *v == variant), views.first())
        else {
            return;
        };
        let cullers: [Culler; 2] = std::array::from_fn(|i| Culler::of_view(views.get(i).unwrap_or(view)));
        let mut order = self.order.borrow_mut();
        order.clear();
        for (b, batch) in scene.batches.iter().enumerate() {
            if scene.materials[batch.material].blended {
                let is_seen =
                    |c: &usize| cullers.iter().any(|culler| culler.sees(&scene.clusters[*c].bounds));
                order.extend(batch.clusters.clone().filter(is_seen).map(|c| {
                    let center = scene.clusters[c].bounds.center();
                    (center.distance_squared(view.pose.position), b as u32, c as u32)
                }));
            }
        }
        if order.is_empty() {
            return;
        }
        back_to_front(&mut order);
        let eyes = Eyes::new(variant.layout, views);
        light.declare(self.gl.pass("transparent")).run(|| {
            if eyes.are_clipped() {
                self.gl.set_clip_distance(true);
            }
            let mut bound = None;
            let mut current = u32::MAX;
            for &(_, batch, cluster) in order.iter() {
                let Batch { material, moves, .. } = scene.batches[batch as usize];
                let material = &scene.materials[material];
                let Some(program) = &programs[material.features.index()] else { continue };
                if batch != current {
                    current = batch;
                    let depth = depth_test(view.depth.convention);
                    let cull = !material.double_sided;
                    self.gl.set_raster_state(&RasterState {
                        depth,
                        blend: Blend::Over,
                        cull,
                        ..RasterState::SCREEN
                    });
                    self.gl.mask_depth();
                    if let Some(Rectangle { origin, size }) = part {
                        self.gl.clip(*origin, *size);
                    }
                    eyes.set(program.bind());
                    light.set(program);
                    scene.set_material(program, material);
                }
                let cluster = &scene.clusters[cluster as usize];
                let mesh = scene.bind_mesh(moves, &mut bound);
                mesh.draw(cluster.start as usize..cluster.end as usize, variant.layout.instances());
            }
            if eyes.are_clipped() {
                self.gl.set_clip_distance(false);
            }
            self.gl.set_raster_state(&RasterState::SCREEN);
        });
    }
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
