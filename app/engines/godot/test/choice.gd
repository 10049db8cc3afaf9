## Tests what [constant YoroCamera3D.Mode.AUTO] measures and chooses.
class_name TestChoice


## A device whose times are given by way: the GPU's, which become known three frames later, and those between frames.
class Device:
	var choice := YoroChoice.new()
	var gpu: Array
	var paces: Array
	## True if no eye can be synthesized.
	var is_near := false
	var now := 5000.0
	var _late: Array[float] = [0.0, 0.0, 0.0]

	func _init(of_gpu: Array, of_paces: Array) -> void:
		gpu = of_gpu
		paces = of_paces

	func frame() -> void:
		var way := choice.way()
		now += paces[way]
		_late.append(gpu[way])
		choice.end_frame(now, -1 if is_near and way == 0 else way, _late.pop_front())

	## Returns the choice after the next measurement.
	func measured() -> String:
		for rests: bool in [true, false]:
			while (choice._phase == YoroChoice._Phase.RESTS) == rests:
				frame()
		return "%d %s" % [choice.chosen, choice.reason]


## Frames at a rate that no load of the machine changes.
class Steady:
	extends YoroChoice
	var now := 0.0

	func end_frame(_now: float, made: int, cost: float) -> void:
		now += 20.0
		super(now, made, cost)


## Prints what is chosen with injected times.
static func print_laws() -> void:
	var chosen: Array[String] = []
	# The GPU's times; a rate that one way misses; no timestamps.
	for times: Array in [[[6.0, 9.0], [11.0, 11.0]], [[9.0, 6.0], [11.0, 11.0]], [[9.0, 6.0], [11.0, 22.0]],
			[[0.0, 0.0], [11.0, 11.0]], [[0.0, 0.0], [20.0, 12.0]]]:
		chosen.append(Device.new(times[0], times[1]).measured())
	var near := Device.new([9.0, 6.0], [11.0, 11.0])
	near.is_near = true
	chosen.append(near.measured())
	print("fact chosen %s" % [chosen])
	var device := Device.new([6.0, 9.0], [11.0, 11.0])
	device.measured()
	var took := device.now - 5000.0
	print("fact a time counts for its way: %s, within two seconds: %s" % [device.choice.times, took > 1200.0 and took < 2000.0])
	chosen.clear()
	for gpu: Array in [[9.3, 9.0], [13.0, 9.0]]:
		var begin := device.now
		while device.now - begin < 5000.0:
			device.frame()
		device.gpu = gpu
		chosen.append("%s after %s" % [device.measured(), "half a minute" if absf(device.now - begin - 32000.0) < 2000.0 else device.now - begin])
	print("fact then %s" % [chosen])


## Lets a camera choose, and says how. Calls [param see] with each way in its first turn.
static func settle(camera: YoroCamera3D, see := func(_way: int) -> void: pass) -> void:
	ProjectSettings.set_setting(YoroCamera3D.MODE_SETTING, YoroCamera3D.Mode.AUTO)
	camera.mode = YoroCamera3D.Mode.PROJECT
	var choice := Steady.new()
	camera.choice = choice
	var used := {}
	while choice.reason == "unmeasured":
		await RenderingServer.frame_post_draw
		if choice._turn >= YoroChoice._UNCOUNTED_TURNS:
			used[_used()] = true
		elif choice._phase == YoroChoice._Phase.MEASURES and choice._frames == YoroChoice._TURN_FRAMES - 1:
			see.call(choice.way())
	print("auto: %s, %s of %s" % [YoroCamera3D.Mode.find_key(camera.way()), choice.reason, choice.times])
	print("fact auto takes what is cheaper of both: %s, compiles and allocates nothing in turns: %s" % [
			choice.times.min() > 0.0 and choice.chosen == choice.times.find(choice.times.min()) and camera.way() == choice.chosen, used.size() == 1])
	ProjectSettings.set_setting(YoroCamera3D.MODE_SETTING, 0)


## Returns the pipelines that were compiled, and the GPU's memory in use.
static func _used() -> Array[int]:
	var infos := range(RenderingServer.RENDERING_INFO_VIDEO_MEM_USED, RenderingServer.RENDERING_INFO_PIPELINE_COMPILATIONS_SPECIALIZATION + 1)
	var used: Array[int] = []
	used.assign(infos.map(func(info: int) -> int: return RenderingServer.get_rendering_info(info as RenderingServer.RenderingInfo)))
	return used
