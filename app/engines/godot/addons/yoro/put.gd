## Draws the eyes with their depth into the buffers of the camera that has this effect, before its transparent objects.
## A viewport with two views gets both eyes.
@tool
class_name YoroPut
extends CompositorEffect

var source: YoroSource
## The eye that a viewport with one view gets: 0 left, 1 right.
var eye := 0
## One of [enum YoroCamera3D.DebugView].
var debug_view := 0
## Shows the rendered eye to both eyes.
var same_image := false


func _init(of: YoroSource) -> void:
	source = of
	effect_callback_type = EFFECT_CALLBACK_TYPE_PRE_TRANSPARENT


func _render_callback(_type: int, data: RenderData) -> void:
	var buffers := data.get_render_scene_buffers() as RenderSceneBuffersRD
	if buffers == null or not source.is_ready():
		return
	var multisampled := buffers.get_msaa_3d() != RenderingServer.VIEWPORT_MSAA_DISABLED
	var two := buffers.get_view_count() > 1
	var whole := source.levels.whole
	for view in buffers.get_view_count():
		var shown := view if two else eye
		if same_image:
			shown = whole.rendered
		if debug_view == YoroCamera3D.DebugView.SYNTHESIZED:
			shown = 1 - whole.rendered
		var is_rendered := shown == whole.rendered
		var pitch := whole.covered * Vector2(whole.eye_size) / Vector2(buffers.get_internal_size())
		var debug := 0 if is_rendered and debug_view == YoroCamera3D.DebugView.HOLES else debug_view
		# The disparity at depth 1, as a share of a tenth of the image's width.
		var push := PackedFloat32Array([pitch.x, pitch.y, debug, whole.max_disparity / (0.1 * whole.eye_size.x)])
		push.append_array(_places(shown))
		push.resize(ceili(push.size() / 4.0) * 4)
		var textures: Array[RID] = []
		for level in source.drawn():
			textures.append_array(level.synthesis.images(is_rendered))
		# Tested against the depth of what is already drawn. Depth is 1 at the near plane.
		source.passes.draw("put_whole" if source.levels.inset == null else "put_levels",
				[buffers.get_color_layer(view, multisampled), buffers.get_depth_layer(view, multisampled)],
				textures, push.to_byte_array(), RenderingDevice.COMPARE_OP_GREATER_OR_EQUAL)


## Returns where an eye lies in its images: what [code]put.glsl[/code] calls [code]corner[/code], and with an inset all
## that follows.
func _places(of: int) -> PackedFloat32Array:
	var levels := source.levels
	var inset := levels.inset
	var is_rendered := of == levels.whole.rendered
	if inset == null:
		var crop := levels.whole.crop if is_rendered else Vector2i.ZERO
		return PackedFloat32Array([crop.x, crop.y])
	var corner := levels.wide_corners[of]
	var place := levels.places[of]
	var inset_corner := (inset.crop if is_rendered else Vector2i.ZERO) - place.position
	# With rendered holes, the other eye's inset is complete.
	var column := Vector3(0.0, 0.5, 0.0) if is_rendered or source.opens else inset.source_column
	return PackedFloat32Array([corner.x, corner.y, place.position.x, place.position.y, place.end.x, place.end.y, inset_corner.x, inset_corner.y,
			column.x, column.y, column.z, levels.whole.pitch / levels.wide.pitch, levels.wide.max_disparity])
