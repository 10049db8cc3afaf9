/*
 * yoro: render one eye, synthesize the other.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 *
 * WHAT IT DOES
 *
 * Your engine renders one eye, a little wider than it is shown, and lends its colour and depth. yoro draws the other eye into your
 * framebuffer or image, with its depth if you ask for it. While sizes stay the same, nothing is allocated, compiled or waited for in
 * a frame.
 *
 * STEP BY STEP, on OpenGL ES 3.0 and desktop OpenGL 4.5, or 4.3 with GL_ARB_ES3_1_compatibility. Fields left at 0 mean OpenGL's
 * conventions, which include a depth buffer that is cleared to 1 and tested with LESS, and the defaults.
 *
 *   Once, with the engine's context current:
 *
 *     YoroContext *yoro;
 *     YoroGlInfo info = {.struct_size = sizeof info, .outputs = YORO_OUTPUT_DEPTH, .state = YORO_GL_STATE_PRESERVE,
 *                        .check = 1, .loader = eglGetProcAddress, .messages = {on_error, NULL}};
 *     yoro_gl_create(&info, &yoro);
 *
 *   Each frame: poses and angles are laid out as XrPosef and XrFovf. Without OpenXR, put the positions 0.032 m to either side of
 *   the head; both orientations are the head's, {0, 0, 0, 1} is identity. angle_left and angle_down are negative.
 *
 *     YoroEyes eyes = {.struct_size = sizeof eyes, .rendered = YORO_EYE_RIGHT, .width = 1832, .height = 1920,
 *                      .near_z = 0.1f, .far_z = 1000, .guard_band = YORO_GUARD_BAND, .messages = {on_error, NULL}};
 *     // The planes are your projection's. If depth is reversed (cleared to 0, tested with GREATER): eyes.depth = YORO_DEPTH_REVERSED,
 *     // with glClipControl also eyes.clip = YORO_CLIP_Y_UP_Z_0_1. Without a far plane: eyes.far_z = INFINITY.
 *     for (int i = 0; i < 2; ++i) {
 *       memcpy(&eyes.poses[i], &located[i].pose, sizeof eyes.poses[i]);
 *       memcpy(&eyes.fovs[i], &located[i].fov, sizeof eyes.fovs[i]);
 *     }
 *     YoroViews views = {.struct_size = sizeof views};
 *     yoro_views_from_eyes(&eyes, &views);
 *     render(views.source.view, views.source.projection, views.source.width, views.source.height);
 *     YoroGlImages images = {.struct_size = sizeof images, .color_texture = color, .depth_texture = depth,
 *                            .framebuffer = framebuffer_of_the_left_eye};
 *     yoro_gl_synthesize(yoro, &views.warp, &images);
 *
 *   Draw transparent objects into the source with views.source, and into the other eye with views.synthesized, each against its own
 *   depth. The rendered eye's image is the part of the source that begins at (views.crop_x, views.crop_y), counted from the bottom,
 *   with the size of views.rendered: blit it, or give the compositor that rectangle. At the end: yoro_destroy.
 *
 * ON VULKAN 1.1, define YORO_USE_VULKAN, or include <vulkan/vulkan.h> before this file; without it there is the rest. The file can
 * be included again with it. Views are as above, with eyes.rows = YORO_ROWS_DOWN and eyes.clip = YORO_CLIP_VULKAN. The complete host
 * is examples/vulkan.c.
 *
 *   Once, with the device, the loader, the target's formats and the largest sizes in a YoroVkInfo:
 *
 *     yoro_vk_create(&info, &yoro);
 *
 *   Once for each pair of images, with its use before and after in a YoroVkSource and a YoroVkTarget:
 *
 *     YoroVkFrame frame = {.struct_size = sizeof frame};
 *     yoro_vk_register_source(yoro, &read, &frame.source);
 *     yoro_vk_register_target(yoro, &written, &frame.target);
 *
 *   Each frame, outside of render passes, after the source's:
 *
 *     yoro_vk_record(yoro, commands, &views.warp, &frame);
 *
 * A VIEW IN ANY POSE near the rendered one: warp_kind = YORO_WARP_KIND_POSE at creation, yoro_guarded_view for what to render,
 * yoro_pose_warp for the newest pose, and the calls that end in _pose.
 *
 * A FOVEATED VIEW: yoro_levels_from_eyes in place of yoro_views_from_eyes gives a wide view of few pixels and an inset of all where the
 * eyes look. Render and synthesize both, then make each eye of them: composes = 1 at creation, yoro_gl_compose or yoro_vk_compose.
 *
 * RULES. Structures begin with their size, so that a program keeps working with later versions: set struct_size, or call
 * YORO_INIT(eyes), which C89 and C++ before 20 need. Each function returns 0 or a negative YoroResult, and may also return
 * YORO_ERROR_INTERNAL. yoro_result_text names it, and the callback in messages gets a sentence with the mistake and the remedy.
 * In development set check: every call then validates textures and framebuffer. Cast loaders of other types: (YoroGlLoader)f.
 *
 * IT DOES NOT create a context, a device, a window or an image of yours; submit or wait; change GL state if you ask it to preserve it;
 * synthesize between eyes that look in different directions (YORO_EYES_PARALLEL and YORO_EYES_EVEN replace them), or with depth that is
 * not affine in the inverse distance (linear or logarithmic depth). What the rendered eye does not see is invented. Once, render the
 * other eye with your own camera, too, and compare: a wrong sign, a flipped row or misread depth costs more than 10 dB.
 *
 * Made of app/engines/c/src by cbindgen; `cargo xtask test the_header --bless` renews it.
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
 * Major version of this header.
 */
#define YORO_VERSION_MAJOR 0

/**
 * Minor version of this header.
 */
#define YORO_VERSION_MINOR 1

/**
 * Patch version of this header.
 */
#define YORO_VERSION_PATCH 0

/**
 * The version as one number that grows: major * 1000000 + minor * 1000 + patch.
 */
#define YORO_VERSION (((YORO_VERSION_MAJOR * 1000000) + (YORO_VERSION_MINOR * 1000)) + YORO_VERSION_PATCH)

/**
 * A guard band, in metres, that is complete for everything farther away than an arm's length.
 */
#define YORO_GUARD_BAND 1.0

/**
 * All pixels everywhere.
 */
#define YORO_FOVEATION_OFF 0

/**
 * An inset of 30 degrees around the gaze, half of the pixels along each axis beyond.
 */
#define YORO_FOVEATION_LOW 1

/**
 * An inset of 20 degrees, half of the pixels along each axis beyond.
 */
#define YORO_FOVEATION_MEDIUM 2

/**
 * An inset of 20 degrees, a third of the pixels along each axis beyond.
 */
#define YORO_FOVEATION_HIGH 3

/**
 * Finds out whether two renders or one render with synthesis is cheaper on this device. It alternates between them for
 * about a second, chooses, and measures again when the result may have changed.
 *
 * Use it from one thread at a time. It needs no YoroContext.
 */
typedef struct YoroChooser YoroChooser;

/**
 * The synthesis in one GL context or on one Vulkan device: compiled shaders and small buffers.
 *
 * Use it from one thread at a time. A second thread receives YORO_ERROR_BUSY. For OpenGL that must be the thread on
 * which the GL context is current; for Vulkan it can be any thread.
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
 * A matrix is not a rigid view or not a perspective projection, or the two eyes' matrices do not match.
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
 * synthesized (4095, in images that are wider).
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
 * The GL context or the driver is too old, or lacks a feature that was asked for.
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
 * The YoroContext was created for a different API than the function's.
 */
#define YORO_ERROR_API (-15)
/**
 * Another thread is inside a function with this YoroContext.
 */
#define YORO_ERROR_BUSY (-16)
/**
 * No memory is left on the host or on the device.
 */
