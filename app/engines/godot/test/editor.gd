## Tests the editor with a scene that does not use the add-on yet: what the yoro menu does, and what undo restores. It
## emits the signals that a user's clicks would emit. With a display, pictures of the editor are saved to `out=FOLDER`.
extends SceneTree

enum Item { REPLACE, MARK, PREVIEW }

const STEREO := YoroMarks.LAYER

var out := ""
var menu: PopupMenu


func _initialize() -> void:
	for argument in OS.get_cmdline_user_args():
		out = argument.trim_prefix("out=") if argument.begins_with("out=") else out
	await _frames(30)
	EditorInterface.open_scene_from_path("res://test/editor.tscn")
	EditorInterface.set_main_screen_editor("3D")
	await _frames(30)
	for button: MenuButton in EditorInterface.get_base_control().find_children("*", "MenuButton", true, false):
		if button.text == "yoro":
			menu = button.get_popup()
	var scene := EditorInterface.get_edited_scene_root()
	var camera: XRCamera3D = scene.get_node("XROrigin3D/Head")
	var glass: MeshInstance3D = scene.get_node("Glass")
	var box: MeshInstance3D = scene.get_node("Box")
	var lights: Array[VisualInstance3D] = [scene.get_node("Sun"), scene.get_node("Probe")]
	await _choose(Item.MARK)
	print("fact without a camera of ours nothing is marked: %s" % [glass.layers == 1])
	await _choose(Item.REPLACE)
	print("fact replaced %s, near %s, children %d" % [camera is YoroCamera3D, camera.near, camera.get_child_count()])
	print("fact warnings before: %d" % camera._get_configuration_warnings().size())
	if out != "":
		_open(camera)
	await _picture("menu")
	await _choose(Item.MARK)
	var lit := lights.all(func(light: VisualInstance3D) -> bool: return light.layers == 1 | STEREO)
	print("fact glass on its own layer %s, box as it was %s, lights on both %s" % [glass.layers == STEREO, box.layers == 1, lit])
	print("fact stereo layers %d" % camera.stereo_layers)
	print("fact warnings after: %d" % camera._get_configuration_warnings().size())
	if RenderingServer.get_rendering_device() != null:
		await _choose(Item.PREVIEW)
		await _frames(10)
		await _picture("preview")
		await _choose(Item.PREVIEW)
	var manager := EditorInterface.get_editor_undo_redo()
	var history := manager.get_history_undo_redo(manager.get_object_history_id(scene))
	history.undo()
	print("fact unmarked %s" % [camera.stereo_layers == 0 and glass.layers == 1 and lights.all(func(light: VisualInstance3D) -> bool: return light.layers == 1)])
	history.undo()
	print("fact put back %s" % [not camera is YoroCamera3D])
	print("fact done")
	quit()


func _choose(item: Item) -> void:
	menu.id_pressed.emit(item)
	await _frames(3)


func _frames(count: int) -> void:
	for i in count:
		await process_frame


## Saves a picture of the whole editor.
func _picture(name: String) -> void:
	if out != "":
		await _frames(20)
		EditorInterface.get_base_control().get_viewport().get_texture().get_image().save_png("%s/%s.png" % [out, name])


## Opens the menu, and the warning of a node in the scene tree.
func _open(node: Node) -> void:
	const WARNING := 5
	var editor: Node = EditorInterface.get_base_control().find_children("*", "SceneTreeEditor", true, false)[0]
	var tree: Tree = editor.find_children("*", "Tree", true, false)[0]
	var item := tree.get_root()
	while item.get_text(0) != node.name:
		item = item.get_next_in_tree()
	tree.button_clicked.emit(item, 0, WARNING, MOUSE_BUTTON_LEFT)
	var button: MenuButton = menu.get_parent()
	button.show_popup()
