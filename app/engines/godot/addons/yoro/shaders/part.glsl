#[versions]
depth = "";
nearest = "#define SAMPLES";
single = "#define COLOR";
both = "#define SAMPLES\n#define COLOR";
holes = "#define COLOR\n#define HOLES";
holes_nearest = "#define SAMPLES\n#define COLOR\n#define HOLES";

#[vertex]
#include "triangle.glslinc"

#[fragment]
#version 450
#VERSION_DEFINES
// A part of an image: its depth, with SAMPLES the nearest of each pixel's, and with COLOR its colour. Depth is 1 at the
// near plane. With HOLES, the depth goes to the depth buffer, and what is at the near plane is left out.
#ifdef SAMPLES
layout(set = 0, binding = 0) uniform sampler2DMS depth_map;
#else
layout(set = 0, binding = 0) uniform sampler2D depth_map;
#endif
#ifdef COLOR
layout(set = 0, binding = 1) uniform sampler2D color_map;
#endif
#ifdef HOLES
layout(location = 0) out vec4 color;
#else
layout(location = 0) out float depth;
#ifdef COLOR
layout(location = 1) out vec4 color;
#endif
#endif
layout(push_constant, std430) uniform Place {
    ivec2 corner;
    // The number of samples.
    int count;
};

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy) + corner;
#ifdef SAMPLES
    float nearest = 0.0;
    for (int i = 0; i < count; ++i) {
        nearest = max(nearest, texelFetch(depth_map, texel, i).r);
    }
#else
    float nearest = texelFetch(depth_map, texel, 0).r;
#endif
#ifdef COLOR
    color = texelFetch(color_map, texel, 0);
#endif
#ifdef HOLES
    if (nearest == 1.0) {
        discard;
    }
    gl_FragDepth = nearest;
#else
    depth = nearest;
#endif
}
