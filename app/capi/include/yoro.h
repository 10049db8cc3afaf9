/*
 * yoro: render one eye, synthesize the other.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 *
 * For Vulkan define YORO_USE_VULKAN, or include <vulkan/vulkan.h> before this file; without it there is the rest. The file can
 * be included again with it.
 *
 * Every function may also return YORO_ERROR_INTERNAL.
 *
 * Made of app/capi/src by cbindgen; `cargo xtask test the_header --bless` renews it.
 */

#ifndef YORO_H
#define YORO_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

/**
 * Sets a structure that begins with struct_size to zeros, and that to its size: YoroEyes eyes; YORO_INIT(eyes);
 */
#define YORO_INIT(structure) \
  (memset(&(structure), 0, sizeof(structure)), (structure).struct_size = (uint32_t)sizeof(structure))

/**
 * Version of this header.
 */
#define YORO_VERSION_MAJOR 0

/**
 * Second part of the version.
 */
#define YORO_VERSION_MINOR 1

/**
 * Third part of the version.
 */
#define YORO_VERSION_PATCH 0

/**
 * The version as one number that grows: major * 1000000 + minor * 1000 + patch.
 */
#define YORO_VERSION (((YORO_VERSION_MAJOR * 1000000) + (YORO_VERSION_MINOR * 1000)) + YORO_VERSION_PATCH)

/**
 * A guard band that is complete for everything farther away than an arm's length, in metres.
 */
#define YORO_GUARD_BAND 1.0

/**
 * The largest number of strips in a history.
 */
#define YORO_MOST_STRIPS 8

/**
 * Finds out whether two renders are cheaper on this device, or one with synthesis: it renders both in turns for about
 * a second, chooses, and measures again when that may have changed.
 *
 * Use it from one thread at a time. It needs no YoroContext.
 */
typedef struct YoroChooser YoroChooser;

/**
 * The synthesis in one GL context or on one Vulkan device: compiled shaders and small buffers.
 *
 * Use it from one thread at a time, a second thread gets YORO_ERROR_BUSY. For OpenGL that must be the thread on which
 * the GL context is current; for Vulkan it can be any thread.
 */
typedef struct YoroContext YoroContext;

/**
 * The result of a function: YORO_OK, or one of the negative YORO_ERROR_ codes.
 */
typedef int32_t YoroResult;
/**
 * Success.
 */
#define YORO_OK 0
/**
 * A pointer that must not be NULL is NULL.
 */
#define YORO_ERROR_NULL (-1)
/**
 * struct_size is not the size of the structure, or a newer program sets fields that this library does not know.
 */
#define YORO_ERROR_STRUCT_SIZE (-2)
/**
 * A value is out of its range: not finite, a size of zero, an unknown constant, or planes out of order.
 */
#define YORO_ERROR_VALUE (-3)
/**
 * A matrix is not a rigid view or not a perspective projection, or the two eyes' matrices do not fit each other.
 */
#define YORO_ERROR_MATRIX (-4)
/**
 * The eyes look in different directions. Use YORO_EYES_PARALLEL, or render both eyes.
 */
#define YORO_ERROR_EYES_CANTED (-5)
/**
 * The eyes do not lie on one horizontal line. Use YORO_EYES_PARALLEL.
 */
#define YORO_ERROR_EYES_OFF_AXIS (-6)
/**
 * The left eye lies to the right of the right eye, or surfaces at the near plane move by more pixels than can be
 * synthesized: 4095 in images that are wider than that.
 */
#define YORO_ERROR_EYES_IPD (-7)
/**
 * The eyes' images have different tangents per pixel. Use YORO_EYES_EVEN.
 */
#define YORO_ERROR_EYES_DENSITY (-8)
/**
 * The rows of one eye's image lie between the rows of the other's. Use YORO_EYES_EVEN.
 */
#define YORO_ERROR_EYES_ROWS (-9)
/**
 * An image is wider or higher than the driver, or any driver, can render.
 */
#define YORO_ERROR_TOO_LARGE (-10)
/**
 * No GL context is current on this thread, or the loader does not return the API's entry points.
 */
#define YORO_ERROR_NO_CONTEXT (-11)
/**
 * The driver is too old, or lacks a feature that was asked for.
 */
#define YORO_ERROR_UNSUPPORTED (-12)
/**
 * A texture, image or framebuffer does not exist, or has the wrong format, type or size.
 */
#define YORO_ERROR_FORMAT (-13)
/**
 * The driver refused a shader, an object or a command.
 */
#define YORO_ERROR_DRIVER (-14)
/**
 * The YoroContext was created for another API than the function belongs to.
 */
#define YORO_ERROR_API (-15)
/**
 * Another thread is inside a function with this YoroContext.
 */
#define YORO_ERROR_BUSY (-16)
/**
 * No memory is left, on the host or on the device.
 */
#define YORO_ERROR_MEMORY (-17)
/**
 * The Vulkan device is lost: create it and the YoroContext again.
 */
#define YORO_ERROR_DEVICE_LOST (-18)
/**
 * The id is not registered with this YoroContext, or was released.
 */
#define YORO_ERROR_NOT_REGISTERED (-19)
/**
 * An error of the library itself. Afterwards the YoroContext returns only this, and can only be destroyed.
 */
#define YORO_ERROR_INTERNAL (-20)

/**
 * One of the two eyes, which is also its index in arrays of two.
 */
typedef uint32_t YoroEye;
/**
 * The left eye.
 */
#define YORO_EYE_LEFT 0
/**
 * The right eye.
 */
#define YORO_EYE_RIGHT 1

/**
 * Pose of an eye in a right-handed world with Y up. The eye looks along its own -Z axis, with X to the right. Laid out
 * as XrPosef.
 */
typedef struct {
  /**
   * Rotation from the eye's axes to the world's: the quaternion x, y, z, w, of length 1.
   */
  float orientation[4];
  /**
   * Position in metres.
   */
  float position[3];
} YoroPose;

/**
 * Angles in radians from the eye's axis to the edges of its image, each smaller than a right angle. Left and down are
 * negative if the image contains the axis. Laid out as XrFovf.
 */
typedef struct {
  /**
   * Left edge.
   */
  float angle_left;
  /**
   * Right edge.
   */
  float angle_right;
  /**
   * Upper edge.
   */
  float angle_up;
  /**
   * Lower edge.
   */
  float angle_down;
} YoroFov;

/**
 * The meaning of the values 0 to 1 in a depth buffer. It does not depend on the API's clip volume.
 */
typedef uint32_t YoroDepth;
/**
 * 0 at the near plane, 1 at the far plane: tested with LESS, cleared to 1.
 */
#define YORO_DEPTH_STANDARD 0
/**
 * 1 at the near plane, 0 at the far plane: tested with GREATER, cleared to 0.
 */
#define YORO_DEPTH_REVERSED 1

/**
 * The order of an image's rows in memory and in texture coordinates.
 */
typedef uint32_t YoroRows;
/**
 * Row 0 is at the bottom: OpenGL.
 */
#define YORO_ROWS_UP 0
/**
 * Row 0 is at the top: Vulkan, Direct3D, image files.
 */
#define YORO_ROWS_DOWN 1

/**
 * The clip volume of projection matrices. X points to the right in all of them.
 */
typedef uint32_t YoroClip;
/**
 * OpenGL: y up, z from -1 to 1.
 */
#define YORO_CLIP_OPENGL 0
/**
 * Vulkan: y down, z from 0 to 1.
 */
