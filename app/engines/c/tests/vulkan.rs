//! Wrong arguments on Vulkan return the codes that the header promises.

#![cfg(feature = "vulkan")]

mod common;

use std::ffi::c_char;
use std::ptr::{null, null_mut};

use ash::vk;
use common::{Mistakes, Random, check_codes, is_documented, zeroed};
use yoro_c::*;

/// A device with a command buffer that is being recorded. It lives as long as the process.
struct Gpu {
    entry: ash::Entry,
    instance: ash::Instance,
    physical_device: vk::PhysicalDevice,
    device: ash::Device,
    commands: vk::CommandBuffer,
}

impl Gpu {
    fn open() -> Option<Gpu> {
        if std::env::var_os("YORO_TEST_WITHOUT_VULKAN").is_some() {
            println!("LEFT OUT: Vulkan");
            return None;
        }
        // SAFETY: all handles are made here, from valid descriptions, and used while they live.
        unsafe {
            let entry = ash::Entry::load().expect("no Vulkan here: set YORO_TEST_WITHOUT_VULKAN=1");
            let application = vk::ApplicationInfo::default().api_version(vk::API_VERSION_1_1);
            let info = vk::InstanceCreateInfo::default().application_info(&application);
            let instance = entry.create_instance(&info, None).unwrap();
            let physical_device = instance.enumerate_physical_devices().unwrap()[0];
            let queues = [vk::DeviceQueueCreateInfo::default().queue_priorities(&[1.0])];
            let info = vk::DeviceCreateInfo::default().queue_create_infos(&queues);
            let device = instance.create_device(physical_device, &info, None).unwrap();
            let pool = device.create_command_pool(&vk::CommandPoolCreateInfo::default(), None).unwrap();
            let info = vk::CommandBufferAllocateInfo::default().command_pool(pool).command_buffer_count(1);
            let commands = device.allocate_command_buffers(&info).unwrap()[0];
            device.begin_command_buffer(commands, &vk::CommandBufferBeginInfo::default()).unwrap();
            Some(Gpu { entry, instance, physical_device, device, commands })
        }
    }

    fn image(&self, format: vk::Format, usage: vk::ImageUsageFlags, [width, height]: [u32; 2]) -> vk::Image {
        let info = vk::ImageCreateInfo::default()
            .image_type(vk::ImageType::TYPE_2D)
            .format(format)
            .extent(vk::Extent3D { width, height, depth: 1 })
            .mip_levels(1)
            .array_layers(1)
            .samples(vk::SampleCountFlags::TYPE_1)
            .usage(usage | vk::ImageUsageFlags::SAMPLED);
        // SAFETY: a valid description; memory of the size and of a type that the image accepts.
        unsafe {
            let image = self.device.create_image(&info, None).unwrap();
            let needs = self.device.get_image_memory_requirements(image);
            let info = vk::MemoryAllocateInfo::default()
                .allocation_size(needs.size)
                .memory_type_index(needs.memory_type_bits.trailing_zeros());
            let memory = self.device.allocate_memory(&info, None).unwrap();
            self.device.bind_image_memory(image, memory, 0).unwrap();
            image
        }
    }

    /// Ends the command buffer, executes it and waits.
    ///
    /// # Safety
    /// The command buffer is being recorded, and everything that it uses is alive.
    unsafe fn execute(&self) {
        // SAFETY: the caller's commands.
        unsafe {
            self.device.end_command_buffer(self.commands).unwrap();
            let buffers = [self.commands];
            let submit = [vk::SubmitInfo::default().command_buffers(&buffers)];
            let queue = self.device.get_device_queue(0, 0);
            self.device.queue_submit(queue, &submit, vk::Fence::null()).unwrap();
            self.device.device_wait_idle().unwrap();
        }
    }

    fn info(&self) -> YoroVkInfo {
        let mut info: YoroVkInfo = zeroed(|i: &mut YoroVkInfo| &mut i.struct_size);
        // SAFETY: the signatures differ only in the name of the calling convention, which is C's.
        info.loader = unsafe {
            std::mem::transmute::<vk::PFN_vkGetInstanceProcAddr, YoroVkLoader>(
                self.entry.static_fn().get_instance_proc_addr,
            )
        };
        (info.instance, info.physical_device) = (self.instance.handle(), self.physical_device);
        info.device = self.device.handle();
        (info.color_format, info.depth_format) = (vk::Format::R8G8B8A8_UNORM, vk::Format::D32_SFLOAT);
        (info.max_source_width, info.max_source_height) = (256, 128);
        (info.max_target_width, info.max_target_height) = (160, 120);
        info
    }
}

