/*
 * yoro: render one eye, synthesize the other.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 *
 * For Vulkan include <vulkan/vulkan.h> before this file; without it there is the rest.
 *
 * Made of app/capi/src by cbindgen; `cargo xtask test the_header --bless` renews it.
 */


#ifndef YORO_H
#define YORO_H

#include <stddef.h>
#include <stdint.h>

/**
 * Version of this header.
 */
#define YORO_VERSION_MAJOR 0

/**
 * Second part of it.
 */
#define YORO_VERSION_MINOR 1

/**
 * Third part of it.
 */
#define YORO_VERSION_PATCH 0

/**
 * All of it as one number that grows: major * 1000000 + minor * 1000 + patch.
 */
#define YORO_VERSION (((YORO_VERSION_MAJOR * 1000000) + (YORO_VERSION_MINOR * 1000)) + YORO_VERSION_PATCH)

/**
 * A guard band that is complete for whatever is farther than an arm's length, in metres.
 */
#define YORO_GUARD_BAND 1.0

/**
 * One way to synthesize in one GL context or on one Vulkan device: compiled shaders and small buffers.
 *
 * Every function that takes one may be called from any thread, from one at a time; a second one gets YORO_ERROR_BUSY.
 * For OpenGL that is the thread on which the GL context is current.
 */
typedef struct YoroContext YoroContext;

/**
 * What a function returns: YORO_OK, or one of the negative YORO_ERROR_ codes.
 */
typedef int32_t YoroResult;
/**
 * All went well.
 */
#define YORO_OK 0
/**
 * A pointer that must not be NULL is NULL.
 */
#define YORO_ERROR_NULL (-1)
/**
 * struct_size is not the size of the structure, or a newer version of it sets what this library does not know.
 */
#define YORO_ERROR_STRUCT_SIZE (-2)
/**
 * A number is out of its range: no finite number, a size of zero, a constant that does not exist, planes out of order.
 */
#define YORO_ERROR_VALUE (-3)
/**
 * The matrices are no rigid view and no perspective projection, or those of the eyes do not fit each other.
 */
#define YORO_ERROR_MATRIX (-4)
/**
 * The eyes are rotated against each other. YORO_EYES_PARALLEL helps, or render both eyes.
 */
#define YORO_ERROR_EYES_CANTED (-5)
/**
 * The eyes do not lie on one horizontal line.
 */
#define YORO_ERROR_EYES_OFF_AXIS (-6)
/**
 * The left eye lies to the right of the right eye, or surfaces at the near plane move by more pixels than can be
 * synthesized: 4095 in images that are wider than that.
 */
#define YORO_ERROR_EYES_IPD (-7)
/**
 * The eyes' images have different tangents per pixel. YORO_EYES_EVEN helps.
 */
#define YORO_ERROR_EYES_DENSITY (-8)
/**
 * The rows of one eye's image lie between those of the other's. YORO_EYES_EVEN helps.
 */
#define YORO_ERROR_EYES_ROWS (-9)
/**
 * An image has more pixels on a side than the driver, or any driver, can render.
 */
#define YORO_ERROR_TOO_LARGE (-10)
/**
 * No GL context is current on this thread, or the loader function does not give the API's entry points.
 */
#define YORO_ERROR_NO_CONTEXT (-11)
/**
 * The driver is too old, or lacks what was asked for.
 */
#define YORO_ERROR_UNSUPPORTED (-12)
/**
 * A texture, image or framebuffer does not exist, or has another format, type or size than is needed.
 */
#define YORO_ERROR_FORMAT (-13)
/**
 * The driver refused a shader, an object or a command.
 */
#define YORO_ERROR_DRIVER (-14)
/**
 * The YoroContext was made for another API than the function.
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
 * The Vulkan device is lost: it has to be made again, and the YoroContext with it.
 */
#define YORO_ERROR_DEVICE_LOST (-18)
/**
 * A number of images that is not registered with this YoroContext, or not any more.
 */
#define YORO_ERROR_NOT_REGISTERED (-19)
/**
 * An error of the library itself. A YoroContext that it happened to gives nothing else from then on, and can only be
 * destroyed.
 */
#define YORO_ERROR_INTERNAL (-20)

