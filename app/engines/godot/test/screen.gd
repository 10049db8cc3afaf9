## Runs the demo without a headset. Saves pictures of both eyes, as the add-on makes them and as Godot draws them, to
## `out=FOLDER`.
extends Node

@onready var camera: YoroCamera3D = $Demo/XROrigin3D/YoroCamera3D
@onready var room: DemoRoom = $Demo/Room
var out := ""


func _ready() -> void:
	for argument in OS.get_cmdline_user_args():
		out = argument.trim_prefix("out=") if argument.begins_with("out=") else out
	get_window().size = Vector2i(1024, 512)
	await _frames(3)
	print("fact warnings %d, transparent %d" % [_warnings(), YoroMarks.transparent(room).size()])
	var light := YoroMarks.lights(room)[0]
	var glass := YoroMarks.transparent(room)[0]
	light.layers = 1
	glass.layers = 1
	print("fact warnings %d" % _warnings())
	light.layers |= camera.stereo_layers
	glass.layers = camera.stereo_layers
	print("fact served %s" % [_served()])
	print("fact shaders of the kit that the add-on does not use: %d" % _compiled("res://test/kit"))
	await _case("plain")
	await _chooses()
	var before := _image(camera.dominant_eye)
	await _holes("plain")
	print("fact with rendered holes the rendered eye is as before: %s" % [before.get_data() == _image(camera.dominant_eye).get_data()])
	camera.holes = YoroCamera3D.Holes.PROJECT
	camera.dominant_eye = YoroCamera3D.Eye.LEFT
	await _case("swapped", ["ONE_VIEW"])
	await _holes("swapped")
	camera.holes = YoroCamera3D.Holes.PROJECT
	camera.dominant_eye = YoroCamera3D.Eye.RIGHT
	await _frames(2)
	# Without stereo layers, glass is drawn with the rendered eye, whose picture must not change.
	camera.stereo_layers = 0
	await _frames(2)
	var levels: float = before.compute_image_metrics(_image(camera.dominant_eye), false).max
	print("fact without stereo layers the rendered eye is as before: %s" % [levels <= 2.0])
	camera.stereo_layers = DemoRoom.STEREO
	camera.ipd_scale = 0.0
	await _case("ipd0")
	camera.ipd_scale = 1.0
	get_viewport().msaa_3d = Viewport.MSAA_4X
	await _case("msaa")
	await _holes("msaa")
	camera.holes = YoroCamera3D.Holes.PROJECT
	get_viewport().msaa_3d = Viewport.MSAA_DISABLED
	room.environment.environment.glow_enabled = true
	room.environment.environment.glow_bloom = 0.3
	await _case("glow")
	room.environment.environment.glow_enabled = false
	# Linear, as in the copies of the headset's pictures: tone mapping would enlarge all differences.
	room.environment.environment.tonemap_mode = Environment.TONE_MAPPER_LINEAR
	await _case("linear")
	room.environment.environment.tonemap_mode = Environment.TONE_MAPPER_ACES
	get_window().size = Vector2i(800, 300)
	await _frames(9)
	await _case("resized")
	for view: int in [YoroCamera3D.DebugView.HOLES, YoroCamera3D.DebugView.DISPARITY, YoroCamera3D.DebugView.SYNTHESIZED]:
		camera.debug_view = view as YoroCamera3D.DebugView
		await _frames(2)
		_save("debug-%d" % view)
	camera.debug_view = YoroCamera3D.DebugView.NONE
	# Shadow maps are drawn with the stereo layers alone before Godot renders both eyes.
	room.lamp.shadow_enabled = true
	await _frames(2)
	await _case("lamp")
	room.lamp.shadow_enabled = false
	# The initial size again, after everything above.
	get_window().size = Vector2i(1024, 512)
	await _frames(2)
	await _has_levels()
	await _follows()
	await _takes_turns()
	camera.preview_without_headset = false
	await _frames(3)
	print("fact preview %s" % [camera.preview() == null and not get_viewport().disable_3d])
	print("fact done")
	get_tree().quit()


## Pictures of each way that is measured: both eyes must be Godot's own in its turn.
func _chooses() -> void:
	TestChoice.print_laws()
	await TestChoice.settle(camera, func(way: int) -> void: _save("auto-%s" % YoroCamera3D.Mode.find_key(way).to_lower()))
	var levels := 0.0
	for eye: String in TestLevels.EYES:
		var pair: Array = ["auto", "plain"].map(func(name: String) -> Image: return Image.load_from_file("%s/%s-both_views-%s.png" % [out, name, eye]))
		levels = maxf(levels, pair[0].compute_image_metrics(pair[1], false).root_mean_squared)
	print("both views in their turn: %.3f of 255 from Godot's own, root mean square" % levels)
	# The sky's light is still being made when the first pictures are taken.
	print("fact in its turn auto shows Godot's own eyes: %s" % [levels < 0.5])
	camera.mode = YoroCamera3D.Mode.ONE_VIEW
	await _frames(2)


