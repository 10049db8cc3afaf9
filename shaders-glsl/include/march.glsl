#include "include/span.glsl"
#include "include/fill.glsl"
#ifdef HISTORY
// law.y * depth of a forward column.
float nearness_at(int x, int row) {
    return law.y * depth_at(x, row);
}
#include "include/history.glsl"
#endif

TEXTURE(2) uniform highp usampler2D tile_map;

// The surface that a target pixel shows: fractional source column and depth. For a hole they are those of the column from
// which it is filled.
struct Surface {
    float source;
    float depth;
    bool hole;
};

// Tiles that are always walked: skipping pays only where there are many.
const float FIRST_TILES = 4.0;

// From column `x` on, where a tile begins, the first one whose tile lands within a pixel of this one, or that of the
// last tile before `end`. Beside the silhouettes of near surfaces that is hundreds of columns away. The far plane's
// surface lands here from column `origin`.
float next_candidate(float x, float end, float origin, int row) {
    bool lands = false;
    while (x + float(TILE.x) < end && !lands) {
        COUNT_TRIP(4)
        uint moved = texelFetch(tile_map, ivec2(int(x), row) / TILE, 0).r;
        vec2 at = x - origin + vec2(moved & 0xffffu, moved >> 16) / TILE_UNITS;
        lands = at.x <= 1.0 && at.y + float(TILE.x) >= -1.0;
        x += lands ? 0.0 : float(TILE.x);
    }
    return x;
}
