// G-buffer, ambient occlusion and lights to scene-referred colour; the sky where there is nothing.
#include "include/view.glsl"
#include "include/normal.glsl"
#include "include/shade.glsl"
#include "include/hdr.glsl"
#include "include/occlusion.glsl"

uniform sampler2D depth_map;
uniform sampler2D albedo_map;
uniform sampler2D normal_map;
uniform sampler2D emissive_map;
#ifdef SSAO
uniform sampler2D occlusion_map;
#endif
#ifdef STYLE_ANIME
uniform int line_width;  // pixels
#endif

layout(location = 0) out vec4 out_color;

#ifdef SSAO
#if SSAO_SCALE == 1
float occlusion(ivec2 p, float z) {
    return texelFetch(occlusion_map, p, 0).x;
}
#else
// The four half-resolution texels around the pixel, weighted by how much they are on its surface.
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
// 1 where surfaces part: another material, or an inverse distance that is not linear over the screen. Of two
// surfaces the nearer one carries the line: it must stay with the outline that it draws when the pixels move to
// the other eye.
float ink(ivec2 p, float depth, float id) {
    ivec2 last = textureSize(depth_map, 0) - 1;
    float c = inverse_distance.x + inverse_distance.y * depth;
    float line = 0.0;
    for (int i = 0; i < 2; ++i) {
        ivec2 step = i == 0 ? ivec2(line_width, 0) : ivec2(0, line_width);
        ivec2 q0 = max(p - step, ivec2(0)), q1 = min(p + step, last);
        float d0 = texelFetch(depth_map, q0, 0).x, d1 = texelFetch(depth_map, q1, 0).x;
        float bend = inverse_distance.y * (2.0 * depth - d0 - d1) / c;
        line = max(line, smoothstep(0.03, 0.06, bend));
        float i0 = texelFetch(emissive_map, q0, 0).a, i1 = texelFetch(emissive_map, q1, 0).a;
        // Of two neighbours in one distance, the line is drawn on one side only.
        line = max(line, i0 != id && abs(d0 - depth) * abs(inverse_distance.y) < 0.05 * c ? 0.8 : 0.0);
    }
    return line;
}
#endif

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    float depth = texelFetch(depth_map, p, 0).x;
    float z = axis_distance(depth);
    vec3 ray = view_ray(gl_FragCoord.xy / vec2(textureSize(depth_map, 0)));
    vec3 position = ray * z;

    vec4 albedo = texelFetch(albedo_map, p, 0);
    vec4 normal = texelFetch(normal_map, p, 0);
    vec4 emissive = texelFetch(emissive_map, p, 0);
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
    vec3 color = shade(s, position, ao);
#ifdef STYLE_ANIME
    color = mix(color, 0.04 * s.albedo, ink(p, depth, emissive.a));
#endif
    color = aerial(color, z);

    vec3 direction = normalize(ray);
    vec3 background = sky(direction);
#ifdef SUN
    float disc = dot(direction, sun_direction);
    background += sun_color * (smoothstep(0.9996, 0.9998, disc) * 2.0 + 0.08 * exp2(60.0 * (disc - 1.0)));
#endif
    out_color = vec4(hdr_encode(depth == far_depth ? background : color), 1.0);
}
