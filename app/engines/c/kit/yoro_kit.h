/*
 * yoro, shader kit: computes from two eyes what to render, and the uniforms of the passes. No other file is needed.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 */
#ifndef YORO_KIT_H
#define YORO_KIT_H

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* Tangents of the angles from an eye's axis to the edges of its image; left and down are negative when the image
 * contains the axis. With OpenXR: tanf of the angles of XrFovf. */
typedef struct {
  float left, right, up, down;
} YoroKitFrustum;

/* Two eyes that look in the same direction, at right angles to the line between them. */
typedef struct {
  YoroKitFrustum frusta[2]; /* left eye first; of one width, one height and the same rows */
  float ipd;                /* distance between the eyes in metres, 0 or more; or all lengths in another unit */
  float near_z, far_z;      /* depth planes in metres, 0 < near_z < far_z; far_z may be INFINITY */
  int reversed;             /* 0: the depth buffer holds 0 at near_z, 1: it holds 1 there */
  int rendered;             /* the eye that is rendered: 0 left, 1 right */
  int width, height;        /* of each eye's image in pixels */
  float guard_band;         /* metres from which on nothing is missing at the other eye's outer border; 0: no band */
  int rows_down;            /* 0: row 0 of images is the lowest (OpenGL), 1: the topmost (Vulkan) */
} YoroKitEyes;

/* The block `Synthesis` of the shaders, in std140: 112 bytes, which fit push constants. */
typedef struct {
  int32_t source_size[2], target_size[2];
  float law[2];
  uint32_t mirrored;
  int32_t row_offset;
  int32_t target_origin[2];
  float far_displacement, near_displacement;
  float columns[2], origins[2];
  float span_place[4];
  float rows[2];
  float first_row, farthest;
  int32_t source_origin[2];
  float texel[2];
} YoroKitUniforms;

typedef struct {
  int width, height;        /* of the image to render */
  YoroKitFrustum frustum;   /* to render it with, from the rendered eye's place */
  int crop_x, crop_y;       /* where the rendered eye's own image begins in it, from row 0 */
  int tile_map[2];          /* size of the target of tiles.frag, format RGBA32UI */
  int span_map[2];          /* size of the target of spans.frag, format RGBA32UI */
  YoroKitUniforms uniforms; /* for all three passes */
} YoroKitViews;

/* The largest side of an image in pixels: no driver renders larger ones. */
#define YORO_KIT_MAX_SIDE 65536

static inline int yoro_kit_ceil(double pixels) {
  return pixels > YORO_KIT_MAX_SIDE ? YORO_KIT_MAX_SIDE + 1 : pixels > 1e-3 ? (int)ceil(pixels - 1e-3) : 0;
}

/*
 * Computes everything for a frame. x and y are the corner of the other eye's image in its target, on the side of row 0.
 * Returns 0 if the other eye cannot be synthesized: both frusta need the same width, height and rows, and all values
 * must be in the ranges above. No image may have more than 65536 pixels on a side, and in images wider than 4095 pixels
 * nothing may move by more than 4095 pixels. Eyes that are rotated against each other cannot be detected here: do not
 * pass them.
 */
