#!/usr/bin/env python3
"""Makes the files that the tests of the patchers compare with, in this folder.

pip install numpy pillow opencv-python-headless onnx
./make.py GROUPS    # GROUPS: yoro dataset talk --groups 3 --size 512 --out GROUPS

NAME.png is a picture without holes, NAME.mask.png is black where holes are cut into it, NAME.telea.png and
NAME.navier-stokes.png are what OpenCV fills them with at radius 3. Holes keep off the picture's border, where OpenCV and
this project differ. The ONNX files have what a model for the neural patcher must not have.
"""

import sys
from pathlib import Path

import cv2
import numpy as np
import onnx
from onnx import TensorProto, helper

BORDER = 6


def save(name, color, hole):
    hole = hole.copy()
    hole[:BORDER], hole[-BORDER:], hole[:, :BORDER], hole[:, -BORDER:] = 0, 0, 0, 0
    cv2.imwrite(f"{name}.png", color)
    cv2.imwrite(f"{name}.mask.png", np.where(hole, 0, 255).astype(np.uint8))
    holed = np.where(hole[..., None], 0, color).astype(np.uint8)
    for method, flag in (("telea", cv2.INPAINT_TELEA), ("navier-stokes", cv2.INPAINT_NS)):
        cv2.imwrite(f"{name}.{method}.png", cv2.inpaint(holed, hole.astype(np.uint8), 3, flag))


def shapes():
    """Smooth shades and two straight edges; a disc, a bar, a ring, single pixels and a diagonal line."""
    height, width = 72, 96
    y, x = np.mgrid[:height, :width].astype(float)
    color = np.stack([90 + 60 * np.sin(x / 9), 120 + 50 * np.cos(y / 7), 100 + x * 0.8], axis=-1)
    color[x > 60] += [60, -40, 20]
    color[y > x] += [-30, 30, 40]
    hole = (x - 25) ** 2 + (y - 22) ** 2 < 8 ** 2
    hole |= (abs(x - 60) < 3) & (abs(y - 36) < 22)
    ring = np.hypot(x - 78, y - 24)
    hole |= (ring > 5) & (ring < 9)
    hole |= (x % 11 == 0) & (y % 9 == 0)
    hole |= abs(x - y + 6) < 2
    return np.clip(color, 0, 255).astype(np.uint8), hole


def group(folder):
    """A part of a real picture with the holes of its group."""
    part = slice(120, 250), slice(100, 280)
    color = cv2.imread(str(folder / "talk/truth/000001.png"))
    mask = cv2.imread(str(folder / "talk/mask/000001.png"), cv2.IMREAD_GRAYSCALE)
    return color[part], mask[part] == 0


def model(name, shape, output_shape):
    value = lambda n, s: helper.make_tensor_value_info(n, TensorProto.FLOAT, s)
    graph = helper.make_graph([helper.make_node("Identity", ["input"], ["output"])], name,
                              [value("input", shape)], [value("output", output_shape)])
    onnx.save(helper.make_model(graph, opset_imports=[helper.make_opsetid("", 18)], ir_version=8), f"{name}.onnx")


if __name__ == "__main__":
    save("shapes", *shapes())
    save("talk", *group(Path(sys.argv[1])))
    model("three-channels", [1, 3, "height", "width"], [1, 3, "height", "width"])
    model("fixed-size", [1, 5, 64, 64], [1, 5, 64, 64])
    model("wrong-output", [1, 5, "height", "width"], [1, 5, "height", "width"])