/**
 * One of the two eyes, and its index in arrays of two.
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
 * Pose of an eye in a right-handed world with Y up, in which the eye looks along its own -Z, X to the right. Laid out as
 * XrPosef.
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
 * Angles in radians from the eye's axis to the edges of its image, of less than a right angle; left and down are
 * negative when the image contains the axis. Laid out as XrFovf.
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
 * What the values 0 to 1 in a depth buffer mean, whatever the API's clip volume is.
 */
typedef uint32_t YoroDepth;
/**
 * 0 at the near plane, 1 at the far plane; tested with LESS, cleared to 1.
 */
#define YORO_DEPTH_STANDARD 0
/**
 * 1 at the near plane, 0 at the far plane; tested with GREATER, cleared to 0.
 */
#define YORO_DEPTH_REVERSED 1

/**
 * In which order the rows of images lie in memory and in texture coordinates.
 */
typedef uint32_t YoroRows;
/**
 * Row 0 is the lowest: OpenGL.
 */
#define YORO_ROWS_UP 0
/**
 * Row 0 is the topmost: Vulkan, Direct3D, image files.
 */
#define YORO_ROWS_DOWN 1

/**
 * The clip volume that projection matrices lead to. X is to the right in all of them.
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
 * Bits of what may be done to eyes that rows cannot serve as they are.
 */
typedef uint32_t YoroEyesFlags;
/**
 * Gives both eyes frusta of one width and one height over the same rows, each as large as it takes. Show the images with
 * the angles that come out.
 */
#define YORO_EYES_EVEN 1
/**
 * Gives canted eyes one direction, and frusta that contain their own. Show the images with the poses and angles that
 * come out: an OpenXR runtime turns them back when they are submitted with these.
 */
#define YORO_EYES_PARALLEL 2

/**
 * Gets the sentence of an error: what is wrong and what helps, UTF-8, valid during the call only. Called on the thread
 * of the function that fails, before it returns. It must not throw, and must not call yoro with the same context.
 */
typedef void (*YoroMessageCallback)(void *user, YoroResult result, const char *sentence);

/**
 * Where the sentences of errors go.
 */
typedef struct {
  /**
   * Gets them; may be NULL.
   */
  YoroMessageCallback callback;
  /**
   * Its first argument.
   */
  void *user;
} YoroMessages;

/**
 * The two eyes of a frame by poses and angles.
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
   * Distance of the far plane in metres, more than near_z; may be INFINITY. In reversed depth, too, it is the larger one.
   */
  float far_z;
  /**
   * What the depth buffer holds.
   */
  YoroDepth depth;
  /**
   * Order of rows in the images.
   */
  YoroRows rows;
  /**
   * The clip volume that the matrices shall lead to.
   */
  YoroClip clip;
  /**
   * Metres from which on the other eye finds all of its outer border in the rendered image, 0.05 to 1000; smaller values
   * cost more pixels. 0: none is rendered, and the border is filled in.
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
 * One image: where its eye is, what it covers, and the matrices that render it.
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
   * Pose of the eye. From matrices of a left-handed world: in the world whose Z axis is negated.
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
 * How pixels of the rendered image move to the other eye's: all that synthesis has to know. yoro_views_from_eyes and
 * yoro_views_from_matrices fill it; it can be copied and kept.
 *
 * The pixel in column x and row y lands in column x + offset + scale * depth and row y + row_offset, depth being the
 * value stored in the depth buffer.
 */
typedef struct {
  /**
   * Width of the rendered colour and depth in pixels.
   */
  uint32_t source_width;
  /**
   * Height of both.
   */
  uint32_t source_height;
  /**
   * Width of the synthesized image in pixels.
   */
  uint32_t target_width;
  /**
   * Height of it.
   */
  uint32_t target_height;
  /**
   * Columns at depth 0.
   */
  double offset;
  /**
   * Columns per unit of depth.
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
   * Whether smaller or larger values of depth are nearer.
   */
  YoroDepth depth;
  /**
   * Zero.
   */
  uint32_t reserved;
} YoroWarp;

/**
 * What to do in a frame.
 */
