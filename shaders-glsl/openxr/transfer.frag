// Converts a finished image to linear colour, for a framebuffer whose driver or format encodes it.
uniform sampler2D source;

layout(location = 0) out vec4 out_color;

void main() {
    vec4 c = texelFetch(source, ivec2(gl_FragCoord.xy), 0);
    vec3 low = c.rgb / 12.92;
    vec3 high = pow((c.rgb + 0.055) / 1.055, vec3(2.4));
    out_color = vec4(mix(high, low, lessThanEqual(c.rgb, vec3(0.04045))), c.a);
}
