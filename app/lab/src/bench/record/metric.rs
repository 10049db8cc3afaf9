//! Names of the metrics, with units. Quality is that of the eye that is not dominant, against the same eye
//! really rendered (`conventional`); images are 8 bits, display-referred.

/// Wall clock of a whole stereo frame up to glFinish, in ms.
pub const FRAME_MS: &str = "frame_ms";
/// CPU time of the whole process during that frame, all threads together, in ms.
pub const CPU_MS: &str = "cpu_ms";
/// Prefix of the time of one pass in ms: `pass_ms/march`. The header's `pass_clock` says what clock. Frames
/// of their own, since timing passes costs time. One value per round, at the setting's first frame.
pub const PASS_MS: &str = "pass_ms/";
/// GPU time of all passes of a frame by timer queries, in ms; only where they can be trusted. One value per
/// round, at the setting's first frame.
pub const GPU_MS: &str = "gpu_ms";
/// Textures that the contender holds after its first frame, by their formats, in MiB; one value.
pub const TEXTURE_MIB: &str = "texture_mib";
/// The same with the resident memory of the process that has loaded the scene and made no contender yet, in MiB;
/// one value.
pub const MEMORY_MIB: &str = "memory_mib";

/// PSNR of red, green and blue in dB; null for identical images.
pub const PSNR: &str = "psnr";
/// Bits that a stream saves over two eyes at the same quantizer, in per cent; one value.
pub const SAVED: &str = "saved";
/// PSNR of luma in dB.
pub const PSNR_LUMA: &str = "psnr_luma";
/// SSIM, gaussian 11x11, mean of red, green and blue.
pub const SSIM: &str = "ssim";
/// The same of luma.
pub const SSIM_LUMA: &str = "ssim_luma";
/// SSIM, uniform 7x7, mean of red, green and blue.
pub const SSIM_UNIFORM: &str = "ssim_uniform";
/// LDR-FLIP, mean over the image, 0 (equal) to 1.
pub const FLIP: &str = "flip";
/// Share of the pixels that the dominant eye's own image does not show, 0 to 1: the same for all contenders.
pub const HOLE_SHARE: &str = "hole_share";
/// PSNR (RGB) in the holes, in dB.
pub const HOLE_PSNR: &str = "hole_psnr";
/// SSIM (gaussian, RGB) in the holes.
pub const HOLE_SSIM: &str = "hole_ssim";
/// FLIP in the holes.
pub const HOLE_FLIP: &str = "hole_flip";
/// PSNR (RGB) elsewhere, in dB.
pub const VISIBLE_PSNR: &str = "visible_psnr";
/// SSIM (gaussian, RGB) elsewhere.
pub const VISIBLE_SSIM: &str = "visible_ssim";
/// FLIP elsewhere.
pub const VISIBLE_FLIP: &str = "visible_flip";

/// Flicker over all pixels, of 255; see [`crate::metrics::Flicker`]. One value per pair of frames, so one
/// less than frames, as for the following.
pub const FLICKER: &str = "flicker";
/// Flicker in the holes of either frame.
pub const FLICKER_HOLES: &str = "flicker_holes";
/// Flicker at the edges of the image, outside of holes.
pub const FLICKER_EDGES: &str = "flicker_edges";
/// Flicker everywhere else.
pub const FLICKER_REST: &str = "flicker_rest";
/// Change of the ground truth from frame to frame, over all pixels, of 255: what flicker is to be held
/// against.
pub const CHANGE: &str = "change";
/// The same in the holes of either frame.
pub const CHANGE_HOLES: &str = "change_holes";
/// The same at edges.
pub const CHANGE_EDGES: &str = "change_edges";
/// The same everywhere else.
pub const CHANGE_REST: &str = "change_rest";

/// The flicker metrics: all pixels, holes, edges, the rest.
pub const FLICKERS: [&str; 4] = [FLICKER, FLICKER_HOLES, FLICKER_EDGES, FLICKER_REST];
/// Their counterparts of the ground truth, measured for `conventional`.
pub const CHANGES: [&str; 4] = [CHANGE, CHANGE_HOLES, CHANGE_EDGES, CHANGE_REST];

/// Columns of the guard band that were drawn in a frame.
pub const GUARD_COLUMNS: &str = "guard_columns";
/// Pixels that lay in the guard band and were seen, but were not drawn, in a frame.
pub const UNDRAWN: &str = "undrawn";
/// PSNR of red, green and blue in dB in the columns at the other eye's outer border that a guard band is for.
pub const BORDER_PSNR: &str = "border_psnr";

/// Share of the uncovered pixels that the history shows, 0 to 1, as the method counts it, two frames before.
pub const SERVED: &str = "served";
/// Pixels of the other eye that were rendered besides, as a share of an eye's.
pub const RENDERED_BESIDES: &str = "rendered_besides";

/// Share of the pixels whose tile has a law, 0 to 1.
pub const LAW_PIXEL: &str = "law_pixel";
/// Share of the waves all of whose pixels have one.
pub const LAW_WAVE: &str = "law_wave";
/// Trips of the loop of the march's short way for a pixel.
pub const TRIPS_PIXEL: &str = "trips_pixel";
/// The same for a wave.
pub const TRIPS_WAVE: &str = "trips_wave";
/// Share of the pixels that go the long way, 0 to 1.
pub const GOES_ON_PIXEL: &str = "goes_on_pixel";
/// Share of the waves of which a pixel does.
pub const GOES_ON_WAVE: &str = "goes_on_wave";
/// Segments that the march takes on its long way, for a wave.
pub const LONG_TRIPS_WAVE: &str = "long_trips_wave";
/// Estimated issue slots for each pixel of the first pass of `gather`.
pub const SLOTS_TILES: &str = "slots_tiles";
/// The same of the second pass.
pub const SLOTS_SPANS: &str = "slots_spans";
/// The same of the third.
pub const SLOTS_MARCH: &str = "slots_march";
/// The same of all three.
pub const SLOTS: &str = "slots";
/// Estimated texture instructions for each pixel.
pub const FETCHES: &str = "fetches";
/// Estimated time of the issue slots alone, in ms.
pub const ALU_MS: &str = "alu_ms";
/// Estimated time of the texture instructions alone, in ms.
pub const FETCH_MS: &str = "fetch_ms";
/// Estimated time of the bytes alone, in ms.
pub const MEMORY_MS: &str = "memory_ms";

/// Time of a patcher alone in ms, by the wall clock, on an image that lies where the patcher works.
pub const PATCH_MS: &str = "patch_ms";
/// Upload and readback around that, in ms; 0 for patchers on the CPU.
pub const PATCH_TRANSFER_MS: &str = "patch_transfer_ms";
