## Both eyes of a [YoroCamera3D] side by side, without a headset: in the editor and on a screen.
@tool
class_name YoroPreview
extends HBoxContainer

## The distance between the eyes in metres.
const IPD := 0.063
## The properties that are copied from the viewport that is shown, beside those of the source.
const _SHOWN: PackedStringArray = ["mesh_lod_threshold", "use_debanding", "screen_space_aa"]

var camera: YoroCamera3D
## The left eye's and the right eye's image.
var eyes: Array[SubViewport] = []
var source: YoroSource
## Why both eyes are rendered although one could be synthesized, or an empty text.
var trouble := ""
var _cameras: Array[Camera3D] = []
var _pictures: Array[TextureRect] = []
var _puts: Array[YoroPut] = []
var _environment := YoroEnvironment.new(YoroCamera3D.SHOWN_OVERRIDES)


func _init(of: YoroCamera3D) -> void:
	camera = of
	# A scene is also shown while it is paused. After the scripts that move things, and the camera's own.
	process_mode = PROCESS_MODE_ALWAYS
	process_priority = 1001
	add_theme_constant_override("separation", 0)
	# Sibling viewports are drawn in this order, so the source comes first.
	source = YoroSource.new()
	add_child(source)
	for eye in 2:
		var viewport := SubViewport.new()
		viewport.gui_disable_input = true
		var shown := Camera3D.new()
		var put := YoroPut.new(source)
		put.eye = eye
		shown.compositor = Compositor.new()
		viewport.add_child(shown)
		add_child(viewport)
		eyes.append(viewport)
		_cameras.append(shown)
		_puts.append(put)
		var picture := TextureRect.new()
		picture.texture = viewport.get_texture()
		picture.expand_mode = TextureRect.EXPAND_IGNORE_SIZE
		picture.stretch_mode = TextureRect.STRETCH_KEEP_ASPECT_CENTERED
		picture.size_flags_horizontal = Control.SIZE_EXPAND_FILL
		picture.size_flags_vertical = Control.SIZE_EXPAND_FILL
		add_child(picture)
		_pictures.append(picture)
	_show(false)


## Returns why a camera cannot be previewed, or an empty text.
static func fault(of: Camera3D) -> String:
	return "" if of.projection == Camera3D.PROJECTION_PERSPECTIVE else "the camera's projection is not a perspective"


func _show(shown: bool) -> void:
	for eye in 2:
		_pictures[eye].visible = shown
		eyes[eye].render_target_update_mode = SubViewport.UPDATE_ALWAYS if shown else SubViewport.UPDATE_DISABLED
	if not shown:
		source.rest()


func _process(_delta: float) -> void:
	if not is_instance_valid(camera) or not camera.is_inside_tree() or not is_visible_in_tree() or fault(camera) != "":
		_show(false)
		return
	_show(true)
	# Controls have logical sizes, which may be stretched to the window's pixels.
	var pixels := size * get_viewport().get_stretch_transform().get_scale()
	var eye := Vector2i(maxi(roundi(pixels.x / 2.0), 16), maxi(roundi(pixels.y), 16))
	var ipd := IPD * camera.ipd_scale
	var up := tan(deg_to_rad(camera.fov) / 2.0)
	if camera.keep_aspect == Camera3D.KEEP_WIDTH:
		up *= float(eye.y) / eye.x
	var across := up * eye.x / eye.y
	var frustum: Array[float] = [-across, across, up, -up]
	var between := Transform3D(Basis.IDENTITY, Vector3(ipd, 0.0, 0.0))
	var levels := YoroLevels.of([frustum, frustum], between, camera.near, camera.far, camera.dominant_eye, eye,
			camera.guard_band, camera.foveation_strength(), camera.gaze_from(camera.get_camera_transform()))
	var way := camera.way()
	trouble = levels.trouble if way != YoroCamera3D.Mode.BOTH_VIEWS else ""
	var both := levels.trouble != "" or way == YoroCamera3D.Mode.BOTH_VIEWS
	_environment.follow(camera.shown_environment(), camera.cull_mask & camera.stereo_layers != 0)
	var effects := camera.effects(false)
	for i in 2:
		var shown := _cameras[i]
		if eyes[i].size != eye:
			eyes[i].size = eye
		if eyes[i].world_3d != camera.get_world_3d():
			eyes[i].world_3d = camera.get_world_3d()
		for name in YoroEye.SHARED + _SHOWN:
			if eyes[i].get(name) != camera.get_viewport().get(name):
				eyes[i].set(name, camera.get_viewport().get(name))
		shown.keep_aspect = camera.keep_aspect
		shown.set_perspective(camera.fov, camera.near, camera.far)
		shown.global_transform = camera.get_camera_transform() * Transform3D(Basis(), Vector3((i - 0.5) * ipd, 0.0, 0.0))
		shown.attributes = camera.attributes
		YoroEye.show_layers(eyes[i], shown, camera.cull_mask if both else camera.cull_mask & camera.stereo_layers)
		shown.environment = camera.shown_environment() if both else _environment.copy
		var wanted: Array[CompositorEffect] = camera.effects(true)
		if both:
			wanted = effects + wanted
		else:
			wanted.push_front(_puts[i])
			_puts[i].debug_view = camera.debug_view
			_puts[i].same_image = way == YoroCamera3D.Mode.SAME_IMAGE
		if shown.compositor.compositor_effects != wanted:
			shown.compositor.compositor_effects = wanted
	if both:
		source.rest()
		return
	source.draw(levels, _cameras[camera.dominant_eye].global_transform, camera, eyes[0], effects)
