#!/usr/bin/env python3
"""What confidence.tif is worth, as Markdown, and how its scale was found.

    tests/benchmarks/confidence.py [--hsgm build/hsgm] [--data ../shared/data] [curves|calibrate ...]

curves     errors after dropping the least confident pixels, scene by scene; from all
           confidences (matcher.min_confidence=0), like the next
calibrate  the table of docs/algorithm.md, section 6, step 7, measured anew: to be put there,
           into matcher/confidence.h and into the twin, when costs or penalties change
"""

import argparse
import json
import os
import sys
import tempfile

import tables

# Parameters are chosen on these; the other scenes only report.
TUNING = ["Cones", "Books", "Rocks1", "Adirondack", "Dublin"]
SYNTHETIC = [
    ("city", "scene-city.yaml", [], "-8,56"),
    ("high city, noisy", "scene-city.yaml",
     ["seed=33", "size=[1024, 1024]", "city.height_max_px=90", "left.noise_gray=4",
      "right.noise_gray=4", "city.plain=0.2"], "-8,110"),
    ("large", "scene-large.yaml", ["size=[1536, 1536]", "seed=5"], "-24,72"),
    ("ramps", "scene-ramps.yaml", [], "-16,47"),
    ("planes", "scene-planes.yaml", [], "-16,63"),
]


def synthetic(folder):
    """Makes the scenes; yields name, folder and range."""
    for name, config, settings, disparity in SYNTHETIC:
        made = os.path.join(folder, name.replace(" ", "-").replace(",", ""))
        if not os.path.isdir(made):
            sets = [part for s in settings for part in ("--set", s)]
            tables.run("synth", os.path.join(tables.PATHS["configs"], config), "-o", made, *sets)
        yield name, made, disparity


def confidence_of(test, truth, threshold, *options):
    scored = tables.score(test, truth, "--thresholds", str(threshold), "--confidence",
                          test.replace(".tif", ".confidence.tif"), "--confidence-px",
                          str(threshold), *options)
    return scored


def of_real_scene(scene, settings, folder, threshold, occluded):
    _, place, _, truth, options = scene
    test = tables.match_scene(scene, settings, folder)
    data = os.path.join(tables.PATHS["data"], place)
    here = [os.path.join(data, o) if o.endswith(".png") else o for o in options]
    if occluded:  # every pixel with a truth, so only what says how to read it
        here = [part for flag, value in zip(here[::2], here[1::2])
                if flag in ("--scale", "--truth-nodata") for part in (flag, value)]
    return confidence_of(test, tables.readable(os.path.join(data, truth), folder), threshold, *here)


def of_synthetic(made, disparity, settings, folder, occluded):
    test = os.path.join(folder, "scene.tif")
    tables.match(os.path.join(made, "left.tif"), os.path.join(made, "right.tif"), disparity,
                 settings, test)
    mask = [] if occluded else ["--mask", os.path.join(made, "visible_left.tif")]
    return confidence_of(test, os.path.join(made, "truth_left.tif"), 1, *mask)


def all_scenes(settings, folder, occluded, tuning_only=False):
    """Yields name, threshold and score."""
    for threshold, scenes in ((1, tables.CLASSICS + tables.OTHERS), (3, tables.COARSE)):
        for scene in scenes:
            if not tuning_only or scene[0] in TUNING:
                yield scene[0], threshold, of_real_scene(scene, settings, folder, threshold, occluded)
    for name, made, disparity in synthetic(folder):
        yield name, 1, of_synthetic(made, disparity, settings, folder, occluded)


def curves(folder, settings):
    print("### Errors after dropping the least confident pixels\n")
    tables.header("scene", "threshold", "density %", "0 %", "10 %", "20 %", "30 %", "50 %", "area", "optimal area",
                  "calibration error")
    for name, threshold, scored in all_scenes(settings, folder, False):
        c = scored["confidence"]
        star = "" if name in TUNING or name in [s[0] for s in SYNTHETIC] else " *"
        tables.row(name + star, f"{threshold} px", f"{scored['density_percent']:.1f}",
                   *[f"{p['bad_percent']:.2f}" for p in c["curve"]], f"{c['area_percent']:.2f}",
                   f"{c['optimal_area_percent']:.2f}", f"{c['calibration_error']:.3f}")
    print()


def rising(values, weights):
    """The nearest rising sequence: neighbours that fall are averaged."""
    blocks = []
    for value, weight in zip(values, weights):
        blocks.append([value, weight, 1])
        while len(blocks) > 1 and blocks[-2][0] >= blocks[-1][0]:
            v, w, n = blocks.pop()
            last = blocks[-1]
            last[0] = (last[0] * last[1] + v * w) / (last[1] + w)
            last[1] += w
            last[2] += n
    return [block[0] for block in blocks for _ in range(block[2])]


def calibrate(folder, settings):
    with open(os.path.join(tables.PATHS["root"], "matcher", "confidence.h"), encoding="ascii") as file:
        text = file.read()
    start = text.index("kConfidenceOfScore{") + len("kConfidenceOfScore{")
    stored = [int(n) for n in text[start:text.index("}", start)].split(",")]
    # Every scene has the same say in a class, unless it has but a few pixels of it.
    within = [0.0] * len(stored)
    weight = [1e-9] * len(stored)
    for _, _, scored in all_scenes(settings, folder, True, tuning_only=True):
        for c in scored["confidence"]["classes"]:
            share = c["within"] / c["pixels"]
            say = c["pixels"] / (c["pixels"] + 300)
            within[stored.index(c["confidence"])] += say * share
            weight[stored.index(c["confidence"])] += say
    shares = rising([w / n for w, n in zip(within, weight)], weight)
    table = [round(255 * share) for share in shares]
    for i in range(len(table)):  # strictly rising, within 2..255
        table[i] = max(table[i], 2 + i, table[i - 1] + 1 if i else 0)
    for i in reversed(range(len(table))):
        table[i] = min(table[i], 255 - (len(table) - 1 - i))
    print(", ".join(str(n) for n in table))


TASKS = {"curves": curves, "calibrate": calibrate}


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tasks", nargs="*", choices=[*TASKS, []], default=["curves"])
    parser.add_argument("--set", action="append", default=[], help="of the matches: matcher.paths=4")
    tables.add_paths(parser)
    arguments = parser.parse_args()
    tables.use_paths(arguments)
    with tempfile.TemporaryDirectory() as folder:
        for task in arguments.tasks:
            TASKS[task](folder, ["matcher.min_confidence=0"] + arguments.set)


if __name__ == "__main__":
    main()