#define YORO_CLIP_VULKAN 1
/**
 * y up, z from 0 to 1: OpenGL with glClipControl, Vulkan with a viewport of negative height, Direct3D, Metal.
 */
#define YORO_CLIP_Y_UP_Z_0_1 2

/**
 * Bits for changes to eyes that cannot be synthesized as they are.
 */
typedef uint32_t YoroEyesFlags;
/**
 * Gives both eyes frusta of the same width and height over the same rows, large enough to contain their own. Show the
 * images with the resulting angles.
 */
#define YORO_EYES_EVEN 1
/**
 * Turns both eyes, which stay where they are, to one direction at right angles to the line between them, and gives
 * them even frusta that contain their own. For canted eyes, and for eyes that do not lie on one horizontal line, such
 * as those of a calibrated headset. Show the images with the resulting poses and angles: an OpenXR runtime turns
 * images back that are submitted with these.
 */
#define YORO_EYES_PARALLEL 2

/**
 * Receives the sentence of an error: the fault and the remedy, in UTF-8, valid during the call only. It is called on
 * the thread of the function that fails, before that returns. It must not throw, and must not call yoro with the same
 * context.
 */
typedef void (*YoroMessageCallback)(void *user, YoroResult result, const char *sentence);

/**
 * The receiver of the sentences of errors.
 */
typedef struct {
  /**
   * Called for each error; may be NULL.
   */
  YoroMessageCallback callback;
  /**
   * The first argument of the callback.
   */
  void *user;
} YoroMessages;

/**
 * The two eyes of a frame, given by poses and angles.
 *
 * Metres stand for any unit: all lengths may have another one, the same for all, and the eyes may be any distance
 * apart, so that a wearer is a giant or a mouse. Positions are rounded to 32 bits: 1 km from the origin to 0.06 mm, a
 * thousandth of the eyes' distance. In larger worlds give poses relative to the head, and move the resulting view
 * matrices by the head's place.
 */
typedef struct {
  /**
   * sizeof(YoroEyes).
   */
  uint32_t struct_size;
  /**
   * The eye that is rendered.
   */
  YoroEye rendered;
  /**
   * Width of each eye's image in pixels.
   */
  uint32_t width;
  /**
   * Height of each eye's image in pixels.
   */
  uint32_t height;
  /**
   * Poses, left eye first.
   */
  YoroPose poses[2];
  /**
   * Angles, left eye first.
   */
  YoroFov fovs[2];
  /**
   * Distance of the near plane in metres, more than 0.
   */
  float near_z;
  /**
   * Distance of the far plane in metres, more than near_z, also for reversed depth; may be INFINITY.
   */
  float far_z;
  /**
   * The meaning of the depth buffer's values.
   */
  YoroDepth depth;
  /**
   * Order of rows in the images.
   */
  YoroRows rows;
  /**
   * The clip volume of the resulting matrices.
   */
  YoroClip clip;
  /**
   * Guard band: the distance in metres from which on the rendered image contains the whole outer border of the other
   * eye. Smaller values cost more pixels. 0 for no guard band: the border is filled in.
   */
  float guard_band;
  /**
   * YORO_EYES_ bits.
   */
  YoroEyesFlags flags;
  /**
   * Zero.
   */
  uint32_t reserved;
  /**
   * Where the sentences of errors go.
   */
  YoroMessages messages;
} YoroEyes;

/**
 * One image: its size, the pose of its eye, its frustum, and the matrices that render it.
 */
typedef struct {
  /**
   * Width in pixels.
   */
  uint32_t width;
  /**
   * Height in pixels.
   */
  uint32_t height;
  /**
   * Pose of the eye. For matrices of a left-handed world it is in the world with the Z axis negated.
   */
  YoroPose pose;
  /**
   * Angles of the image's outer edges.
   */
  YoroFov fov;
  /**
   * World to eye, column-major, for column vectors: the translation is in elements 12 to 14.
   */
  float view[16];
  /**
   * Eye to clip space, column-major.
   */
  float projection[16];
} YoroView;

/**
 * The mapping of pixels from the rendered image to the other eye's. yoro_views_from_eyes and yoro_views_from_matrices
 * fill it. It can be copied and kept.
 *
 * The pixel in column x and row y lands in column x + offset + scale * depth and row y + row_offset, where depth is
 * the value in the depth buffer.
 */
typedef struct {
  /**
   * Width of the rendered colour and depth in pixels.
   */
  uint32_t source_width;
  /**
   * Height of the rendered colour and depth in pixels.
   */
  uint32_t source_height;
  /**
   * Width of the synthesized image in pixels.
   */
  uint32_t target_width;
  /**
   * Height of the synthesized image in pixels.
   */
  uint32_t target_height;
  /**
   * Displacement in columns at depth 0.
   */
  double offset;
  /**
   * Displacement in columns per unit of depth.
   */
  double scale;
  /**
   * Target row minus source row.
   */
  int32_t row_offset;
  /**
   * The eye that is synthesized.
   */
  YoroEye target_eye;
  /**
   * The meaning of depth values.
   */
  YoroDepth depth;
  /**
   * Zero.
   */
  uint32_t reserved;
} YoroWarp;

/**
 * The images of a frame.
 */
typedef struct {
  /**
   * sizeof(YoroViews), set by the caller.
   */
  uint32_t struct_size;
  /**
   * First column of the rendered eye's own image in the source.
   */
  uint32_t crop_x;
  /**
   * First row of the rendered eye's own image in the source, counted as YoroRows says.
   */
  uint32_t crop_y;
  /**
   * Zero.
   */
  uint32_t reserved;
  /**
   * The view to render: the rendered eye's, widened by the guard band. Render colour and depth of this size.
   */
  YoroView source;
  /**
   * The rendered eye's own image: the part of the source of this size that begins at crop_x, crop_y.
   */
  YoroView rendered;
  /**
   * The synthesized image.
   */
  YoroView synthesized;
  /**
   * The mapping of pixels, for synthesis.
   */
  YoroWarp warp;
} YoroViews;

/**
 * The two eyes of a frame, given by matrices; they may be any distance apart. All matrices are column-major, for
 * column vectors, as GL and Vulkan take them. The translation of a view matrix is in elements 12 to 14. Element 11
 * of a projection is -1 for eyes that look along -Z, and 1 for eyes that look along +Z.
 */
typedef struct {
  /**
   * sizeof(YoroMatrices).
   */
  uint32_t struct_size;
  /**
   * The eye that is rendered.
   */
  YoroEye rendered;
  /**
   * Width of each eye's image in pixels.
   */
  uint32_t width;
  /**
   * Height of each eye's image in pixels.
   */
  uint32_t height;
  /**
   * World to eye, left eye first: rotation and translation only. The world may be right- or left-handed.
   */
  float view[2][16];
  /**
   * Eye to clip space, left eye first: perspective. Reversed and infinite depth are recognized.
   */
  float projection[2][16];
  /**
   * The clip volume of the projections.
   */
  YoroClip clip;
  /**
   * Order of rows in the images.
   */
  YoroRows rows;
  /**
   * As in YoroEyes, in metres.
   */
  float guard_band;
  /**
   * Units of the world in a metre: 100 for centimetres. 0 means 1.
   */
  float units_per_metre;
  /**
   * Where the sentences of errors go.
   */
  YoroMessages messages;
  /**
   * YORO_EYES_ bits. The resulting view matrices are turned as the eyes are.
   */
  YoroEyesFlags flags;
  /**
   * Zero.
   */
  uint32_t reserved;
} YoroMatrices;

