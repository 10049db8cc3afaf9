//! Opens a session: the instance, its system, and everything that frames need.

use std::rc::Rc;

use openxr as xr;
use xr::sys;

use super::state::{PanelImages, RuntimeLevel, Session, Spaces};
use crate::openxr::description::{Description, Options};
#[cfg(target_os = "android")]
use crate::openxr::error::check;
use crate::openxr::error::{XrError, call, optional, without};
use crate::openxr::fixed_foveation::{self, FixedFoveation};
use crate::openxr::graphics::{self, make_current};
use crate::openxr::images::{EyeImages, ImageSpec, Images};
use crate::openxr::input::Input;
use crate::openxr::mask::Mask;
use crate::openxr::motion::{self, MotionImages};
use crate::openxr::runtime::Runtime;
use crate::openxr::storage::{self, Storage};
use yoro::eyes::{Eye, FoveationLevel};
use yoro_context::Graphics;
use yoro_gl::Context;
use yoro_lenses::{Board, Panel};
use yoro_render::DepthCopy;
use yoro_settings::{FrameRate, Settings};

/// If the eyes' images are scaled, their sizes are multiples of this many pixels.
const SIZE_STEP: f32 = 16.0;
/// Two views of each eye, the second of which is an inset of the first (also XR_VARJO_quad_views).
const QUAD: xr::ViewConfigurationType = xr::ViewConfigurationType::PRIMARY_STEREO_WITH_FOVEATED_INSET;

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
        let foveated = settings.foveation.unwrap_or_default() != FoveationLevel::Off;
        let system = System::of(&instance, settings.one_view, foveated)?;
        let limit = gl.capabilities().max_texture_size / 2;
        let sizes: Vec<LevelSize> =
            system.levels.iter().map(|level| level.scaled(settings.render_scale, limit)).collect();

        graphics::check_version(&instance, system.id, gl.capabilities().version)?;
        let (session, waiter, stream) = graphics::create_session(&instance, system.id, graphics)?;
        #[cfg(target_os = "android")]
        hint_thread(&session)?;
        let images = FrameImages::new(graphics, gl, &session, &sizes)?;
        let FrameImages { color, wide, inset, depth, panel, formats } = images;
        let is_stereo = system.views == xr::ViewConfigurationType::PRIMARY_STEREO;
        let motion = match settings.frame_rate {
            FrameRate::Half | FrameRate::Auto if is_stereo => {
                MotionImages::new(graphics, gl, &session, system.id, &formats)?
            }
            _ => None,
        };
        let mask = make_mask(gl, &session, system.views)?;
        let spaces = make_spaces(&session)?;
        let input = optional("controllers are not used", Input::new(&instance, &session))?;
        let refresh_rates = ask_refresh_rates(&session)?;
        make_current(graphics)?;
        let storage = Storage::new(gl, color)?;
        let description = Description {
            runtime: format!("{} {}", properties.runtime_name, properties.runtime_version),
            views: match system.views {
                QUAD => "quad",
                xr::ViewConfigurationType::PRIMARY_STEREO => "stereo",
                _ => "mono",
            }
            .into(),
            system: system.name,
            recommended: wide.recommended,
            size: wide.size,
            inset_size: inset.as_ref().map(|inset| inset.size),
            format: storage::format_name(color),
            direct: storage.is_direct(),
            readable: storage.is_direct() && gl.reads_stored(),
            depth: depth.as_ref().map(|(format, _)| storage::format_name(*format)),
            mask: mask.as_ref().is_some_and(Mask::hides),
            refresh_rates,
            input: input.is_some(),
            makes_frames: motion.as_ref().map(MotionImages::extension),
        };
        description.log();
        Ok(Session {
            wide,
            inset,
            motion,
            depth_copy: depth.map(|(_, copy)| copy),
            fixed_foveation: FixedFoveation::new(&session),
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
            remade: 0,
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
        return Err(without("XR_KHR_opengl_es_enable"));
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
            return Err(without("XR_MNDX_egl_enable"));
        }
        enabled.mndx_egl_enable = true;
    }
    enabled.khr_composition_layer_depth = offered.khr_composition_layer_depth;
    enabled.khr_visibility_mask = offered.khr_visibility_mask;
    enabled.fb_display_refresh_rate = offered.fb_display_refresh_rate;
    enabled.ext_performance_settings = offered.ext_performance_settings;
    enabled.bd_controller_interaction = offered.bd_controller_interaction;
    enabled.varjo_quad_views = offered.varjo_quad_views;
    motion::enable(&offered, &mut enabled);
    fixed_foveation::enable(&offered, &mut enabled);
    let create = |minor| {
        let application = xr::ApplicationInfo {
            application_name: "yoro",
            application_version: 1,
            engine_name: "yoro",
            engine_version: 1,
            api_version: xr::Version::new(1, minor, 0),
        };
        #[cfg(target_os = "android")]
        if let Some(android) = options.android {
            return entry.create_instance(&application, &enabled, &[], &android.platform());
        }
        #[cfg(not(target_os = "android"))]
        let _ = options;
        entry.create_instance(&application, &enabled, &[], &())
    };
    // Insets for the eyes need either the extension or OpenXR 1.1.
    let created = match create(u16::from(!offered.varjo_quad_views)) {
        Err(sys::Result::ERROR_API_VERSION_UNSUPPORTED) => create(0),
        created => created,
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
    /// The eyes, and their insets if there are any.
    levels: Vec<Recommended>,
    blend: xr::EnvironmentBlendMode,
}

