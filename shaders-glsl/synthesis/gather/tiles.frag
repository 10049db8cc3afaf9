#version 310 es
// Gather, pass 1: the smallest and the largest displacement of each source tile and of the column after it, so that
// every pair of neighbours, and with it every disocclusion, lies within one tile. With SHORT_WAY, also the plane of
// these displacements, if they are on one.

#include "include/tiles.glsl"
#ifdef SHORT_WAY
#include "include/planes.glsl"
#endif

layout(location = 0) out uvec4 tile;

void main() {
    // Forward column and row of the tile's corner.
    vec2 corner = (gl_FragCoord.xy - 0.5) * vec2(TILE);
#ifdef SHORT_WAY
    tile = plane_tile(corner);
#else
    float least = 1e9;
    float most = -1e9;
#ifdef TEXTURE_GATHER
    // Each fetch takes 2 x 2 texels and each pass two rows. The last pair of columns overlaps the one before.
    vec4 low = vec4(1e9);
    vec4 high = vec4(-1e9);
    // A loop that no compiler unrolls: all fetches in flight at once would take most of the registers.
    for (float row = corner.y; row < corner.y + float(TILE.y); row += 2.0) {
        for (int i = 0; i <= TILE.x; i += 2) {
            vec4 depths = depth_quad(vec2(corner.x + float(min(i, TILE.x - 1)), row));
            low = min(low, depths);
            high = max(high, depths);
        }
    }
    low.xy = min(low.xy, low.zw);
    high.xy = max(high.xy, high.zw);
    least = min(low.x, low.y);
    most = max(high.x, high.y);
#else
    for (int j = 0; j < TILE.y; ++j) {
        int row = min(int(corner.y) + j, source_size.y - 1);
        for (int i = 0; i <= TILE.x; ++i) {
            float depth = depth_at(min(int(corner.x) + i, source_size.x - 1), row);
            least = min(least, depth);
            most = max(most, depth);
        }
    }
#endif
    float a = displacement(least);
    float b = displacement(most);
    tile = uvec4(pack_interval(min(a, b), max(a, b)), 0u, 0u, 0u);
#endif
}