static inline int yoro_kit_views(const YoroKitEyes *eyes, int x, int y, YoroKitViews *views) {
  YoroKitFrustum s = eyes->frusta[eyes->rendered != 0], t = eyes->frusta[eyes->rendered == 0];
  if (eyes->rows_down) {
    /* Rows are counted from the lower edge. If row 0 is the topmost, turn everything upside down. */
    float up = s.up;
    s.up = -s.down, s.down = -up;
    up = t.up, t.up = -t.down, t.down = -up;
  }
  memset(views, 0, sizeof *views);
  if (!(eyes->width > 0 && eyes->width <= YORO_KIT_MAX_SIDE && eyes->height > 0 && eyes->height <= YORO_KIT_MAX_SIDE &&
        x >= 0 && x <= YORO_KIT_MAX_SIDE && y >= 0 && y <= YORO_KIT_MAX_SIDE && s.right > s.left && s.up > s.down && t.right > t.left && t.up > t.down &&
        eyes->near_z > 0 && eyes->near_z < eyes->far_z && eyes->ipd >= 0 && isfinite(eyes->ipd) && eyes->guard_band >= 0))
    return 0;
  const double width = eyes->width, height = eyes->height;
  const double dx = (s.right - s.left) / width, dy = (s.up - s.down) / height; /* tangent per pixel */
  const double row = (s.down - t.down) / dy;
  /* Written so that numbers that are not finite fail, too. */
  if (!(fabs((t.right - t.left) / width / dx - 1) * width <= 0.05 && fabs((t.up - t.down) / height / dy - 1) * height <= 0.05 &&
        fabs(row - round(row)) <= 0.05))
    return 0;

  /* The source: the rendered eye, grown by whole pixels to the union of both frusta and by the guard band, which lies
   * on the side that the other eye sees more of. */
  const int to_left = eyes->rendered != 0;
  const int guard = eyes->guard_band > 0 ? yoro_kit_ceil(eyes->ipd / dx / eyes->guard_band) : 0;
  const int left = yoro_kit_ceil((s.left - t.left) / dx) + (to_left ? guard : 0);
  const int right = yoro_kit_ceil((t.right - s.right) / dx) + (to_left ? 0 : guard);
  const int below = yoro_kit_ceil((s.down - t.down) / dy), above = yoro_kit_ceil((t.up - s.up) / dy);
  if (eyes->width + left + right > YORO_KIT_MAX_SIDE || eyes->height + below + above > YORO_KIT_MAX_SIDE) return 0;
  s.left -= (float)(left * dx), s.right += (float)(right * dx);
  s.down -= (float)(below * dy), s.up += (float)(above * dy);
  views->width = eyes->width + left + right;
  views->height = eyes->height + below + above;
  views->crop_x = left, views->crop_y = below;
  views->frustum = s;
  if (eyes->rows_down) views->frustum.up = -s.down, views->frustum.down = -s.up;

  /* x_other = x + offset + scale * depth, since 1 / z is affine in the depth buffer's values. */
  const double shift = (to_left ? 1.0 : -1.0) * eyes->ipd / dx;
  const double near_inverse = 1.0 / eyes->near_z, far_inverse = isinf(eyes->far_z) ? 0.0 : 1.0 / eyes->far_z;
  const double constant = eyes->reversed ? far_inverse : near_inverse;
  const double slope = eyes->reversed ? near_inverse - far_inverse : far_inverse - near_inverse;
  double offset = ((double)s.left - t.left) / dx + shift * constant, scale = shift * slope;
  const int row_offset = (int)lround((s.down - t.down) / dy);

  /* Shaders count columns in the direction in which nearer surfaces lie farther along: from the right for a right eye. */
  if (!to_left) offset = width - views->width - offset, scale = -scale;
  const double at_near = offset + (eyes->reversed ? scale : 0.0), at_far = offset + (eyes->reversed ? 0.0 : scale);
  if (!(fmin(at_near - at_far, width - at_far) <= 4095 && fmax(fabs(at_near), fabs(at_far)) <= 1 << 20)) {
    memset(views, 0, sizeof *views);
    return 0;
  }
  views->tile_map[0] = (views->width + 15) / 16, views->tile_map[1] = (views->height + 7) / 8;
  views->span_map[0] = (eyes->width + 15) / 16, views->span_map[1] = views->tile_map[1];
  const double sense = to_left ? 1.0 : -1.0, first = to_left ? -x - 0.5 : width + x - 0.5, first_row = y + row_offset;
  const double across = 16.0 * views->span_map[0], up = 8.0 * views->span_map[1];
  YoroKitUniforms *u = &views->uniforms;
  u->source_size[0] = views->width, u->source_size[1] = views->height;
  u->target_size[0] = eyes->width, u->target_size[1] = eyes->height;
  u->law[0] = (float)offset, u->law[1] = (float)scale;
  u->mirrored = !to_left;
  u->row_offset = row_offset;
  u->target_origin[0] = x, u->target_origin[1] = y;
  u->far_displacement = (float)at_far, u->near_displacement = (float)at_near;
  u->columns[0] = (float)(sense / views->width), u->columns[1] = to_left ? 0.0f : 1.0f;
  u->origins[0] = (float)sense, u->origins[1] = (float)(first - offset);
  u->span_place[0] = (float)(sense / across), u->span_place[1] = (float)(1.0 / up);
  u->span_place[2] = (float)((first + 0.5) / across), u->span_place[3] = (float)(-first_row / up);
  u->rows[0] = (float)(1.0 / views->height), u->rows[1] = (float)(-first_row / views->height);
  u->first_row = (float)first_row, u->farthest = (float)(at_far - offset + 0.01);
  u->texel[0] = (float)(1.0 / views->width), u->texel[1] = (float)(1.0 / views->height);
  return 1;
}

