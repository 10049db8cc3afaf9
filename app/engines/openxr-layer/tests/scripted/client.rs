//! A scripted OpenXR application above the layer, with the simulated runtime below it.

use std::ffi::CStr;
use std::ptr;

use openxr_sys as sys;
use sys::{Handle as _, ViewConfigurationType as ViewsOf, pfn};
use yoro::eyes::{DepthRange, Frustum, Pose};
use yoro::vulkan::ImageState;
use yoro::vulkan::ash::vk;
use yoro::vulkan::ash::vk::Handle as _;

use crate::drawing::Drawing;
use crate::harness::{self, Gpu, READ, WRITTEN};
use crate::scene::{self, Picture};

mod extensions;
mod mistakes;

pub const DEPTH: &CStr = c"XR_KHR_composition_layer_depth";

/// A failed call of the application.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Failure {
    pub call: &'static str,
    pub result: sys::Result,
}

pub type Outcome<T> = Result<T, Failure>;

fn check(call: &'static str, result: sys::Result) -> Outcome<sys::Result> {
    if result.into_raw() < 0 { Err(Failure { call, result }) } else { Ok(result) }
}

macro_rules! functions {
    ($($field:ident: $kind:ident = $name:literal,)*) => {
        /// The OpenXR functions that an application uses.
        struct Functions { $($field: pfn::$kind,)* }

        impl Functions {
            /// Finds all functions.
            ///
            /// # Safety
            /// `get` is the xrGetInstanceProcAddr for this live instance.
            unsafe fn new(get: pfn::GetInstanceProcAddr, instance: sys::Instance) -> Functions {
                Functions { $($field: {
                    let mut function = None;
                    // SAFETY: a live instance, and a function of this name has this type.
                    unsafe {
                        assert_eq!(get(instance, $name.as_ptr(), &mut function), sys::Result::SUCCESS);
                        std::mem::transmute::<pfn::VoidFunction, pfn::$kind>(function.unwrap())
                    }
                },)* }
            }
        }
    };
}

functions! {
    destroy_instance: DestroyInstance = c"xrDestroyInstance",
    get_system: GetSystem = c"xrGetSystem",
    poll_event: PollEvent = c"xrPollEvent",
    enumerate_view_configurations: EnumerateViewConfigurations = c"xrEnumerateViewConfigurations",
    enumerate_view_configuration_views: EnumerateViewConfigurationViews = c"xrEnumerateViewConfigurationViews",
    create_session: CreateSession = c"xrCreateSession",
    destroy_session: DestroySession = c"xrDestroySession",
    begin_session: BeginSession = c"xrBeginSession",
    end_session: EndSession = c"xrEndSession",
    create_reference_space: CreateReferenceSpace = c"xrCreateReferenceSpace",
    wait_frame: WaitFrame = c"xrWaitFrame",
    begin_frame: BeginFrame = c"xrBeginFrame",
    end_frame: EndFrame = c"xrEndFrame",
    locate_views: LocateViews = c"xrLocateViews",
    create_swapchain: CreateSwapchain = c"xrCreateSwapchain",
    destroy_swapchain: DestroySwapchain = c"xrDestroySwapchain",
    enumerate_swapchain_images: EnumerateSwapchainImages = c"xrEnumerateSwapchainImages",
    acquire_swapchain_image: AcquireSwapchainImage = c"xrAcquireSwapchainImage",
    wait_swapchain_image: WaitSwapchainImage = c"xrWaitSwapchainImage",
    release_swapchain_image: ReleaseSwapchainImage = c"xrReleaseSwapchainImage",
}

/// Creates the runtime's instance, at the end of the chain of layers, as a loader does.
unsafe extern "system" fn create_runtime_instance(
    info: *const sys::InstanceCreateInfo,
    _: *const sys::ApiLayerCreateInfo,
    instance: *mut sys::Instance,
) -> sys::Result {
    let mut function = None;
    // SAFETY: the layer's structures, and a function of this name has this type.
    unsafe {
        runtime()(sys::Instance::NULL, c"xrCreateInstance".as_ptr(), &mut function);
        std::mem::transmute::<pfn::VoidFunction, pfn::CreateInstance>(function.unwrap())(info, instance)
    }
}

