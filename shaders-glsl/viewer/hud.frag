// A panel of text over the viewport: white letters on translucent black.

uniform sampler2D panel;  // coverage by letters
uniform vec4 rectangle;   // origin and size of the viewport in pixels
uniform float used;       // part of the panel, from the top, that the viewport shows

layout(location = 0) out vec4 out_color;

void main() {
    vec2 uv = (gl_FragCoord.xy - rectangle.xy) / rectangle.zw;
    float letters = texture(panel, vec2(uv.x, 1.0 - used + used * uv.y)).r;
    out_color = vec4(vec3(letters), mix(0.55, 1.0, letters));
}
