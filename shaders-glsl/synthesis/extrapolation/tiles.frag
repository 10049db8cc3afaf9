#version 310 es
// Extrapolation, pass 1: the motion of the fastest and of the nearest moving surface of each tile, in pixels; 0 if none
// moves. Looks at each fourth pixel along each axis.

#include "include/extrapolation.glsl"

layout(location = 0) out vec4 motions;

void main() {
    ivec2 first = ivec2(gl_FragCoord.xy) * REACH;
    motions = vec4(0.0);
    float nearest = -1.0;
    for (int i = 0; i < 64; ++i) {
        ivec2 pixel = min(first + ivec2(i % 8, i / 8) * 4 + 2, ivec2(size) - 1);
        vec3 motion = motion_of(pixel);
        if (!stands(motion)) {
            bool faster = dot(motion.xy, motion.xy) > dot(motions.xy, motions.xy);
            motions.xy = faster ? motion.xy : motions.xy;
            motions.zw = motion.z > nearest ? motion.xy : motions.zw;
            nearest = max(nearest, motion.z);
        }
    }
}
