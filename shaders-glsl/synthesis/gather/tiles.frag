#version 310 es
// Gather, pass 1: smallest and largest displacement of each source tile and of the column after it, so that every
// pair of neighbours, and with it every disocclusion, lies within one tile.

#include "include/tiles.glsl"

layout(location = 0) out uint tile;

void main() {
    ivec2 corner = ivec2(gl_FragCoord.xy) * TILE;
    float low = 1e9;
    float high = -1e9;
    for (int j = 0; j < TILE.y; ++j) {
        int row = min(corner.y + j, source_size.y - 1);
        for (int i = 0; i <= TILE.x; ++i) {
            float moved = displacement_at(min(corner.x + i, source_size.x - 1), row);
            low = min(low, moved);
            high = max(high, moved);
        }
    }
    tile = pack_interval(low, high);
}
