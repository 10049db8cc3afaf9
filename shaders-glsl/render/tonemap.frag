// Scene-referred colour (and bloom) to display-referred sRGB, with luma in alpha for FXAA.
#include "include/color.glsl"
#include "include/hdr.glsl"

uniform sampler2D source;
uniform ivec2 columns;  // first and last of the source that are there
uniform float exposure;
#ifdef BLOOM
uniform sampler2D bloom;
uniform float bloom_strength;
#endif

layout(location = 0) out vec4 out_color;

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec3 c = hdr_decode(texelFetch(source, ivec2(clamp(p.x, columns.x, columns.y), p.y), 0).rgb);
#ifdef BLOOM
    c += bloom_strength * texture(bloom, gl_FragCoord.xy / vec2(textureSize(source, 0))).rgb;
#endif
    c = tonemap(exposure * c);
    out_color = vec4(c, luma(c));
}