#define YORO_ERROR_MEMORY (-17)
/**
 * The Vulkan device is lost: create both it and the YoroContext again.
 */
#define YORO_ERROR_DEVICE_LOST (-18)
/**
 * The id is not registered with this YoroContext, or was released.
 */
#define YORO_ERROR_NOT_REGISTERED (-19)
/**
 * An internal error of the library. Afterwards the YoroContext returns only this error, and can only be destroyed.
 */
#define YORO_ERROR_INTERNAL (-20)

/**
 * One of the two eyes. The value is also its index in arrays of two.
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
 * The pose of an eye in a right-handed world with Y up. The eye looks along its own -Z axis, with X to the right. The
 * layout is that of XrPosef.
 */
typedef struct {
  /**
   * Rotation from the eye's axes to the world's, as the quaternion x, y, z, w, of length 1.
   */
  float orientation[4];
  /**
   * Position in metres.
   */
  float position[3];
} YoroPose;

/**
 * Angles in radians from the eye's axis to the edges of its image, each smaller than a right angle. The left and lower
 * angles are negative if the image contains the axis. The layout is that of XrFovf.
 */
typedef struct {
  /**
   * Angle to the left edge.
   */
  float angle_left;
  /**
   * Angle to the right edge.
   */
  float angle_right;
  /**
   * Angle to the upper edge.
   */
  float angle_up;
  /**
   * Angle to the lower edge.
   */
  float angle_down;
} YoroFov;

/**
 * The meaning of the values 0 to 1 in a depth buffer. It is independent of the API's clip volume.
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
 * Bits that change eyes which cannot be synthesized as they are.
 */
typedef uint32_t YoroEyesFlags;
/**
 * Gives both eyes frusta of the same width and height over the same rows, large enough to contain their own. Display
 * the images with the resulting angles.
 */
#define YORO_EYES_EVEN 1
/**
 * Turns both eyes, without moving them, to one direction at right angles to the line between them, and gives them
 * frusta of the same size that contain their own. For canted eyes, and for eyes that do not lie on one horizontal
 * line, such as those of a calibrated headset. Display the images with the resulting poses and angles: an OpenXR
 * runtime that receives these with the images rotates them back.
 */
#define YORO_EYES_PARALLEL 2

/**
 * Receives an error message: one sentence that names the fault and the remedy, in UTF-8, valid during the call only.
 * It is called on the thread of the failing function, before that returns. It must not throw, and must not call yoro
 * with the same context.
 */
typedef void (*YoroMessageCallback)(void *user, YoroResult result, const char *sentence);

/**
 * The receiver of error messages.
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
 * The two eyes of a frame, given as poses and angles.
 *
 * Any unit of length may be used instead of metres, as long as it is the same for all lengths. The eyes may be any
 * distance apart, so a wearer can be a giant or a mouse. Positions are rounded to 32 bits: at 1 km from the origin to
 * 0.06 mm, a thousandth of the distance between the eyes. In larger worlds give poses relative to the head, and
 * translate the resulting view matrices by the head's position.
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
   * Distance of the far plane in metres, more than near_z even for reversed depth; may be INFINITY.
   */
  float far_z;
  /**
   * The meaning of the depth buffer's values.
   */
  YoroDepth depth;
  /**
   * The order of rows in the images.
   */
  YoroRows rows;
  /**
   * The clip volume of the resulting matrices.
   */
  YoroClip clip;
  /**
   * Guard band: the distance in metres beyond which the rendered image contains the whole outer border of the other
   * eye. Smaller values cost more pixels. 0: no guard band, and the border is filled in.
   */
  float guard_band;
  /**
   * YORO_EYES_ bits.
   */
  YoroEyesFlags flags;
  /**
   * Must be 0.
   */
  uint32_t reserved;
  /**
   * Receives error messages.
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
   * Pose of the eye. For matrices of a left-handed world, the Z axis of the world is negated.
   */
  YoroPose pose;
  /**
   * Angles to the outer edges of the image.
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
   * Displacement in rows: target row minus source row.
   */
  int32_t row_offset;
  /**
   * The eye that is synthesized.
   */
  YoroEye target_eye;
  /**
   * The meaning of the depth buffer's values.
   */
  YoroDepth depth;
  /**
   * Must be 0.
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
   * The view to render: the rendered eye's view, widened by the guard band. Render colour and depth of this size.
   */
  YoroView source;
  /**
   * The rendered eye's own image: the part of the source, of this size, that begins at crop_x and crop_y.
   */
  YoroView rendered;
  /**
   * The synthesized image.
   */
  YoroView synthesized;
  /**
   * The mapping of pixels, which synthesis takes.
   */
  YoroWarp warp;
} YoroViews;

/**
 * The two eyes of a frame, given as matrices. They may be any distance apart. All matrices are column-major, for
 * column vectors, as in GL and Vulkan. The translation of a view matrix is in elements 12 to 14. Element 11 of a
 * projection is -1 for eyes that look along -Z, and 1 for eyes that look along +Z.
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
   * Eye to clip space, left eye first: perspective projections. Reversed and infinite depth are recognized.
   */
  float projection[2][16];
  /**
   * The clip volume of the projections.
   */
  YoroClip clip;
  /**
   * The order of rows in the images.
   */
  YoroRows rows;
  /**
   * Guard band in metres, as in YoroEyes.
   */
  float guard_band;
  /**
   * Number of world units in a metre: 100 for centimetres. 0 means 1.
   */
  float units_per_metre;
  /**
   * Receives error messages.
   */
  YoroMessages messages;
  /**
   * YORO_EYES_ bits. The resulting view matrices are rotated with the eyes.
   */
  YoroEyesFlags flags;
  /**
   * Must be 0.
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
   * 1 if the CPU renders (llvmpipe, SwiftShader).
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
   * Name of the GPU or its driver in UTF-8, terminated by 0, and truncated if it is too long.
   */
  uint8_t device[128];
} YoroCapabilities;

/**
 * The GPU times of one frame, in nanoseconds. All are 0 until the first are known.
 */
typedef struct {
  /**
   * sizeof(YoroTimes), set by the caller.
   */
  uint32_t struct_size;
  /**
   * 1 if the times are known.
   */
  uint32_t is_known;
  /**
   * Time to find the bounds of the displacements, or of the depths, in each tile.
   */
  uint64_t tiles_ns;
  /**
   * Time to find the part of the source to search for each tile of the target.
   */
  uint64_t spans_ns;
  /**
   * Time of the search, which writes the target.
   */
  uint64_t march_ns;
} YoroTimes;

/**
 * A way to produce both eyes of a frame. The value is also its index in arrays of two.
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
 * Another way, such as both eyes rendered because synthesis was not possible. The frame counts for neither way.
 */
#define YORO_WAY_OTHER 2

/**
 * A frame that was submitted to the display.
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
   * The current time of a monotonic clock, in nanoseconds.
   */
  int64_t now_ns;
  /**
   * Refreshes of the display per second. 0 if unknown, or if the display did not set the pace of this frame, for
   * example because you waited for the GPU in order to measure it.
   */
  float refresh_hz;
  /**
   * Milliseconds that a frame took; 0 if none are known yet. This is the GPU time if there is a timer. Otherwise, if
   * you wait for the GPU, it is the time from the beginning of the frame's work until the GPU has finished it.
   */
  float cost_ms;
  /**
   * The frame that took cost_ms, as the number of frames that ended after it: 0 for this one, at most 63.
   */
  uint32_t cost_frames_ago;
  /**
   * 1 if `heat` is known.
   */
  uint32_t has_heat;
  /**
   * The device's heat on a scale on which 0.1 matters, such as Android's thermal headroom.
   */
  float heat;
  /**
   * Must be 0.
   */
  uint32_t reserved;
  /**
   * Receives error messages.
   */
  YoroMessages messages;
} YoroFrameEnd;