unsafe extern "C" fn load_nothing(_: vk::Instance, _: *const c_char) -> Option<unsafe extern "C" fn()> {
    None
}

/// Validation layers return the commands of an extension from a device's table even if the extension is not enabled.
mod labels {
    use super::*;
    use std::ffi::{CStr, c_void};
    use std::mem::transmute;
    use std::sync::atomic::{AtomicUsize, Ordering};

    static CALLS: AtomicUsize = AtomicUsize::new(0);

    unsafe extern "system" fn begin(_: vk::CommandBuffer, _: *const c_void) {
        CALLS.fetch_add(1, Ordering::Relaxed);
    }

    unsafe extern "system" fn end(_: vk::CommandBuffer) {}

    unsafe extern "system" fn of_device(device: vk::Device, name: *const c_char) -> vk::PFN_vkVoidFunction {
        // SAFETY: a live device and a name; both functions have the signatures of their commands.
        unsafe {
            match CStr::from_ptr(name).to_str().unwrap() {
                "vkCmdBeginDebugUtilsLabelEXT" => {
                    transmute::<*const (), vk::PFN_vkVoidFunction>(begin as *const ())
                }
                "vkCmdEndDebugUtilsLabelEXT" => {
                    transmute::<*const (), vk::PFN_vkVoidFunction>(end as *const ())
                }
                _ => {
                    let own = ash::Entry::load().unwrap();
                    let get = own.static_fn().get_instance_proc_addr;
                    let _kept = std::mem::ManuallyDrop::new(own);
                    let instance = INSTANCE.get().copied().unwrap_or_default();
                    let get = get(vk::Handle::from_raw(instance), c"vkGetDeviceProcAddr".as_ptr());
                    transmute::<vk::PFN_vkVoidFunction, vk::PFN_vkGetDeviceProcAddr>(get)(device, name)
                }
            }
        }
    }

    static INSTANCE: std::sync::OnceLock<u64> = std::sync::OnceLock::new();

    unsafe extern "C" fn of_instance(
        instance: vk::Instance,
        name: *const c_char,
    ) -> Option<unsafe extern "C" fn()> {
        // SAFETY: a live instance and a name.
        unsafe {
            if CStr::from_ptr(name) == c"vkGetDeviceProcAddr" {
                return transmute::<*const (), Option<unsafe extern "C" fn()>>(of_device as *const ());
            }
            let own = ash::Entry::load().unwrap();
            let get = own.static_fn().get_instance_proc_addr;
            let _kept = std::mem::ManuallyDrop::new(own);
            transmute::<vk::PFN_vkVoidFunction, Option<unsafe extern "C" fn()>>(get(instance, name))
        }
    }

    #[test]
    fn no_command_of_an_extension_that_is_not_enabled_is_called() {
        let Some(gpu) = Gpu::open() else { return };
        INSTANCE.set(vk::Handle::as_raw(gpu.instance.handle())).unwrap();
        let context = create(&YoroVkInfo { loader: Some(of_instance), ..gpu.info() }).unwrap();
        let frame = registered(&gpu, context);
        // SAFETY: live handles; the command buffer is never submitted.
        unsafe {
            assert_eq!(yoro_vk_record(context, gpu.commands, &WARP, &frame), YORO_OK);
            assert_eq!(CALLS.load(Ordering::Relaxed), 0);
            gpu.device.end_command_buffer(gpu.commands).unwrap();
            assert_eq!(yoro_destroy(context), YORO_OK);
        }
    }
}

/// A warp that fits the images of [`registered`].
const WARP: YoroWarp = YoroWarp {
    source_width: 200,
    source_height: 120,
    target_width: 160,
    target_height: 120,
    offset: -2.0,
    scale: 12.0,
    row_offset: 0,
    target_eye: YORO_EYE_LEFT,
    depth: YORO_DEPTH_REVERSED,
    reserved: 0,
};

/// A warp between views of the same orientation, the target a little to the right.
const POSE_WARP: YoroPoseWarp = YoroPoseWarp {
    source_width: 200,
    source_height: 120,
    target_width: 160,
    target_height: 120,
    homography: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 20.0, 0.0, 1.0],
    epipole: [5.0, 0.0, 0.0],
    source_law: [0.0, 10.0],
    target_law: [0.0, 10.0],
    nearest: 1.0,
    far_depth: 0.0,
};