typedef struct {
  /**
   * sizeof(YoroViews), set by the caller.
   */
  uint32_t struct_size;
  /**
   * Column of the source in which the rendered eye's own image begins.
   */
  uint32_t crop_x;
  /**
   * Row of the source in which it begins, counted as YoroRows says.
   */
  uint32_t crop_y;
  /**
   * Zero.
   */
  uint32_t reserved;
  /**
   * The view to render: that of the rendered eye, wider by the guard band. Render colour and depth of this size.
   */
  YoroView source;
  /**
   * The rendered eye's own image: the part of the source that begins at the crop and has this size.
   */
  YoroView rendered;
  /**
   * The image that is synthesized.
   */
  YoroView synthesized;
  /**
   * How pixels move; goes to synthesis.
   */
  YoroWarp warp;
} YoroViews;

/**
 * The two eyes of a frame by matrices. All are column-major, for column vectors, as GL and Vulkan take them: the
 * translation of a view matrix is in elements 12 to 14, and element 11 of a projection is -1 (eyes that look along -Z) or
 * 1 (along +Z).
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
   * The clip volume that the projections lead to.
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
   * Units of the world in a metre: 100 for centimetres. 0 stands for 1.
   */
  float units_per_metre;
  /**
   * Where the sentences of errors go.
   */
  YoroMessages messages;
} YoroMatrices;

/**
 * The API that a YoroContext was made for.
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
 * What a YoroContext runs on, and what it takes.
 */
typedef struct {
  /**
   * sizeof(YoroCapabilities), set by the caller.
   */
  uint32_t struct_size;
  /**
   * What it was made for.
   */
  YoroApi api;
  /**
   * Version of the API: 3 of 3.1.
   */
  uint32_t api_major;
  /**
   * Version of the API: 1 of 3.1.
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
   * 1 where the CPU draws (llvmpipe, SwiftShader).
   */
  uint32_t software;
  /**
   * Largest side of an image in pixels.
   */
  uint32_t max_image_size;
  /**
   * Bytes of the buffers that it has allocated on the GPU so far.
   */
  uint64_t buffer_bytes;
  /**
   * Name of the GPU or its driver, UTF-8, cut off and ended by 0.
   */
  uint8_t device[128];
} YoroCapabilities;

/**
 * Bits of what is written besides colour, and how.
 */
typedef uint32_t YoroOutputFlags;
/**
 * Depth of the synthesized eye, encoded as the source's, to the target's depth attachment: for transparent objects.
 */
#define YORO_OUTPUT_DEPTH 1
/**
 * Source and target are both sRGB images, which sampling decodes: what is written is encoded.
 */
#define YORO_OUTPUT_SRGB 2

/**
 * What becomes of the GL state that a call changes.
 */
typedef uint32_t YoroGlState;
/**
 * Some of it is left changed (docs/library.md has the table): for engines that set what they draw with.
 */
#define YORO_GL_STATE_LEAVE 0
/**
 * All of it is as it was before the call.
 */
#define YORO_GL_STATE_PRESERVE 1

/**
 * What the rendered eye knows of its edges, where a pixel shows more than one surface, and with it what its depth is. Depth
 * that was averaged over samples belongs to no surface, and gives halos.
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
 * Colour resolved from several samples, depth of the first of them: what a driver leaves that resolves depth by itself.
 */
#define YORO_EDGES_SAMPLE 2
/**
 * Colour resolved from 2 or 4 samples, depth of all of them and, where it is still there, the colour of all of them, in the
 * standard places. The best of the four.
 */
#define YORO_EDGES_MULTISAMPLE 3

/**
 * An entry point, whatever its own type is.
 */
typedef void (*YoroGlProc)(void);

/**
 * Gives an entry point by its name, NULL for those that do not exist: eglGetProcAddress, glfwGetProcAddress and others.
 */
typedef YoroGlProc (*YoroGlLoader)(const char *name);

/**
 * How to create a context for OpenGL.
 */
