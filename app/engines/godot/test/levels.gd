## Saves what levels are compared by: the fovea, and the rest of each eye.
class_name TestLevels

const EYES: PackedStringArray = ["left", "right"]


## Takes pictures of both eyes with [param take], and saves parts of them in [param folder]: as [code]fovea[/code],
## [code]fovea-holes[/code] and [code]whole[/code] what the inset shows, with levels, with rendered holes and without levels; as [code]rest[/code] all else, against an eye
## that is rendered with the same levels.
static func save(camera: YoroCamera3D, gaze: Vector3, take: Callable, folder: String) -> void:
	camera.gaze = gaze
	camera.mode = YoroCamera3D.Mode.BOTH_VIEWS
	var godots: Array[Image] = await take.call()
	camera.mode = YoroCamera3D.Mode.ONE_VIEW
	camera.foveation = YoroCamera3D.Foveation.OFF
	var whole: Array[Image] = await take.call()
	camera.foveation = YoroCamera3D.Foveation.MEDIUM
	camera.holes = YoroCamera3D.Holes.RENDERED
	var open: Array[Image] = await take.call()
	camera.holes = YoroCamera3D.Holes.PROJECT
	var levels: Array[Image] = await take.call()
	var split := camera.source().levels
	var counted := camera.source().drawn().map(func(eye: YoroEye) -> Vector2i: return eye.synthesis.views.size)
	print("levels: %s of %s pixels rendered for eyes of %s, gaze %s" % [counted, split.whole.size, split.whole.eye_size, gaze])
	camera.dominant_eye = YoroCamera3D.Eye.LEFT
	var like: Array[Image] = await take.call()
	camera.dominant_eye = YoroCamera3D.Eye.RIGHT
	camera.foveation = YoroCamera3D.Foveation.OFF
	camera.gaze = Vector3.ZERO
	for eye in 2:
		var scale := Vector2(levels[eye].get_size()) / (split.whole.covered * Vector2(split.whole.eye_size))
		var place := Rect2(split.places[eye])
		var inside := Rect2i(Rect2(place.position * scale, place.size * scale).grow(-1.0))
		var parts := {"fovea-both_views": godots, "fovea-holes-one_view": open, "fovea-one_view": levels, "whole-one_view": whole}
		for name: String in parts:
			var part: Image = parts[name][eye].get_region(inside)
			part.save_png("%s/%s-%s.png" % [folder, name, EYES[eye]])
			part.save_png("%s/rendered-%s-%s.png" % [folder, name, EYES[eye]])
	for rest: Array in [[levels[0], "one_view", 0], [like[0], "both_views", 0], [levels[1], "both_views", 1]]:
		var place := Rect2(split.places[rest[2]])
		var scale := Vector2(rest[0].get_size()) / (split.whole.covered * Vector2(split.whole.eye_size))
		rest[0].save_png("%s/levels-%s-%s.png" % [folder, rest[1], EYES[rest[2]]])
		rest[0].fill_rect(Rect2i(Rect2(place.position * scale, place.size * scale).grow(2.0)), Color.BLACK)
		rest[0].save_png("%s/rest-%s-%s.png" % [folder, rest[1], EYES[rest[2]]])