/// Returns a source and a target of 256 x 128 pixels, not registered yet.
fn images(gpu: &Gpu) -> (YoroVkSource, YoroVkTarget) {
    let color = gpu.image(vk::Format::R8G8B8A8_UNORM, vk::ImageUsageFlags::COLOR_ATTACHMENT, [256, 128]);
    let depth = gpu.image(vk::Format::D32_SFLOAT, vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT, [256, 128]);
    let (color, depth) = (plane(color, vk::Format::R8G8B8A8_UNORM), plane(depth, vk::Format::D32_SFLOAT));
    let mut source: YoroVkSource = zeroed(|s: &mut YoroVkSource| &mut s.struct_size);
    (source.width, source.height, source.color, source.depth) = (256, 128, color, depth);
    let mut target: YoroVkTarget = zeroed(|t: &mut YoroVkTarget| &mut t.struct_size);
    (target.width, target.height, target.color, target.depth) = (256, 128, color, depth);
    (source, target)
}

/// Registers [`images`], and returns a frame with them.
fn registered(gpu: &Gpu, context: *mut YoroContext) -> YoroVkFrame {
    let (source, target) = images(gpu);
    let mut frame: YoroVkFrame = zeroed(|f: &mut YoroVkFrame| &mut f.struct_size);
    // SAFETY: live images and complete structures.
    unsafe {
        assert_eq!(yoro_vk_register_source(context, &source, &mut frame.source), YORO_OK);
        assert_eq!(yoro_vk_register_target(context, &target, &mut frame.target), YORO_OK);
    }
    frame
}

#[test]
fn uses_memory_and_times_are_those_of_the_core() {
    let Some(gpu) = Gpu::open() else { return };
    let info = YoroVkInfo { timed_frames: 1, ..gpu.info() };
    let mut bytes = 0;
    // Neither handles nor a loader are needed.
    let plan = YoroVkInfo { loader: None, device: vk::Device::null(), ..info };
    // SAFETY: complete structures, and null pointers, which are refused.
    unsafe {
        assert_eq!(yoro_vk_buffer_bytes(&plan, &mut bytes), YORO_OK);
        assert_eq!(bytes, 16 * (16 + 10) * 16);
        assert_eq!(yoro_vk_buffer_bytes(&plan, null_mut()), YORO_ERROR_NULL);
        assert_eq!(yoro_vk_buffer_bytes(null(), &mut bytes), YORO_ERROR_NULL);
    }
    let context = create(&info).unwrap();
    let frame = registered(&gpu, context);
    let general = YoroVkUse { before: ATTACHMENT, after: ATTACHMENT };
    let mut uses: YoroVkUses = zeroed(|u: &mut YoroVkUses| &mut u.struct_size);
    (uses.source_color, uses.source_depth) = (general, general);
    (uses.target_color, uses.target_depth) = (general, general);
    let record = |uses: &YoroVkUses| {
        // SAFETY: live handles and complete structures.
        unsafe { yoro_vk_record(context, gpu.commands, &WARP, &YoroVkFrame { uses, ..frame }) }
    };
    let discarded = YoroVkState { layout: vk::ImageLayout::UNDEFINED, ..ATTACHMENT };
    let table: &Mistakes<YoroVkUses> = &[
        (&|u| u.struct_size = 3, YORO_ERROR_STRUCT_SIZE),
        (&|u| u.source_depth.before = discarded, YORO_ERROR_VALUE),
        (&|u| u.target_color.after = discarded, YORO_ERROR_VALUE),
        (&|u| u.target_color.before = discarded, YORO_OK),
    ];
    check_codes(&uses, table, record);
    let mut times: YoroTimes = zeroed(|t: &mut YoroTimes| &mut t.struct_size);
    // SAFETY: live handles; the commands have been executed before the last lines.
    unsafe {
        let other = YoroVkFrame { reserved: 1, ..frame };
        assert_eq!(yoro_vk_record(context, gpu.commands, &WARP, &other), YORO_ERROR_VALUE);
        assert_eq!(yoro_times(context, null_mut()), YORO_ERROR_NULL);
        gpu.execute();
        assert_eq!(yoro_times(context, &mut times), YORO_OK);
        assert_eq!(yoro_destroy(context), YORO_OK);
    }
    assert!(times.is_known == 1 && times.march_ns > 0, "{times:?}");
}

