#!/usr/bin/env python3
"""Makes docs/images/demo.png from the results of `./dev demo`: the same part of the left image,
the disparity and the hillshade, side by side. Run it from the top of the project:

    ./dev demo && python3 docs/images/make_demo.py
"""

import os

import numpy
from osgeo import gdal

ROW, COL, SIDE, GAP = 325, 372, 280, 5  # in the pictures of the demo, 1024 pixels wide

gdal.UseExceptions()
gdal.PushErrorHandler("CPLQuietErrorHandler")


def rgb(path):
    reduced = gdal.Translate("", path, format="MEM", width=1024, height=0,
                             resampleAlg="average", outputType=gdal.GDT_Byte)
    pixels = reduced.ReadAsArray()
    pixels = pixels if pixels.ndim == 3 else numpy.stack([pixels] * 3)
    return pixels // 8 * 8 + 4  # fewer colours, a smaller file


panels = [rgb("demo-out/" + name)[:, ROW:ROW + SIDE, COL:COL + SIDE]
          for name in ("scene/left.tif", "result/disparity.png", "result/hillshade.png")]
gap = numpy.full((3, SIDE, GAP), 255, numpy.uint8)
picture = numpy.concatenate([panels[0], gap, panels[1], gap, panels[2]], axis=2)
memory = gdal.GetDriverByName("MEM").Create("", picture.shape[2], SIDE, 3)
memory.WriteArray(picture)
gdal.GetDriverByName("PNG").CreateCopy("docs/images/demo.png", memory, options=["ZLEVEL=9"])
if os.path.exists("docs/images/demo.png.aux.xml"):
    os.remove("docs/images/demo.png.aux.xml")
