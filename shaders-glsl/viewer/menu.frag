// The menu's panel, which stands in the world: white on dark, translucent, with a dot where the user points.

#include "include/color.glsl"

uniform sampler2D panel;   // how bright the panel is, display-referred
uniform mat3 to_panel;     // from pixels of the viewport to the panel, homogeneous, 0 to 1 on it
uniform vec2 origin;       // of the viewport in pixels
uniform vec2 pointer;      // place of the dot on the panel, 0 to 1; outside for none
uniform vec2 dot_radius;   // radius of the dot, as a share of the panel
uniform bool to_linear;    // the framebuffer encodes what is written, or holds linear colour

layout(location = 0) out vec4 out_color;

void main() {
    vec3 at = to_panel * vec3(gl_FragCoord.xy - origin, 1.0);
    vec2 uv = at.xy / at.z;
    if (at.z <= 0.0 || any(notEqual(clamp(uv, 0.0, 1.0), uv))) {
        discard;
    }
    float light = texture(panel, uv).r;
    float edge = length((uv - pointer) / dot_radius);
    light = mix(light, edge < 0.6 ? 1.0 : 0.0, 1.0 - smoothstep(0.9, 1.0, edge));
    vec3 shade = vec3(light);
    out_color = vec4(to_linear ? srgb_decode(shade) : shade, mix(0.85, 1.0, light));
}
