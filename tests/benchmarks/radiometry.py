#!/usr/bin/env python3
"""How much bad pixels grow where the right image differs in brightness, as Markdown.

    tests/benchmarks/radiometry.py [--hsgm build/hsgm] [--data ../shared/data] [--set KEY=VALUE ...]

Scored like `answered` in docs/benchmarks.md. Needs GDAL's Python bindings and numpy (Debian:
python3-gdal python3-numpy).
"""

import argparse
import os
import tempfile

import numpy
from osgeo import gdal

import tables

gdal.UseExceptions()


def shadow(tone):
    """The right part, beyond a wavy border, at 0.6 of its brightness."""
    rows, cols = tone.shape
    border = 0.5 * cols + 0.15 * rows * numpy.sin(0.02 * numpy.arange(rows))
    return numpy.where(numpy.arange(cols)[None, :] > border[:, None], 0.6 * tone, tone)


def vignette(tone):
    rows, cols = tone.shape
    y = (numpy.arange(rows)[:, None] - rows / 2) / rows
    x = (numpy.arange(cols)[None, :] - cols / 2) / cols
    return tone * (1 - 0.8 * (x * x + y * y))


LUMA = (0.299, 0.587, 0.114)  # as the program makes grey of colour

# Of tones 0..1.
CHANGES = {
    "gain 0.7": lambda tone: 0.7 * tone,
    "0.85 x + 0.1": lambda tone: 0.85 * tone + 0.1,
    "gamma 1.5": lambda tone: tone ** 1.5,
    "gamma 0.7": lambda tone: tone ** 0.7,
    "shadow": shadow,
    "vignette": vignette,
}


def changed(source, change, target, bits):
    """Writes the first band of `source`, changed: in 16 bits, so that rounding stays out of it, or in 8."""
    tone = gdal.Open(source).ReadAsArray().astype(float)
    if tone.ndim == 3:
        tone = numpy.floor(numpy.tensordot(LUMA, tone[:3], 1) + 0.5)
    tone /= 255
    top = 255 if bits == 8 else 65280
    image = numpy.clip(numpy.floor(top * change(tone) + 0.5), 1, top).astype(
        numpy.uint8 if bits == 8 else numpy.uint16)
    data_type = gdal.GDT_Byte if bits == 8 else gdal.GDT_UInt16
    raster = gdal.GetDriverByName("GTiff").Create(target, image.shape[1], image.shape[0], 1, data_type)
    raster.GetRasterBand(1).WriteArray(image)


def images_of(scene):
    data = os.path.join(tables.PATHS["data"], scene[1])
    names = sorted(os.listdir(data))
    return [os.path.join(data, next(f for f in names if f.startswith(side)))
            for side in ("left", "right.")]


def scored(scene, left, right, settings, folder):
    _, place, disparity, truth, options = scene
    data = os.path.join(tables.PATHS["data"], place)
    test = os.path.join(folder, "test.tif")
    tables.match(left, right, disparity, settings, test)
    here = [os.path.join(data, o) if o.endswith(".png") else o for o in options]
    return tables.bad(tables.score(test, os.path.join(data, truth), "--thresholds", "1", *here), 1)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--set", action="append", default=[], help="of the matches: matcher.cost=pairs5x5")
    tables.add_paths(parser)
    arguments = parser.parse_args()
    tables.use_paths(arguments)
    settings = tables.ANSWERED + arguments.set
    tables.header("scene", "bits", "as it is", *CHANGES, "other exposure")
    with tempfile.TemporaryDirectory() as folder:
        for scene in tables.CLASSICS + tables.OTHERS:
            if scene[0] in ("Cones", "Books", "Rocks1", "Adirondack"):
                for bits in (16, 8):
                    print_changes(scene, bits, settings, folder)


def print_changes(scene, bits, settings, folder):
    """One row: the bad pixels, and how many more there are after each change."""
    left, right = images_of(scene)
    grey = [os.path.join(folder, f"{side}.tif") for side in ("left", "right")]
    changed(left, lambda tone: tone, grey[0], bits)
    changed(right, lambda tone: tone, grey[1], bits)
    plain = scored(scene, *grey, settings, folder)
    losses = []
    for change in CHANGES.values():
        changed(right, change, grey[1], bits)
        losses.append(scored(scene, *grey, settings, folder) - plain)
    other = right.replace("right.", "right_other_exposure.")
    if bits == 8 and os.path.exists(other):
        losses.append(scored(scene, left, other, settings, folder) - plain)
    tables.row(scene[0], bits, f"{plain:.2f}", *[f"{v:+.2f}" for v in losses],
               *[""] * (len(CHANGES) + 1 - len(losses)))


if __name__ == "__main__":
    main()