/*
 * Fills the block for a source that is a rectangle of larger textures, at x, y from the side of row 0. The shaders are
 * compiled with the macro SOURCE_PARTS, or for Vulkan with the specialization constant 0, PART. In the block of any view, set
 * source_origin and texel.
 */
static inline void yoro_kit_source_part(const YoroKitViews *views, int x, int y, int texture_width, int texture_height,
                                        YoroKitUniforms *block) {
  const double width = texture_width, height = texture_height;
  *block = views->uniforms;
  block->source_origin[0] = x, block->source_origin[1] = y;
  block->texel[0] = (float)(1 / width), block->texel[1] = (float)(1 / height);
  block->columns[0] = (float)((block->mirrored ? -1 : 1) / width);
  block->columns[1] = (float)((block->mirrored ? x + views->width : x) / width);
  block->rows[0] = (float)(1 / height), block->rows[1] = (float)((y - (double)block->first_row) / height);
  /* Spans are found by tiles, not by texture coordinates. */
  for (int i = 0; i < 4; ++i) block->span_place[i] *= (float)views->span_map[i & 1];
}

/* The block of march.frag with the macro MOTION: 128 bytes. The other passes take its first part. */
typedef struct {
  YoroKitUniforms uniforms; /* of yoro_kit_views */
  float motion[4];
} YoroKitMotionUniforms;

/* NDC x of the other eye is that of the rendered eye, plus place[0], plus place[1] times the depth buffer's value. */
static inline void yoro_kit_place(const YoroKitEyes *eyes, double place[2]) {
  const YoroKitFrustum s = eyes->frusta[eyes->rendered != 0], t = eyes->frusta[eyes->rendered == 0];
  const double half = ((double)s.right - s.left) / 2, shift = (eyes->rendered ? 1.0 : -1.0) * eyes->ipd / half;
  const double near_inverse = 1.0 / eyes->near_z, far_inverse = isinf(eyes->far_z) ? 0.0 : 1.0 / eyes->far_z;
  place[0] = ((double)s.left - t.left) / half + shift * (eyes->reversed ? far_inverse : near_inverse);
  place[1] = shift * (eyes->reversed ? near_inverse - far_inverse : far_inverse - near_inverse);
}

/*
 * Fills the rest of the block for motion vectors, whose colour is RGBA16F: the place of a surface minus its place in the
 * previous frame, in normalized device coordinates of the rendered eye itself (not of the wider image), with three
 * components. `minus_one` is 1 if their z is from -1 to 1 (OpenGL), 0 if from 0 to 1. The eyes' size is that of an eye's
 * vectors.
 *
 * Vectors that a game has for an upscaler mostly point from a surface's place to its previous one, in pixels or in texture
 * coordinates, and have y down. Multiply pixels by -2 / width and -2 / height, and texture coordinates by -2; where the runtime
 * takes y up, multiply y by 2 / height, or by 2. They lack z. With 0 in its place, a surface keeps the disparity that it had before it
 * came nearer.
 */
