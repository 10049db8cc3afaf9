#[vertex]
#include "triangle.glslinc"

#[fragment]
#version 450
// Puts an eye's colour and depth into the buffers that Godot renders into.
layout(set = 0, binding = 0) uniform sampler2D depth_map;
layout(set = 0, binding = 1) uniform sampler2D color_map;
layout(set = 0, binding = 2) uniform usampler2D source_map;
layout(push_constant, std430) uniform Place {
    // The eye's corner in its image, and its pixels per pixel of the target.
    vec2 corner;
    vec2 pitch;
    // YoroCamera3D.DebugView
    int debug_view;
    float disparity;
};
layout(location = 0) out vec4 color;

const int HOLES = 1;
const int DISPARITY = 2;

void main() {
    vec2 at = corner + gl_FragCoord.xy * pitch;
    ivec2 texel = min(ivec2(at), textureSize(depth_map, 0) - 1);
    float depth = texelFetch(depth_map, texel, 0).r;
    color = texture(color_map, at / vec2(textureSize(color_map, 0)));
    if (debug_view == HOLES && (texelFetch(source_map, texel, 0).r & 0x80000000u) != 0u) {
        color.rgb = vec3(1.0, 0.0, 1.0);
    } else if (debug_view == DISPARITY) {
        color.rgb = vec3(abs(disparity * depth));
    }
    gl_FragDepth = depth;
}