typedef struct {
  /**
   * sizeof(YoroGlInfo).
   */
  uint32_t struct_size;
  /**
   * Zero. It once chose a pipeline: other numbers are refused.
   */
  uint32_t reserved;
  /**
   * YORO_OUTPUT_ bits.
   */
  YoroOutputFlags outputs;
  /**
   * What becomes of GL state.
   */
  YoroGlState state;
  /**
   * 1: each call looks whether textures and framebuffer are as they must be, and whether GL has errors, which it takes.
   * Costs a wait for the driver: for development. 0: such mistakes are undefined, as in GL.
   */
  uint32_t check;
  /**
   * What the source knows of its edges; 0 is YORO_EDGES_HARD. YORO_EDGES_MULTISAMPLE needs
   * OpenGL ES 3.1.
   */
  YoroEdges edges;
  /**
   * Entry points.
   */
  YoroGlLoader loader;
  /**
   * Where the sentences of errors go, those of later calls, too.
   */
  YoroMessages messages;
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
   * The rendered eye: name of a GL_TEXTURE_2D of the source's size and any filterable format, without samples. All four
   * channels are carried over, in whatever encoding. Filters and sampler objects do not matter. Other than with
   * YORO_EDGES_HARD it is resolved, and lies between 0 and 1.
   */
  uint32_t color_texture;
  /**
   * Its depth: name of a GL_TEXTURE_2D of the same size with a depth, depth-stencil (sampled as depth) or red float format;
   * with YORO_EDGES_MULTISAMPLE of a GL_TEXTURE_2D_MULTISAMPLE of 2 or 4 samples.
   */
  uint32_t depth_texture;
  /**
   * The framebuffer to draw into, 0 for the window's. It has neither of the textures; its first colour attachment is
   * written, and with YORO_OUTPUT_DEPTH its depth attachment.
   */
  uint32_t framebuffer;
  /**
   * Column of the framebuffer where the synthesized image begins.
   */
  uint32_t x;
  /**
   * Row of the framebuffer where it begins, from the lowest.
   */
  uint32_t y;
  /**
   * With YORO_EDGES_MULTISAMPLE, name of the GL_TEXTURE_2D_MULTISAMPLE that color_texture was resolved from, where it is
   * still there; otherwise 0.
   */
  uint32_t sample_color_texture;
} YoroGlImages;

#if defined(VK_VERSION_1_1)
/**
 * vkGetInstanceProcAddr, of the loader or of whoever stands in for it.
 */
typedef void (*(*YoroVkLoader)(VkInstance instance, const char *name))(void);
#endif

#if defined(VK_VERSION_1_1)
/**
 * How to create a context for Vulkan.
 */
typedef struct {
  /**
   * sizeof(YoroVkInfo).
   */
  uint32_t struct_size;
  /**
   * Family of the queue that the command buffers go to; it has graphics.
   */
  uint32_t queue_family;
  /**
   * Entry points.
   */
  YoroVkLoader loader;
  /**
   * Of version 1.1 or later; no extension is needed.
   */
  VkInstance instance;
  /**
   * The physical device of `device`.
   */
  VkPhysicalDevice physical_device;
  /**
   * Of version 1.1 or later; no extension and no feature is needed.
   */
  VkDevice device;
  /**
   * 1 where the feature dynamicRendering is enabled, of Vulkan 1.3 or VK_KHR_dynamic_rendering, which is then used. 0:
   * render passes and framebuffers, with the same result.
   */
  uint32_t dynamic_rendering;
  /**
   * Format of the targets' colour, any that the device renders to. A source that is sampled as sRGB belongs into an sRGB
   * target.
   */
  VkFormat color_format;
  /**
   * Format of the targets' depth, which is then written, too, encoded as the source's; VK_FORMAT_UNDEFINED for none.
   */
  VkFormat depth_format;
  /**
   * Largest width of a source in pixels.
   */
  uint32_t max_source_width;
  /**
   * Largest height of a source.
   */
  uint32_t max_source_height;
  /**
   * Largest width of a synthesized image in pixels.
   */
  uint32_t max_target_width;
  /**
   * Largest height of a synthesized image.
   */
  uint32_t max_target_height;
  /**
   * What sources know of their edges; 0 is YORO_EDGES_HARD.
   */
  YoroEdges edges;
  /**
   * With YORO_EDGES_MULTISAMPLE, samples in each pixel of a source's depth: 2 or 4. Otherwise not looked at.
   */
  uint32_t samples;
  /**
   * Zero.
   */
  uint32_t reserved;
  /**
   * A cache for pipelines, or VK_NULL_HANDLE.
   */
  VkPipelineCache pipeline_cache;
  /**
   * Where the sentences of errors go, those of later calls, too.
   */
  YoroMessages messages;
} YoroVkInfo;
#endif

#if defined(VK_VERSION_1_1)
/**
 * What an image was used for, or will be: the one side of a barrier.
 */
