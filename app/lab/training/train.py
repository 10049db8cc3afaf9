#!/usr/bin/env python3
"""Trains the neural patcher and writes it as ONNX. See README.md for the data and the command.

A small pix2pix-style pair (Isola et al. 2017): a U-Net generator and a patch discriminator. The generator sees the
reprojected image with its holes filled roughly, the mask and the disparity, and adds a correction; only holes count.
"""

import argparse
import json
import random
import time
from pathlib import Path

import numpy as np
import onnx
import torch
import torch.nn.functional as F
from PIL import Image
from torch import nn

CROP = 256
# Sizes must be multiples of this: the generator halves them four times.
MULTIPLE = 16


def read(path):
    return np.asarray(Image.open(path))


def load_group(folder, index):
    """One group in forward columns: the background of a disocclusion is on its left, whichever eye is dominant."""
    group = json.loads((folder / "group" / f"{index:06}.json").read_text())
    name = f"{index:06}.png"
    color = read(folder / "reprojected" / name).astype(np.float32) / 255
    truth = read(folder / "truth" / name).astype(np.float32) / 255
    hole = read(folder / "mask" / name) == 0
    depth = read(folder / "reprojected-depth" / name).astype(np.float32) / 65535
    nearness = depth if group["depth"]["encoding"] == "reversed-z" else 1 - depth
    if group["dominant"] == "left":
        color, truth, hole, nearness = (a[:, ::-1] for a in (color, truth, hole, nearness))
    nearness = np.where(hole, 0, nearness)
    color, nearness = rough_fill(color, nearness, hole)
    disparity = nearness / max(nearness.max(), 1e-6)
    return color, disparity, hole, truth


def rough_fill(color, disparity, hole):
    """Each hole takes colour and disparity of the farther of its two ends in the row, the left one when equal.
    `rough_fill` in app/lab/bench/src/inpaint/neural.rs does the same."""
    height, width = hole.shape
    columns = np.broadcast_to(np.arange(width), hole.shape)
    left = np.maximum.accumulate(np.where(hole, -1, columns), axis=1)
    right = np.minimum.accumulate(np.where(hole, width, columns)[:, ::-1], axis=1)[:, ::-1]
    rows = np.arange(height)[:, None]
    at = lambda x: disparity[rows, np.clip(x, 0, width - 1)]
    take_right = (left < 0) | ((right < width) & (at(right) < at(left)))
    source = np.clip(np.where(take_right, right, left), 0, width - 1)
    return color[rows, source], disparity[rows, source]


def load(folders):
    groups = []
    for folder in folders:
        for file in sorted((folder / "group").glob("*.json")):
            color, disparity, hole, truth = load_group(folder, int(file.stem))
            to_bytes = lambda a: torch.from_numpy(np.rint(a * 255).astype(np.uint8).copy())
            groups.append((to_bytes(color), torch.from_numpy(disparity.astype(np.float16).copy()),
                           torch.from_numpy(hole.copy()), to_bytes(truth)))
    if not groups:
        raise SystemExit(f"no groups in {', '.join(map(str, folders))}: make them as README.md says")
    return groups


def crop(groups, rng):
    """A random crop with holes: [5, CROP, CROP] of input and [3, CROP, CROP] of truth."""
    for _ in range(20):
        color, disparity, hole, truth = groups[rng.randrange(len(groups))]
        height, width = hole.shape
        y, x = rng.randrange(height - CROP + 1), rng.randrange(width - CROP + 1)
        part = slice(y, y + CROP), slice(x, x + CROP)
        if hole[part].float().mean() > 0.01:
            break
    # Brightness is the one augmentation that leaves geometry as it is; a flip would put the background on the right.
    gain = rng.uniform(0.7, 1.2)
    picture = lambda a: (a[part].permute(2, 0, 1).float() / 255 * gain).clamp(0, 1)
    masks = torch.stack([hole[part].float(), disparity[part].float()])
    return torch.cat([picture(color), masks]), picture(truth)


class Generator(nn.Module):
    """U-Net of four halvings. Input [n, 5, h, w]: roughly filled RGB from 0 to 1, hole (1) or valid (0), disparity from
    0 (far plane) to 1 (the nearest pixel). Output [n, 3, h, w]: RGB, not clamped, meant for the holes."""

    def __init__(self):
        super().__init__()
        widths = [16, 32, 64, 96, 96]
        self.first = nn.Conv2d(5, widths[0], 3, padding=1)
        self.down = nn.ModuleList(nn.Conv2d(a, b, 4, stride=2, padding=1) for a, b in zip(widths, widths[1:]))
        self.middle = nn.ModuleList(nn.Conv2d(96, 96, 3, padding=d, dilation=d) for d in (2, 4))
        self.up = nn.ModuleList(
            nn.Conv2d(a + b, b, 3, padding=1) for a, b in zip(widths[:0:-1], widths[-2::-1]))
        self.last = nn.Conv2d(widths[0], 3, 3, padding=1)
        # An untrained generator changes nothing.
        nn.init.zeros_(self.last.weight)
        nn.init.zeros_(self.last.bias)

    def forward(self, x):
        activate = lambda t: F.leaky_relu(t, 0.2)
        features = [activate(self.first(x))]
        for layer in self.down:
            features.append(activate(layer(features[-1])))
        t = features.pop()
        for layer in self.middle:
            t = t + activate(layer(t))
        for layer in self.up:
            t = F.interpolate(t, scale_factor=2.0, mode="nearest")
            t = activate(layer(torch.cat([t, features.pop()], dim=1)))
        return x[:, :3] + self.last(t)