/**
 * The reason for a choice.
 */
typedef uint32_t YoroReason;
/**
 * Nothing has been measured in this scene yet. The initial way, or the one chosen before, is kept.
 */
#define YORO_REASON_UNMEASURED 0
/**
 * The chosen way costs less.
 */
#define YORO_REASON_CHEAPER 1
/**
 * The chosen way costs more, but too little more to justify a change. It is kept.
 */
#define YORO_REASON_SIMILAR 2
/**
 * The chosen way reaches the display's refresh rate, and the other does not.
 */
#define YORO_REASON_HOLDS_RATE 3
/**
 * Both ways reach the display's refresh rate, which hides their costs, and nothing else is known. The way is kept.
 */
#define YORO_REASON_BOTH_HOLD_RATE 4
/**
 * One of the ways could not be measured. The way is kept.
 */
#define YORO_REASON_INCOMPARABLE 5

/**
 * The way to render the next frame, and the reason.
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
   * 1 while both ways are being measured. Do not change resolution or quality during this time.
   */
  uint32_t is_measuring;
  /**
   * The way that was chosen last.
   */
  YoroWay chosen;
  /**
   * The reason for that choice.
   */
  YoroReason reason;
  /**
   * The compared times in milliseconds, indexed by way; 0 if there was nothing to compare.
   */
  float cost_ms[2];
} YoroChoice;

/**
 * The strength of foveation, as OpenXR's runtimes name it.
 */
typedef uint32_t YoroFoveationLevel;

/**
 * How much of the eyes' images is rendered with all pixels.
 */
typedef struct {
  /**
   * sizeof(YoroFoveation).
   */
  uint32_t struct_size;
  /**
   * The strength.
   */
  YoroFoveationLevel level;
  /**
   * Angle in radians around the gaze that has all pixels. 0: that of the level.
   */
  float radius;
  /**
   * Pixels of the wide view for each pixel of an eye's image, along each axis, at most 1. 0: that of the level.
   */
  float density;
  /**
   * The distance in metres from which on the other eye's inset is complete. 0: 0.5.
   */
  float nearest;
  /**
   * Angle in radians beyond the radius over which the inset fades into the wide view. 0: a hard seam.
   */
  float fade;
  /**
   * 0: the inset lies around each eye's own axis. 1: around `gaze`, for both.
   */
  uint32_t tracked;
  /**
   * A direction in the world, of any length.
   */
  float gaze[3];
} YoroFoveation;

/**
 * How an eye's image is made of its levels. yoro_levels_from_eyes fills it. It can be copied and kept.
 *
 * Places in images are from 0 to 1, from the left and from row 0. The place p in the eye's image is the place scale * p
 * + offset in that of a level.
 */
typedef struct {
  /**
   * Width of the eye's image in pixels.
   */
  uint32_t width;
  /**
   * Height of the eye's image in pixels.
   */
  uint32_t height;
  /**
   * Width of the wide level's image in pixels.
   */
  uint32_t wide_width;
  /**
   * Height of the wide level's image in pixels.
   */
  uint32_t wide_height;
  /**
   * Width of the inset's image in pixels; 0 if there is only one level.
   */
  uint32_t inset_width;
  /**
   * Height of the inset's image in pixels; 0 if there is only one level.
   */
  uint32_t inset_height;
  /**
   * Columns and rows over which the inset fades in; 0 for a hard seam.
   */
  float inset_fade[2];
  /**
   * Places in the wide level.
   */
  double wide_scale[2];
  /**
   * Places in the wide level.
   */
  double wide_offset[2];
  /**
   * Places in the inset.
   */
  double inset_scale[2];
  /**
   * Places in the inset.
   */
  double inset_offset[2];
  /**
   * Of the synthesized eye: with the depth d, what the inset shows at the place x comes from the place
   * a * x + b + c * d of the rendered image, whose borders are -1 and 1; these are a, b and c.
   * Zeros for the rendered eye.
   */
  double inset_source[3];
} YoroComposition;

/**
 * The image in whose normalized device coordinates motion vectors are given. A vector is the place of a surface minus its
 * place in the previous frame, each with the view of its own frame, so that the head's motion is in it. It has three
 * components: two do not tell how a surface that comes nearer moves in the other eye.
 */
typedef uint32_t YoroVectors;
/**
 * The rendered view with its guard band: what an engine writes with the projection of YoroViews::source.
 */
#define YORO_VECTORS_SOURCE 0
/**
 * The rendered eye without the guard band: its own vectors are a part of the image.
 */
#define YORO_VECTORS_EYE 1

/**
 * Two frames, of which the vectors of the newer one point to the previous.
 */
typedef struct {
  /**
   * sizeof(YoroMotion).
   */
  uint32_t struct_size;
  /**
   * The image that the vectors refer to.
   */
  YoroVectors vectors;
  /**
   * The eyes of this frame. Their size is that of an eye's vectors, as a runtime recommends it, not that of the image.
   * The clip volume is that of the vectors.
   */
  const YoroEyes *eyes;
  /**
   * The eyes of the previous frame, of the same size. Distance, angles and planes may have changed.
   */
  const YoroEyes *previous;
  /**
   * Receives error messages.
   */
  YoroMessages messages;
} YoroMotion;

/**
 * What yoro_gl_synthesize_motion and yoro_vk_record_motion need to know of two frames. yoro_motion_warp fills it. It can be
 * copied and kept.
 *
 * A surface with the vector v and the stored depth d in the source has the vector
 * `(a * v.x + per_z * v.z + per_depth * d + constant, b * v.y, v.z)` in the eye; a and b are 1, or for YORO_VECTORS_SOURCE
 * the source's size over the eye's.
 */
typedef struct {
  /**
   * The mapping of pixels, at the vectors' size.
   */
  YoroWarp warp;
  /**
   * X per unit of the vector's z.
   */
  double per_z;
  /**
   * X per unit of stored depth.
   */
  double per_depth;
  /**
   * X that is added.
   */
  double constant;
  /**
   * The image that the vectors refer to.
   */
  YoroVectors vectors;
  /**
   * Must be 0.
   */
  uint32_t reserved;
} YoroMotionWarp;

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
   * Distance of the near plane of both views in metres, more than 0.
   */
  float near_z;
  /**
   * Distance of the far plane of both views in metres; may be INFINITY.
   */
  float far_z;
  /**
   * Order of rows in the images.
   */
  YoroRows rows;
  /**
   * Must be 0.
   */
  uint32_t reserved;
  /**
   * The rendered view. Of this view and the target, the size, pose and angles are read, which may differ. The
   * matrices are ignored.
   */
  const YoroView *source;
  /**
   * The view to synthesize.
   */
  const YoroView *target;
  /**
   * Receives error messages.
   */
  YoroMessages messages;
} YoroPoses;

/**
 * The mapping of pixels from a rendered view to one in any pose near it, for yoro_gl_synthesize_pose and
 * yoro_vk_record_pose. yoro_pose_warp fills it. It can be copied and kept.
 *
 * A surface that the target shows at the pixel (x, y), at the distance 1 / k along its viewing axis, lies in the
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
   * Position of the target's eye in the source image. Set it to zeros to apply the rotation only, without depth.
   */
  double epipole[3];
  /**
   * The source's depth buffer holds values for which 1 / distance is `source_law[0] + source_law[1] * depth`.
   */
  double source_law[2];
  /**
   * The same for the target.
   */
  double target_law[2];
  /**
   * Depth value, in the source, of the nearest surface that the target may show.
   */
  double nearest;
  /**
   * Depth value of the source's far plane.
   */
  double far_depth;
} YoroPoseWarp;

/**
 * The limits of a head's motion between the render and its display, and the view that is rendered.
 */
