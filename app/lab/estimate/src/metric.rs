//! The names of the values that a [`Meter`](crate::Meter) returns.

/// Share of the pixels whose tile has a law, 0 to 1.
pub const LAW_PIXEL: &str = "law_pixel";
/// Share of the waves in which every pixel's tile has a law, 0 to 1.
pub const LAW_WAVE: &str = "law_wave";
/// The march's first steps, per pixel.
pub const TRIPS_PIXEL: &str = "trips_pixel";
/// The march's first steps, per wave.
pub const TRIPS_WAVE: &str = "trips_wave";
/// Share of the pixels that search over segments, 0 to 1.
pub const GOES_ON_PIXEL: &str = "goes_on_pixel";
/// Share of the waves with a pixel that searches over segments, 0 to 1.
pub const GOES_ON_WAVE: &str = "goes_on_wave";
/// Segments of that search, per wave.
pub const LONG_TRIPS_WAVE: &str = "long_trips_wave";
/// Estimated issue slots per pixel of the first pass of `gather`.
pub const SLOTS_TILES: &str = "slots_tiles";
/// Estimated issue slots per pixel of the second pass.
pub const SLOTS_SPANS: &str = "slots_spans";
/// Estimated issue slots per pixel of the third pass.
pub const SLOTS_MARCH: &str = "slots_march";
/// Estimated issue slots per pixel of all three passes.
pub const SLOTS: &str = "slots";
/// Estimated texture instructions per pixel.
pub const FETCHES: &str = "fetches";
/// Estimated time of the issue slots alone, in ms.
pub const ALU_MS: &str = "alu_ms";
/// Estimated time of the texture instructions alone, in ms.
pub const FETCH_MS: &str = "fetch_ms";
/// Estimated time of the memory traffic alone, in ms.
pub const MEMORY_MS: &str = "memory_ms";