fn loader() -> sys::NegotiateLoaderInfo {
    sys::NegotiateLoaderInfo {
        struct_type: sys::NegotiateLoaderInfo::TYPE,
        struct_version: sys::NegotiateLoaderInfo::VERSION,
        struct_size: size_of::<sys::NegotiateLoaderInfo>(),
        min_interface_version: 1,
        max_interface_version: 1,
        min_api_version: sys::Version::new(1, 0, 0),
        max_api_version: sys::Version::new(1, 0xfff, 0xfff),
    }
}

fn runtime() -> pfn::GetInstanceProcAddr {
    let mut request = sys::NegotiateRuntimeRequest {
        struct_type: sys::NegotiateRuntimeRequest::TYPE,
        struct_version: sys::NegotiateRuntimeRequest::VERSION,
        struct_size: size_of::<sys::NegotiateRuntimeRequest>(),
        runtime_interface_version: 0,
        runtime_api_version: sys::Version::new(0, 0, 0),
        get_instance_proc_addr: None,
    };
    // SAFETY: complete structures.
    let result = unsafe { yoro_openxr_stub::xrNegotiateLoaderRuntimeInterface(&loader(), &mut request) };
    assert_eq!(result, sys::Result::SUCCESS);
    request.get_instance_proc_addr.unwrap()
}

fn layer() -> sys::NegotiateApiLayerRequest {
    let mut request = sys::NegotiateApiLayerRequest {
        struct_type: sys::NegotiateApiLayerRequest::TYPE,
        struct_version: sys::NegotiateApiLayerRequest::VERSION,
        struct_size: size_of::<sys::NegotiateApiLayerRequest>(),
        layer_interface_version: 0,
        layer_api_version: sys::Version::new(0, 0, 0),
        get_instance_proc_addr: None,
        create_api_layer_instance: None,
    };
    // SAFETY: complete structures.
    let result = unsafe {
        yoro_openxr_layer::xrNegotiateLoaderApiLayerInterface(&loader(), ptr::null(), &mut request)
    };
    assert_eq!(result, sys::Result::SUCCESS);
    request
}

/// A swapchain and its images.
pub struct Chain {
    pub handle: sys::Swapchain,
    /// VkImages, or names of textures.
    images: Vec<u64>,
}

/// A part of a swapchain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    pub chain: sys::Swapchain,
    pub origin: [u32; 2],
    pub size: [u32; 2],
    pub layer: u32,
}

impl Part {
    pub fn raw(self) -> sys::SwapchainSubImage {
        let [x, y] = self.origin.map(|n| n as i32);
        let [width, height] = self.size.map(|n| n as i32);
        sys::SwapchainSubImage {
            swapchain: self.chain,
            image_rect: sys::Rect2Di {
                offset: sys::Offset2Di { x, y },
                extent: sys::Extent2Di { width, height },
            },
            image_array_index: self.layer,
        }
    }
}

/// The meaning of the depth values: the distances in metres that are stored as `min` and as `max`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Planes {
    pub near: f32,
    pub far: f32,
    pub min: f32,
    pub max: f32,
}

impl Planes {
    pub const PLAIN: Planes = Planes { near: 0.1, far: 100.0, min: 0.0, max: 1.0 };

    pub fn stored(self, distance: f32) -> f32 {
        let depth = DepthRange::from_distances(self.near, self.far).depth(distance);
        self.min + depth * (self.max - self.min)
    }
}

/// A located view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    pub pose: Pose,
    pub frustum: Frustum,
    raw: (sys::Posef, sys::Fovf),
}

impl View {
    /// Returns the view flipped sideways, upside down, or both.
    pub fn flipped(self, [sides, upside_down]: [bool; 2]) -> View {
        let mut view = self;
        let (frustum, fov) = (&mut view.frustum, &mut view.raw.1);
        if sides {
            std::mem::swap(&mut frustum.left, &mut frustum.right);
            std::mem::swap(&mut fov.angle_left, &mut fov.angle_right);
        }
        if upside_down {
            std::mem::swap(&mut frustum.bottom, &mut frustum.top);
            std::mem::swap(&mut fov.angle_down, &mut fov.angle_up);
        }
        view
    }

    /// Returns the view with a pose that is none.
    pub fn without_orientation(mut self) -> View {
        self.raw.0.orientation = sys::Quaternionf { x: 0.0, y: 0.0, z: 0.0, w: 0.0 };
        self
    }

    /// Returns the view moved by an offset.
    pub fn at(self, offset: glam::Vec3) -> View {
        let mut view = self;
        view.pose.position += offset;
        let p = view.pose.position;
        view.raw.0.position = sys::Vector3f { x: p.x, y: p.y, z: p.z };
        view
    }
}

