// Gives half of a pixel's samples at a surface's edge the depth behind the surface, by alpha to coverage. An image has
// the front's depth in every pixel that the front touches, although it covers only half of such a pixel on average.
#include "include/view.glsl"

uniform sampler2D depth_map;
uniform ivec2 offset;  // from a pixel of the target to its pixel in the map

layout(location = 0) out vec4 out_coverage;

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy) + offset;
    ivec2 last = textureSize(depth_map, 0) - 1;
    float depth = texelFetch(depth_map, p, 0).x;
    float behind = depth;
    for (int i = 0; i < 4; ++i) {
        ivec2 step = i < 2 ? ivec2(2 * i - 1, 0) : ivec2(0, 2 * i - 5);
        float there = texelFetch(depth_map, clamp(p + step, ivec2(0), last), 0).x;
        behind = inverse_distance.y * (behind - there) > 0.0 ? there : behind;
    }
    // A slanted surface is not an edge.
    float c = inverse_distance.x + inverse_distance.y * depth;
    if (inverse_distance.y * (depth - behind) < 0.05 * c) {
        discard;
    }
    gl_FragDepth = behind;
    out_coverage = vec4(0.5);
}
