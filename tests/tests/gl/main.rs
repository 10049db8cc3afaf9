//! Tests on a real GL context: golden images, shader variants and costs, GL objects.

mod golden;
mod methods;
mod multiview;
mod objects;
mod refusals;
mod record;
mod shader_cost;
mod shaders;
