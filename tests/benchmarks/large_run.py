#!/usr/bin/env python3
"""Carries out a run of a large synthetic pair, stage by stage, each in a process of its own, and
tells what each took: seconds, megapixels a second, how busy the processors were, peak memory beside
the plan's bound.

    tests/benchmarks/large_run.py --folder /data/large                        # 30000 x 30000 px, 2 GiB
    tests/benchmarks/large_run.py --folder /data/large --side 16384           # how busy two cores are
    tests/benchmarks/large_run.py --folder /tmp/small --side 2048 --memory 512MiB
    tests/benchmarks/large_run.py --folder /data/large --report               # print again

May be stopped at any moment, and goes on where it was when it is called again: the scene is rendered
once, finished stages are not repeated, and an unfinished one is resumed; its times and peaks are those
of all attempts. Everything is kept in FOLDER/large-SIDE.json. Disk: some 35 bytes a pixel, 32 GB for
30000 x 30000 px.
"""

import argparse
import glob
import json
import os
import shutil
import sqlite3
import subprocess
import sys
import time

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
MIB = 1 << 20
SAMPLE_S = 0.1
LOWEST = -32  # of the range; the scene's disparities lie within -32..73 px
PARTS = (("coarse", []), ("tiles 0/1", ["--shard", "0/1"]), ("assemble", []))


def progress(*words):
    print(*words, file=sys.stderr, flush=True)


class Record:
    """What is known so far, on the disk after every change."""

    def __init__(self, path):
        self.path = path
        self.data = {"parts": {}}
        if os.path.exists(path):
            with open(path, encoding="ascii") as file:
                self.data = json.load(file)

    def save(self):
        with open(self.path + ".part", "w", encoding="ascii") as file:
            json.dump(self.data, file, indent=1)
        os.replace(self.path + ".part", self.path)

    def part(self, name):
        return self.data["parts"].setdefault(name, {"done": False, "attempts": []})


def render(arguments, folder):
    scene = os.path.join(folder, f"scene-{arguments.side}")
    if not os.path.exists(os.path.join(scene, "scene.used.yaml")):
        progress(f"rendering {arguments.side} x {arguments.side} px")
        subprocess.run([arguments.hsgm, "synth", os.path.join(ROOT, "configs", "scene-large.yaml"), "-o",
                        scene, "--set", f"size=[{arguments.side}, {arguments.side}]"], check=True,
                       stdout=subprocess.DEVNULL)
    config = os.path.join(folder, f"large-{arguments.side}.yaml")
    with open(config, "w", encoding="ascii") as file:
        file.write(f"pair: {{left: scene-{arguments.side}/left.tif, right: scene-{arguments.side}/right.tif}}\n"
                   "geometry: {kind: rectified, height_per_px_m: 0.5}\n"
                   f"output: {{folder: result-{arguments.side}}}\n"
                   f"matcher: {{disparity: [{LOWEST}, {LOWEST + arguments.disparities - 1}]}}\n"
                   f"run: {{threads: {arguments.threads}, memory: {arguments.memory}}}\n")
    return config


def sample(pid):
    """Seconds of CPU and resident bytes of a process; nothing once it has gone."""
    try:
        with open(f"/proc/{pid}/stat", encoding="ascii") as file:
            fields = file.read().rsplit(")", 1)[1].split()
        with open(f"/proc/{pid}/status", encoding="ascii") as file:
            resident = next((line.split()[1] for line in file if line.startswith("VmRSS")), 0)
        ticks = os.sysconf("SC_CLK_TCK")
        return (int(fields[11]) + int(fields[12])) / ticks, int(resident) * 1024
    except (OSError, IndexError):
        return None


def run_part(arguments, config, name, words):
    """One attempt at a part: exit code, seconds, peak, and a sample every tenth of a second."""
    command = [arguments.hsgm, "run", config, "--stage", name.split()[0], "--resume", *words]
    progress(name)
    start, started = time.time(), time.monotonic()
    samples = []
    child = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    try:
        while True:
            pid, status, usage = os.wait4(child.pid, os.WNOHANG)
            if pid:
                break
            now = sample(child.pid)
            if now:
                samples.append([round(time.time(), 2), round(now[0], 2), now[1]])
            time.sleep(SAMPLE_S)
    except KeyboardInterrupt:
        child.terminate()
        _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    return {"exit_code": child.returncode, "started_s": start, "seconds": time.monotonic() - started,
            "cpu_s": usage.ru_utime + usage.ru_stime, "peak_bytes": usage.ru_maxrss * 1024,
            "samples": thinned(samples)}