#[test]
fn a_context_of_any_pose_records_pose_warps() {
    let Some(gpu) = Gpu::open() else { return };
    let info = YoroVkInfo { warp_kind: YORO_WARP_KIND_POSE, ..gpu.info() };
    assert_eq!(create(&YoroVkInfo { warp_kind: 3, ..info }), Err(YORO_ERROR_VALUE));
    let (warp, mut bytes) = (POSE_WARP, 0);
    // SAFETY: live handles and complete structures, and null pointers, which are refused.
    unsafe {
        assert_eq!(yoro_vk_buffer_bytes(&info, &mut bytes), YORO_OK);
        assert_eq!(bytes, 16 * (16 * 16 + 10 * 15));
        let context = create(&info).unwrap();
        let frame = registered(&gpu, context);
        let record = |warp| yoro_vk_record_pose(context, gpu.commands, warp, &frame);
        assert_eq!(record(&warp), YORO_OK);
        assert_eq!(record(null()), YORO_ERROR_NULL);
        assert_eq!(record(&YoroPoseWarp { source_width: 257, ..warp }), YORO_ERROR_TOO_LARGE);
        assert_eq!(record(&YoroPoseWarp { nearest: f64::NAN, ..warp }), YORO_ERROR_VALUE);
        assert_eq!(record(&YoroPoseWarp { homography: [0.0; 9], ..warp }), YORO_ERROR_VALUE);
        let no_commands = vk::CommandBuffer::null();
        assert_eq!(yoro_vk_record_pose(context, no_commands, &warp, &frame), YORO_ERROR_NULL);
        assert_eq!(yoro_vk_record(context, gpu.commands, &WARP, &frame), YORO_ERROR_VALUE);
        let eyes = create(&gpu.info()).unwrap();
        let of_eyes = registered(&gpu, eyes);
        assert_eq!(yoro_vk_record_pose(eyes, gpu.commands, &warp, &of_eyes), YORO_ERROR_VALUE);
        gpu.execute();
        assert_eq!(yoro_destroy(context), YORO_OK);
        assert_eq!(yoro_destroy(eyes), YORO_OK);
    }
}

/// Which pixels are open, and their marks, are compared with a reference in the core's tests.
#[test]
fn holes_are_left_open_with_either_mark() {
    let Some(gpu) = Gpu::open() else { return };
    let marks = [
        (YORO_OUTPUT_OPEN_STENCIL, vk::Format::D32_SFLOAT_S8_UINT),
        (YORO_OUTPUT_OPEN_DEPTH, vk::Format::D32_SFLOAT),
    ];
    let contexts = marks.map(|(holes, depth_format)| {
        let context = create(&YoroVkInfo { holes, depth_format, ..gpu.info() }).unwrap();
        let (source, mut target) = images(&gpu);
        let usage = vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT;
        target.depth = plane(gpu.image(depth_format, usage, [256, 128]), depth_format);
        let mut frame: YoroVkFrame = zeroed(|f: &mut YoroVkFrame| &mut f.struct_size);
        // SAFETY: live handles and complete structures.
        unsafe {
            assert_eq!(yoro_vk_register_source(context, &source, &mut frame.source), YORO_OK);
            assert_eq!(yoro_vk_register_target(context, &target, &mut frame.target), YORO_OK);
            assert_eq!(yoro_vk_record(context, gpu.commands, &WARP, &frame), YORO_OK);
        }
        context
    });
    // SAFETY: nothing is pending afterwards.
    unsafe {
        gpu.execute();
        assert!(contexts.into_iter().all(|context| yoro_destroy(context) == YORO_OK));
    }
}

