//! The library on a real GL context: golden images, shader variants, GL objects.

mod golden;
mod methods;
mod objects;
mod refusals;
mod shaders;
