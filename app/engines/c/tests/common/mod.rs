//! Shared beginnings of the tests: valid structures, and their callback.

#![allow(dead_code, reason = "no test needs all of it")]

use std::ffi::{CStr, c_char, c_void};
use std::mem::MaybeUninit;

use glow::HasContext;
use yoro::eyes::{DepthRange, Eye, EyePair, Frustum, Pose};
use yoro_c::*;

/// A change that makes an argument wrong, and the code that the function then returns.
pub type Mistakes<'a, T> = [(&'a dyn Fn(&mut T), YoroResult)];

/// Makes each mistake in a structure that is right, and checks the code that is returned then.
#[track_caller]
pub fn check_codes<T: Copy>(good: &T, mistakes: &Mistakes<T>, call: impl Fn(&T) -> YoroResult) {
    for (i, (change, expected)) in mistakes.iter().enumerate() {
        let mut wrong = *good;
        change(&mut wrong);
        assert_eq!(call(&wrong), *expected, "row {i}");
    }
}

/// Returns what a function has written, or the code of its failure.
pub fn outcome<T>(code: YoroResult, written: T) -> Result<T, YoroResult> {
    if code == YORO_OK { Ok(written) } else { Err(code) }
}

/// A fixed sequence of numbers that often reveal mistakes (SplitMix64).
pub struct Random(pub u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    pub fn below(&mut self, limit: usize) -> usize {
        (self.next() % limit as u64) as usize
    }

    pub fn pick<T: Copy>(&mut self, from: &[T]) -> T {
        from[self.below(from.len())]
    }

    /// Returns a special number, an integer or a number between -2 and 2.
    pub fn word(&mut self) -> u32 {
        let special = [f32::NAN, f32::INFINITY, -1.0, f32::MAX, f32::MIN_POSITIVE].map(f32::to_bits);
        match self.below(4) {
            0 => self.pick(&special),
            1 => self.pick(&[0, 1, 2, 7, u32::MAX, 1 << 20]),
            2 => self.next() as u32,
            _ => (self.below(4001) as f32 / 1000.0 - 2.0).to_bits(),
        }
    }

    /// Returns a structure of which up to three words, behind the first bytes, are replaced. It has no pointers there, or
    /// the caller replaces them.
    pub fn damaged<T: Copy>(&mut self, value: &T, from: usize) -> T {
        let mut copy = *value;
        for _ in 0..self.below(4) {
            let place = from + 4 * self.below((size_of::<T>() - from) / 4);
            let word = self.word();
            // SAFETY: the write stays within the structure, whose numbers may have any bits.
            unsafe { (&raw mut copy).cast::<u8>().add(place).cast::<u32>().write_unaligned(word) };
        }
        copy
    }
}

/// True for the results of wrong arguments: no fault of the library, of the driver or of the device.
pub fn is_documented(code: YoroResult) -> bool {
    let faults = [YORO_ERROR_DRIVER, YORO_ERROR_DEVICE_LOST, YORO_ERROR_INTERNAL, YORO_ERROR_BUSY];
    (YORO_ERROR_INTERNAL..=YORO_OK).contains(&code) && !faults.contains(&code)
}

/// Returns a structure of zeros, which are valid for all structures of the interface, with its size set.
pub fn zeroed<T>(size: impl FnOnce(&mut T) -> &mut u32) -> T {
    // SAFETY: the structures have only numbers, handles and nullable pointers, for which zeros are valid.
    let mut value = unsafe { MaybeUninit::<T>::zeroed().assume_init() };
    *size(&mut value) = size_of::<T>() as u32;
    value
}

pub unsafe extern "C" fn note(user: *mut c_void, result: YoroResult, sentence: *const c_char) {
    // SAFETY: the vector that `messages` was given, and a C string.
    unsafe {
        let noted = &mut *user.cast::<Vec<(YoroResult, String)>>();
        noted.push((result, CStr::from_ptr(sentence).to_str().unwrap().to_owned()));
    }
}

pub fn messages(noted: &mut Vec<(YoroResult, String)>) -> YoroMessages {
    YoroMessages { callback: Some(note), user: (&raw mut *noted).cast() }
}

