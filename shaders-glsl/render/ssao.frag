// Ambient occlusion at 1 / SCALE of the resolution, after McGuire et al., "Scalable Ambient Obscurance" (HPG 2012).
#include "include/view.glsl"
#include "include/g_buffer.glsl"
#include "include/role.glsl"
#include "include/normal.glsl"
#include "include/occlusion.glsl"

uniform G_SAMPLER normal_map;
uniform vec4 kernel[SAMPLES / 2];  // points of a spiral in the unit disc
uniform vec3 radius;               // metres, pixels at distance 1, most pixels
uniform ivec2 columns;             // first and last that are always drawn: what lies beside them does not reach in

layout(location = 0) out vec4 out_occlusion;

float occlusion(ivec2 p, ivec2 size, float z) {
    vec2 texel = 1.0 / vec2(size);
    vec3 position = view_ray((vec2(p) + 0.5) * texel) * z;
    vec3 normal = unpack_normal(G_TEXEL(normal_map, p).xyz);

    float pixels = min(radius.y / z, radius.z);
    // One of sixteen rotations: the blur covers each once.
    ivec2 cell = ivec2(gl_FragCoord.xy) & 3;
    float angle = float((cell.x * 4 + cell.y) * 7 & 15) * (6.2831853 / 16.0);
    vec2 axis = pixels * vec2(cos(angle), sin(angle));
    mat2 rotation = mat2(axis.x, axis.y, -axis.y, axis.x);
    float r2 = radius.x * radius.x;
    float bias = 0.01 * radius.x + 0.002 * z;
    float sum = 0.0;
    ivec2 lowest = ivec2(min(columns.x, p.x), 0);
    ivec2 highest = ivec2(max(columns.y, p.x), size.y - 1);
    for (int i = 0; i < SAMPLES; ++i) {
        vec4 pair = kernel[i / 2];
        vec2 offset = rotation * ((i & 1) == 0 ? pair.xy : pair.zw);
        ivec2 q = clamp(p + ivec2(floor(offset + 0.5)), lowest, highest);
        vec3 v = view_ray((vec2(q) + 0.5) * texel) * axis_distance(G_TEXEL(depth_map, q).x) - position;
        float vv = dot(v, v);
        float f = max(r2 - vv, 0.0) / r2;
        sum += f * f * f * max((dot(v, normal) - bias) / (vv + 0.01 * r2), 0.0);
    }
    return max(1.0 - sum * (radius.x * STRENGTH / float(SAMPLES)), 0.0);
}

// Whether any pixel is lit whose blur reads this texel.
bool is_wanted(ivec2 p, float depth) {
#ifdef REPROJECTED
    // Filtered where four texels meet, each tap sees all of them.
    const int FIRST = SCALE == 1 ? 0 : -3;
    const int TAPS = SCALE == 1 ? 2 : 5;
    vec2 texel = 1.0 / vec2(textureSize(disocclusion, 0));
    float sum = 0.0;
    for (int y = 0; y < TAPS; ++y) {
        for (int x = 0; x < TAPS; ++x) {
            sum += textureLod(disocclusion, vec2(p + FIRST + 2 * ivec2(x, y)) * texel, 0.0).x;
        }
    }
    return depth != far_depth && sum > 0.0;
#else
    return is_lit(p, depth);
#endif
}

void main() {
    ivec2 size = g_size();
    ivec2 p = min(ivec2(gl_FragCoord.xy) * SCALE, size - 1);
    float depth = G_TEXEL(depth_map, p).x;
    float z = axis_distance(depth);
    out_occlusion = pack_occlusion(1.0, distance_code(z), false);
    if (is_wanted(p, depth)) {
        out_occlusion = pack_occlusion(occlusion(p, size, z), distance_code(z), true);
    }
}
