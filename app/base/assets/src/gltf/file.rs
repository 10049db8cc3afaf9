//! The glTF file: reads and checks its JSON, and reads its buffers.

use std::borrow::Cow;
use std::io::Read;
use std::path::Path;

use base64::Engine as _;
use gltf::Document;
use gltf::json::validation::{Checked, Error as Fault, Validate as _};
use serde_json::{Value, json};

use crate::error::{SceneError, file_size};
use crate::textures::find_file;

/// Maximum size of a buffer in bytes.
const MAX_BUFFER: u64 = 4 << 30;

pub(super) fn read_file(path: &Path) -> Result<Vec<u8>, SceneError> {
    let size = file_size(path)?;
    if size > MAX_BUFFER {
        return Err(SceneError::unusable(
            path,
            format!("it has {size} bytes, at most {MAX_BUFFER} can be read: split the model"),
        ));
    }
    let read = SceneError::read(path);
    let mut bytes = Vec::new();
    yoro_files::open(path).map_err(&read)?.take(MAX_BUFFER).read_to_end(&mut bytes).map_err(&read)?;
    Ok(bytes)
}

/// Parses a `.gltf` or `.glb` file. Returns its JSON and its binary part.
pub(super) fn parse(path: &Path, bytes: &[u8]) -> Result<(Document, Option<Vec<u8>>), SceneError> {
    let unusable = |what: String| SceneError::unusable(path, what);
    let invalid =
        |what: String| unusable(format!("this is not valid glTF 2.0 ({what}); export the model again"));
    let (text, blob) = if bytes.starts_with(b"glTF") {
        // The crate subtracts the header's size from this length unchecked.
        let length =
            bytes.get(8..).and_then(|rest| rest.first_chunk()).map(|bytes| u32::from_le_bytes(*bytes));
        if length.is_none_or(|length| length < 20) {
            return Err(unusable("the binary header is cut off; export the model again".into()));
        }
        let glb = gltf::Glb::from_slice(bytes).map_err(|e| invalid(e.to_string()))?;
        (glb.json, glb.bin.map(Cow::into_owned))
    } else {
        (Cow::Borrowed(bytes), None)
    };
    let mut root: Value = serde_json::from_slice(&text).map_err(|e| invalid(e.to_string()))?;
    drop(text);
    complete(&mut root);
    let root = serde_json::from_value(root).map_err(|e| invalid(e.to_string()))?;
    Ok((Document::from_json_without_validation(root), blob))
}

/// Adds what glTF 2.0 lets a file leave out but the crate requires, and removes the channels of animations that move no
/// node (KHR_animation_pointer).
fn complete(root: &mut Value) {
    let scenes = root.get_mut("scenes").and_then(Value::as_array_mut);
    for scene in scenes.into_iter().flatten().filter_map(Value::as_object_mut) {
        scene.entry("nodes").or_insert_with(|| json!([]));
    }
    let animations = root.get_mut("animations").and_then(Value::as_array_mut);
    for animation in animations.into_iter().flatten() {
        if let Some(channels) = animation.get_mut("channels").and_then(Value::as_array_mut) {
            channels
                .retain(|channel| !channel["target"].is_object() || channel["target"].get("node").is_some());
        }
    }
}

/// The extensions that are read, and those without which nothing looks different.
const KNOWN: [&str; 10] = [
    "EXT_mesh_gpu_instancing",
    "EXT_texture_webp",
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_unlit",
    "KHR_mesh_quantization",
    "KHR_texture_basisu",
    "KHR_texture_transform",
    "KHR_xmp_json_ld",
];

/// The extensions that compress geometry.
const COMPRESSION: [&str; 3] =
    ["KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression"];

/// Refuses extensions without which a file cannot be read, and warns about those that are left out. Must run first:
/// what such an extension leaves out may look like a mistake.
pub(super) fn check_extensions(path: &Path, document: &Document) -> Result<(), SceneError> {
    let root = document.as_json();
    // Without their extensions, materials look plainer and less moves; geometry cannot be read at all.
    let readable =
        |e: &str| KNOWN.contains(&e) || e.starts_with("KHR_materials_") || e == "KHR_animation_pointer";
    if let Some(e) = root.extensions_required.iter().find(|e| !readable(e)) {
        return Err(SceneError::unusable(
            path,
            format!("it needs the extension {e}, which is not supported: export the model without it"),
        ));
    }
    let mut left_out: Vec<&str> = root.extensions_used.iter().map(String::as_str).collect();
    left_out.retain(|e| !KNOWN.contains(e) && !COMPRESSION.contains(e));
    if !left_out.is_empty() {
        log::warn!("{}: what these extensions add is left out: {}", path.display(), left_out.join(", "));
    }
    Ok(())
}

