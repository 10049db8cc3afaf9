//! The layer between a scripted application and the simulated runtime: on Vulkan under the validation layer, and on
//! OpenGL ES where that differs.

mod checks;
mod client;
mod drawing;
mod faults;
mod habits;
mod lasting;
mod mistakes;
mod passing;
mod scene;
mod stereo;
mod world;

use yoro_test_support::harness;
