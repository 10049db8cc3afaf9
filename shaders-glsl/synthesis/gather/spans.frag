#version 310 es
// Gather, pass 2: for each target tile, the interval of displacements of the source pixels that can land in it.

#include "include/tiles.glsl"

uniform highp usampler2D tile_map;
// Displacement of the near plane: bounds how far away a source tile can be.
uniform float near_displacement;

layout(location = 0) out uint span;

void main() {
    ivec2 tile = ivec2(gl_FragCoord.xy);
    float first = float(tile.x * TILE.x);
    float last = first + float(TILE.x - 1);
    int tiles = (source_size.x + TILE.x - 1) / TILE.x;
    int from = clamp(int(floor((first - near_displacement - 1.0) / float(TILE.x))) - 1, 0, tiles - 1);
    int to = clamp(int(floor((last - far_displacement + 1.0) / float(TILE.x))), 0, tiles - 1);
    float low = 1e9;
    float high = -1e9;
    for (int s = from; s <= to; ++s) {
        vec2 moved = unpack_interval(texelFetch(tile_map, ivec2(s, tile.y), 0).r);
        float source_first = float(s * TILE.x);
        float source_last = source_first + float(TILE.x);
        if (source_last + moved.y >= first - 1.0 && source_first + moved.x <= last + 1.0) {
            low = min(low, max(moved.x, first - source_last - 1.0));
            high = max(high, min(moved.y, last - source_first + 1.0));
        }
    }
    span = high < low ? EMPTY_TILE : pack_interval(low, high);
}
