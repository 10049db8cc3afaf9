// Averages the sixteen rotations of the occlusion pattern, on one surface.
#include "include/occlusion.glsl"

uniform sampler2D occlusion_map;

layout(location = 0) out vec4 out_occlusion;

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    ivec2 last = textureSize(occlusion_map, 0) - 1;
    vec4 center = texelFetch(occlusion_map, p, 0);
    float code = unpack_code(center);
    vec2 sum = vec2(center.x, 1.0) * 0.01;
    for (int y = -2; y < 2; ++y) {
        for (int x = -2; x < 2; ++x) {
            vec4 texel = texelFetch(occlusion_map, clamp(p + ivec2(x, y), ivec2(0), last), 0);
            float weight = same_surface(code, unpack_code(texel));
            sum += weight * vec2(texel.x, 1.0);
        }
    }
    out_occlusion = vec4(sum.x / sum.y, center.yz, 1.0);
}