typedef struct {
  /**
   * Its layout.
   */
  VkImageLayout layout;
  /**
   * The stages that use it.
   */
  VkPipelineStageFlags stages;
  /**
   * How they use it.
   */
  VkAccessFlags access;
} YoroVkState;
#endif

#if defined(VK_VERSION_1_1)
/**
 * One layer of a 2-D image: mip level 0, without multisampling where nothing else is said.
 */
typedef struct {
  /**
   * Its usage has VK_IMAGE_USAGE_SAMPLED_BIT for a source, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT or
   * VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT for a target.
   */
  VkImage image;
  /**
   * The image's format, or of a VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT image a compatible one.
   */
  VkFormat format;
  /**
   * Layer of an array, such as that of the eye; 0 where there is one.
   */
  uint32_t layer;
  /**
   * What it was used for before yoro_vk_record: the layout that it is in, and what has to be waited for.
   */
  YoroVkState before;
  /**
   * What it is left ready for.
   */
  YoroVkState after;
} YoroVkImage;
#endif

#if defined(VK_VERSION_1_1)
/**
 * Images to read.
 */
typedef struct {
  /**
   * sizeof(YoroVkSource).
   */
  uint32_t struct_size;
  /**
   * Width of the images in pixels; what is rendered may be a part of them.
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
   * Colour of the rendered eye, of any format that can be filtered. All four channels are carried over. Other than with
   * YORO_EDGES_HARD it is resolved, and lies between 0 and 1.
   */
  YoroVkImage color;
  /**
   * Its depth: VK_FORMAT_D16_UNORM, D24_UNORM_S8_UINT, D32_SFLOAT, D32_SFLOAT_S8_UINT or R32_SFLOAT; with
   * YORO_EDGES_MULTISAMPLE of YoroVkInfo's samples.
   */
  YoroVkImage depth;
  /**
   * With YORO_EDGES_MULTISAMPLE, what the colour was resolved from, of as many samples, where it is still there; otherwise
   * its image is VK_NULL_HANDLE.
   */
  YoroVkImage sample_color;
} YoroVkSource;
#endif

#if defined(VK_VERSION_1_1)
/**
 * A registered source, never 0.
 */
typedef uint32_t YoroVkSourceId;
#endif

#if defined(VK_VERSION_1_1)
/**
 * Images to write.
 */
typedef struct {
  /**
   * sizeof(YoroVkTarget).
   */
  uint32_t struct_size;
  /**
   * Width of the images in pixels; what is synthesized may be a part of them.
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
   * Colour, of YoroVkInfo's color_format.
   */
  YoroVkImage color;
  /**
   * Depth, of YoroVkInfo's depth_format; not looked at where that is VK_FORMAT_UNDEFINED.
   */
  YoroVkImage depth;
} YoroVkTarget;
#endif

#if defined(VK_VERSION_1_1)
/**
 * A registered target, never 0.
 */
typedef uint32_t YoroVkTargetId;
#endif

#if defined(VK_VERSION_1_1)
/**
 * What to synthesize in one call.
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
   * Column of them where what was rendered begins.
   */
  uint32_t source_x;
  /**
   * Row of them where it begins; row 0 is the first in memory.
   */
  uint32_t source_y;
  /**
   * The images to write.
   */
  YoroVkTargetId target;
  /**
   * Column of them where the synthesized image begins.
   */
  uint32_t target_x;
  /**
   * Row of them where it begins.
   */
  uint32_t target_y;
} YoroVkFrame;
#endif

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/**
 * A short text for a result, such as "the eyes are canted"; "unknown result" for other numbers. It lives as long as the
 * library.
 *
 * Any thread.
 */
const char *yoro_result_text(YoroResult result);

/**
 * The version of the library, as YORO_VERSION says that of the header.
 *
 * Any thread.
 */
uint32_t yoro_version(void);

/**
 * Works out what to render, and how its pixels move to the other eye.
 *
 * Any thread, no context needed. Nothing is allocated or kept.
 *
 * @param eyes  Where the eyes are.
 * @param views Filled; struct_size is set by the caller.
 * @pre Both pointers lead to structures of the size that they state.
 * @return YORO_ERROR_VALUE, YORO_ERROR_TOO_LARGE or a YORO_ERROR_EYES_ code for eyes that cannot be, or that rows
 *         cannot serve; YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE.
 */
YoroResult yoro_views_from_eyes(const YoroEyes *eyes,
                                YoroViews *views);

