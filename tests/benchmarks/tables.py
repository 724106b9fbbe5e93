#!/usr/bin/env python3
"""Prints the quality and memory tables of docs/benchmarks.md as Markdown.

    tests/benchmarks/tables.py [--hsgm build/hsgm] [--data ../shared/data] [TABLE ...]

Tables: seams, middlebury, peers, ablation, costs, memory.

Needs the program and, but for `seams` and `memory`, the data folder of real pairs. Quality
does not depend on the machine; memory hardly does.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile

RAW = ["matcher.left_right_px=off", "matcher.speckle_px=off", "matcher.subpixel=sums",
       "matcher.min_confidence=0", "matcher.median=off", "matcher.smooth=off"]
# Every pixel answers, but the answer is filtered, as that of OpenCV's matcher always is.
ANSWERED = ["matcher.left_right_px=off", "matcher.speckle_px=off", "matcher.min_confidence=0"]
CLOSE_UP = ["matcher.profile=close"]
PATHS = {}


def run(*arguments):
    done = subprocess.run([PATHS["hsgm"], "--log-level", "error", *arguments], check=True,
                          stdout=subprocess.PIPE)
    return done.stdout


def match(left, right, disparity, settings, output):
    options = [part for key in settings for part in ("--set", key)]
    run("match", left, right, "-o", output, f"--disparity={disparity}", *options)


def bad(scored, threshold, among="bad_percent"):
    return next(row[among] for row in scored["bad"] if row["threshold_px"] == threshold)


def score(test, truth, *options):
    return json.loads(run("evaluate", "disparity", test, truth, "--json", *options))


def row(*cells):
    print("| " + " | ".join(str(cell) for cell in cells) + " |")


def header(*cells):
    row(*cells)
    row(*["---"] * len(cells))


MODES = [
    ("sgm, whole image", ["matcher.mode=sgm"]),
    ("local windows, no overlap", ["matcher.mode=local", "matcher.halo=0"]),
    ("local windows, overlap 8", ["matcher.mode=local", "matcher.halo=8"]),
    ("local windows, overlap 16", ["matcher.mode=local", "matcher.halo=16"]),
    ("hsgm-paper (eq. 2 and 3)", ["matcher.mode=hsgm-paper"]),
    ("hsgm without halo", ["matcher.halo=0"]),
    ("hsgm", []),
]


def seams(folder):
    print("### Seams at window borders (figure 5 of the paper as a table)\n")
    header("scene", "mode", "% bad > 1 px", "jump ratio at borders", "95 % interval")
    for scene, disparity in (("city", "-8,56"), ("ramps", "-16,47"), ("planes", "-16,63")):
        made = os.path.join(folder, scene)
        run("synth", os.path.join(PATHS["configs"], f"scene-{scene}.yaml"), "-o", made)
        truth = os.path.join(made, "truth_left.tif")
        mask = os.path.join(made, "visible_left.tif")
        for name, settings in MODES:
            test = os.path.join(folder, "seam.tif")
            match(os.path.join(made, "left.tif"), os.path.join(made, "right.tif"), disparity,
                  settings + RAW, test)
            scored = score(test, truth, "--mask", mask)
            seam = json.loads(run("evaluate", "seams", test, "--truth", truth, "--mask", mask,
                                  "--window", "64", "--json"))
            grid = seam["window_64"]
            row(scene, name, f"{bad(scored, 1):.2f}", f"{grid['ratio']:.3f}",
                f"{grid['ratio_low']:.2f} to {grid['ratio_high']:.2f}")
    print()


def third(scene):
    folder = f"middlebury_2005_2006_third/{scene}"
    return (scene, folder, "0,79", "disp_left_x3.png",
            ["--scale", "3", "--truth-right", "disp_right_x3.png"])


CLASSICS = [
    ("Tsukuba", "middlebury_tsukuba", "0,15", "disp_left_x16.png",
     ["--scale", "16", "--mask", "mask_nonocc.png"]),
    ("Cones", "middlebury_cones", "0,63", "disp_left_x4.png",
     ["--scale", "4", "--mask", "mask_nonocc.png"]),
    third("Books"), third("Bowling2"), third("Lampshade1"), third("Rocks1"), third("Wood2"),
]
OTHERS = [
    ("Dolls", "middlebury_2005_2006_full/Dolls", "0,255", "disp_left_x1.png",
     ["--truth-right", "disp_right_x1.png"]),
    ("Adirondack", "middlebury_2014_adirondack_q", "0,63", "disp_left_x1.png",
     ["--mask", "mask_nonocc.png"]),
    ("ETH3D playground", "eth3d_playground", "0,63", "disp_left.pfm",
     ["--nonoccluded", "zbuffer"]),
    ("Fountain", "fountain23", "0,127", "disp_left_x1.png", ["--nonoccluded", "zbuffer"]),
]
# These are scored at 3 px: their truth is lidar of another date.
COARSE = [
    ("Dublin", "aerial_dublin_lower", "0,127", "disp_left_x256.png",
     ["--scale", "256", "--nonoccluded", "zbuffer"]),
    ("US3D JAX_079", "sat_us3d_JAX_079_006_007", "-64,63", "disp_left.tif",
     ["--truth-nodata", "-999", "--nonoccluded", "zbuffer"]),
]


def readable(truth, folder):
    """GDAL reads no PFM, but its rows (float32, bottom to top) through a virtual raster."""
    if not truth.endswith(".pfm"):
        return truth
    with open(truth, "rb") as pfm:
        header = [pfm.readline() for _ in range(3)]
    cols, rows = (int(n) for n in header[1].split())
    order = "LSB" if float(header[2]) < 0 else "MSB"
    first = sum(len(line) for line in header) + (rows - 1) * cols * 4
    vrt = os.path.join(folder, "truth.vrt")
    with open(vrt, "w", encoding="ascii") as file:
        file.write(
            f'<VRTDataset rasterXSize="{cols}" rasterYSize="{rows}">'
            '<VRTRasterBand dataType="Float32" band="1" subClass="VRTRawRasterBand">'
            f'<SourceFilename relativeToVRT="0">{os.path.abspath(truth)}</SourceFilename>'
            f"<ImageOffset>{first}</ImageOffset><PixelOffset>4</PixelOffset>"
            f"<LineOffset>{-4 * cols}</LineOffset><ByteOrder>{order}</ByteOrder>"
            "</VRTRasterBand></VRTDataset>")
    return vrt


def match_scene(scene, settings, folder):
    _, place, disparity, _, _ = scene
    data = os.path.join(PATHS["data"], place)
    test = os.path.join(folder, "scene.tif")
    images = [f for f in os.listdir(data) if f.startswith(("left", "right."))]
    left, right = (os.path.join(data, next(f for f in sorted(images) if f.startswith(side)))
                   for side in ("left", "right"))
    match(left, right, disparity, settings, test)
    return test


def score_scene(scene, settings, folder, threshold=1):
    _, place, _, truth, options = scene
    data = os.path.join(PATHS["data"], place)
    here = [os.path.join(data, o) if o.endswith(".png") else o for o in options]
    test = match_scene(scene, settings, folder)
    return score(test, readable(os.path.join(data, truth), folder), "--thresholds", str(threshold), *here)


def middlebury(folder):
    print("### Table 1 of the paper: % bad > 1 px, non-occluded, missing counted as bad\n")
    columns = [("sgm", ["matcher.mode=sgm"]), ("hsgm-paper, hmi", ["matcher.mode=hsgm-paper", "matcher.cost=hmi"]),
               ("hsgm-paper, ternary5x5", ["matcher.mode=hsgm-paper"]), ("hsgm", [])]
    for title, extra in (("raw", RAW), ("with left-right check and median", [])):
        header(title, *[scene[0] for scene in CLASSICS], "mean")
        for name, settings in columns:
            values = [bad(score_scene(s, settings + extra, folder), 1) for s in CLASSICS]
            row(name, *[f"{v:.2f}" for v in values], f"{sum(values) / len(values):.2f}")
        print()


def peers(folder):
    print("### Every scene\n")
    header("scene", "threshold", "raw", "answered", "close-up, answered", "checked", "density %",
           "% bad among valid")
    for threshold, scenes in ((1, CLASSICS + OTHERS), (3, COARSE)):
        for scene in scenes:
            raw, answered, close_up, checked = (
                score_scene(scene, settings, folder, threshold)
                for settings in (RAW, ANSWERED, ANSWERED + CLOSE_UP, []))
            row(scene[0], f"{threshold} px", f"{bad(raw, threshold):.2f}",
                f"{bad(answered, threshold):.2f}", f"{bad(close_up, threshold):.2f}",
                f"{bad(checked, threshold):.2f}", f"{checked['density_percent']:.1f}",
                f"{bad(checked, threshold, 'bad_answered_percent'):.2f}")
    print()


# What each step and choice is worth: the defaults, and one thing changed.
CHANGES = [
    ("defaults", []),
    ("prior: false", ["matcher.prior=false"]),
    ("smooth: off", ["matcher.smooth=off"]),
    ("median: off", ["matcher.median=off"]),
    ("subpixel: sums", ["matcher.subpixel=sums"]),
    ("prune: false", ["matcher.prune=false"]),
    ("halo: 0", ["matcher.halo=0"]),
    ("mode: sgm", ["matcher.mode=sgm"]),
    ("paths: 4", ["matcher.paths=4"]),
    ("paths: 16", ["matcher.paths=16"]),
    ("p1: 16", ["matcher.p1=16"]),
    ("profile: aerial", ["matcher.profile=aerial"]),
    ("profile: close", ["matcher.profile=close"]),
    ("close, paths: 8", ["matcher.profile=close", "matcher.paths=8"]),
]


def answered_rows(folder, title, changes):
    made = os.path.join(folder, "city")
    run("synth", os.path.join(PATHS["configs"], "scene-city.yaml"), "-o", made)
    scenes = [(scene, 1) for scene in CLASSICS + OTHERS] + [(scene, 3) for scene in COARSE]
    header(title, *[scene[0] for scene, _ in scenes], "noisy city")
    for name, change in changes:
        settings = ANSWERED + change
        values = [bad(score_scene(scene, settings, folder, limit), limit) for scene, limit in scenes]
        test = os.path.join(folder, "city.tif")
        match(os.path.join(made, "left.tif"), os.path.join(made, "right.tif"), "-8,56", settings, test)
        values.append(bad(score(test, os.path.join(made, "truth_left.tif"), "--mask",
                                os.path.join(made, "visible_left.tif")), 1))
        row(name, *[f"{v:.2f}" for v in values])
    print()


def ablation(folder):
    print("### One thing changed\n")
    answered_rows(folder, "change", CHANGES)


COSTS = ["census5x5", "census7x7", "census9x7", "pairs5x5", "ternary5x5", "census_ad", "pairs_bt",
         "birchfield_tomasi", "hmi"]


def costs(folder):
    print("### Matching costs\n")
    answered_rows(folder, "cost", [(cost, [f"matcher.cost={cost}"]) for cost in COSTS])


def peak_mebibytes(arguments):
    # A shell of its own, since a parent's maximum is over all children it ever had.
    code = ("import resource, subprocess, sys; subprocess.run(sys.argv[1:], check=True); "
            "print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)")
    done = subprocess.run([sys.executable, "-c", code, PATHS["hsgm"], "--log-level", "error",
                           *arguments], check=True, stdout=subprocess.PIPE)
    return int(done.stdout) / 1024


def memory(folder):
    print("### Peak memory, whole process\n")
    header("pair", "mode", "tile", "peak MiB", "share of sgm")
    for size, disparity in (("1024", "0,127"), ("2048", "0,127"), ("2048", "0,255")):
        made = os.path.join(folder, "memory")
        run("synth", os.path.join(PATHS["configs"], "scene-city.yaml"), "-o", made,
            "--set", f"size=[{size}, {size}]")
        whole = None
        for name, tile in (("sgm", "0"), ("hsgm", "0"), ("hsgm", "1024"), ("hsgm", "256")):
            peak = peak_mebibytes(
                ["match", os.path.join(made, "left.tif"), os.path.join(made, "right.tif"), "-o",
                 os.path.join(folder, "memory.tif"), f"--disparity={disparity}", "--tile-size",
                 tile, "--threads", "1", "--set", f"matcher.mode={name}"])
            whole = whole or peak
            row(f"{size} x {size}, {disparity}", name, "untiled" if tile == "0" else tile,
                f"{peak:.0f}", f"{100 * peak / whole:.0f} %")
    print()


TABLES = {"seams": seams, "middlebury": middlebury, "peers": peers, "ablation": ablation,
          "costs": costs, "memory": memory}


def add_paths(parser):
    root = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
    parser.add_argument("--hsgm", default=os.path.join(root, "build", "hsgm"))
    parser.add_argument("--data", default=os.environ.get(
        "HSGM_DATA_DIR", os.path.join(root, "..", "shared", "data")))
    PATHS.update(root=root, configs=os.path.join(root, "configs"))


def use_paths(arguments):
    PATHS.update(hsgm=arguments.hsgm, data=arguments.data)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tables", nargs="*", choices=[*TABLES, []], default=list(TABLES))
    add_paths(parser)
    arguments = parser.parse_args()
    use_paths(arguments)
    with tempfile.TemporaryDirectory() as folder:
        for table in arguments.tables:
            TABLES[table](folder)


if __name__ == "__main__":
    main()
