## The rendered eye, from which the other one is synthesized: a viewport for each level.
@tool
class_name YoroSource
extends Node

## The levels of the frame.
var levels: YoroLevels
## The viewport that fills the eye.
var wide: YoroEye
## The viewport around the gaze, which is drawn only if there is such a level.
var inset: YoroEye
var passes := YoroPasses.new()
var _mask := YoroMask.new()


func _init() -> void:
	wide = YoroEye.new(passes)
	inset = YoroEye.new(passes)
	for eye: YoroEye in [wide, inset]:
		add_child(eye)
		eye.rest()


## Returns the levels that are drawn, the wide one first.
func drawn() -> Array[YoroEye]:
	var eyes: Array[YoroEye] = [wide]
	if levels != null and levels.inset != null:
		eyes.append(inset)
	return eyes


## Returns whether all textures show a frame that was drawn with [member levels].
func is_ready() -> bool:
	return drawn().all(func(eye: YoroEye) -> bool: return eye.synthesis.ready)


## Draws [param of] from [param at] in this frame, with the settings of the camera [param like] and of the viewport
## [param shown]. [param effects] are drawn before the synthesis.
func draw(of: YoroLevels, at: Transform3D, like: YoroCamera3D, shown: Viewport, effects: Array[CompositorEffect]) -> void:
	levels = of
	if levels.inset_image == levels.inset:
		_mask.rest()
	if levels.inset == null:
		inset.rest()
	for eye in drawn():
		var views := levels.inset if eye == inset else levels.wide
		var image := levels.inset_image if eye == inset else levels.wide
		var part := levels.inset_part if eye == inset else Rect2i(Vector2i.ZERO, levels.wide.size)
		eye.synthesis.map = like.debug_view == YoroCamera3D.DebugView.HOLES
		eye.follow(like, shown, effects, _mask.layer() if image != views else 0)
		if image != views:
			_mask.follow(eye.world_3d, part, image.size)
		# Levels of detail are those of the eye's own pixels in each level. The viewport has half of these.
		var threshold := shown.mesh_lod_threshold * 0.5 * levels.whole.pitch / views.pitch
		if eye.mesh_lod_threshold != threshold:
			eye.mesh_lod_threshold = threshold
		eye.synthesis.views = views
		eye.synthesis.part = part
		eye.synthesis.image_size = image.size
		eye.draw(image, at, like.near, like.far)


## Draws nothing.
func rest() -> void:
	_mask.rest()
	wide.rest()
	inset.rest()
