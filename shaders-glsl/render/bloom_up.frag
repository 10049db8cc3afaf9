// Adds (by blending) a level of the bloom pyramid, widened, to the next larger one.
uniform sampler2D source;
uniform vec2 texel;         // of the target
uniform vec2 source_texel;

layout(location = 0) out vec4 out_color;

void main() {
    vec2 uv = gl_FragCoord.xy * texel;
    vec2 h = 0.5 * source_texel;
    vec3 c = texture(source, uv + vec2(-h.x, -h.y)).rgb + texture(source, uv + vec2(h.x, -h.y)).rgb
        + texture(source, uv + vec2(-h.x, h.y)).rgb + texture(source, uv + vec2(h.x, h.y)).rgb;
    out_color = vec4(0.25 * c, 1.0);
}
