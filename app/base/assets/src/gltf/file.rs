//! The glTF file: checks its JSON and reads its buffers.

use std::io::Read;
use std::path::Path;

use base64::Engine as _;
use gltf::Document;
use gltf::json::validation::{Checked, Error as Fault, Validate as _};

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
    let read = |source| SceneError::Read { path: path.into(), source };
    let mut bytes = Vec::new();
    yoro_files::open(path).map_err(read)?.take(MAX_BUFFER).read_to_end(&mut bytes).map_err(read)?;
    Ok(bytes)
}

/// Refuses extensions that cannot be read. Must run first: what such an extension leaves out may look like a mistake.
pub(super) fn check_extensions(path: &Path, document: &Document) -> Result<(), SceneError> {
    let root = document.as_json();
    // Without their extensions, materials look plainer; geometry cannot be read at all.
    let readable = |e: &str| {
        e.starts_with("KHR_materials_")
            || [
                "KHR_texture_transform",
                "KHR_lights_punctual",
                "KHR_mesh_quantization",
                "EXT_texture_webp",
                "KHR_texture_basisu",
            ]
            .contains(&e)
    };
    match root.extensions_required.iter().find(|e| !readable(e)) {
        Some(e) => Err(SceneError::unusable(
            path,
            format!("it needs the extension {e}, which is not supported: export the model without it"),
        )),
        None => Ok(()),
    }
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
            format!("this is no valid glTF 2.0 ({fault}); export the model again"),
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
    let bytes = text.as_bytes();
    let mut out = Vec::with_capacity(bytes.len());
    let mut i = 0;
    while i < bytes.len() {
        let code = (bytes[i] == b'%').then(|| bytes.get(i + 1..i + 3)).flatten();
        let byte =
            code.and_then(|c| std::str::from_utf8(c).ok()).and_then(|c| u8::from_str_radix(c, 16).ok());
        out.push(byte.unwrap_or(bytes[i]));
        i += if byte.is_some() { 3 } else { 1 };
    }
    out
}

pub(super) fn external(path: &Path, uri: &str) -> Option<std::path::PathBuf> {
    let folder = path.parent().unwrap_or(Path::new(""));
    find_file(folder, &String::from_utf8_lossy(&percent_decoded(uri))).or_else(|| find_file(folder, uri))
}