/// Pictures of the composer on Vulkan are compared in the core's tests.
#[test]
fn a_context_with_a_composer_records_compositions() {
    let Some(gpu) = Gpu::open() else { return };
    let info = YoroVkInfo { composes: 1, ..gpu.info() };
    let (source, target) = images(&gpu);
    let mut levels: YoroVkLevels = zeroed(|l: &mut YoroVkLevels| &mut l.struct_size);
    (levels.wide_width, levels.wide_height, levels.wide) = (256, 128, source.color);
    (levels.inset_width, levels.inset_height, levels.inset) = (256, 128, source.color);
    (levels.has_depth, levels.inset_depth) = (1, source.depth);
    let composition = YoroComposition {
        width: 160,
        height: 120,
        wide_width: 80,
        wide_height: 60,
        wide_scale: [1.0; 2],
        inset_width: 40,
        inset_height: 30,
        inset_scale: [4.0; 2],
        inset_offset: [-1.5; 2],
        inset_source: [1.6, -0.8, 0.3],
        ..YoroComposition::default()
    };
    let mut frame: YoroVkComposed = zeroed(|f: &mut YoroVkComposed| &mut f.struct_size);
    // SAFETY: live handles and complete structures, and null pointers, which are refused.
    unsafe {
        let context = create(&info).unwrap();
        let written =
            gpu.image(vk::Format::R8G8B8A8_UNORM, vk::ImageUsageFlags::COLOR_ATTACHMENT, [256, 128]);
        let target = YoroVkTarget { color: plane(written, vk::Format::R8G8B8A8_UNORM), ..target };
        assert_eq!(yoro_vk_register_levels(context, &levels, &mut frame.levels), YORO_OK);
        assert_eq!(yoro_vk_register_composed(context, &target, &mut frame.target), YORO_OK);
        let record = |composition: &YoroComposition, frame: &YoroVkComposed| {
            yoro_vk_compose(context, gpu.commands, composition, frame)
        };
        assert_eq!(record(&composition, &frame), YORO_OK);
        let far = YoroVkComposed { inset_x: 230, ..frame };
        assert_eq!(record(&composition, &far), YORO_ERROR_TOO_LARGE);
        assert_eq!(record(&composition, &YoroVkComposed { levels: 99, ..frame }), YORO_ERROR_NOT_REGISTERED);
        assert_eq!(record(&YoroComposition { width: 0, ..composition }, &frame), YORO_ERROR_VALUE);
        assert_eq!(yoro_vk_compose(context, gpu.commands, null(), &frame), YORO_ERROR_NULL);
        let wrong = YoroVkLevels { has_depth: 2, ..levels };
        assert_eq!(yoro_vk_register_levels(context, &wrong, &mut frame.levels), YORO_ERROR_VALUE);
        gpu.execute();
        assert_eq!(yoro_vk_release_levels(context, frame.levels), YORO_OK);
        assert_eq!(yoro_vk_release_composed(context, frame.target), YORO_OK);
        assert_eq!(yoro_destroy(context), YORO_OK);
        let plain = create(&gpu.info()).unwrap();
        assert_eq!(yoro_vk_register_levels(plain, &levels, &mut frame.levels), YORO_ERROR_UNSUPPORTED);
        assert_eq!(yoro_destroy(plain), YORO_OK);
    }
}

/// Damages an image's description. The image and its layer stay: they are Vulkan's to judge.
fn damaged_plane(random: &mut Random, image: YoroVkImage) -> YoroVkImage {
    let formats = [image.format.as_raw(), image.format.as_raw(), 0, -5, i32::MAX, 1 << 30];
    let uint = vk::Format::R8G8B8A8_UINT.as_raw();
    let format = vk::Format::from_raw(random.pick(&[&formats[..], &[uint]].concat()));
    let handle = random.pick(&[image.image, image.image, image.image, vk::Image::null()]);
    let mut state = |state: YoroVkState| if random.below(3) == 0 { random.damaged(&state, 0) } else { state };
    YoroVkImage { image: handle, format, before: state(image.before), after: state(image.after), ..image }
}

