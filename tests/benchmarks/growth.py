#!/usr/bin/env python3
"""Measures how time and memory of `hsgm match` grow with the image and with the range, and
draws docs/images/growth-side.svg and growth-range.svg; the tables of docs/benchmarks.md go to
standard output.

    tests/benchmarks/growth.py --folder /tmp/growth                       # everything: an hour or so
    tests/benchmarks/growth.py --folder /tmp/growth --sides 512,1024 --ranges 64,128 --range-side 512 \\
        --images /tmp                                                     # a small version
    tests/benchmarks/growth.py --from /tmp/growth/growth.json             # draw and print again

One scene of the largest side is rendered (configs/scene-large.yaml: its disparities lie within
-32..73 px); smaller images are cut out of it by virtual rasters, so that all sizes show the
same kind of town. Each match is a process of its own with the default tiles. The folder needs
about 30 bytes of disk for each pixel of the largest image; what is there is used again.
"""

import argparse
import json
import math
import os
import re
import statistics
import subprocess
import sys
import time

import plot_svg

LOWEST = -32  # of every range
ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


def progress(*words):
    print(*words, file=sys.stderr, flush=True)


def render(hsgm, folder, side):
    """The scene of that side; True is left.tif there from an earlier run."""
    scene = os.path.join(folder, f"scene-{side}")
    if not os.path.exists(os.path.join(scene, "scene.used.yaml")):
        progress(f"rendering {side} x {side} px")
        subprocess.run([hsgm, "synth", os.path.join(ROOT, "configs", "scene-large.yaml"), "-o", scene,
                        "--set", f"size=[{side}, {side}]"], check=True, stdout=subprocess.DEVNULL)
    return scene


def cut(scene, name, side):
    """The upper left corner of a raster of the scene, as a virtual raster."""
    path = os.path.join(scene, f"{name}-{side}.vrt")
    rect = f'xOff="0" yOff="0" xSize="{side}" ySize="{side}"'
    with open(path, "w", encoding="ascii") as file:
        file.write(f'<VRTDataset rasterXSize="{side}" rasterYSize="{side}">'
                   '<VRTRasterBand dataType="UInt16" band="1"><NoDataValue>0</NoDataValue>'
                   f'<SimpleSource><SourceFilename relativeToVRT="1">{name}.tif</SourceFilename>'
                   f'<SourceBand>1</SourceBand><SrcRect {rect}/><DstRect {rect}/></SimpleSource>'
                   "</VRTRasterBand></VRTDataset>")
    return path


def run_once(command):
    """Wall clock and CPU seconds, peak MiB, and what the program said, of one process."""
    start = time.monotonic()
    with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as child:
        said = child.stderr.read()
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode != 0:
        sys.exit(f"{' '.join(command)}\n{said}")
    return {"seconds": time.monotonic() - start, "cpu_s": usage.ru_utime + usage.ru_stime,
            "peak_mib": usage.ru_maxrss / 1024, "said": said}


def measure(arguments, scene, side, disparities):
    output = os.path.join(arguments.folder, "disparity.tif")
    command = [arguments.hsgm, "match", cut(scene, "left", side), cut(scene, "right", side), "-o", output,
               f"--disparity={LOWEST},{LOWEST + disparities - 1}", "--threads", str(arguments.threads)]
    runs = []
    for i in range(arguments.repeats):
        progress(f"{side} x {side} px, {disparities} disparities, run {i + 1} of {arguments.repeats}")
        runs.append(run_once(command))
    planned = re.search(r"(\d+) levels; tiles (?:(\d+) of )?(\d+|untiled).*at most (\d+) MiB",
                        runs[0]["said"])
    return {"side": side, "disparities": disparities,
            "seconds": statistics.median(r["seconds"] for r in runs),
            "cpu_s": statistics.median(r["cpu_s"] for r in runs),
            "peak_mib": max(r["peak_mib"] for r in runs),
            "levels": int(planned[1]), "tiles": int(planned[2] or 1), "bound_mib": int(planned[4])}


