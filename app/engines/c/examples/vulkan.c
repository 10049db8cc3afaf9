/*
 * yoro on Vulkan: renders one eye and synthesizes the other.
 *
 *   vulkan [FILE.png]
 *
 * writes both eyes side by side, the synthesized left eye on the left, and prints how close that is to a real render of
 * it. Steps 1 to 5 show all uses of yoro; engine_vulkan.h stands in for an engine. yoro needs Vulkan 1.1 and no
 * extension.
 */
#include "engine_vulkan.h"

static void on_error(void *user, YoroResult result, const char *sentence) {
  (void)user;
  fprintf(stderr, "yoro (%s): %s\n", yoro_result_text(result), sentence);
}

int main(int argc, char **argv) {
  engine_start();

  /* 1. Where the eyes are. With OpenXR, copy the poses and angles from xrLocateViews. */
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
  eyes.near_z = 0.1f;
  eyes.far_z = INFINITY;
  eyes.depth = YORO_DEPTH_REVERSED;
  eyes.rows = YORO_ROWS_DOWN;
  eyes.clip = YORO_CLIP_VULKAN;
  eyes.guard_band = YORO_GUARD_BAND;
  eyes.messages.callback = on_error;
  YoroViews views;
  YORO_INIT(views);
  if (yoro_views_from_eyes(&eyes, &views) != YORO_OK) return 1;

  /* 2. Once: pipelines for the target's format, and buffers for the largest sizes. */
  YoroContext *yoro = NULL;
  YoroVkInfo info;
  YORO_INIT(info);
  info.loader = vkGetInstanceProcAddr;
  info.instance = instance;
  info.physical_device = gpu;
  info.device = device;
  info.queue_family = 0;
  info.dynamic_rendering = 1;
  info.color_format = VK_FORMAT_R8G8B8A8_UNORM;
  info.depth_format = VK_FORMAT_D32_SFLOAT;
  info.max_source_width = views.source.width, info.max_source_height = views.source.height;
  info.max_target_width = info.max_target_height = SIZE;
  info.messages.callback = on_error;
  if (yoro_vk_create(&info, &yoro) != YORO_OK) return 1;

  /* 3. Once for each pair of images: how they are used before and afterwards. Here, all of them stay attachments. */
  Image source = make_image(views.source.width, views.source.height), other = make_image(SIZE, SIZE);
  const YoroVkState as_color = {VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
                                VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT};
  const YoroVkState as_depth = {
      VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
      VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT,
      VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT};
  /* The previous contents of the target are not needed. */
  const YoroVkState nothing = {VK_IMAGE_LAYOUT_UNDEFINED, VK_PIPELINE_STAGE_ALL_GRAPHICS_BIT, 0};
  const YoroVkImage color_read = {source.color, VK_FORMAT_R8G8B8A8_UNORM, 0, as_color, as_color};
  const YoroVkImage depth_read = {source.depth, VK_FORMAT_D32_SFLOAT, 0, as_depth, as_depth};
  const YoroVkImage color_written = {other.color, VK_FORMAT_R8G8B8A8_UNORM, 0, nothing, as_color};
  const YoroVkImage depth_written = {other.depth, VK_FORMAT_D32_SFLOAT, 0, nothing, as_depth};
  YoroVkSource read;
  YoroVkTarget written;
  YoroVkFrame frame;
  YORO_INIT(read);
  YORO_INIT(written);
  YORO_INIT(frame);
  read.width = source.size.width, read.height = source.size.height;
  read.color = color_read, read.depth = depth_read;
  written.width = written.height = SIZE;
  written.color = color_written, written.depth = depth_written;
  if (yoro_vk_register_source(yoro, &read, &frame.source) != YORO_OK) return 1;
  if (yoro_vk_register_target(yoro, &written, &frame.target) != YORO_OK) return 1;

  /* 4. Each frame: the engine records the opaque objects of one eye. The image is wider than the eye's, which is a crop
   * of it. */
  engine_draw(&views.source, &source);

  /* 5. The other eye, recorded after it. Transparent objects are drawn into both eyes afterwards, against each eye's
   * depth. */
  if (yoro_vk_record(yoro, commands, &views.warp, &frame) != YORO_OK) return 1;

  /* A real render of the same eye. Do this once in every engine: a wrong sign, a flipped row or a misread depth costs
   * more than 10 dB. */
  Image truth = make_image(SIZE, SIZE);
  engine_draw(&views.synthesized, &truth);
  const uint8_t *pixels = engine_finish(&other, &source, views.crop_x, views.crop_y, &truth);
  Picture pair = {2 * SIZE, SIZE, pixels, 2 * SIZE}, expected = {SIZE, SIZE, pixels + 2 * 4 * SIZE * SIZE, SIZE};
  Picture left = {SIZE, SIZE, pixels, 2 * SIZE}, right = {SIZE, SIZE, pixels + 4 * SIZE, 2 * SIZE};
  printf("synthesized: %.2f dB, SSIM %.4f\n", picture_psnr(&left, &expected), picture_ssim(&left, &expected));
  printf("same image:  %.2f dB, SSIM %.4f\n", picture_psnr(&right, &expected), picture_ssim(&right, &expected));
  if (!picture_write(argc > 1 ? argv[1] : "vulkan.png", &pair, 0)) return 1;
  /* To be destroyed before the device. The rest of this engine ends with its process. */
  yoro_destroy(yoro);
  return 0;
}
