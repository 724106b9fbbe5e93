#!/usr/bin/env python3
"""Prints the tables of docs/geometry.md: raw pairs and orthoimages to surface models, scored.

    tests/benchmarks/satellites.py [--hsgm build/hsgm] [--data ../shared/data] [--set KEY=VALUE ...] [TABLE ...]

Tables: pair, step, penalties, ortho, fused, seams, real. All with default options but for --set. Needs GDAL's Python
bindings and numpy (Debian: python3-gdal python3-numpy).
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile

import numpy
from osgeo import gdal

import tables

gdal.UseExceptions()

SCENE = "synthetic_satellite_500m"


def data(*parts):
    return os.path.join(tables.PATHS["data"], *parts)


def run(folder, name, config, settings=()):
    """Runs a configuration given as a map; its result folder, CPU seconds and peak MB."""
    result = os.path.join(folder, name)
    path = os.path.join(folder, name + ".json")  # JSON is YAML
    with open(path, "w", encoding="ascii") as file:
        json.dump(config | {"output": {"folder": result}}, file)
    options = [part for key in settings for part in ("--set", key)]
    code = ("import resource, subprocess, sys; subprocess.run(sys.argv[1:], check=True); "
            "u = resource.getrusage(resource.RUSAGE_CHILDREN); print(u.ru_utime + u.ru_stime, u.ru_maxrss)")
    done = subprocess.run([sys.executable, "-c", code, tables.PATHS["hsgm"], "--log-level", "error", "run", path,
                           *options], check=True, stdout=subprocess.PIPE)
    seconds, kilobytes = done.stdout.split()
    return result, float(seconds), int(kilobytes) * 1024 / 1e6


def score(result, left_bit=1, right_bit=2):
    seen = str(left_bit + right_bit)
    return json.loads(tables.run(
        "evaluate", "dsm", os.path.join(result, "dsm.tif"), data(SCENE, "truth_dsm.tif"), "--mask",
        data(SCENE, "truth_visible.tif"), "--mask-bits", seen, "--classes", data(SCENE, "truth_classes.tif"),
        "--align-classes", "0", "--exclude-classes", "3", "--json"))


def within(scored):
    return next(w["percent"] for w in scored["within"] if w["threshold_m"] == 1)


def cells(scored):
    shift = scored["shift"]
    return (f"{scored['completeness_percent']:.2f} %", f"{within(scored):.2f} %", f"{scored['nmad_m']:.3f} m",
            f"{scored['rmse_m']:.2f} m", f"{scored['le90_m']:.2f} m",
            f"{within(scored['classes']['1']):.1f} %", f"{within(scored['classes']['4']):.1f} %",
            f"{shift['east_m']:.2f}, {shift['north_m']:.2f}, {shift['up_m']:.2f}")


HEAD = ("complete", "within 1 m", "NMAD", "RMSE", "LE90", "buildings", "low texture", "shift found, m")


def of_views(left, right):
    return {"pair": {"left": data(SCENE, left + ".tif"), "right": data(SCENE, right + ".tif")},
            "geometry": {"kind": "rpc"}}


def megapixels(path):
    raster = gdal.Open(path)
    return raster.RasterXSize * raster.RasterYSize / 1e6


def pair(folder, settings):
    print("### The raw pair\n")
    tables.header("", *HEAD, "CPU s/Mpx", "peak MB")
    for name, views, more in (("raw pair", ("left", "right"), []), ("swapped", ("right", "left"), []),
                              ("without an error of pointing", ("left", "third"), []),
                              ("every cell", ("left", "right"), ["dsm.min_confidence=0"]),
                              ("cells from 210 on", ("left", "right"), ["dsm.min_confidence=210"]),
                              ("penalties fixed", ("left", "right"), ["matcher.penalties=fixed"]),
                              ("both", ("left", "right"), ["matcher.penalties=fixed", "dsm.min_confidence=0"])):
        result, seconds, peak = run(folder, "pair", of_views(*views), [*settings, *more])
        bits = {"left": 1, "right": 2, "third": 4}
        scored = score(result, bits[views[0]], bits[views[1]])
        tables.row(name, *cells(scored), f"{seconds / megapixels(data(SCENE, views[0] + '.tif')):.1f}", f"{peak:.0f}")
    print()


def step(folder, settings):
    print("### The step of the frame\n")
    tables.header("m", *HEAD, "CPU s/Mpx")
    for metres in (0.5, 0.42, 0.375, 0.35, 0.3):
        result, seconds, _ = run(folder, "step", of_views("left", "right"),
                                 [*settings, f"geometry.epipolar_gsd_m={metres}"])
        tables.row(metres, *cells(score(result)), f"{seconds / megapixels(data(SCENE, 'left.tif')):.1f}")
    print()


def ortho_image(side, how):
    with open(data(SCENE, "scene.json"), encoding="ascii") as file:
        view = json.load(file)["views"][side]
    image = {"path": data(SCENE, f"ortho_{side}.tif")}
    if how == "vector":
        image["view_vector"] = [view["b_dE_dz"], view["b_dN_dz"]]
    return image


def ortho(folder, settings):
    print("### Orthoimages and a reference DEM\n")
    tables.header("", *HEAD)
    dem = {"reference_dem": data(SCENE, "ortho_refdem.tif"), "reference_dem_vertical": "ellipsoid"}
    images = {"left": ortho_image("left", "vector"), "right": ortho_image("right", "vector")}
    for name, config in (("raw pair", of_views("left", "right")),
                         ("raw pair, with the DEM", of_views("left", "right") | {"geometry": {"kind": "rpc"} | dem}),
                         ("ortho pair", {"pair": images, "geometry": {"kind": "ortho"} | dem})):
        result, _, _ = run(folder, "ortho", config, settings)
        tables.row(name, *cells(score(result)))
    print()


def fused(folder, settings):
    print("### Three views (every cell of the land)\n")
    tables.header("", "complete", "within 1 m", "NMAD", "LE90", "CPU s")
    three = {v: data(SCENE, v + ".tif") for v in ("left", "right", "third")}
    whole, seconds, _ = run(folder, "fused", {"images": three, "geometry": {"kind": "rpc"}}, settings)
    pairs = sorted(f for f in os.listdir(os.path.join(whole, "pairs")))
    for name, result in [(p, os.path.join(whole, "pairs", p)) for p in pairs] + [("fused", whole)]:
        if not os.path.exists(os.path.join(result, "dsm.tif")):
            continue
        s = json.loads(tables.run(
            "evaluate", "dsm", os.path.join(result, "dsm.tif"), data(SCENE, "truth_dsm.tif"), "--classes",
            data(SCENE, "truth_classes.tif"), "--align-classes", "0", "--exclude-classes", "3", "--json"))
        tables.row(name, f"{s['completeness_percent']:.2f} %", f"{within(s):.2f} %", f"{s['nmad_m']:.3f} m",
                   f"{s['le90_m']:.2f} m", f"{seconds:.0f}" if name == "fused" else "")
    print()


def penalties(folder, settings):
    """The same penalties where the images look alike, and where they do not."""
    print("### Penalties\n")
    tables.header("p1, p2", "unlike", "synthetic scene: within 1 m", "RMSE", "LE90", "low texture",
                  "Réunion: complete", "within 1 m", "RMSE to s2p")
    reunion = {"pair": {"left": raw_image("sat_reunion_pair", "img_01.tif"),
                        "right": raw_image("sat_reunion_pair", "img_02.tif")}, "geometry": {"kind": "rpc"}}
    for p1, p2 in (("auto", ""), (8, 40), (12, 48), (12, 64), (16, 96), (20, 128), (24, 192)):
        more = [] if p1 == "auto" else [f"matcher.p1={p1}", f"matcher.p2={p2}"]
        result, _, _ = run(folder, "synthetic", of_views("left", "right"), [*settings, *more])
        a = score(result)
        unlike = [unlike_share(result)]
        result, _, _ = run(folder, "reunion", reunion, [*settings, *more])
        unlike.append(unlike_share(result))
        b = beside_s2p(result)
        tables.row(f"{p1}, {p2}" if p2 else p1, ", ".join(unlike), f"{within(a):.2f} %", f"{a['rmse_m']:.2f} m",
                   f"{a['le90_m']:.2f} m", f"{within(a['classes']['4']):.1f} %", f"{b['completeness_percent']:.1f} %",
                   f"{within(b):.1f} %", f"{b['rmse_m']:.2f} m")
    print()


def unlike_share(result):
    with open(os.path.join(result, "geometry.json"), encoding="ascii") as file:
        likeness = json.load(file).get("likeness")
    return f"{100 * likeness['unlike'] / likeness['windows']:.1f} %" if likeness else ""


def beside_s2p(result):
    return json.loads(tables.run("evaluate", "dsm", os.path.join(result, "dsm.tif"),
                                 data("sat_reunion_pair", "expected_dsm_s2p.tif"), "--align", "none", "--json"))


def cubic(positions, nodes):
    """Lagrange's cubic, as the program's lattices are read: the first of four nodes, and their weights."""
    cell = numpy.clip(numpy.floor(positions).astype(int), 1, nodes - 3)
    t = positions - cell
    return cell - 1, numpy.stack([-t * (t - 1) * (t - 2) / 6, (t + 1) * (t - 1) * (t - 2) / 2,
                                  -(t + 1) * t * (t - 2) / 2, (t + 1) * t * (t - 1) / 6])


def ground_points(result):
    """x, y and height of every pixel of the frame, NaN where it has no disparity."""
    with open(os.path.join(result, "geometry.json"), encoding="ascii") as file:
        geometry = json.load(file)
    nodes, ground = geometry["ground"]["nodes"], geometry["ground"]
    values = numpy.array(nodes["values"]).reshape(nodes["rows"], nodes["cols"], 4, 4)[..., :3]
    raster = gdal.Open(os.path.join(result, "disparity.tif"))
    d = raster.ReadAsArray().astype(float)
    d[d == raster.GetRasterBand(1).GetNoDataValue()] = numpy.nan
    top, down = cubic((numpy.arange(d.shape[0]) - nodes["first_row"]) / nodes["step"], nodes["rows"])
    first, across = cubic((numpy.arange(d.shape[1]) - nodes["first_col"]) / nodes["step"], nodes["cols"])
    rows = sum(down[k][:, None, None, None] * values[top + k] for k in range(4))
    layers = sum(across[k][None, :, None, None] * rows[:, first + k] for k in range(4))
    low, high = ground["disparity_min_px"], ground["disparity_max_px"]
    t = (d - low) / (high - low) * 3
    weights = (-(t - 1) * (t - 2) * (t - 3) / 6, t * (t - 2) * (t - 3) / 2, -t * (t - 1) * (t - 3) / 2,
               t * (t - 1) * (t - 2) / 6)
    return [sum(w * layers[..., k, channel] for k, w in enumerate(weights)) for channel in range(3)]


def errors_in_frame(result):
    """Of the heights of the frame's pixels, after the shift that `evaluate dsm` finds."""
    x, y, height = ground_points(result)
    shift = score(result)["shift"]
    raster = gdal.Open(data(SCENE, "truth_dsm.tif"))
    truth, geo = raster.ReadAsArray().astype(float), raster.GetGeoTransform()
    with numpy.errstate(invalid="ignore"):
        col = numpy.floor((x - shift["east_m"] - geo[0]) / geo[1])
        row = numpy.floor((y - shift["north_m"] - geo[3]) / geo[5])
        inside = (col >= 0) & (row >= 0) & (col < truth.shape[1]) & (row < truth.shape[0])
    col, row = numpy.where(inside, col, 0).astype(int), numpy.where(inside, row, 0).astype(int)
    return numpy.where(inside, height - shift["up_m"] - truth[row, col], numpy.nan)


