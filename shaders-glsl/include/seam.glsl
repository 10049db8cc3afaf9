// Both eyes side by side, without clip distances: each eye's triangles stay in its own half.
#ifdef SEAM_DISCARD
uniform float seam;  // first column of the right eye
flat in int v_view;
#define DISCARD_BEYOND_SEAM if ((gl_FragCoord.x < seam) != (v_view == 0)) { discard; }
#else
#define DISCARD_BEYOND_SEAM
#endif
