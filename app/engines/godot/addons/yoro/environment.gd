## A copy of an environment that is kept up to date, except for some properties, which are overridden.
@tool
class_name YoroEnvironment
extends RefCounted

## The number of properties that are compared in each frame: all of them are compared within a tenth of a second.
const _EACH_FRAME := 12

## Overrides if nothing is lit. Godot updates a sky that viewports use with different lights for each of them, in each
## frame.
const _UNLIT := {
	sky = null, ambient_light_source = Environment.AMBIENT_SOURCE_DISABLED,
	reflected_light_source = Environment.REFLECTION_SOURCE_DISABLED,
}

## The copy, or null if there is nothing to copy.
var copy: Environment

var _of: Environment
var _always: Dictionary
var _overrides: Dictionary
var _lit := true
var _names: PackedStringArray
var _next := 0


func _init(overrides: Dictionary) -> void:
	_always = overrides
	_overrides = overrides
	for property in ClassDB.class_get_property_list(&"Environment", true):
		if property.usage & PROPERTY_USAGE_STORAGE:
			_names.append(property.name)


## Updates the copy. To be called in each frame. [param lit] is true if the copy lights what is drawn with it.
func follow(environment: Environment, lit := true) -> void:
	if environment != _of or lit != _lit:
		_of = environment
		_lit = lit
		_overrides = _always if lit else _always.merged(_UNLIT)
		copy = environment.duplicate() if environment != null else null
		if copy != null:
			for name: String in _overrides:
				copy.set(name, _overrides[name])
			_keep_light()
	if copy == null:
		return
	for i in _EACH_FRAME:
		var name := _names[_next]
		_next = (_next + 1) % _names.size()
		if not _overrides.has(name) and copy.get(name) != _of.get(name):
			copy.set(name, _of.get(name))
			_keep_light()


## Keeps the light that comes from the sky in the background, although the copy's background is another.
func _keep_light() -> void:
	if _lit and _overrides.has("background_mode") and _of.background_mode == Environment.BG_SKY:
		if _of.ambient_light_source == Environment.AMBIENT_SOURCE_BG:
			copy.ambient_light_source = Environment.AMBIENT_SOURCE_SKY
		if _of.reflected_light_source == Environment.REFLECTION_SOURCE_BG:
			copy.reflected_light_source = Environment.REFLECTION_SOURCE_SKY
