// From a surface and the lights to scene-referred linear colour. Positions are relative to the eye.
#include "include/color.glsl"

struct Surface {
    vec3 albedo;      // linear
    vec3 emissive;    // linear
    vec3 normal;
    float roughness;
    float specular;   // reflectance at normal incidence
};

uniform vec3 zenith;
uniform vec3 horizon;
uniform vec3 ground;
uniform vec3 sun_direction;
uniform vec3 sun_color;
uniform vec4 light_positions[MAX_POINT_LIGHTS];  // w: 1 / range
uniform vec4 light_colors[MAX_POINT_LIGHTS];
#ifdef LIGHT_TILES
uniform ivec4 light_tiles[LIGHT_TILES / 4];  // bit i: light i reaches into the tile; row by row from the bottom
uniform vec2 tiles_per_pixel;
#else
uniform int light_count;
#endif
#ifdef SHADOWS
uniform sampler2DShadow shadow_map;
uniform mat4 shadow_matrix;   // to 0..1
uniform vec3 shadow_texel;    // width in texture coordinates, width in metres, depth bias
#endif

#ifdef STEREO
// Lights and shadow map are relative to the first of two eyes; `position` is relative to the fragment's own.
in vec3 v_from_first;
#define LIT_POSITION v_from_first
#else
#define LIT_POSITION position
#endif

const float PI = 3.14159265;

vec3 sky(vec3 direction) {
    float low = 1.0 - max(direction.y, 0.0);
    low *= low;
    vec3 above = mix(zenith, horizon, low * low);
    return mix(above, ground, smoothstep(0.0, 0.35, -direction.y));
}

// What is seen where there is nothing.
vec3 background(vec3 direction) {
    vec3 color = sky(direction);
#ifdef SUN
    float disc = dot(direction, sun_direction);
    color += sun_color * (smoothstep(0.9996, 0.9998, disc) * 2.0 + 0.08 * exp2(60.0 * (disc - 1.0)));
#endif
    return color;
}

// How a style distributes light between the terminator and the light. x: cosine times visibility.
float ramp(float x) {
#if defined(STYLE_CARTOON)
    return 0.35 * smoothstep(0.02, 0.06, x) + 0.4 * smoothstep(0.3, 0.35, x) + 0.25 * smoothstep(0.7, 0.76, x);
#elif defined(STYLE_ANIME)
    return 0.9 * smoothstep(0.22, 0.27, x);
#else
    return x;
#endif
}

// Diffuse (over PI) and GGX specular reflection of light with irradiance 1 at normal incidence.
vec3 reflected(Surface s, vec3 to_eye, vec3 to_light, float visibility) {
    float nl = max(dot(s.normal, to_light), 0.0);
    float nv = abs(dot(s.normal, to_eye)) + 1e-3;
    vec3 half_vector = normalize(to_light + to_eye);
    float nh = max(dot(s.normal, half_vector), 0.0);
    float alpha = max(s.roughness * s.roughness, 0.008);
    float a2 = alpha * alpha;
    float q = nh * nh * (a2 - 1.0) + 1.0;
    float f = 1.0 - max(dot(half_vector, to_light), 0.0);
    float f2 = f * f;
    float fresnel = s.specular + (1.0 - s.specular) * f2 * f2 * f * min(s.specular * 20.0, 1.0);
    float specular = a2 / (PI * q * q) * fresnel * 0.5 / mix(2.0 * nl * nv, nl + nv, alpha);
#if defined(STYLE_CARTOON) || defined(STYLE_ANIME)
    specular = 0.6 * s.specular * smoothstep(0.6, 0.8, specular * nl);
    float lit = ramp(nl * visibility);
    return lit * (s.albedo / PI + specular);
#else
    return nl * visibility * (s.albedo / PI + min(specular, 16.0));
#endif
}

