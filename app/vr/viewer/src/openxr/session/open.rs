//! Opens a session: the instance, its system, and everything that frames need.

use std::rc::Rc;

use openxr as xr;
#[cfg(target_os = "android")]
use xr::sys;

use super::state::{Depth, PanelImages, Session, Spaces};
use crate::openxr::description::{Description, Options};
#[cfg(target_os = "android")]
use crate::openxr::error::check;
use crate::openxr::error::{XrError, call, optional};
use crate::openxr::graphics::{self, make_current};
use crate::openxr::images::{EyeImages, Images, Kind};
use crate::openxr::input::Input;
use crate::openxr::mask::Mask;
use crate::openxr::runtime::Runtime;
use crate::openxr::storage::{self, Storage};
use yoro::eyes::Eye;
use yoro_context::Graphics;
use yoro_gl::Context;
use yoro_lenses::{Board, Panel};
use yoro_render::DepthCopy;
use yoro_settings::Settings;

/// If the eyes' images are scaled, their sizes are multiples of this many pixels.
const SIZE_STEP: f32 = 16.0;

impl Session {
    /// Starts a session with a runtime.
    pub fn open(
        runtime: &Runtime,
        graphics: &dyn Graphics,
        gl: &Rc<Context>,
        settings: &Settings,
        options: &Options,
    ) -> Result<Session, XrError> {
        make_current(graphics)?;
        let instance = create_instance(runtime, options)?;
        let properties = call("xrGetInstanceProperties", instance.properties())?;
        let system = System::of(&instance, settings.one_view)?;
        let size = system.image_size(settings.render_scale, gl.capabilities().max_texture_size / 2);

        graphics::check_version(&instance, system.id, gl.capabilities().version)?;
        let (session, waiter, stream) = graphics::create_session(&instance, system.id, graphics)?;
        #[cfg(target_os = "android")]
        hint_thread(&session)?;
        let images = FrameImages::new(graphics, gl, &session, size, settings.submit_depth)?;
        let FrameImages { color, eyes, depth, panel } = images;
        let mask = make_mask(gl, &session, system.views)?;
        let spaces = make_spaces(&session)?;
        let input = optional("controllers are not used", Input::new(&instance, &session))?;
        let refresh_rates = ask_refresh_rates(&session)?;
        make_current(graphics)?;
        let storage = Storage::new(gl, color)?;
        let description = Description {
            runtime: format!("{} {}", properties.runtime_name, properties.runtime_version),
            views: if system.is_stereo() { "stereo" } else { "mono" }.into(),
            system: system.name,
            recommended: system.recommended,
            size,
            format: storage::format_name(color),
            array: eyes.is_array(),
            direct: storage.is_direct(),
            depth: depth.as_ref().map(|depth| storage::format_name(depth.format)),
            mask: mask.as_ref().is_some_and(Mask::hides),
            refresh_rates,
            input: input.is_some(),
        };
        description.log();
        Ok(Session {
            eyes,
            depth,
            panel,
            storage,
            mask,
            input,
            spaces,
            waiter,
            stream,
            session,
            instance,
            gl: gl.clone(),
            views: system.views,
            blend: system.blend,
            state: xr::SessionState::UNKNOWN,
            is_running: false,
            applied: None,
            realigned: None,
            recenter: false,
            events: Vec::with_capacity(8),
            last_error: String::new(),
            description,
        })
    }
}

/// Creates an instance with all useful extensions.
fn create_instance(runtime: &Runtime, options: &Options) -> Result<xr::Instance, XrError> {
    let entry = call("xrGetInstanceProcAddr", runtime.entry())?;
    let offered = call("xrEnumerateInstanceExtensionProperties", entry.enumerate_extensions())?;
    let mut enabled = xr::ExtensionSet::default();
    if !offered.khr_opengl_es_enable {
        return Err(XrError::Extension { extension: "XR_KHR_opengl_es_enable" });
    }
    enabled.khr_opengl_es_enable = true;
    #[cfg(target_os = "android")]
    {
        enabled.khr_android_create_instance = true;
        enabled.khr_android_thread_settings = offered.khr_android_thread_settings;
    }
    #[cfg(not(target_os = "android"))]
    {
        if !offered.mndx_egl_enable {
            return Err(XrError::Extension { extension: "XR_MNDX_egl_enable" });
        }
        enabled.mndx_egl_enable = true;
    }
    enabled.khr_composition_layer_depth = offered.khr_composition_layer_depth;
    enabled.khr_visibility_mask = offered.khr_visibility_mask;
    enabled.fb_display_refresh_rate = offered.fb_display_refresh_rate;
    enabled.ext_performance_settings = offered.ext_performance_settings;
    enabled.bd_controller_interaction = offered.bd_controller_interaction;
    let application = xr::ApplicationInfo {
        application_name: "yoro",
        application_version: 1,
        engine_name: "yoro",
        engine_version: 1,
        api_version: xr::Version::new(1, 0, 0),
    };
    #[cfg(target_os = "android")]
    let created = match options.android {
        Some(android) => entry.create_instance(&application, &enabled, &[], &android.platform()),
        None => entry.create_instance(&application, &enabled, &[], &()),
    };
    #[cfg(not(target_os = "android"))]
    let created = {
        let _ = options;
        entry.create_instance(&application, &enabled, &[], &())
    };
    call("xrCreateInstance", created)
}

