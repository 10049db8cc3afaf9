/* An engine on OpenGL ES that uses only the shader kit. The shaders are read from the folder kit, or from that in
 * YORO_KIT. */
#include "engine_gles.h"
#include "yoro_kit.h"

static char *read_file(const char *name) {
  char path[1024], *text = (char *)calloc(1, 1 << 16);
  snprintf(path, sizeof path, "%s/gles/%s", getenv("YORO_KIT") ? getenv("YORO_KIT") : "kit", name);
  FILE *file = fopen(path, "rb");
  if (!file || !text || !fread(text, 1, (1 << 16) - 1, file)) fail("a file of the kit cannot be read");
  fclose(file);
  return text;
}

static GLuint make_pass(const char *vertex, const char *name) {
  const char *files[] = {vertex, name};
  const char *textures[] = {"depth_map", "color_map", "tile_map", "span_map"};
  GLuint program = glCreateProgram();
  for (int i = 0; i < 2; ++i) {
    char *text = read_file(files[i]);
    const char *constant = text;
    GLuint shader = glCreateShader(i ? GL_FRAGMENT_SHADER : GL_VERTEX_SHADER);
    glShaderSource(shader, 1, &constant, NULL);
    glCompileShader(shader);
    glAttachShader(program, shader);
    free(text);
  }
  glLinkProgram(program);
  GLint linked = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  if (!linked) fail("a shader of the kit does not compile");
  glUseProgram(program);
  for (int i = 0; i < 4; ++i) glUniform1i(glGetUniformLocation(program, textures[i]), i);
  glUniformBlockBinding(program, glGetUniformBlockIndex(program, "Synthesis"), 0);
  return program;
}

/* A target of four 32-bit integers. */
static Image make_map(const int size[2]) {
  Image map = {0, 0, 0, size[0], size[1]};
  glGenFramebuffers(1, &map.framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, map.framebuffer);
  map.color = make_texture(GL_RGBA32UI, GL_COLOR_ATTACHMENT0, map.width, map.height);
  return map;
}

static void bind(int unit, GLuint texture, GLenum filter) {
  glActiveTexture(GL_TEXTURE0 + (GLenum)unit);
  glBindTexture(GL_TEXTURE_2D, texture);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, (GLint)filter);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, (GLint)filter);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

static void run_pass(GLuint program, const Image *target) {
  glBindFramebuffer(GL_FRAMEBUFFER, target->framebuffer);
  glViewport(0, 0, target->width, target->height);
  glUseProgram(program);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

/* Draws a view with the engine's matrices: reversed depth from 0.1 m to infinity, eyes that are not rotated. */
static void draw_view(GLuint program, const YoroKitFrustum *f, float eye_x, const Image *image) {
  const float w = f->right - f->left, h = f->up - f->down;
  const float projection[16] = {2 / w, 0, 0, 0, 0, 2 / h, 0, 0, (f->right + f->left) / w, (f->up + f->down) / h, 1, -1,
                                0, 0, 0.2f, 0};
  const float view[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -eye_x, -1.6f, -2.0f, 1};
  draw(program, projection, view, image);
}

int main(int argc, char **argv) {
  make_context();
  GLuint scene = make_program();
  GLuint tiles = make_pass("screen.vert", "tiles.frag"), spans = make_pass("screen.vert", "spans.frag");
  GLuint march = make_pass("march.vert", "march.frag");

  /* 1. What to render, and the uniforms. */
  const float up = tanf(0.65f), out = tanf(0.7f), in = tanf(0.6f);
  const YoroKitEyes eyes = {{{-out, in, up, -up}, {-in, out, up, -up}}, 0.063f, 0.1f, INFINITY, 1, 1, SIZE, SIZE, 1.0f, 0};
  YoroKitViews views;
  if (!yoro_kit_views(&eyes, 0, 0, &views)) fail("these eyes cannot be served");
  Image source = make_image((uint32_t)views.width, (uint32_t)views.height);
  draw_view(scene, &views.frustum, 0.0315f, &source);

  /* 2. Three passes. */
  GLuint block;
  glGenBuffers(1, &block);
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, block);
  glBufferData(GL_UNIFORM_BUFFER, sizeof views.uniforms, &views.uniforms, GL_STREAM_DRAW);
  Image tile_map = make_map(views.tile_map), span_map = make_map(views.span_map), other = make_image(SIZE, SIZE);
  bind(0, source.depth, GL_NEAREST);
  bind(1, source.color, GL_LINEAR);
  bind(2, tile_map.color, GL_NEAREST);
  bind(3, span_map.color, GL_NEAREST);
  glDisable(GL_DEPTH_TEST);
  run_pass(tiles, &tile_map);
  run_pass(spans, &span_map);
  run_pass(march, &other);

  Image truth = make_image(SIZE, SIZE);
  draw_view(scene, &eyes.frusta[0], -0.0315f, &truth);
  report(argc > 1 ? argv[1] : "kit.png", &other, &source, views.crop_x, views.crop_y, &truth);
  return 0;
}