typedef struct {
  /**
   * sizeof(YoroHeadMotion).
   */
  uint32_t struct_size;
  /**
   * Largest angle of rotation about any axis, in radians.
   */
  float rotation;
  /**
   * Largest distance that an eye moves, in metres.
   */
  float translation;
  /**
   * Distance from the eye, in metres, beyond which surfaces must stay in the image.
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
   * Must be 0.
   */
  uint32_t reserved;
  /**
   * The view to widen. Its size, pose and angles are read.
   */
  const YoroView *view;
  /**
   * Receives error messages.
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
   * First row of the original view's image in the wider one, counted as YoroRows says.
   */
  uint32_t crop_y;
  /**
   * Zero.
   */
  uint32_t reserved;
  /**
   * The wider view, which is the one to render.
   */
  YoroView view;
} YoroGuardedView;

/**
 * Bits for outputs besides colour, and for their encoding.
 */
typedef uint32_t YoroOutputFlags;
/**
 * Writes the depth of the synthesized eye to the target's depth attachment, in the source's encoding, so that
 * transparent objects can be drawn afterwards.
 */
#define YORO_OUTPUT_DEPTH 1
/**
 * Source and target are both sRGB images: sampling decodes them, and writing encodes them.
 */
#define YORO_OUTPUT_SRGB 2
/**
 * Leaves open what the rendered eye does not show, and silhouettes, for the caller's scene, drawn once more. The call
 * clears depth to the farthest and stencil to 0 in the target's rectangle, and sets stencil to 1 in each pixel that it
 * writes: draw the opaque scene for the other eye where stencil equals 0. Only for YORO_WARP_KIND_EYES.
 */
#define YORO_OUTPUT_OPEN_STENCIL 4
/**
 * The same for materials without stencil: depth is the nearest in each pixel that is written, so that the scene passes
 * the depth test in open ones alone. Not together with YORO_OUTPUT_DEPTH.
 */
#define YORO_OUTPUT_OPEN_DEPTH 8

/**
 * What happens to GL state that a call changes.
 */
typedef uint32_t YoroGlState;
/**
 * Some of it stays changed: program, vertex array, framebuffers, the first viewport, the textures of units 0 to 3 (two
 * of them array textures for sources that are layers), their samplers, and the active unit. Depth mask and depth
 * function are on and ALWAYS, the depth range is 0 to 1, the colour mask is open. Scissor, stencil and depth test, face
 * culling, blending, dithering, polygon offset, rasterizer discard, primitive restart, coverage, clip distances and
 * logic operation are off. For engines that set all the state they draw with.
 */
#define YORO_GL_STATE_LEAVE 0
/**
 * All of it is restored, except that a program that was deleted while it was current goes at the first call, as GL
 * requires. None is current then.
 */
#define YORO_GL_STATE_PRESERVE 1

/**
 * Bits that describe where sources lie in their textures.
 */
typedef uint32_t YoroGlSourceFlags;
/**
 * The rendered image is a part of larger textures, and its size may change in each frame: for dynamic resolution.
 * Buffers then only grow, so that nothing is allocated after yoro_gl_prepare with the largest sizes. These textures
 * cannot be the framebuffer's, not even other parts of them: if both eyes are shown from one texture, render into
 * others, synthesize into that one at x and y of YoroGlImages, and blit the rendered eye's part beside it.
 */
#define YORO_GL_SOURCE_PARTS 1
/**
 * The rendered image is a layer of a GL_TEXTURE_2D_ARRAY, in colour and in depth: for the textures of GL_OVR_multiview
 * and the OpenXR swapchains used with it.
 */
#define YORO_GL_SOURCE_LAYERS 2

/**
 * The kind of warp that a context is created for.
 */
typedef uint32_t YoroWarpKind;
/**
 * Between two parallel eyes, with a YoroWarp.
 */
#define YORO_WARP_KIND_EYES 0
/**
 * To a view in any pose near the rendered one, with a YoroPoseWarp. If both views are parallel eyes, YORO_WARP_KIND_EYES gives the same image and is faster.
 */
#define YORO_WARP_KIND_POSE 1
/**
 * Motion vectors between two parallel eyes, with a YoroMotionWarp. The colour is RGBA16F, and each texel a vector.
 */
#define YORO_WARP_KIND_MOTION 2

/**
 * An entry point of any type.
 */
typedef void (*YoroGlProc)(void);

/**
 * Returns an entry point by its name, or NULL if it does not exist: eglGetProcAddress, glfwGetProcAddress and others.
 * Cast loaders of other types: (YoroGlLoader)SDL_GL_GetProcAddress.
 */
typedef YoroGlProc (*YoroGlLoader)(const char *name);

/**
 * The options of a context for OpenGL.
 */
typedef struct {
  /**
   * sizeof(YoroGlInfo).
   */
  uint32_t struct_size;
  /**
   * YORO_OUTPUT_ bits.
   */
  YoroOutputFlags outputs;
  /**
   * What happens to GL state.
   */
  YoroGlState state;
  /**
   * 1: each call checks the textures, the framebuffer and GL's error flag, which it clears. This waits for the
   * driver, so use it in development only. 0: mistakes are undefined behaviour, as in GL.
   */
  uint32_t check;
  /**
   * YORO_GL_SOURCE_ bits.
   */
  YoroGlSourceFlags sources;
  /**
   * 1: measures the passes for yoro_times with GL_TIME_ELAPSED queries. The engine must have no such query active
   * during a call. 0: measures nothing.
   */
  uint32_t timed;
  /**
   * The kind of warp. 0 is YORO_WARP_KIND_EYES.
   */
  YoroWarpKind warp_kind;
  /**
   * 1: compiles the composer, too, for yoro_gl_compose. 0: it is not used.
   */
  uint32_t composes;
  /**
   * The loader of entry points.
   */
  YoroGlLoader loader;
  /**
   * Receives error messages, including those of later calls.
   */
  YoroMessages messages;
} YoroGlInfo;

/**
 * The textures and the framebuffer of one synthesis.
 */
typedef struct {
  /**
   * sizeof(YoroGlImages).
   */
  uint32_t struct_size;
  /**
   * Colour of the rendered eye: name of a GL_TEXTURE_2D of the source's size in any filterable format (another
   * target or size with YORO_GL_SOURCE_ bits). All four channels are carried over, in any encoding. Texture filters
   * and samplers have no effect. Of a multisampled image, give the resolved one.
   */
  uint32_t color_texture;
  /**
   * Depth of the rendered eye: name of a GL_TEXTURE_2D of the same size with a depth, depth-stencil (sampled as
   * depth) or red float format. Of a multisampled image, give the depth of each pixel's nearest sample. Averaged
   * depth belongs to no surface, and causes halos.
   */
  uint32_t depth_texture;
  /**
   * The framebuffer to draw into, or 0 for the window's. Its first colour attachment is written, and with
   * YORO_OUTPUT_DEPTH or an OPEN flag its depth attachment, with stencil for YORO_OUTPUT_OPEN_STENCIL. None of the textures above may be attached to it.
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
   * First column of the rendered part in its textures. This field and the next three are for YORO_GL_SOURCE_PARTS,
   * and otherwise 0.
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
   * The layer of both textures for YORO_GL_SOURCE_LAYERS, otherwise 0. To draw into a layer, attach it to the
   * framebuffer with glFramebufferTextureLayer.
   */
  uint32_t layer;
} YoroGlImages;

/**
 * The images of an eye's levels, and where its image is drawn. Rows are counted from the bottom.
 */