/// Tells the runtime which thread renders, so that it can raise the thread's priority (XR_KHR_android_thread_settings).
#[cfg(target_os = "android")]
fn hint_thread(session: &xr::Session<xr::OpenGlEs>) -> Result<(), XrError> {
    let Some(extension) = &session.instance().exts().khr_android_thread_settings else { return Ok(()) };
    // SAFETY: `gettid` has no arguments.
    let thread = unsafe { libc::gettid() };
    let kind = sys::AndroidThreadTypeKHR::RENDERER_MAIN;
    // SAFETY: the session is live, the enum valid, and the number that of a thread of this process.
    let result =
        unsafe { (extension.set_android_application_thread)(session.as_raw(), kind, thread.cast_unsigned()) };
    let hinted = check("xrSetAndroidApplicationThreadKHR", result);
    optional("the priority of the rendering thread stays", hinted).map(drop)
}

/// The headset that an instance is used with.
struct System {
    id: xr::SystemId,
    name: String,
    views: xr::ViewConfigurationType,
    /// The size in pixels that the runtime recommends for each eye, and the largest possible one.
    recommended: [u32; 2],
    largest: [u32; 2],
    blend: xr::EnvironmentBlendMode,
}

impl System {
    /// Asks the runtime for the headset; `one_view` prefers one view to two.
    fn of(instance: &xr::Instance, one_view: bool) -> Result<System, XrError> {
        let id = call("xrGetSystem", instance.system(xr::FormFactor::HEAD_MOUNTED_DISPLAY))?;
        let properties = call("xrGetSystemProperties", instance.system_properties(id))?;
        let configurations =
            call("xrEnumerateViewConfigurations", instance.enumerate_view_configurations(id))?;
        let mut wanted = [xr::ViewConfigurationType::PRIMARY_STEREO, xr::ViewConfigurationType::PRIMARY_MONO];
        if one_view {
            wanted.reverse();
        }
        let views = wanted
            .into_iter()
            .find(|views| configurations.contains(views))
            .ok_or_else(|| XrError::Nonsense("offers neither one view nor two".into()))?;
        let sizes = call(
            "xrEnumerateViewConfigurationViews",
            instance.enumerate_view_configuration_views(id, views),
        )?;
        let recommended = sizes.iter().fold([0, 0], |size, view| {
            [size[0].max(view.recommended_image_rect_width), size[1].max(view.recommended_image_rect_height)]
        });
        let largest = sizes.iter().fold([u32::MAX; 2], |size, view| {
            [size[0].min(view.max_image_rect_width), size[1].min(view.max_image_rect_height)]
        });
        if recommended.contains(&0) || largest.contains(&0) {
            return Err(XrError::Nonsense("recommends images without pixels".into()));
        }
        let blends =
            call("xrEnumerateEnvironmentBlendModes", instance.enumerate_environment_blend_modes(id, views))?;
        let opaque = xr::EnvironmentBlendMode::OPAQUE;
        let blend = match blends.first() {
            Some(first) if !blends.contains(&opaque) => *first,
            _ => opaque,
        };
        Ok(System { id, name: properties.system_name, views, recommended, largest, blend })
    }

    fn is_stereo(&self) -> bool {
        self.views == xr::ViewConfigurationType::PRIMARY_STEREO
    }

    /// Returns the size in pixels of the images: the recommended one, scaled.
    fn image_size(&self, scale: f32, limit: u32) -> [u32; 2] {
        image_size(self.recommended, scale, self.largest.map(|n| n.min(limit)))
    }
}

/// The runtime's images that frames are drawn into.
struct FrameImages {
    /// Format of the eyes and the panel.
    color: u32,
    eyes: EyeImages,
    depth: Option<Depth>,
    panel: Option<PanelImages>,
}