/// A view to submit.
#[derive(Clone, Copy)]
pub struct Submitted {
    pub view: View,
    pub color: Part,
    pub depth: Option<(Part, Planes)>,
}

/// A composition layer to submit.
pub enum Layer {
    Projection(Vec<Submitted>),
    Quad(Part),
}

/// A frame between xrBeginFrame and xrEndFrame.
#[derive(Clone, Copy)]
pub struct Frame {
    time: sys::Time,
    pub should_render: bool,
}

impl Frame {
    /// Returns the frame with a time that was not predicted.
    pub fn at_another_time(self) -> Frame {
        Frame { time: sys::Time::from_nanos(self.time.as_nanos() + 1), ..self }
    }
}

/// A picture that can be copied to swapchains.
pub struct Painted<'a> {
    view: View,
    samples: u32,
    planes: Planes,
    formats: [vk::Format; 2],
    pub picture: Picture,
    /// Its depth, as it is stored.
    stored: Vec<f32>,
    /// Colour and depth on Vulkan.
    images: Option<[harness::Image<'a>; 2]>,
}

impl<'a> Painted<'a> {
    pub fn color(&self) -> &harness::Image<'a> {
        &self.images.as_ref().expect("on Vulkan")[0]
    }

    pub fn depth(&self) -> &harness::Image<'a> {
        &self.images.as_ref().expect("on Vulkan")[1]
    }
}

/// The application.
pub struct Client<'a> {
    drawing: Drawing<'a>,
    get: pfn::GetInstanceProcAddr,
    xr: Functions,
    instance: sys::Instance,
    system: sys::SystemId,
    pub session: sys::Session,
    space: sys::Space,
    pub views: ViewsOf,
    running: bool,
    pub over: bool,
    pub painted: Option<Painted<'a>>,
    /// True if the images are upside down, and the layers say so.
    pub upside_down: bool,
    /// The view configurations and views in events about a changed visibility mask.
    pub masks: Vec<(ViewsOf, u32)>,
}

const IDENTITY: sys::Posef = sys::Posef {
    orientation: sys::Quaternionf { x: 0.0, y: 0.0, z: 0.0, w: 1.0 },
    position: sys::Vector3f { x: 0.0, y: 0.0, z: 0.0 },
};

