/* An engine on Direct3D 11 that uses only the shader kit. engine_direct3d.h says how to compile it. */
#define NOMINMAX
#include "engine_direct3d.h"

#include <d3d11.h>

static ID3D11Device *device;
static ID3D11DeviceContext *context;

static void check(HRESULT result, const char *what) {
  char code[16];
  snprintf(code, sizeof code, ": %08x", (unsigned)result);
  if (FAILED(result)) fail(std::string(what) + code);
}

/* A target with its views; depth may be missing. */
struct Image {
  int width, height;
  ID3D11Texture2D *color, *depth;
  ID3D11RenderTargetView *target;
  ID3D11DepthStencilView *depth_target;
  ID3D11ShaderResourceView *color_map, *depth_map;
};

static ID3D11Texture2D *make_texture(DXGI_FORMAT format, int width, int height, UINT bind) {
  D3D11_TEXTURE2D_DESC about = {};
  about.Width = (UINT)width, about.Height = (UINT)height, about.MipLevels = about.ArraySize = 1;
  about.Format = format, about.SampleDesc.Count = 1;
  about.BindFlags = bind | D3D11_BIND_SHADER_RESOURCE;
  ID3D11Texture2D *texture;
  check(device->CreateTexture2D(&about, nullptr, &texture), "a texture");
  return texture;
}

static Image make_image(DXGI_FORMAT format, int width, int height, bool has_depth) {
  Image image = {width, height, make_texture(format, width, height, D3D11_BIND_RENDER_TARGET), nullptr, nullptr, nullptr, nullptr, nullptr};
  check(device->CreateRenderTargetView(image.color, nullptr, &image.target), "a target");
  check(device->CreateShaderResourceView(image.color, nullptr, &image.color_map), "a view");
  if (!has_depth) return image;
  /* A depth buffer that shaders read has no type of its own; its views do. With stencil: R24G8_TYPELESS, to be read as
   * R24_UNORM_X8_TYPELESS. */
  image.depth = make_texture(DXGI_FORMAT_R32_TYPELESS, width, height, D3D11_BIND_DEPTH_STENCIL);
  D3D11_DEPTH_STENCIL_VIEW_DESC written = {};
  written.Format = DXGI_FORMAT_D32_FLOAT, written.ViewDimension = D3D11_DSV_DIMENSION_TEXTURE2D;
  check(device->CreateDepthStencilView(image.depth, &written, &image.depth_target), "a depth target");
  D3D11_SHADER_RESOURCE_VIEW_DESC read = {};
  read.Format = DXGI_FORMAT_R32_FLOAT, read.ViewDimension = D3D11_SRV_DIMENSION_TEXTURE2D, read.Texture2D.MipLevels = 1;
  check(device->CreateShaderResourceView(image.depth, &read, &image.depth_map), "a view of depth");
  return image;
}

static ID3D11Buffer *make_block(UINT size, const void *content) {
  D3D11_BUFFER_DESC about = {};
  about.ByteWidth = size, about.Usage = D3D11_USAGE_IMMUTABLE, about.BindFlags = D3D11_BIND_CONSTANT_BUFFER;
  const D3D11_SUBRESOURCE_DATA data = {content, 0, 0};
  ID3D11Buffer *block;
  check(device->CreateBuffer(&about, &data, &block), "a constant buffer");
  return block;
}

static ID3D11SamplerState *make_sampler(D3D11_FILTER filter) {
  D3D11_SAMPLER_DESC about = {};
  about.Filter = filter, about.MaxLOD = D3D11_FLOAT32_MAX, about.ComparisonFunc = D3D11_COMPARISON_NEVER;
  about.AddressU = about.AddressV = about.AddressW = D3D11_TEXTURE_ADDRESS_CLAMP;
  ID3D11SamplerState *sampler;
  check(device->CreateSamplerState(&about, &sampler), "a sampler");
  return sampler;
}

struct Pass {
  ID3D11VertexShader *vertex;
  ID3D11PixelShader *pixel;
};

static Pass make_pass(const char *vertex, const char *pixel) {
  Pass pass;
  const std::vector<char> v = read_shader(vertex), p = read_shader(pixel);
  check(device->CreateVertexShader(v.data(), v.size(), nullptr, &pass.vertex), vertex);
  check(device->CreatePixelShader(p.data(), p.size(), nullptr, &pass.pixel), pixel);
  return pass;
}

/* Draws a triangle over the image. No texture may be bound as a target and to be read at once. */
static void run_pass(const Pass &pass, const Image &image, ID3D11Buffer *block, const std::vector<ID3D11ShaderResourceView *> &maps) {
  ID3D11ShaderResourceView *none[4] = {};
  const D3D11_VIEWPORT viewport = {0, 0, (float)image.width, (float)image.height, 0, 1};
  context->PSSetShaderResources(0, 4, none);
  context->OMSetRenderTargets(1, &image.target, image.depth_target);
  context->PSSetShaderResources(0, (UINT)maps.size(), maps.data());
  context->VSSetConstantBuffers(0, 1, &block), context->PSSetConstantBuffers(0, 1, &block);
  context->VSSetShader(pass.vertex, nullptr, 0), context->PSSetShader(pass.pixel, nullptr, 0);
  context->RSSetViewports(1, &viewport);
  context->Draw(3, 0);
}

