## Completes the synthesized eye. It belongs to the camera that draws the scene where that eye is open, and copies what it
## drew into the eye.
@tool
class_name YoroHoles
extends CompositorEffect

## The synthesis that leaves holes open, and the size of the drawn image, to be set before it is drawn.
var synthesis: YoroSynthesis
var image_size: Vector2i
## The pose of the camera with which the holes were drawn.
var pose: Transform3D
## True if the holes of a frame are complete.
var ready := false

var _passes: YoroPasses
## 1 where the eye is open.
var _map: RID
var _map_size: Vector2i
## The same for [member _mask].
var _texture := Texture2DRD.new()
var _mask: YoroMask
## The place of the synthesized eye in the drawn image.
var _corner: Vector2i


func _init(passes: YoroPasses) -> void:
	_passes = passes
	effect_callback_type = EFFECT_CALLBACK_TYPE_POST_TRANSPARENT
	access_resolved_color = true


func _notification(what: int) -> void:
	if what == NOTIFICATION_PREDELETE and _passes != null:
		_texture.texture_rd_rid = RID()
		YoroPasses.free_all(_passes.device, [_map])


## Leaves holes of [param of] open. Its eye lies at [param corner] of the image of [param size] that is drawn of a world.
## Returns the layer that the camera must show.
func follow(of: YoroSynthesis, corner: Vector2i, size: Vector2i, world: World3D) -> int:
	if _mask == null:
		_mask = YoroMask.new(_texture)
	if _map_size != of.views.eye_size:
		var old := _map
		_map_size = of.views.eye_size
		_map = _passes.texture(_map_size, RenderingDevice.DATA_FORMAT_R8_UNORM)
		_texture.texture_rd_rid = _map
		YoroPasses.free_all(_passes.device, [old])
	of.open_map = _map
	synthesis = of
	image_size = size
	_corner = corner
	_mask.follow(world, Rect2i(), size, corner)
	return _mask.layer()


## Hides the mask.
func rest() -> void:
	if _mask != null:
		_mask.rest()


func _render_callback(_type: int, data: RenderData) -> void:
	var buffers := data.get_render_scene_buffers() as RenderSceneBuffersRD
	ready = buffers != null and synthesis != null and synthesis.ready and buffers.get_internal_size() == image_size
	if not ready:
		return
	pose = data.get_render_scene_data().get_cam_transform()
	var multisampled := buffers.get_msaa_3d() != RenderingServer.VIEWPORT_MSAA_DISABLED
	var depth := buffers.get_depth_layer(0, multisampled)
	var samples := 1 << _passes.device.texture_get_format(depth).samples
	var push := PackedInt32Array([_corner.x, _corner.y, samples, 0]).to_byte_array()
	_passes.draw("part_holes_nearest" if multisampled else "part_holes", [synthesis.synthesized_color, synthesis.synthesized_depth],
			[depth, buffers.get_texture_slice("render_buffers", "color", 0, 0, 1, 1)], push, RenderingDevice.COMPARE_OP_ALWAYS)