typedef struct {
  /**
   * sizeof(YoroGlLevels).
   */
  uint32_t struct_size;
  /**
   * Colour of the wide level: name of a GL_TEXTURE_2D in any filterable format. Of the rendered eye it is the
   * rendered image, in which the level begins at crop_x and crop_y; of the other, the synthesized one.
   */
  uint32_t wide_texture;
  /**
   * First column of the wide level in its texture.
   */
  uint32_t wide_x;
  /**
   * First row of the wide level in its texture.
   */
  uint32_t wide_y;
  /**
   * Width of the texture in pixels; 0 if the level fills it.
   */
  uint32_t wide_image_width;
  /**
   * Height of the texture in pixels; 0 if the level fills it.
   */
  uint32_t wide_image_height;
  /**
   * Colour of the inset, in the same way; ignored for a composition of one level.
   */
  uint32_t inset_texture;
  /**
   * Depth of the synthesized eye's inset, in a texture of the same size, or 0. With it, holes at the border of what was
   * rendered show the wide view.
   */
  uint32_t inset_depth_texture;
  /**
   * First column of the inset in its texture.
   */
  uint32_t inset_x;
  /**
   * First row of the inset in its texture.
   */
  uint32_t inset_y;
  /**
   * Width of the texture in pixels; 0 if the inset fills it.
   */
  uint32_t inset_image_width;
  /**
   * Height of the texture in pixels; 0 if the inset fills it.
   */
  uint32_t inset_image_height;
  /**
   * The framebuffer to draw into, or 0 for the window's. Its first colour attachment is written. None of the textures
   * above may be attached to it.
   */
  uint32_t framebuffer;
  /**
   * First column of the eye's image in the framebuffer.
   */
  uint32_t x;
  /**
   * First row of the eye's image in the framebuffer.
   */
  uint32_t y;
} YoroGlLevels;

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
 * @param views Receives the views. The caller sets struct_size.
 * @pre Both pointers point to structures of the sizes that they state.
 * @return YORO_ERROR_VALUE, YORO_ERROR_TOO_LARGE or a YORO_ERROR_EYES_ code for eyes that are impossible or cannot be
 *         synthesized; YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE.
 */
YoroResult yoro_views_from_eyes(const YoroEyes *eyes,
                                YoroViews *views);

/**
 * Computes the view to render, and the mapping of its pixels to the other eye. The resulting matrices use the same
 * world, clip volume and units as the given ones. Poses are in metres.
 *
 * The translation of a view matrix is rounded to 32 bits: at 1 km from the origin to 0.06 mm, a thousandth of the
 * distance between the eyes. Displacements caused by this rounding are removed, but the distance between the eyes
 * keeps its error. In larger worlds give matrices relative to the head: subtract its position from both eyes'
 * positions, in 64 bits, before computing the matrices.
 *
 * Call it from any thread, without a context. It allocates and keeps nothing.
 *
 * @param matrices The eyes.
 * @param views    Receives the views. The caller sets struct_size.
 * @pre Both pointers point to structures of the sizes that they state.
 * @return YORO_ERROR_MATRIX for matrices that are not rigid views or perspective projections; otherwise as for
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
 * @param capabilities Receives the limits. The caller sets struct_size.
 * @pre context is alive.
 * @return YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE, YORO_ERROR_BUSY.
 */
YoroResult yoro_capabilities(YoroContext *context,
                             YoroCapabilities *capabilities);

/**
 * Returns the times of the passes in an earlier frame. Call it once a frame, before the synthesis; it does not wait
 * for the GPU.
 *
 * OpenGL: the times are those of a frame a few frames ago, if `timed` of YoroGlInfo is 1 and the driver has reliable
 * timer queries. Those of CPU rasterizers are not. Vulkan: the times are those of the frame recorded `timed_frames`
 * (of YoroVkInfo) calls of yoro_vk_record ago, on queue families with timestamps.
 *
 * Thread and preconditions are as for yoro_capabilities.
 *
 * @param context The context.
 * @param times   Receives the times. The caller sets struct_size.
 * @pre For Vulkan the commands of that frame have been executed.
 * @return YORO_ERROR_DEVICE_LOST, YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE, YORO_ERROR_BUSY.
 */
YoroResult yoro_times(YoroContext *context,
                      YoroTimes *times);

/**
 * Destroys a context and its objects on the GPU. Does nothing if the context is NULL.
 *
 * Call it on the thread that may use the context. For OpenGL the GL context must be current. For Vulkan the device
 * must have executed all recorded commands. Destroy the YoroContext before the GL context or device. Deleted GL
 * objects are unbound; other GL state is unchanged.
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
 * @param first   The initial way, which is kept if nothing can be measured: YORO_WAY_TWO_VIEWS or YORO_WAY_SYNTHESIS.
 * @param chooser Receives the chooser, or NULL after an error. Destroy it with yoro_chooser_destroy.
 * @pre chooser can be written to.
 * @return YORO_ERROR_VALUE, YORO_ERROR_NULL.
 */
YoroResult yoro_chooser_create(YoroWay first,
                               YoroChooser **chooser);

/**
 * Takes a frame that was submitted to the display, and returns how to render the next one. It allocates nothing.
 * Render the first frame in the way that yoro_chooser_create was given.
 *
 * @param chooser The chooser.
 * @param frame   The frame.
 * @param choice  Receives the choice. The caller sets struct_size.
 * @pre chooser is alive, and no other thread uses it. The other pointers point to structures of the sizes that they
 *      state.
 * @return YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE; YORO_ERROR_VALUE for an unknown way, negative numbers and numbers
 *         that are not finite: such a frame is not counted.
 */
YoroResult yoro_chooser_end_frame(YoroChooser *chooser,
                                  const YoroFrameEnd *frame,
                                  YoroChoice *choice);

/**
 * Requests a new measurement of both ways, after a change of the scene, the place in it, or the resolution.
 *
 * @param chooser The chooser.
 * @pre chooser is alive, and no other thread uses it.
 * @return YORO_ERROR_NULL.
 */
YoroResult yoro_chooser_scene_changed(YoroChooser *chooser);

/**
 * Destroys a chooser. Does nothing if it is NULL.
 *
 * @param chooser The chooser, or NULL.
 * @pre chooser is alive, and no other thread uses it.
 */
void yoro_chooser_destroy(YoroChooser *chooser);

/**
 * Computes the levels of a foveated view: a wide one of few pixels, and an inset of all of them where the eyes look.
 * Render and synthesize each as the views of yoro_views_from_eyes, then compose each eye: yoro_gl_compose,
 * yoro_vk_compose, or your own pass with the shader kit. The guard band of the eyes is that of the wide level.
 *
 * Call it from any thread, without a context. It allocates and keeps nothing. Sizes do not depend on a tracked gaze.
 *
 * @param eyes         The eyes.
 * @param foveation    What is rendered with all pixels.
 * @param wide         Receives the views of the wide level. The caller sets struct_size.
 * @param inset        Receives the views of the inset, all zeros if there is only one level: without foveation, or if
 *                     an inset would save no pixels. The caller sets struct_size.
 * @param compositions Receives how to compose the left and the right eye.
 * @pre All pointers point to structures, of the sizes that they state, and `compositions` to two.
 * @return YORO_ERROR_VALUE for an impossible foveation; those of yoro_views_from_eyes.
 */
YoroResult yoro_levels_from_eyes(const YoroEyes *eyes,
                                 const YoroFoveation *foveation,
                                 YoroViews *wide,
                                 YoroViews *inset,
                                 YoroComposition *compositions);

/**
 * Computes how motion vectors of the rendered eye become those of the other eye, and its own without the guard band.
 *
 * Call it from any thread, without a context. It allocates and keeps nothing.
 *
 * @param motion The two frames.
 * @param other  Receives the mapping to the other eye.
 * @param own    Receives the mapping to the rendered eye; NULL if it is not needed, because vectors can be scaled, or
 *               cropped.
 * @pre The pointers point to structures of the sizes that they state.
 * @return YORO_ERROR_VALUE if the frames have no law in common: then tell the runtime not to extrapolate this one. As for
 *         yoro_views_from_eyes for each pair of eyes.
 */
