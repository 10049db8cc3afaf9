/*
 * The engine of vulkan.c: a device, images, a scene of one draw, and reading a picture back. For brevity it uses Vulkan
 * 1.3, which yoro does not need.
 */
#ifndef ENGINE_VULKAN_H
#define ENGINE_VULKAN_H

#define YORO_USE_VULKAN
#include <yoro.h>

#include "picture.h"
#include "room_spv.h" /* room.vert and room.frag, by glslangValidator -V */

enum { SIZE = 512 };

static VkInstance instance;
static VkPhysicalDevice gpu;
static VkDevice device;
static VkCommandBuffer commands;

static void check(VkResult result, const char *what) {
  if (result == VK_SUCCESS) return;
  fprintf(stderr, "vulkan: %s: error %d\n", what, (int)result);
  exit(1);
}

static uint32_t memory_type(uint32_t allowed, VkMemoryPropertyFlags flags) {
  VkPhysicalDeviceMemoryProperties all;
  vkGetPhysicalDeviceMemoryProperties(gpu, &all);
  for (uint32_t i = 0; i < all.memoryTypeCount; ++i)
    if ((allowed >> i & 1) && (all.memoryTypes[i].propertyFlags & flags) == flags) return i;
  check(VK_ERROR_FEATURE_NOT_PRESENT, "no memory of this kind");
  return 0;
}

static VkDeviceMemory allocate(VkMemoryRequirements needs, VkMemoryPropertyFlags flags) {
  VkMemoryAllocateInfo info = {VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, NULL, needs.size,
                               memory_type(needs.memoryTypeBits, flags)};
  VkDeviceMemory memory;
  check(vkAllocateMemory(device, &info, NULL, &memory), "vkAllocateMemory");
  return memory;
}

/* Images that the engine renders to, and that yoro reads or writes. */
typedef struct {
  VkImage color, depth;
  VkImageView color_view, depth_view;
  VkExtent2D size;
} Image;

static void make_plane(VkFormat format, VkImageUsageFlags usage, VkImageAspectFlags aspect, VkExtent2D size,
                       VkImage *image, VkImageView *view) {
  VkImageCreateInfo info;
  memset(&info, 0, sizeof info);
  info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = format;
  info.extent.width = size.width, info.extent.height = size.height, info.extent.depth = 1;
  info.mipLevels = info.arrayLayers = 1;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.usage = usage | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  check(vkCreateImage(device, &info, NULL, image), "vkCreateImage");
  VkMemoryRequirements needs;
  vkGetImageMemoryRequirements(device, *image, &needs);
  check(vkBindImageMemory(device, *image, allocate(needs, 0), 0), "vkBindImageMemory");
  VkImageViewCreateInfo view_info;
  memset(&view_info, 0, sizeof view_info);
  view_info.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
  view_info.image = *image;
  view_info.viewType = VK_IMAGE_VIEW_TYPE_2D;
  view_info.format = format;
  view_info.subresourceRange.aspectMask = aspect;
  view_info.subresourceRange.levelCount = view_info.subresourceRange.layerCount = 1;
  check(vkCreateImageView(device, &view_info, NULL, view), "vkCreateImageView");
}

static Image make_image(uint32_t width, uint32_t height) {
  Image image;
  image.size.width = width, image.size.height = height;
  make_plane(VK_FORMAT_R8G8B8A8_UNORM, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, VK_IMAGE_ASPECT_COLOR_BIT, image.size,
             &image.color, &image.color_view);
  make_plane(VK_FORMAT_D32_SFLOAT, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, VK_IMAGE_ASPECT_DEPTH_BIT, image.size,
             &image.depth, &image.depth_view);
  return image;
}

static VkShaderModule make_shader(const uint32_t *words, size_t bytes) {
  VkShaderModuleCreateInfo info = {VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, NULL, 0, bytes, words};
  VkShaderModule shader;
  check(vkCreateShaderModule(device, &info, NULL, &shader), "vkCreateShaderModule");
  return shader;
}

