## A second program on the same OpenXR runtime. While it runs, it has the headset, and the first program's session is
## paused.
extends Node3D


func _ready() -> void:
	get_viewport().use_xr = true
