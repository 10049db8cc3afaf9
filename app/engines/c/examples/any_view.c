/*
 * yoro on OpenGL ES: shows an image from the pose that the head has reached since the image was rendered.
 *
 *   any_view [FILE.png]
 *
 * writes the synthesized view from the new pose on the left and the rendered view on the right, and prints how close
 * the first is to a real render of it. engine_gles.h stands in for an engine.
 */
#include <yoro.h>

#include "engine_gles.h"

/* Called with a sentence for every error, after which the sample exits. */
static void on_error(void *user, YoroResult result, const char *sentence) {
  (void)user;
  fprintf(stderr, "yoro (%s): %s\n", yoro_result_text(result), sentence);
}

/* Widens a view for a head that turns by up to `rotation` radians and moves by up to `translation` metres, and sets the
 * view's matrices. Surfaces at a distance of half a metre or more stay in the image. */
static YoroGuardedView widened(const YoroView *view, float rotation, float translation) {
  YoroHeadMotion motion;
  YORO_INIT(motion);
  motion.rotation = rotation;
  motion.translation = translation;
  motion.nearest = 0.5f;
  motion.near_z = 0.1f;
  motion.far_z = INFINITY;
  motion.depth = YORO_DEPTH_REVERSED;
  motion.view = view;
  motion.messages.callback = on_error;
  YoroGuardedView guarded;
  YORO_INIT(guarded);
  if (yoro_guarded_view(&motion, &guarded) != YORO_OK) exit(1);
  return guarded;
}

int main(int argc, char **argv) {
  make_context();
  GLuint program = make_program();

  /* 1. Once, with the engine's context current. */
  YoroContext *yoro = NULL;
  YoroGlInfo info;
  YORO_INIT(info);
  info.warp_kind = YORO_WARP_KIND_POSE;
  info.state = YORO_GL_STATE_PRESERVE;
  info.check = 1;
  info.loader = eglGetProcAddress;
  info.messages.callback = on_error;
  if (yoro_gl_create(&info, &yoro) != YORO_OK) return 1;

  /* 2. When rendering: the eye's view, widened for the motion that is expected until the image is shown. */
  YoroView own = {SIZE, SIZE, {{0, 0, 0, 1}, {0, 1.6f, 2}}, {-0.7f, 0.6f, 0.65f, -0.65f}, {0}, {0}};
  YoroGuardedView guarded = widened(&own, 0.15f, 0.06f);
  Image source = make_image(guarded.view.width, guarded.view.height);
  draw(program, guarded.view.projection, guarded.view.view, &source);

  /* 3. When displaying: the head has turned by a tenth of a radian to the left, and moved to the right and forward. */
  own.pose.orientation[1] = sinf(0.05f);
  own.pose.orientation[3] = cosf(0.05f);
  own.pose.position[0] += 0.04f;
  own.pose.position[2] -= 0.03f;
  YoroPoses poses;
  YORO_INIT(poses);
  poses.near_z = 0.1f;
  /* As in widened(): reversed depth without a far plane. Other depth: see gles.c. */
  poses.far_z = INFINITY;
  poses.depth = YORO_DEPTH_REVERSED;
  poses.source = &guarded.view;
  poses.target = &own;
  poses.messages.callback = on_error;
  YoroPoseWarp warp;
  if (yoro_pose_warp(&poses, &warp) != YORO_OK) return 1;
  Image shown = make_image(SIZE, SIZE);
  YoroGlImages images;
  YORO_INIT(images);
  images.color_texture = source.color;
  images.depth_texture = source.depth;
  images.framebuffer = shown.framebuffer;
  if (yoro_gl_synthesize_pose(yoro, &warp, &images) != YORO_OK) return 1;

  /* A real render of the same view. An engine uses its own camera; here the matrices are those of a view that is not
   * widened. */
  YoroGuardedView exact = widened(&own, 0, 0);
  Image truth = make_image(SIZE, SIZE);
  draw(program, exact.view.projection, exact.view.view, &truth);
  report(argc > 1 ? argv[1] : "any_view.png", &shown, &source, (int)guarded.crop_x, (int)guarded.crop_y, &truth);
  yoro_destroy(yoro);
  return 0;
}
