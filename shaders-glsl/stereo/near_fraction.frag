#version 310 es
// The share of a depth image that is nearer than a given depth: each of 16 x 16 texels counts 8 x 8 pixels of its part
// of the image.

#include "include/depth_map.glsl"

uniform ivec2 origin;
uniform ivec2 size;
uniform float near_depth;
uniform bool reversed;

layout(location = 0) out vec4 fraction;

const int GRID = 16;
const int SAMPLES = 8;

void main() {
    ivec2 cell = ivec2(gl_FragCoord.xy) * SAMPLES;
    float count = 0.0;
    for (int j = 0; j < SAMPLES; ++j) {
        for (int i = 0; i < SAMPLES; ++i) {
            ivec2 pixel = origin + ((cell + ivec2(i, j)) * 2 + 1) * size / (2 * GRID * SAMPLES);
            float depth = depth_of(pixel);
            count += (reversed ? depth > near_depth : depth < near_depth) ? 1.0 : 0.0;
        }
    }
    fraction = vec4(count / float(SAMPLES * SAMPLES));
}
