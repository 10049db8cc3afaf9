## The editor plugin: a menu above the 3D view, and a preview of both eyes.
@tool
extends EditorPlugin

enum _Item { REPLACE, MARK, PREVIEW }

var _menu := MenuButton.new()
var _preview: YoroPreview


func _enter_tree() -> void:
	var settings := {
		YoroCamera3D.MODE_SETTING: "One View:0,Both Views:1,Auto:3", YoroCamera3D.FOVEATION_SETTING: "Off,Low,Medium,High",
		YoroCamera3D.HOLES_SETTING: "Filled,Rendered",
	}
	for setting: String in settings:
		if not ProjectSettings.has_setting(setting):
			ProjectSettings.set_setting(setting, 0)
		ProjectSettings.set_initial_value(setting, 0)
		ProjectSettings.set_as_basic(setting, true)
		ProjectSettings.add_property_info({name = setting, type = TYPE_INT, hint = PROPERTY_HINT_ENUM, hint_string = settings[setting]})
	_menu.text = "yoro"
	_menu.tooltip_text = "One rendered eye, one synthesized."
	var popup := _menu.get_popup()
	popup.add_item("Put YoroCamera3D in Place of XRCamera3D", _Item.REPLACE)
	popup.add_item("Draw Transparent Things for Both Eyes", _Item.MARK)
	popup.add_check_item("Preview Both Eyes", _Item.PREVIEW)
	popup.set_item_tooltip(_Item.MARK, "Puts transparent things, all lights and reflection probes onto the camera's stereo layers.")
	popup.id_pressed.connect(_choose)
	add_control_to_container(CONTAINER_SPATIAL_EDITOR_MENU, _menu)


func _exit_tree() -> void:
	_show_preview(false)
	remove_control_from_container(CONTAINER_SPATIAL_EDITOR_MENU, _menu)
	_menu.queue_free()


func _choose(id: int) -> void:
	var scene := EditorInterface.get_edited_scene_root()
	match id:
		_Item.REPLACE:
			for camera: XRCamera3D in _cameras(scene):
				if camera is YoroCamera3D:
					continue
				if camera.get_script() != null:
					_say("%s has a script of its own: let it extend YoroCamera3D." % camera.name)
				else:
					replace(camera)
				return
			var others := scene.find_children("*", "Camera3D") if scene != null else []
			_say("This scene has no XRCamera3D to replace%s." % (
					"" if others.is_empty() else ": make %s one first, by Change Type in its menu" % others[0].name))
		_Item.MARK:
			var camera := _camera(scene)
			if camera == null:
				_say("This scene has no YoroCamera3D.")
			else:
				mark(scene, camera)
		_Item.PREVIEW:
			_show_preview(_preview == null)


## Makes a camera a YoroCamera3D by setting its script. Its name, children and properties stay.
func replace(camera: XRCamera3D) -> void:
	var undo := get_undo_redo()
	undo.create_action("Put YoroCamera3D in Place of XRCamera3D", UndoRedo.MERGE_DISABLE, camera)
	undo.add_do_method(camera, &"set_script", load("res://addons/yoro/camera.gd"))
	undo.add_undo_method(camera, &"set_script", camera.get_script())
	undo.commit_action()
	camera.update_configuration_warnings()


## Puts transparent things and lights onto the stereo layers.
func mark(scene: Node, camera: YoroCamera3D) -> void:
	var undo := get_undo_redo()
	undo.create_action("Draw Transparent Things for Both Eyes", UndoRedo.MERGE_DISABLE, scene)
	for change in YoroMarks.changes(scene, camera):
		undo.add_do_property(change.node, change.property, change.value)
		undo.add_undo_property(change.node, change.property, change.node.get(change.property))
	undo.commit_action()
	camera.update_configuration_warnings()


func _process(_delta: float) -> void:
	if _preview != null:
		_preview.camera = _previewed()


func _show_preview(shown: bool) -> void:
	if shown == (_preview != null):
		return
	if shown and RenderingServer.get_rendering_device() == null:
		_say("The Compatibility renderer cannot show this: choose Mobile or Forward+.")
		return
	_menu.get_popup().set_item_checked(_Item.PREVIEW, shown)
	if not shown:
		remove_control_from_bottom_panel(_preview)
		_preview.queue_free()
		_preview = null
		return
	_preview = YoroPreview.new(_previewed())
	_preview.custom_minimum_size = Vector2(0, 240)
	add_control_to_bottom_panel(_preview, "yoro")
	make_bottom_panel_item_visible(_preview)
	var camera := _camera(EditorInterface.get_edited_scene_root())
	if camera == null:
		_say("This scene has no YoroCamera3D yet.")
	elif _previewed() == null:
		_say("The editor does not run the script of %s, which is no @tool: preview it in the running project." % camera.name)
	elif YoroPreview.fault(camera) != "":
		_say("There is no preview of %s, since %s." % [camera.name, YoroPreview.fault(camera)])


## Returns the edited scene's camera, or null if it has none that runs in the editor.
func _previewed() -> YoroCamera3D:
	var camera := _camera(EditorInterface.get_edited_scene_root())
	return camera if camera != null and (camera.get_script() as Script).is_tool() else null


func _cameras(scene: Node) -> Array[Node]:
	if scene == null:
		return []
	var found := scene.find_children("*", "XRCamera3D", true, false)
	if scene is XRCamera3D:
		found.push_front(scene)
	return found


func _camera(scene: Node) -> YoroCamera3D:
	for camera in _cameras(scene):
		if camera is YoroCamera3D:
			return camera
	return null


func _say(sentence: String) -> void:
	EditorInterface.get_editor_toaster().push_toast(sentence)
