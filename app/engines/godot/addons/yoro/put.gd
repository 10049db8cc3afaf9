## Draws the eyes with their depth into the buffers of the camera that has this effect, before its transparent objects.
## A viewport with two views gets both eyes.
@tool
class_name YoroPut
extends CompositorEffect

var synthesis: YoroSynthesis
## The eye that a viewport with one view gets: 0 left, 1 right.
var eye := 0
## One of [enum YoroCamera3D.DebugView].
var debug_view := 0
## Shows the rendered eye to both eyes.
var same_image := false


func _init(of: YoroSynthesis) -> void:
	synthesis = of
	effect_callback_type = EFFECT_CALLBACK_TYPE_PRE_TRANSPARENT


func _render_callback(_type: int, data: RenderData) -> void:
	var buffers := data.get_render_scene_buffers() as RenderSceneBuffersRD
	if buffers == null or not synthesis.ready:
		return
	var views := synthesis.views
	var multisampled := buffers.get_msaa_3d() != RenderingServer.VIEWPORT_MSAA_DISABLED
	var two := buffers.get_view_count() > 1
	for view in buffers.get_view_count():
		var is_rendered := (view if two else eye) == views.rendered or same_image
		if debug_view == YoroCamera3D.DebugView.SYNTHESIZED:
			is_rendered = false
		var push := PackedByteArray()
		push.resize(32)
		var corner := Vector2(views.crop) if is_rendered else Vector2.ZERO
		var pitch := views.covered * Vector2(views.eye_size) / Vector2(buffers.get_internal_size())
		push.encode_float(0, corner.x)
		push.encode_float(4, corner.y)
		push.encode_float(8, pitch.x)
		push.encode_float(12, pitch.y)
		push.encode_s32(16, 0 if is_rendered and debug_view == YoroCamera3D.DebugView.HOLES else debug_view)
		# The disparity at depth 1, as a share of a tenth of the image's width.
		push.encode_float(20, views.max_disparity / (0.1 * views.eye_size.x))
		var color := synthesis.rendered_color if is_rendered else synthesis.synthesized_color
		var depth := synthesis.rendered_depth if is_rendered else synthesis.synthesized_depth
		var map := synthesis.source_map if synthesis.source_map.is_valid() else synthesis._tiles
		# Tested against the depth of what is already drawn. Depth is 1 at the near plane.
		synthesis.passes.draw("put", [buffers.get_color_layer(view, multisampled), buffers.get_depth_layer(view, multisampled)],
				[depth, color, map], push, RenderingDevice.COMPARE_OP_GREATER_OR_EQUAL)
