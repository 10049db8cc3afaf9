/* An engine on Direct3D 12 that uses only the shader kit. engine_direct3d.h says how to compile it. */
#define NOMINMAX
#include "engine_direct3d.h"

#ifdef _WIN32
#include <d3d12.h>
#else
#define WIDL_EXPLICIT_AGGREGATE_RETURNS
#define VKD3D_UTILS_API_VERSION VKD3D_API_VERSION_1_2
#include <vkd3d_utils.h>
#define IID_PPV_ARGS(address) __uuidof(**(address)), (void **)(address)
#endif

static ID3D12Device *device;
static ID3D12GraphicsCommandList *list;
static ID3D12RootSignature *root;
static ID3D12DescriptorHeap *view_heap;
static const D3D12_RESOURCE_STATES READ = D3D12_RESOURCE_STATE_PIXEL_SHADER_RESOURCE;

static void check(HRESULT result, const char *what) {
  char code[16];
  snprintf(code, sizeof code, ": %08x", (unsigned)result);
  if (FAILED(result)) fail(std::string(what) + code);
}

static ID3D12Resource *make_resource(D3D12_HEAP_TYPE type, const D3D12_RESOURCE_DESC &about, D3D12_RESOURCE_STATES state) {
  D3D12_HEAP_PROPERTIES heap = {};
  heap.Type = type;
  ID3D12Resource *resource;
  check(device->CreateCommittedResource(&heap, D3D12_HEAP_FLAG_NONE, &about, state, nullptr, IID_PPV_ARGS(&resource)), "memory");
  return resource;
}

static ID3D12Resource *make_texture(DXGI_FORMAT format, int width, int height, D3D12_RESOURCE_FLAGS flags, D3D12_RESOURCE_STATES state) {
  D3D12_RESOURCE_DESC about = {};
  about.Dimension = D3D12_RESOURCE_DIMENSION_TEXTURE2D, about.Format = format, about.Flags = flags;
  about.Width = (UINT64)width, about.Height = (UINT)height, about.DepthOrArraySize = about.MipLevels = 1;
  about.SampleDesc.Count = 1;
  return make_resource(D3D12_HEAP_TYPE_DEFAULT, about, state);
}

static ID3D12DescriptorHeap *make_heap(D3D12_DESCRIPTOR_HEAP_TYPE type, UINT count, D3D12_DESCRIPTOR_HEAP_FLAGS flags) {
  const D3D12_DESCRIPTOR_HEAP_DESC about = {type, count, flags, 0};
  ID3D12DescriptorHeap *heap;
  check(device->CreateDescriptorHeap(&about, IID_PPV_ARGS(&heap)), "descriptors");
  return heap;
}

/* A target. Depth may be missing. Both are in the state of a target until they are read. */
struct Image {
  int width, height;
  ID3D12Resource *color, *depth;
  D3D12_CPU_DESCRIPTOR_HANDLE target, depth_target;
};

static Image make_image(DXGI_FORMAT format, int width, int height, bool has_depth) {
  Image image = {width, height, nullptr, nullptr, {}, {}};
  image.color = make_texture(format, width, height, D3D12_RESOURCE_FLAG_ALLOW_RENDER_TARGET, D3D12_RESOURCE_STATE_RENDER_TARGET);
  image.target = make_heap(D3D12_DESCRIPTOR_HEAP_TYPE_RTV, 1, D3D12_DESCRIPTOR_HEAP_FLAG_NONE)->GetCPUDescriptorHandleForHeapStart();
  device->CreateRenderTargetView(image.color, nullptr, image.target);
  if (!has_depth) return image;
  /* A depth buffer that shaders read has no type of its own; its views do. With stencil: R32G8X24_TYPELESS, to be read as
   * R32_FLOAT_X8X24_TYPELESS. */
  image.depth = make_texture(DXGI_FORMAT_R32_TYPELESS, width, height, D3D12_RESOURCE_FLAG_ALLOW_DEPTH_STENCIL, D3D12_RESOURCE_STATE_DEPTH_WRITE);
  image.depth_target = make_heap(D3D12_DESCRIPTOR_HEAP_TYPE_DSV, 1, D3D12_DESCRIPTOR_HEAP_FLAG_NONE)->GetCPUDescriptorHandleForHeapStart();
  D3D12_DEPTH_STENCIL_VIEW_DESC written = {};
  written.Format = DXGI_FORMAT_D32_FLOAT, written.ViewDimension = D3D12_DSV_DIMENSION_TEXTURE2D;
  device->CreateDepthStencilView(image.depth, &written, image.depth_target);
  return image;
}

