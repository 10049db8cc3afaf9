## Keeps a camera from shading what lies outside of a rectangle of its image, or of what a map leaves open: a frame that is
## as near as anything can be, and drawn before all else.
@tool
class_name YoroMask
extends RefCounted

## The layers of frames. Nodes have the first twenty, and the editor those from 1 << 24 to 1 << 30.
const LAYERS := 1 << 31 | 15 << 20

## The layers in use. Each frame has its own, since sources may share a world.
static var _taken := 0

const _SHADER := "
shader_type spatial;
render_mode unshaded, cull_disabled, shadows_disabled, fog_disabled;
// The rectangle's corners, from 0 to 1.
uniform vec4 rectangle;
uniform sampler2D open_map : filter_nearest;
uniform ivec2 corner;
void vertex() {
	vec2 place = mix(VERTEX.xy, mix(rectangle.xy, rectangle.zw, VERTEX.xy), VERTEX.z);
	POSITION = vec4(place * 2.0 - 1.0, 1.0, 1.0);
}
void fragment() {
	%s
	ALBEDO = vec3(0.0);
}
"
const _OPENS := "
	uvec2 texel = uvec2(ivec2(FRAGCOORD.xy) - corner);
	if (all(lessThan(texel, uvec2(textureSize(open_map, 0)))) && texelFetch(open_map, ivec2(texel), 0).r == 1.0) {
		discard;
	}
"

var _mesh := ArrayMesh.new()
var _material := ShaderMaterial.new()
var _instance := RenderingServer.instance_create()
var _scenario: RID
## The layer of this frame; 0 if none is free, so that all pixels are shaded.
var _layer := 0


## [param open_map] is 1 where pixels are shaded, or null for a frame around a rectangle.
func _init(open_map: Texture2D = null) -> void:
	var free := LAYERS & ~_taken
	_layer = free & -free
	_taken |= _layer
	_material.shader = Shader.new()
	_material.shader.code = _SHADER % [_OPENS if open_map != null else ""]
	_material.set_shader_parameter(&"open_map", open_map)
	_material.render_priority = Material.RENDER_PRIORITY_MIN
	var vertices := PackedVector3Array()
	for z in 2:
		for corner: Vector2 in [Vector2(0, 0), Vector2(1, 0), Vector2(1, 1), Vector2(0, 1)]:
			vertices.append(Vector3(corner.x, corner.y, z))
	var indices := PackedInt32Array()
	for i in 4:
		var next := (i + 1) % 4
		indices.append_array([i, next, i + 4, next, next + 4, i + 4])
	var arrays := []
	arrays.resize(Mesh.ARRAY_MAX)
	arrays[Mesh.ARRAY_VERTEX] = vertices
	arrays[Mesh.ARRAY_INDEX] = indices
	_mesh.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, arrays)
	_mesh.surface_set_material(0, _material)
	RenderingServer.instance_set_base(_instance, _mesh.get_rid())
	RenderingServer.instance_set_layer_mask(_instance, _layer)
	# Wherever the camera is.
	RenderingServer.instance_set_custom_aabb(_instance, AABB(-1e6 * Vector3.ONE, 2e6 * Vector3.ONE))
	RenderingServer.instance_geometry_set_cast_shadows_setting(_instance, RenderingServer.SHADOW_CASTING_SETTING_OFF)


func _notification(what: int) -> void:
	if what == NOTIFICATION_PREDELETE:
		_taken &= ~_layer
		RenderingServer.free_rid(_instance)


## Returns the layer that a camera must show to have the frame.
func layer() -> int:
	return _layer


## Leaves only [param rectangle] of images of [param size] in a world; with a map, which lies at [param corner], only what is
## 1 there.
func follow(world: World3D, rectangle: Rect2i, size: Vector2i, corner := Vector2i.ZERO) -> void:
	if _scenario != world.scenario:
		_scenario = world.scenario
		RenderingServer.instance_set_scenario(_instance, _scenario)
	var from := Vector2(rectangle.position) / Vector2(size)
	var to := Vector2(rectangle.end) / Vector2(size)
	_material.set_shader_parameter(&"rectangle", Vector4(from.x, from.y, to.x, to.y))
	_material.set_shader_parameter(&"corner", corner)
	RenderingServer.instance_set_visible(_instance, true)


## Hides the frame.
func rest() -> void:
	RenderingServer.instance_set_visible(_instance, false)
