//! Calls that an application must not make.

use std::ptr;

use openxr_sys as sys;
use sys::{Handle as _, pfn};

use super::{Chain, Client, Frame};

/// A call, and the argument that is wrong, with the result.
pub type Mistake = (&'static str, sys::Result);

impl Client<'_> {
    fn locate_info(&self, frame: Frame) -> sys::ViewLocateInfo {
        sys::ViewLocateInfo {
            ty: sys::ViewLocateInfo::TYPE,
            next: ptr::null(),
            view_configuration_type: self.views,
            display_time: frame.time,
            space: self.space,
        }
    }

    /// Makes calls with a null pointer each. The session runs, and has this swapchain.
    pub fn calls_with_null(&self, frame: Frame, chain: &Chain) -> Vec<Mistake> {
        let (info, mut count, none) = (self.locate_info(frame), 0, ptr::null_mut());
        let (instance, system, session) = (self.instance, self.system, self.session);
        let mut state = sys::ViewState {
            ty: sys::ViewState::TYPE,
            next: none,
            view_state_flags: sys::ViewStateFlags::EMPTY,
        };
        let (mut function, mut made) = (None, sys::Swapchain::NULL);
        let (xr, locate, count, nowhere) =
            (&self.xr, self.xr.locate_views, &raw mut count, ptr::null_mut::<u32>());
        let about = self.chain_info(crate::habits::SRGB, [64; 2], 1);
        // SAFETY: live handles, and null pointers where the layer and the runtime must expect them; a function of each
        // name has its type.
        unsafe {
            let mask: pfn::GetVisibilityMaskKHR =
                std::mem::transmute(self.function(c"xrGetVisibilityMaskKHR"));
            let hidden = sys::VisibilityMaskTypeKHR::HIDDEN_TRIANGLE_MESH;
            let views = xr.enumerate_view_configuration_views;
            vec![
                ("xrBeginSession", (xr.begin_session)(session, ptr::null())),
                ("xrLocateViews, info", locate(session, ptr::null(), &mut state, 0, count, ptr::null_mut())),
                ("xrLocateViews, state", locate(session, &info, ptr::null_mut(), 0, count, ptr::null_mut())),
                ("xrLocateViews, count", locate(session, &info, &mut state, 0, nowhere, ptr::null_mut())),
                ("xrLocateViews, views", locate(session, &info, &mut state, 4, count, ptr::null_mut())),
                ("xrCreateSwapchain, info", (xr.create_swapchain)(session, ptr::null(), &mut made)),
                ("xrCreateSwapchain, swapchain", (xr.create_swapchain)(session, &about, ptr::null_mut())),
                ("xrAcquireSwapchainImage", (xr.acquire_swapchain_image)(chain.handle, ptr::null(), nowhere)),
                ("xrEndFrame", (xr.end_frame)(session, ptr::null())),
                ("xrGetVisibilityMaskKHR", mask(session, self.views, 0, hidden, ptr::null_mut())),
                ("xrPollEvent", (xr.poll_event)(instance, ptr::null_mut())),
                (
                    "xrEnumerateViewConfigurations",
                    (xr.enumerate_view_configurations)(instance, system, 0, nowhere, ptr::null_mut()),
                ),
                (
                    "xrEnumerateViewConfigurationViews",
                    views(instance, system, self.views, 0, nowhere, ptr::null_mut()),
                ),
                ("xrCreateSession", (xr.create_session)(instance, ptr::null(), ptr::null_mut())),
                ("xrGetInstanceProcAddr, name", (self.get)(instance, ptr::null(), &mut function)),
                (
                    "xrGetInstanceProcAddr, function",
                    (self.get)(instance, c"xrWaitFrame".as_ptr(), ptr::null_mut()),
                ),
            ]
        }
    }

    /// Asks for views in structures whose type is wrong, and checks that they stay as they are.
    pub fn calls_with_wrong_types(&self, frame: Frame) -> [Mistake; 2] {
        let (info, mut count) = (self.locate_info(frame), 0);
        let wrong = sys::StructureType::UNKNOWN;
        // SAFETY: plain data; room for as many elements as stated.
        unsafe {
            let mut state = sys::ViewState { ty: sys::ViewState::TYPE, ..std::mem::zeroed() };
            let mut views = [sys::View { ty: wrong, ..std::mem::zeroed() }; 4];
            let mut sizes = [sys::ViewConfigurationView { ty: wrong, ..std::mem::zeroed() }; 4];
            let (locate, ask) = (self.xr.locate_views, self.xr.enumerate_view_configuration_views);
            let located = locate(self.session, &info, &mut state, 4, &mut count, views.as_mut_ptr());
            let asked = ask(self.instance, self.system, self.views, 4, &mut count, sizes.as_mut_ptr());
            assert!(views.iter().all(|view| view.ty == wrong) && sizes.iter().all(|view| view.ty == wrong));
            [("xrLocateViews", located), ("xrEnumerateViewConfigurationViews", asked)]
        }
    }

    /// Asks for the mask of a view, and returns the number of its vertices.
    pub fn mask_size(&self, view: u32, kind: i32) -> Result<u32, sys::Result> {
        // SAFETY: a function of this name has this type, and without capacities only counts are written.
        unsafe {
            let ask: pfn::GetVisibilityMaskKHR =
                std::mem::transmute(self.function(c"xrGetVisibilityMaskKHR"));
            let mut mask = sys::VisibilityMaskKHR { ty: sys::VisibilityMaskKHR::TYPE, ..std::mem::zeroed() };
            let kind = sys::VisibilityMaskTypeKHR::from_raw(kind);
            let result = ask(self.session, self.views, view, kind, &mut mask);
            if result == sys::Result::SUCCESS { Ok(mask.vertex_count_output) } else { Err(result) }
        }
    }
}
