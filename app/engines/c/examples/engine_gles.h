/* A minimal engine for the samples on OpenGL ES: a context, images to render to, and a scene. It does not use yoro. */
#ifndef ENGINE_GLES_H
#define ENGINE_GLES_H

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES3/gl31.h>

#include "picture.h"

enum { SIZE = 512 };

static void fail(const char *what) {
  fprintf(stderr, "%s\n", what);
  exit(1);
}

/* A GL context without a window. An engine has its own. */
static void make_context(void) {
  static const EGLint config_attributes[] = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_ES3_BIT, EGL_NONE};
  static const EGLint context_attributes[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 1, EGL_NONE};
  EGLDisplay display = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
  EGLConfig config = NULL;
  EGLint configs = 0;
  if (!eglInitialize(display, NULL, NULL) || !eglChooseConfig(display, config_attributes, &config, 1, &configs))
    fail("no EGL display without a window here");
  eglBindAPI(EGL_OPENGL_ES_API);
  EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, context_attributes);
  if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) fail("no OpenGL ES 3.1 context");
}

/* What the engine renders to: colour and depth as textures, behind a framebuffer. */
typedef struct {
  GLuint framebuffer, color, depth;
  int width, height;
} Image;

static GLuint make_texture(GLenum format, GLenum attachment, int width, int height) {
  GLuint texture;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  glTexStorage2D(GL_TEXTURE_2D, 1, format, width, height);
  glFramebufferTexture2D(GL_FRAMEBUFFER, attachment, GL_TEXTURE_2D, texture, 0);
  return texture;
}

static Image make_image(uint32_t width, uint32_t height) {
  Image image = {0, 0, 0, (int)width, (int)height};
  glGenFramebuffers(1, &image.framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, image.framebuffer);
  image.color = make_texture(GL_RGBA8, GL_COLOR_ATTACHMENT0, image.width, image.height);
  image.depth = make_texture(GL_DEPTH_COMPONENT32F, GL_DEPTH_ATTACHMENT, image.width, image.height);
  return image;
}

/* The scene: a tiled room with balls, one ray per pixel. It takes the product of the projection and of the view without
 * its translation, since an engine has such a matrix, and inverts it, since a ray caster needs the inverse. */
static const char VERTEX[] =
    "#version 310 es\n"
    "out vec2 ndc;\n"
    "void main() {\n"
    "  ndc = vec2(float((gl_VertexID << 1) & 2), float(gl_VertexID & 2)) * 2.0 - 1.0;\n"
    "  gl_Position = vec4(ndc, 0.0, 1.0);\n"
    "}\n";
static const char FRAGMENT[] =
    "#version 310 es\n"
    "precision highp float;\n"
    "uniform mat4 projection, view;\n"
    "in vec2 ndc;\n"
    "layout(location = 0) out vec4 color;\n"
    "void main() {\n"
    "  vec3 eye = -transpose(mat3(view)) * view[3].xyz;\n"
    "  vec2 ahead = (ndc + vec2(projection[2][0], projection[2][1])) / vec2(projection[0][0], projection[1][1]);\n"
    "  vec3 ray = normalize(transpose(mat3(view)) * vec3(ahead, -1.0));\n"
    "  vec3 walls = (sign(ray) * vec3(3.0, 3.0, 5.0) - eye) / ray;\n"
    "  float t = min(walls.x, min(walls.y, walls.z));\n"
    "  vec3 normal = -sign(ray) * step(walls, vec3(t));\n"
    "  ivec3 tile = ivec3(floor((eye + t * ray + 0.01 * normal) * 2.0));\n"
    "  vec3 albedo = ((tile.x + tile.y + tile.z) & 1) == 0 ? vec3(0.75, 0.72, 0.66) : vec3(0.32, 0.38, 0.45);\n"
    "  for (int i = 0; i < 7; ++i) {\n"
    "    float n = float(i);\n"
    "    vec3 center = vec3(1.5 * sin(0.9 * n), 1.6 + 0.9 * cos(1.53 * n), 0.9 - 0.8 * n);\n"
    "    vec3 to_eye = eye - center;\n"
    "    float radius = 0.2 + 0.05 * n, b = dot(to_eye, ray);\n"
    "    float d = b * b - dot(to_eye, to_eye) + radius * radius;\n"
    "    float hit = -b - sqrt(max(d, 0.0));\n"
    "    if (d > 0.0 && hit > 0.0 && hit < t) {\n"
    "      t = hit;\n"
    "      normal = (eye + t * ray - center) / radius;\n"
    "      albedo = 0.5 + 0.45 * cos(n + vec3(0.0, 2.1, 4.2));\n"
    "      albedo *= fract(4.0 * atan(normal.z, normal.x) / 3.1416) < 0.5 ? 1.0 : 0.6;\n"
    "    }\n"
    "  }\n"
    "  color = vec4(albedo * (0.45 + 0.55 * max(dot(normal, vec3(0.36, 0.8, 0.48)), 0.0)), 1.0);\n"
    "  vec4 clip = projection * (view * vec4(eye + t * ray, 1.0));\n"
    "  gl_FragDepth = 0.5 * clip.z / clip.w + 0.5;\n"
    "}\n";