/// The size in pixels that a runtime recommends for each eye of a level, and the largest possible one.
struct Recommended {
    size: [u32; 2],
    largest: [u32; 2],
}

impl Recommended {
    /// Returns the recommendation that suits all of these views.
    fn of(views: &[xr::ViewConfigurationView]) -> Result<Recommended, XrError> {
        let size = views.iter().fold([0, 0], |size, view| {
            [size[0].max(view.recommended_image_rect_width), size[1].max(view.recommended_image_rect_height)]
        });
        let largest = views.iter().fold([u32::MAX; 2], |size, view| {
            [size[0].min(view.max_image_rect_width), size[1].min(view.max_image_rect_height)]
        });
        if size.contains(&0) || largest.contains(&0) {
            return Err(XrError::InvalidRuntimeData("recommends images without pixels".into()));
        }
        Ok(Recommended { size, largest })
    }

    /// Returns the size, and the size of the images: scaled, and within a limit in pixels.
    fn scaled(&self, scale: f32, limit: u32) -> LevelSize {
        let largest = self.largest.map(|n| n.min(limit));
        LevelSize { recommended: self.size, size: image_size(self.size, scale, largest), largest }
    }
}

/// The size in pixels that the runtime recommends for each eye of a level, that of the images, and the largest possible one.
#[derive(Clone, Copy)]
struct LevelSize {
    recommended: [u32; 2],
    size: [u32; 2],
    largest: [u32; 2],
}

impl System {
    /// Asks the runtime for the headset; `one_view` prefers one view to two, and `foveated` two views with insets.
    fn of(instance: &xr::Instance, one_view: bool, foveated: bool) -> Result<System, XrError> {
        let id = call("xrGetSystem", instance.system(xr::FormFactor::HEAD_MOUNTED_DISPLAY))?;
        let properties = call("xrGetSystemProperties", instance.system_properties(id))?;
        let configurations =
            call("xrEnumerateViewConfigurations", instance.enumerate_view_configurations(id))?;
        let (stereo, mono) =
            (xr::ViewConfigurationType::PRIMARY_STEREO, xr::ViewConfigurationType::PRIMARY_MONO);
        let wanted: &[_] = match (one_view, foveated) {
            (true, _) => &[mono, stereo],
            (false, true) => &[QUAD, stereo, mono],
            (false, false) => &[stereo, mono],
        };
        let views = wanted
            .iter()
            .copied()
            .find(|views| configurations.contains(views))
            .ok_or_else(|| XrError::InvalidRuntimeData("offers neither one view nor two".into()))?;
        let sizes = call(
            "xrEnumerateViewConfigurationViews",
            instance.enumerate_view_configuration_views(id, views),
        )?;
        let (eyes, insets) = sizes.split_at_checked(2).unwrap_or((&sizes, &[]));
        let levels = [eyes, insets].into_iter().take(if views == QUAD { 2 } else { 1 });
        let levels = levels.map(Recommended::of).collect::<Result<_, _>>()?;
        let blends =
            call("xrEnumerateEnvironmentBlendModes", instance.enumerate_environment_blend_modes(id, views))?;
        let opaque = xr::EnvironmentBlendMode::OPAQUE;
        let blend = match blends.first() {
            Some(first) if !blends.contains(&opaque) => *first,
            _ => opaque,
        };
        Ok(System { id, name: properties.system_name, views, levels, blend })
    }
}