/* The scene: one triangle over the viewport, with projection and view as push constants. */
static VkPipelineLayout layout;
static VkPipeline scene;
static VkPipeline make_scene(void) {
  VkPushConstantRange range = {VK_SHADER_STAGE_FRAGMENT_BIT, 0, 128};
  VkPipelineLayoutCreateInfo layout_info = {VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO, NULL, 0, 0, NULL, 1, &range};
  check(vkCreatePipelineLayout(device, &layout_info, NULL, &layout), "vkCreatePipelineLayout");
  VkPipelineShaderStageCreateInfo stages[2];
  memset(stages, 0, sizeof stages);
  for (int i = 0; i < 2; ++i) {
    stages[i].sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    stages[i].stage = i ? VK_SHADER_STAGE_FRAGMENT_BIT : VK_SHADER_STAGE_VERTEX_BIT;
    stages[i].module = i ? make_shader(room_frag, sizeof room_frag) : make_shader(room_vert, sizeof room_vert);
    stages[i].pName = "main";
  }
  VkPipelineVertexInputStateCreateInfo vertices;
  VkPipelineInputAssemblyStateCreateInfo assembly;
  VkPipelineViewportStateCreateInfo viewport;
  VkPipelineRasterizationStateCreateInfo raster;
  VkPipelineMultisampleStateCreateInfo samples;
  VkPipelineDepthStencilStateCreateInfo depth;
  VkPipelineColorBlendAttachmentState attachment;
  VkPipelineColorBlendStateCreateInfo blend;
  VkPipelineDynamicStateCreateInfo dynamic;
  VkPipelineRenderingCreateInfo rendering;
  VkGraphicsPipelineCreateInfo info;
  memset(&vertices, 0, sizeof vertices), memset(&assembly, 0, sizeof assembly);
  memset(&viewport, 0, sizeof viewport), memset(&raster, 0, sizeof raster), memset(&samples, 0, sizeof samples);
  memset(&depth, 0, sizeof depth), memset(&attachment, 0, sizeof attachment), memset(&blend, 0, sizeof blend);
  memset(&dynamic, 0, sizeof dynamic), memset(&rendering, 0, sizeof rendering), memset(&info, 0, sizeof info);
  static const VkDynamicState states[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
  static const VkFormat format = VK_FORMAT_R8G8B8A8_UNORM;
  vertices.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO;
  assembly.sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO;
  assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  viewport.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO;
  viewport.viewportCount = viewport.scissorCount = 1;
  raster.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO;
  raster.lineWidth = 1.0f;
  samples.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO;
  samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
  depth.sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO;
  depth.depthTestEnable = depth.depthWriteEnable = VK_TRUE;
  depth.depthCompareOp = VK_COMPARE_OP_ALWAYS;
  attachment.colorWriteMask = 15;
  blend.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO;
  blend.attachmentCount = 1, blend.pAttachments = &attachment;
  dynamic.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO;
  dynamic.dynamicStateCount = 2, dynamic.pDynamicStates = states;
  rendering.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO;
  rendering.colorAttachmentCount = 1, rendering.pColorAttachmentFormats = &format;
  rendering.depthAttachmentFormat = VK_FORMAT_D32_SFLOAT;
  info.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO, info.pNext = &rendering;
  info.stageCount = 2, info.pStages = stages, info.pVertexInputState = &vertices;
  info.pInputAssemblyState = &assembly, info.pViewportState = &viewport, info.pRasterizationState = &raster;
  info.pMultisampleState = &samples, info.pDepthStencilState = &depth, info.pColorBlendState = &blend;
  info.pDynamicState = &dynamic, info.layout = layout;
  VkPipeline pipeline;
  check(vkCreateGraphicsPipelines(device, VK_NULL_HANDLE, 1, &info, NULL, &pipeline), "vkCreateGraphicsPipelines");
  return pipeline;
}

static void to_attachment(VkImage image, VkImageAspectFlags aspect, VkImageLayout new_layout) {
  VkImageMemoryBarrier barrier = {VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER, NULL, 0, VK_ACCESS_MEMORY_WRITE_BIT,
                                  VK_IMAGE_LAYOUT_UNDEFINED, new_layout, VK_QUEUE_FAMILY_IGNORED,
                                  VK_QUEUE_FAMILY_IGNORED, image, {aspect, 0, 1, 0, 1}};
  vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, VK_PIPELINE_STAGE_ALL_GRAPHICS_BIT, 0, 0, NULL, 0,
                       NULL, 1, &barrier);
}

/* Leaves colour and depth as attachments. */
static void engine_draw(const YoroView *view, const Image *image) {
  to_attachment(image->color, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
  to_attachment(image->depth, VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL);
  VkRenderingAttachmentInfo color, depth;
  VkRenderingInfo info;
  memset(&color, 0, sizeof color), memset(&depth, 0, sizeof depth), memset(&info, 0, sizeof info);
  color.sType = depth.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
  color.imageView = image->color_view, color.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  depth.imageView = image->depth_view, depth.imageLayout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
  color.storeOp = depth.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  color.loadOp = depth.loadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
  info.sType = VK_STRUCTURE_TYPE_RENDERING_INFO;
  info.renderArea.extent = image->size, info.layerCount = 1;
  info.colorAttachmentCount = 1, info.pColorAttachments = &color, info.pDepthAttachment = &depth;
  vkCmdBeginRendering(commands, &info);
  VkViewport viewport = {0, 0, (float)image->size.width, (float)image->size.height, 0, 1};
  vkCmdSetViewport(commands, 0, 1, &viewport);
  vkCmdSetScissor(commands, 0, 1, &info.renderArea);
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, scene);
  vkCmdPushConstants(commands, layout, VK_SHADER_STAGE_FRAGMENT_BIT, 0, 64, view->projection);
  vkCmdPushConstants(commands, layout, VK_SHADER_STAGE_FRAGMENT_BIT, 64, 64, view->view);
  vkCmdDraw(commands, 3, 1, 0, 0);
  vkCmdEndRendering(commands);
}

