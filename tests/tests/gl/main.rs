//! Tests on a real GL context: golden images, shader variants and costs, GL objects.

mod golden;
mod methods;
mod multiview;
mod objects;
mod record;
mod refusals;
mod shader_cost;
mod shaders;