pub fn good_eyes() -> YoroEyes {
    let mut eyes: YoroEyes = zeroed(|e: &mut YoroEyes| &mut e.struct_size);
    (eyes.rendered, eyes.width, eyes.height) = (YORO_EYE_RIGHT, 160, 120);
    for (i, (pose, fov)) in eyes.poses.iter_mut().zip(&mut eyes.fovs).enumerate() {
        *pose =
            YoroPose { orientation: [0.0, 0.0, 0.0, 1.0], position: [0.063 * (i as f32 - 0.5), 1.6, 0.0] };
        *fov = YoroFov { angle_left: -0.8, angle_right: 0.8, angle_up: 0.6, angle_down: -0.6 };
    }
    (eyes.near_z, eyes.far_z, eyes.guard_band) = (0.1, 100.0, 1.0);
    eyes
}

pub fn views_of(eyes: &YoroEyes) -> Result<YoroViews, YoroResult> {
    let mut views: YoroViews = zeroed(|v: &mut YoroViews| &mut v.struct_size);
    // SAFETY: both are whole structures of the sizes that they state.
    outcome(unsafe { yoro_views_from_eyes(eyes, &mut views) }, views)
}

/// Returns the warps of motion to the other eye and to the rendered one.
pub fn motion_of(
    eyes: &YoroEyes,
    previous: &YoroEyes,
    vectors: YoroVectors,
) -> Result<[YoroMotionWarp; 2], YoroResult> {
    let mut motion: YoroMotion = zeroed(|m: &mut YoroMotion| &mut m.struct_size);
    (motion.eyes, motion.previous, motion.vectors) = (eyes, previous, vectors);
    let mut warps = [YoroMotionWarp::default(); 2];
    let [other, own] = &mut warps;
    // SAFETY: complete structures.
    outcome(unsafe { yoro_motion_warp(&motion, other, own) }, warps)
}

/// Returns the levels of foveated eyes, the wide one and the inset, and both eyes' compositions.
pub fn levels_of(
    eyes: &YoroEyes,
    foveation: &YoroFoveation,
) -> Result<([YoroViews; 2], [YoroComposition; 2]), YoroResult> {
    let mut views = [0; 2].map(|_| zeroed(|v: &mut YoroViews| &mut v.struct_size));
    let mut compositions = [YoroComposition::default(); 2];
    let [wide, inset] = &mut views;
    // SAFETY: complete structures.
    let code = unsafe { yoro_levels_from_eyes(eyes, foveation, wide, inset, compositions.as_mut_ptr()) };
    outcome(code, (views, compositions))
}

/// Returns a foveation of middle strength.
pub fn medium() -> YoroFoveation {
    let mut foveation: YoroFoveation = zeroed(|f: &mut YoroFoveation| &mut f.struct_size);
    foveation.level = YORO_FOVEATION_MEDIUM;
    foveation
}

/// Returns the warp from one view to another.
pub fn pose_warp_of(poses: &YoroPoses) -> Result<YoroPoseWarp, YoroResult> {
    let mut warp = YoroPoseWarp::default();
    // SAFETY: complete structures, and what is refused.
    outcome(unsafe { yoro_pose_warp(poses, &mut warp) }, warp)
}

/// Returns eyes with a depth buffer from 0 to 1 for the core.
pub fn core(eyes: &YoroEyes) -> EyePair {
    let depth = DepthRange::from_distances(eyes.near_z, eyes.far_z);
    let fov = |f: YoroFov| Frustum::from_fov(f.angle_left, f.angle_right, f.angle_up, f.angle_down);
    let pose = |p: YoroPose| Pose {
        position: p.position.into(),
        orientation: glam::Quat::from_array(p.orientation),
    };
    let size = [eyes.width, eyes.height];
    EyePair { poses: eyes.poses.map(pose), frusta: eyes.fovs.map(fov), depth, size, dominant: Eye::Right }
}

pub fn matrices_of(views: &YoroViews, eyes: &YoroEyes) -> YoroMatrices {
    let mut matrices: YoroMatrices = zeroed(|m: &mut YoroMatrices| &mut m.struct_size);
    (matrices.rendered, matrices.width, matrices.height) = (eyes.rendered, eyes.width, eyes.height);
    let (own, other) = (eyes.rendered as usize, 1 - eyes.rendered as usize);
    for (eye, image) in [(own, &views.rendered), (other, &views.synthesized)] {
        (matrices.view[eye], matrices.projection[eye]) = (image.view, image.projection);
    }
    (matrices.clip, matrices.rows, matrices.guard_band) = (eyes.clip, eyes.rows, eyes.guard_band);
    matrices
}

