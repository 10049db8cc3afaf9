// Lights the g-buffer, with ambient occlusion, to scene-referred colour. Pixels without a surface show the sky.
#include "include/view.glsl"
#include "include/g_buffer.glsl"
#include "include/role.glsl"
#include "include/normal.glsl"
#include "include/shade.glsl"
#include "include/hdr.glsl"
#include "include/occlusion.glsl"

uniform G_SAMPLER albedo_map;
uniform G_SAMPLER normal_map;
uniform G_SAMPLER emissive_map;
#ifdef SSAO
uniform sampler2D occlusion_map;
#endif
#ifdef NEAR_FIELD
uniform sampler2D far_field;
uniform ivec2 far_field_crop;
#endif
#ifdef REPROJECTED
uniform sampler2D dominant_color;
#endif

layout(location = 0) out vec4 out_color;

#ifdef SSAO
#if SSAO_SCALE == 1
float occlusion(ivec2 p, float z) {
    return texelFetch(occlusion_map, p, 0).x;
}
#else
// The four half-resolution texels around the pixel, weighted by their likeness to its surface.
float occlusion(ivec2 p, float z) {
    ivec2 last = textureSize(occlusion_map, 0) - 1;
    // Texel i was computed at full-resolution pixel 2 i.
    ivec2 a = p >> 1;
    ivec2 b = min(a + (p & 1), last);
    vec4 t00 = texelFetch(occlusion_map, a, 0);
    vec4 t10 = texelFetch(occlusion_map, ivec2(b.x, a.y), 0);
    vec4 t01 = texelFetch(occlusion_map, ivec2(a.x, b.y), 0);
    vec4 t11 = texelFetch(occlusion_map, b, 0);
    float code = distance_code(z);
    vec4 weights = vec4(same_surface(code, unpack_code(t00)), same_surface(code, unpack_code(t10)),
        same_surface(code, unpack_code(t01)), same_surface(code, unpack_code(t11))) + 1e-4;
    return dot(weights, vec4(t00.x, t10.x, t01.x, t11.x)) / dot(weights, vec4(1.0));
}
#endif
#endif

#ifdef STYLE_ANIME
#define INK_DEPTH(p) G_TEXEL(depth_map, p).x
#define INK_MATERIAL(p) G_TEXEL(emissive_map, p).a
#include "include/ink.glsl"
#endif

vec3 lit(ivec2 p, float depth, vec3 ray) {
    float z = axis_distance(depth);
    vec4 albedo = G_TEXEL(albedo_map, p);
    vec4 normal = G_TEXEL(normal_map, p);
    vec4 emissive = G_TEXEL(emissive_map, p);
    Surface s;
    s.albedo = albedo.rgb * albedo.rgb;
    s.roughness = albedo.a;
    s.normal = unpack_normal(normal.xyz);
    s.specular = normal.a;
    s.emissive = 4.0 * emissive.rgb * emissive.rgb;
#ifdef SSAO
    float ao = occlusion(p, z);
#else
    float ao = 1.0;
#endif
    vec3 color = shade(s, ray * z, ao);
#ifdef STYLE_ANIME
    color = mix(color, 0.04 * s.albedo, ink(p, g_size() - 1, depth, emissive.a));
#endif
    return aerial(color, z);
}

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    float depth = G_TEXEL(depth_map, p).x;
    vec3 ray = view_ray(gl_FragCoord.xy / vec2(g_size()));
    vec3 color = vec3(0.0);
    if (is_lit(p, depth)) {
        color = hdr_encode(lit(p, depth, ray));
    }
#ifdef NEAR_FIELD
    if (depth == far_depth) {
        color = texelFetch(far_field, p + far_field_crop, 0).rgb;
    }
#else
    if (depth == far_depth) {
        color = hdr_encode(background(normalize(ray)));
    }
#endif
#ifdef REPROJECTED
    vec2 reprojected = texelFetch(disocclusion, p, 0).xy;
    if (depth != far_depth && reprojected.x < 0.5) {
        float x = dominant_column(p.x, depth);
        x = reprojected.y > 0.5 ? x : float(nearest_column(x));
        vec2 q = vec2(x, float(p.y - row_offset)) + 0.5;
        color = textureLod(dominant_color, q / vec2(textureSize(dominant_color, 0)), 0.0).rgb;
    }
#endif
    out_color = vec4(color, 1.0);
}