/**
 * The API of a YoroContext.
 */
typedef uint32_t YoroApi;
/**
 * OpenGL ES.
 */
#define YORO_API_OPENGL_ES 0
/**
 * Desktop OpenGL.
 */
#define YORO_API_OPENGL 1
/**
 * Vulkan.
 */
#define YORO_API_VULKAN 2

/**
 * The driver of a YoroContext and its limits.
 */
typedef struct {
  /**
   * sizeof(YoroCapabilities), set by the caller.
   */
  uint32_t struct_size;
  /**
   * The API of the context.
   */
  YoroApi api;
  /**
   * Major version of the API: 3 for 3.1.
   */
  uint32_t api_major;
  /**
   * Minor version of the API: 1 for 3.1.
   */
  uint32_t api_minor;
  /**
   * Zero.
   */
  uint32_t reserved;
  /**
   * 1 if there are compute shaders; yoro does not need them.
   */
  uint32_t compute;
  /**
   * 1 if the CPU draws (llvmpipe, SwiftShader).
   */
  uint32_t software;
  /**
   * Largest width and height of an image in pixels.
   */
  uint32_t max_image_size;
  /**
   * Bytes of the buffers that the context has allocated on the GPU.
   */
  uint64_t buffer_bytes;
  /**
   * Name of the GPU or its driver in UTF-8, cut off if it is too long, and ended by 0.
   */
  uint8_t device[128];
} YoroCapabilities;

/**
 * The GPU's times of one frame, in nanoseconds. All are 0 as long as none is known.
 */
typedef struct {
  /**
   * sizeof(YoroTimes), set by the caller.
   */
  uint32_t struct_size;
  /**
   * 1 if the times are those of a frame.
   */
  uint32_t is_known;
  /**
   * The split of the source into surfaces; 0 with YORO_EDGES_HARD.
   */
  uint64_t split_ns;
  /**
   * The bounds of the displacements, or depths, in each tile.
   */
  uint64_t tiles_ns;
  /**
   * The part of the source to search for each tile of the target.
   */
  uint64_t spans_ns;
  /**
   * The search, which writes the target.
   */
  uint64_t march_ns;
} YoroTimes;

/**
 * A way to make both eyes of a frame, which is also its index in arrays of two.
 */
typedef uint32_t YoroWay;
/**
 * Both eyes are rendered.
 */
#define YORO_WAY_TWO_VIEWS 0
/**
 * One eye is rendered, the other synthesized.
 */
#define YORO_WAY_SYNTHESIS 1
/**
 * Something else, such as both eyes rendered because synthesis was not possible: the frame counts for no way.
 */
#define YORO_WAY_OTHER 2

/**
 * A frame that was handed to the display.
 */
typedef struct {
  /**
   * sizeof(YoroFrameEnd).
   */
  uint32_t struct_size;
  /**
   * The way in which the frame was rendered.
   */
  YoroWay rendered;
  /**
   * The time now, in nanoseconds of a monotonic clock.
   */
  int64_t now_ns;
  /**
   * Refreshes of the display per second; 0 if unknown, or if the display did not set the pace of this frame, as when
   * you waited for the GPU to measure it.
   */
  float refresh_hz;
  /**
   * Milliseconds that a frame has taken; 0 if none are known by now. The GPU's time, if there is a timer; else the
   * time from the beginning of the frame's work to the end of the GPU's, if you wait for that.
   */
  float cost_ms;
  /**
   * The frame that took cost_ms, as the number of frames ended since: 0 for this one. 63 at most.
   */
  uint32_t cost_frames_ago;
  /**
   * 1 if heat is known.
   */
  uint32_t has_heat;
  /**
   * The device's heat on a scale on which 0.1 matters, such as Android's thermal headroom.
   */
  float heat;
  /**
   * Zero.
   */
  uint32_t reserved;
  /**
   * Where the sentences of errors go.
   */
  YoroMessages messages;
} YoroFrameEnd;

/**
 * The reason for a choice.
 */
typedef uint32_t YoroReason;
/**
 * Nothing is measured yet in this scene: it is the way to begin with, or the one before.
 */
#define YORO_REASON_UNMEASURED 0
/**
 * It costs less.
 */
#define YORO_REASON_CHEAPER 1
/**
 * It costs more, but too little for a change: it is the way before.
 */
#define YORO_REASON_SIMILAR 2
/**
 * It holds the display's rate, and the other way does not.
 */
#define YORO_REASON_HOLDS_RATE 3
/**
 * Both ways hold the display's rate, which hides their costs, and nothing more is known: it is the way before.
 */
#define YORO_REASON_BOTH_HOLD_RATE 4
/**
 * One of the ways could not be measured: it is the way before.
 */
#define YORO_REASON_INCOMPARABLE 5

/**
 * The way to render, and why.
 */
typedef struct {
  /**
   * sizeof(YoroChoice), set by the caller.
   */
  uint32_t struct_size;
  /**
   * The way to render the next frame.
   */
  YoroWay next;
  /**
   * 1 while both ways are being measured. Keep resolution and quality meanwhile.
   */
  uint32_t is_measuring;
  /**
   * The way that was chosen last.
   */
  YoroWay chosen;
  /**
   * Why.
   */
  YoroReason reason;
  /**
   * The compared times in milliseconds, by way; 0 if there was nothing to compare.
   */
  float cost_ms[2];
} YoroChoice;

/**
 * A history: an image of the synthesized eye that was really rendered, in strips of equally many rows, each in a frame
 * of its own. All but the last have as many rows: the image's divided by the number of strips, rounded up.
 */
typedef struct {
  /**
   * sizeof(YoroHistory).
   */
  uint32_t struct_size;
  /**
   * Number of strips, 1 to YORO_MOST_STRIPS.
   */
  uint32_t count;
  /**
   * From row 0 of the image on, the view of the whole image from which each was rendered: YoroViews' synthesized of
   * that frame, in the size of the history, all of one size. NULL for a strip with nothing in it.
   */
  const YoroView *strips[YORO_MOST_STRIPS];
  /**
   * Distance of the near plane, as of the eyes: in metres, more than 0.
   */
  float near_z;
  /**
   * Distance of the far plane in metres; may be INFINITY.
   */
  float far_z;
  /**
   * The meaning of the depth buffers' values.
   */
  YoroDepth depth;
  /**
   * Order of rows in the images.
   */
  YoroRows rows;
  /**
   * Where the sentences of errors go.
   */
  YoroMessages messages;
} YoroHistory;

/**
 * The relation of a synthesized image to the strips of a history, for yoro_gl_synthesize and yoro_vk_record.
 * yoro_strips fills it. It can be copied and kept. It has the layout of the block `History` of the shader kit, in
 * std140.
 */
typedef struct {
  /**
   * From a pixel of the synthesized image and its depth to a pixel of each strip's image and its depth,
   * column-major. Zeros for strips with nothing in them.
   */
  float to_history[YORO_MOST_STRIPS][16];
  /**
   * Number of strips.
   */
  uint32_t count;
  /**
   * Zero.
   */
  uint32_t reserved[3];
} YoroStrips;

/**
 * Two views of a scene: a rendered one, and one in any pose near it.
 */
