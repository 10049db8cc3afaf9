// Anti-aliasing along edges of luma, after T. Lottes, FXAA 3.11 (console). Reads luma from alpha.
uniform sampler2D source;
uniform ivec2 offset;  // from a pixel of the target to its pixel in the source

layout(location = 0) out vec4 out_color;

void main() {
    vec2 texel = 1.0 / vec2(textureSize(source, 0));
    ivec2 p = ivec2(gl_FragCoord.xy) + offset;
    vec2 uv = (vec2(p) + 0.5) * texel;
    vec4 center = texelFetch(source, p, 0);
    // Half a pixel off diagonally: bilinear filtering averages four pixels each.
    float nw = textureLod(source, uv - 0.5 * texel, 0.0).a;
    float se = textureLod(source, uv + 0.5 * texel, 0.0).a;
    float ne = textureLod(source, uv + vec2(0.5, -0.5) * texel, 0.0).a + 1.0 / 384.0;
    float sw = textureLod(source, uv + vec2(-0.5, 0.5) * texel, 0.0).a;
    float low = min(center.a, min(min(nw, ne), min(sw, se)));
    float high = max(center.a, max(max(nw, ne), max(sw, se)));
    vec4 color = center;
    if (high - low > max(0.04, 0.125 * high)) {
        vec2 along = normalize(vec2((sw + se) - (nw + ne), (nw + sw) - (ne + se)));
        vec2 near = 0.5 * along * texel;
        vec4 a = 0.5 * (textureLod(source, uv - near, 0.0) + textureLod(source, uv + near, 0.0));
        vec2 far = clamp(along / (8.0 * min(abs(along.x), abs(along.y)) + 1e-4), -2.0, 2.0) * 2.0 * texel;
        vec4 b = 0.5 * a + 0.25 * (textureLod(source, uv - far, 0.0) + textureLod(source, uv + far, 0.0));
        color = b.a < low || b.a > high ? a : b;
    }
    out_color = color;
}