impl<'a> Client<'a> {
    /// Creates an instance with these extensions and those for its graphics, and finds the headset.
    pub fn new(drawing: impl Into<Drawing<'a>>, name: &str, extensions: &[&CStr]) -> Outcome<Client<'a>> {
        let (drawing, layer) = (drawing.into(), layer());
        let mut next = sys::ApiLayerNextInfo {
            struct_type: sys::ApiLayerNextInfo::TYPE,
            struct_version: sys::ApiLayerNextInfo::VERSION,
            struct_size: size_of::<sys::ApiLayerNextInfo>(),
            layer_name: [0; sys::MAX_API_LAYER_NAME_SIZE],
            next_get_instance_proc_addr: Some(runtime()),
            next_create_api_layer_instance: Some(create_runtime_instance),
            next: ptr::null_mut(),
        };
        let chain = sys::ApiLayerCreateInfo {
            struct_type: sys::ApiLayerCreateInfo::TYPE,
            struct_version: sys::ApiLayerCreateInfo::VERSION,
            struct_size: size_of::<sys::ApiLayerCreateInfo>(),
            loader_instance: ptr::null_mut(),
            settings_file_location: [0; sys::API_LAYER_MAX_SETTINGS_PATH_SIZE],
            next_info: &mut next,
        };
        let mut application = sys::ApplicationInfo {
            application_name: [0; sys::MAX_APPLICATION_NAME_SIZE],
            application_version: 1,
            engine_name: [0; sys::MAX_ENGINE_NAME_SIZE],
            engine_version: 1,
            api_version: sys::Version::new(1, 0, 0),
        };
        for (to, from) in application.application_name.iter_mut().zip(name.bytes()) {
            *to = from as _;
        }
        let extensions: Vec<_> =
            drawing.extensions().iter().chain(extensions).map(|name| name.as_ptr()).collect();
        let info = sys::InstanceCreateInfo {
            ty: sys::InstanceCreateInfo::TYPE,
            next: ptr::null(),
            create_flags: sys::InstanceCreateFlags::EMPTY,
            application_info: application,
            enabled_api_layer_count: 0,
            enabled_api_layer_names: ptr::null(),
            enabled_extension_count: extensions.len() as u32,
            enabled_extension_names: extensions.as_ptr(),
        };
        let mut instance = sys::Instance::NULL;
        let create = layer.create_api_layer_instance.unwrap();
        // SAFETY: complete structures.
        check("xrCreateInstance", unsafe { create(&info, &chain, &mut instance) })?;
        let get = layer.get_instance_proc_addr.unwrap();
        // SAFETY: the instance was just created.
        let xr = unsafe { Functions::new(get, instance) };
        let mut client = Client {
            drawing,
            get,
            xr,
            instance,
            system: sys::SystemId::from_raw(0),
            session: sys::Session::NULL,
            space: sys::Space::NULL,
            views: ViewsOf::PRIMARY_MONO,
            running: false,
            over: false,
            painted: None,
            upside_down: false,
            masks: Vec::new(),
        };
        let info = sys::SystemGetInfo {
            ty: sys::SystemGetInfo::TYPE,
            next: ptr::null(),
            form_factor: sys::FormFactor::HEAD_MOUNTED_DISPLAY,
        };
        // SAFETY: complete structures.
        check("xrGetSystem", unsafe { (client.xr.get_system)(instance, &info, &mut client.system) })?;
        Ok(client)
    }

    /// Returns the offered view configurations.
    pub fn configurations(&self) -> Outcome<Vec<ViewsOf>> {
        let (mut list, mut count) = ([ViewsOf::PRIMARY_MONO; 8], 0);
        let call = self.xr.enumerate_view_configurations;
        // SAFETY: room for as many elements as stated.
        let result = unsafe { call(self.instance, self.system, 8, &mut count, list.as_mut_ptr()) };
        check("xrEnumerateViewConfigurations", result)?;
        Ok(list[..count as usize].to_vec())
    }

    /// Returns the recommended sizes of the configuration's views.
    pub fn sizes(&self) -> Outcome<Vec<[u32; 2]>> {
        // SAFETY: plain data; the type is set below.
        let empty: sys::ViewConfigurationView = unsafe { std::mem::zeroed() };
        let mut views = [sys::ViewConfigurationView { ty: sys::ViewConfigurationView::TYPE, ..empty }; 4];
        let mut count = 0;
        let call = self.xr.enumerate_view_configuration_views;
        // SAFETY: room for as many elements as stated.
        let result =
            unsafe { call(self.instance, self.system, self.views, 4, &mut count, views.as_mut_ptr()) };
        check("xrEnumerateViewConfigurationViews", result)?;
        let size = |view: &sys::ViewConfigurationView| {
            [view.recommended_image_rect_width, view.recommended_image_rect_height]
        };
        Ok(views[..count as usize].iter().map(size).collect())
    }

    /// Creates a session and a space.
    pub fn create_session(&mut self) -> Outcome<()> {
        (self.running, self.over) = (false, false);
        let (instance, system, create) = (self.instance, self.system, self.xr.create_session);
        let (call, result) = self.drawing.ask_requirements(self.get, instance, system);
        check(call, result)?;
        let session = &mut self.session;
        let result = self.drawing.with_binding(|binding| {
            let info = sys::SessionCreateInfo {
                ty: sys::SessionCreateInfo::TYPE,
                next: binding,
                create_flags: sys::SessionCreateFlags::EMPTY,
                system_id: system,
            };
            // SAFETY: complete structures, with handles that live longer than the session.
            unsafe { create(instance, &info, session) }
        });
        check("xrCreateSession", result)?;
        // SAFETY: complete structures.
        unsafe {
            let info = sys::ReferenceSpaceCreateInfo {
                ty: sys::ReferenceSpaceCreateInfo::TYPE,
                next: ptr::null(),
                reference_space_type: sys::ReferenceSpaceType::LOCAL,
                pose_in_reference_space: IDENTITY,
            };
            let result = (self.xr.create_reference_space)(self.session, &info, &mut self.space);
            check("xrCreateReferenceSpace", result)?;
        }
        Ok(())
    }

    /// Creates a session and a space, and begins the session if the runtime is ready.
    pub fn start_session(&mut self) -> Outcome<()> {
        self.create_session()?;
        self.poll()
    }

    /// Handles the runtime's events, and begins and ends the session accordingly.
    pub fn poll(&mut self) -> Outcome<()> {
        loop {
            // SAFETY: plain data.
            let mut event: sys::EventDataBuffer = unsafe { std::mem::zeroed() };
            event.ty = sys::EventDataBuffer::TYPE;
            // SAFETY: a buffer for any event.
            let result = unsafe { (self.xr.poll_event)(self.instance, &mut event) };
            if check("xrPollEvent", result)? == sys::Result::EVENT_UNAVAILABLE {
                return Ok(());
            }
            if event.ty == sys::EventDataVisibilityMaskChangedKHR::TYPE {
                // SAFETY: the event has this type.
                let event = unsafe { *(&raw const event).cast::<sys::EventDataVisibilityMaskChangedKHR>() };
                assert_eq!(event.session, self.session);
                self.masks.push((event.view_configuration_type, event.view_index));
            }
            if event.ty != sys::EventDataSessionStateChanged::TYPE {
                continue;
            }
            // SAFETY: the event has this type.
            let state = unsafe { (*(&raw const event).cast::<sys::EventDataSessionStateChanged>()).state };
            match state {
                sys::SessionState::READY => self.begin(self.views)?,
                sys::SessionState::STOPPING => {
                    self.running = false;
                    // SAFETY: a live session.
                    check("xrEndSession", unsafe { (self.xr.end_session)(self.session) })?;
                }
                sys::SessionState::EXITING | sys::SessionState::LOSS_PENDING => self.over = true,
                _ => {}
            }
        }
    }

    /// Begins the session with this view configuration.
    pub fn begin(&mut self, views: ViewsOf) -> Outcome<()> {
        let info = sys::SessionBeginInfo {
            ty: sys::SessionBeginInfo::TYPE,
            next: ptr::null(),
            primary_view_configuration_type: views,
        };
        // SAFETY: a live session.
        check("xrBeginSession", unsafe { (self.xr.begin_session)(self.session, &info) })?;
        self.running = true;
        Ok(())
    }

    pub fn is_running(&self) -> bool {
        self.running
    }

    fn chain_info(&self, format: vk::Format, size: [u32; 2], layers: u32) -> sys::SwapchainCreateInfo {
        let kind = if harness::is_depth(format) {
            sys::SwapchainUsageFlags::DEPTH_STENCIL_ATTACHMENT
        } else {
            sys::SwapchainUsageFlags::COLOR_ATTACHMENT
        };
        sys::SwapchainCreateInfo {
            ty: sys::SwapchainCreateInfo::TYPE,
            next: ptr::null(),
            create_flags: sys::SwapchainCreateFlags::EMPTY,
            usage_flags: kind | sys::SwapchainUsageFlags::TRANSFER_DST,
            format: self.drawing.format(format),
            sample_count: 1,
            width: size[0],
            height: size[1],
            face_count: 1,
            array_size: layers,
            mip_count: 1,
        }
    }

    /// Creates a swapchain for colour or for depth.
    pub fn chain(&self, format: vk::Format, size: [u32; 2], layers: u32) -> Outcome<Chain> {
        self.chain_of(&self.xr, &self.chain_info(format, size, layers))
    }

    fn chain_of(&self, xr: &Functions, info: &sys::SwapchainCreateInfo) -> Outcome<Chain> {
        let mut handle = sys::Swapchain::NULL;
        // SAFETY: complete structures.
        let result = unsafe { (xr.create_swapchain)(self.session, info, &mut handle) };
        check("xrCreateSwapchain", result)?;
        let (result, images) = self.drawing.images(xr.enumerate_swapchain_images, handle);
        check("xrEnumerateSwapchainImages", result)?;
        Ok(Chain { handle, images })
    }

    /// Creates a swapchain that the layer does not know, as functions of extensions do.
    pub fn chain_below_the_layer(&self) -> Outcome<Chain> {
        // SAFETY: the instance is also a live instance of the runtime.
        let xr = unsafe { Functions::new(runtime(), self.instance) };
        self.chain_of(&xr, &self.chain_info(vk::Format::R8G8B8A8_SRGB, [64; 2], 1))
    }

    /// Returns a function that destroys a swapchain on any thread.
    pub fn destroyer(&self, chain: Chain) -> impl Fn() -> sys::Result + Send + Sync + 'static {
        let destroy = self.xr.destroy_swapchain;
        // SAFETY: called once, and no longer used.
        move || unsafe { destroy(chain.handle) }
    }