#ifdef SHADOWS
float sun_visibility(vec3 position, vec3 normal) {
    // Moving the point off its surface by a texel instead of a large depth bias keeps contact shadows attached.
    vec3 p = (shadow_matrix * vec4(position + normal * shadow_texel.y * 2.0, 1.0)).xyz;
    p.z -= shadow_texel.z;
    float lit = 0.0;
    for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
            lit += texture(shadow_map, p + vec3(vec2(x, y) * shadow_texel.x, 0.0));
        }
    }
    bool inside = all(lessThan(abs(p - 0.5), vec3(0.5)));
    return inside ? lit / 9.0 : 1.0;
}
#endif

#ifdef LIGHT_TILES
int lights_here() {
    ivec2 tile = ivec2(gl_FragCoord.xy * tiles_per_pixel);
    int i = tile.y * LIGHT_TILE_COLUMNS + tile.x;
    return light_tiles[i >> 2][i & 3];
}

// Number of the lowest bit, below 24, by the exponent of its value: findLSB wants ES 3.1.
int lowest_bit(int bits) {
    return (floatBitsToInt(float(bits & -bits)) >> 23) - 127;
}
#endif

vec3 shade(Surface s, vec3 position, float occlusion) {
    vec3 to_eye = -normalize(position);
    float up = 0.5 * s.normal.y + 0.5;
    // Eyes adapt to the colour of the sky: half of it goes, or shadows would be blue.
    vec3 overhead = mix(zenith, horizon, 0.4);
    overhead = mix(vec3(luma(overhead)), overhead, 0.5);
    vec3 ambient = mix(ground, overhead, up);
    float nv = max(dot(s.normal, to_eye), 0.0);
#if defined(STYLE_ANIME)
    ambient *= vec3(1.02, 0.92, 1.12);
#endif
    vec3 color = s.emissive + s.albedo * ambient * occlusion;
#if !defined(STYLE_CARTOON) && !defined(STYLE_ANIME)
    // The sky's reflection, blurred towards the ambient light by roughness.
    float grazing = 1.0 - nv;
    grazing *= grazing;
    float smoothness = 1.0 - s.roughness;
    float fresnel = s.specular + max(smoothness - s.specular, 0.0) * s.specular * 10.0 * grazing * grazing * grazing;
    color += mix(ambient, sky(reflect(-to_eye, s.normal)), smoothness * smoothness) * min(fresnel, 1.0) * occlusion;
#endif
#ifdef SUN
#ifdef SHADOWS
    float visibility = sun_visibility(LIT_POSITION, s.normal);
#else
    float visibility = 1.0;
#endif
    color += sun_color * reflected(s, to_eye, sun_direction, visibility);
#endif
#ifdef LIGHT_TILES
    for (int left = lights_here(); left != 0; left &= left - 1) {
        int i = lowest_bit(left);
#else
    for (int i = 0; i < light_count; ++i) {
#endif
        vec3 offset = light_positions[i].xyz - LIT_POSITION;
        float d2 = dot(offset, offset);
        float fade = d2 * light_positions[i].w * light_positions[i].w;
        fade = max(1.0 - fade * fade, 0.0);
        // A loop, because CPU rasterizers run both sides of an `if` but leave a loop that no pixel needs.
        for (int near = fade > 0.0 ? 1 : 0; near > 0; --near) {
            // No lamp is a point: the offset keeps the wall behind it from turning white.
            float strength = fade * fade / (d2 + 0.06);
            color += strength * light_colors[i].rgb * reflected(s, to_eye, offset * inversesqrt(d2), 1.0);
        }
    }
#if defined(STYLE_ANIME)
    // Not on level ground, which towards the horizon is all rim.
    float rim = smoothstep(0.62, 0.72, 1.0 - nv) * up * (1.0 - smoothstep(0.8, 0.95, s.normal.y));
    color += rim * 0.3 * (0.3 + s.albedo) * horizon;
#endif
#if defined(STYLE_CARTOON) || defined(STYLE_ANIME)
    color = max(mix(vec3(luma(color)), color, 1.2), 0.0);
#endif
    return color;
}

#ifdef SUN
// Air between here and a distance in metres.
vec3 aerial(vec3 color, float distance) {
    return mix(horizon, color, exp2(-0.0009 * distance));
}
#else
vec3 aerial(vec3 color, float distance) {
    return color;
}
#endif