class Discriminator(nn.Module):
    """Says for each patch of 22 x 22 pixels whether it looks rendered; sees the mask, too."""

    def __init__(self):
        super().__init__()
        self.layers = nn.Sequential(
            nn.Conv2d(4, 32, 4, stride=2, padding=1), nn.LeakyReLU(0.2),
            nn.Conv2d(32, 64, 4, stride=2, padding=1), nn.LeakyReLU(0.2),
            nn.Conv2d(64, 1, 4, padding=1))

    def forward(self, picture, hole):
        return self.layers(torch.cat([picture, hole], dim=1))


def compose(output, x):
    """The picture as the patcher gives it: the output in holes, the input elsewhere."""
    hole = x[:, 3:4]
    return output * hole + x[:, :3] * (1 - hole)


def psnr_of_holes(generator, groups):
    """Mean squared error in the holes of whole images as PSNR: generator and rough fill."""
    errors = np.zeros(2)
    count = 0
    with torch.no_grad():
        for color, disparity, hole, truth in groups:
            height, width = (n // MULTIPLE * MULTIPLE for n in hole.shape)
            part = slice(0, height), slice(0, width)
            picture = lambda a: a[part].permute(2, 0, 1).float()[None] / 255
            masks = torch.stack([hole[part].float(), disparity[part].float()])[None]
            x = torch.cat([picture(color), masks], dim=1)
            where = x[:, 3:4].expand(-1, 3, -1, -1) > 0.5
            for i, image in enumerate([generator(x).clamp(0, 1), x[:, :3]]):
                errors[i] += ((image - picture(truth))[where] ** 2).sum().item()
            count += where.sum().item()
    return -10 * np.log10(errors / count)


def export(generator, path):
    generator.eval()
    example = torch.zeros(1, 5, 64, 96)
    axes = {2: torch.export.Dim("h16", min=1, max=1024) * MULTIPLE, 3: torch.export.Dim("w16", min=1, max=1024) * MULTIPLE}
    program = torch.onnx.export(generator, (example,), dynamo=True, opset_version=18, dynamic_shapes=(axes,),
                                input_names=["input"], output_names=["output"], external_data=False)
    path.parent.mkdir(parents=True, exist_ok=True)
    program.save(str(path), external_data=False)
    strip(path)


def strip(path):
    """Removes the exporter's stack traces, which contain paths of this machine."""
    model = onnx.load(path)
    graph = model.graph
    for part in [model, graph, *graph.node, *graph.value_info, *graph.input, *graph.output, *graph.initializer]:
        part.ClearField("doc_string")
        part.ClearField("metadata_props")
    onnx.save(model, path)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, nargs="+", required=True, help="folders written by `yoro dataset`")
    parser.add_argument("--hold-out", nargs="*", default=["prototype"], help="scenes that are not trained on, but reported")
    parser.add_argument("--out", type=Path, default=Path("app/lab/training/patcher.onnx"))
    parser.add_argument("--steps", type=int, default=2000)
    parser.add_argument("--minutes", type=float, default=1e9, help="stop after this time, whatever --steps says")
    parser.add_argument("--batch", type=int, default=4)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--threads", type=int, default=1)
    args = parser.parse_args()

    torch.set_num_threads(args.threads)
    torch.manual_seed(args.seed)
    rng = random.Random(args.seed)
    folders = sorted(scene for data in args.data for scene in data.iterdir() if (scene / "group").is_dir())
    groups = load([folder for folder in folders if folder.name not in args.hold_out])
    held_out = load([folder for folder in folders if folder.name in args.hold_out]) if args.hold_out else []

    generator, discriminator = Generator(), Discriminator()
    print(f"{len(groups)} groups, {sum(p.numel() for p in generator.parameters())} parameters")
    adam = lambda model, rate: torch.optim.Adam(model.parameters(), lr=rate, betas=(0.5, 0.99))
    for_generator, for_discriminator = adam(generator, 1e-3), adam(discriminator, 2e-4)
    start = time.monotonic()
    for step in range(args.steps):
        progress = max(step / args.steps, (time.monotonic() - start) / (args.minutes * 60))
        if progress >= 1:
            break
        # Falls to a twentieth.
        for_generator.param_groups[0]["lr"] = 1e-3 * 0.05 ** progress
        batch = [crop(groups, rng) for _ in range(args.batch)]
        x, truth = (torch.stack(part) for part in zip(*batch))
        hole = x[:, 3:4]
        picture = compose(generator(x), x)
        # What lies outside the holes is not to be learned: there the discriminator sees the same twice.
        real = truth * hole + x[:, :3] * (1 - hole)

        judge = lambda image: discriminator(image, hole)
        loss_d = ((judge(real) - 1) ** 2).mean() + (judge(picture.detach()) ** 2).mean()
        for_discriminator.zero_grad()
        loss_d.backward()
        for_discriminator.step()

        l1 = ((picture - real).abs() * hole).sum() / (3 * hole.sum()).clamp(min=1)
        # The discriminator starts late, on a generator that knows the colours.
        weight = 0.002 if progress > 0.2 else 0.0
        loss_g = l1 + weight * ((judge(picture) - 1) ** 2).mean()
        for_generator.zero_grad()
        loss_g.backward()
        for_generator.step()
        if step % 50 == 0:
            print(f"step {step}, {time.monotonic() - start:.0f} s: L1 {l1.item():.4f}, discriminator {loss_d.item():.3f}", flush=True)

    export(generator, args.out)
    print(f"{args.out}: {args.out.stat().st_size} bytes after {step + 1} steps")
    if held_out:
        trained, rough = psnr_of_holes(generator, held_out)
        print(f"holes of {', '.join(args.hold_out)}: {trained:.2f} dB, rough fill {rough:.2f} dB")


if __name__ == "__main__":
    main()