    pub fn destroy_chain(&self, chain: Chain) -> Outcome<()> {
        // SAFETY: no longer used.
        check("xrDestroySwapchain", unsafe { (self.xr.destroy_swapchain)(chain.handle) }).map(|_| ())
    }

    /// Waits for a frame and begins it.
    pub fn begin_frame(&mut self) -> Outcome<Frame> {
        let frame = self.wait_frame()?;
        self.begin_waited()?;
        Ok(frame)
    }

    pub fn wait_frame(&mut self) -> Outcome<Frame> {
        let mut state = sys::FrameState {
            ty: sys::FrameState::TYPE,
            next: ptr::null_mut(),
            predicted_display_time: sys::Time::from_nanos(0),
            predicted_display_period: sys::Duration::from_nanos(0),
            should_render: sys::FALSE,
        };
        // SAFETY: a live session.
        check("xrWaitFrame", unsafe { (self.xr.wait_frame)(self.session, ptr::null(), &mut state) })?;
        Ok(Frame { time: state.predicted_display_time, should_render: state.should_render.into() })
    }

    pub fn begin_waited(&mut self) -> Outcome<()> {
        // SAFETY: a live session.
        check("xrBeginFrame", unsafe { (self.xr.begin_frame)(self.session, ptr::null()) }).map(|_| ())
    }

