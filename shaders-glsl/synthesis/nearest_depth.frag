#version 310 es
// The depth of each pixel's nearest sample, for graphics interfaces that do not resolve depth. With REVERSED, larger
// depth is nearer.

#include "include/interface.glsl"

TEXTURE(0) uniform highp sampler2DMS sample_depths;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float nearest = texelFetch(sample_depths, pixel, 0).r;
    for (int i = 1; i < textureSamples(sample_depths); ++i) {
        float depth = texelFetch(sample_depths, pixel, i).r;
#ifdef REVERSED
        nearest = max(nearest, depth);
#else
        nearest = min(nearest, depth);
#endif
    }
    gl_FragDepth = nearest;
}
