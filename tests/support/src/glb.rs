//! A model in one file.

/// Returns a GLB file with one triangle, 2 m in front of the origin.
pub fn triangle() -> Vec<u8> {
    let json = br#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"buffers":[{"byteLength":36}],
        "bufferViews":[{"buffer":0,"byteLength":36}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,
        "type":"VEC3","min":[-0.5,-0.5,-2],"max":[0.5,0.5,-2]}]}"#;
    let mut json = json.to_vec();
    json.resize(json.len().next_multiple_of(4), b' ');
    let corners = [[-0.5, -0.5, -2.0], [0.5, -0.5, -2.0], [0.0, 0.5, -2.0_f32]];
    let binary: Vec<u8> = corners.iter().flatten().flat_map(|n| n.to_le_bytes()).collect();
    let word = |n: usize| (n as u32).to_le_bytes();
    let length = 12 + 8 + json.len() + 8 + binary.len();
    let head = [*b"glTF", word(2), word(length), word(json.len()), *b"JSON"].concat();
    [head, json, word(binary.len()).to_vec(), b"BIN\0".to_vec(), binary].concat()
}
