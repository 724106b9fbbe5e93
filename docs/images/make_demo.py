#!/usr/bin/env python3
"""Makes docs/images/demo.png from the results of `./dev demo`: the same place in the raw left
image, in the shaded surface model and in its errors, side by side. Run it from the top of the
project:

    ./dev demo && /usr/bin/python3 docs/images/make_demo.py
"""

import os

import numpy
from osgeo import gdal

SIDE, GAP = 320, 5
IMAGE = (330, 330)  # column and row of the part in the left image
WORST_M = 2.0  # full blue and full red

gdal.UseExceptions()
gdal.PushErrorHandler("CPLQuietErrorHandler")


def cut(path, col, row):
    raster = gdal.Open("demo-out/" + path)
    return raster.ReadAsArray(col, row, SIDE, SIDE).astype(float)


def grey(values, low, high):
    scaled = numpy.clip((values - low) / (high - low), 0, 1) * 255
    return numpy.stack([scaled] * 3)


def errors(values):
    off = numpy.clip(values / WORST_M, -1, 1)
    red, blue = 1 + numpy.minimum(off, 0), 1 - numpy.maximum(off, 0)
    colours = 255 * numpy.stack([red, 1 - numpy.abs(off), blue])
    return numpy.where(numpy.isnan(values), 0, colours)


def map_cell(truth, of):
    """Column and row in another raster of the map, of the cell of the truth that shows at IMAGE."""
    model = gdal.Transformer(gdal.Open("demo-out/scene/left.tif"), truth, ["METHOD=RPC", "RPC_HEIGHT=335"])
    _, (col, row, _) = model.TransformPoint(0, *IMAGE)
    t, o = truth.GetGeoTransform(), of.GetGeoTransform()
    return (round((t[0] + col * t[1] - o[0]) / o[1]), round((t[3] + row * t[5] - o[3]) / o[5]))


truth = gdal.Open("demo-out/scene/truth_dsm.tif")
panels = [grey(cut("scene/left.tif", *IMAGE), 150, 1600),
          grey(cut("result/hillshade.tif", *map_cell(truth, gdal.Open("demo-out/result/hillshade.tif"))), 0, 255),
          errors(cut("result/error.tif", *map_cell(truth, gdal.Open("demo-out/result/error.tif"))))]
gap = numpy.full((3, SIDE, GAP), 255)
picture = numpy.concatenate([panels[0], gap, panels[1], gap, panels[2]], axis=2)
picture = (picture // 8 * 8 + 4).clip(0, 255).astype(numpy.uint8)  # fewer colours, a smaller file
memory = gdal.GetDriverByName("MEM").Create("", picture.shape[2], SIDE, 3)
memory.WriteArray(picture)
gdal.GetDriverByName("PNG").CreateCopy("docs/images/demo.png", memory, options=["ZLEVEL=9"])
if os.path.exists("docs/images/demo.png.aux.xml"):
    os.remove("docs/images/demo.png.aux.xml")