/**
 * Works out what to render, and how its pixels move to the other eye. Matrices that come out are like those that went in:
 * of the same world, clip volume and units. Poses are in metres.
 *
 * Any thread, no context needed. Nothing is allocated or kept.
 *
 * @param matrices Where the eyes are.
 * @param views    Filled; struct_size is set by the caller.
 * @pre Both pointers lead to structures of the size that they state.
 * @return YORO_ERROR_MATRIX for matrices that are no rigid views or perspective projections; otherwise as
 *         yoro_views_from_eyes.
 */
YoroResult yoro_views_from_matrices(const YoroMatrices *matrices,
                                    YoroViews *views);

/**
 * Asks what a context runs on and what it takes.
 *
 * On the thread that may use the context; for OpenGL with the GL context current. Leaves all GL state as it is.
 *
 * @param context      Whom to ask.
 * @param capabilities Filled; struct_size is set by the caller.
 * @pre context is alive.
 * @return YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE, YORO_ERROR_BUSY.
 */
YoroResult yoro_capabilities(YoroContext *context,
                             YoroCapabilities *capabilities);

/**
 * Destroys a context and all that it has on the GPU. NULL is allowed, and does nothing.
 *
 * On the thread that may use the context; for OpenGL with the GL context current, with Vulkan after the device has done
 * all that was recorded. A YoroContext does not outlive the GL context or device: where that is lost, destroy it before.
 * Leaves GL state as deleting objects does: what was bound and is deleted is not bound any more.
 *
 * @param context What to destroy.
 * @pre context is alive and no other thread uses it.
 * @return YORO_ERROR_BUSY, and nothing is destroyed, when another thread is inside a function with it.
 */
YoroResult yoro_destroy(YoroContext *context);

/**
 * Creates a context for OpenGL ES 3.0 or later, or desktop OpenGL 4.5 or later, and compiles its shaders: at start, not in
 * a frame.
 *
 * On the thread on which the GL context is current. GL state as YoroGlInfo says, without a change of the error flag.
 *
 * @param info    How.
 * @param context Gets the new context, NULL after an error. Destroy it with yoro_destroy.
 * @pre The GL context is current, and stays alive as long as the YoroContext.
 * @return YORO_ERROR_NO_CONTEXT, YORO_ERROR_UNSUPPORTED, YORO_ERROR_DRIVER, YORO_ERROR_VALUE, YORO_ERROR_NULL,
 *         YORO_ERROR_STRUCT_SIZE.
 */
YoroResult yoro_gl_create(const YoroGlInfo *info,
                          YoroContext **context);

/**
 * Allocates what images of these sizes take, so that the first yoro_gl_synthesize does not. Costs nothing when the sizes
 * are as before.
 *
 * Thread, GL state and results as yoro_gl_synthesize.
 *
 * @param context The context.
 * @param warp    Of a frame of these sizes.
 * @pre The GL context is current.
 */
YoroResult yoro_gl_prepare(YoroContext *context,
                           const YoroWarp *warp);

/**
 * Synthesizes the other eye into a rectangle of warp's target size, all of which is overwritten. Call it after the opaque
 * objects of the rendered eye, before transparent objects and effects that are drawn for each eye.
 *
 * On the thread on which the GL context is current. GL state as YoroGlInfo says. While sizes stay the same nothing is
 * allocated or compiled, and nothing waits for the GPU. Transform feedback and conditional rendering are not active.
 *
 * @param context The context.
 * @param warp    From YoroViews.
 * @param images  What to read and where to draw.
 * @pre The GL context is current; the textures and the framebuffer are its own and fit what YoroGlImages says.
 * @return YORO_ERROR_VALUE, YORO_ERROR_TOO_LARGE, YORO_ERROR_DRIVER; with `check` YORO_ERROR_FORMAT, too;
 *         YORO_ERROR_API, YORO_ERROR_BUSY, YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE.
 */
YoroResult yoro_gl_synthesize(YoroContext *context,
                              const YoroWarp *warp,
                              const YoroGlImages *images);

