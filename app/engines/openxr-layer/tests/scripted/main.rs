//! The layer between a scripted application and the simulated runtime: on Vulkan under the validation layer, and on
//! OpenGL ES where that differs.

#[path = "../../../core/tests/vulkan/harness.rs"]
#[expect(dead_code, reason = "shared with the core's tests, which use all of it")]
mod harness;

mod checks;
mod client;
mod drawing;
mod faults;
mod habits;
mod lasting;
mod passing;
mod scene;
mod stereo;
mod world;