static inline void yoro_kit_motion(const YoroKitEyes *eyes, const YoroKitEyes *previous, int minus_one, float motion[4]) {
  double now[2], then[2];
  yoro_kit_place(eyes, now), yoro_kit_place(previous, then);
  motion[0] = (float)(then[1] / (minus_one ? 2.0 : 1.0));
  motion[1] = (float)(now[1] - then[1]), motion[2] = (float)(now[0] - then[0]);
  motion[3] = 0;
}

/* Where an eye is in the world: x to the right, y up, looking along -z. With OpenXR: an XrPosef. */
typedef struct {
  float orientation[4]; /* quaternion x, y, z, w, of length 1 */
  float position[3];    /* in metres */
} YoroKitPose;

/* Rotates a vector by the orientation of a pose if `sense` is 1, or by its inverse if `sense` is -1. */
static inline void yoro_kit_turn(const YoroKitPose *pose, double sense, const double v[3], double turned[3]) {
  const float *o = pose->orientation;
  const double q[3] = {sense * o[0], sense * o[1], sense * o[2]}, w = o[3];
  double t[3];
  for (int i = 0; i < 3; ++i) t[i] = 2 * (q[(i + 1) % 3] * v[(i + 2) % 3] - q[(i + 2) % 3] * v[(i + 1) % 3]);
  for (int i = 0; i < 3; ++i) turned[i] = v[i] + w * t[i] + q[(i + 1) % 3] * t[(i + 2) % 3] - q[(i + 2) % 3] * t[(i + 1) % 3];
}

/* One view: where its eye is, and its image. With OpenXR: an XrView. */
typedef struct {
  YoroKitPose pose;
  YoroKitFrustum frustum;
  int width, height; /* in pixels */
} YoroKitView;

/* The block `AnyView` of the passes of any view, in std140: 112 bytes, which fit push constants. */
typedef struct {
  int32_t source_size[2], target_origin[2];
  float to_source_x[4], to_source_y[4], to_source_w[4];
  float source_law[2], target_law[2];
  float nearest, far_depth;
  int32_t source_origin[2];
  float texel[2], padding[2];
} YoroKitPoseUniforms;

/*
 * Computes the uniforms to show `target`, in any pose near that of `source`, from the rendered image of `source`.
 * near_z, far_z, reversed and rows_down are as in YoroKitEyes, and apply to both. x and y are the corner of the
 * target's image, on the side of row 0; the source fills its textures. maps receives the sizes of the targets of
 * any_view_tiles.frag and any_view_spans.frag, both RGBA32UI. Returns 0 if numbers are out of range, or if the target
 * sees farther than 80 degrees from the source's axis.
 */