def thinned(samples):
    """A few thousand at most, and of each neighbourhood the one with the most memory."""
    step = -(-len(samples) // 4000) if samples else 1
    return [max(samples[i:i + step], key=lambda s: s[2]) for i in range(0, len(samples), step)]


def stages_in(folder, side):
    """Every attempt at a stage that the ledgers tell of: name, start, seconds; tiles as one."""
    stages = []
    for path in sorted(glob.glob(os.path.join(folder, f"result-{side}", "ledger", "*.sqlite"))):
        with sqlite3.connect(f"file:{path}?mode=ro", uri=True) as ledger:
            stages += [list(row) for row in ledger.execute(
                "SELECT stage, started_s, seconds FROM attempts WHERE stage <> 'match'")]
            spans = ledger.execute(
                "SELECT 'tiles', min(started_s), max(started_s + seconds) - min(started_s) FROM "
                "attempts WHERE stage = 'match' AND outcome = 'done' GROUP BY token").fetchall()
            stages += [list(row) for row in spans]
    return sorted(stages, key=lambda stage: stage[1])


def busy_percent(samples, start, seconds, threads):
    """CPU use over the middle half of a span, in per cent of so many threads."""
    middle = [s for s in samples if start + seconds / 4 <= s[0] <= start + 3 * seconds / 4]
    if len(middle) < 2 or middle[-1][0] <= middle[0][0]:
        return None
    return 100 * (middle[-1][1] - middle[0][1]) / (middle[-1][0] - middle[0][0]) / threads


def measure(arguments, record):
    config = render(arguments, arguments.folder)
    plan = json.loads(subprocess.run(
        [arguments.hsgm, "plan", config, "--shards", "1", "--json", "--no-time"], check=True, text=True,
        stdout=subprocess.PIPE).stdout)
    bounds = {part["part"]: part["memory_bytes"] for part in plan["parts"]}
    record.data.update(side=arguments.side, threads=arguments.threads, memory=arguments.memory,
                       disparities=arguments.disparities, tiles=plan["tiles"],
                       tile_size_px=plan["tile_size_px"], bounds=bounds)
    record.save()
    for name, words in PARTS:
        part = record.part(name)
        if part["done"]:
            continue
        attempt = run_part(arguments, config, name, words)
        part["attempts"].append(attempt)
        part["done"] = attempt["exit_code"] == 0
        record.data["stages"] = stages_in(arguments.folder, arguments.side)
        record.save()
        if not part["done"]:
            sys.exit(f"{name} ended with code {attempt['exit_code']}; call again to go on")


def row(*cells):
    print("| " + " | ".join(str(cell) for cell in cells) + " |")


def print_report(data):
    mpx = data["side"] ** 2 / 1e6
    print(f"{data['side']} x {data['side']} px, {data['disparities']} disparities, {data['tiles']} tiles of "
          f"{data['tile_size_px']} px, {data['threads']} threads, {data['memory']} allowed\n")
    row("process", "seconds", "CPU s", "megapixels / s", "peak MiB", "bound of the plan, MiB", "attempts")
    row(*["---"] * 7)
    samples = []
    for name, part in data["parts"].items():
        attempts = part["attempts"]
        samples += [s for a in attempts for s in a["samples"]]
        seconds = sum(a["seconds"] for a in attempts)
        row(name, f"{seconds:.1f}", f"{sum(a['cpu_s'] for a in attempts):.1f}", f"{mpx / seconds:.2f}",
            f"{max(a['peak_bytes'] for a in attempts) / MIB:.0f}", f"{data['bounds'][name] / MIB:.0f}",
            len(attempts))
    print()
    row("stage", "seconds", "megapixels / s", "peak MiB (sampled)", "busy in its middle, % of the threads")
    row(*["---"] * 5)
    for name in dict.fromkeys(stage[0] for stage in data["stages"]):
        spans = [stage[1:] for stage in data["stages"] if stage[0] == name]
        seconds = sum(length for _, length in spans)
        resident = [s[2] for s in samples if any(at <= s[0] <= at + length for at, length in spans)]
        longest = max(spans, key=lambda span: span[1])
        busy = busy_percent(samples, *longest, data["threads"])
        row(name, f"{seconds:.1f}", f"{mpx / seconds:.2f}" if seconds else "",
            f"{max(resident) / MIB:.0f}" if resident else "", f"{busy:.1f}" if busy is not None else "")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--folder", required=True, help="for scene, results and figures")
    parser.add_argument("--side", type=int, default=30000)
    parser.add_argument("--disparities", type=int, default=128)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--memory", default="2GiB")
    parser.add_argument("--hsgm", default=os.path.join(ROOT, "build", "hsgm"))
    parser.add_argument("--report", action="store_true", help="print what was measured, and do nothing")
    parser.add_argument("--again", action="store_true", help="forget earlier results, but not the scene")
    arguments = parser.parse_args()
    os.makedirs(arguments.folder, exist_ok=True)
    path = os.path.join(arguments.folder, f"large-{arguments.side}.json")
    if arguments.again:
        shutil.rmtree(os.path.join(arguments.folder, f"result-{arguments.side}"), ignore_errors=True)
        if os.path.exists(path):
            os.remove(path)
    record = Record(path)
    if not arguments.report:
        measure(arguments, record)
    print_report(record.data)


if __name__ == "__main__":
    main()