/* Makes the view that all passes find at t0, t1 and so on. */
static void set_view(UINT index, ID3D12Resource *texture, DXGI_FORMAT format) {
  D3D12_SHADER_RESOURCE_VIEW_DESC about = {};
  about.Format = format, about.ViewDimension = D3D12_SRV_DIMENSION_TEXTURE2D, about.Texture2D.MipLevels = 1;
  about.Shader4ComponentMapping = D3D12_DEFAULT_SHADER_4_COMPONENT_MAPPING;
  D3D12_CPU_DESCRIPTOR_HANDLE place = view_heap->GetCPUDescriptorHandleForHeapStart();
  place.ptr += index * device->GetDescriptorHandleIncrementSize(D3D12_DESCRIPTOR_HEAP_TYPE_CBV_SRV_UAV);
  device->CreateShaderResourceView(texture, &about, place);
}

/* The block is 28 root constants at b0, the textures are a table, and the samplers are static. */
static ID3D12RootSignature *make_root_signature() {
  D3D12_DESCRIPTOR_RANGE range = {};
  range.RangeType = D3D12_DESCRIPTOR_RANGE_TYPE_SRV, range.NumDescriptors = 4;
  D3D12_ROOT_PARAMETER parameters[2] = {};
  parameters[0].ParameterType = D3D12_ROOT_PARAMETER_TYPE_32BIT_CONSTANTS;
  parameters[0].Constants.Num32BitValues = sizeof(YoroKitUniforms) / 4;
  parameters[1].ParameterType = D3D12_ROOT_PARAMETER_TYPE_DESCRIPTOR_TABLE;
  parameters[1].DescriptorTable.NumDescriptorRanges = 1, parameters[1].DescriptorTable.pDescriptorRanges = &range;
  D3D12_STATIC_SAMPLER_DESC samplers[2] = {};
  for (UINT i = 0; i < 2; ++i) {
    samplers[i].Filter = i ? D3D12_FILTER_MIN_MAG_LINEAR_MIP_POINT : D3D12_FILTER_MIN_MAG_MIP_POINT;
    samplers[i].AddressU = samplers[i].AddressV = samplers[i].AddressW = D3D12_TEXTURE_ADDRESS_MODE_CLAMP;
    samplers[i].ComparisonFunc = D3D12_COMPARISON_FUNC_NEVER, samplers[i].MaxLOD = D3D12_FLOAT32_MAX;
    samplers[i].ShaderRegister = i;
  }
  const D3D12_ROOT_SIGNATURE_DESC about = {2, parameters, 2, samplers, D3D12_ROOT_SIGNATURE_FLAG_NONE};
  ID3DBlob *blob;
  check(D3D12SerializeRootSignature(&about, D3D_ROOT_SIGNATURE_VERSION_1, &blob, nullptr), "a root signature");
  ID3D12RootSignature *signature;
  check(device->CreateRootSignature(0, blob->GetBufferPointer(), blob->GetBufferSize(), IID_PPV_ARGS(&signature)), "a root signature");
  return signature;
}

static ID3D12PipelineState *make_pass(const char *vertex, const char *pixel, DXGI_FORMAT format, bool has_depth) {
  const std::vector<char> v = read_shader(vertex), p = read_shader(pixel);
  D3D12_GRAPHICS_PIPELINE_STATE_DESC about = {};
  about.pRootSignature = root;
  about.VS = {v.data(), v.size()}, about.PS = {p.data(), p.size()};
  about.BlendState.RenderTarget[0].RenderTargetWriteMask = D3D12_COLOR_WRITE_ENABLE_ALL;
  about.SampleMask = ~0u, about.SampleDesc.Count = 1;
  about.RasterizerState.FillMode = D3D12_FILL_MODE_SOLID, about.RasterizerState.CullMode = D3D12_CULL_MODE_NONE;
  about.RasterizerState.DepthClipEnable = TRUE;
  /* Depth is written without a test. */
  about.DepthStencilState.DepthEnable = has_depth, about.DepthStencilState.DepthWriteMask = D3D12_DEPTH_WRITE_MASK_ALL;
  about.DepthStencilState.DepthFunc = D3D12_COMPARISON_FUNC_ALWAYS;
  about.PrimitiveTopologyType = D3D12_PRIMITIVE_TOPOLOGY_TYPE_TRIANGLE;
  about.NumRenderTargets = 1, about.RTVFormats[0] = format;
  about.DSVFormat = has_depth ? DXGI_FORMAT_D32_FLOAT : DXGI_FORMAT_UNKNOWN;
  ID3D12PipelineState *pass;
  check(device->CreateGraphicsPipelineState(&about, IID_PPV_ARGS(&pass)), pixel);
  return pass;
}

