// Ambient occlusion at 1 / SCALE of the resolution, after McGuire et al., "Scalable Ambient Obscurance" (HPG 2012).
#include "include/view.glsl"
#include "include/g_buffer.glsl"
#include "include/role.glsl"
#include "include/normal.glsl"
#include "include/occlusion.glsl"

uniform G_SAMPLER normal_map;
uniform vec4 kernel[SAMPLES / 2];  // points of a spiral in the unit disc
uniform vec2 radius;               // pixels at distance 1, most pixels
uniform vec4 falloff;              // of the radius in metres: its square, one over that, a hundredth of that, of itself
uniform mat3 pixel_rays;           // through the middle of pixel (0, 0), at distance 1 along the axis; one more right; up
uniform ivec3 bounds;              // first and last column always drawn: what lies beside does not reach in; last row

layout(location = 0) out vec4 out_occlusion;

vec3 pixel_ray(ivec2 p) {
    return pixel_rays[0] + float(p.x) * pixel_rays[1] + float(p.y) * pixel_rays[2];
}

float occlusion(ivec2 p, float z) {
    vec3 position = pixel_ray(p) * z;
    vec3 normal = unpack_normal(G_TEXEL(normal_map, p).xyz);

    float pixels = min(radius.x / z, radius.y);
    // One of sixteen rotations: the blur covers each once.
    ivec2 cell = ivec2(gl_FragCoord.xy) & 3;
    float angle = float((cell.x * 4 + cell.y) * 7 & 15) * (6.2831853 / 16.0);
    vec2 axis = pixels * vec2(cos(angle), sin(angle));
    mat2 rotation = mat2(axis.x, axis.y, -axis.y, axis.x);
    float bias = falloff.w + 0.002 * z;
    float sum = 0.0;
    ivec2 lowest = ivec2(min(bounds.x, p.x), 0);
    ivec2 highest = ivec2(max(bounds.y, p.x), bounds.z);
    for (int i = 0; i < SAMPLES; ++i) {
        vec4 pair = kernel[i / 2];
        vec2 offset = rotation * ((i & 1) == 0 ? pair.xy : pair.zw);
        ivec2 q = clamp(p + ivec2(floor(offset + 0.5)), lowest, highest);
        vec3 v = pixel_ray(q) * axis_distance(G_TEXEL(depth_map, q).x) - position;
        float vv = dot(v, v);
        float f = max(falloff.x - vv, 0.0) * falloff.y;
        sum += f * f * f * max((dot(v, normal) - bias) / (vv + falloff.z), 0.0);
    }
    return max(1.0 - sum * (falloff.w * (100.0 * STRENGTH / float(SAMPLES))), 0.0);
}

// True if this texel is read by the blur of a lit pixel.
bool is_wanted(ivec2 p, float depth) {
#ifdef REPROJECTED
    // A filtered fetch where four texels meet takes in all four of them.
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
    ivec2 p = min(ivec2(gl_FragCoord.xy) * SCALE, g_size() - 1);
    float depth = G_TEXEL(depth_map, p).x;
    float z = axis_distance(depth);
    bool wanted = is_wanted(p, depth);
    float open = 1.0;
    if (wanted) {
        open = occlusion(p, z);
    }
    out_occlusion = pack_occlusion(open, distance_code(z), wanted);
}
