## Synthesizes the other eye from the colour and depth of the camera that has this effect, after all that the camera
## draws.
@tool
class_name YoroSynthesis
extends CompositorEffect

## Also makes [member source_map], which marks holes.
var map := false
## The views of the frame, to be set before it is drawn.
var views: YoroViews
var passes: YoroPasses
## The rendered eye as it was drawn, in [member YoroViews.size], and the other eye, in [member YoroViews.eye_size].
var rendered_color: RID
var rendered_depth: RID
var synthesized_color: RID
var synthesized_depth: RID
var source_map: RID
## The pose of the camera with which the eye was drawn.
var pose: Transform3D
## True if the textures show a frame that was drawn with [member views].
var ready := false

var _tiles: RID
var _spans: RID
var _nearest: RID
var _allocated_for: Array = []


func _init(with: YoroPasses) -> void:
	passes = with
	effect_callback_type = EFFECT_CALLBACK_TYPE_POST_TRANSPARENT
	access_resolved_color = true


func _notification(what: int) -> void:
	if what == NOTIFICATION_PREDELETE and passes != null:
		# A static function, since an object can no longer call its own methods while it is deleted.
		YoroPasses.free_all(passes.device, [synthesized_color, synthesized_depth, source_map, _tiles, _spans, _nearest])


## Returns the depth, the colour and the map of the rendered eye, or of the synthesized one. Where there is no map, some
## texture like it stands for it.
func images(rendered: bool) -> Array[RID]:
	var map_of_holes := source_map if source_map.is_valid() else _tiles
	if rendered:
		return [rendered_depth, rendered_color, map_of_holes]
	return [synthesized_depth, synthesized_color, map_of_holes]


## Creates the textures anew if their sizes have changed, which follow the viewport's.
func _allocate(format: RenderingDevice.DataFormat, multisampled: bool) -> void:
	var want := [views.size, views.eye_size, format, multisampled, map]
	if want == _allocated_for:
		return
	YoroPasses.free_all(passes.device, [synthesized_color, synthesized_depth, source_map, _tiles, _spans, _nearest])
	_allocated_for = want
	_tiles = passes.texture(views.tile_map, RenderingDevice.DATA_FORMAT_R32G32B32A32_UINT)
	_spans = passes.texture(views.span_map, RenderingDevice.DATA_FORMAT_R32G32B32A32_UINT)
	synthesized_color = passes.texture(views.eye_size, format)
	synthesized_depth = passes.texture(views.eye_size, RenderingDevice.DATA_FORMAT_D32_SFLOAT)
	_nearest = passes.texture(views.size, RenderingDevice.DATA_FORMAT_R32_SFLOAT) if multisampled else RID()
	source_map = passes.texture(views.eye_size, RenderingDevice.DATA_FORMAT_R32_UINT) if map else RID()


func _render_callback(_type: int, data: RenderData) -> void:
	var buffers := data.get_render_scene_buffers() as RenderSceneBuffersRD
	ready = buffers != null and views != null and buffers.get_internal_size() == views.size
	if not ready:
		return
	pose = data.get_render_scene_data().get_cam_transform()
	rendered_color = buffers.get_texture_slice("render_buffers", "color", 0, 0, 1, 1)
	rendered_depth = buffers.get_depth_layer(0, false)
	var multisampled := buffers.get_msaa_3d() != RenderingServer.VIEWPORT_MSAA_DISABLED
	_allocate(passes.device.texture_get_format(rendered_color).format, multisampled)
	passes.device.draw_command_begin_label("yoro", Color.WHITE)
	if multisampled:
		# Colour is already resolved. Depth becomes that of the nearest sample, since averages belong to no surface.
		var samples := buffers.get_depth_layer(0, true)
		var push := PackedByteArray()
		push.resize(16)
		push.encode_s32(0, 1 << passes.device.texture_get_format(samples).samples)
		passes.draw("nearest", [_nearest], [samples], push)
		rendered_depth = _nearest
	passes.draw("tiles", [_tiles], [rendered_depth, rendered_color], views.uniforms)
	passes.draw("spans", [_spans], [rendered_depth, rendered_color, _tiles], views.uniforms)
	var targets: Array[RID] = [synthesized_color, synthesized_depth]
	if map:
		targets.insert(1, source_map)
	passes.draw("march_map" if map else "march_depth", targets, [rendered_depth, rendered_color, _tiles, _spans],
			views.uniforms, RenderingDevice.COMPARE_OP_ALWAYS)
	passes.device.draw_command_end_label()
