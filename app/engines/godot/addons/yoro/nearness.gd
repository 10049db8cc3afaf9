## Measures which share of the view is near, at the points of a coarse grid. The result is read some frames later,
## without waiting.
@tool
class_name YoroNearness
extends CompositorEffect

## The number of points in a row and in a column.
const POINTS := 16

## True if one eye is synthesized in this frame; otherwise Godot renders both.
var synthesized := true:
	set(value):
		synthesized = value
		# The synthesis resolves its own depth.
		access_resolved_depth = not value
## Surfaces of at least this depth are near. Depth is 1 at the near plane.
var depth_limit := 1.0
## The share of the points that are near, by the latest result.
var share := 0.0

var _synthesis: YoroSynthesis
var _grid: RID
var _is_read := false


func _init(of: YoroSynthesis) -> void:
	_synthesis = of
	effect_callback_type = EFFECT_CALLBACK_TYPE_PRE_TRANSPARENT


func _notification(what: int) -> void:
	if what == NOTIFICATION_PREDELETE and _synthesis != null:
		YoroPasses.free_all(_synthesis.passes.device, [_grid])


## Returns the depth at [param distance] from the camera's plane.
static func depth_at(distance: float, near: float, far: float) -> float:
	return near * (far - distance) / (distance * (far - near))


func _render_callback(_type: int, data: RenderData) -> void:
	var buffers := data.get_render_scene_buffers() as RenderSceneBuffersRD
	if buffers == null or _is_read or (synthesized and not _synthesis.ready):
		return
	var passes := _synthesis.passes
	if not _grid.is_valid():
		_grid = passes.texture(Vector2i.ONE * POINTS, RenderingDevice.DATA_FORMAT_R32_SFLOAT)
	var size := _synthesis.views.size if synthesized else buffers.get_internal_size()
	var push := PackedByteArray()
	push.resize(16)
	push.encode_float(0, float(size.x) / POINTS)
	push.encode_float(4, float(size.y) / POINTS)
	passes.draw("grid", [_grid], [_synthesis.rendered_depth if synthesized else buffers.get_depth_layer(0, false)], push)
	_is_read = passes.device.texture_get_data_async(_grid, 0, _count) == OK


## Counts the near points. As a method of this object, it does not keep the object alive: a read that is still pending
## when the program ends is dropped.
func _count(bytes: PackedByteArray) -> void:
	_is_read = false
	var count := 0
	for depth in bytes.to_float32_array():
		count += int(depth > depth_limit)
	share = float(count) / (POINTS * POINTS)