typedef struct {
  /**
   * sizeof(YoroPoses).
   */
  uint32_t struct_size;
  /**
   * The meaning of the depth buffers' values.
   */
  YoroDepth depth;
  /**
   * Distance of the near plane of both, in metres, more than 0.
   */
  float near_z;
  /**
   * Distance of the far plane of both, in metres; may be INFINITY.
   */
  float far_z;
  /**
   * Order of rows in the images.
   */
  YoroRows rows;
  /**
   * Zero.
   */
  uint32_t reserved;
  /**
   * The rendered view. Of this and the next one size, pose and angles are read, which may differ; the matrices are
   * not.
   */
  const YoroView *source;
  /**
   * The view to synthesize.
   */
  const YoroView *target;
  /**
   * Where the sentences of errors go.
   */
  YoroMessages messages;
} YoroPoses;

/**
 * The mapping of pixels from a rendered view to one in any pose near it, for yoro_gl_synthesize_pose and
 * yoro_vk_record_pose. yoro_pose_warp fills it. It can be copied and kept.
 *
 * A surface that the target shows at the pixel (x, y), at the distance 1 / k along the axis of its eye, lies in the
 * source at the homogeneous pixel homography * (x, y, 1) + k * epipole.
 */
typedef struct {
  /**
   * Width of the rendered colour and depth in pixels.
   */
  uint32_t source_width;
  /**
   * Height of the rendered colour and depth in pixels.
   */
  uint32_t source_height;
  /**
   * Width of the synthesized image in pixels.
   */
  uint32_t target_width;
  /**
   * Height of the synthesized image in pixels.
   */
  uint32_t target_height;
  /**
   * The homography of the rotation, column-major.
   */
  double homography[9];
  /**
   * Place of the target's eye in the source image. Zeros in its place leave rotation alone, without depth.
   */
  double epipole[3];
  /**
   * The source's 1 / distance is `source_law[0] + source_law[1] * depth`.
   */
  double source_law[2];
  /**
   * The same of the target.
   */
  double target_law[2];
  /**
   * Stored depth, in the source, of the nearest surface that the target may show.
   */
  double nearest;
  /**
   * Stored depth of the source's far plane.
   */
  double far_depth;
} YoroPoseWarp;

/**
 * The bounds of a head's motion from the pose of a render to that of its display, and a view to render for it.
 */
typedef struct {
  /**
   * sizeof(YoroHeadMotion).
   */
  uint32_t struct_size;
  /**
   * Largest angle of rotation, about any axis, in radians.
   */
  float rotation;
  /**
   * Largest distance that an eye moves, in metres.
   */
  float translation;
  /**
   * Distance in metres from the eye from which on surfaces are to stay in the image.
   */
  float nearest;
  /**
   * Distance of the near plane in metres, more than 0.
   */
  float near_z;
  /**
   * Distance of the far plane in metres; may be INFINITY.
   */
  float far_z;
  /**
   * The meaning of the depth buffer's values.
   */
  YoroDepth depth;
  /**
   * Order of rows in the images.
   */
  YoroRows rows;
  /**
   * The clip volume of the resulting matrices.
   */
  YoroClip clip;
  /**
   * Zero.
   */
  uint32_t reserved;
  /**
   * The view to widen: its size, pose and angles are read.
   */
  const YoroView *view;
  /**
   * Where the sentences of errors go.
   */
  YoroMessages messages;
} YoroHeadMotion;

/**
 * A view with a guard band on all four sides.
 */
typedef struct {
  /**
   * sizeof(YoroGuardedView), set by the caller.
   */
  uint32_t struct_size;
  /**
   * First column of the original view's image in the wider one.
   */
  uint32_t crop_x;
  /**
   * First row of it, counted as YoroRows says.
   */
  uint32_t crop_y;
  /**
   * Zero.
   */
  uint32_t reserved;
  /**
   * The wider view: what to render.
   */
  YoroView view;
} YoroGuardedView;

/**
 * Bits for outputs besides colour, and for their encoding.
 */
typedef uint32_t YoroOutputFlags;
/**
 * Writes depth of the synthesized eye to the target's depth attachment, in the source's encoding: for transparent
 * objects.
 */
#define YORO_OUTPUT_DEPTH 1
/**
 * Source and target are both sRGB images: sampling decodes them, and writing encodes.
 */
#define YORO_OUTPUT_SRGB 2

/**
 * The treatment of GL state that a call changes.
 */
typedef uint32_t YoroGlState;
/**
 * Some of it stays changed: for engines that set all state that they draw with. library.md lists each state.
 */
#define YORO_GL_STATE_LEAVE 0
/**
 * All of it is restored. A program that was deleted while it was current goes at the first call, as GL says; none is
 * current then.
 */
#define YORO_GL_STATE_PRESERVE 1

/**
 * The kind of source images, by their edges: the pixels that show more than one surface. Never give depth that was
 * averaged over samples: it belongs to no surface, and gives halos.
 */
typedef uint32_t YoroEdges;
/**
 * One sample per pixel, of colour and depth.
 */
#define YORO_EDGES_HARD 0
/**
 * Colour resolved from several samples, depth of the nearest of them.
 */
#define YORO_EDGES_NEAREST 1
/**
 * Colour resolved from several samples, depth of the first of them. Drivers that resolve depth themselves leave this.
 */
#define YORO_EDGES_SAMPLE 2
/**
 * Colour resolved from 2 or 4 samples in the standard positions, depth of all of them and, if it still exists, the
 * colour of all of them. This gives the best picture.
 */
#define YORO_EDGES_MULTISAMPLE 3

/**
 * An entry point of any type.
 */
typedef void (*YoroGlProc)(void);

/**
 * Returns an entry point by its name, NULL for one that does not exist: eglGetProcAddress, glfwGetProcAddress and
 * others. Cast those of other types: (YoroGlLoader)SDL_GL_GetProcAddress.
 */
typedef YoroGlProc (*YoroGlLoader)(const char *name);

/**
 * Bits for the way in which sources lie in their textures.
 */
typedef uint32_t YoroGlSourceFlags;
/**
 * The rendered image is a part of larger textures, of any size up to theirs in each frame: dynamic resolution, or both
 * eyes side by side. Buffers then only grow, so that nothing is allocated after yoro_gl_prepare with the largest
 * sizes.
 */
#define YORO_GL_SOURCE_PARTS 1
/**
 * The rendered image is a layer of a GL_TEXTURE_2D_ARRAY, of colour and of depth: the textures of GL_OVR_multiview,
 * and of OpenXR's swapchains for it. Not with YORO_EDGES_MULTISAMPLE.
 */
#define YORO_GL_SOURCE_LAYERS 2

/**
 * The kind of warp that a context is made for.
 */
typedef uint32_t YoroWarpKind;
/**
 * Between two parallel eyes: YoroWarp.
 */
#define YORO_WARP_KIND_EYES 0
/**
 * To a view in any pose near that of the rendered one: YoroPoseWarp. For YORO_EDGES_HARD, without a history. Where
 * both views are parallel eyes the other kind gives the same picture, and is faster.
 */
#define YORO_WARP_KIND_POSE 1

/**
 * The options of a context for OpenGL.
 */