static inline int yoro_kit_any_view(const YoroKitView *source, const YoroKitView *target, float near_z, float far_z,
                                    int reversed, int rows_down, int x, int y, int maps[2][2],
                                    YoroKitPoseUniforms *block) {
  const YoroKitFrustum s = source->frustum, t = target->frustum;
  const double near_inverse = 1.0 / near_z, far_inverse = isinf(far_z) ? 0.0 : 1.0 / far_z;
  const double constant = reversed ? far_inverse : near_inverse;
  const double slope = reversed ? near_inverse - far_inverse : far_inverse - near_inverse;
  const double wide = (double)t.right - t.left, high = (double)t.up - t.down, sense = rows_down ? -1.0 : 1.0;
  const double low = rows_down ? t.up : t.down, source_low = rows_down ? s.up : s.down; /* at row 0 */
  const double across = source->width / ((double)s.right - s.left), up = source->height / ((double)s.up - s.down);
  const double least_cosine = 0.173648; /* of 80 degrees */
  memset(block, 0, sizeof *block);
  if (!(source->width > 0 && source->width <= YORO_KIT_MAX_SIDE && source->height > 0 && source->height <= YORO_KIT_MAX_SIDE &&
        target->width > 0 && target->width <= YORO_KIT_MAX_SIDE && target->height > 0 && target->height <= YORO_KIT_MAX_SIDE &&
        x >= 0 && x <= YORO_KIT_MAX_SIDE && y >= 0 && y <= YORO_KIT_MAX_SIDE && across > 0 && isfinite(across) && up > 0 &&
        isfinite(up) && wide > 0 && high > 0 && near_z > 0 && near_z < far_z))
    return 0;
  /* Columns of the matrix from a pixel of the target and the inverse of its distance to a place before the source's
   * eye. */
  double ray[4][3] = {{wide / target->width, 0, 0}, {0, sense * high / target->height, 0}, {t.left, low, -1}, {0, 0, 0}}, own[4][3];
  for (int i = 0; i < 3; ++i) ray[3][i] = (double)target->pose.position[i] - source->pose.position[i];
  for (int column = 0; column < 4; ++column) {
    double world[3] = {ray[3][0], ray[3][1], ray[3][2]};
    if (column < 3) yoro_kit_turn(&target->pose, 1, ray[column], world);
    yoro_kit_turn(&source->pose, -1, world, own[column]);
    block->to_source_x[column] = (float)((own[column][0] + s.left * own[column][2]) * across);
    block->to_source_y[column] = (float)(sense * (own[column][1] + source_low * own[column][2]) * up);
    block->to_source_w[column] = (float)-own[column][2];
  }
  for (int corner = 0; corner < 4; ++corner) {
    double length = 0, seen[3];
    for (int i = 0; i < 3; ++i) {
      seen[i] = own[2][i] + (corner & 1) * target->width * own[0][i] + (corner >> 1) * target->height * own[1][i];
      length += seen[i] * seen[i];
    }
    /* Written so that numbers that are not finite fail, too. */
    if (!(-seen[2] >= least_cosine * sqrt(length))) return 0;
  }
  const double nearest = fmax(near_z, least_cosine * near_z - own[3][2]);
  if (!(nearest < far_z && isfinite(own[3][0] + own[3][1] + own[3][2]))) return 0;
  block->source_size[0] = source->width, block->source_size[1] = source->height;
  block->target_origin[0] = x, block->target_origin[1] = y;
  block->source_law[0] = block->target_law[0] = (float)constant;
  block->source_law[1] = block->target_law[1] = (float)slope;
  block->nearest = (float)((1.0 / nearest - constant) / slope);
  block->far_depth = reversed ? 0.0f : 1.0f;
  block->texel[0] = (float)(1.0 / source->width), block->texel[1] = (float)(1.0 / source->height);
  maps[0][0] = (source->width + 15) / 16, maps[0][1] = (source->height + 7) / 8;
  maps[1][0] = (target->width + 15) / 16, maps[1][1] = (target->height + 7) / 8;
  return 1;
}

/* How much of a foveated view is rendered with all pixels. */
typedef struct {
  float radius;  /* angle in radians around the gaze, more than 0, less than 1.39 */
  float density; /* pixels of the wide view for each pixel of an eye, along each axis: 0.5 */
  float nearest; /* metres from which on the other eye's inset is complete: 0.5 */
  float gaze[2]; /* where both eyes look: tangents to the right and up; 0, 0 for fixed foveation along the axis */
} YoroKitFoveation;

/*
 * Computes the two levels of a foveated view: eyes for yoro_kit_views, each to be rendered and synthesized apart. Sizes do
 * not depend on the gaze. Returns 0 if numbers are out of range, or if an inset would save no pixels: render `shown` then.
 */
