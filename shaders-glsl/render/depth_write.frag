// A view's depth into the depth buffer of another framebuffer.
#include "include/depth_map.glsl"

uniform vec4 place;    // from a place in the target to its place in the depth map, in pixels: place.xy * p + place.zw
uniform bool reverse;  // true if the target's convention is the other one

void main() {
    ivec2 last = textureSize(depth_map, 0).xy - 1;
    float depth = depth_of(clamp(ivec2(floor(place.xy * gl_FragCoord.xy + place.zw)), ivec2(0), last));
    gl_FragDepth = reverse ? 1.0 - depth : depth;
}