/// Random and special numbers, wrong ids and formats, in any order and in contexts of any kind: documented results, and
/// what is right is accepted afterwards.
#[test]
fn a_vulkan_host_may_pass_any_numbers() {
    const CALLS: usize = 8_000;
    let Some(gpu) = Gpu::open() else { return };
    let mut random = Random(3);
    let (source, target) = images(&gpu);
    let kinds = [YORO_WARP_KIND_EYES, YORO_WARP_KIND_POSE, YORO_WARP_KIND_MOTION];
    for _ in 0..60 {
        let mut wrong = YoroVkInfo { warp_kind: random.pick(&kinds), composes: 1, ..gpu.info() };
        let numbers: [fn(&mut YoroVkInfo, u32); 9] = [
            |i, n| i.color_format = vk::Format::from_raw(n as i32),
            |i, n| i.depth_format = vk::Format::from_raw(n as i32),
            |i, n| i.max_source_width = n,
            |i, n| i.max_target_height = n,
            |i, n| i.queue_family = n,
            |i, n| i.warp_kind = n,
            |i, n| i.composes = n,
            |i, n| i.holes = n,
            |i, n| i.timed_frames = n % 1000,
        ];
        (0..2).for_each(|_| random.pick(&numbers)(&mut wrong, random.word()));
        match create(&wrong) {
            // SAFETY: just made.
            Ok(context) => assert_eq!(unsafe { yoro_destroy(context) }, YORO_OK),
            Err(code) => assert!(is_documented(code), "{wrong:?}: {code}"),
        }
    }
    let info = YoroVkInfo { composes: 1, ..gpu.info() };
    let contexts = kinds.map(|warp_kind| create(&YoroVkInfo { warp_kind, ..info }).unwrap());
    let frames = contexts.map(|context| registered(&gpu, context));
    let motion = YoroMotionWarp { warp: WARP, ..YoroMotionWarp::default() };
    let mut accepted = 0;
    for number in 0..CALLS {
        let i = random.below(contexts.len());
        let (context, mut id) = (random.pick(&contexts), 0);
        // The pointer at the end stays null.
        let frame = YoroVkFrame { uses: null(), ..random.damaged(&frames[i], 4) };
        let commands = random.pick(&[gpu.commands, gpu.commands, gpu.commands, vk::CommandBuffer::null()]);
        let which = random.below(8);
        // SAFETY: live handles or null, complete structures, and numbers that are checked.
        let code = unsafe {
            match which {
                0 | 1 => {
                    let mut source = YoroVkSource {
                        color: source.color,
                        depth: source.depth,
                        ..random.damaged(&source, 0)
                    };
                    // The images' own size is Vulkan's to judge.
                    (source.width, source.height) = (source.width.min(256), source.height.min(128));
                    source.color = damaged_plane(&mut random, source.color);
                    let code = yoro_vk_register_source(context, &source, &mut id);
                    assert!(code != YORO_OK || yoro_vk_release_source(context, id) == YORO_OK);
                    code
                }
                2 => {
                    let color = damaged_plane(&mut random, target.color);
                    let depth = damaged_plane(&mut random, target.depth);
                    let target = YoroVkTarget { color, depth, ..target };
                    let code = yoro_vk_register_target(context, &target, &mut id);
                    assert!(code != YORO_OK || yoro_vk_release_target(context, id) == YORO_OK);
                    code
                }
                3 => yoro_vk_record_pose(context, commands, &random.damaged(&POSE_WARP, 0), &frame),
                4 => yoro_vk_record_motion(context, commands, &random.damaged(&motion, 0), &frame),
                5 => yoro_vk_release_source(context, random.word().max(1000)),
                6 => yoro_gl_prepare(context, &WARP),
                _ => yoro_vk_record(context, commands, &random.damaged(&WARP, 0), &frame),
            }
        };
        assert!(is_documented(code), "call {number}, {which}: {code}");
        accepted += usize::from(code == YORO_OK);
    }
    println!("{CALLS} calls, {accepted} accepted");
    assert!((CALLS / 10..CALLS * 9 / 10).contains(&accepted), "{accepted}");
    // SAFETY: live handles and complete structures; the commands are executed before the contexts go.
    unsafe {
        assert_eq!(yoro_vk_record(contexts[0], gpu.commands, &WARP, &frames[0]), YORO_OK);
        assert_eq!(yoro_vk_record_pose(contexts[1], gpu.commands, &POSE_WARP, &frames[1]), YORO_OK);
        assert_eq!(yoro_vk_record_motion(contexts[2], gpu.commands, &motion, &frames[2]), YORO_OK);
        gpu.device.end_command_buffer(gpu.commands).unwrap();
        assert!(contexts.into_iter().all(|context| yoro_destroy(context) == YORO_OK));
    }
}

fn create(info: &YoroVkInfo) -> Result<*mut YoroContext, YoroResult> {
    let mut context = null_mut();
    // SAFETY: a complete structure with live handles, or with what is refused.
    match unsafe { yoro_vk_create(info, &mut context) } {
        YORO_OK => Ok(context),
        code => {
            assert!(context.is_null());
            Err(code)
        }
    }
}

const ATTACHMENT: YoroVkState = YoroVkState {
    layout: vk::ImageLayout::GENERAL,
    stages: vk::PipelineStageFlags::ALL_COMMANDS,
    access: vk::AccessFlags::MEMORY_WRITE,
};

fn plane(image: vk::Image, format: vk::Format) -> YoroVkImage {
    YoroVkImage { image, format, layer: 0, before: ATTACHMENT, after: ATTACHMENT }
}