func _warnings() -> int:
	return YoroMarks.warnings(room, camera.stereo_layers, camera.cull_mask).size()


## Pictures with levels, and what stays and what changes with the gaze.
func _has_levels() -> void:
	# Godot fits the sun's shadow maps to each view, so they are finer in the inset. Those of lamps are the same.
	room.sun.shadow_enabled = false
	room.lamp.shadow_enabled = true
	await TestLevels.save(camera, Vector3.ZERO, _both_images, out)
	var whole := camera.source().levels.whole
	# Without stereo layers, glass is drawn in each level.
	camera.stereo_layers = 0
	await _frames(2)
	var before := _image(camera.dominant_eye)
	ProjectSettings.set_setting(YoroCamera3D.FOVEATION_SETTING, 2)
	camera.foveation = YoroCamera3D.Foveation.PROJECT
	await _frames(2)
	var place := camera.source().levels.places[camera.dominant_eye].grow(-1)
	var levels: float = before.get_region(place).compute_image_metrics(_image(camera.dominant_eye).get_region(place), false).root_mean_squared
	# Edges are rounded to other parts of a pixel.
	print("fact without stereo layers the fovea is as before: %s" % [levels < 2.0])
	camera.stereo_layers = DemoRoom.STEREO
	await _frames(2)
	_count("medium")
	camera.gaze = Vector3.FORWARD
	await _frames(3)
	var sizes := {}
	var places := {}
	for gaze: Vector3 in [Vector3.FORWARD, Vector3(-0.4, 0.1, -1.0), Vector3(0.3, -0.3, -1.0), Vector3.RIGHT, Vector3(0.0, 5.0, 1.0), Vector3.ZERO]:
		camera.gaze = gaze
		await _frames(1)
		var split := camera.source().levels
		sizes[[split.wide.size, split.inset.size, RenderingServer.get_rendering_info(RenderingServer.RENDERING_INFO_VIDEO_MEM_USED)]] = true
		places[split.places[0].position] = true
		var inside := split.places.all(func(it: Rect2i) -> bool: return Rect2i(Vector2i.ZERO, whole.eye_size).encloses(it))
		if not inside or not camera.source().is_ready():
			print("the inset for %s is not drawn: %s" % [gaze, split.places])
			places.clear()
	print("fact as the gaze moves: sizes and bytes %d, places %d" % [sizes.size(), places.size()])
	print("fact frames have layers of their own: %s" % [YoroMask.new().layer() != YoroMask.new().layer()])
	ProjectSettings.set_setting(YoroCamera3D.FOVEATION_SETTING, 0)
	await _frames(2)
	print("fact the project sets the foveation: %s" % [camera.source().levels.inset == null])
	_count("off")
	ProjectSettings.set_setting(YoroCamera3D.HOLES_SETTING, 1)
	await _frames(2)
	print("fact the project sets the holes: %s" % [camera.source().opens])
	_count("rendered holes")
	ProjectSettings.set_setting(YoroCamera3D.HOLES_SETTING, 0)
	camera.mode = YoroCamera3D.Mode.BOTH_VIEWS
	await _frames(2)
	_count("both views")
	camera.mode = YoroCamera3D.Mode.ONE_VIEW
	room.sun.shadow_enabled = true
	room.lamp.shadow_enabled = false


## Prints the pixels and the draw calls of the last frame.
func _count(what: String) -> void:
	var drawn: Array[Viewport] = []
	drawn.assign(camera.preview().eyes)
	if camera.mode == YoroCamera3D.Mode.ONE_VIEW:
		drawn.append_array(camera.source().drawn())
		if camera.source().opens:
			drawn.append(camera.source().beyond)
	var calls: Array[Array] = []
	var pixels := 0
	for viewport in drawn:
		var rendered := 0
		if viewport is YoroEye and viewport.synthesis != null:
			rendered = viewport.synthesis.views.size.x * viewport.synthesis.views.size.y
		elif camera.mode == YoroCamera3D.Mode.BOTH_VIEWS:
			rendered = (viewport as SubViewport).size.x * (viewport as SubViewport).size.y
		pixels += rendered
		calls.append([RenderingServer.VIEWPORT_RENDER_INFO_TYPE_VISIBLE, RenderingServer.VIEWPORT_RENDER_INFO_TYPE_SHADOW].map(
				func(type: int) -> int: return RenderingServer.viewport_get_render_info(viewport.get_viewport_rid(),
						type as RenderingServer.ViewportRenderInfoType, RenderingServer.VIEWPORT_RENDER_INFO_DRAW_CALLS_IN_FRAME)))
	print("counted, %s: %d pixels; draw calls, and those of shadows, by viewport: %s" % [what, pixels, calls])


func _both_images() -> Array[Image]:
	await _frames(2)
	return [_image(0), _image(1)]


