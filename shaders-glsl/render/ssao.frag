// Ambient occlusion at 1 / SCALE of the resolution, after McGuire et al., "Scalable Ambient Obscurance" (HPG 2012).
#include "include/view.glsl"
#include "include/normal.glsl"
#include "include/occlusion.glsl"

uniform sampler2D depth_map;
uniform sampler2D normal_map;
uniform vec4 kernel[SAMPLES / 2];  // points of a spiral in the unit disc
uniform vec3 radius;               // metres, pixels at distance 1, most pixels

layout(location = 0) out vec4 out_occlusion;

void main() {
    ivec2 size = textureSize(depth_map, 0);
    vec2 texel = 1.0 / vec2(size);
    ivec2 p = min(ivec2(gl_FragCoord.xy) * SCALE, size - 1);
    float depth = texelFetch(depth_map, p, 0).x;
    float z = axis_distance(depth);
    vec3 position = view_ray((vec2(p) + 0.5) * texel) * z;
    vec3 normal = unpack_normal(texelFetch(normal_map, p, 0).xyz);

    float pixels = min(radius.y / z, radius.z);
    // One of sixteen rotations: the blur covers each once.
    ivec2 cell = ivec2(gl_FragCoord.xy) & 3;
    float angle = float((cell.x * 4 + cell.y) * 7 & 15) * (6.2831853 / 16.0);
    vec2 axis = pixels * vec2(cos(angle), sin(angle));
    mat2 rotation = mat2(axis.x, axis.y, -axis.y, axis.x);
    float r2 = radius.x * radius.x;
    float bias = 0.01 * radius.x + 0.002 * z;
    float sum = 0.0;
    for (int i = 0; i < SAMPLES; ++i) {
        vec4 pair = kernel[i / 2];
        vec2 offset = rotation * ((i & 1) == 0 ? pair.xy : pair.zw);
        ivec2 q = clamp(p + ivec2(floor(offset + 0.5)), ivec2(0), size - 1);
        vec3 v = view_ray((vec2(q) + 0.5) * texel) * axis_distance(texelFetch(depth_map, q, 0).x) - position;
        float vv = dot(v, v);
        float f = max(r2 - vv, 0.0) / r2;
        sum += f * f * f * max((dot(v, normal) - bias) / (vv + 0.01 * r2), 0.0);
    }
    float occlusion = max(1.0 - sum * (radius.x * STRENGTH / float(SAMPLES)), 0.0);
    out_occlusion = pack_occlusion(depth == far_depth ? 1.0 : occlusion, distance_code(z));
}
