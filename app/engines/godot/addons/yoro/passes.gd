## The GPU side of the add-on: shaders, samplers, pipelines, and drawing a pass. To be used on the render thread.
@tool
class_name YoroPasses
extends RefCounted

const _SHADERS: PackedStringArray = ["tiles", "spans", "march", "part", "put", "grid"]
## The bindings of the textures that are interpolated; all others are read texel by texel.
const _INTERPOLATED: Array[int] = [1, 4]

var device: RenderingDevice
var _files := {}
var _shaders := {}
var _samplers: Array[RID] = []
var _pipelines := {}


func _init() -> void:
	device = RenderingServer.get_rendering_device()
	# Not preloaded: a project that is opened for the first time imports the shaders after it has read its scripts.
	for name in _SHADERS:
		_files[name] = load("res://addons/yoro/shaders/%s.glsl" % name)
	RenderingServer.call_on_render_thread(_make)


func _notification(what: int) -> void:
	if what == NOTIFICATION_PREDELETE:
		# Pipelines and uniform sets are freed with what they are made of.
		free_all(device, _samplers + Array(_shaders.values(), TYPE_RID, &"", null))


## Frees GPU resources once the render thread no longer draws with them.
static func free_all(from: RenderingDevice, ids: Array[RID]) -> void:
	RenderingServer.call_on_render_thread(func() -> void:
		for id in ids:
			if id.is_valid():
				from.free_rid(id))


func _make() -> void:
	for name: String in _files:
		var file: RDShaderFile = _files[name]
		for version in file.get_version_list():
			var key := name if version == &"" else "%s_%s" % [name, version]
			_shaders[key] = device.shader_create_from_spirv(file.get_spirv(version), "yoro " + key)
	for filter in [RenderingDevice.SAMPLER_FILTER_NEAREST, RenderingDevice.SAMPLER_FILTER_LINEAR]:
		var state := RDSamplerState.new()
		state.min_filter = filter
		state.mag_filter = filter
		state.repeat_u = RenderingDevice.SAMPLER_REPEAT_MODE_CLAMP_TO_EDGE
		state.repeat_v = RenderingDevice.SAMPLER_REPEAT_MODE_CLAMP_TO_EDGE
		_samplers.append(device.sampler_create(state))


## Returns a new texture that can be drawn to and sampled.
func texture(size: Vector2i, format: RenderingDevice.DataFormat) -> RID:
	var attachment := RenderingDevice.TEXTURE_USAGE_COLOR_ATTACHMENT_BIT
	if format == RenderingDevice.DATA_FORMAT_D32_SFLOAT:
		attachment = RenderingDevice.TEXTURE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT
	var f := RDTextureFormat.new()
	f.width = size.x
	f.height = size.y
	f.format = format
	f.usage_bits = attachment | RenderingDevice.TEXTURE_USAGE_SAMPLING_BIT | RenderingDevice.TEXTURE_USAGE_CAN_COPY_FROM_BIT
	return device.texture_create(f, RDTextureView.new())


## Draws a pass over the whole of [param targets], the last of which is depth if [param compare] is not the default, and 1
## at first if [param clears_depth] is true.
func draw(shader: String, targets: Array[RID], textures: Array[RID], push: PackedByteArray,
		compare := RenderingDevice.COMPARE_OP_NEVER, clears_depth := false) -> void:
	var framebuffer := FramebufferCacheRD.get_cache_multipass(targets, [], 1)
	var list := device.draw_list_begin(framebuffer, RenderingDevice.DRAW_CLEAR_DEPTH if clears_depth else RenderingDevice.DRAW_DEFAULT_ALL)
	device.draw_list_bind_render_pipeline(list, _pipeline(shader, device.framebuffer_get_format(framebuffer), targets.size(), compare))
	device.draw_list_bind_uniform_set(list, _bound(shader, textures), 0)
	device.draw_list_set_push_constant(list, push, push.size())
	device.draw_list_draw(list, false, 1, 3)
	device.draw_list_end()


func _pipeline(shader: String, format: int, targets: int, compare: RenderingDevice.CompareOperator) -> RID:
	var known: Dictionary = _pipelines.get_or_add(shader, {})
	if not known.has(format):
		var has_depth := compare != RenderingDevice.COMPARE_OP_NEVER
		var multisample := RDPipelineMultisampleState.new()
		multisample.sample_count = device.framebuffer_format_get_texture_samples(format)
		var depth := RDPipelineDepthStencilState.new()
		depth.enable_depth_test = has_depth
		depth.enable_depth_write = has_depth
		depth.depth_compare_operator = compare
		var blend := RDPipelineColorBlendState.new()
		for i in targets - int(has_depth):
			blend.attachments.append(RDPipelineColorBlendStateAttachment.new())
		known[format] = device.render_pipeline_create(_shaders[shader], format, -1, RenderingDevice.RENDER_PRIMITIVE_TRIANGLES,
				RDPipelineRasterizationState.new(), multisample, depth, blend)
	return known[format]


func _bound(shader: String, textures: Array[RID]) -> RID:
	var uniforms: Array[RDUniform] = []
	for i in textures.size():
		var uniform := RDUniform.new()
		uniform.uniform_type = RenderingDevice.UNIFORM_TYPE_SAMPLER_WITH_TEXTURE
		uniform.binding = i
		uniform.add_id(_samplers[int(i in _INTERPOLATED)])
		uniform.add_id(textures[i])
		uniforms.append(uniform)
	return UniformSetCacheRD.get_cache(_shaders[shader], 0, uniforms)
