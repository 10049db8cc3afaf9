## Measures the cost of a frame of the demo, on an OpenXR runtime or without one (then two viewports stand in for
## Godot's stereo). Without arguments, all variants take turns. A runtime paces a program by its previous frames, so to
## measure the time between frames, run one variant in a process of its own: `only=NUMBER`. `blocks=COUNT` is the number
## of turns of each variant. Godot's option `--gpu-profile` adds the stages of each viewport. Run it by hand.
extends Node

## The settings of each variant. The first one is Godot's stereo.
const VARIANTS: Array[Dictionary] = [
	{mode = YoroCamera3D.Mode.BOTH_VIEWS, near_limit = 0.4, stereo_layers = DemoRoom.STEREO, foveation = YoroCamera3D.Foveation.OFF},
	{mode = YoroCamera3D.Mode.ONE_VIEW, near_limit = 0.4, stereo_layers = DemoRoom.STEREO, foveation = YoroCamera3D.Foveation.OFF},
	{mode = YoroCamera3D.Mode.ONE_VIEW, near_limit = 0.0, stereo_layers = DemoRoom.STEREO, foveation = YoroCamera3D.Foveation.OFF},
	{mode = YoroCamera3D.Mode.ONE_VIEW, near_limit = 0.4, stereo_layers = 0, foveation = YoroCamera3D.Foveation.OFF},
	{mode = YoroCamera3D.Mode.ONE_VIEW, near_limit = 0.4, stereo_layers = 0, foveation = YoroCamera3D.Foveation.MEDIUM},
	{mode = YoroCamera3D.Mode.ONE_VIEW, near_limit = 0.4, stereo_layers = 0, foveation = YoroCamera3D.Foveation.HIGH},
]
## The number of measured frames in a block. The [constant SKIPPED] frames before them are not counted.
const FRAMES := 8
const SKIPPED := 3
## The clock ticks per second in /proc.
const TICKS := 100.0

@onready var camera: YoroCamera3D = $Demo/XROrigin3D/YoroCamera3D


func _ready() -> void:
	var blocks := 8
	var wanted := range(VARIANTS.size())
	for argument in OS.get_cmdline_user_args():
		blocks = int(argument.trim_prefix("blocks=")) if argument.begins_with("blocks=") else blocks
		wanted = [int(argument.trim_prefix("only="))] if argument.begins_with("only=") else wanted
	var interface: OpenXRInterface = XRServer.primary_interface as OpenXRInterface
	if interface != null and interface.is_initialized():
		interface.render_target_size_multiplier = 2.0
	await _frames(12)
	var shown: Array[Viewport] = [get_viewport()]
	if camera.preview() != null:
		shown.assign(camera.preview().eyes)
	var levels: Array[Viewport] = [camera.source().wide, camera.source().inset]
	for viewport: Viewport in shown + levels:
		RenderingServer.viewport_set_measure_render_time(viewport.get_viewport_rid(), true)
	var times: Array[Dictionary] = []
	for variant in VARIANTS:
		times.append({frame = [], processor = [], shown = [], eye = []})
	var stages: Array[Dictionary] = []
	stages.assign(VARIANTS.map(func(_it: Dictionary) -> Dictionary: return {}))
	for block in blocks:
		for i: int in wanted:
			for property: String in VARIANTS[i]:
				camera.set(property, VARIANTS[i][property])
			await _frames(SKIPPED)
			var processor := _processor()
			for frame in FRAMES:
				var start := Time.get_ticks_usec()
				await _frames(1)
				times[i].frame.append((Time.get_ticks_usec() - start) / 1000.0)
				_add_stages(stages[i])
				times[i].shown.append(_gpu(shown))
				times[i].eye.append(_gpu(levels.slice(0, _drawn())))
			times[i].processor.append((_processor() - processor) * 1000.0 / FRAMES)
	for i: int in wanted:
		var medians: Array[float] = []
		for part: String in times[i]:
			medians.append(_median(times[i][part]))
		print("fact %d: a frame %.1f ms, processor %.1f ms, GPU: shown %.1f ms, rendered eye %.1f ms" % ([i] + medians))
		for stage: String in stages[i]:
			if _median(stages[i][stage]) >= 1.0:
				print("stage %d, viewport %s: %.1f ms" % [i, stage, _median(stages[i][stage])])
	get_tree().quit()


## Returns how many levels are drawn.
func _drawn() -> int:
	return camera.source().drawn().size() if camera.mode == YoroCamera3D.Mode.ONE_VIEW else 0


## Returns the GPU time of the viewports' last frame, in ms.
func _gpu(viewports: Array[Viewport]) -> float:
	var time := 0.0
	for viewport in viewports:
		time += RenderingServer.viewport_get_measured_render_time_gpu(viewport.get_viewport_rid())
	return time


## Adds the GPU time of each stage that Godot names, in ms. A stage lasts until the next one begins.
func _add_stages(to: Dictionary) -> void:
	var device := RenderingServer.get_rendering_device()
	var viewport := 0
	for i in device.get_captured_timestamps_count() - 1:
		var stage := device.get_captured_timestamp_name(i)
		viewport += int(stage == "Update Occlusion Buffer")
		var values: Array = to.get_or_add("%d %s" % [viewport, stage], [])
		values.append((device.get_captured_timestamp_gpu_time(i + 1) - device.get_captured_timestamp_gpu_time(i)) / 1e6)


func _median(values: Array) -> float:
	values.sort()
	return values[values.size() / 2]


## Returns the CPU time of all threads of this program in seconds, on Linux.
func _processor() -> float:
	var fields := FileAccess.open("/proc/self/stat", FileAccess.READ).get_line().get_slice(") ", 1).split(" ")
	return (float(fields[11]) + float(fields[12])) / TICKS


func _frames(count: int) -> void:
	for i in count:
		await RenderingServer.frame_post_draw
