// Two images of one size on a flat screen: the first one, an anaglyph of both, or their difference. For a headset that
// takes depth: the first image with its depth. For a browser, which reads no depth: depth as colour.

uniform sampler2D first;   // display-referred sRGB; the left eye's for an anaglyph; with PACKED_DEPTH window depth
#if defined(ANAGLYPH) || defined(DIFFERENCE)
uniform sampler2D second;
#endif
#ifdef WITH_DEPTH
uniform sampler2D depth_map;
#endif
uniform vec4 rectangle;    // origin and size of the viewport in pixels

layout(location = 0) out vec4 out_color;

// Black, blue, red, yellow, white from 0 to 1.
vec3 heat(float t) {
    return clamp(vec3(3.0 * t - 0.6, 3.0 * t - 1.5, t < 0.4 ? 2.5 * t : max(2.0 - 2.5 * t, 4.0 * t - 3.0)), 0.0, 1.0);
}

void main() {
    vec2 uv = (gl_FragCoord.xy - rectangle.xy) / rectangle.zw;
    vec3 color = texture(first, uv).rgb;
#ifdef ANAGLYPH
    // Half colour: the left eye's luma for the red filter, so that strong reds do not flicker between the eyes.
    color = vec3(dot(color, vec3(0.299, 0.587, 0.114)), texture(second, uv).gb);
#endif
#ifdef DIFFERENCE
    vec3 difference = abs(color - texture(second, uv).rgb);
    // White from a quarter of the full range on.
    color = heat(min(4.0 * max(difference.r, max(difference.g, difference.b)), 1.0));
#endif
#ifdef WITH_DEPTH
    gl_FragDepth = texture(depth_map, uv).r;
#endif
    out_color = vec4(color, 1.0);
#ifdef PACKED_DEPTH
    // 24 bits, the highest in red.
    uint depth = uint(texture(first, uv).r * 16777215.0 + 0.5);
    out_color = vec4(uvec4(depth >> 16u, (depth >> 8u) & 255u, depth & 255u, 255u)) / 255.0;
#endif
}
