## The GPU's time for a frame of the demo with one view and with both, in turn: on an OpenXR runtime, or without one (two
## viewports are then Godot's stereo). Run it by hand, alone on the machine.
extends Node

## Blocks of each mode, and frames of a block; the first ones of a block are not counted.
const BLOCKS := 8
const FRAMES := 8
const SKIPPED := 3

@onready var camera: YoroCamera3D = $Demo/XROrigin3D/YoroCamera3D


func _ready() -> void:
	var interface: OpenXRInterface = XRServer.primary_interface as OpenXRInterface
	if interface != null and interface.is_initialized():
		interface.render_target_size_multiplier = 2.0
	await _frames(8)
	var shown: Array[Viewport] = [get_viewport()]
	var source: Viewport = camera.source_viewport()
	if camera.preview() != null:
		shown.assign(camera.preview().eyes)
		source = camera.preview().source
	for viewport: Viewport in shown + [source]:
		RenderingServer.viewport_set_measure_render_time(viewport.get_viewport_rid(), true)
	var times := {YoroCamera3D.Mode.BOTH_VIEWS: [], YoroCamera3D.Mode.ONE_VIEW: []}
	for block in BLOCKS:
		for mode: YoroCamera3D.Mode in times:
			camera.mode = mode
			await _frames(SKIPPED)
			for frame in FRAMES:
				await _frames(1)
				var drawn := shown.duplicate()
				if mode == YoroCamera3D.Mode.ONE_VIEW:
					drawn.append(source)
				var time := 0.0
				for viewport: Viewport in drawn:
					time += RenderingServer.viewport_get_measured_render_time_gpu(viewport.get_viewport_rid())
				times[mode].append(time)
	var medians: Array[float] = []
	for mode: YoroCamera3D.Mode in times:
		times[mode].sort()
		medians.append(times[mode][times[mode].size() / 2])
		print("fact %s: median %.1f ms of %d" % [YoroCamera3D.Mode.find_key(mode), medians[-1], times[mode].size()])
	print("fact ratio %.2f" % (medians[1] / medians[0]))
	get_tree().quit()


func _frames(count: int) -> void:
	for i in count:
		await RenderingServer.frame_post_draw