## The preview has the window's pixels and the camera's lens, also while the scene is paused, or says why there is none.
func _follows() -> void:
	var window := get_window()
	window.content_scale_mode = Window.CONTENT_SCALE_MODE_CANVAS_ITEMS
	window.content_scale_size = Vector2i(512, 256)
	window.content_scale_aspect = Window.CONTENT_SCALE_ASPECT_IGNORE
	window.size = Vector2i(256, 64)
	await _frames(4)
	var eyes := camera.preview().eyes
	print("fact pixels of an eye in a stretched window: %s" % eyes[0].size)
	get_tree().paused = true
	camera.rotation.y = PI
	camera.keep_aspect = Camera3D.KEEP_WIDTH
	camera.h_offset = 0.25
	await _frames(2)
	var shown := eyes[0].get_camera_3d()
	var left := camera.to_global(Vector3(0.25 - 0.5 * YoroPreview.IPD, 0.0, 0.0))
	print("fact follows while paused %s" % [shown.global_position.distance_to(left) < 1e-4
			and shown.global_basis.is_equal_approx(camera.global_basis)])
	var across := tan(deg_to_rad(camera.fov) / 2.0)
	var rendered := camera.source().levels.whole.frustum
	print("fact the angle is kept across %s, %s" % [absf(shown.get_camera_projection().get_fov() - camera.fov) < 0.01,
			absf(rendered[2] - across / 2.0) < 1e-4])
	get_tree().paused = false
	camera.rotation.y = 0.0
	camera.keep_aspect = Camera3D.KEEP_HEIGHT
	camera.h_offset = 0.0
	camera.projection = Camera3D.PROJECTION_ORTHOGONAL
	await _frames(2)
	print("fact orthogonal %s, %s" % [camera.preview() == null and not get_viewport().disable_3d, camera.trouble()])
	camera.projection = Camera3D.PROJECTION_PERSPECTIVE
	await _frames(2)


## Of several cameras, only the current one has a preview, also if its script has callbacks of its own. When it is
## freed, nothing remains.
func _takes_turns() -> void:
	var own: YoroCamera3D = preload("own.gd").new()
	own.preview_without_headset = true
	camera.get_parent().add_child(own)
	await _frames(2)
	var first := [camera.preview() != null, own.preview() != null, own.trouble()]
	own.current = true
	await _frames(3)
	print("fact turns %s, then %s" % [first, [camera.preview() != null, own.preview() != null, own.trouble(), get_viewport().disable_3d]])
	var other := Camera3D.new()
	add_child(other)
	own.queue_free()
	other.current = true
	await _frames(2)
	print("fact freed: 3D %s, preview %s" % [not get_viewport().disable_3d, camera.preview() != null])
	other.queue_free()
	camera.current = true
	await _frames(2)
	print("fact back: preview %s" % [camera.preview() != null])


## Returns whether an eye can be synthesized, for eyes that are parallel, parallel except for rounding, turned, raised,
## and of unequal sizes.
func _served() -> Array[bool]:
	var frustum: Array[float] = [-1.0, 1.0, 1.0, -1.0]
	var wider: Array[float] = [-1.0, 1.1, 1.0, -1.0]
	var apart := Vector3(0.063, 0.0, 0.0)
	var parallel := Transform3D(Basis.IDENTITY, apart)
	var served: Array[bool] = []
	for eyes: Array in [
		[parallel, frustum], [Transform3D(Basis(Vector3.UP, 1e-4), apart), frustum],
		[Transform3D(Basis(Vector3.UP, 0.01), apart), frustum], [parallel.translated(0.02 * Vector3.UP), frustum], [parallel, wider],
	]:
		served.append(YoroViews.of([frustum, eyes[1]], eyes[0], 0.1, 60.0, 1, Vector2i(512, 512), 1.0).trouble == "")
	return served


## Returns how many versions of a folder's shaders Godot compiles, or -1 if one fails.
func _compiled(folder: String) -> int:
	var device := RenderingServer.get_rendering_device()
	var count := 0
	for name in ResourceLoader.list_directory(folder):
		var file: RDShaderFile = load(folder.path_join(name))
		for version in file.get_version_list():
			var shader := device.shader_create_from_spirv(file.get_spirv(version))
			if not shader.is_valid():
				return -1
			device.free_rid(shader)
			count += 1
	return count


func _frames(count: int) -> void:
	for i in count:
		await RenderingServer.frame_post_draw


## Saves both eyes in each mode, switching modes while running.
func _case(name: String, modes: Array[String] = ["BOTH_VIEWS", "ONE_VIEW"]) -> void:
	for mode in modes:
		camera.mode = YoroCamera3D.Mode[mode]
		# The picture follows changes of the environment within eight frames.
		await _frames(9 if name in ["glow", "linear"] and mode == "ONE_VIEW" else 2)
		_save("%s-%s" % [name, mode.to_lower()])


## Saves both eyes with rendered holes, which stay so.
func _holes(name: String) -> void:
	camera.holes = YoroCamera3D.Holes.RENDERED
	await _case(name + "-holes", ["ONE_VIEW"])


func _save(name: String) -> void:
	for eye in 2:
		_image(eye).save_png("%s/%s-%s.png" % [out, name, ["left", "right"][eye]])


func _image(eye: int) -> Image:
	return camera.preview().eyes[eye].get_texture().get_image()