static inline int yoro_kit_levels(const YoroKitEyes *shown, const YoroKitFoveation *foveation, YoroKitEyes *wide,
                                  YoroKitEyes *inset) {
  const YoroKitFrustum l = shown->frusta[0], r = shown->frusta[1];
  const double extent[2] = {(double)l.right - l.left, (double)l.up - l.down};
  const double lows[2] = {fmin(l.left, r.left), fmin(l.down, r.down)}, highs[2] = {fmax(l.right, r.right), fmax(l.up, r.up)};
  const int sides[2] = {shown->width, shown->height};
  int size[2], coarse[2];
  double corner[2];
  *wide = *inset = *shown;
  /* Written so that numbers that are not finite fail, too. */
  if (!(sides[0] > 0 && sides[0] <= YORO_KIT_MAX_SIDE && sides[1] > 0 && sides[1] <= YORO_KIT_MAX_SIDE && extent[0] > 0 &&
        extent[1] > 0 && isfinite(extent[0]) && isfinite(extent[1]) && foveation->radius > 0 && foveation->radius < 1.39f &&
        foveation->density > 0 && foveation->density <= 1 && foveation->nearest > 0))
    return 0;
  for (int axis = 0; axis < 2; ++axis) {
    const double pixel = extent[axis] / sides[axis], gaze = isfinite(foveation->gaze[axis]) ? foveation->gaze[axis] : 0;
    const double columns = ceil(2 * tan(foveation->radius) / pixel) + 1;
    size[axis] = columns < sides[axis] ? (int)columns : sides[axis];
    coarse[axis] = yoro_kit_ceil(sides[axis] * (double)foveation->density);
    /* From the left eye's corner, in whole pixels, within what the eyes see together. */
    const double own = axis ? l.down : l.left;
    const double place = fmin(fmax(gaze - size[axis] * pixel / 2, lows[axis]), highs[axis] - size[axis] * pixel);
    corner[axis] = round((place - own) / pixel) * pixel;
  }
  if ((int64_t)size[0] * size[1] + (int64_t)coarse[0] * coarse[1] >= (int64_t)sides[0] * sides[1]) return 0;
  wide->width = coarse[0] > 0 ? coarse[0] : 1, wide->height = coarse[1] > 0 ? coarse[1] : 1;
  inset->width = size[0], inset->height = size[1], inset->guard_band = foveation->nearest;
  for (int eye = 0; eye < 2; ++eye) {
    /* The right eye's pixels are not the left eye's: the same tangents, from the right eye's nearest pixel. */
    YoroKitFrustum *f = &inset->frusta[eye];
    const double dx = extent[0] / sides[0], dy = extent[1] / sides[1];
    const double apart_x = round((l.left - (double)f->left) / dx) * dx, apart_y = round((l.down - (double)f->down) / dy) * dy;
    const double left = f->left + corner[0] + apart_x, down = f->down + corner[1] + apart_y;
    f->left = (float)left, f->right = (float)(left + size[0] * dx);
    f->down = (float)down, f->up = (float)(down + size[1] * dy);
  }
  return 1;
}

/* The block `Levels` of compose.frag, in std140: 128 bytes, which fit push constants. */
typedef struct {
  float eye_place[4], wide_place[4], wide_bounds[4], inset_place[4], inset_part[4], inset_bounds[4], inset_source[4];
  float inset_ramp[2], padding[2];
} YoroKitLevelUniforms;

/* A level of one eye in its texture. */
typedef struct {
  int x, y;                         /* its corner, on the side of row 0 */
  int texture_width, texture_height; /* of the texture */
} YoroKitPart;

/* Texture coordinates of a part of a texture, and of the middles of its outermost pixels. */
static inline void yoro_kit_part(const YoroKitEyes *level, const YoroKitPart *part, double scale[2], double offset[2], float bounds[4]) {
  const double corner[2] = {(double)part->x, (double)part->y}, size[2] = {(double)level->width, (double)level->height};
  const double texture[2] = {(double)part->texture_width, (double)part->texture_height};
  for (int axis = 0; axis < 2; ++axis) {
    scale[axis] = size[axis] / texture[axis], offset[axis] = corner[axis] / texture[axis];
    bounds[axis] = (float)((corner[axis] + 0.5) / texture[axis]);
    bounds[axis + 2] = (float)((corner[axis] + size[axis] - 0.5) / texture[axis]);
  }
}

