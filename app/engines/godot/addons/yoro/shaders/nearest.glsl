#[vertex]
#include "triangle.glslinc"

#[fragment]
#version 450
// The nearest depth of each pixel's samples; depth is 1 at the near plane.
layout(set = 0, binding = 0) uniform sampler2DMS samples;
layout(push_constant, std430) uniform Count {
    int count;
};
layout(location = 0) out float depth;

void main() {
    depth = 0.0;
    for (int i = 0; i < count; ++i) {
        depth = max(depth, texelFetch(samples, ivec2(gl_FragCoord.xy), i).r);
    }
}
