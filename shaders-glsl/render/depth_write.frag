// A view's depth into the depth buffer of another framebuffer.
#include "include/g_buffer.glsl"

uniform ivec2 offset;  // from a pixel of the target to its pixel in the depth map

void main() {
    gl_FragDepth = G_TEXEL(depth_map, ivec2(gl_FragCoord.xy) + offset).x;
}
