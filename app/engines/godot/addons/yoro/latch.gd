## Places the cameras of the rendered eye and of the other eye's holes when a frame is drawn. OpenXR locates the eyes
## anew after all scripts have run, so scripts see the poses of the last frame. This effect belongs to the camera of a
## tiny viewport that is drawn before theirs.
@tool
class_name YoroLatch
extends CompositorEffect

var interface: XRInterface
var cameras: Array[RID] = []
var rendered := 1
## The camera of the other eye's holes, and its place in the axes of the rendered eye, in metres.
var other: RID
var apart: Vector3


func _init() -> void:
	effect_callback_type = EFFECT_CALLBACK_TYPE_PRE_OPAQUE


func _render_callback(_type: int, _data: RenderData) -> void:
	if interface != null and interface.is_initialized():
		var at := interface.get_transform_for_view(rendered, XRServer.world_origin)
		for camera in cameras:
			RenderingServer.camera_set_transform(camera, at)
		RenderingServer.camera_set_transform(other, at.translated_local(apart))
