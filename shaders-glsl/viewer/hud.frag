// A panel of text over the viewport.

#include "include/panel.glsl"

uniform vec4 rectangle;  // origin and size of the viewport in pixels

layout(location = 0) out vec4 out_color;

void main() {
    out_color = panel_color((gl_FragCoord.xy - rectangle.xy) / rectangle.zw);
}
