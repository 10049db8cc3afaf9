//! The manifest with which loaders find the layer.

use std::path::Path;

/// The name of the layer, as in XR_ENABLE_API_LAYERS.
pub const NAME: &str = "XR_APILAYER_YORO_one_view";
/// The file name of the manifest.
pub const MANIFEST: &str = "XR_APILAYER_YORO_one_view.json";
/// If this variable is set to any value, loaders load the implicit layer.
pub const ENABLE: &str = "YORO_LAYER_ENABLE";
/// If this variable is set to any value, loaders do not load the implicit layer.
pub const DISABLE: &str = "YORO_LAYER_DISABLE";

/// The applications in which loaders load the layer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Applications that request it by name.
    Explicit,
    /// Applications that run with [`ENABLE`].
    Implicit,
    /// The application that it is packaged with. Loaders on Android do not read these variables.
    Packaged,
}

/// Returns the text of the manifest for the layer's library at this path.
pub fn manifest(library: &Path, kind: Kind) -> String {
    let mut layer = serde_json::json!({
        "name": NAME,
        "library_path": library,
        "api_version": "1.1",
        "implementation_version": "1",
        "description": "One rendered view becomes two",
        "instance_extensions": [
            { "name": "XR_KHR_composition_layer_depth", "extension_version": "6", "entrypoints": [] }
        ],
    });
    if kind == Kind::Implicit {
        layer["enable_environment"] = ENABLE.into();
    }
    if kind != Kind::Explicit {
        layer["disable_environment"] = DISABLE.into();
    }
    format!("{:#}\n", serde_json::json!({ "file_format_version": "1.0.0", "api_layer": layer }))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An application has the manifest in its assets, and Android finds the library by name.
    #[test]
    fn the_packaged_manifest_is_the_generated_one() {
        let json = |text: &str| serde_json::from_str::<serde_json::Value>(text).unwrap();
        let packaged = json(include_str!("../android/XR_APILAYER_YORO_one_view.json"));
        assert_eq!(packaged, json(&manifest(Path::new("libyoro_openxr_layer.so"), Kind::Packaged)));
    }

    #[test]
    fn only_an_implicit_layer_needs_to_be_enabled_by_a_variable() {
        for (kind, enable, disable) in
            [(Kind::Explicit, false, false), (Kind::Implicit, true, true), (Kind::Packaged, false, true)]
        {
            let text = manifest(Path::new("/lib/libyoro_openxr_layer.so"), kind);
            let json: serde_json::Value = serde_json::from_str(&text).unwrap();
            let layer = &json["api_layer"];
            assert_eq!(
                (&layer["name"], &layer["library_path"]),
                (&NAME.into(), &"/lib/libyoro_openxr_layer.so".into())
            );
            assert_eq!(layer["instance_extensions"][0]["name"], "XR_KHR_composition_layer_depth");
            assert_eq!(layer.get("enable_environment").is_some(), enable);
            assert_eq!(layer.get("disable_environment").is_some(), disable);
        }
    }
}
