#[versions]
nearest = "#define SAMPLES";
single = "#define COLOR";
both = "#define SAMPLES\n#define COLOR";

#[vertex]
#include "triangle.glslinc"

#[fragment]
#version 450
#VERSION_DEFINES
// A part of an image: its depth, with SAMPLES the nearest of each pixel's, and with COLOR its colour. Depth is 1 at the
// near plane.
#ifdef SAMPLES
layout(set = 0, binding = 0) uniform sampler2DMS depth_map;
#else
layout(set = 0, binding = 0) uniform sampler2D depth_map;
#endif
#ifdef COLOR
layout(set = 0, binding = 1) uniform sampler2D color_map;
layout(location = 1) out vec4 color;
#endif
layout(push_constant, std430) uniform Place {
    ivec2 corner;
    // The number of samples.
    int count;
};
layout(location = 0) out float depth;

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy) + corner;
#ifdef SAMPLES
    depth = 0.0;
    for (int i = 0; i < count; ++i) {
        depth = max(depth, texelFetch(depth_map, texel, i).r);
    }
#else
    depth = texelFetch(depth_map, texel, 0).r;
#endif
#ifdef COLOR
    color = texelFetch(color_map, texel, 0);
#endif
}
