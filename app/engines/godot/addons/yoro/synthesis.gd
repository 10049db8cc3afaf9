## Synthesizes the other eye from the colour and depth of the camera that has this effect, after all that the camera
## draws.
@tool
class_name YoroSynthesis
extends CompositorEffect

## Also makes [member source_map], which marks holes.
var map := false
## If this is a texture of [member YoroViews.eye_size], holes and silhouettes stay open, and it becomes 1 there.
var open_map: RID
## The views of the frame, and the part of the drawn image that is theirs, to be set before it is drawn.
var views: YoroViews
var part: Rect2i
var image_size: Vector2i
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
var _part_color: RID
var _part_depth: RID
var _allocated_for: Array = []


func _init(with: YoroPasses) -> void:
	passes = with
	effect_callback_type = EFFECT_CALLBACK_TYPE_POST_TRANSPARENT
	access_resolved_color = true


func _notification(what: int) -> void:
	if what == NOTIFICATION_PREDELETE and passes != null:
		# A static function, since an object can no longer call its own methods while it is deleted.
		YoroPasses.free_all(passes.device, [synthesized_color, synthesized_depth, source_map, _tiles, _spans, _part_color, _part_depth])


## Returns the depth, the colour and the map of the rendered eye, or of the synthesized one. Where there is no map, some
## texture like it stands for it.
func images(rendered: bool) -> Array[RID]:
	var map_of_holes := source_map if source_map.is_valid() else _tiles
	if rendered:
		return [rendered_depth, rendered_color, map_of_holes]
	return [synthesized_depth, synthesized_color, map_of_holes]


## Creates the textures anew if their sizes have changed, which follow the viewport's.
func _allocate(format: RenderingDevice.DataFormat, multisampled: bool, cropped: bool) -> void:
	var want := [views.size, views.eye_size, format, multisampled, cropped, map]
	if want == _allocated_for:
		return
	YoroPasses.free_all(passes.device, [synthesized_color, synthesized_depth, source_map, _tiles, _spans, _part_color, _part_depth])
	_allocated_for = want
	_tiles = passes.texture(views.tile_map, RenderingDevice.DATA_FORMAT_R32G32B32A32_UINT)
	_spans = passes.texture(views.span_map, RenderingDevice.DATA_FORMAT_R32G32B32A32_UINT)
	synthesized_color = passes.texture(views.eye_size, format)
	synthesized_depth = passes.texture(views.eye_size, RenderingDevice.DATA_FORMAT_D32_SFLOAT)
	_part_color = passes.texture(views.size, format) if cropped else RID()
	_part_depth = passes.texture(views.size, RenderingDevice.DATA_FORMAT_R32_SFLOAT) if multisampled or cropped else RID()
	source_map = passes.texture(views.eye_size, RenderingDevice.DATA_FORMAT_R32_UINT) if map else RID()


func _render_callback(_type: int, data: RenderData) -> void:
	var buffers := data.get_render_scene_buffers() as RenderSceneBuffersRD
	ready = buffers != null and views != null and buffers.get_internal_size() == image_size
	if not ready:
		return
	pose = data.get_render_scene_data().get_cam_transform()
	rendered_color = buffers.get_texture_slice("render_buffers", "color", 0, 0, 1, 1)
	rendered_depth = buffers.get_depth_layer(0, false)
	var multisampled := buffers.get_msaa_3d() != RenderingServer.VIEWPORT_MSAA_DISABLED
	var cropped := part.size != image_size
	_allocate(passes.device.texture_get_format(rendered_color).format, multisampled, cropped)
	passes.device.draw_command_begin_label("yoro", Color.WHITE)
	if multisampled or cropped:
		# Colour is already resolved. Depth becomes that of the nearest sample, since averages belong to no surface.
		var depth := buffers.get_depth_layer(0, multisampled)
		var samples := 1 << passes.device.texture_get_format(depth).samples
		var push := PackedInt32Array([part.position.x, part.position.y, samples, 0]).to_byte_array()
		var targets: Array[RID] = [_part_depth]
		var textures: Array[RID] = [depth]
		if cropped:
			targets.append(_part_color)
			textures.append(rendered_color)
			rendered_color = _part_color
		passes.draw("part_nearest" if not cropped else "part_both" if multisampled else "part_single", targets, textures, push)
		rendered_depth = _part_depth
	passes.draw("tiles", [_tiles], [rendered_depth, rendered_color], views.uniforms)
	passes.draw("spans", [_spans], [rendered_depth, rendered_color, _tiles], views.uniforms)
	var eye: Array[RID] = [synthesized_color, synthesized_depth]
	if map:
		eye.insert(1, source_map)
	var opens := open_map.is_valid()
	passes.draw("march_map" if map else "march_open" if opens else "march_depth", eye, [rendered_depth, rendered_color, _tiles, _spans],
			views.uniforms, RenderingDevice.COMPARE_OP_ALWAYS, opens)
	if opens:
		var push := PackedInt32Array([0, 0, 1, 0]).to_byte_array()
		passes.draw("part_depth", [open_map], [synthesized_depth], push)
	passes.device.draw_command_end_label()