/*
 * Computes the uniforms that make the image of an eye, 0 left, 1 right, from its levels. Of the rendered eye, the levels
 * are the crops of the rendered images, of the other eye the synthesized ones. `views` are those of the inset if
 * inset_depth is bound, the other eye's depth: its holes at the border of what was rendered then show the wide view. NULL:
 * they show what they were filled with. x and y are the corner of the eye's image in its target.
 */
static inline void yoro_kit_compose(const YoroKitEyes *shown, const YoroKitEyes *wide, const YoroKitEyes *inset, int eye,
                                    const YoroKitPart *wide_part, const YoroKitPart *inset_part,
                                    const YoroKitViews *views, int x, int y, YoroKitLevelUniforms *block) {
  const YoroKitFrustum s = shown->frusta[eye != 0], w = wide->frusta[eye != 0], i = inset->frusta[eye != 0];
  const double corners[2] = {(double)x, (double)y}, sides[2] = {(double)shown->width, (double)shown->height};
  /* From row 0. */
  const double down = shown->rows_down;
  const double lows[3][2] = {{s.left, down ? -s.up : s.down}, {w.left, down ? -w.up : w.down}, {i.left, down ? -i.up : i.down}};
  const double extents[3][2] = {{(double)s.right - s.left, (double)s.up - s.down},
                                {(double)w.right - w.left, (double)w.up - w.down},
                                {(double)i.right - i.left, (double)i.up - i.down}};
  double scale[2], offset[2], part_scale[2], part_offset[2];
  memset(block, 0, sizeof *block);
  yoro_kit_part(wide, wide_part, part_scale, part_offset, block->wide_bounds);
  for (int axis = 0; axis < 2; ++axis) {
    block->eye_place[axis] = (float)(1 / sides[axis]), block->eye_place[axis + 2] = (float)(-corners[axis] / sides[axis]);
    scale[axis] = extents[0][axis] / extents[1][axis], offset[axis] = (lows[0][axis] - lows[1][axis]) / extents[1][axis];
    block->wide_place[axis] = (float)(part_scale[axis] * scale[axis]);
    block->wide_place[axis + 2] = (float)(part_scale[axis] * offset[axis] + part_offset[axis]);
    block->inset_place[axis] = (float)(extents[0][axis] / extents[2][axis]);
    block->inset_place[axis + 2] = (float)((lows[0][axis] - lows[2][axis]) / extents[2][axis]);
    block->inset_ramp[axis] = 1e6f;
  }
  yoro_kit_part(inset, inset_part, part_scale, part_offset, block->inset_bounds);
  for (int axis = 0; axis < 2; ++axis)
    block->inset_part[axis] = (float)part_scale[axis], block->inset_part[axis + 2] = (float)part_offset[axis];
  if (views && (eye != 0) != (inset->rendered != 0)) {
    const YoroKitUniforms *u = &views->uniforms;
    const double per_column = 2.0 / u->source_size[0], across = u->target_size[0] * per_column;
    const double shift = -u->law[0] * per_column - 1;
    /* Columns of a right eye are counted from the right. */
    block->inset_source[0] = (float)across;
    block->inset_source[1] = (float)(u->mirrored ? -across - shift : shift);
    block->inset_source[2] = (float)(u->mirrored ? u->law[1] * per_column : -u->law[1] * per_column);
  }
}

/* Each structure is the shaders' block, byte by byte. */
#if defined(__cplusplus)
#define YORO_KIT_AT(type, member, byte) static_assert(offsetof(type, member) == byte, #type " differs from the shaders' block")
#elif defined(__STDC_VERSION__) && __STDC_VERSION__ >= 201112L
#define YORO_KIT_AT(type, member, byte) _Static_assert(offsetof(type, member) == byte, #type " differs from the shaders' block")
#else
#define YORO_KIT_AT(type, member, byte) extern char yoro_kit_at[offsetof(type, member) == byte ? 1 : -1]
#endif

#endif
