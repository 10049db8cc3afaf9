## A camera with callbacks of its own.
extends YoroCamera3D

var is_ready := false


func _ready() -> void:
	is_ready = true


func _exit_tree() -> void:
	is_ready = false
