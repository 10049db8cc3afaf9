#version 310 es
// Gather, pass 2: for each target tile, the range of source columns that may land in it or, if these columns are of
// one continuous surface and affine in the target's, this law.

#include "include/tiles.glsl"

TEXTURE(2) uniform highp usampler2D tile_map;

#include "include/laws.glsl"

// A span with 0 in its second component, or a law, whose second component is never 0. The last component is 0 if a law's
// surface does not end at the tiles above and below.
layout(location = 0) out uvec4 span;

void main() {
    ivec2 tile = ivec2(gl_FragCoord.xy);
    float first = float(tile.x * TILE.x);
    float last = first + float(TILE.x - 1);
    int tiles = (source_size.x + TILE.x - 1) / TILE.x;
    int from = clamp(int(floor((first - near_displacement - 1.0) / float(TILE.x))) - 1, 0, tiles - 1);
    int to = clamp(int(floor((last - far_displacement + 1.0) / float(TILE.x))), 0, tiles - 1);
    // The displacements that move source tile `from` just to the first and just to the last target column, in units of
    // the tiles' intervals.
    const int PITCH = TILE.x * int(TILE_UNITS);
    int least = int(floor((first - 1.0 - far_displacement - float((from + 1) * TILE.x)) * TILE_UNITS));
    int most = int(ceil((last + 1.0 - far_displacement - float(from * TILE.x)) * TILE_UNITS));
    int low = 0xffff;
    int high = 0;
    // The first and the last tile that may land here.
    int left = tiles;
    int right = 0;
    // By how much the tiles above and below reach farther than these, in units of displacement.
    int drop = 0;
    ivec2 beside = clamp(tile.y + ivec2(-1, 1), 0, (source_size.y - 1) / TILE.y);
    for (int s = from; s <= to; ++s) {
        uint moved = texelFetch(tile_map, ivec2(s, tile.y), 0).r;
        int own = int(moved & 0xffffu);
        int lowest = max(own, least);
        int highest = min(int(moved >> 16), most);
        if (lowest <= highest) {
            low = min(low, lowest);
            high = max(high, highest);
            left = min(left, s);
            right = s;
            uint below = texelFetch(tile_map, ivec2(s, beside.x), 0).r & 0xffffu;
            uint above = texelFetch(tile_map, ivec2(s, beside.y), 0).r & 0xffffu;
            drop = max(drop, own - int(min(below, above)));
        }
        least -= PITCH;
        most -= PITCH;
    }
    if (high < low) {
        // Beyond a border of the source, the search starts at its outermost column.
        low = high = 2 * tile.x * TILE.x < target_size.x ? 0xffff : 0;
    }
    // From the first candidate to the last one, each rounded outwards, and one more to close the last pair.
    uint search = pack_span(float(high) / TILE_UNITS, ceil(float(high - low) / TILE_UNITS) + 2.0);
    span = uvec4(search, 0u, 0u, 1u);
    vec3 affine = tile_plane(tile, left, right);
    if (affine.y != 0.0) {
        // On the law's plane, they reach farther by no more than the rise from tile to tile.
        float rise = abs(affine.z / columns.x) * float(TILE.y);
        span = uvec4(floatBitsToUint(affine), uint(float(drop) > (rise + ROW_GAP) * TILE_UNITS));
    }
}
