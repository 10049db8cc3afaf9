## What to render for two eyes, and the uniforms of the synthesis passes: [code]yoro_kit.h[/code] of yoro's shader kit
## in GDScript.
@tool
class_name YoroViews
extends RefCounted

## The largest distance that a surface may move between the eyes, in pixels.
const MAX_MOVE := 4095.0
## Eyes count as parallel up to this angle in radians: a script sees the last frame's eyes, and those of this frame may
## differ by rounding.
const _PARALLEL := 1e-3

## Why the other eye cannot be synthesized, in one sentence; nothing else is set then. It is empty if the eye can be.
var trouble := ""
## The size of the image to render, in pixels.
var size: Vector2i
## The frustum to render it with: tangents left, right, up, down.
var frustum: Array[float]
## Where the rendered eye's own image begins in the image to render, counted from its topmost row.
var crop: Vector2i
## The size of each eye's image, in pixels.
var eye_size: Vector2i
## The share of the eyes' images that is shown, counted from their left and upper edges.
var covered: Vector2
## The eye that is rendered: 0 left, 1 right.
var rendered: int
## The other eye's place in the axes of the rendered eye, in metres.
var apart: Vector3
## The frustum and the size of an image that has the other eye's, and is of even size.
var other_frustum: Array[float]
var other_size: Vector2i
## The tangents that a pixel of each image covers.
var pitch: float
## Where in the image to render a pixel of the other eye comes from, as a share of its width: X times its column, plus Y,
## plus Z times its depth.
var source_column: Vector3
## The sizes of the intermediate images.
var tile_map: Vector2i
var span_map: Vector2i
## The largest possible disparity of a surface, in pixels.
var max_disparity: float
## The block of all passes, in std140.
var uniforms: PackedByteArray


## Returns the views of two eyes. [param frusta] has the tangents left, right, up and down of the left eye, then of the
## right eye. [param between] is the pose of the right eye relative to the left eye. [param pixels] is the size of each
## image as it is shown. Lengths are in metres. From [param guard_band] on, nothing is missing at the other eye's outer
## border; 0 means no band.
static func of(frusta: Array, between: Transform3D, near: float, far: float, rendered_eye: int, pixels: Vector2i,
		guard_band: float) -> YoroViews:
	var v := YoroViews.new()
	v.trouble = v._fill(frusta, between, near, far, rendered_eye, pixels, guard_band)
	return v


## Returns the tangents left, right, up, down of a projection.
static func tangents(p: Projection) -> Array[float]:
	return [(p.z.x - 1.0) / p.x.x, (p.z.x + 1.0) / p.x.x, (p.z.y + 1.0) / p.y.y, (p.z.y - 1.0) / p.y.y]


func _fill(frusta: Array, between: Transform3D, near: float, far: float, rendered_eye: int, pixels: Vector2i,
		guard_band: float) -> String:
	var ipd := between.origin.length()
	if maxf(between.basis.x.distance_to(Vector3.RIGHT), between.basis.z.distance_to(Vector3.BACK)) > _PARALLEL:
		return "the headset's displays are turned against each other"
	if absf(between.origin.y) + absf(between.origin.z) > 0.05 * ipd:
		return "the headset's eyes do not lie on a horizontal line"
	var s: Array = frusta[rendered_eye]
	var t: Array = frusta[1 - rendered_eye]
	# Godot's cameras have square pixels, but a headset's need not be square. Take the finer of the headset's two
	# pitches, so that one axis is not resampled. The image then covers the eye and up to one pixel more.
	var extent := Vector2(s[1] - s[0], s[2] - s[3])
	pitch = minf(extent.x / pixels.x, extent.y / pixels.y)
	var row: float = (t[2] - s[2]) / pitch
	# Written so that tangents that are not finite fail, too.
	if not (pitch > 0.0 and extent.distance_to(Vector2(t[1] - t[0], t[2] - t[3])) <= 0.05 * pitch
			and absf(row - roundf(row)) <= 0.05):
		return "the eyes' fields of view differ in size, or by parts of a pixel's row"
	var eye := Vector2i(ceili(extent.x / pitch - 1e-3), ceili(extent.y / pitch - 1e-3))
	eye_size = eye
	covered = extent / (Vector2(eye) * pitch)
	rendered = rendered_eye
	# The rendered eye, grown by whole pixels to the union of both frusta, and by the guard band on the side of which
	# the other eye sees more.
	var to_left := rendered_eye != 0
	var guard := _ceil(ipd / pitch / guard_band) if guard_band > 0.0 else 0
	var left := _ceil((s[0] - t[0]) / pitch) + (guard if to_left else 0)
	var right := _ceil((t[1] - s[1]) / pitch) + (0 if to_left else guard)
	var above := _ceil(row)
	var below := _ceil((s[3] - t[3]) / pitch)
	# Make the sizes even: YoroEye draws at twice the size of its viewport.
	right += (eye.x + left + right) % 2
	below += (eye.y + above + below) % 2
	other_size = eye + eye % 2
	other_frustum = [t[0], t[0] + other_size.x * pitch, t[2], t[2] - other_size.y * pitch]
	apart = Vector3(-ipd if to_left else ipd, 0.0, 0.0)
	size = eye + Vector2i(left + right, above + below)
	crop = Vector2i(left, above)
	var corner := Vector2(s[0] - left * pitch, s[2] + above * pitch)
	frustum = [corner.x, corner.x + size.x * pitch, corner.y, corner.y - size.y * pitch]
	# x_other = x + offset + scale * depth, since 1 / z is affine in Godot's depth, which is 1 at the near plane.
	var shift := (1.0 if to_left else -1.0) * ipd / pitch
	var offset: float = (frustum[0] - t[0]) / pitch + shift / far
	var scale := shift * (1.0 / near - 1.0 / far)
	# Rows are counted from the topmost one.
	var row_offset := roundi(row) - above
	# Columns are counted in the direction in which nearer surfaces lie farther along: from the right for a right eye.
	if not to_left:
		offset = eye.x - size.x - offset
		scale = -scale
	max_disparity = scale
	if not minf(scale, eye.x - offset) <= MAX_MOVE:
		return "near objects move too far between the eyes: increase near"
	tile_map = Vector2i(ceili(size.x / 16.0), ceili(size.y / 8.0))
	span_map = Vector2i(ceili(eye.x / 16.0), tile_map.y)
	var sense := 1.0 if to_left else -1.0
	var first := -0.5 if to_left else eye.x - 0.5
	var across := 16.0 * span_map.x
	var up := 8.0 * span_map.y
	source_column = Vector3(sense, (0.0 if to_left else float(eye.x)) - offset, -scale) / size.x
	uniforms.resize(112)
	_integers(0, [size.x, size.y, eye.x, eye.y])
	_floats(16, [offset, scale])
	_integers(24, [0 if to_left else 1, row_offset, 0, 0])
	_floats(40, [
		offset, offset + scale, sense / size.x, 0.0 if to_left else 1.0, sense, first - offset,
		sense / across, 1.0 / up, (first + 0.5) / across, -row_offset / up,
		1.0 / size.y, -row_offset / float(size.y), row_offset, 0.01,
	])
	_floats(104, [1.0 / size.x, 1.0 / size.y])
	return ""


static func _ceil(pixels: float) -> int:
	return ceili(pixels - 1e-3) if pixels > 1e-3 else 0


func _integers(at: int, values: Array) -> void:
	for i in values.size():
		uniforms.encode_s32(at + 4 * i, values[i])


func _floats(at: int, values: Array) -> void:
	for i in values.size():
		uniforms.encode_float(at + 4 * i, values[i])