YoroResult yoro_motion_warp(const YoroMotion *motion,
                            YoroMotionWarp *other,
                            YoroMotionWarp *own);

/**
 * Computes the mapping of pixels from a rendered view to one in any pose near it.
 *
 * Call it from any thread, without a context. It allocates and keeps nothing.
 *
 * @param poses The views.
 * @param warp  Receives the mapping.
 * @pre The pointers point to structures, `poses` to one of the size that it states.
 * @return YORO_ERROR_VALUE for impossible views, and if the target sees more than 80 degrees away from the source's
 *         axis; YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE.
 */
YoroResult yoro_pose_warp(const YoroPoses *poses,
                          YoroPoseWarp *warp);

/**
 * Widens a view on all four sides, by whole pixels, so that it contains what the view shows after any such motion.
 *
 * Call it from any thread, without a context. It allocates and keeps nothing.
 *
 * @param motion  The limits and the view.
 * @param guarded Receives the wider view. The caller sets struct_size.
 * @pre The pointers point to structures of the sizes that they state.
 * @return YORO_ERROR_VALUE for an impossible view, or one that would have to see more than 80 degrees to a side;
 *         YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE.
 */
YoroResult yoro_guarded_view(const YoroHeadMotion *motion,
                             YoroGuardedView *guarded);

/**
 * Creates a context for OpenGL ES 3.0 or later, or desktop OpenGL 4.5 or later (4.3 with GL_ARB_ES3_1_compatibility),
 * and compiles its shaders. Call it at startup, not in a frame.
 *
 * Call it on the thread on which the GL context is current. YoroGlInfo says how GL state is treated; the error flag is
 * left as it is.
 *
 * @param info    The options.
 * @param context Receives the new context, or NULL after an error. Destroy it with yoro_destroy.
 * @pre The GL context is current, and lives as long as the YoroContext.
 * @return YORO_ERROR_NO_CONTEXT, YORO_ERROR_UNSUPPORTED, YORO_ERROR_MEMORY, YORO_ERROR_DRIVER, YORO_ERROR_VALUE,
 *         YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE.
 */
YoroResult yoro_gl_create(const YoroGlInfo *info,
                          YoroContext **context);

/**
 * Returns how many bytes of GPU memory the buffers of a context will take, computed from the sizes of a frame. Drivers add
 * padding. For an existing context, call yoro_capabilities. Fails for YORO_WARP_KIND_POSE, whose buffers take 16 bytes for
 * each 16 x 8 pixels of the source and of the target. For YORO_WARP_KIND_MOTION, give the `warp` of YoroMotionWarp: both
 * kinds have the same buffers.
 *
 * Call it from any thread. It needs neither a loader nor a GL context.
 *
 * @param info  The options.
 * @param warp  The warp of a frame of the largest size.
 * @param bytes Receives the number of bytes.
 * @return YORO_ERROR_VALUE, YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE.
 */
YoroResult yoro_gl_buffer_bytes(const YoroGlInfo *info,
                                const YoroWarp *warp,
                                uint64_t *bytes);

/**
 * Allocates the buffers for images of these sizes, so that the first yoro_gl_synthesize need not. Does nothing if the
 * sizes have not changed.
 *
 * Thread, GL state and results are as for yoro_gl_synthesize.
 *
 * @param context The context.
 * @param warp    The warp of a frame of these sizes.
 * @pre The GL context is current.
 */
YoroResult yoro_gl_prepare(YoroContext *context,
                           const YoroWarp *warp);

/**
 * Does what yoro_gl_prepare does, in a context of YORO_WARP_KIND_POSE.
 *
 * @param context The context.
 * @param warp    The warp of a frame of these sizes.
 * @pre The GL context is current.
 */
YoroResult yoro_gl_prepare_pose(YoroContext *context, const YoroPoseWarp *warp);

/**
 * Does what yoro_gl_prepare does, in a context of YORO_WARP_KIND_MOTION.
 *
 * @param context The context.
 * @param warp    The warp of a frame of these sizes.
 * @pre The GL context is current.
 */
YoroResult yoro_gl_prepare_motion(YoroContext *context, const YoroMotionWarp *warp);

/**
 * Synthesizes the other eye into a rectangle of the warp's target size, and overwrites all of it except for open holes.
 * Call it after the rendered eye's opaque objects, and before transparent objects and effects that are drawn for each
 * eye.
 *
 * Call it on the thread on which the GL context is current. YoroGlInfo says how GL state is treated. While sizes stay
 * the same it allocates and compiles nothing, and does not wait for the GPU.
 *
 * @param context The context.
 * @param warp    The warp of YoroViews.
 * @param images  The images to read and where to draw.
 * @pre The GL context is current. The textures and the framebuffer belong to it and are as YoroGlImages says.
 *      Transform feedback and conditional rendering are not active.
 * @return YORO_ERROR_VALUE, YORO_ERROR_TOO_LARGE, YORO_ERROR_MEMORY, YORO_ERROR_DRIVER; with `check` also
 *         YORO_ERROR_FORMAT and YORO_ERROR_NO_CONTEXT; YORO_ERROR_API, YORO_ERROR_BUSY, YORO_ERROR_NULL,
 *         YORO_ERROR_STRUCT_SIZE.
 */
YoroResult yoro_gl_synthesize(YoroContext *context,
                              const YoroWarp *warp,
                              const YoroGlImages *images);

/**
 * Synthesizes a view in any pose near the rendered one, in a context of YORO_WARP_KIND_POSE. Otherwise it is like
 * yoro_gl_synthesize.
 *
 * @param context The context.
 * @param warp    The warp of yoro_pose_warp.
 * @param images  The images to read and where to draw.
 * @pre As for yoro_gl_synthesize.
 * @return As for yoro_gl_synthesize.
 */
YoroResult yoro_gl_synthesize_pose(YoroContext *context,
                                   const YoroPoseWarp *warp,
                                   const YoroGlImages *images);

/**
 * Makes motion vectors of an eye, in a context of YORO_WARP_KIND_MOTION. Otherwise it is like yoro_gl_synthesize. The
 * colour that is read and the one that is written are vectors in RGBA16F; vectors of two components are not enough.
 *
 * @param context The context.
 * @param warp    The warp of yoro_motion_warp.
 * @param images  The images to read and where to draw.
 * @pre As for yoro_gl_synthesize.
 * @return As for yoro_gl_synthesize.
 */
YoroResult yoro_gl_synthesize_motion(YoroContext *context,
                                     const YoroMotionWarp *warp,
                                     const YoroGlImages *images);

/**
 * Composes an eye of its levels into a rectangle of its size, and overwrites all of it: the inset where it covers the eye
 * and has no hole at the border of what was rendered, else the wide view, bilinearly. The context must have been
 * created with `composes`; its warp_kind and sources do not matter.
 *
 * Call it on the thread on which the GL context is current. YoroGlInfo says how GL state is treated. It allocates and
 * compiles nothing, and does not wait for the GPU.
 *
 * @param context     The context.
 * @param composition The eye's composition, from yoro_levels_from_eyes with YORO_ROWS_UP.
 * @param levels      The images to read and where to draw.
 * @pre As for yoro_gl_synthesize.
 * @return YORO_ERROR_UNSUPPORTED without `composes`, YORO_ERROR_VALUE, YORO_ERROR_TOO_LARGE; with `check` also
 *         YORO_ERROR_FORMAT and YORO_ERROR_DRIVER; YORO_ERROR_API, YORO_ERROR_BUSY, YORO_ERROR_NULL,
 *         YORO_ERROR_STRUCT_SIZE.
 */
