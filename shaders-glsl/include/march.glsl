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

// The surface that a target pixel shows: fractional source column and depth. For a hole they are those of the column
// from which it is filled.
struct Surface {
    float source;
    float depth;
    bool hole;
};
