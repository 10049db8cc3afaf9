#version 310 es
// Any view, pass 1: the smallest and the largest stored depth of each source tile and of the pixels around it. On each
// axis, these are one pixel before the tile and two after it, since a sample just beyond the tile has its second pixel
// there.

#include "include/any_view.glsl"

// The bits of the smallest and of the largest depth.
layout(location = 0) out uvec4 tile;

void main() {
    ivec2 corner = ivec2(gl_FragCoord.xy) * TILE;
    ivec2 last = source_size - 1;
    float least = 1e9;
    float most = -1e9;
    for (int y = -1; y <= TILE.y + 1; ++y) {
        for (int x = -1; x <= TILE.x + 1; ++x) {
            ivec2 pixel = clamp(corner + ivec2(x, y), ivec2(0), last);
            float depth = depth_texel(pixel.x, pixel.y);
            least = min(least, depth);
            most = max(most, depth);
        }
    }
    tile = uvec4(floatBitsToUint(least), floatBitsToUint(most), 0u, 0u);
}
