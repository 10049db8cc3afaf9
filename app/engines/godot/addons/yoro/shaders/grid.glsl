#[vertex]
#include "triangle.glslinc"

#[fragment]
#version 450
// Depth at the points of a coarse grid.
layout(set = 0, binding = 0) uniform sampler2D depth_map;
layout(push_constant, std430) uniform Grid {
    // The size of a point's cell in pixels of the depth map.
    vec2 pitch;
};
layout(location = 0) out float depth;

void main() {
    depth = texelFetch(depth_map, ivec2(gl_FragCoord.xy * pitch), 0).r;
}
