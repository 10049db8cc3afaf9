//! Tests on a real GL context: golden images, shader variants and costs, GL objects. Also scenes on Vulkan.

mod frame_passes;
mod golden;
mod layers;
mod methods;
mod multiview;
mod objects;
mod refusals;
mod shader_cost;
mod shaders;
mod supersampled;
mod vulkan;
