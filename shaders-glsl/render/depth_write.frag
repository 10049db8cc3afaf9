// A view's depth into the depth buffer of another framebuffer.
#include "include/depth_map.glsl"

uniform ivec2 offset;  // from a pixel of the target to its pixel in the depth map
uniform bool reverse;  // true if the target's convention is the other one

void main() {
    float depth = depth_of(ivec2(gl_FragCoord.xy) + offset);
    gl_FragDepth = reverse ? 1.0 - depth : depth;
}