#[test]
fn wrong_vulkan_arguments_return_their_codes() {
    let Some(gpu) = Gpu::open() else { return };
    let info = gpu.info();
    let table: &Mistakes<YoroVkInfo> = &[
        (&|i| i.struct_size = 8, YORO_ERROR_STRUCT_SIZE),
        (&|i| i.loader = None, YORO_ERROR_NULL),
        (&|i| i.loader = Some(load_nothing), YORO_ERROR_NO_CONTEXT),
        (&|i| i.instance = vk::Instance::null(), YORO_ERROR_NULL),
        (&|i| i.physical_device = vk::PhysicalDevice::null(), YORO_ERROR_NULL),
        (&|i| i.device = vk::Device::null(), YORO_ERROR_NULL),
        (&|i| i.queue_family = 77, YORO_ERROR_UNSUPPORTED),
        (&|i| i.dynamic_rendering = 2, YORO_ERROR_VALUE),
        (&|i| i.color_format = vk::Format::UNDEFINED, YORO_ERROR_FORMAT),
        (&|i| i.color_format = vk::Format::from_raw(-5), YORO_ERROR_FORMAT),
        (&|i| i.color_format = vk::Format::from_raw(i32::MAX), YORO_ERROR_FORMAT),
        (&|i| i.color_format = vk::Format::BC7_SRGB_BLOCK, YORO_ERROR_FORMAT),
        (&|i| i.depth_format = vk::Format::R8G8B8A8_UNORM, YORO_ERROR_FORMAT),
        (&|i| i.depth_format = vk::Format::S8_UINT, YORO_ERROR_FORMAT),
        (&|i| i.max_source_width = 0, YORO_ERROR_VALUE),
        (&|i| i.max_target_height = 0, YORO_ERROR_VALUE),
        (&|i| i.composes = 7, YORO_ERROR_VALUE),
        (&|i| i.reserved = 1, YORO_ERROR_VALUE),
        (&|i| i.holes = YORO_OUTPUT_DEPTH, YORO_ERROR_VALUE),
        (&|i| i.holes = YORO_OUTPUT_OPEN_DEPTH | YORO_OUTPUT_OPEN_STENCIL, YORO_ERROR_VALUE),
        // Depth without stencil, no depth, and passes that open no holes.
        (&|i| i.holes = YORO_OUTPUT_OPEN_STENCIL, YORO_ERROR_UNSUPPORTED),
        (
            &|i| (i.holes, i.depth_format) = (YORO_OUTPUT_OPEN_DEPTH, vk::Format::UNDEFINED),
            YORO_ERROR_UNSUPPORTED,
        ),
        (&|i| (i.holes, i.warp_kind) = (YORO_OUTPUT_OPEN_DEPTH, YORO_WARP_KIND_POSE), YORO_ERROR_UNSUPPORTED),
        (&|i| i.max_target_height = u32::MAX, YORO_ERROR_TOO_LARGE),
    ];
    check_codes(&info, table, |wrong| create(wrong).unwrap_err());
    // SAFETY: null pointers are allowed, and refused with a code.
    unsafe {
        assert_eq!(yoro_vk_create(null(), &mut null_mut()), YORO_ERROR_NULL);
        assert_eq!(yoro_vk_create(&info, null_mut()), YORO_ERROR_NULL);
    }

    let context = create(&info).unwrap();
    let mut capabilities: YoroCapabilities = zeroed(|c: &mut YoroCapabilities| &mut c.struct_size);
    // SAFETY: alive, and a complete structure.
    assert_eq!(unsafe { yoro_capabilities(context, &mut capabilities) }, YORO_OK);
    assert_eq!((capabilities.api, capabilities.buffer_bytes), (YORO_API_VULKAN, 16 * (16 + 10) * 16));
    assert!(capabilities.device[0] != 0);

    let (source, target) = images(&gpu);
    let color = source.color;
    let mut frame: YoroVkFrame = zeroed(|f: &mut YoroVkFrame| &mut f.struct_size);
    let discarded = YoroVkState { layout: vk::ImageLayout::UNDEFINED, ..ATTACHMENT };
    let sources: &Mistakes<YoroVkSource> = &[
        (&|_| (), YORO_OK),
        (&|s| s.struct_size = 1, YORO_ERROR_STRUCT_SIZE),
        (&|s| s.width = 0, YORO_ERROR_VALUE),
        (&|s| s.width = 1 << 20, YORO_ERROR_TOO_LARGE),
        (&|s| s.reserved = 1, YORO_ERROR_VALUE),
        (&|s| s.color.image = vk::Image::null(), YORO_ERROR_NULL),
        (&|s| s.color.format = vk::Format::R8G8B8A8_UINT, YORO_ERROR_FORMAT),
        (&|s| s.color.format = vk::Format::from_raw(1 << 30), YORO_ERROR_FORMAT),
        (&|s| s.depth.format = vk::Format::R8G8B8A8_UNORM, YORO_ERROR_FORMAT),
        (&|s| s.depth.before = discarded, YORO_ERROR_VALUE),
        (&|s| s.color.after = discarded, YORO_ERROR_VALUE),
        // Access without stages.
        (&|s| s.color.before.stages = vk::PipelineStageFlags::empty(), YORO_ERROR_VALUE),
    ];
    check_codes(&source, sources, |wrong| {
        let mut id = 0;
        // SAFETY: live images, or what is refused.
        unsafe { yoro_vk_register_source(context, wrong, &mut id) }
    });
    // SAFETY: live handles, or what is refused.
    unsafe {
        assert_eq!(yoro_vk_register_source(context, &source, null_mut()), YORO_ERROR_NULL);
        assert_eq!(yoro_vk_register_source(context, &source, &mut frame.source), YORO_OK);
        let other =
            YoroVkTarget { color: YoroVkImage { format: vk::Format::R8G8B8A8_SRGB, ..color }, ..target };
        assert_eq!(yoro_vk_register_target(context, &other, &mut frame.target), YORO_ERROR_FORMAT);
        let empty = YoroVkTarget { width: 0, ..target };
        assert_eq!(yoro_vk_register_target(context, &empty, &mut frame.target), YORO_ERROR_VALUE);
        assert_eq!(yoro_vk_register_target(context, &target, &mut frame.target), YORO_OK);
        assert_eq!(yoro_gl_prepare(context, null()), YORO_ERROR_API);
    }

    let warp = WARP;
    let record = |warp: &YoroWarp, frame: &YoroVkFrame| {
        // SAFETY: live handles, and a command buffer that is being recorded and is never submitted.
        unsafe { yoro_vk_record(context, gpu.commands, warp, frame) }
    };
    assert_eq!(record(&warp, &frame), YORO_OK);
    assert_eq!(record(&warp, &YoroVkFrame { source: 99, ..frame }), YORO_ERROR_NOT_REGISTERED);
    assert_eq!(record(&warp, &YoroVkFrame { target_x: 100, ..frame }), YORO_ERROR_TOO_LARGE);
    assert_eq!(record(&warp, &YoroVkFrame { source_y: u32::MAX, ..frame }), YORO_ERROR_TOO_LARGE);
    assert_eq!(record(&YoroWarp { target_width: 161, ..warp }, &frame), YORO_ERROR_TOO_LARGE);
    assert_eq!(record(&YoroWarp { offset: f64::NAN, ..warp }, &frame), YORO_ERROR_VALUE);
    assert_eq!(record(&YoroWarp { reserved: 1, ..warp }, &frame), YORO_ERROR_VALUE);
    assert_eq!(record(&warp, &YoroVkFrame { struct_size: 0, ..frame }), YORO_ERROR_STRUCT_SIZE);
    // SAFETY: null pointers are allowed, and refused with a code.
    unsafe {
        let no_commands = vk::CommandBuffer::null();
        assert_eq!(yoro_vk_record(context, no_commands, &warp, &frame), YORO_ERROR_NULL);
        assert_eq!(yoro_vk_record(context, gpu.commands, null(), &frame), YORO_ERROR_NULL);
        assert_eq!(yoro_vk_record(context, gpu.commands, &warp, null()), YORO_ERROR_NULL);
        assert_eq!(yoro_vk_record(null_mut(), gpu.commands, &warp, &frame), YORO_ERROR_NULL);
    }

    // SAFETY: nothing is pending; alive until the last line.
    unsafe {
        assert_eq!(yoro_vk_release_source(context, frame.source), YORO_OK);
        assert_eq!(yoro_vk_release_source(context, frame.source), YORO_OK);
        assert_eq!(record(&warp, &frame), YORO_ERROR_NOT_REGISTERED);
        assert_eq!(yoro_vk_release_target(context, frame.target), YORO_OK);
        gpu.device.end_command_buffer(gpu.commands).unwrap();
        gpu.device.device_wait_idle().unwrap();
        assert_eq!(yoro_destroy(context), YORO_OK);
    }
}
