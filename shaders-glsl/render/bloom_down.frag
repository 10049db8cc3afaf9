// One step of the bloom pyramid, to half the size. The first step takes a part of a display-referred picture, and keeps
// what is brighter than white.
#include "include/color.glsl"
#include "include/hdr.glsl"

#ifdef LAYER
uniform highp sampler2DArray source;
uniform int color_layer;
#define SOURCE(uv) textureLod(source, vec3(uv, float(color_layer)), 0.0)
#else
uniform sampler2D source;
#define SOURCE(uv) textureLod(source, uv, 0.0)
#endif
uniform vec2 texel;  // of the target
#ifdef FIRST
uniform float exposure;
uniform vec4 part;    // of the source, by texture coordinates: lower left corner, size
uniform vec4 bounds;  // middles of the corners' texels of what shines: what is beside it is never filtered in
#endif

layout(location = 0) out vec4 out_color;

void main() {
    vec2 uv = gl_FragCoord.xy * texel;
#ifdef FIRST
    uv = clamp(part.xy + uv * part.zw, bounds.xy, bounds.zw);
    vec3 c = undo_tonemap(SOURCE(uv).rgb) / exposure;
    float bright = max(c.r, max(c.g, c.b));
    // A knee, and a ceiling so that a single very bright pixel does not flicker from eye to eye.
    c *= max(bright - 1.0, 0.0) / max(bright, 1e-4);
    out_color = vec4(HDR_SCALE * min(c, vec3(4.0)), 1.0);
#else
    vec2 h = 0.5 * texel;
    vec3 c = SOURCE(uv + vec2(-h.x, -h.y)).rgb + SOURCE(uv + vec2(h.x, -h.y)).rgb
        + SOURCE(uv + vec2(-h.x, h.y)).rgb + SOURCE(uv + vec2(h.x, h.y)).rgb;
    out_color = vec4(0.25 * c, 1.0);
#endif
}
