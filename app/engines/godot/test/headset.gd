## Runs the demo on an OpenXR runtime, with the head held still. Saves pictures of both eyes to `out=FOLDER`, with one
## eye rendered and with both.
extends Node

@onready var camera: YoroCamera3D = $Demo/XROrigin3D/YoroCamera3D
@onready var room: DemoRoom = $Demo/Room
var out := ""
## The minimum number of frames of the run.
var frames := 100
## The path of Godot, to start the program that takes over the headset.
var godot := ""
var look := Look.new()


## Holds the head still. It runs before everything else is drawn, since OpenXR locates the headset anew after all
## scripts have run.
class Hold:
	extends CompositorEffect
	var at: Transform3D

	func _init() -> void:
		effect_callback_type = EFFECT_CALLBACK_TYPE_PRE_OPAQUE

	func _render_callback(_type: int, _data: RenderData) -> void:
		var interface := XRServer.primary_interface
		var left := interface.get_transform_for_view(0, Transform3D.IDENTITY)
		var right := interface.get_transform_for_view(1, Transform3D.IDENTITY)
		XRServer.world_origin = at * Transform3D(left.basis, (left.origin + right.origin) / 2.0).affine_inverse()


## Copies the images of both eyes, before tone mapping, and compares the rendered pose with the one that is shown.
class Look:
	extends CompositorEffect
	var source: YoroSource
	var wanted := false
	var pictures: Array[Image] = []
	var radians := 0.0
	var metres := 0.0
	var frames := 0

	func _init() -> void:
		effect_callback_type = EFFECT_CALLBACK_TYPE_POST_TRANSPARENT

	func _render_callback(_type: int, data: RenderData) -> void:
		frames += 1
		var buffers := data.get_render_scene_buffers() as RenderSceneBuffersRD
		if source != null and source.is_ready():
			var scene := data.get_render_scene_data()
			var rendered := source.levels.whole.rendered
			for level in source.drawn():
				_compare(scene, rendered, level.synthesis.pose)
			if source.opens:
				_compare(scene, 1 - rendered, source.holes.pose)
		if not wanted or source == null:
			return
		wanted = false
		pictures = []
		var passes := source.passes
		if not passes._shaders.has("look"):
			passes._shaders["look"] = passes.device.shader_create_from_spirv(preload("look.glsl").get_spirv())
		var push := PackedByteArray()
		push.resize(16)
		push.encode_float(0, 2.0 if RenderingServer.get_current_rendering_method() == "mobile" else 1.0)
		var size := buffers.get_internal_size()
		for view in buffers.get_view_count():
			# The buffers themselves cannot be copied from. They are linear; writing to this texture encodes them.
			var copy := passes.texture(size, RenderingDevice.DATA_FORMAT_R8G8B8A8_SRGB)
			passes.draw("look", [copy], [buffers.get_texture_slice("render_buffers", "color", view, 0, 1, 1)], push)
			pictures.append(Image.create_from_data(size.x, size.y, false, Image.FORMAT_RGBA8, passes.device.texture_get_data(copy, 0)))
			YoroPasses.free_all(passes.device, [copy])

	func _compare(scene: RenderSceneData, view: int, pose: Transform3D) -> void:
		var eye := scene.get_cam_transform().translated_local(scene.get_view_eye_offset(view))
		radians = maxf(radians, (eye.basis.inverse() * pose.basis).get_rotation_quaternion().get_angle())
		metres = maxf(metres, eye.origin.distance_to(pose.origin))