YoroResult yoro_gl_compose(YoroContext *context,
                           const YoroComposition *composition,
                           const YoroGlLevels *levels);

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
 * vkGetInstanceProcAddr of the Vulkan loader, or of a layer that replaces it.
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
   * Family of the queue that executes the command buffers; it must support graphics.
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
   * 1 if the feature dynamicRendering of Vulkan 1.3 or VK_KHR_dynamic_rendering is enabled, which is then used. 0:
   * render passes and framebuffers are used, with the same result.
   */
  uint32_t dynamic_rendering;
  /**
   * Format of the targets' colour: any format that the device can render to. Choose an sRGB format if the source is
   * sampled as sRGB.
   */
  VkFormat color_format;
  /**
   * Format of the targets' depth, which is written in the source's encoding. VK_FORMAT_UNDEFINED for no depth.
   */
  VkFormat depth_format;
  /**
   * Largest width of a source in pixels. The source's size follows from the eyes' distance and angles: take it from
   * eyes with the largest distance, and add a margin.
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
   * For yoro_times: the number of frames after which the times of a frame are returned, at least the number of
   * frames in flight. 0: nothing is measured.
   */
  uint32_t timed_frames;
  /**
   * The kind of warp. 0 is YORO_WARP_KIND_EYES.
   */
  YoroWarpKind warp_kind;
  /**
   * 1: makes a composer, too, for yoro_vk_compose. 0: it is not used.
   */
  uint32_t composes;
  /**
   * With YORO_WARP_KIND_EYES and a depth_format: YORO_OUTPUT_OPEN_STENCIL, if that has stencil, or YORO_OUTPUT_OPEN_DEPTH:
   * the mark then replaces the synthesized depth. 0: holes are filled.
   */
  YoroOutputFlags holes;
  /**
   * Must be 0.
   */
  uint32_t reserved;
  /**
   * A pipeline cache, or VK_NULL_HANDLE.
   */
  VkPipelineCache pipeline_cache;
  /**
   * Receives error messages, including those of later calls.
   */
  YoroMessages messages;
} YoroVkInfo;

/**
 * A use of an image: one side of a barrier.
 */
typedef struct {
  /**
   * The layout of the image. Before a call, that of a target may be VK_IMAGE_LAYOUT_UNDEFINED if its contents are
   * not needed: with VK_PIPELINE_STAGE_ALL_GRAPHICS_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT and access 0 if it was
   * drawn to, sampled or copied from before.
   */
  VkImageLayout layout;
  /**
   * The stages that use the image. 0: nothing is waited for before the call, or nothing waits after it, for example
   * because a semaphore does this. Before a call, where a semaphore hands the image over, name the stage at which
   * that semaphore is waited for.
   */
  VkPipelineStageFlags stages;
  /**
   * The kinds of access of these stages; 0 if there are none.
   */
  VkAccessFlags access;
} YoroVkState;

/**
 * One layer of a 2-D image: mip level 0, without multisampling.
 */
typedef struct {
  /**
   * The image. Its usage must include VK_IMAGE_USAGE_SAMPLED_BIT for a source, and
   * VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT or VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT for a target.
   */
  VkImage image;
  /**
   * The image's format, or a compatible one if the image has VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT.
   */
  VkFormat format;
  /**
   * The layer of the image, for example that of the eye. 0 for an image with one layer.
   */
  uint32_t layer;
  /**
   * Its use before yoro_vk_record: its layout at that time, and the stages to wait for.
   */
  YoroVkState before;
  /**
   * Its use after yoro_vk_record, for which it is made ready.
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
   * Must be 0.
   */
  uint32_t reserved;
  /**
   * Colour of the rendered eye, in any filterable format. All four channels are carried over. Of a
   * multisampled image, give the resolved one.
   */
  YoroVkImage color;
  /**
   * Depth of the rendered eye: VK_FORMAT_D16_UNORM, D24_UNORM_S8_UINT, D32_SFLOAT, D32_SFLOAT_S8_UINT, R16_UNORM or
   * R32_SFLOAT. Of a multisampled image, give the depth of each pixel's nearest sample (VK_RESOLVE_MODE_MIN_BIT, or
   * MAX for reversed depth). Averaged depth belongs to no surface, and causes halos.
   */
  YoroVkImage depth;
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
   * Must be 0.
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
   * Its use before yoro_vk_record: its layout at that time, and the stages to wait for.
   */
  YoroVkState before;
  /**
   * Its use after yoro_vk_record, for which it is made ready.
   */
  YoroVkState after;
} YoroVkUse;

/**
 * The uses of all images in one call, for engines whose images come from different passes and go to different ones in
 * each frame. Those of images that were not registered are ignored. A source is still sampled in the layout that it
 * was registered with: the registered `before` layout if it can be sampled, otherwise
 * VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL.
 */
typedef struct {
  /**
   * sizeof(YoroVkUses).
   */
  uint32_t struct_size;
  /**
   * The use of the source's colour.
   */
  YoroVkUse source_color;
  /**
   * The use of the source's depth.
   */
  YoroVkUse source_depth;
  /**
   * The use of the target's colour.
   */
  YoroVkUse target_color;
  /**
   * The use of the target's depth.
   */
  YoroVkUse target_depth;
} YoroVkUses;

/**
 * The images of one synthesis, and the rectangles in them.
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
   * First row of the rendered part. Row 0 is the first in memory.
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
   * Must be 0.
   */
  uint32_t reserved;
  /**
   * The uses of the images around this call, which replace those given at registration. May be NULL.
   */
  const YoroVkUses *uses;
} YoroVkFrame;

/**
 * The images of an eye's levels.
 */
typedef struct {
  /**
   * sizeof(YoroVkLevels).
   */
  uint32_t struct_size;
  /**
   * Width of the wide level's image in pixels; the level may be a part of it.
   */
  uint32_t wide_width;
  /**
   * Height of the wide level's image in pixels.
   */
  uint32_t wide_height;
  /**
   * Width of the inset's images in pixels; 0 for one level.
   */
  uint32_t inset_width;
  /**
   * Height of the inset's images in pixels; 0 for one level.
   */
  uint32_t inset_height;
  /**
   * 1: `inset_depth` is given. 0: it is ignored.
   */
  uint32_t has_depth;
  /**
   * Colour of the wide level in any filterable format. Of the rendered eye it is the rendered image, in which the
   * level begins at crop_x and crop_y; of the other, the synthesized one.
   */
  YoroVkImage wide;
  /**
   * Colour of the inset, in the same way; ignored for one level.
   */
  YoroVkImage inset;
  /**
   * Depth of the synthesized eye's inset. With it, holes at the border of what was rendered show the wide view.
   */
  YoroVkImage inset_depth;
} YoroVkLevels;

/**
 * The id of registered levels, never 0.
 */
typedef uint32_t YoroVkLevelsId;

/**
 * The images of one call of yoro_vk_compose, and the rectangles in them.
 */
typedef struct {
  /**
   * sizeof(YoroVkComposed).
   */
  uint32_t struct_size;
  /**
   * The images to read.
   */
  YoroVkLevelsId levels;
  /**
   * First column of the wide level.
   */
  uint32_t wide_x;
  /**
   * First row of the wide level. Row 0 is the first in memory.
   */
  uint32_t wide_y;
  /**
   * First column of the inset.
   */
  uint32_t inset_x;
  /**
   * First row of the inset.
   */
  uint32_t inset_y;
  /**
   * The image to write, of yoro_vk_register_composed.
   */
  YoroVkTargetId target;
  /**
   * First column of the eye's image.
   */
  uint32_t target_x;
  /**
   * First row of the eye's image.
   */
  uint32_t target_y;
} YoroVkComposed;