    /// Locates the views of a frame, as many as the configuration has.
    pub fn locate(&mut self, frame: Frame) -> Outcome<[Option<View>; 4]> {
        let fov = sys::Fovf { angle_left: 0.0, angle_right: 0.0, angle_up: 0.0, angle_down: 0.0 };
        let mut views = [sys::View { ty: sys::View::TYPE, next: ptr::null_mut(), pose: IDENTITY, fov }; 4];
        let count = self.locate_views(frame, &mut views)?;
        let mut located = [None; 4];
        for (place, view) in located.iter_mut().zip(&views[..count]) {
            let (p, q, f) = (view.pose.position, view.pose.orientation, view.fov);
            *place = Some(View {
                pose: Pose {
                    position: glam::Vec3::new(p.x, p.y, p.z),
                    orientation: glam::Quat::from_xyzw(q.x, q.y, q.z, q.w),
                },
                frustum: Frustum::from_fov(f.angle_left, f.angle_right, f.angle_up, f.angle_down),
                raw: (view.pose, view.fov),
            });
        }
        Ok(located)
    }

    /// Locates views, and returns their number.
    fn locate_views(&self, frame: Frame, views: &mut [sys::View]) -> Outcome<usize> {
        let info = sys::ViewLocateInfo {
            ty: sys::ViewLocateInfo::TYPE,
            next: ptr::null(),
            view_configuration_type: self.views,
            display_time: frame.time,
            space: self.space,
        };
        let mut state = sys::ViewState {
            ty: sys::ViewState::TYPE,
            next: ptr::null_mut(),
            view_state_flags: sys::ViewStateFlags::EMPTY,
        };
        let (call, room, mut count) = (self.xr.locate_views, views.len() as u32, 0);
        // SAFETY: complete structures, and room for as many elements as stated.
        let result = unsafe { call(self.session, &info, &mut state, room, &mut count, views.as_mut_ptr()) };
        check("xrLocateViews", result)?;
        Ok(count as usize)
    }

    pub fn acquire(&self, chain: &Chain) -> Outcome<u64> {
        let image = self.acquire_only(chain)?;
        self.wait_image(chain)?;
        Ok(image)
    }

    pub fn acquire_only(&self, chain: &Chain) -> Outcome<u64> {
        let mut index = 0;
        // SAFETY: a live swapchain.
        let result = unsafe { (self.xr.acquire_swapchain_image)(chain.handle, ptr::null(), &mut index) };
        check("xrAcquireSwapchainImage", result)?;
        Ok(chain.images[index as usize])
    }

    pub fn wait_image(&self, chain: &Chain) -> Outcome<()> {
        let info = sys::SwapchainImageWaitInfo {
            ty: sys::SwapchainImageWaitInfo::TYPE,
            next: ptr::null(),
            timeout: sys::Duration::INFINITE,
        };
        // SAFETY: a live swapchain.
        let result = unsafe { (self.xr.wait_swapchain_image)(chain.handle, &info) };
        check("xrWaitSwapchainImage", result).map(|_| ())
    }

    pub fn release(&self, chain: &Chain) -> Outcome<()> {
        // SAFETY: a live swapchain.
        let result = unsafe { (self.xr.release_swapchain_image)(chain.handle, ptr::null()) };
        check("xrReleaseSwapchainImage", result).map(|_| ())
    }