func _ready() -> void:
	for argument in OS.get_cmdline_user_args():
		out = argument.trim_prefix("out=") if argument.begins_with("out=") else out
		godot = argument.trim_prefix("godot=") if argument.begins_with("godot=") else godot
		frames = int(argument.trim_prefix("frames=")) if argument.begins_with("frames=") else frames
	var interface: OpenXRInterface = XRServer.primary_interface as OpenXRInterface
	if interface == null or not interface.is_initialized():
		print("fact runtime false")
		get_tree().quit(1)
		return
	interface.render_target_size_multiplier = 0.5
	var first := SubViewport.new()
	first.size = Vector2i(2, 2)
	first.render_target_update_mode = SubViewport.UPDATE_ALWAYS
	var holder := Camera3D.new()
	var hold := Hold.new()
	hold.at = Transform3D(Basis(), Vector3(0, 1.5, 0.4))
	holder.cull_mask = 0
	holder.environment = Environment.new()
	holder.compositor = Compositor.new()
	holder.compositor.compositor_effects = [hold]
	first.add_child(holder)
	add_child(first)
	move_child(first, 0)
	camera.compositor = Compositor.new()
	camera.compositor.compositor_effects = [look]
	await _frames(12)
	look.source = camera.source()
	print("fact views %d" % interface.get_view_count())
	await TestChoice.settle(camera)
	var was := hold.at
	# At an arm's length from the wall, past its right end: a fifth, two fifths and then most of the view is near, and
	# back again.
	var near: Array[bool] = []
	for x: float in [4.70, 4.55, 4.35, 4.55, 4.70]:
		hold.at = Transform3D(Basis(), Vector3(x, 1.5, -5.6))
		await _frames(8)
		near.append(camera.trouble().contains("near"))
		print("near at %.2f m: %.2f of the view" % [x, camera._nearness.share])
	print("fact near %s" % [near])
	hold.at = was
	interface.render_target_size_multiplier = 2.0
	await _case("plain")
	await _holes("plain")
	await _pause(interface)
	camera.holes = YoroCamera3D.Holes.PROJECT
	get_viewport().msaa_3d = Viewport.MSAA_4X
	await _case("msaa")
	await _holes("msaa")
	camera.holes = YoroCamera3D.Holes.PROJECT
	await TestLevels.save(camera, Vector3(-0.25, 0.1, -1.0), _pictures, out)
	get_viewport().msaa_3d = Viewport.MSAA_DISABLED
	camera.dominant_eye = YoroCamera3D.Eye.LEFT
	await _case("swapped", ["ONE_VIEW"])
	camera.dominant_eye = YoroCamera3D.Eye.RIGHT
	interface.render_target_size_multiplier = 1.5
	# Shadow maps are drawn with the stereo layers alone before Godot renders both eyes.
	room.lamp.shadow_enabled = true
	await _frames(2)
	await _case("resized")
	# The head moves again: these pictures are not compared.
	camera.holes = YoroCamera3D.Holes.RENDERED
	camera.foveation = YoroCamera3D.Foveation.HIGH
	interface.render_target_size_multiplier = 0.5
	first.queue_free()
	look.radians = 0.0
	look.metres = 0.0
	await _frames(maxi(frames - look.frames, 10))
	print("fact lag %.7f rad, %.7f m" % [look.radians, look.metres])
	print("fact frames %d" % look.frames)
	print("fact trouble %s" % [camera.trouble()])
	print("fact done")
	get_tree().quit()


func _frames(count: int) -> void:
	for i in count:
		await RenderingServer.frame_post_draw


## Lets another program take the headset for a while, which pauses the scene. Afterwards everything must be as before.
func _pause(interface: OpenXRInterface) -> void:
	var memory := _memory()
	var before := look.pictures
	var visitor := OS.create_process(godot, ["--path", ProjectSettings.globalize_path("res://"), "--audio-driver", "Dummy",
			"--xr-mode", "on", "res://test/visitor.tscn"])
	get_tree().paused = true
	await _until(func() -> bool: return not camera._is_shown(interface))
	await _frames(2)
	var drawn := look.frames
	await _frames(4)
	var rests := camera.source().wide.render_target_update_mode == SubViewport.UPDATE_DISABLED
	print("fact paused %s, drawn %d, rests %s" % [not camera._is_shown(interface), look.frames - drawn, rests])
	OS.kill(visitor)
	await _until(func() -> bool: return camera._is_shown(interface))
	await _case("resumed", ["ONE_VIEW"])
	get_tree().paused = false
	var levels := 0.0
	for view in 2:
		levels = maxf(levels, before[view].compute_image_metrics(look.pictures[view], false).root_mean_squared)
	print("resumed: %.3f of 255 from before, root mean square" % levels)
	# A small difference, of 60 dB, is allowed: the inverse transform that holds the head is rounded.
	print("fact resumed, as before %s, bytes more %d" % [levels < 0.25, _memory() - memory])


func _memory() -> int:
	return RenderingServer.get_rendering_info(RenderingServer.RENDERING_INFO_VIDEO_MEM_USED)


## Waits for a condition, up to a time limit.
func _until(holds: Callable) -> void:
	for i in 600:
		if holds.call():
			return
		await _frames(1)


func _case(name: String, modes: Array[String] = ["BOTH_VIEWS", "ONE_VIEW"]) -> void:
	for mode in modes:
		camera.mode = YoroCamera3D.Mode[mode]
		var pictures := await _pictures()
		for view in 2:
			pictures[view].save_png("%s/%s-%s-%s.png" % [out, name, mode.to_lower(), ["left", "right"][view]])


## Pictures with rendered holes, which stay so.
func _holes(name: String) -> void:
	camera.holes = YoroCamera3D.Holes.RENDERED
	await _case(name + "-holes", ["ONE_VIEW"])


func _pictures() -> Array[Image]:
	await _frames(2)
	look.wanted = true
	while look.wanted:
		await _frames(1)
	for picture in look.pictures:
		picture.convert(Image.FORMAT_RGB8)
	return look.pictures