def border_ratio(jumps, side):
    """Median jump across the borders of a grid to that more than 4 px from any; and the same of grids that lie
    elsewhere, where there is no border: the middle 95 % of them."""
    def ratio(phase):
        away = (numpy.arange(jumps.shape[1]) + 1 - phase) % side
        elsewhere = numpy.minimum(away, side - away) > 4
        return numpy.nanmedian(jumps[:, away == 0]) / numpy.nanmedian(jumps[:, elsewhere])
    # Some 60 grids say as much as all, and those of the windows, of 64 px, are left out.
    phases = [p for p in range(5, side - 4, max(1, side // 60)) if min(p % 64, 64 - p % 64) > 4]
    low, high = numpy.percentile([ratio(phase) for phase in phases], [2.5, 97.5])
    return f"{ratio(0):.3f} ({low:.2f} to {high:.2f})"


def seams(folder, settings):
    print("### Seams: jumps of the error at borders to those elsewhere (of grids without borders)\n")
    tables.header("borders of", "between columns", "between rows")
    result, _, _ = run(folder, "seams", of_views("left", "right"), settings)
    error = errors_in_frame(result)
    across, down = numpy.abs(numpy.diff(error, axis=1)), numpy.abs(numpy.diff(error, axis=0)).T
    for name, side in (("windows", 64), ("tiles", 256), ("tiles", 512), ("tiles", 1024)):
        tables.row(f"{name}, {side} px", border_ratio(across, side), border_ratio(down, side))
    print()


def raw_image(place, name):
    geom = data(place, os.path.splitext(name)[0] + ".geom")
    return {"path": data(place, name)} | ({"rpc": geom} if os.path.exists(geom) else {})


def pyramid_height(path):
    """The 99.99th percentile and the highest cell, above the median of a ring round the middle of the top."""
    raster = gdal.Open(path)
    heights = raster.ReadAsArray().astype(float)
    heights[heights == raster.GetRasterBand(1).GetNoDataValue()] = numpy.nan
    top = numpy.unravel_index(numpy.nanargmax(heights), heights.shape)
    far = numpy.hypot(*(numpy.indices(heights.shape) - numpy.array(top)[:, None, None])) * raster.GetGeoTransform()[1]
    ground = numpy.nanmedian(heights[(far > 170) & (far < 230)])
    return numpy.nanpercentile(heights, 99.99) - ground, numpy.nanmax(heights) - ground


def real(folder, settings):
    print("### Real pairs\n")
    tables.header("", "pointing px", "heights m", "CPU s/Mpx", "peak MB", "unlike", "what was found")
    for name, place, left, right in (("Réunion", "sat_reunion_pair", "img_01.tif", "img_02.tif"),
                                     ("Gizeh", "sat_gizeh_phr", "img1.tif", "img2.tif"),
                                     ("Kahramanmaraş", "sat_kahramanmaras_pre", "img1.tif", "img2.tif")):
        config = {"pair": {"left": raw_image(place, left), "right": raw_image(place, right)},
                  "geometry": {"kind": "rpc"}}
        result, seconds, peak = run(folder, place, config, settings)
        with open(os.path.join(result, "geometry.json"), encoding="ascii") as file:
            geometry = json.load(file)
        found = ""
        if name == "Réunion":
            s = beside_s2p(result)
            found = (f"beside s2p: median {s['median_error_m']:.2f} m, NMAD {s['nmad_m']:.2f} m, within 1 m "
                     f"{within(s):.1f} %, complete {s['completeness_percent']:.1f} %")
        if name == "Gizeh":
            most, highest = pyramid_height(os.path.join(result, "dsm.tif"))
            found = f"pyramid {most:.1f} m (99.99th percentile), {highest:.1f} m (highest cell); truth 138.5 m"
        low, high = geometry["heights_m"]
        tables.row(name, f"{geometry['pointing']['shift_px']:.2f}", f"{low:.0f} to {high:.0f}",
                   f"{seconds / megapixels(data(place, left)):.1f}", f"{peak:.0f}", unlike_share(result), found)
    print()


TABLES = {"pair": pair, "step": step, "penalties": penalties, "ortho": ortho, "fused": fused, "seams": seams, "real": real}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tables", nargs="*", metavar="TABLE", choices=[[], *TABLES])
    parser.add_argument("--set", action="append", default=[], help="of the runs: matcher.cost=census7x7")
    tables.add_paths(parser)
    arguments = parser.parse_args()
    tables.use_paths(arguments)
    with tempfile.TemporaryDirectory() as folder:
        for name in arguments.tables or TABLES:
            TABLES[name](folder, arguments.set)


if __name__ == "__main__":
    main()
