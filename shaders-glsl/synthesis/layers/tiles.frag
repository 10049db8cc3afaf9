#version 310 es
// Gather over layers, pass 2: as gather/tiles.frag, of front and back.

#include "include/layers.glsl"

TEXTURE(2) uniform highp usampler2D layer_map;

layout(location = 0) out uint tile;

void main() {
    ivec2 corner = ivec2(gl_FragCoord.xy) * TILE;
    float low = 1e9;
    float high = 0.0;
    for (int j = 0; j < TILE.y; ++j) {
        int row = min(corner.y + j, source_size.y - 1);
        for (int i = 0; i <= TILE.x; ++i) {
            int x = min(corner.x + i, source_size.x - 1);
            uint layer = texelFetch(layer_map, ivec2(source_column(x), row), 0).r;
            vec2 both = is_full(layer) ? vec2(full_front(layer)) : split_displacements(layer);
            high = max(high, both.x);
            low = min(low, both.y);
        }
    }
    tile = pack_interval(far_displacement + low, far_displacement + high);
}