/// Returns the extension that compresses a file's geometry, if it uses one.
pub(super) fn compression(document: &Document) -> Option<&'static str> {
    let used = &document.as_json().extensions_used;
    COMPRESSION.into_iter().find(|e| used.iter().any(|used| used == e))
}

/// Runs the crate's validation, except for extensions, and checks what it relies on without checking it.
pub(super) fn check(path: &Path, document: &Document) -> Result<(), SceneError> {
    let root = document.as_json();
    let mut fault = None;
    // The validation itself indexes with these unchecked.
    let primitives =
        root.meshes.iter().enumerate().flat_map(|(i, m)| m.primitives.iter().map(move |p| (i, p)));
    for (i, p) in primitives {
        if p.attributes.values().any(|a| a.value() >= root.accessors.len()) {
            return Err(SceneError::unusable(
                path,
                format!("mesh {i} names an accessor that does not exist; export the model again"),
            ));
        }
    }
    root.validate(root, gltf::json::Path::new, &mut |at, error| {
        let at = at().to_string();
        // Bounds of positions, and positions themselves, may be missing: nothing here needs them. An accessor without a
        // buffer view is all zeros.
        let needless = error == Fault::Missing
            && ([".min", ".max", "[\"POSITION\"]"].iter().any(|e| at.ends_with(e))
                || at.starts_with("accessors[") && at.ends_with(".bufferView"));
        if error != Fault::Unsupported && !needless && fault.is_none() {
            fault = Some(format!("{at}: {error}"));
        }
    });
    for (i, image) in root.images.iter().enumerate() {
        if image.uri.is_none() && (image.buffer_view.is_none() || image.mime_type.is_none()) {
            fault = fault.or(Some(format!("images[{i}] has no data or no type")));
        }
    }
    // The validation does not cover the targets of animations.
    for (i, animation) in root.animations.iter().enumerate() {
        for (k, target) in animation.channels.iter().map(|channel| &channel.target).enumerate() {
            if target.node.value() >= root.nodes.len() {
                fault =
                    fault.or(Some(format!("channel {k} of animation {i} moves a node that does not exist")));
            }
            if target.path == Checked::Invalid {
                fault = fault.or(Some(format!("channel {k} of animation {i} has an unknown path")));
            }
        }
    }
    if let Some(fault) = fault {
        return Err(SceneError::unusable(
            path,
            format!("this is not valid glTF 2.0 ({fault}); export the model again"),
        ));
    }
    Ok(())
}

/// Returns the bytes of all buffers.
pub(super) fn buffers(
    path: &Path,
    document: &Document,
    mut blob: Option<Vec<u8>>,
) -> Result<Vec<Vec<u8>>, SceneError> {
    document
        .buffers()
        .map(|buffer| {
            let data = match buffer.source() {
                gltf::buffer::Source::Bin => blob.take().ok_or_else(|| {
                    SceneError::unusable(path, "its binary part is missing; export the model again")
                })?,
                gltf::buffer::Source::Uri(uri) => match data_uri(uri) {
                    Some(data) => data.ok_or_else(|| {
                        SceneError::unusable(path, "an embedded buffer is damaged; export the model again")
                    })?,
                    None => read_file(&external(path, uri).ok_or_else(|| {
                        SceneError::unusable(
                            path,
                            format!("its buffer {uri} is missing: put it beside the file"),
                        )
                    })?)?,
                },
            };
            if data.len() < buffer.length() {
                let what = format!(
                    "buffer {} has {} bytes instead of {}; copy or export it again",
                    buffer.index(),
                    data.len(),
                    buffer.length()
                );
                return Err(SceneError::unusable(path, what));
            }
            Ok(data)
        })
        .collect()
}

/// Returns the bytes of a `data:` URI: `Some(None)` if they are damaged, `None` for other URIs.
pub(super) fn data_uri(uri: &str) -> Option<Option<Vec<u8>>> {
    let (head, data) = uri.strip_prefix("data:")?.split_once(',')?;
    Some(if head.ends_with(";base64") {
        base64::engine::general_purpose::STANDARD.decode(data.trim()).ok()
    } else {
        Some(percent_decoded(data))
    })
}

fn percent_decoded(text: &str) -> Vec<u8> {
    percent_encoding::percent_decode_str(text).collect()
}

pub(super) fn external(path: &Path, uri: &str) -> Option<std::path::PathBuf> {
    let folder = path.parent().unwrap_or(Path::new(""));
    find_file(folder, &String::from_utf8_lossy(&percent_decoded(uri))).or_else(|| find_file(folder, uri))
}
