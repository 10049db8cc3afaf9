// A panel of text over the viewport: white letters on translucent black.

uniform sampler2D panel;  // coverage by letters
uniform vec4 rectangle;   // origin and size of the viewport in pixels

layout(location = 0) out vec4 out_color;

void main() {
    float letters = texture(panel, (gl_FragCoord.xy - rectangle.xy) / rectangle.zw).r;
    out_color = vec4(vec3(letters), mix(0.55, 1.0, letters));
}
