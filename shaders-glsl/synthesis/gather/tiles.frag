#version 310 es
// Gather, pass 1: the smallest and the largest displacement of each source tile and of the column after it, so that
// every pair of neighbours, and with it every disocclusion, lies within one tile; also the plane of these
// displacements, if they are on one.

#include "include/planes.glsl"

layout(location = 0) out uvec4 tile;

void main() {
    // The argument is the forward column and the row of the tile's corner.
    tile = plane_tile((gl_FragCoord.xy - 0.5) * vec2(TILE));
}
