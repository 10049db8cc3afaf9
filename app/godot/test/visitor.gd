## A second program on the same OpenXR runtime: while it runs, the headset is its own and the first one's session is paused.
extends Node3D


func _ready() -> void:
	get_viewport().use_xr = true