#ifdef __cplusplus
extern "C" {
#endif

/**
 * Creates a context for Vulkan: pipelines, and buffers for the largest sizes. Call it at startup, not in a frame.
 *
 * Call it from any thread.
 *
 * @param info    The options.
 * @param context Receives the new context, or NULL after an error. Destroy it with yoro_destroy.
 * @pre The handles are valid, belong together, and live until the YoroContext is destroyed.
 * @return YORO_ERROR_NO_CONTEXT for a loader without Vulkan's commands, YORO_ERROR_UNSUPPORTED, YORO_ERROR_FORMAT,
 *         YORO_ERROR_TOO_LARGE, YORO_ERROR_MEMORY, YORO_ERROR_DEVICE_LOST, YORO_ERROR_DRIVER, YORO_ERROR_VALUE,
 *         YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE.
 */
YoroResult yoro_vk_create(const YoroVkInfo *info,
                          YoroContext **context);

/**
 * Returns how many bytes of GPU memory the buffers of a context will take, computed from the sizes in its
 * options. Drivers add padding. For an existing context, call yoro_capabilities.
 *
 * Call it from any thread. It needs none of the handles in the options.
 *
 * @param info  The options.
 * @param bytes Receives the number of bytes.
 * @return YORO_ERROR_VALUE, YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE.
 */
YoroResult yoro_vk_buffer_bytes(const YoroVkInfo *info, uint64_t *bytes);

/**
 * Creates views and descriptors for images to read. Call it once for each set of images that you render to.
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
 * Creates views for images to write. Call it once for each image of a swapchain.
 *
 * Thread, preconditions and results are as for yoro_vk_register_source.
 *
 * @param context The context.
 * @param target  The images.
 * @param id      Receives their id.
 */
YoroResult yoro_vk_register_target(YoroContext *context, const YoroVkTarget *target, YoroVkTargetId *id);

/**
 * Releases the views and descriptors of images to read. Does nothing if the id is not registered.
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
 * Releases the views of images to write. Thread and results are as for yoro_vk_release_source.
 *
 * @param context The context.
 * @param id      The id from yoro_vk_register_target.
 * @pre No command that was recorded with the id is pending.
 */
YoroResult yoro_vk_release_target(YoroContext *context, YoroVkTargetId id);

/**
 * Records the synthesis of the other eye into a rectangle of the warp's target size, and overwrites all of it except
 * for open holes. Records barriers and three draws. Call it after recording the opaque objects of the rendered eye, and
 * before transparent objects and effects that are drawn for each eye. It allocates, compiles and submits nothing, and
 * does not wait.
 *
 * Changes the command buffer's graphics pipeline, descriptor set 0, push constants, viewport and scissor. Transitions
 * the images from their state `before` to their state `after`.
 *
 * Call it on the thread that may use the context and that records the command buffer.
 *
 * @param context  The context.
 * @param commands A command buffer of the device.
 * @param warp     The warp of YoroViews, with rows ordered as in the images.
 * @param frame    The images to read and where to draw.
 * @pre The command buffer is in the recording state, outside render passes and dynamic rendering, and is submitted to
 *      the queue family of YoroVkInfo. The images are in the state `before` when it is executed. Conditional rendering
 *      is not active.
 * @return YORO_ERROR_NOT_REGISTERED, YORO_ERROR_TOO_LARGE for sizes beyond those of YoroVkInfo or rectangles beyond
 *         their images, YORO_ERROR_VALUE, YORO_ERROR_API, YORO_ERROR_BUSY, YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE.
 *         After an error nothing has been recorded.
 */
YoroResult yoro_vk_record(YoroContext *context,
                          VkCommandBuffer commands,
                          const YoroWarp *warp,
                          const YoroVkFrame *frame);

/**
 * Records the synthesis of a view in any pose near the rendered one, in a context of YORO_WARP_KIND_POSE: barriers and
 * three draws. Otherwise it is like yoro_vk_record.
 *
 * @param context  The context.
 * @param commands A command buffer of the device.
 * @param warp     The warp of yoro_pose_warp, with rows ordered as in the images.
 * @param frame    The images to read and where to draw.
 * @pre As for yoro_vk_record.
 * @return As for yoro_vk_record.
 */
YoroResult yoro_vk_record_pose(YoroContext *context,
                               VkCommandBuffer commands,
                               const YoroPoseWarp *warp,
                               const YoroVkFrame *frame);

/**
 * Records motion vectors of an eye, in a context of YORO_WARP_KIND_MOTION: barriers and three draws. Otherwise it is like
 * yoro_vk_record. Colours are vectors, VK_FORMAT_R16G16B16A16_SFLOAT; images with two components are refused with
 * YORO_ERROR_FORMAT when they are registered.
 *
 * @param context  The context.
 * @param commands A command buffer of the device.
 * @param warp     The warp of yoro_motion_warp, with rows ordered as in the images.
 * @param frame    The images to read and where to draw.
 * @pre As for yoro_vk_record.
 * @return As for yoro_vk_record.
 */
YoroResult yoro_vk_record_motion(YoroContext *context,
                                 VkCommandBuffer commands,
                                 const YoroMotionWarp *warp,
                                 const YoroVkFrame *frame);

/**
 * Creates views and descriptors for the levels of an eye, in a context that was created with `composes`. Otherwise it is
 * like yoro_vk_register_source.
 *
 * @param context The context.
 * @param levels  The images.
 * @param id      Receives their id.
 * @pre The images live until the id is released or the context is destroyed.
 * @return YORO_ERROR_UNSUPPORTED without `composes`; those of yoro_vk_register_source.
 */
YoroResult yoro_vk_register_levels(YoroContext *context,
                                   const YoroVkLevels *levels,
                                   YoroVkLevelsId *id);

/**
 * Creates views for an image to compose eyes in: that of yoro_vk_register_target, but for yoro_vk_compose. Depth is
 * ignored.
 *
 * @param context The context.
 * @param target  The image.
 * @param id      Receives its id.
 * @pre As for yoro_vk_register_target.
 * @return YORO_ERROR_UNSUPPORTED without `composes`; those of yoro_vk_register_target.
 */
YoroResult yoro_vk_register_composed(YoroContext *context,
                                     const YoroVkTarget *target,
                                     YoroVkTargetId *id);

/**
 * Releases the objects of levels. Does nothing if the id is not registered. Thread and results are as for
 * yoro_vk_release_source.
 *
 * @param context The context.
 * @param id      The id from yoro_vk_register_levels.
 * @pre No command that was recorded with the id is pending.
 */
YoroResult yoro_vk_release_levels(YoroContext *context, YoroVkLevelsId id);

/**
 * Releases the objects of an image to compose eyes in. Does nothing if the id is not registered. Thread and results are
 * as for yoro_vk_release_source.
 *
 * @param context The context.
 * @param id      The id from yoro_vk_register_composed.
 * @pre No command that was recorded with the id is pending.
 */
YoroResult yoro_vk_release_composed(YoroContext *context,
                                    YoroVkTargetId id);

/**
 * Records the composition of an eye of its levels into a rectangle of its size, and overwrites all of it: the inset where
 * it covers the eye and has no hole at the border of what was rendered, else the wide view, bilinearly. Records barriers
 * and one draw. Otherwise it is like yoro_vk_record.
 *
 * @param context     The context.
 * @param commands    A command buffer of the device.
 * @param composition The eye's composition, from yoro_levels_from_eyes with YORO_ROWS_DOWN.
 * @param frame       The images to read and where to draw.
 * @pre As for yoro_vk_record.
 * @return YORO_ERROR_UNSUPPORTED without `composes`; those of yoro_vk_record.
 */
YoroResult yoro_vk_compose(YoroContext *context,
                           VkCommandBuffer commands,
                           const YoroComposition *composition,
                           const YoroVkComposed *frame);

#ifdef __cplusplus
}
#endif

#endif  /* YORO_VULKAN_H */