/* Copies SIZE x SIZE pixels of a colour attachment into a buffer. */
static void read_back(const Image *image, uint32_t x, uint32_t y, VkBuffer buffer, VkDeviceSize offset, uint32_t row) {
  VkImageMemoryBarrier barrier = {VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER, NULL, VK_ACCESS_MEMORY_WRITE_BIT,
                                  VK_ACCESS_TRANSFER_READ_BIT, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                  VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_QUEUE_FAMILY_IGNORED,
                                  VK_QUEUE_FAMILY_IGNORED, image->color, {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
  vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_GRAPHICS_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, NULL, 0,
                       NULL, 1, &barrier);
  VkBufferImageCopy copy = {offset, row, SIZE, {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1}, {(int)x, (int)y, 0}, {SIZE, SIZE, 1}};
  vkCmdCopyImageToBuffer(commands, image->color, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer, 1, &copy);
}

/* Makes an instance, the first device with queue family 0 and Vulkan 1.3's dynamic rendering, and begins a command
 * buffer. */
static void engine_start(void) {
  VkApplicationInfo application = {VK_STRUCTURE_TYPE_APPLICATION_INFO, NULL, "sample", 1, NULL, 0, VK_API_VERSION_1_3};
  VkInstanceCreateInfo instance_info = {VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, NULL, 0, &application, 0, NULL, 0, NULL};
  check(vkCreateInstance(&instance_info, NULL, &instance), "vkCreateInstance");
  uint32_t one = 1;
  vkEnumeratePhysicalDevices(instance, &one, &gpu);
  if (!one) check(VK_ERROR_INITIALIZATION_FAILED, "no device");
  float priority = 1.0f;
  VkDeviceQueueCreateInfo queue_info = {VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, NULL, 0, 0, 1, &priority};
  VkPhysicalDeviceVulkan13Features features;
  memset(&features, 0, sizeof features);
  features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
  features.dynamicRendering = VK_TRUE;
  VkDeviceCreateInfo device_info = {VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &features, 0, 1, &queue_info, 0, NULL, 0, NULL,
                                    NULL};
  check(vkCreateDevice(gpu, &device_info, NULL, &device), "vkCreateDevice");
  VkCommandPoolCreateInfo pool_info = {VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, NULL, 0, 0};
  VkCommandPool pool;
  check(vkCreateCommandPool(device, &pool_info, NULL, &pool), "vkCreateCommandPool");
  VkCommandBufferAllocateInfo commands_info = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, NULL, pool,
                                               VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
  check(vkAllocateCommandBuffers(device, &commands_info, &commands), "vkAllocateCommandBuffers");
  scene = make_scene();
  VkCommandBufferBeginInfo begin = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO, NULL, 0, NULL};
  check(vkBeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer");
}

/* Executes what was recorded. Returns three pictures of SIZE x SIZE pixels: the first image and a part of the second
 * one side by side, and below these the third one in rows of half the length. */
static const uint8_t *engine_finish(const Image *left, const Image *right, uint32_t x, uint32_t y, const Image *third) {
  VkBufferCreateInfo buffer_info = {VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, NULL, 0, 3 * 4 * SIZE * SIZE,
                                    VK_BUFFER_USAGE_TRANSFER_DST_BIT, VK_SHARING_MODE_EXCLUSIVE, 0, NULL};
  VkBuffer buffer;
  check(vkCreateBuffer(device, &buffer_info, NULL, &buffer), "vkCreateBuffer");
  VkMemoryRequirements needs;
  vkGetBufferMemoryRequirements(device, buffer, &needs);
  VkDeviceMemory memory =
      allocate(needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
  vkBindBufferMemory(device, buffer, memory, 0);
  read_back(left, 0, 0, buffer, 0, 2 * SIZE);
  read_back(right, x, y, buffer, 4 * SIZE, 2 * SIZE);
  read_back(third, 0, 0, buffer, 2 * 4 * SIZE * SIZE, SIZE);
  vkEndCommandBuffer(commands);
  VkQueue queue;
  vkGetDeviceQueue(device, 0, 0, &queue);
  VkSubmitInfo submit = {VK_STRUCTURE_TYPE_SUBMIT_INFO, NULL, 0, NULL, NULL, 1, &commands, 0, NULL};
  check(vkQueueSubmit(queue, 1, &submit, VK_NULL_HANDLE), "vkQueueSubmit");
  check(vkDeviceWaitIdle(device), "vkDeviceWaitIdle");

  void *mapped = NULL;
  check(vkMapMemory(device, memory, 0, VK_WHOLE_SIZE, 0, &mapped), "vkMapMemory");
  return (const uint8_t *)mapped;
}

#endif
