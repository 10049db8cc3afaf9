// Clears the depth that include/carried.glsl carries, in the samples and channels that the masks let through. Blending
// with alpha 0 leaves the picture as it is, and alpha 1 replaces.
layout(location = 0) out vec4 out_color;
layout(location = 1) out vec4 out_depth;

void main() {
    out_color = vec4(0.0);
    out_depth = vec4(0.0, 0.0, 0.0, 1.0);
}
