## The viewport of a level of the rendered eye, which also synthesizes the other one's, or of what holes of that show.
@tool
class_name YoroEye
extends SubViewport

## Overrides for what is done later, once for both eyes, where these are shown.
const _OVERRIDES := {glow_enabled = false, adjustment_enabled = false, tonemap_mode = Environment.TONE_MAPPER_LINEAR}
## The properties that are copied from the viewport that is shown, since they affect how things are drawn.
const SHARED: PackedStringArray = [
	"msaa_3d", "use_occlusion_culling", "positional_shadow_atlas_size", "positional_shadow_atlas_16_bits",
	"positional_shadow_atlas_quad_0", "positional_shadow_atlas_quad_1", "positional_shadow_atlas_quad_2",
	"positional_shadow_atlas_quad_3", "anisotropic_filtering_level", "texture_mipmap_bias",
]

var camera := Camera3D.new()
## The effect that makes the other eye, or null in the viewport of its holes.
var synthesis: YoroSynthesis
var _last: CompositorEffect
var _environment: YoroEnvironment
var _effects: Array[CompositorEffect] = []


func _init(last: CompositorEffect, overrides := {}) -> void:
	_last = last
	synthesis = last as YoroSynthesis
	_environment = YoroEnvironment.new(_OVERRIDES.merged(overrides))
	# Godot's post-processed picture is not shown, so a quarter of its pixels is cheaper. The synthesis uses all
	# rendered pixels.
	scaling_3d_mode = Viewport.SCALING_3D_MODE_BILINEAR
	scaling_3d_scale = 2.0
	gui_disable_input = true
	camera.keep_aspect = Camera3D.KEEP_HEIGHT
	camera.compositor = Compositor.new()
	camera.current = true
	add_child(camera)


## Takes over the settings of the camera [param like], except for what Godot draws for both eyes, and those of the
## viewport [param shown]. [param effects] are drawn before the last one. [param layers] are shown in addition.
## [param density] is the number of pixels along each axis for each of a whole eye's.
func follow(like: YoroCamera3D, shown: Viewport, effects: Array[CompositorEffect], layers: int, density: float) -> void:
	for name in SHARED:
		if get(name) != shown.get(name):
			set(name, shown.get(name))
	# Levels of detail are those of the eye's own pixels in each level. The viewport has half of these.
	var threshold := shown.mesh_lod_threshold * 0.5 * density
	if mesh_lod_threshold != threshold:
		mesh_lod_threshold = threshold
	if world_3d != like.get_world_3d():
		world_3d = like.get_world_3d()
	_environment.follow(like.shown_environment())
	camera.environment = _environment.copy
	camera.attributes = like.attributes
	show_layers(self, camera, like.cull_mask & ~like.stereo_layers & ~YoroMask.LAYERS | layers)
	if effects != _effects or camera.compositor.compositor_effects.is_empty():
		_effects = effects.duplicate()
		var all := _effects.duplicate()
		all.append(_last)
		camera.compositor.compositor_effects = all


## Lets a camera show these layers. Godot culls what casts shadows by them, too, but renews the shadow maps of lamps and
## spotlights only if something moves, or, as here, with the quadrants of the viewport's atlas.
static func show_layers(in_viewport: Viewport, of: Camera3D, layers: int) -> void:
	if of.cull_mask != layers:
		of.cull_mask = layers
		renew_shadows(in_viewport)


## Lets a viewport draw all its shadow maps anew, into the same memory.
static func renew_shadows(of: Viewport) -> void:
	for quadrant in 4:
		var parts: int = 1 << 2 * of.get("positional_shadow_atlas_quad_%d" % quadrant) >> 2
		for count: int in [0, parts]:
			RenderingServer.viewport_set_positional_shadow_atlas_quadrant_subdivision(of.get_viewport_rid(), quadrant, count)


## Draws an image of [param pixels], an even size, from [param at] in this frame, with the tangents left, right, up and down.
func draw(pixels: Vector2i, f: Array[float], at: Transform3D, near: float, far: float) -> void:
	if size != pixels / 2:
		size = pixels / 2
	camera.set_frustum((f[2] - f[3]) * near, Vector2(f[0] + f[1], f[2] + f[3]) * 0.5 * near, near, far)
	camera.global_transform = at
	render_target_update_mode = SubViewport.UPDATE_ALWAYS


## Draws nothing.
func rest() -> void:
	render_target_update_mode = SubViewport.UPDATE_DISABLED
