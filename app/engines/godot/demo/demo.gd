## A room, shown in a headset, or with both eyes side by side on a screen. The space bar changes how the eyes are made.
extends Node3D

@onready var camera: YoroCamera3D = $XROrigin3D/YoroCamera3D


func _ready() -> void:
	var interface := XRServer.find_interface("OpenXR")
	get_viewport().use_xr = interface != null and interface.is_initialized()


func _unhandled_key_input(event: InputEvent) -> void:
	if event.is_pressed() and event.keycode == KEY_SPACE:
		camera.mode = wrapi(camera.mode + 1, 0, YoroCamera3D.Mode.size()) as YoroCamera3D.Mode
		print(YoroCamera3D.Mode.find_key(camera.mode))
