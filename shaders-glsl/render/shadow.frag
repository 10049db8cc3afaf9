// Depth alone; leaves cast the shadow of leaves.
#include "include/material.glsl"

void main() {
#ifdef CUTOUT
    if (cut_out(material_diffuse().a)) {
        discard;
    }
#endif
}
