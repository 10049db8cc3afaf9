// OpenGL ES 3.0 and WebGL 2 lack functions of OpenGL ES 3.1, which are written out there: WITHOUT_ES_310. Both forms
// draw the same picture.
#if __VERSION__ == 300 && !defined(WITHOUT_ES_310)
#define WITHOUT_ES_310
#endif