    /// Renders what a view sees, unless this was rendered last.
    pub fn paint(
        &mut self,
        view: View,
        size: [u32; 2],
        samples: u32,
        formats: [vk::Format; 2],
        planes: Planes,
    ) {
        let same = |old: &Painted| {
            old.view == view
                && (old.samples, old.planes) == (samples, planes)
                && old.picture.size == size
                && old.formats == formats
        };
        if self.painted.as_ref().is_some_and(same) {
            return;
        }
        let rendered = view.flipped([false, self.upside_down]);
        let picture = scene::render(rendered.pose, rendered.frustum, size, samples);
        let stored: Vec<f32> = picture.distance.iter().map(|&z| planes.stored(z)).collect();
        let images = match self.drawing {
            Drawing::Vulkan(gpu) => {
                let [color, depth] = formats.map(|format| gpu.image(format, size, 1));
                color.upload_rgba8(0, &picture.rgba, READ);
                depth.upload_depth(0, &stored, READ);
                Some([color, depth])
            }
            Drawing::Gles(_) => None,
        };
        self.painted = Some(Painted { view, samples, planes, formats, picture, stored, images });
    }

    /// Copies the painted colour to a part of a swapchain's image.
    pub fn copy_color(&self, to: u64, part: Part) {
        let painted = self.painted.as_ref().unwrap();
        match self.drawing {
            Drawing::Vulkan(gpu) => copy(gpu, painted.color(), vk::Image::from_raw(to), part),
            Drawing::Gles(gles) => gles.upload_color(to, part, &painted.picture.rgba),
        }
    }

    /// Copies the painted depth to a part of a swapchain's image.
    pub fn copy_depth(&self, to: u64, part: Part) {
        let painted = self.painted.as_ref().unwrap();
        match self.drawing {
            Drawing::Vulkan(gpu) => copy(gpu, painted.depth(), vk::Image::from_raw(to), part),
            Drawing::Gles(gles) => gles.upload_depth(to, part, &painted.stored),
        }
    }

    /// Ends a frame with these layers.
    pub fn end_frame(&mut self, frame: Frame, layers: &[Layer]) -> Outcome<()> {
        // Eight layers of four views are enough. They are on the stack, because the tests count the layer's allocations.
        // SAFETY: plain data; what is not filled is not used.
        let (mut depths, mut views, mut projections, mut quads) = unsafe {
            (
                std::mem::zeroed::<[[sys::CompositionLayerDepthInfoKHR; 4]; 8]>(),
                std::mem::zeroed::<[[sys::CompositionLayerProjectionView; 4]; 8]>(),
                std::mem::zeroed::<[sys::CompositionLayerProjection; 8]>(),
                std::mem::zeroed::<[sys::CompositionLayerQuad; 8]>(),
            )
        };
        let mut pointers = [ptr::null::<sys::CompositionLayerBaseHeader>(); 8];
        let (space, layer_flags) = (self.space, sys::CompositionLayerFlags::EMPTY);
        let layout = sys::CompositionLayerImageLayoutFB {
            ty: sys::CompositionLayerImageLayoutFB::TYPE,
            next: ptr::null_mut(),
            flags: sys::CompositionLayerImageLayoutFlagsFB::VERTICAL_FLIP,
        };
        let chained = if self.upside_down { (&raw const layout).cast() } else { ptr::null() };
        for (i, layer) in layers.iter().enumerate() {
            match layer {
                Layer::Projection(submitted) => {
                    for (j, one) in submitted.iter().enumerate() {
                        let mut next = ptr::null();
                        if let Some((part, planes)) = one.depth {
                            depths[i][j] = sys::CompositionLayerDepthInfoKHR {
                                ty: sys::CompositionLayerDepthInfoKHR::TYPE,
                                next: ptr::null(),
                                sub_image: part.raw(),
                                min_depth: planes.min,
                                max_depth: planes.max,
                                near_z: planes.near,
                                far_z: planes.far,
                            };
                            next = (&raw const depths[i][j]).cast();
                        }
                        views[i][j] = sys::CompositionLayerProjectionView {
                            ty: sys::CompositionLayerProjectionView::TYPE,
                            next,
                            pose: one.view.raw.0,
                            fov: one.view.raw.1,
                            sub_image: one.color.raw(),
                        };
                    }
                    projections[i] = sys::CompositionLayerProjection {
                        ty: sys::CompositionLayerProjection::TYPE,
                        next: chained,
                        layer_flags,
                        space,
                        view_count: submitted.len() as u32,
                        views: views[i].as_ptr(),
                    };
                    pointers[i] = (&raw const projections[i]).cast();
                }
                Layer::Quad(part) => {
                    quads[i] = sys::CompositionLayerQuad {
                        ty: sys::CompositionLayerQuad::TYPE,
                        next: ptr::null(),
                        layer_flags,
                        space,
                        eye_visibility: sys::EyeVisibility::BOTH,
                        sub_image: part.raw(),
                        pose: IDENTITY,
                        size: sys::Extent2Df { width: 1.0, height: 1.0 },
                    };
                    pointers[i] = (&raw const quads[i]).cast();
                }
            }
        }
        self.submit(frame, layers.len(), pointers.as_ptr())
    }