static void barrier(ID3D12Resource *resource, D3D12_RESOURCE_STATES before, D3D12_RESOURCE_STATES after) {
  D3D12_RESOURCE_BARRIER about = {};
  about.Type = D3D12_RESOURCE_BARRIER_TYPE_TRANSITION;
  about.Transition.pResource = resource;
  about.Transition.StateBefore = before, about.Transition.StateAfter = after;
  list->ResourceBarrier(1, &about);
}

static void run_pass(ID3D12PipelineState *pass, const Image &image, const void *block, size_t size) {
  const D3D12_VIEWPORT viewport = {0, 0, (float)image.width, (float)image.height, 0, 1};
  const D3D12_RECT all = {0, 0, image.width, image.height};
  list->SetPipelineState(pass);
  list->SetGraphicsRootSignature(root);
  list->SetGraphicsRoot32BitConstants(0, (UINT)size / 4, block, 0);
  list->SetDescriptorHeaps(1, &view_heap);
  list->SetGraphicsRootDescriptorTable(1, view_heap->GetGPUDescriptorHandleForHeapStart());
  list->OMSetRenderTargets(1, &image.target, FALSE, image.depth ? &image.depth_target : nullptr);
  list->RSSetViewports(1, &viewport), list->RSSetScissorRects(1, &all);
  list->IASetPrimitiveTopology(D3D_PRIMITIVE_TOPOLOGY_TRIANGLELIST);
  list->DrawInstanced(3, 1, 0, 0);
}

/* A copy of a texture of four bytes a pixel, whose rows begin at multiples of 256 bytes. */
struct Copy {
  ID3D12Resource *buffer;
  int width, height;
  size_t pitch() const { return ((size_t)width * 4 + 255) & ~(size_t)255; }
};

static Copy copy_texture(ID3D12Resource *texture, int width, int height, DXGI_FORMAT format, D3D12_RESOURCE_STATES before) {
  Copy copy = {nullptr, width, height};
  D3D12_RESOURCE_DESC about = {};
  about.Dimension = D3D12_RESOURCE_DIMENSION_BUFFER, about.Layout = D3D12_TEXTURE_LAYOUT_ROW_MAJOR;
  about.Width = copy.pitch() * (size_t)height, about.Height = about.DepthOrArraySize = about.MipLevels = 1;
  about.SampleDesc.Count = 1;
  copy.buffer = make_resource(D3D12_HEAP_TYPE_READBACK, about, D3D12_RESOURCE_STATE_COPY_DEST);
  D3D12_TEXTURE_COPY_LOCATION from = {}, to = {};
  from.pResource = texture, from.Type = D3D12_TEXTURE_COPY_TYPE_SUBRESOURCE_INDEX;
  to.pResource = copy.buffer, to.Type = D3D12_TEXTURE_COPY_TYPE_PLACED_FOOTPRINT;
  to.PlacedFootprint.Footprint = {format, (UINT)width, (UINT)height, 1, (UINT)copy.pitch()};
  barrier(texture, before, D3D12_RESOURCE_STATE_COPY_SOURCE);
  list->CopyTextureRegion(&to, 0, 0, 0, &from, nullptr);
  return copy;
}

static Pixels read_back(const Copy &copy) {
  char *data;
  check(copy.buffer->Map(0, nullptr, (void **)&data), "reading back");
  Pixels pixels = {copy.width, copy.height, std::vector<uint8_t>((size_t)copy.width * (size_t)copy.height * 4)};
  const size_t row = (size_t)copy.width * 4;
  for (size_t y = 0; y < (size_t)copy.height; ++y) memcpy(&pixels.bytes[y * row], data + y * copy.pitch(), row);
  return pixels;
}

