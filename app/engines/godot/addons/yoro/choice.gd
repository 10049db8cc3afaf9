## Measures in turns whether two rendered eyes or one with synthesis are cheaper here, and takes what is: the laws of
## [code]yoro::choice[/code] of yoro's library. Ways are the first two of [enum YoroCamera3D.Mode]; times are in milliseconds.
@tool
class_name YoroChoice
extends RefCounted

enum _Phase { SETTLES, MEASURES, RESTS }

## Longer times between frames are pauses.
const _PAUSE := 1000.0
const _SETTLING := 250.0
const _MEASURING := 1000.0
const _TURN := 125.0
const _TURN_FRAMES := 11
const _TURNS := 8
## The first turn of each way, which allocates and compiles what that needs, and the first frames of a turn do not count:
## caches are cold, and the GPU's times that become known are of earlier frames.
const _UNCOUNTED_TURNS := 2
const _UNCOUNTED := 7
## If one way's frames come this much faster, the other one misses the display's rate, whatever the GPU takes.
const _FASTER := 0.8
## Without the GPU's times, ways whose frames come at times that differ by less hold the same rate.
const _ALIKE := 0.95
## A choice changes if the other way costs less than this share.
const _SWITCH_BELOW := 0.9
## The share of the time that measuring may cost, the shortest rest and the longest one.
const _OVERHEAD := 0.002
const _REST: PackedFloat64Array = [6e4, 6e5]
## While it rests, windows are watched. A cost that differs from the first one's by this much ends the rest early.
const _WATCH := 2000.0
const _DRIFT := 1.3
const _LEAST_REST := 3e4

## The way that is taken.
var chosen := 0
## Why: unmeasured; cheaper; similar, so that the choice stays; alike, at the display's rate; or incomparable.
var reason := "unmeasured"
## The compared times of both ways: the GPU's, or between frames.
var times: Array = [0.0, 0.0]

var _phase := _Phase.SETTLES
var _begin := 0.0
## Of the turn, or the window.
var _turn_begin := 0.0
var _turn := 0
var _frames := 0
var _last := -INF
var _until := 0.0
var _first := 0.0
## By way.
var _costs: Array[Array] = [[], []]
var _intervals: Array[Array] = [[], []]


## Returns the way of the next frame.
func way() -> int:
	return (chosen + _turn) % 2


## Measures again: for another scene, another place in it, or other sizes.
func renew() -> void:
	reason = "unmeasured"
	_last = -INF
	_enter(_Phase.SETTLES, 0.0)


## Counts a frame that ended at [param now] and was made in the way [param made], or in neither if that is negative.
## [param cost] is the last time of the GPU that is known, or 0.
func end_frame(now: float, made: int, cost: float) -> void:
	var interval := now - _last
	_last = now
	_frames += 1
	if interval > _PAUSE:
		_enter(_phase if _phase == _Phase.RESTS else _Phase.SETTLES, now)
		return
	if made == way() and _frames > _UNCOUNTED and (_phase == _Phase.RESTS or _turn >= _UNCOUNTED_TURNS):
		_intervals[made].append(interval)
		if cost > 0.0:
			_costs[made].append(cost)
	match _phase:
		_Phase.SETTLES when now - _begin >= _SETTLING:
			_enter(_Phase.MEASURES, now)
		_Phase.MEASURES when _frames >= _TURN_FRAMES and now - _turn_begin >= _TURN:
			_turn += 1
			_turn_begin = now
			_frames = 0
			if _turn >= _TURNS and _turn % 2 == 0 and now - _begin >= _MEASURING:
				_choose(now)
		_Phase.RESTS when now >= _until or _has_changed(now):
			_enter(_Phase.MEASURES, now)


func _enter(phase: _Phase, now: float) -> void:
	_phase = phase
	_begin = now
	_turn_begin = now
	_turn = 0
	_frames = 0
	for samples: Array in _costs + _intervals:
		samples.clear()


func _choose(now: float) -> void:
	var paces := _intervals.map(_middle)
	times = _costs.map(_middle)
	var is_timed: bool = times.min() > 0.0 and paces.min() >= _FASTER * paces.max()
	if not is_timed:
		times = paces
	var least: float = times.min()
	var rest := _REST[0]
	if least <= 0.0:
		reason = "incomparable"
	elif not is_timed and least > _ALIKE * times.max():
		reason = "alike"
		rest = _REST[1]
	else:
		if least < times[chosen] * (1.0 if reason == "unmeasured" else _SWITCH_BELOW):
			chosen = times.find(least)
		reason = "cheaper" if times[chosen] == least else "similar"
		rest = clampf((now - _begin) * (times.max() / least - 1.0) / 2.0 / _OVERHEAD, _REST[0], _REST[1])
	_until = now + rest
	_first = 0.0
	_enter(_Phase.RESTS, now)


## True if a window ends now, and something has changed.
func _has_changed(now: float) -> bool:
	if now - _turn_begin < _WATCH:
		return false
	var time := _middle(_intervals[chosen] if _costs[chosen].is_empty() else _costs[chosen])
	_first = time if _first == 0.0 else _first
	_turn_begin = now
	_costs[chosen].clear()
	_intervals[chosen].clear()
	return time > 0.0 and now - _begin >= _LEAST_REST and maxf(time / _first, _first / time) > _DRIFT


## Returns the mean of the middle half, or 0 for fewer than four times.
func _middle(of: Array) -> float:
	if of.size() < 4:
		return 0.0
	of.sort()
	var quarter := of.size() >> 2
	var half := of.slice(quarter, of.size() - quarter)
	return half.reduce(func(sum: float, time: float) -> float: return sum + time) / half.size()