typedef struct {
  /**
   * sizeof(YoroGlInfo).
   */
  uint32_t struct_size;
  /**
   * Zero. Earlier versions chose a pipeline here; other numbers are refused.
   */
  uint32_t reserved;
  /**
   * YORO_OUTPUT_ bits.
   */
  YoroOutputFlags outputs;
  /**
   * The treatment of GL state.
   */
  YoroGlState state;
  /**
   * 1: each call checks textures, framebuffer and GL's error flag, which it clears. This waits for the driver: use
   * it in development. 0: mistakes are undefined behaviour, as in GL.
   */
  uint32_t check;
  /**
   * The kind of source images; 0 is YORO_EDGES_HARD. YORO_EDGES_MULTISAMPLE needs OpenGL ES 3.1.
   */
  YoroEdges edges;
  /**
   * The loader of entry points.
   */
  YoroGlLoader loader;
  /**
   * The receiver of the sentences of errors, also in later calls.
   */
  YoroMessages messages;
  /**
   * YORO_GL_SOURCE_ bits.
   */
  YoroGlSourceFlags sources;
  /**
   * 1: times the passes for yoro_times, by GL_TIME_ELAPSED queries. No such query of the engine may be active then.
   * 0: no times.
   */
  uint32_t timed;
  /**
   * 1: sources may have a history (YoroGlImages). 0: none has.
   */
  uint32_t history;
  /**
   * The kind of warp; 0 is YORO_WARP_KIND_EYES.
   */
  YoroWarpKind warp_kind;
} YoroGlInfo;

/**
 * Textures and framebuffer of one synthesis.
 */
typedef struct {
  /**
   * sizeof(YoroGlImages).
   */
  uint32_t struct_size;
  /**
   * Colour of the rendered eye: name of a GL_TEXTURE_2D of the source's size in any filterable format (another
   * target or size with YORO_GL_SOURCE_ bits). All four channels are carried over, in any encoding. Filters and
   * sampler objects do not matter. Unless YORO_EDGES_HARD is chosen it is resolved, with values between 0 and 1.
   */
  uint32_t color_texture;
  /**
   * Depth of the rendered eye: name of a GL_TEXTURE_2D of the same size with a depth, depth-stencil (sampled as
   * depth) or red float format. For YORO_EDGES_MULTISAMPLE a GL_TEXTURE_2D_MULTISAMPLE of 2 or 4 samples.
   */
  uint32_t depth_texture;
  /**
   * The framebuffer to draw into, 0 for the window's. Its first colour attachment is written, and with
   * YORO_OUTPUT_DEPTH its depth attachment. None of the textures above may be attached to it.
   */
  uint32_t framebuffer;
  /**
   * First column of the synthesized image in the framebuffer.
   */
  uint32_t x;
  /**
   * First row of the synthesized image in the framebuffer, counted from the bottom.
   */
  uint32_t y;
  /**
   * For YORO_EDGES_MULTISAMPLE, name of the GL_TEXTURE_2D_MULTISAMPLE that color_texture was resolved from, or 0 if
   * it does not exist any more. Otherwise 0.
   */
  uint32_t sample_color_texture;
  /**
   * First column of the rendered part in its textures. This and the next three are for YORO_GL_SOURCE_PARTS,
   * otherwise 0.
   */
  uint32_t source_x;
  /**
   * First row of the rendered part, counted from the bottom.
   */
  uint32_t source_y;
  /**
   * Width of the textures in pixels.
   */
  uint32_t image_width;
  /**
   * Height of the textures in pixels.
   */
  uint32_t image_height;
  /**
   * The layer of both textures, for YORO_GL_SOURCE_LAYERS; otherwise 0. A layer to draw into is attached to the
   * framebuffer, by glFramebufferTextureLayer.
   */
  uint32_t layer;
  /**
   * What the other eye has seen, for contexts with `history`; otherwise 0. Name of a GL_TEXTURE_2D of any size with
   * the colour of an image of the synthesized eye that was really rendered, in this frame or before: disocclusions
   * show what is there. It holds what synthesis takes, so nothing that is drawn over both eyes afterwards.
   */
  uint32_t history_color_texture;
  /**
   * The depth of that image, of its size, one value a pixel, with the planes and encoding of the source's.
   */
  uint32_t history_depth_texture;
  /**
   * The views of its strips; NULL: nothing is looked up.
   */
  const YoroStrips *strips;
} YoroGlImages;