int main(int argc, char **argv) {
  check(D3D12CreateDevice(nullptr, D3D_FEATURE_LEVEL_11_0, IID_PPV_ARGS(&device)), "no device");
  D3D12_COMMAND_QUEUE_DESC direct = {};
  ID3D12CommandQueue *queue;
  ID3D12CommandAllocator *allocator;
  check(device->CreateCommandQueue(&direct, IID_PPV_ARGS(&queue)), "a queue");
  check(device->CreateCommandAllocator(direct.Type, IID_PPV_ARGS(&allocator)), "commands");
  check(device->CreateCommandList(0, direct.Type, allocator, nullptr, IID_PPV_ARGS(&list)), "commands");
  root = make_root_signature();
  view_heap = make_heap(D3D12_DESCRIPTOR_HEAP_TYPE_CBV_SRV_UAV, 4, D3D12_DESCRIPTOR_HEAP_FLAG_SHADER_VISIBLE);
  const DXGI_FORMAT rgba = DXGI_FORMAT_R8G8B8A8_UNORM, integers = DXGI_FORMAT_R32G32B32A32_UINT, depths = DXGI_FORMAT_R32_FLOAT;
  ID3D12PipelineState *room = make_pass("room.vert", "room.frag", rgba, true);
  ID3D12PipelineState *tiles = make_pass("screen.vert", "tiles.frag", integers, false);
  ID3D12PipelineState *spans = make_pass("screen.vert", "spans.frag", integers, false);
  ID3D12PipelineState *march = make_pass("march.vert", "march.frag", rgba, true);

  /* 1. What to render, and the constants. */
  const YoroKitEyes eyes = make_eyes();
  YoroKitViews views;
  if (!yoro_kit_views(&eyes, 0, 0, &views)) fail("these eyes cannot be served");
  const Image source = make_image(rgba, views.width, views.height, true), truth = make_image(rgba, SIDE, SIDE, true);
  const Image tile_map = make_image(integers, views.tile_map[0], views.tile_map[1], false);
  const Image span_map = make_image(integers, views.span_map[0], views.span_map[1], false);
  const Image other = make_image(rgba, SIDE, SIDE, true);
  set_view(0, source.depth, depths), set_view(1, source.color, rgba);
  set_view(2, tile_map.color, integers), set_view(3, span_map.color, integers);
  const Room seen = make_room(views.frustum, 0.0315f), real = make_room(eyes.frusta[0], -0.0315f);
  run_pass(room, source, &seen, sizeof seen);
  run_pass(room, truth, &real, sizeof real);

  /* 2. Three passes. */
  barrier(source.color, D3D12_RESOURCE_STATE_RENDER_TARGET, READ);
  barrier(source.depth, D3D12_RESOURCE_STATE_DEPTH_WRITE, READ);
  run_pass(tiles, tile_map, &views.uniforms, sizeof views.uniforms);
  barrier(tile_map.color, D3D12_RESOURCE_STATE_RENDER_TARGET, READ);
  run_pass(spans, span_map, &views.uniforms, sizeof views.uniforms);
  barrier(span_map.color, D3D12_RESOURCE_STATE_RENDER_TARGET, READ);
  run_pass(march, other, &views.uniforms, sizeof views.uniforms);

  const Copy copies[6] = {
      copy_texture(source.color, source.width, source.height, rgba, READ),
      copy_texture(source.depth, source.width, source.height, depths, READ),
      copy_texture(other.color, SIDE, SIDE, rgba, D3D12_RESOURCE_STATE_RENDER_TARGET),
      copy_texture(other.depth, SIDE, SIDE, depths, D3D12_RESOURCE_STATE_DEPTH_WRITE),
      copy_texture(truth.color, SIDE, SIDE, rgba, D3D12_RESOURCE_STATE_RENDER_TARGET),
      copy_texture(truth.depth, SIDE, SIDE, depths, D3D12_RESOURCE_STATE_DEPTH_WRITE),
  };
  check(list->Close(), "commands");
  ID3D12CommandList *lists[1] = {list};
  queue->ExecuteCommandLists(1, lists);
  ID3D12Fence *fence;
  check(device->CreateFence(0, D3D12_FENCE_FLAG_NONE, IID_PPV_ARGS(&fence)), "a fence");
  check(queue->Signal(fence, 1), "a fence");
  /* Without an event, this waits. */
  check(fence->SetEventOnCompletion(1, nullptr), "a fence");
  report(argc, argv, "d3d12", views,
         {read_back(copies[0]), read_back(copies[1]), read_back(copies[2]), read_back(copies[3]), read_back(copies[4]), read_back(copies[5])});
  fflush(stdout);
  return 0;
}
