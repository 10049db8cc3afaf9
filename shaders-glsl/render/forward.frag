// A lit surface, display-referred. Tone mapping comes before the samples of a pixel are averaged, so that edges of
// bright surfaces are as smooth as others. Alpha is luma, or the material if outlines are drawn.
#include "include/surface.glsl"

uniform float exposure;
#ifdef INK
uniform float material_id;
#endif
layout(location = 0) out vec4 out_color;
#include "include/carried.glsl"
#include "include/seam.glsl"
#include "include/hole_bloom.glsl"
#ifdef REPROJECTED
#include "include/reprojection.glsl"
#endif

void main() {
    vec4 color = material_diffuse();
    DISCARD_BEYOND_SEAM
#if defined(CUTOUT) && !defined(MULTISAMPLE)
    if (cut_out(color.a)) {
        discard;
    }
#endif
#ifdef UNLIT
    vec3 c = srgb_encode(color.rgb);
#else
    // Beyond the surface's edge, where only some samples are covered, the extrapolated distance may be invalid.
    float distance = 1.0 / max(gl_FragCoord.w, 1e-6);
    Surface surface = material_surface(color.rgb);
#ifdef REPROJECTED
    // Maps are sampled before the branch, since their derivatives are undefined within it.
    vec3 c;
    if (!is_seen(c)) {
        c = tonemap(exposure * aerial(shade(surface, v_position), distance));
    }
#else
    vec3 c = tonemap(exposure * aerial(shade(surface, v_position), distance));
#endif
#endif
    c = with_view_bloom(c, gl_FragCoord.z);
    CARRY_DEPTH(gl_FragCoord.z)
#if defined(CUTOUT) && defined(MULTISAMPLE)
    out_color = vec4(c, coverage(color.a));
#elif defined(INK)
    out_color = vec4(c, material_id);
#else
    out_color = vec4(c, luma(c));
#endif
}