#if defined(VK_VERSION_1_1)
/**
 * Creates a context for Vulkan: pipelines, and buffers for the largest sizes. At start, not in a frame.
 *
 * Any thread.
 *
 * @param info    How.
 * @param context Gets the new context, NULL after an error. Destroy it with yoro_destroy.
 * @pre The handles are valid, belong together, and stay so until the YoroContext is destroyed.
 * @return YORO_ERROR_NO_CONTEXT for a loader without Vulkan's commands, YORO_ERROR_UNSUPPORTED, YORO_ERROR_FORMAT,
 *         YORO_ERROR_TOO_LARGE, YORO_ERROR_MEMORY, YORO_ERROR_DEVICE_LOST, YORO_ERROR_DRIVER, YORO_ERROR_VALUE,
 *         YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE.
 */
YoroResult yoro_vk_create(const YoroVkInfo *info,
                          YoroContext **context);
#endif

#if defined(VK_VERSION_1_1)
/**
 * Makes views and descriptors of images to read: once for each pair of images that is rendered to.
 *
 * On the thread that may use the context.
 *
 * @param context The context.
 * @param source  The images.
 * @param id      Gets their number.
 * @pre The images are alive until the number is released or the context destroyed.
 * @return YORO_ERROR_FORMAT, YORO_ERROR_TOO_LARGE, YORO_ERROR_MEMORY, YORO_ERROR_DEVICE_LOST, YORO_ERROR_DRIVER,
 *         YORO_ERROR_VALUE, YORO_ERROR_API, YORO_ERROR_BUSY, YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE.
 */
YoroResult yoro_vk_register_source(YoroContext *context,
                                   const YoroVkSource *source,
                                   YoroVkSourceId *id);
#endif

#if defined(VK_VERSION_1_1)
/**
 * Makes views of images to write: once for each image of a swapchain.
 *
 * Thread, preconditions and results as yoro_vk_register_source.
 *
 * @param context The context.
 * @param target  The images.
 * @param id      Gets their number.
 */
YoroResult yoro_vk_register_target(YoroContext *context, const YoroVkTarget *target, YoroVkTargetId *id);
#endif

#if defined(VK_VERSION_1_1)
/**
 * Forgets images to read. A number that is not registered is ignored.
 *
 * On the thread that may use the context.
 *
 * @param context The context.
 * @param id      What yoro_vk_register_source gave.
 * @pre No command that was recorded with it is pending.
 * @return YORO_ERROR_API, YORO_ERROR_BUSY, YORO_ERROR_NULL.
 */
YoroResult yoro_vk_release_source(YoroContext *context, YoroVkSourceId id);
#endif

#if defined(VK_VERSION_1_1)
/**
 * Forgets images to write. As yoro_vk_release_source.
 *
 * @param context The context.
 * @param id      What yoro_vk_register_target gave.
 * @pre No command that was recorded with it is pending.
 */
YoroResult yoro_vk_release_target(YoroContext *context, YoroVkTargetId id);
#endif

#if defined(VK_VERSION_1_1)
/**
 * Records the synthesis of the other eye: barriers, and three draws or, other than with YORO_EDGES_HARD, four into the target's rectangle of warp's target size, all of
 * which is overwritten. Record it after the opaque objects of the rendered eye, before transparent objects and effects
 * that are drawn for each eye. Nothing is allocated, compiled, submitted or waited for.
 *
 * Changes the command buffer's graphics pipeline, descriptor set 0, push constants, viewport and scissor. Images go from
 * their state `before` to their state `after`.
 *
 * On the thread that may use the context and that records the command buffer.
 *
 * @param context  The context.
 * @param commands A command buffer of the device.
 * @param warp     From YoroViews, with rows as they lie in the images.
 * @param frame    What to read and where to draw.
 * @pre The command buffer is in the recording state, outside of render passes and dynamic rendering, and is submitted to
 *      the queue family of YoroVkInfo. The images are in the state `before` when it is executed.
 * @return YORO_ERROR_NOT_REGISTERED, YORO_ERROR_TOO_LARGE for sizes beyond those of YoroVkInfo or rectangles beyond their
 *         images, YORO_ERROR_VALUE, YORO_ERROR_API, YORO_ERROR_BUSY, YORO_ERROR_NULL, YORO_ERROR_STRUCT_SIZE; with
 *         any of these nothing was recorded.
 */
YoroResult yoro_vk_record(YoroContext *context,
                          VkCommandBuffer commands,
                          const YoroWarp *warp,
                          const YoroVkFrame *frame);
#endif

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* YORO_H */
