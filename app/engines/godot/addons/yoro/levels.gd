## What is rendered at which density: the whole eye, or a wide level of few pixels and an inset of all of them around the
## gaze. These are the laws of [code]yoro::eyes::foveation[/code] of yoro's library.
@tool
class_name YoroLevels
extends RefCounted

## The angle in degrees around the gaze that has all pixels, and the pixels along each axis for each of an eye's beyond
## it: off, low, medium, high.
const _STRENGTHS: Array[Vector2] = [Vector2.ZERO, Vector2(30.0, 1.0 / 2.0), Vector2(20.0, 1.0 / 2.0), Vector2(20.0, 1.0 / 3.0)]
## From this distance in metres on, the other eye's inset is complete. Nearer surfaces leave holes at its border, which
## show the wide level.
const _NEAREST := 0.5

## Why the other eye cannot be synthesized, in one sentence; nothing else is set then. It is empty if the eye can be.
var trouble := ""
## The views with all pixels, whose images are those that are shown.
var whole: YoroViews
## The views that fill the eyes' images: [member whole], or with fewer pixels if there is an inset.
var wide: YoroViews
## The views around the gaze, or null.
var inset: YoroViews
## The views whose image the inset is a part of: [member inset], or [member whole] if the gaze is not straight ahead, since
## Godot fits a sun's shadow maps to views that are symmetric.
var inset_image: YoroViews
## The place of the inset's image in that of [member inset_image].
var inset_part: Rect2i
## The place of each eye's inset in [member whole], in its pixels, counted from the topmost row. Both have one size.
var places: Array[Rect2i] = [Rect2i(), Rect2i()]
## The place of each eye's topmost left corner in its wide image, in pixels of that.
var wide_corners: Array[Vector2] = [Vector2.ZERO, Vector2.ZERO]


## Returns the views of two eyes, for a strength from 0 (off) to 3 (high). [param gaze] is the direction in which the eyes
## look, in the rendered eye's axes; zero stands for straight ahead. Sizes do not depend on it. All else is as for
## [method YoroViews.of].
static func of(frusta: Array, between: Transform3D, near: float, far: float, rendered: int, pixels: Vector2i,
		guard_band: float, strength: int, gaze: Vector3) -> YoroLevels:
	var made := YoroLevels.new()
	made.whole = YoroViews.of(frusta, between, near, far, rendered, pixels, guard_band)
	made.wide = made.whole
	made.trouble = made.whole.trouble
	if made.trouble == "" and strength > 0:
		var level := _STRENGTHS[strength]
		made._place_insets(frusta, deg_to_rad(level.x), gaze)
		made._split(frusta, between, near, far, guard_band, level.y, gaze != Vector3.ZERO)
	return made


## Places insets around the gaze, over the same tangents in both eyes, within what the two see together.
func _place_insets(frusta: Array, angle: float, gaze: Vector3) -> void:
	var own: Array = frusta[whole.rendered]
	var other: Array = frusta[1 - whole.rendered]
	# Directions beside and behind the eye are far to its side.
	var ahead := maxf(-gaze.z, 1e-3)
	var length := ceili(2.0 * tan(angle) / whole.pitch) + 1
	for axis in 2:
		# Columns are counted from the left, rows from the top.
		var edge := 2 * axis
		var step := whole.pitch if axis == 0 else -whole.pitch
		var apart := roundi((own[edge] - other[edge]) / step)
		var first := maxi(0, -apart)
		var last := whole.eye_size[axis] - maxi(0, apart)
		var size := mini(length, last - first)
		var corner := clampi(roundi((gaze[axis] / ahead - own[edge]) / step - size / 2.0), first, last - size)
		for eye in 2:
			places[eye].position[axis] = corner + (0 if eye == whole.rendered else apart)
			places[eye].size[axis] = size


## Makes both levels, unless one level of all pixels is cheaper.
func _split(frusta: Array, between: Transform3D, near: float, far: float, guard_band: float, density: float,
		moves: bool) -> void:
	var wides: Array = []
	for eye in 2:
		var f: Array = frusta[eye]
		# The rows of both eyes' wide levels are the same.
		wides.append([f[0], f[1], maxf(frusta[0][2], frusta[1][2]), minf(frusta[0][3], frusta[1][3])])
	var around: Array = wides[whole.rendered]
	var scale := density / whole.pitch
	var pixels := Vector2i(ceili((around[1] - around[0]) * scale - 1e-3), ceili((around[2] - around[3]) * scale - 1e-3))
	var few := YoroViews.of(wides, between, near, far, whole.rendered, pixels, guard_band)
	var all := YoroViews.of(_insets(frusta), between, near, far, whole.rendered, places[0].size, _NEAREST)
	if moves and all.trouble == "":
		# Within the whole image, with all that the other eye's inset needs.
		var at := places[whole.rendered].position + whole.crop - all.crop
		var shift := at.clamp(Vector2i.ZERO, (whole.size - all.size).max(Vector2i.ZERO)) - at
		for eye in 2:
			places[eye].position += shift
		all = YoroViews.of(_insets(frusta), between, near, far, whole.rendered, places[0].size, _NEAREST)
	if few.trouble != "" or all.trouble != "" or _pixels(few) + _pixels(all) >= _pixels(whole):
		return
	wide = few
	inset = all
	inset_image = inset
	inset_part = Rect2i(Vector2i.ZERO, inset.size)
	var part := Rect2i(places[whole.rendered].position + whole.crop - inset.crop, inset.size)
	if moves and Rect2i(Vector2i.ZERO, whole.size).encloses(part):
		inset_image = whole
		inset_part = part
	for eye in 2:
		var corner := Vector2(0.0, (wides[eye][2] - frusta[eye][2]) / wide.pitch)
		wide_corners[eye] = corner + (Vector2(wide.crop) if eye == wide.rendered else Vector2.ZERO)


## Returns the frusta of the insets.
func _insets(frusta: Array) -> Array:
	var insets: Array = []
	for eye in 2:
		var f: Array = frusta[eye]
		var place := Rect2(places[eye])
		insets.append([f[0] + place.position.x * whole.pitch, f[0] + place.end.x * whole.pitch,
				f[2] - place.position.y * whole.pitch, f[2] - place.end.y * whole.pitch])
	return insets


static func _pixels(of: YoroViews) -> int:
	return of.size.x * of.size.y