/// The runtime's images that frames are drawn into.
struct FrameImages {
    /// Format of the eyes and the panel.
    color: u32,
    wide: RuntimeLevel,
    inset: Option<RuntimeLevel>,
    /// Format of the depth, and the pass that writes it.
    depth: Option<(u32, DepthCopy)>,
    panel: Option<PanelImages>,
    /// The formats that the runtime takes.
    formats: Vec<u32>,
}

impl FrameImages {
    fn new(
        graphics: &dyn Graphics,
        gl: &Rc<Context>,
        session: &xr::Session<xr::OpenGlEs>,
        sizes: &[LevelSize],
    ) -> Result<FrameImages, XrError> {
        let formats = call("xrEnumerateSwapchainFormats", session.enumerate_swapchain_formats())?;
        let color = storage::choose(&storage::COLOR_FORMATS, &formats).ok_or_else(|| {
            XrError::InvalidRuntimeData("offers no format of images that OpenGL ES can draw to".into())
        })?;
        let foveation = fixed_foveation::flags(session, gl);
        let level = |LevelSize { recommended, size, largest }: LevelSize| {
            let spec = ImageSpec { format: color, is_depth: false, is_sampled: true, size, foveation };
            let eyes = EyeImages::new(graphics, gl, session, spec)?;
            Ok::<_, XrError>(RuntimeLevel { eyes, depth: None, recommended, size, largest })
        };
        let mut levels = sizes.iter().map(|size| level(*size)).collect::<Result<Vec<_>, _>>()?;
        let depth = match session.instance().exts().khr_composition_layer_depth {
            Some(_) => {
                let made = make_depth(graphics, gl, session, &formats, &mut levels);
                optional("no depth is submitted", made)?.flatten()
            }
            None => None,
        };
        let size = [0, 1].map(|i| Panel::MAX_SIZE[i].max(Board::SIZE[i]));
        let panel = Images::new(
            graphics,
            gl,
            session,
            ImageSpec { format: color, is_depth: false, is_sampled: true, size, foveation: None },
        );
        let panel = optional("there is no HUD", panel)?.map(|images| PanelImages { images, version: None });
        let mut levels = levels.into_iter();
        let wide = levels.next().ok_or_else(|| XrError::InvalidRuntimeData("has no views".into()))?;
        Ok(FrameImages { color, wide, inset: levels.next(), depth, panel, formats })
    }
}

/// Makes images for the depth of all levels. Returns their format and the pass that writes them.
fn make_depth(
    graphics: &dyn Graphics,
    gl: &Rc<Context>,
    session: &xr::Session<xr::OpenGlEs>,
    formats: &[u32],
    levels: &mut [RuntimeLevel],
) -> Result<Option<(u32, DepthCopy)>, XrError> {
    let Some(format) = storage::choose(&storage::DEPTH_FORMATS, formats) else {
        log::info!("no depth is submitted: the runtime takes none of the formats of OpenGL ES");
        return Ok(None);
    };
    let images = |level: &RuntimeLevel| {
        let (size, foveation) = (level.size, None);
        let spec = ImageSpec { format, is_depth: true, is_sampled: false, size, foveation };
        EyeImages::new(graphics, gl, session, spec)
    };
    let (images, copy) = (levels.iter().map(images).collect::<Result<Vec<_>, _>>()?, DepthCopy::new(gl)?);
    for (level, images) in levels.iter_mut().zip(images) {
        level.depth = Some(images);
    }
    Ok(Some((format, copy)))
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
    let count = if views == xr::ViewConfigurationType::PRIMARY_MONO { 1 } else { 2 };
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
