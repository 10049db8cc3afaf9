// The eye's image through the lens. It is looked up by direction, so that it can be turned (timewarp), and fades
// towards the borders of the lens and of the image.

// The image is display-referred sRGB, as the screen takes it: a rectangle of a texture, or levels that are composed on the way.
// A panel is drawn over composed levels, since letters cannot be read in a level of few pixels.
#ifdef LEVELS
#include "include/levels.glsl"
#include "include/panel.glsl"
uniform vec4 panel_place;  // place in the panel at a place in the eye's image: panel_place.xy * place + panel_place.zw

vec4 with_panel(vec2 place) {
    vec4 color = composed(place);
    vec2 at = panel_place.xy * place + panel_place.zw;
    if (at == clamp(at, 0.0, 1.0)) {
        vec4 over = panel_color(at);
        color = mix(color, over, over.a);
    }
    return color;
}
#define IMAGE(uv) with_panel(uv)
#else
uniform sampler2D image;
uniform vec4 image_place;  // texture coordinates at a place in the eye's image: image_place.xy * place + image_place.zw
#define IMAGE(uv) texture(image, image_place.xy * (uv) + image_place.zw)
#endif
uniform vec4 frustum;     // left, bottom, width, height of the image in tangents
uniform float border;     // width of the fade at a border, as a part of the image

in vec2 lens_uv;
in vec3 direction;

layout(location = 0) out vec4 out_color;

vec2 image_uv(vec3 direction) {
    return (direction.xy / max(-direction.z, 1e-3) - frustum.xy) / frustum.zw;
}

// 1 inside, 0 from the borders on.
float inside(vec2 uv) {
    vec2 edge = smoothstep(0.0, border, uv) * smoothstep(0.0, border, 1.0 - uv);
    return edge.x * edge.y;
}

void main() {
    vec2 uv = image_uv(direction);
    // A turned image may end before the lens does.
    out_color = vec4(IMAGE(uv).rgb * min(inside(lens_uv), inside(uv)), 1.0);
}
