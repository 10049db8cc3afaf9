## Finds transparent things, and which of them, and of the lights, are on the layers that Godot draws for both eyes.
@tool
class_name YoroMarks
extends RefCounted

## The layer for things that Godot draws for both eyes, if the user has chosen none.
const LAYER := 1 << 19


## Returns sentences about what will look wrong in a scene.
static func warnings(scene: Node, layers: int) -> PackedStringArray:
	var sentences := PackedStringArray()
	if scene == null:
		return sentences
	var marked := not drawn(scene, layers).is_empty()
	var dark := lights(scene).filter(func(light: VisualInstance3D) -> bool: return light.layers & layers == 0)
	if marked and not dark.is_empty():
		sentences.append("Lights and probes that are not on the stereo layers leave things there too dark, and the sky is made anew in each frame: %d, %s first." % [dark.size(), dark[0].name])
	var moved := transparent(scene).filter(func(thing: VisualInstance3D) -> bool: return thing.layers & layers == 0)
	if not moved.is_empty():
		sentences.append("Transparent things that are not on the stereo layers move with what lies behind them: %d, %s first." % [moved.size(), moved[0].name])
	return sentences


## Returns all things of a scene that are on [param layers].
static func drawn(scene: Node, layers: int) -> Array[VisualInstance3D]:
	return _all(scene, func(node: VisualInstance3D) -> bool: return node is GeometryInstance3D and node.layers & layers != 0)


## Returns all lights and probes of a scene.
static func lights(scene: Node) -> Array[VisualInstance3D]:
	return _all(scene, func(node: VisualInstance3D) -> bool: return node is Light3D or node is ReflectionProbe)


## Returns all transparent things of a scene.
static func transparent(scene: Node) -> Array[VisualInstance3D]:
	return _all(scene, func(node: VisualInstance3D) -> bool: return node is GeometryInstance3D and _is_transparent(node))


## True if a material is drawn after opaque ones. For shaders this is a guess from their code.
static func is_transparent_material(material: Material) -> bool:
	if material is BaseMaterial3D:
		return (material.transparency in [BaseMaterial3D.TRANSPARENCY_ALPHA, BaseMaterial3D.TRANSPARENCY_ALPHA_DEPTH_PRE_PASS]
				or material.blend_mode != BaseMaterial3D.BLEND_MODE_MIX or material.refraction_enabled)
	if material is ShaderMaterial and material.shader != null:
		var code: String = material.shader.code
		var blends := RegEx.create_from_string("\\bALPHA\\b|blend_(add|sub|mul|premul_alpha)|hint_screen_texture|hint_depth_texture")
		return blends.search(code) != null and not code.contains("ALPHA_SCISSOR_THRESHOLD")
	return false


static func _is_transparent(thing: GeometryInstance3D) -> bool:
	if thing.transparency > 0.0:
		return true
	if thing.material_override != null or thing.material_overlay != null:
		return is_transparent_material(thing.material_override) or is_transparent_material(thing.material_overlay)
	if thing is MeshInstance3D:
		for i in thing.get_surface_override_material_count():
			if is_transparent_material(thing.get_active_material(i)):
				return true
		return false
	if thing is SpriteBase3D:
		return thing.transparent and thing.alpha_cut == SpriteBase3D.ALPHA_CUT_DISABLED
	if thing is Label3D:
		return thing.alpha_cut == Label3D.ALPHA_CUT_DISABLED
	var meshes: Array[Mesh] = []
	if thing is GPUParticles3D:
		for i in thing.draw_passes:
			meshes.append(thing.get_draw_pass_mesh(i))
	elif thing is CPUParticles3D:
		meshes.append(thing.mesh)
	elif thing is MultiMeshInstance3D and thing.multimesh != null:
		meshes.append(thing.multimesh.mesh)
	elif &"material" in thing:
		# CSG shapes.
		return is_transparent_material(thing.get(&"material"))
	for mesh in meshes:
		for i in mesh.get_surface_count() if mesh != null else 0:
			if is_transparent_material(mesh.surface_get_material(i)):
				return true
	return false


static func _all(node: Node, wanted: Callable) -> Array[VisualInstance3D]:
	var found: Array[VisualInstance3D] = []
	if node is VisualInstance3D and wanted.call(node):
		found.append(node)
	for child in node.get_children():
		found.append_array(_all(child, wanted))
	return found
