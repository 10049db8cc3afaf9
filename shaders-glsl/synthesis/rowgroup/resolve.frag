#version 310 es
// Rowgroup, pass 2: fetch the colour of each source map entry, fill the holes.

#include "include/fill.glsl"

uniform highp usampler2D source_map;

layout(location = 0) out vec4 color;
#ifdef SOURCE_MAP
layout(location = 1) out uint source_entry;
#endif

void main() {
    ivec2 pixel = target_pixel();
    uint entry = texelFetch(source_map, ivec2(gl_FragCoord.xy) - target_origin, 0).r;
    float source = float(entry & ~HOLE) / FIXED;
    int nearest = min(int(source + 0.5), source_size.x - 1);
    float depth = depth_at(nearest, pixel.y);
    bool hole = (entry & HOLE) != 0u;
    source = hole ? float(nearest) : source;
    color = fill_hole(hole, color_at(source, pixel.y), float(pixel.x), nearest,
        displacement(depth), pixel.y);
#ifdef WRITE_DEPTH
    gl_FragDepth = depth;
#endif
#ifdef SOURCE_MAP
    source_entry = entry;
#endif
}
