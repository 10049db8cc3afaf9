// Converts a finished image to linear colour, for a framebuffer whose driver or format encodes it.

#include "include/color.glsl"

uniform sampler2D source;

layout(location = 0) out vec4 out_color;

void main() {
    vec4 c = texelFetch(source, ivec2(gl_FragCoord.xy), 0);
    out_color = vec4(srgb_decode(c.rgb), c.a);
}
