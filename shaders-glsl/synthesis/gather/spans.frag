#version 310 es
// Gather, pass 2: for each target tile, the range of source columns that may land in it.

#include "include/tiles.glsl"

TEXTURE(2) uniform highp usampler2D tile_map;

layout(location = 0) out uint span;

void main() {
    ivec2 tile = ivec2(gl_FragCoord.xy);
    float first = float(tile.x * TILE.x);
    float last = first + float(TILE.x - 1);
    int tiles = (source_size.x + TILE.x - 1) / TILE.x;
    int from = clamp(int(floor((first - near_displacement - 1.0) / float(TILE.x))) - 1, 0, tiles - 1);
    int to = clamp(int(floor((last - far_displacement + 1.0) / float(TILE.x))), 0, tiles - 1);
    // In units of the tiles' intervals: the displacements that take source tile `from` just to the first and just to
    // the last target column.
    const int PITCH = TILE.x * int(TILE_UNITS);
    int least = int(floor((first - 1.0 - far_displacement - float((from + 1) * TILE.x)) * TILE_UNITS));
    int most = int(ceil((last + 1.0 - far_displacement - float(from * TILE.x)) * TILE_UNITS));
    int low = 0xffff;
    int high = 0;
    for (int s = from; s <= to; ++s) {
        uint moved = texelFetch(tile_map, ivec2(s, tile.y), 0).r;
        int lowest = max(int(moved & 0xffffu), least);
        int highest = min(int(moved >> 16), most);
        if (lowest <= highest) {
            low = min(low, lowest);
            high = max(high, highest);
        }
        least -= PITCH;
        most -= PITCH;
    }
    if (high < low) {
        // Beyond a border of the source: its outermost column is where to start.
        low = high = 2 * tile.x * TILE.x < target_size.x ? 0xffff : 0;
    }
    // To the last candidate from the first, each rounded away, and one to close the last pair.
    span = pack_span(float(high) / TILE_UNITS, ceil(float(high - low) / TILE_UNITS) + 2.0);
}