impl FrameImages {
    fn new(
        graphics: &dyn Graphics,
        gl: &Rc<Context>,
        session: &xr::Session<xr::OpenGlEs>,
        size: [u32; 2],
        submit_depth: bool,
    ) -> Result<FrameImages, XrError> {
        let formats = call("xrEnumerateSwapchainFormats", session.enumerate_swapchain_formats())?;
        let color = storage::choose(&storage::COLOR_FORMATS, &formats).ok_or_else(|| {
            XrError::Nonsense("offers no format of images that OpenGL ES can draw to".into())
        })?;
        let kind = Kind { format: color, is_depth: false, size, layers: 2 };
        let eyes = EyeImages::new(graphics, gl, session, kind)?;
        let depth = match session.instance().exts().khr_composition_layer_depth {
            Some(_) if submit_depth => {
                let made = make_depth(graphics, gl, session, &formats, size);
                optional("no depth is submitted", made)?.flatten()
            }
            _ => None,
        };
        let panel = Images::new(
            graphics,
            gl,
            session,
            Kind { size: [0, 1].map(|i| Panel::MAX_SIZE[i].max(Board::SIZE[i])), layers: 1, ..kind },
        );
        let panel = optional("there is no HUD", panel)?.map(|images| PanelImages { images, version: None });
        Ok(FrameImages { color, eyes, depth, panel })
    }
}

fn make_depth(
    graphics: &dyn Graphics,
    gl: &Rc<Context>,
    session: &xr::Session<xr::OpenGlEs>,
    formats: &[u32],
    size: [u32; 2],
) -> Result<Option<Depth>, XrError> {
    let Some(format) = storage::choose(&storage::DEPTH_FORMATS, formats) else {
        log::info!("no depth is submitted: the runtime takes none of the formats of OpenGL ES");
        return Ok(None);
    };
    let images = EyeImages::new(graphics, gl, session, Kind { format, is_depth: true, size, layers: 2 })?;
    Ok(Some(Depth { images, copy: DepthCopy::new(gl)?, format }))
}

/// Returns the mask of the hidden part of each eye's image, if the runtime provides it.
fn make_mask(
    gl: &Rc<Context>,
    session: &xr::Session<xr::OpenGlEs>,
    views: xr::ViewConfigurationType,
) -> Result<Option<Mask>, XrError> {
    if session.instance().exts().khr_visibility_mask.is_none() {
        return Ok(None);
    }
    let mut mask = Mask::new(gl)?;
    let count = if views == xr::ViewConfigurationType::PRIMARY_STEREO { 2 } else { 1 };
    for eye in Eye::BOTH.into_iter().take(count) {
        optional("nothing is masked", mask.update(session, views, eye))?;
    }
    Ok(Some(mask))
}

fn make_spaces(session: &xr::Session<xr::OpenGlEs>) -> Result<Spaces, XrError> {
    let reference =
        |kind| call("xrCreateReferenceSpace", session.create_reference_space(kind, xr::Posef::IDENTITY));
    let local = xr::ReferenceSpaceType::LOCAL;
    Ok(Spaces {
        head: reference(xr::ReferenceSpaceType::VIEW)?,
        base: reference(local)?,
        ahead: reference(local)?,
    })
}

/// Returns the display's refresh rates in Hz; empty if the runtime does not report them.
fn ask_refresh_rates(session: &xr::Session<xr::OpenGlEs>) -> Result<Vec<f32>, XrError> {
    if session.instance().exts().fb_display_refresh_rate.is_none() {
        return Ok(Vec::new());
    }
    let rates = call("xrEnumerateDisplayRefreshRatesFB", session.enumerate_display_refresh_rates());
    Ok(optional("refresh rates are not known", rates)?.unwrap_or_default())
}

/// Returns the size of the images: the recommended one, scaled.
fn image_size(recommended: [u32; 2], scale: f32, limit: [u32; 2]) -> [u32; 2] {
    let scaled =
        |n: u32| if scale == 1.0 { n } else { ((n as f32 * scale / SIZE_STEP).ceil() * SIZE_STEP) as u32 };
    [0, 1].map(|i| scaled(recommended[i]).clamp(1, limit[i].max(1)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn image_sizes_stay_within_limits() {
        assert_eq!(image_size([1833, 1921], 1.0, [4096; 2]), [1833, 1921]);
        assert_eq!(image_size([1000, 1000], 0.5, [4096; 2]), [512, 512]);
        assert_eq!(image_size([1000, 1000], 2.0, [1200, 4096]), [1200, 2000]);
    }
}