def measure_all(arguments):
    scene = render(arguments.hsgm, arguments.folder, max([*arguments.sides, arguments.range_side]))
    result = {"threads": arguments.threads, "repeats": arguments.repeats,
              "sides": [measure(arguments, scene, s, arguments.disparities) for s in arguments.sides],
              "ranges": [measure(arguments, scene, arguments.range_side, d) for d in arguments.ranges]}
    with open(os.path.join(arguments.folder, "growth.json"), "w", encoding="ascii") as file:
        json.dump(result, file, indent=1)
    return result


def exponent(xs, ys):
    """The slope of a straight line through the points in logarithms."""
    xs, ys = [math.log(x) for x in xs], [math.log(y) for y in ys]
    mean_x, mean_y = statistics.mean(xs), statistics.mean(ys)
    spread = sum((x - mean_x) ** 2 for x in xs)
    return sum((x - mean_x) * (y - mean_y) for x, y in zip(xs, ys)) / spread if spread > 0 else float("nan")


def row(*cells):
    print("| " + " | ".join(str(cell) for cell in cells) + " |")


def print_table(measured):
    row("side px", "disparities", "levels", "tiles", "seconds", "CPU s", "million px x disparities / s",
        "peak MiB", "bound of the plan, MiB")
    row(*["---"] * 9)
    for m in measured:
        rate = m["side"] ** 2 * m["disparities"] / m["seconds"] / 1e6
        row(m["side"], m["disparities"], m["levels"], m["tiles"], f"{m['seconds']:.2f}", f"{m['cpu_s']:.2f}",
            f"{rate:.0f}", f"{m['peak_mib']:.0f}", m["bound_mib"])
    print()


def print_tables(result):
    sides, ranges = result["sides"], result["ranges"]
    print(f"{result['threads']} thread{'s' * (result['threads'] > 1)}, medians of {result['repeats']}.\n")
    print_table(sides)
    if len(sides) > 1:
        pixels = [m["side"] ** 2 for m in sides]
        print(f"Time grows with the pixels to the power of {exponent(pixels, [m['cpu_s'] for m in sides]):.2f}.\n")
    print_table(ranges)
    if len(ranges) > 1:
        counts = [m["disparities"] for m in ranges]
        print(f"Time grows with the range to the power of {exponent(counts, [m['cpu_s'] for m in ranges]):.2f}.")


def draw(result, folder):
    for name, label, key, power in (("side", "side of the image, px", "sides", 2),
                                    ("range", "disparities searched", "ranges", 1)):
        measured = result[key]
        xs = [m["side" if key == "sides" else "disparities"] for m in measured]
        times = [m["cpu_s"] for m in measured]
        linear = [times[0] * (x / xs[0]) ** power for x in xs]
        guide = [("in proportion to the pixels" if power == 2 else "in proportion", linear)]
        plot_svg.write(os.path.join(folder, f"growth-{name}.svg"), [
            plot_svg.Chart("CPU time of hsgm match, s", label, xs, times, True, guide),
            plot_svg.Chart("peak memory, MiB", label, xs, [m["peak_mib"] for m in measured], False)])


def numbers(text):
    return [int(part) for part in text.split(",")]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--folder", help="for the scene, results and growth.json")
    parser.add_argument("--from", dest="earlier", metavar="GROWTH.JSON", help="draw an earlier measurement")
    parser.add_argument("--sides", type=numbers, default=[1024, 2048, 4096, 8192, 16384])
    parser.add_argument("--disparities", type=int, default=128, help="of the growth with the side")
    parser.add_argument("--ranges", type=numbers, default=[64, 128, 256, 512, 1024])
    parser.add_argument("--range-side", type=int, default=2048, help="of the growth with the range")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--hsgm", default=os.path.join(ROOT, "build", "hsgm"))
    parser.add_argument("--images", default=os.path.join(ROOT, "docs", "images"), help="where pictures go")
    arguments = parser.parse_args()
    if arguments.earlier:
        with open(arguments.earlier, encoding="ascii") as file:
            result = json.load(file)
    elif arguments.folder:
        os.makedirs(arguments.folder, exist_ok=True)
        result = measure_all(arguments)
    else:
        parser.error("give --folder to measure, or --from to draw what was measured")
    print_tables(result)
    draw(result, arguments.images)


if __name__ == "__main__":
    main()
