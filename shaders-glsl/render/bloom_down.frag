// One step of the bloom pyramid, to half the size. The first step keeps only bright pixels.
#include "include/color.glsl"
#include "include/hdr.glsl"

uniform sampler2D source;
uniform vec2 texel;  // of the target
#if defined(FIRST) && !defined(DISPLAY_REFERRED)
uniform vec2 columns;  // middles of the first and last of the source that shine, by texture coordinates
#endif
#ifdef DISPLAY_REFERRED
uniform float exposure;
uniform vec4 part;    // of the source, by texture coordinates: lower left corner, size
uniform vec4 bounds;  // middles of the corners' texels of what shines: what is beside it is never filtered in
#endif

layout(location = 0) out vec4 out_color;

void main() {
    vec2 uv = gl_FragCoord.xy * texel;
#ifdef FIRST
#ifdef DISPLAY_REFERRED
    uv = clamp(part.xy + uv * part.zw, bounds.xy, bounds.zw);
    vec3 c = undo_tonemap(texture(source, uv).rgb) / exposure;
#else
    vec3 c = hdr_decode(texture(source, vec2(clamp(uv.x, columns.x, columns.y), uv.y)).rgb);
#endif
    float bright = max(c.r, max(c.g, c.b));
    // A knee, and a ceiling so that a single very bright pixel does not flicker from eye to eye.
    c *= max(bright - 1.0, 0.0) / max(bright, 1e-4);
    out_color = vec4(min(c, vec3(4.0)), 1.0);
#else
    vec2 h = 0.5 * texel;
    vec3 c = texture(source, uv + vec2(-h.x, -h.y)).rgb + texture(source, uv + vec2(h.x, -h.y)).rgb
        + texture(source, uv + vec2(-h.x, h.y)).rgb + texture(source, uv + vec2(h.x, h.y)).rgb;
    out_color = vec4(0.25 * c, 1.0);
#endif
}
