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
	print("fact warnings %d, transparent %d" % [YoroMarks.warnings(room, camera.stereo_layers).size(), YoroMarks.transparent(room).size()])
	var light := YoroMarks.lights(room)[0]
	var glass := YoroMarks.transparent(room)[0]
	light.layers = 1
	glass.layers = 1
	print("fact warnings %d" % YoroMarks.warnings(room, camera.stereo_layers).size())
	light.layers |= camera.stereo_layers
	glass.layers = camera.stereo_layers
	print("fact served %s" % [_served()])
	print("fact shaders of the kit that the add-on does not use: %d" % _compiled("res://test/kit"))
	await _case("plain")
	camera.dominant_eye = YoroCamera3D.Eye.LEFT
	await _case("swapped", ["ONE_VIEW"])
	camera.dominant_eye = YoroCamera3D.Eye.RIGHT
	await _frames(2)
	# Without stereo layers, glass is drawn with the rendered eye, whose picture must not change.
	var before := _image(camera.dominant_eye)
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
	# The initial size again, after everything above.
	get_window().size = Vector2i(1024, 512)
	await _frames(2)
	camera.preview_without_headset = false
	await _frames(3)
	print("fact preview %s" % [camera.preview() == null])
	print("fact done")
	get_tree().quit()


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


func _save(name: String) -> void:
	for eye in 2:
		_image(eye).save_png("%s/%s-%s.png" % [out, name, ["left", "right"][eye]])


func _image(eye: int) -> Image:
	return camera.preview().eyes[eye].get_texture().get_image()
