//! Names of the metrics, with units. Quality is that of the eye that is not dominant, compared with a real render of
//! the same eye (`conventional`); images are 8 bits, display-referred.

/// Wall-clock time of a whole stereo frame up to glFinish, in ms.
pub const FRAME_MS: &str = "frame_ms";
/// CPU time of all threads of the process during that frame, in ms.
pub const CPU_MS: &str = "cpu_ms";
/// Prefix of the time of one pass in ms: `pass_ms/march`. The header's `pass_clock` names the clock. Passes are timed
/// in separate frames, because timing them costs time. One value per round, at the setting's first frame.
pub const PASS_MS: &str = "pass_ms/";
/// GPU time of all passes of a frame by timer queries, in ms, only where they can be trusted. One value per round, at
/// the setting's first frame.
pub const GPU_MS: &str = "gpu_ms";
/// Number of draw calls of a stereo frame, without copies and clears. One value per round, at the setting's first frame.
pub const DRAW_CALLS: &str = "draw_calls";
/// Size of the textures that the contender holds after its first frame, computed from their formats, in MiB; one value.
pub const TEXTURE_MIB: &str = "texture_mib";
/// The same plus the resident memory of the process with the scene loaded and no contender made, in MiB; one value.
pub const MEMORY_MIB: &str = "memory_mib";

/// PSNR of red, green and blue in dB; null for identical images.
pub const PSNR: &str = "psnr";
/// Bit rate of a stream in kbit/s (1000 bits) at 72 frames per second, without the first, intra frame; one value.
pub const KBIT_S: &str = "kbit_s";
/// Bits that a stream saves compared with two eyes at the same quantizer, in per cent; one value.
pub const SAVED: &str = "saved";
/// PSNR of luma in dB.
pub const PSNR_LUMA: &str = "psnr_luma";
/// SSIM, gaussian 11x11, mean of red, green and blue.
pub const SSIM: &str = "ssim";
/// SSIM of luma, gaussian 11x11.
pub const SSIM_LUMA: &str = "ssim_luma";
/// SSIM, uniform 7x7, mean of red, green and blue.
pub const SSIM_UNIFORM: &str = "ssim_uniform";
/// LDR-FLIP, mean over the image, 0 (equal) to 1.
pub const FLIP: &str = "flip";
/// Share of the pixels that the dominant eye's own image does not show, 0 to 1; the same for all contenders.
pub const HOLE_SHARE: &str = "hole_share";
/// Share of the pixels that the synthesis leaves open for the scene to be rendered there, 0 to 1.
pub const OPEN_SHARE: &str = "open_share";
/// PSNR (RGB) in the holes, in dB.
pub const HOLE_PSNR: &str = "hole_psnr";
/// SSIM (gaussian, RGB) in the holes.
pub const HOLE_SSIM: &str = "hole_ssim";
/// FLIP in the holes.
pub const HOLE_FLIP: &str = "hole_flip";
/// PSNR (RGB) outside of the holes, in dB.
pub const VISIBLE_PSNR: &str = "visible_psnr";
/// SSIM (gaussian, RGB) outside of the holes.
pub const VISIBLE_SSIM: &str = "visible_ssim";
/// PSNR (RGB) within 3 pixels of what moves in the scene, in dB.
pub const MOVING_PSNR: &str = "moving_psnr";
/// FLIP outside of the holes.
pub const VISIBLE_FLIP: &str = "visible_flip";

/// Flicker over all pixels, out of 255; see [`yoro_metrics::Flicker`]. This metric and the following have one value
/// per pair of consecutive frames, so one less than there are frames.
pub const FLICKER: &str = "flicker";
/// Flicker in the holes of either frame.
pub const FLICKER_HOLES: &str = "flicker_holes";
/// Flicker at the edges of the ground truth, outside of holes.
pub const FLICKER_EDGES: &str = "flicker_edges";
/// Flicker everywhere else.
pub const FLICKER_REST: &str = "flicker_rest";
/// Change of the ground truth from frame to frame over all pixels, out of 255, for comparison with flicker.
pub const CHANGE: &str = "change";
/// Change of the ground truth in the holes of either frame.
pub const CHANGE_HOLES: &str = "change_holes";
/// Change of the ground truth at its edges, outside of holes.
pub const CHANGE_EDGES: &str = "change_edges";
/// Change of the ground truth everywhere else.
pub const CHANGE_REST: &str = "change_rest";

/// The flicker metrics: all pixels, holes, edges, the rest.
pub const FLICKERS: [&str; 4] = [FLICKER, FLICKER_HOLES, FLICKER_EDGES, FLICKER_REST];
/// The corresponding metrics of the ground truth, measured for `conventional`.
pub const CHANGES: [&str; 4] = [CHANGE, CHANGE_HOLES, CHANGE_EDGES, CHANGE_REST];

/// Pixels that are rendered, of those of two full eyes.
pub const SHADED: &str = "shaded";
/// PSNR (RGB) in dB and SSIM (gaussian, RGB) within 20 degrees of the axis, against a full render.
pub const FOVEA: [&str; 2] = ["fovea_psnr", "fovea_ssim"];
/// The same beyond the inset of the level.
pub const PERIPHERY: [&str; 2] = ["periphery_psnr", "periphery_ssim"];
/// The same beyond the inset, against a render with the same levels.
pub const ALIKE: [&str; 2] = ["alike_psnr", "alike_ssim"];
/// The same within 3 pixels of silhouettes.
pub const SILHOUETTES: [&str; 2] = ["silhouettes_psnr", "silhouettes_ssim"];
/// Flicker beyond the inset from a frame to one 4.5 cm ahead, against two full renders, out of 255: of the eye that is
/// rendered, and of the one that is synthesized.
pub const PERIPHERY_FLICKER: [&str; 2] = ["periphery_flicker_rendered", "periphery_flicker"];

/// Wall-clock time of patching alone in ms, with the image in the memory in which the patcher works.
pub const PATCH_MS: &str = "patch_ms";
/// Time of the upload before and the readback after patching in ms; 0 for patchers on the CPU.
pub const PATCH_TRANSFER_MS: &str = "patch_transfer_ms";