#ifdef __cplusplus
extern "C" {
#endif /* __cplusplus */

/**
 * Returns a short text for a result, such as "the eyes are canted", and "unknown result" for other numbers. The text
 * lives as long as the library.
 *
 * Call it from any thread.
 */
const char *yoro_result_text(YoroResult result);

/**
 * Returns the version of the library, in the form of YORO_VERSION, which is the version of the header.
 *
 * Call it from any thread.
 */
uint32_t yoro_version(void);

/**
 * Computes the view to render, and the mapping of its pixels to the other eye.
 *
 * Call it from any thread, without a context. It allocates and keeps nothing.
 *
 * @param eyes  The eyes.
 * @param views Filled in; the caller sets struct_size.
 * @pre Both pointers lead to structures of the size that they state.
 * @return YORO_ERROR_VALUE, YORO_ERROR_TOO_LARGE or a YORO_ERROR_EYES_ code for eyes that are impossible or cannot be
 *         synthesized; YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE.
 */
YoroResult yoro_views_from_eyes(const YoroEyes *eyes,
                                YoroViews *views);

/**
 * Computes the view to render, and the mapping of its pixels to the other eye. The resulting matrices have the world,
 * clip volume and units of the given ones. Poses are in metres.
 *
 * The translation of a view matrix is rounded to 32 bits: 1 km from the origin to 0.06 mm, a thousandth of the eyes'
 * distance. Displacements that this rounding makes are taken out; the eyes' distance keeps its error. In larger worlds
 * give matrices relative to the head: subtract its place from both eyes' places, in 64 bits, before making the
 * matrices.
 *
 * Call it from any thread, without a context. It allocates and keeps nothing.
 *
 * @param matrices The eyes.
 * @param views    Filled in; the caller sets struct_size.
 * @pre Both pointers lead to structures of the size that they state.
 * @return YORO_ERROR_MATRIX for matrices that are not rigid views or perspective projections; otherwise as
 *         yoro_views_from_eyes.
 */
YoroResult yoro_views_from_matrices(const YoroMatrices *matrices,
                                    YoroViews *views);

/**
 * Returns the driver of a context and its limits.
 *
 * Call it on the thread that may use the context; for OpenGL with the GL context current. It changes no GL state.
 *
 * @param context      The context.
 * @param capabilities Filled in; the caller sets struct_size.
 * @pre context is alive.
 * @return YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE, YORO_ERROR_BUSY.
 */
YoroResult yoro_capabilities(YoroContext *context,
                             YoroCapabilities *capabilities);

/**
 * Returns the times of the passes in an earlier frame. Call it once a frame, before the synthesis; it does not wait.
 *
 * OpenGL: of a frame some frames ago, if `timed` of YoroGlInfo is 1 and the driver has timer queries that can be
 * trusted; those of CPU rasterizers cannot. Vulkan: of the frame that was recorded `timed_frames` of YoroVkInfo calls
 * of yoro_vk_record ago, on queue families with timestamps.
 *
 * Thread and preconditions are those of yoro_capabilities.
 *
 * @param context The context.
 * @param times   Filled in; the caller sets struct_size.
 * @pre For Vulkan the commands of that frame have been executed.
 * @return YORO_ERROR_DEVICE_LOST, YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE, YORO_ERROR_BUSY.
 */
YoroResult yoro_times(YoroContext *context,
                      YoroTimes *times);

/**
 * Destroys a context and its objects on the GPU. NULL is allowed, and does nothing.
 *
 * Call it on the thread that may use the context. For OpenGL the GL context must be current. For Vulkan the device
 * must have executed all recorded commands. Destroy the YoroContext before the GL context or device. Deleted GL
 * objects that were bound are not bound any more; other GL state stays.
 *
 * @param context The context, or NULL.
 * @pre context is alive and no other thread uses it.
 * @return YORO_ERROR_BUSY if another thread is inside a function with the context; nothing is destroyed then.
 */
YoroResult yoro_destroy(YoroContext *context);

/**
 * Creates a chooser.
 *
 * Call it from any thread.
 *
 * @param first   The way to begin with, which stays if nothing can be measured: YORO_WAY_TWO_VIEWS or
 * YORO_WAY_SYNTHESIS. @param chooser Receives the chooser; NULL after an error. @pre chooser can be written. @return
 * YORO_ERROR_VALUE, YORO_ERROR_NULL.
 */
YoroResult yoro_chooser_create(YoroWay first,
                               YoroChooser **chooser);

/**
 * Takes a frame that was handed to the display, and says how to render the next one. It allocates nothing. The first
 * frame is rendered in the way that yoro_chooser_create was given.
 *
 * @param chooser The chooser. @param frame   The frame. @param choice  Filled in; the caller sets struct_size. @pre
 * chooser is alive, and no other thread uses it. The others lead to structures of the size that they state. @return
 * YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE; YORO_ERROR_VALUE for an unknown way, negative numbers and numbers that are
 * not finite: such a frame is not counted.
 */
YoroResult yoro_chooser_end_frame(YoroChooser *chooser,
                                  const YoroFrameEnd *frame,
                                  YoroChoice *choice);

/**
 * Has both ways measured again: there is another scene, another place in it, or another resolution.
 *
 * @param chooser The chooser.
 * @pre chooser is alive, and no other thread uses it.
 * @return YORO_ERROR_NULL.
 */
YoroResult yoro_chooser_scene_changed(YoroChooser *chooser);

/**
 * Destroys a chooser. NULL is allowed, and does nothing.
 *
 * @param chooser The chooser, or NULL.
 * @pre chooser is alive, and no other thread uses it.
 */
void yoro_chooser_destroy(YoroChooser *chooser);

/**
 * Computes where the strips of a history show the surfaces of a synthesized image.
 *
 * Call it from any thread, without a context. It allocates and keeps nothing.
 *
 * @param history     The strips.
 * @param synthesized The image to synthesize: YoroViews' synthesized of this frame.
 * @param strips      Filled in.
 * @pre The pointers lead to structures, and `history` to one of the size that it states.
 * @return YORO_ERROR_VALUE, YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE.
 */
YoroResult yoro_strips(const YoroHistory *history, const YoroView *synthesized, YoroStrips *strips);

/**
 * Computes the mapping of pixels from a rendered view to one in any pose near it.
 *
 * Call it from any thread, without a context. It allocates and keeps nothing.
 *
 * @param poses The views. @param warp  Filled in. @pre The pointers lead to structures, and `poses` to one of the size
 * that it states. @return YORO_ERROR_VALUE for views that are impossible, or of which the target sees further than 80
 * degrees from the source's axis; YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE.
 */
YoroResult yoro_pose_warp(const YoroPoses *poses,
                          YoroPoseWarp *warp);

/**
 * Widens a view on all four sides, by whole pixels, so that it contains what the view shows after any such motion.
 *
 * Call it from any thread, without a context. It allocates and keeps nothing.
 *
 * @param motion  The bounds and the view. @param guarded Filled in; the caller sets struct_size. @pre The pointers
 * lead to structures of the sizes that they state. @return YORO_ERROR_VALUE for a view that is impossible or would
 * have to see further than 80 degrees to a side; YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE.
 */
YoroResult yoro_guarded_view(const YoroHeadMotion *motion,
                             YoroGuardedView *guarded);

/**
 * Creates a context for OpenGL ES 3.0 or later, or desktop OpenGL 4.5 or later, and compiles its shaders. Call it at
 * start, not in a frame.
 *
 * Call it on the thread on which the GL context is current. GL state is treated as YoroGlInfo says; the error flag
 * stays.
 *
 * @param info    The options.
 * @param context Receives the new context, NULL after an error. Destroy it with yoro_destroy.
 * @pre The GL context is current, and lives as long as the YoroContext.
 * @return YORO_ERROR_NO_CONTEXT, YORO_ERROR_UNSUPPORTED, YORO_ERROR_MEMORY, YORO_ERROR_DRIVER, YORO_ERROR_VALUE,
 *         YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE.
 */
YoroResult yoro_gl_create(const YoroGlInfo *info,
                          YoroContext **context);

/**
 * Returns how many bytes the buffers of a context will have on the GPU, of its edges and a frame's sizes alone;
 * drivers add padding. yoro_capabilities says it of a context that exists. Not for YORO_WARP_KIND_POSE: there they are
 * 16 bytes for each 16 x 8 pixels of the source, and of the target.
 *
 * Call it from any thread. Neither loader nor GL context is needed.
 *
 * @param info  The options.
 * @param warp  The warp of a frame of the largest sizes.
 * @param bytes Receives the number.
 * @return YORO_ERROR_VALUE, YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE.
 */
YoroResult yoro_gl_buffer_bytes(const YoroGlInfo *info,
                                const YoroWarp *warp,
                                uint64_t *bytes);

/**
 * Allocates the buffers for images of these sizes, so that the first yoro_gl_synthesize does not. Does nothing if the
 * sizes are as before.
 *
 * Thread, GL state and results are those of yoro_gl_synthesize.
 *
 * @param context The context.
 * @param warp    The warp of a frame of these sizes.
 * @pre The GL context is current.
 */
YoroResult yoro_gl_prepare(YoroContext *context,
                           const YoroWarp *warp);

/**
 * Does what yoro_gl_prepare does in a context of YORO_WARP_KIND_POSE.
 *
 * @param context The context.
 * @param warp    The warp of a frame of these sizes.
 * @pre The GL context is current.
 */
YoroResult yoro_gl_prepare_pose(YoroContext *context, const YoroPoseWarp *warp);

/**
 * Synthesizes the other eye into a rectangle of warp's target size, and overwrites all of it. Call it after the opaque
 * objects of the rendered eye, and before transparent objects and effects that are drawn for each eye.
 *
 * Call it on the thread on which the GL context is current. GL state is treated as YoroGlInfo says. While sizes stay
 * the same it allocates and compiles nothing, and does not wait for the GPU.
 *
 * @param context The context. @param warp    The warp of YoroViews. @param images  The images to read and the place to
 * draw. @pre The GL context is current. The textures and the framebuffer belong to it and are as YoroGlImages says.
 * Transform feedback and conditional rendering are not active. @return YORO_ERROR_VALUE, YORO_ERROR_TOO_LARGE,
 * YORO_ERROR_MEMORY, YORO_ERROR_DRIVER; with `check` also YORO_ERROR_FORMAT and YORO_ERROR_NO_CONTEXT; YORO_ERROR_API,
 * YORO_ERROR_BUSY, YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE.
 */
YoroResult yoro_gl_synthesize(YoroContext *context,
                              const YoroWarp *warp,
                              const YoroGlImages *images);

/**
 * Synthesizes a view in any pose near that of the rendered one, in a context of YORO_WARP_KIND_POSE. All else is as in
 * yoro_gl_synthesize.
 *
 * @param context The context.
 * @param warp    The warp of yoro_pose_warp.
 * @param images  The images to read and the place to draw.
 * @pre Those of yoro_gl_synthesize.
 * @return Those of yoro_gl_synthesize.
 */
YoroResult yoro_gl_synthesize_pose(YoroContext *context,
                                   const YoroPoseWarp *warp,
                                   const YoroGlImages *images);

#ifdef __cplusplus
}  // extern "C"
#endif  /* __cplusplus */