/// Returns the same eyes in a left-handed world, in centimetres, looking along +Z.
pub fn left_handed(mut matrices: YoroMatrices) -> YoroMatrices {
    for (view, projection) in matrices.view.iter_mut().zip(&mut matrices.projection) {
        (0..4).for_each(|column| view[4 * column + 2] *= -1.0);
        (8..12).for_each(|i| view[i] *= -1.0);
        (8..12).for_each(|i| projection[i] *= -1.0);
        (12..15).for_each(|i| view[i] *= 100.0);
        projection[14] *= 100.0;
    }
    matrices.units_per_metre = 100.0;
    matrices
}

pub fn views_of_matrices(matrices: &YoroMatrices) -> Result<YoroViews, YoroResult> {
    let mut views: YoroViews = zeroed(|v: &mut YoroViews| &mut v.struct_size);
    // SAFETY: both are whole structures of the sizes that they state.
    outcome(unsafe { yoro_views_from_matrices(matrices, &mut views) }, views)
}

/// The loader for the current context.
pub unsafe extern "C" fn load(name: *const c_char) -> YoroGlProc {
    type GetProcAddress = unsafe extern "C" fn(*const c_char) -> YoroGlProc;
    // SAFETY: libEGL is loaded, since one of its contexts is current, and it is never unloaded.
    unsafe {
        let library = libloading::Library::new("libEGL.so.1").unwrap();
        let get = *library.get::<GetProcAddress>(b"eglGetProcAddress\0").unwrap();
        std::mem::forget(library);
        get(name)
    }
}

pub fn gl_info(noted: &mut Vec<(YoroResult, String)>) -> YoroGlInfo {
    let mut info: YoroGlInfo = zeroed(|i: &mut YoroGlInfo| &mut i.struct_size);
    info.loader = Some(load);
    (info.check, info.state) = (1, YORO_GL_STATE_PRESERVE);
    info.messages = messages(noted);
    info
}

/// Creates a texture with one mip level.
///
/// # Safety
/// The context is current.
pub unsafe fn texture(gl: &glow::Context, target: u32, format: u32, [w, h]: [u32; 2]) -> u32 {
    // SAFETY: the context is current; format and sizes are valid.
    unsafe {
        let texture = gl.create_texture().unwrap();
        gl.bind_texture(target, Some(texture));
        match target {
            glow::TEXTURE_2D => gl.tex_storage_2d(target, 1, format, w as i32, h as i32),
            glow::TEXTURE_2D_MULTISAMPLE => {
                gl.tex_storage_2d_multisample(target, 4, format, w as i32, h as i32, true);
            }
            _ => gl.tex_storage_3d(target, 1, format, w as i32, h as i32, 2),
        }
        gl.bind_texture(target, None);
        texture.0.get()
    }
}

/// Creates a framebuffer of two textures.
///
/// # Safety
/// As for [`texture`].
pub unsafe fn framebuffer(gl: &glow::Context, attachments: &[(u32, u32)]) -> u32 {
    // SAFETY: live textures.
    unsafe {
        let framebuffer = gl.create_framebuffer().unwrap();
        gl.bind_framebuffer(glow::FRAMEBUFFER, Some(framebuffer));
        for &(attachment, texture) in attachments {
            let texture = std::num::NonZeroU32::new(texture).map(glow::NativeTexture);
            gl.framebuffer_texture_2d(glow::FRAMEBUFFER, attachment, glow::TEXTURE_2D, texture, 0);
        }
        gl.bind_framebuffer(glow::FRAMEBUFFER, None);
        framebuffer.0.get()
    }
}

/// Creates a context.
pub fn create(info: &YoroGlInfo) -> Result<*mut YoroContext, YoroResult> {
    let mut context = std::ptr::null_mut();
    // SAFETY: a complete structure, and a context is current.
    outcome(unsafe { yoro_gl_create(info, &mut context) }, context)
}

/// Creates textures of a source of this format and size, and a framebuffer with colour and depth to draw into.
pub fn images(gl: &glow::Context, format: u32, size: [u32; 2], target_size: [u32; 2]) -> YoroGlImages {
    let mut images: YoroGlImages = zeroed(|i: &mut YoroGlImages| &mut i.struct_size);
    // SAFETY: the context is current; textures and framebuffer are its own.
    unsafe {
        let made = |format, size| texture(gl, glow::TEXTURE_2D, format, size);
        (images.color_texture, images.depth_texture) =
            (made(format, size), made(glow::DEPTH_COMPONENT24, size));
        let (color, depth) = (made(format, target_size), made(glow::DEPTH_COMPONENT24, target_size));
        images.framebuffer =
            framebuffer(gl, &[(glow::COLOR_ATTACHMENT0, color), (glow::DEPTH_ATTACHMENT, depth)]);
    }
    images
}
