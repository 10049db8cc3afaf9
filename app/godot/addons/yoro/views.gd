## What to render of two eyes, and the uniforms of the synthesis passes: [code]yoro_kit.h[/code] of yoro's shader kit in GDScript.
@tool
class_name YoroViews
extends RefCounted

## The furthest that a surface may move between the eyes, in pixels.
const MAX_MOVE := 4095.0

## The size of the image to render, in pixels.
var size: Vector2i
## The frustum to render it with: tangents left, right, up, down.
var frustum: Array[float]
## Where the rendered eye's own image begins in it, from the topmost row.
var crop: Vector2i
## The size of each eye's image, in pixels.
var eye_size: Vector2i
## The eye that is rendered: 0 left, 1 right.
var rendered: int
## The sizes of the intermediate images.
var tile_map: Vector2i
var span_map: Vector2i
## The disparity of the nearest surfaces that there may be, in pixels.
var reach: float
## The block of all passes, in std140.
var uniforms: PackedByteArray


## Returns the views of two eyes that look in one direction, or null for eyes that cannot be served. [param frusta] has the
## left eye's and the right eye's tangents left, right, up, down; [param eye] is the size of either image in pixels; lengths are
## in metres; from [param guard_band] on nothing is missing at the other eye's outer border (0: no band).
static func of(frusta: Array, ipd: float, near: float, far: float, rendered_eye: int, eye: Vector2i, guard_band: float) -> YoroViews:
	var s := _rows_down(frusta[rendered_eye])
	var t := _rows_down(frusta[1 - rendered_eye])
	if not (eye.x > 0 and eye.y > 0 and s[1] > s[0] and s[2] > s[3] and t[1] > t[0] and t[2] > t[3]
			and near > 0.0 and near < far and ipd >= 0.0 and ipd < 100.0 and guard_band >= 0.0):
		return null
	# Tangent per pixel.
	var dx: float = (s[1] - s[0]) / eye.x
	var dy: float = (s[2] - s[3]) / eye.y
	var row: float = (s[3] - t[3]) / dy
	if not (absf((t[1] - t[0]) / eye.x / dx - 1.0) * eye.x <= 0.05 and absf((t[2] - t[3]) / eye.y / dy - 1.0) * eye.y <= 0.05
			and absf(row - roundf(row)) <= 0.05):
		return null
	var v := YoroViews.new()
	v.eye_size = eye
	v.rendered = rendered_eye
	# The rendered eye, grown by whole pixels to both frusta, and by the guard band on the side that the other eye sees more of.
	var to_left := rendered_eye != 0
	var guard := _ceil(ipd / dx / guard_band) if guard_band > 0.0 else 0
	var left := _ceil((s[0] - t[0]) / dx) + (guard if to_left else 0)
	var right := _ceil((t[1] - s[1]) / dx) + (0 if to_left else guard)
	var below := _ceil((s[3] - t[3]) / dy)
	var above := _ceil((t[2] - s[2]) / dy)
	# An even size: YoroEye draws at twice its viewport's.
	right += (eye.x + left + right) % 2
	above += (eye.y + below + above) % 2
	s[0] -= left * dx
	s[1] += right * dx
	s[3] -= below * dy
	s[2] += above * dy
	v.size = eye + Vector2i(left + right, below + above)
	v.crop = Vector2i(left, below)
	v.frustum = _rows_down(s)
	# x_other = x + offset + scale * depth, since 1 / z is affine in Godot's depth, which is 1 at the near plane.
	var shift := (1.0 if to_left else -1.0) * ipd / dx
	var far_inverse := 0.0 if is_inf(far) else 1.0 / far
	var offset: float = (s[0] - t[0]) / dx + shift * far_inverse
	var scale := shift * (1.0 / near - far_inverse)
	var row_offset := roundi((s[3] - t[3]) / dy)
	# Columns are counted in the direction in which nearer surfaces lie farther along: from the right for a right eye.
	if not to_left:
		offset = eye.x - v.size.x - offset
		scale = -scale
	v.reach = scale
	var at_near := offset + scale
	if not minf(scale, eye.x - offset) <= MAX_MOVE:
		return null
	v.tile_map = Vector2i(ceili(v.size.x / 16.0), ceili(v.size.y / 8.0))
	v.span_map = Vector2i(ceili(eye.x / 16.0), v.tile_map.y)
	var sense := 1.0 if to_left else -1.0
	var first := -0.5 if to_left else eye.x - 0.5
	var across := 16.0 * v.span_map.x
	var up := 8.0 * v.span_map.y
	v.uniforms.resize(112)
	v._integers(0, [v.size.x, v.size.y, eye.x, eye.y])
	v._floats(16, [offset, scale])
	v._integers(24, [0 if to_left else 1, row_offset, 0, 0])
	v._floats(40, [
		offset, at_near, sense / v.size.x, 0.0 if to_left else 1.0, sense, first - offset,
		sense / across, 1.0 / up, (first + 0.5) / across, -row_offset / up,
		1.0 / v.size.y, -row_offset / float(v.size.y), row_offset, 0.01,
	])
	v._floats(104, [1.0 / v.size.x, 1.0 / v.size.y])
	return v


## Tangents left, right, up, down of a projection.
static func tangents(p: Projection) -> Array[float]:
	return [(p.z.x - 1.0) / p.x.x, (p.z.x + 1.0) / p.x.x, (p.z.y + 1.0) / p.y.y, (p.z.y - 1.0) / p.y.y]


## Godot's Vulkan images begin with the topmost row: from there, everything is upside down.
static func _rows_down(f: Array) -> Array[float]:
	return [f[0], f[1], -f[3], -f[2]]


static func _ceil(pixels: float) -> int:
	return ceili(pixels - 1e-3) if pixels > 1e-3 else 0


func _integers(at: int, values: Array) -> void:
	for i in values.size():
		uniforms.encode_s32(at + 4 * i, values[i])


func _floats(at: int, values: Array) -> void:
	for i in values.size():
		uniforms.encode_float(at + 4 * i, values[i])