#endif  /* YORO_H */

#ifdef YORO_USE_VULKAN
#include <vulkan/vulkan.h>
#endif

#if defined(VK_VERSION_1_1) && !defined(YORO_VULKAN_H)
#define YORO_VULKAN_H

/**
 * vkGetInstanceProcAddr of the Vulkan loader, or of a layer in its place.
 */
typedef void (*(*YoroVkLoader)(VkInstance instance, const char *name))(void);

/**
 * The options of a context for Vulkan.
 */
typedef struct {
  /**
   * sizeof(YoroVkInfo).
   */
  uint32_t struct_size;
  /**
   * Family of the queue that executes the command buffers; it has graphics.
   */
  uint32_t queue_family;
  /**
   * The loader of entry points.
   */
  YoroVkLoader loader;
  /**
   * The instance, of version 1.1 or later; no extension is needed.
   */
  VkInstance instance;
  /**
   * The physical device of `device`.
   */
  VkPhysicalDevice physical_device;
  /**
   * The device, of version 1.1 or later; no extension and no feature is needed.
   */
  VkDevice device;
  /**
   * 1 if the feature dynamicRendering of Vulkan 1.3 or VK_KHR_dynamic_rendering is enabled; it is then used. 0:
   * render passes and framebuffers are used, with the same result.
   */
  uint32_t dynamic_rendering;
  /**
   * Format of the targets' colour, any that the device can render to. Choose an sRGB format if the source is sampled
   * as sRGB.
   */
  VkFormat color_format;
  /**
   * Format of the targets' depth, which is written in the source's encoding; VK_FORMAT_UNDEFINED for no depth.
   */
  VkFormat depth_format;
  /**
   * Largest width of a source in pixels.
   */
  uint32_t max_source_width;
  /**
   * Largest height of a source in pixels.
   */
  uint32_t max_source_height;
  /**
   * Largest width of a synthesized image in pixels.
   */
  uint32_t max_target_width;
  /**
   * Largest height of a synthesized image in pixels.
   */
  uint32_t max_target_height;
  /**
   * The kind of source images; 0 is YORO_EDGES_HARD.
   */
  YoroEdges edges;
  /**
   * For YORO_EDGES_MULTISAMPLE, samples in each pixel of a source's depth: 2 or 4. Otherwise ignored.
   */
  uint32_t samples;
  /**
   * Zero.
   */
  uint32_t reserved;
  /**
   * A pipeline cache, or VK_NULL_HANDLE.
   */
  VkPipelineCache pipeline_cache;
  /**
   * The receiver of the sentences of errors, also in later calls.
   */
  YoroMessages messages;
  /**
   * For yoro_times: the number of frames after which it returns the times of one, at least the frames in flight. 0
   * for no times.
   */
  uint32_t timed_frames;
  /**
   * 1: sources may have a history (YoroVkSource). 0: none has.
   */
  uint32_t history;
  /**
   * The kind of warp; 0 is YORO_WARP_KIND_EYES.
   */
  YoroWarpKind warp_kind;
  /**
   * Zero.
   */
  uint32_t reserved_too;
} YoroVkInfo;

/**
 * A use of an image: one side of a barrier.
 */
typedef struct {
  /**
   * Its layout.
   */
  VkImageLayout layout;
  /**
   * The stages that use it. 0: nothing is waited for before, or nothing waits afterwards, as where a semaphore does.
   */
  VkPipelineStageFlags stages;
  /**
   * Their kinds of access; 0 without stages.
   */
  VkAccessFlags access;
} YoroVkState;

/**
 * One layer of a 2-D image: mip level 0, without multisampling unless stated otherwise.
 */
typedef struct {
  /**
   * The image. Its usage has VK_IMAGE_USAGE_SAMPLED_BIT for a source, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT or
   * VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT for a target.
   */
  VkImage image;
  /**
   * The image's format, or a compatible one if the image has VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT.
   */
  VkFormat format;
  /**
   * The layer of the image, for example the eye's; 0 for an image with one layer.
   */
  uint32_t layer;
  /**
   * Its use before yoro_vk_record: its layout then, and the stages to wait for.
   */
  YoroVkState before;
  /**
   * Its use afterwards, for which it is made ready.
   */
  YoroVkState after;
} YoroVkImage;

/**
 * Images to read.
 */
typedef struct {
  /**
   * sizeof(YoroVkSource).
   */
  uint32_t struct_size;
  /**
   * Width of the images in pixels; the rendered part may be smaller.
   */
  uint32_t width;
  /**
   * Height of the images in pixels.
   */
  uint32_t height;
  /**
   * Zero.
   */
  uint32_t reserved;
  /**
   * Colour of the rendered eye, in any format that can be filtered. All four channels are carried over. Unless
   * YORO_EDGES_HARD is chosen it is resolved, with values between 0 and 1.
   */
  YoroVkImage color;
  /**
   * Depth of the rendered eye: VK_FORMAT_D16_UNORM, D24_UNORM_S8_UINT, D32_SFLOAT, D32_SFLOAT_S8_UINT, R16_UNORM or
   * R32_SFLOAT. For YORO_EDGES_MULTISAMPLE it has YoroVkInfo's samples.
   */
  YoroVkImage depth;
  /**
   * For YORO_EDGES_MULTISAMPLE, the image with as many samples that the colour was resolved from. Its image is
   * VK_NULL_HANDLE if it does not exist any more, and for all other edges.
   */
  YoroVkImage sample_color;
  /**
   * Width of the history's images in pixels, any; 0 without a history.
   */
  uint32_t history_width;
  /**
   * Height of the history's images in pixels.
   */
  uint32_t history_height;
  /**
   * What the other eye has seen, for contexts with `history`: colour of an image of the synthesized eye that was
   * really rendered, in this frame or before; disocclusions show what is there. It holds what synthesis takes, so
   * nothing that is drawn over both eyes afterwards. Its image is VK_NULL_HANDLE without a history.
   */
  YoroVkImage history_color;
  /**
   * The depth of that image, one value a pixel, with the planes and encoding of the source's.
   */
  YoroVkImage history_depth;
} YoroVkSource;

/**
 * The id of a registered source, never 0.
 */
typedef uint32_t YoroVkSourceId;

/**
 * Images to write.
 */
typedef struct {
  /**
   * sizeof(YoroVkTarget).
   */
  uint32_t struct_size;
  /**
   * Width of the images in pixels; the synthesized part may be smaller.
   */
  uint32_t width;
  /**
   * Height of the images in pixels.
   */
  uint32_t height;
  /**
   * Zero.
   */
  uint32_t reserved;
  /**
   * Colour, in YoroVkInfo's color_format.
   */
  YoroVkImage color;
  /**
   * Depth, in YoroVkInfo's depth_format; ignored if that is VK_FORMAT_UNDEFINED.
   */
  YoroVkImage depth;
} YoroVkTarget;

/**
 * The id of a registered target, never 0.
 */
typedef uint32_t YoroVkTargetId;

/**
 * The uses of an image before and after one call.
 */
typedef struct {
  /**
   * Its use before yoro_vk_record: its layout then, and the stages to wait for.
   */
  YoroVkState before;
  /**
   * Its use afterwards, for which it is made ready.
   */
  YoroVkState after;
} YoroVkUse;

