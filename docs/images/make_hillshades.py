#!/usr/bin/python3
"""Two surface models of one place, shaded alike, side by side.

    make_hillshades.py OURS.tif THEIRS.tif OUT.png

Draws the middle of the part that both cover, in the cells of the second: the first on the left, the second on
the right, light from azimuth 315, altitude 45, black where there is no height.
"""

import sys

import numpy
from osgeo import gdal

gdal.UseExceptions()
GAP_PX = 8
SIDE_PX = 460


def grid_of(raster):
    west, cell, _, north, _, _ = raster.GetGeoTransform()
    return west, north, west + raster.RasterXSize * cell, north - raster.RasterYSize * cell


def shaded(path, bounds, cell, crs):
    part = gdal.Warp("", path, format="MEM", outputBounds=bounds, xRes=cell, yRes=cell,
                     dstSRS=crs, resampleAlg="near")
    return gdal.DEMProcessing("", part, "hillshade", format="MEM", computeEdges=True).ReadAsArray()


def main(ours, theirs, out):
    reference = gdal.Open(theirs)
    crs = reference.GetProjection()
    mine = gdal.Warp("", ours, format="MEM", dstSRS=crs)
    a, b = grid_of(mine), grid_of(reference)
    bounds = (max(a[0], b[0]), max(a[3], b[3]), min(a[2], b[2]), min(a[1], b[1]))
    cell = reference.GetGeoTransform()[1]
    left = shaded(ours, bounds, cell, crs)
    right = shaded(theirs, bounds, cell, crs)
    row, col = (max(0, (n - SIDE_PX) // 2) for n in left.shape)
    left, right = (shade[row:row + SIDE_PX, col:col + SIDE_PX] for shade in (left, right))
    gap = numpy.full((left.shape[0], GAP_PX), 255, numpy.uint8)
    picture = numpy.hstack([left, gap, right])
    memory = gdal.GetDriverByName("MEM").Create("", picture.shape[1], picture.shape[0], 1)
    memory.GetRasterBand(1).WriteArray(picture)
    gdal.GetDriverByName("PNG").CreateCopy(out, memory, options=["ZLEVEL=9"])


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    main(*sys.argv[1:])
