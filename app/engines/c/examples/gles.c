/*
 * yoro on OpenGL ES: renders one eye and synthesizes the other.
 *
 *   gles [FILE.png]
 *
 * writes both eyes side by side, the synthesized left eye on the left, and prints how close that is to a real render of
 * it. engine_gles.h stands in for an engine.
 */
#include <yoro.h>

#include "engine_gles.h"

/* Called with a sentence for every error, after which the sample exits. */
static void on_error(void *user, YoroResult result, const char *sentence) {
  (void)user;
  fprintf(stderr, "yoro (%s): %s\n", yoro_result_text(result), sentence);
}

int main(int argc, char **argv) {
  make_context();
  GLuint program = make_program();

  /* 1. Once, with the engine's context current. `check` is for development: it reports mistakes as sentences. */
  YoroContext *yoro = NULL;
  YoroGlInfo info;
  YORO_INIT(info);
  info.outputs = YORO_OUTPUT_DEPTH;
  info.state = YORO_GL_STATE_PRESERVE;
  info.check = 1;
  info.loader = eglGetProcAddress;
  info.messages.callback = on_error;
  if (yoro_gl_create(&info, &yoro) != YORO_OK) return 1;

  /* 2. Each frame: where the eyes are. With OpenXR, copy the poses and angles from xrLocateViews. */
  YoroEyes eyes;
  YORO_INIT(eyes);
  eyes.rendered = YORO_EYE_RIGHT;
  eyes.width = eyes.height = SIZE;
  for (int eye = 0; eye < 2; ++eye) {
    const float up = 0.65f, out = 0.7f, in = 0.6f;
    eyes.poses[eye].orientation[3] = 1.0f;
    eyes.poses[eye].position[0] = eye == YORO_EYE_LEFT ? -0.0315f : 0.0315f;
    eyes.poses[eye].position[1] = 1.6f;
    eyes.poses[eye].position[2] = 2.0f;
    eyes.fovs[eye].angle_left = eye == YORO_EYE_LEFT ? -out : -in;
    eyes.fovs[eye].angle_right = eye == YORO_EYE_LEFT ? in : out;
    eyes.fovs[eye].angle_up = up;
    eyes.fovs[eye].angle_down = -up;
  }
  /* The planes of the engine's projection, and what its depth buffer means: here it is cleared to 1 and tested with
   * LESS. If it is cleared to 0 and tested with GREATER: YORO_DEPTH_REVERSED. Without a far plane: INFINITY. */
  eyes.near_z = 0.1f;
  eyes.far_z = 100.0f;
  eyes.depth = YORO_DEPTH_STANDARD;
  eyes.guard_band = YORO_GUARD_BAND;
  eyes.messages.callback = on_error;
  YoroViews views;
  YORO_INIT(views);
  if (yoro_views_from_eyes(&eyes, &views) != YORO_OK) return 1;

  /* 3. The engine renders the opaque objects of one eye. The image is wider than the eye's, which is a crop of it. */
  Image source = make_image(views.source.width, views.source.height);
  draw(program, views.source.projection, views.source.view, &source);

  /* 4. The other eye. Transparent objects are drawn into both eyes afterwards, tested against each eye's depth. */
  Image other = make_image(views.synthesized.width, views.synthesized.height);
  YoroGlImages images;
  YORO_INIT(images);
  images.color_texture = source.color;
  images.depth_texture = source.depth;
  images.framebuffer = other.framebuffer;
  if (yoro_gl_synthesize(yoro, &views.warp, &images) != YORO_OK) return 1;

  /* A real render of the same eye. Do this once in every engine: a wrong sign, a flipped row or a misread depth costs
   * more than 10 dB. */
  Image truth = make_image(views.synthesized.width, views.synthesized.height);
  draw(program, views.synthesized.projection, views.synthesized.view, &truth);
  report(argc > 1 ? argv[1] : "gles.png", &other, &source, (int)views.crop_x, (int)views.crop_y, &truth);
  yoro_destroy(yoro);
  return 0;
}