/**
 * The uses of all images in one call, for engines whose images come from other passes and go to others in each frame.
 * Those of images that were not registered are ignored. A source is still sampled in the layout that it was registered
 * for: if its registered layout before is not one of those that can be sampled,
 * VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL.
 */
typedef struct {
  /**
   * sizeof(YoroVkUses).
   */
  uint32_t struct_size;
  /**
   * Zero.
   */
  uint32_t reserved;
  /**
   * Of the source's colour.
   */
  YoroVkUse source_color;
  /**
   * Of the source's depth.
   */
  YoroVkUse source_depth;
  /**
   * Of the source's colour of samples.
   */
  YoroVkUse source_sample_color;
  /**
   * Of the target's colour.
   */
  YoroVkUse target_color;
  /**
   * Of the target's depth.
   */
  YoroVkUse target_depth;
  /**
   * Of the history's colour.
   */
  YoroVkUse history_color;
  /**
   * Of the history's depth.
   */
  YoroVkUse history_depth;
} YoroVkUses;

/**
 * The images and places of one synthesis.
 */
typedef struct {
  /**
   * sizeof(YoroVkFrame).
   */
  uint32_t struct_size;
  /**
   * The images to read.
   */
  YoroVkSourceId source;
  /**
   * First column of the rendered part.
   */
  uint32_t source_x;
  /**
   * First row of the rendered part; row 0 is the first in memory.
   */
  uint32_t source_y;
  /**
   * The images to write.
   */
  YoroVkTargetId target;
  /**
   * First column of the synthesized image.
   */
  uint32_t target_x;
  /**
   * First row of the synthesized image.
   */
  uint32_t target_y;
  /**
   * Zero.
   */
  uint32_t reserved;
  /**
   * The uses of the images around this call, in place of those of their registration; may be NULL.
   */
  const YoroVkUses *uses;
  /**
   * The views of the history's strips, for sources with one; NULL: nothing is looked up.
   */
  const YoroStrips *strips;
} YoroVkFrame;

#ifdef __cplusplus
extern "C" {
#endif

/**
 * Creates a context for Vulkan: pipelines, and buffers for the largest sizes. Call it at start, not in a frame.
 *
 * Call it from any thread.
 *
 * @param info    The options.
 * @param context Receives the new context, NULL after an error. Destroy it with yoro_destroy.
 * @pre The handles are valid, belong together, and live until the YoroContext is destroyed.
 * @return YORO_ERROR_NO_CONTEXT for a loader without Vulkan's commands, YORO_ERROR_UNSUPPORTED, YORO_ERROR_FORMAT,
 *         YORO_ERROR_TOO_LARGE, YORO_ERROR_MEMORY, YORO_ERROR_DEVICE_LOST, YORO_ERROR_DRIVER, YORO_ERROR_VALUE,
 *         YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE.
 */
YoroResult yoro_vk_create(const YoroVkInfo *info,
                          YoroContext **context);

/**
 * Returns how many bytes the buffers of a context will have on the GPU, of the sizes, formats and edges of its options
 * alone; drivers add padding. yoro_capabilities says it of a context that exists.
 *
 * Call it from any thread. No handle of the options is needed.
 *
 * @param info  The options.
 * @param bytes Receives the number.
 * @return YORO_ERROR_VALUE, YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE.
 */
YoroResult yoro_vk_buffer_bytes(const YoroVkInfo *info,
                                uint64_t *bytes);

/**
 * Creates views and descriptors of images to read. Call it once for each set of images that you render to.
 *
 * Call it on the thread that may use the context.
 *
 * @param context The context.
 * @param source  The images.
 * @param id      Receives their id.
 * @pre The images live until the id is released or the context is destroyed.
 * @return YORO_ERROR_FORMAT, YORO_ERROR_TOO_LARGE, YORO_ERROR_MEMORY, YORO_ERROR_DEVICE_LOST, YORO_ERROR_DRIVER,
 *         YORO_ERROR_VALUE, YORO_ERROR_API, YORO_ERROR_BUSY, YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE.
 */
YoroResult yoro_vk_register_source(YoroContext *context,
                                   const YoroVkSource *source,
                                   YoroVkSourceId *id);

/**
 * Creates views of images to write. Call it once for each image of a swapchain.
 *
 * Thread, preconditions and results are those of yoro_vk_register_source.
 *
 * @param context The context.
 * @param target  The images.
 * @param id      Receives their id.
 */
YoroResult yoro_vk_register_target(YoroContext *context, const YoroVkTarget *target, YoroVkTargetId *id);

/**
 * Releases the views and descriptors of images to read. Ignores an id that is not registered.
 *
 * Call it on the thread that may use the context.
 *
 * @param context The context.
 * @param id      The id from yoro_vk_register_source.
 * @pre No command that was recorded with the id is pending.
 * @return YORO_ERROR_API, YORO_ERROR_BUSY, YORO_ERROR_NULL.
 */
YoroResult yoro_vk_release_source(YoroContext *context, YoroVkSourceId id);

/**
 * Releases the views of images to write. Thread and results are those of yoro_vk_release_source.
 *
 * @param context The context.
 * @param id      The id from yoro_vk_register_target.
 * @pre No command that was recorded with the id is pending.
 */
YoroResult yoro_vk_release_target(YoroContext *context, YoroVkTargetId id);

/**
 * Records the synthesis of the other eye into a rectangle of warp's target size, all of which is overwritten:
 * barriers, and three draws with YORO_EDGES_HARD, four with other edges. Record it after the opaque objects of the
 * rendered eye, and before transparent objects and effects that are drawn for each eye. It allocates, compiles and
 * submits nothing, and does not wait.
 *
 * Changes the command buffer's graphics pipeline, descriptor set 0, push constants, viewport and scissor. Brings
 * images from their state `before` to their state `after`.
 *
 * Call it on the thread that may use the context and that records the command buffer.
 *
 * @param context  The context. @param commands A command buffer of the device. @param warp     The warp of YoroViews,
 * with rows as they lie in the images. @param frame    The images to read and the place to draw. @pre The command
 * buffer is in the recording state, outside of render passes and dynamic rendering, and is submitted to the queue
 * family of YoroVkInfo. The images are in the state `before` when it is executed. Conditional rendering is not active.
 * @return YORO_ERROR_NOT_REGISTERED, YORO_ERROR_TOO_LARGE for sizes beyond those of YoroVkInfo or rectangles beyond
 * their images, YORO_ERROR_VALUE, YORO_ERROR_API, YORO_ERROR_BUSY, YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE. After an
 * error nothing was recorded.
 */
YoroResult yoro_vk_record(YoroContext *context,
                          VkCommandBuffer commands,
                          const YoroWarp *warp,
                          const YoroVkFrame *frame);

/**
 * Records the synthesis of a view in any pose near that of the rendered one, in a context of YORO_WARP_KIND_POSE:
 * barriers and three draws. All else is as in yoro_vk_record.
 *
 * @param context  The context.
 * @param commands A command buffer of the device.
 * @param warp     The warp of yoro_pose_warp, with rows as they lie in the images.
 * @param frame    The images to read and the place to draw.
 * @pre Those of yoro_vk_record.
 * @return Those of yoro_vk_record.
 */
YoroResult yoro_vk_record_pose(YoroContext *context,
                               VkCommandBuffer commands,
                               const YoroPoseWarp *warp,
                               const YoroVkFrame *frame);

#ifdef __cplusplus
}
#endif

#endif  /* YORO_VULKAN_H */
