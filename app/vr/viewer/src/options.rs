//! What the renderer and the stereo methods get from the viewer's settings.

use yoro_gl::Capabilities;
use yoro_render::stereo::{NearFieldPolicy, PaperOptions, Pipeline, PipelineOptions, StereoOptions};
use yoro_render::{MAX_POINT_LIGHTS, RenderSettings};
use yoro_settings::{MSAA, Settings};

/// Returns the renderer's settings for those of the viewer. If the driver is known and lacks the number of samples, it is
/// the next smaller one that the driver has.
pub fn render_settings(settings: &Settings, capabilities: Option<&Capabilities>) -> RenderSettings {
    let has = |samples: &u32| capabilities.is_none_or(|driver| driver.check_samples(*samples).is_ok());
    let msaa = MSAA.into_iter().rev().filter(|samples| *samples <= settings.msaa).find(has);
    RenderSettings {
        msaa: msaa.unwrap_or(1),
        shadow_map_size: settings.shadow_map,
        bloom: settings.bloom,
        // Phones shade each of them in each pixel.
        point_lights: MAX_POINT_LIGHTS / 2,
        ..RenderSettings::default()
    }
}

/// Returns the options of the methods for the viewer's settings. `pipeline` may differ from that of the settings if the
/// driver does not support the latter.
pub fn stereo_options(settings: &Settings, pipeline: Pipeline) -> StereoOptions {
    let options = StereoOptions::of_pipeline(pipeline);
    let paper = PaperOptions {
        imbuffer: settings.imbuffer,
        linear_interpolation: settings.linear_interpolation,
        strict: settings.strict,
    };
    StereoOptions {
        synthesis: PipelineOptions { paper, ..options.synthesis },
        guard_band: settings.guard_band.unwrap_or(options.guard_band),
        holes: settings.holes,
        policy: settings.switch.then(NearFieldPolicy::default),
        // A display whose runtime makes frames asks for them.
        motion_vectors: false,
        frame_rate: settings.frame_rate,
        ..options
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every option of the methods must have a setting, be the display's, or belong to a method's definition.
    #[test]
    fn every_stereo_option_has_a_setting() {
        let changed = Settings::resolve(
            None,
            [
                "imbuffer=4",
                "linear-interpolation=false",
                "strict=true",
                "guard-band=40px",
                "holes=rendered",
                "switch=false",
                "frame-rate=half",
            ],
        );
        let [changed, default] = [changed.unwrap(), Settings::default()]
            .map(|s| serde_json::json!(stereo_options(&s, Pipeline::Paper)));
        assert_eq!(
            serde_json::json!(stereo_options(&Settings::default(), Pipeline::Gather)),
            serde_json::json!(StereoOptions::default())
        );
        fn unchanged(path: &str, a: &serde_json::Value, b: &serde_json::Value) -> Vec<String> {
            match (a.as_object(), b.as_object()) {
                (Some(a), Some(b)) => {
                    a.iter().flat_map(|(key, a)| unchanged(&format!("{path}.{key}"), a, &b[key])).collect()
                }
                _ => (a == b).then(|| path.to_owned()).into_iter().collect(),
            }
        }
        assert_eq!(
            unchanged("", &changed, &default),
            [".motion-vectors", ".split-disparity", ".synthesis.pipeline"]
        );
    }
}
