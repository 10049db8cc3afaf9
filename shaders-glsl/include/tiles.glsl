#include "include/warp.glsl"

// Tiles in forward columns and source rows. A tile holds two displacements, relative to the far plane's, in
// 1/16 pixel, in one 32-bit integer: ES renders to R32UI everywhere.

const ivec2 TILE = ivec2(8, 8);
const uint EMPTY_TILE = 0x0000ffffu;

// Displacement of the far plane: the smallest there is.
uniform float far_displacement;

uint pack_interval(float low, float high) {
    float lowest = clamp(floor((low - far_displacement) * 16.0), 0.0, 65534.0);
    float highest = clamp(ceil((high - far_displacement) * 16.0), 0.0, 65535.0);
    return uint(lowest) | (uint(highest) << 16);
}

vec2 unpack_interval(uint tile) {
    return vec2(float(tile & 0xffffu), float(tile >> 16)) / 16.0 + far_displacement;
}