static GLuint make_program(void) {
  const GLenum kinds[] = {GL_VERTEX_SHADER, GL_FRAGMENT_SHADER};
  const char *texts[] = {VERTEX, FRAGMENT};
  GLuint program = glCreateProgram();
  for (int i = 0; i < 2; ++i) {
    GLuint shader = glCreateShader(kinds[i]);
    glShaderSource(shader, 1, &texts[i], NULL);
    glCompileShader(shader);
    glAttachShader(program, shader);
  }
  glLinkProgram(program);
  GLint linked = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  if (!linked) fail("the scene's shaders do not compile");
  return program;
}

static void draw(GLuint program, const float *projection, const float *view, const Image *image) {
  glBindFramebuffer(GL_FRAMEBUFFER, image->framebuffer);
  glViewport(0, 0, image->width, image->height);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_ALWAYS);
  glUseProgram(program);
  glUniformMatrix4fv(glGetUniformLocation(program, "projection"), 1, GL_FALSE, projection);
  glUniformMatrix4fv(glGetUniformLocation(program, "view"), 1, GL_FALSE, view);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

static void read_pixels(const Image *image, int x, int y, uint8_t *pixels) {
  glBindFramebuffer(GL_FRAMEBUFFER, image->framebuffer);
  glReadPixels(x, y, SIZE, SIZE, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
}

/* Writes both eyes side by side, the synthesized one on the left, and prints how close it is to a real render. */
static void report(const char *path, const Image *synthesized, const Image *source, int crop_x, int crop_y,
                   const Image *truth) {
  static uint8_t both[4 * 2 * SIZE * SIZE], rendered[4 * SIZE * SIZE];
  glPixelStorei(GL_PACK_ROW_LENGTH, 2 * SIZE);
  read_pixels(synthesized, 0, 0, both);
  read_pixels(source, crop_x, crop_y, both + 4 * SIZE);
  glPixelStorei(GL_PACK_ROW_LENGTH, 0);
  read_pixels(truth, 0, 0, rendered);
  Picture pair = {2 * SIZE, SIZE, both, 2 * SIZE};
  Picture left = {SIZE, SIZE, both, 2 * SIZE}, right = {SIZE, SIZE, both + 4 * SIZE, 2 * SIZE};
  Picture expected = {SIZE, SIZE, rendered, SIZE};
  printf("synthesized: %.2f dB, SSIM %.4f\n", picture_psnr(&left, &expected), picture_ssim(&left, &expected));
  printf("same image:  %.2f dB, SSIM %.4f\n", picture_psnr(&right, &expected), picture_ssim(&right, &expected));
  if (!picture_write(path, &pair, 1)) fail("the picture cannot be written");
  if (glGetError() != GL_NO_ERROR) fail("GL has an error");
}

#endif
