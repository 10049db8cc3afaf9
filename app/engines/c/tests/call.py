"""Calls the library without its header, by ctypes, as any other language would: python3 call.py libyoro.so"""

import ctypes
import math
import sys
from ctypes import CFUNCTYPE, POINTER, Structure, byref, c_char_p, c_double, c_float, c_int32, c_uint32, c_void_p, sizeof

CALLBACK = CFUNCTYPE(None, c_void_p, c_int32, c_char_p)


class Messages(Structure):
    _fields_ = [("callback", CALLBACK), ("user", c_void_p)]


class Pose(Structure):
    _fields_ = [("orientation", c_float * 4), ("position", c_float * 3)]


class Fov(Structure):
    _fields_ = [(name, c_float) for name in ("left", "right", "up", "down")]


class Eyes(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("rendered", c_uint32),
        ("width", c_uint32),
        ("height", c_uint32),
        ("poses", Pose * 2),
        ("fovs", Fov * 2),
        ("near_z", c_float),
        ("far_z", c_float),
        ("depth", c_uint32),
        ("rows", c_uint32),
        ("clip", c_uint32),
        ("guard_band", c_float),
        ("flags", c_uint32),
        ("reserved", c_uint32),
        ("messages", Messages),
    ]


class View(Structure):
    _fields_ = [
        ("width", c_uint32),
        ("height", c_uint32),
        ("pose", Pose),
        ("fov", Fov),
        ("view", c_float * 16),
        ("projection", c_float * 16),
    ]


class Warp(Structure):
    _fields_ = [
        ("source_width", c_uint32),
        ("source_height", c_uint32),
        ("target_width", c_uint32),
        ("target_height", c_uint32),
        ("offset", c_double),
        ("scale", c_double),
        ("row_offset", c_int32),
        ("target_eye", c_uint32),
        ("depth", c_uint32),
        ("reserved", c_uint32),
    ]


class Views(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("crop_x", c_uint32),
        ("crop_y", c_uint32),
        ("reserved", c_uint32),
        ("source", View),
        ("rendered", View),
        ("synthesized", View),
        ("warp", Warp),
    ]


yoro = ctypes.CDLL(sys.argv[1])
yoro.yoro_result_text.restype = c_char_p
yoro.yoro_views_from_eyes.argtypes = [POINTER(Eyes), POINTER(Views)]
sentences = []


@CALLBACK
def on_error(user, result, sentence):
    sentences.append((user, result, sentence.decode()))


IPD, SIZE, NEAR = 0.063, 1000, 0.1
eyes = Eyes(struct_size=sizeof(Eyes), rendered=1, width=SIZE, height=SIZE, near_z=NEAR, far_z=math.inf, depth=1)
eyes.messages = Messages(on_error, 7)
for eye in (0, 1):
    eyes.poses[eye].orientation[3] = 1
    eyes.poses[eye].position[0] = (eye - 0.5) * IPD
    eyes.fovs[eye] = Fov(-math.pi / 4, math.pi / 4, math.pi / 4, -math.pi / 4)
views = Views(struct_size=sizeof(Views))
assert yoro.yoro_views_from_eyes(byref(eyes), byref(views)) == 0, sentences

# Equation 5 of the paper: a surface at z metres moves by the focal length in pixels times the IPD, divided by z. In
# reversed depth with an infinite far plane the depth buffer holds near / z.
warp, focal = views.warp, SIZE / 2
for z in (0.5, 2.0, 40.0):
    moved = warp.offset + warp.scale * NEAR / z
    assert abs(moved - focal * IPD / z) < 1e-3, (z, moved)
assert (views.source.width, views.crop_x, warp.target_eye) == (SIZE, 0, 0)
assert views.source.view[12] == -views.source.pose.position[0]

eyes.near_z = math.nan
assert yoro.yoro_views_from_eyes(byref(eyes), byref(views)) == -3
eyes.struct_size = 8
assert yoro.yoro_views_from_eyes(byref(eyes), byref(views)) == -2
assert yoro.yoro_views_from_eyes(None, byref(views)) == -1
assert [entry[:2] for entry in sentences] == [(7, -3)], sentences
assert "near" in sentences[0][2]
assert yoro.yoro_result_text(-5) == b"the eyes are canted"
assert yoro.yoro_version() > 0
print("called by ctypes")