static Pixels read_back(ID3D11Texture2D *texture) {
  D3D11_TEXTURE2D_DESC about;
  texture->GetDesc(&about);
  about.Usage = D3D11_USAGE_STAGING, about.BindFlags = 0, about.CPUAccessFlags = D3D11_CPU_ACCESS_READ;
  ID3D11Texture2D *copy;
  check(device->CreateTexture2D(&about, nullptr, &copy), "a texture to read back");
  context->CopyResource(copy, texture);
  D3D11_MAPPED_SUBRESOURCE mapped;
  check(context->Map(copy, 0, D3D11_MAP_READ, 0, &mapped), "reading back");
  Pixels pixels = {(int)about.Width, (int)about.Height, std::vector<uint8_t>((size_t)about.Width * about.Height * 4)};
  for (size_t y = 0; y < about.Height; ++y)
    memcpy(&pixels.bytes[y * about.Width * 4], (const char *)mapped.pData + y * mapped.RowPitch, (size_t)about.Width * 4);
  return pixels;
}

int main(int argc, char **argv) {
  const D3D_FEATURE_LEVEL level = D3D_FEATURE_LEVEL_11_0;
  check(D3D11CreateDevice(nullptr, D3D_DRIVER_TYPE_HARDWARE, nullptr, 0, &level, 1, D3D11_SDK_VERSION, &device, nullptr, &context), "no device");
  const Pass room = make_pass("room.vert", "room.frag");
  const Pass tiles = make_pass("screen.vert", "tiles.frag"), spans = make_pass("screen.vert", "spans.frag");
  const Pass march = make_pass("march.vert", "march.frag");

  /* State: nothing is culled or blended, and depth is written without a test. */
  D3D11_RASTERIZER_DESC raster = {};
  raster.FillMode = D3D11_FILL_SOLID, raster.CullMode = D3D11_CULL_NONE, raster.DepthClipEnable = TRUE;
  ID3D11RasterizerState *raster_state;
  check(device->CreateRasterizerState(&raster, &raster_state), "a state");
  D3D11_DEPTH_STENCIL_DESC depth = {};
  depth.DepthEnable = TRUE, depth.DepthWriteMask = D3D11_DEPTH_WRITE_MASK_ALL, depth.DepthFunc = D3D11_COMPARISON_ALWAYS;
  ID3D11DepthStencilState *depth_state;
  check(device->CreateDepthStencilState(&depth, &depth_state), "a state");
  ID3D11SamplerState *samplers[2] = {make_sampler(D3D11_FILTER_MIN_MAG_MIP_POINT), make_sampler(D3D11_FILTER_MIN_MAG_LINEAR_MIP_POINT)};
  context->IASetPrimitiveTopology(D3D11_PRIMITIVE_TOPOLOGY_TRIANGLELIST);
  context->RSSetState(raster_state);
  context->OMSetDepthStencilState(depth_state, 0);
  context->PSSetSamplers(0, 2, samplers);

  /* 1. What to render, and the constants. */
  const YoroKitEyes eyes = make_eyes();
  YoroKitViews views;
  if (!yoro_kit_views(&eyes, 0, 0, &views)) fail("these eyes cannot be served");
  const Image source = make_image(DXGI_FORMAT_R8G8B8A8_UNORM, views.width, views.height, true);
  const Room seen = make_room(views.frustum, 0.0315f);
  run_pass(room, source, make_block(sizeof seen, &seen), {});

  /* 2. Three passes. */
  ID3D11Buffer *block = make_block(sizeof views.uniforms, &views.uniforms);
  const Image tile_map = make_image(DXGI_FORMAT_R32G32B32A32_UINT, views.tile_map[0], views.tile_map[1], false);
  const Image span_map = make_image(DXGI_FORMAT_R32G32B32A32_UINT, views.span_map[0], views.span_map[1], false);
  const Image other = make_image(DXGI_FORMAT_R8G8B8A8_UNORM, SIDE, SIDE, true);
  run_pass(tiles, tile_map, block, {source.depth_map});
  run_pass(spans, span_map, block, {nullptr, nullptr, tile_map.color_map});
  run_pass(march, other, block, {source.depth_map, source.color_map, tile_map.color_map, span_map.color_map});

  const Image truth = make_image(DXGI_FORMAT_R8G8B8A8_UNORM, SIDE, SIDE, true);
  const Room real = make_room(eyes.frusta[0], -0.0315f);
  run_pass(room, truth, make_block(sizeof real, &real), {});
  report(argc, argv, "d3d11", views,
         {read_back(source.color), read_back(source.depth), read_back(other.color), read_back(other.depth),
          read_back(truth.color), read_back(truth.depth)});
  fflush(stdout);
  return 0;
}
