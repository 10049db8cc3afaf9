// A lit surface, display-referred. Tone mapping comes before the samples of a pixel are averaged, so that edges of
// bright surfaces are as smooth as others. Alpha is luma, or the material if outlines are drawn.
#include "include/surface.glsl"

uniform float exposure;
#ifdef INK
uniform float material_id;
#endif
#ifdef SEAM_DISCARD
uniform float seam;  // first column of the right eye
flat in int v_view;
#endif

layout(location = 0) out vec4 out_color;

void main() {
    vec4 color = material_diffuse();
#ifdef SEAM_DISCARD
    if ((gl_FragCoord.x < seam) != (v_view == 0)) {
        discard;
    }
#endif
#if defined(CUTOUT) && !defined(MULTISAMPLE)
    if (cut_out(color.a)) {
        discard;
    }
#endif
    // Beyond the surface's edge, where only some samples are covered, the extrapolated distance may be invalid.
    float distance = 1.0 / max(gl_FragCoord.w, 1e-6);
    vec3 c = aerial(shade(material_surface(color.rgb), v_position, 1.0), distance);
    c = tonemap(exposure * c);
#if defined(CUTOUT) && defined(MULTISAMPLE)
    out_color = vec4(c, coverage(color.a));
#elif defined(INK)
    out_color = vec4(c, material_id);
#else
    out_color = vec4(c, luma(c));
#endif
}
