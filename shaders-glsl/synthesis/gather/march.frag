#version 310 es
// Gather, pass 3: for each target pixel, walk along the source row from the nearest candidate outwards.
//
// The first place where the displaced row crosses the pixel is the visible surface, and its fractional column is
// fetched with linear filtering. A silhouette that crosses the pixel is blended over what lies behind. Where the row jumps over the pixel from a farther to a nearer surface there is a
// disocclusion: the farthest such jump is remembered and the hole is filled from its background side.

#include "include/tiles.glsl"
#include "include/fill.glsl"

uniform highp usampler2D span_map;

layout(location = 0) out vec4 color;
#ifdef SOURCE_MAP
layout(location = 1) out uint source_entry;
#endif

void main() {
    ivec2 pixel = target_pixel();
    int row = pixel.y;
    float target = float(pixel.x);
    uint packed_span = texelFetch(span_map, pixel / TILE, 0).r;
    vec2 span = unpack_interval(packed_span);

    int last_column = source_size.x - 1;
    // A hundredth of a pixel for rounding: a crossing that starts at the interval's end must not be missed.
    int x = clamp(int(floor(target - span.y - 0.01)), 0, last_column);
    int last = clamp(int(ceil(target - span.x)) + 1, 0, last_column);
    if (packed_span == EMPTY_TILE) {
        // Beyond one of the source's borders: nothing but its outermost column is there to fill from.
        x = target < 0.5 * float(target_size.x) ? 0 : last_column;
        last = x;
    }
    float source = -1.0;
    float depth = 0.0;
    int edge = -1;
    float edge_displacement = 1e9;
    float edge_depth = 0.0;
    // The nearest silhouette beside the pixel: its column and depth, and how much of the pixel it covers.
    int rim = 0;
    float rim_depth = 0.0;
    float coverage = 0.0;

    float depth_a = depth_at(x, row);
    float a = float(x) + displacement(depth_a);
    if (x == 0 && a > target) {
        // Left of everything: the border of the image is the only background there is.
        source = a - target <= 0.5 ? 0.0 : -1.0;
        depth = depth_a;
        edge = 0;
        edge_displacement = a;
        edge_depth = depth_a;
    }
    for (++x; x <= last && source < 0.0; ++x) {
        float depth_b = depth_at(x, row);
        float b = float(x) + displacement(depth_b);
        if (a <= target) {
            float stretch = b - a;
            if (b > target) {
                if (stretch < MAX_STRETCH) {
                    float t = (target - a) / stretch;
                    source = float(x - 1) + t;
                    depth = mix(depth_a, depth_b, t);
                } else {
                    if (b - target < 1.0 && coverage == 0.0) {
                        rim = x;
                        rim_depth = depth_b;
                        coverage = 1.0 - (b - target);
                    }
                    if (target - a < 0.5) {
                        source = float(x - 1);
                        depth = depth_a;
                    } else if (a - float(x - 1) < edge_displacement) {
                        edge_displacement = a - float(x - 1);
                        edge = x - 1;
                        edge_depth = depth_a;
                    }
                }
            } else if (target - a < 1.0 && stretch < 0.0 && coverage == 0.0) {
                rim = x - 1;
                rim_depth = depth_a;
                coverage = 1.0 - (target - a);
            }
        }
        a = b;
        depth_a = depth_b;
    }
    if (source < 0.0 && edge < 0) {
        // Right of everything that the interval holds.
        edge = last;
        edge_depth = depth_a;
        if (a <= target && target - a < 0.5) {
            source = float(last);
            depth = depth_a;
        }
    }

    bool hole = source < 0.0;
    if (hole) {
        source = float(edge);
        depth = edge_depth;
    }
    color = fill_hole(hole, color_at(source, row), target, edge, displacement(edge_depth), row);
    // A silhouette lies anywhere between its last sample and the next one: blend by the share of the pixel that
    // it covers on average.
    for (int i = 0; i < (coverage > 0.0 ? 1 : 0); ++i) {
        color = mix(color, color_texel(rim, row), coverage);
    }
    if (coverage >= 0.5) {
        source = float(rim);
        depth = rim_depth;
        hole = false;
    }
#ifdef WRITE_DEPTH
    gl_FragDepth = depth;
#endif
#ifdef SOURCE_MAP
    source_entry = uint(source * FIXED + 0.5) | (hole ? HOLE : 0u);
#endif
}