    /// Ends a frame with one view.
    pub fn show(&mut self, frame: Frame, submitted: Submitted) -> Outcome<()> {
        self.end_frame(frame, &[Layer::Projection(vec![submitted])])
    }

    /// Ends a frame with this many layers, and with a pointer to them that may be null.
    pub fn submit(
        &mut self,
        frame: Frame,
        count: usize,
        layers: *const *const sys::CompositionLayerBaseHeader,
    ) -> Outcome<()> {
        let info = sys::FrameEndInfo {
            ty: sys::FrameEndInfo::TYPE,
            next: ptr::null(),
            display_time: frame.time,
            environment_blend_mode: sys::EnvironmentBlendMode::OPAQUE,
            layer_count: count as u32,
            layers,
        };
        // SAFETY: complete structures.
        check("xrEndFrame", unsafe { (self.xr.end_frame)(self.session, &info) }).map(|_| ())
    }

    pub fn destroy_session(&mut self) -> Outcome<()> {
        self.running = false;
        // SAFETY: no longer used.
        let result =
            unsafe { (self.xr.destroy_session)(std::mem::replace(&mut self.session, sys::Session::NULL)) };
        check("xrDestroySession", result).map(|_| ())
    }
}

/// Copies an image to a part of a swapchain's image.
fn copy(gpu: &Gpu, from: &harness::Image, to: vk::Image, part: Part) {
    let depth = harness::is_depth(from.format);
    let (state, aspect_mask) = if depth {
        (ImageState::DEPTH_ATTACHMENT, vk::ImageAspectFlags::DEPTH)
    } else {
        (ImageState::COLOR_ATTACHMENT, vk::ImageAspectFlags::COLOR)
    };
    let stencil =
        from.format == vk::Format::D32_SFLOAT_S8_UINT || from.format == vk::Format::D24_UNORM_S8_UINT;
    let all = if stencil { aspect_mask | vk::ImageAspectFlags::STENCIL } else { aspect_mask };
    let layers = |base_array_layer| vk::ImageSubresourceLayers {
        aspect_mask,
        mip_level: 0,
        base_array_layer,
        layer_count: 1,
    };
    let [x, y] = part.origin.map(|n| n as i32);
    let region = vk::ImageCopy {
        src_subresource: layers(0),
        src_offset: vk::Offset3D::default(),
        dst_subresource: layers(part.layer),
        dst_offset: vk::Offset3D { x, y, z: 0 },
        extent: vk::Extent3D { width: part.size[0], height: part.size[1], depth: 1 },
    };
    let turn = |commands, from: ImageState, to_state: ImageState| {
        let barrier = vk::ImageMemoryBarrier::default()
            .image(to)
            .old_layout(from.layout)
            .new_layout(to_state.layout)
            .src_access_mask(from.access)
            .dst_access_mask(to_state.access)
            .subresource_range(vk::ImageSubresourceRange {
                aspect_mask: all,
                base_mip_level: 0,
                level_count: 1,
                base_array_layer: part.layer,
                layer_count: 1,
            });
        let (from, to, none) = (from.stages, to_state.stages, vk::DependencyFlags::empty());
        // SAFETY: a live image in this layout.
        unsafe { gpu.device.cmd_pipeline_barrier(commands, from, to, none, &[], &[], &[barrier]) };
    };
    gpu.run(|commands| {
        turn(commands, state, WRITTEN);
        // SAFETY: live images in these layouts.
        unsafe {
            let (read, written) = (READ.layout, WRITTEN.layout);
            gpu.device.cmd_copy_image(commands, from.raw, read, to, written, &[region]);
        }
        turn(commands, WRITTEN, state);
    });
}

impl Drop for Client<'_> {
    fn drop(&mut self) {
        // SAFETY: no longer used. Everything that is left is destroyed with it.
        unsafe { (self.xr.destroy_instance)(self.instance) };
    }
}
