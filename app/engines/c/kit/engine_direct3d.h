/*
 * What the samples on Direct3D share, without any Direct3D: the eyes, files, and figures.
 *
 * They read compiled shaders. Each file of hlsl begins with its stage, registers and settings; its entry point is main:
 *
 *     fxc /T vs_5_0 /Fo screen.vert.dxbc hlsl/screen.vert.hlsl      and march.vert
 *     fxc /T ps_5_0 /Fo tiles.frag.dxbc hlsl/tiles.frag.hlsl        and spans.frag
 *     fxc /T ps_5_0 /D WRITE_DEPTH=1 /Fo march.frag.dxbc hlsl/march.frag.hlsl
 *     fxc /T vs_5_0 /E room_vertex /Fo room.vert.dxbc room.hlsl
 *     fxc /T ps_5_0 /E room_pixel /Fo room.frag.dxbc room.hlsl
 *     cl /std:c++17 example_d3d12.cpp d3d12.lib                     or example_d3d11.cpp d3d11.lib
 *
 * On Linux, vkd3d-compiler -x hlsl -b dxbc-tpf -p ps_5_0 -e main FILE -o RESULT compiles the same text, and vkd3d and DXVK
 * run the samples: link vkd3d-utils and vkd3d, or dxvk_d3d11. dxc -T ps_6_0 compiles for Shader Model 6.0.
 *
 * What differs from other interfaces, in any engine:
 *
 * Rows are counted from the top: set rows_down. Clip space has y up all the same, so both vertex shaders turn it; nothing
 * else must. Frusta stay as they are, with up and down as the eye sees them.
 *
 * The clip volume has z from 0 to 1, and the depth buffer stores it if the viewport's MinDepth and MaxDepth are 0 and 1.
 * yoro_kit.h takes what is stored, and needs no matrix. A game that narrows the range for some objects stores another
 * law for them. The passes draw one triangle at z 0: nothing must cull it or test its depth.
 *
 * Reversed depth, which is cleared to 0 and tested with GREATER, is `reversed`; without a far plane, far_z is INFINITY. To be
 * read, a depth buffer is made typeless and gets two views: R32_TYPELESS, D32_FLOAT and R32_FLOAT; or R24G8_TYPELESS,
 * D24_UNORM_S8_UINT and R24_UNORM_X8_TYPELESS. Of a buffer that is not typeless, make a typeless copy by CopyResource.
 *
 * MSAA: colour is resolved as usual, and depth to each pixel's nearest. On Direct3D 12, ResolveSubresourceRegion does it with
 * D3D12_RESOLVE_MODE_MIN, or MAX of reversed depth. On Direct3D 11 nothing does: draw nearest_depth.frag with screen.vert, and
 * with REVERSED for reversed depth; it reads the samples at t0 and writes the depth of a target.
 */
#ifndef ENGINE_DIRECT3D_H
#define ENGINE_DIRECT3D_H

#include "picture.h"
#include "yoro_kit.h"

#include <string>
#include <utility>
#include <vector>

enum { SIDE = 512 };

/* Eyes that are not rotated. Depth is reversed, from 0.1 m to infinity. Row 0 of Direct3D's images is the topmost. */
static YoroKitEyes make_eyes() {
  const float up = tanf(0.65f), out = tanf(0.7f), in = tanf(0.6f);
  return {{{-out, in, up, -up}, {-in, out, up, -up}}, 0.063f, 0.1f, INFINITY, 1, 1, SIDE, SIDE, 1.0f, 1};
}

/* The constants of room.hlsl. */
struct Room {
  YoroKitFrustum frustum;
  float eye[3], near_z;
};
static_assert(sizeof(Room) == 32, "the buffer of room.hlsl");

static Room make_room(const YoroKitFrustum &frustum, float eye_x) { return {frustum, {eye_x, 1.6f, 2.0f}, 0.1f}; }

[[noreturn]] static void fail(const std::string &what) {
  fprintf(stderr, "error: %s\n", what.c_str());
  exit(1);
}

/* Reads a compiled shader from the folder in YORO_KIT, or from this one. */
static std::vector<char> read_shader(const std::string &name) {
  const char *folder = getenv("YORO_KIT");
  const std::string path = std::string(folder ? folder : ".") + "/" + name + ".dxbc";
  std::vector<char> bytes;
  FILE *file = fopen(path.c_str(), "rb");
  if (!file) fail(path + " cannot be read: compile the shaders as engine_direct3d.h says");
  for (int byte = fgetc(file); byte != EOF; byte = fgetc(file)) bytes.push_back((char)byte);
  fclose(file);
  return bytes;
}

/* An image that was read back: pixels of four bytes, row 0 first. */
struct Pixels {
  int width, height;
  std::vector<uint8_t> bytes;
};

static void write_raw(const std::string &path, const Pixels &image) {
  FILE *file = fopen(path.c_str(), "wb");
  if (!file || fwrite(image.bytes.data(), 1, image.bytes.size(), file) != image.bytes.size() || fclose(file))
    fail(path + " cannot be written");
}

/* All that a sample has drawn: colour and depth of the source, of the other eye, and of that eye rendered. */
struct Results {
  Pixels source, source_depth, other, other_depth, truth, truth_depth;
};

/* Writes both eyes side by side, and prints how close the synthesized one is to the one rendered. With a second argument,
 * also writes what can be compared: files of that name, with endings. */
static void report(int argc, char **argv, const std::string &name, const YoroKitViews &views, const Results &r) {
  const uint8_t *own = r.source.bytes.data() + 4 * ((size_t)views.crop_y * r.source.width + views.crop_x);
  const Picture synthesized = {SIDE, SIDE, r.other.bytes.data(), SIDE}, rendered = {SIDE, SIDE, own, r.source.width};
  const Picture expected = {SIDE, SIDE, r.truth.bytes.data(), SIDE};
  std::vector<uint8_t> both(4 * 2 * SIDE * SIDE);
  for (size_t y = 0; y < SIDE; ++y) {
    memcpy(&both[8 * SIDE * y], &r.other.bytes[4 * SIDE * y], 4 * SIDE);
    memcpy(&both[8 * SIDE * y + 4 * SIDE], own + 4 * y * r.source.width, 4 * SIDE);
  }
  const Picture pair = {2 * SIDE, SIDE, both.data(), 2 * SIDE};
  printf("synthesized: %.2f dB, SSIM %.4f\n", picture_psnr(&synthesized, &expected), picture_ssim(&synthesized, &expected));
  printf("same image:  %.2f dB, SSIM %.4f\n", picture_psnr(&rendered, &expected), picture_ssim(&rendered, &expected));
  if (!picture_write(argc > 1 ? argv[1] : (name + ".png").c_str(), &pair, 0)) fail("the picture cannot be written");
  const std::string prefix = argc > 2 ? argv[2] : "";
  const std::pair<const char *, const Pixels *> images[] = {{"source", &r.source}, {"source_depth", &r.source_depth}, {"other", &r.other},
                                                            {"other_depth", &r.other_depth}, {"truth_depth", &r.truth_depth}};
  for (const auto &image : images)
    if (argc > 2) write_raw(prefix + "." + image.first, *image.second);
}

#endif
