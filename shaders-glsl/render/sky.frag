// The sky where no surface was drawn: display-referred, with luma in alpha. It is drawn at the far plane's depth.
#include "include/view.glsl"
#include "include/shade.glsl"

uniform vec2 view_origin;   // lower left corner of the view in the target
uniform vec2 view_texel;    // 1 / size of the view in pixels
uniform float exposure;

layout(location = 0) out vec4 out_color;

void main() {
    vec3 ray = view_ray((gl_FragCoord.xy - view_origin) * view_texel);
    vec3 c = tonemap(exposure * background(normalize(ray)));
    out_color = vec4(c, luma(c));
}
