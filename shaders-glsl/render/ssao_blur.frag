// Averages the sixteen rotations of the occlusion pattern within one surface.
#include "include/occlusion.glsl"

uniform sampler2D occlusion_map;

layout(location = 0) out vec4 out_occlusion;

// Returns the smaller of the differences on both sides: the one that stays on the surface.
float slope(float before, float center, float after) {
    float a = center - before, b = after - center;
    return abs(a) < abs(b) ? a : b;
}

#define CODE(x, y) unpack_code(texelFetch(occlusion_map, clamp(p + ivec2(x, y), ivec2(0), last), 0))

float blur(ivec2 p, vec4 center) {
    ivec2 last = textureSize(occlusion_map, 0) - 1;
    float code = unpack_code(center);
    vec2 gradient = vec2(slope(CODE(-1, 0), code, CODE(1, 0)), slope(CODE(0, -1), code, CODE(0, 1)));
    vec2 sum = vec2(center.x, 1.0) * 0.01;
    for (int y = -2; y < 2; ++y) {
        for (int x = -2; x < 2; ++x) {
            vec4 texel = center;
            if (x != 0 || y != 0) {
                texel = texelFetch(occlusion_map, clamp(p + ivec2(x, y), ivec2(0), last), 0);
            }
            float weight = same_surface(code + dot(gradient, vec2(x, y)), unpack_code(texel));
            sum += weight * vec2(texel.x, 1.0);
        }
    }
    return sum.x / sum.y;
}

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec4 center = texelFetch(occlusion_map, p, 0);
    out_occlusion = center;
    if (center.w > 0.0) {
        out_occlusion.x = blur(p, center);
    }
}
