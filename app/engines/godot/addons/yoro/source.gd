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
## The viewport that draws what holes of the synthesized eye show, in the level of all pixels.
var beyond: YoroEye
## True if that is drawn, and holes are not filled.
var opens := false
var passes := YoroPasses.new()
## Puts them into that eye.
var holes := YoroHoles.new(passes)
var _mask := YoroMask.new()


func _init() -> void:
	wide = YoroEye.new(YoroSynthesis.new(passes))
	inset = YoroEye.new(YoroSynthesis.new(passes))
	# Screen-space light would come from what is not drawn.
	beyond = YoroEye.new(holes, {ssao_enabled = false, ssil_enabled = false, ssr_enabled = false})
	for eye: YoroEye in [wide, inset, beyond]:
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
	return drawn().all(func(eye: YoroEye) -> bool: return eye.synthesis.ready) and (holes.ready or not opens)


## Draws [param of] from [param at] in this frame, with the settings of the camera [param like] and of the viewport
## [param shown]. [param effects] are drawn before the synthesis.
func draw(of: YoroLevels, at: Transform3D, like: YoroCamera3D, shown: Viewport, effects: Array[CompositorEffect]) -> void:
	levels = of
	opens = like.renders_holes()
	if levels.inset_image == levels.inset:
		_mask.rest()
	if levels.inset == null:
		inset.rest()
	for eye in drawn():
		var views := levels.inset if eye == inset else levels.wide
		var image := levels.inset_image if eye == inset else levels.wide
		var part := levels.inset_part if eye == inset else Rect2i(Vector2i.ZERO, levels.wide.size)
		eye.synthesis.map = like.debug_view == YoroCamera3D.DebugView.HOLES
		eye.synthesis.open_map = RID()
		eye.follow(like, shown, effects, _mask.layer() if image != views else 0, levels.whole.pitch / views.pitch)
		if image != views:
			_mask.follow(eye.world_3d, part, image.size)
		eye.synthesis.views = views
		eye.synthesis.part = part
		eye.synthesis.image_size = image.size
		eye.draw(image.size, image.frustum, at, like.near, like.far)
	if opens:
		_draw_beyond(at, like, shown, effects)
	else:
		holes.rest()
		beyond.rest()


## Draws what holes of the synthesized eye show, in the level of all pixels.
func _draw_beyond(at: Transform3D, like: YoroCamera3D, shown: Viewport, effects: Array[CompositorEffect]) -> void:
	var synthesis: YoroSynthesis = drawn().back().synthesis
	var image := levels.inset_image if levels.inset != null else levels.whole
	var corner := levels.places[1 - levels.whole.rendered].position if image != synthesis.views else Vector2i.ZERO
	var layer := holes.follow(synthesis, corner, image.other_size, like.get_world_3d())
	beyond.follow(like, shown, effects, layer, 1.0)
	beyond.draw(image.other_size, image.other_frustum, at.translated_local(image.apart), like.near, like.far)


## Draws nothing.
func rest() -> void:
	_mask.rest()
	holes.rest()
	for eye: YoroEye in [wide, inset, beyond]:
		eye.rest()
