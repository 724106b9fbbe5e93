#!/usr/bin/env python3
"""A run as a chain of jobs on a real Slurm: one node is lost in mid-run, its task starts again
elsewhere, and every output is the same as of an undisturbed run.

    test_slurm.py HSGM SCENE.yaml
"""

import hashlib
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
from slurm_cluster import Cluster, is_there  # noqa: E402

SHARDS = 3
CONFIG = """\
pair: {left: scene/left.tif, right: scene/right.tif}
geometry: {kind: rectified}
output: {folder: results}
matcher: {disparity: [-100, 411], paths: 16, prune: false}
run: {threads: 1, tile_size: 128}
"""


def sums(folder):
    return {path.name: hashlib.sha256(path.read_bytes()).hexdigest()
            for path in sorted(folder.glob("*.tif"))}


def done_in_shard(hsgm, results, shard):
    answer = subprocess.run([hsgm, "status", results, "--json"], text=True,
                            stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    if answer.returncode != 0:
        return 0, 0
    for part in json.loads(answer.stdout)["parts"]:
        if part["name"] == f"tiles {shard}/{SHARDS}":
            return part["tiles"]["done"], part["tiles"]["all"]
    return 0, 0


def lose_a_node(cluster, hsgm, results, array):
    """Waits for a task in the middle of its work, and takes its node away."""
    end = time.monotonic() + 120
    while time.monotonic() < end:
        for line in cluster.ask("squeue", "-h", "-t", "R", "-j", array,
                                "-o", "%K %N").splitlines():
            shard, node = line.split()
            done, tiles = done_in_shard(hsgm, results, shard)
            if 2 <= done <= tiles - 4:
                cluster.lose_node(node)
                print(f"lost {node} with task {shard}, {done} of {tiles} tiles done")
                return shard
        time.sleep(0.1)
    raise TimeoutError("no task was seen in the middle of its work\n" + cluster.ask("squeue"))


def run_chain(cluster, hsgm, folder):
    results = folder / "on-slurm"
    filed = subprocess.run(
        [hsgm, "submit", folder / "run.yaml", "--engine", "slurm", "-o", results,
         "--shards", str(SHARDS), "--memory", "400MiB"],
        env=cluster.environment, text=True, stdout=subprocess.PIPE, check=True).stdout
    print(filed, end="")
    numbers = {line.split()[0]: line.split()[1] for line in filed.splitlines()}
    shard = lose_a_node(cluster, hsgm, results, numbers["tiles"])
    cluster.wait_for(lambda: cluster.job(numbers["assemble"]).get("JobState")
                     in ("COMPLETED", "FAILED", "CANCELLED"), 300, "end of the chain")
    task = cluster.job(f"{numbers['tiles']}_{shard}")
    assemble = cluster.job(numbers["assemble"])
    print(f"task {shard}: {task['JobState']}, {task['Restarts']} restarts, on "
          f"{task['NodeList']}; assemble: {assemble['JobState']}, "
          f"{assemble['Restarts']} restarts")
    for log in sorted((results / "logs").glob("slurm-hsgm-assemble-*.log")):
        print(log.read_text())
    print(cluster.ask("squeue", "--states=all", "-o", "%i %F %T %S %r"))
    assert task["JobState"] == "COMPLETED" and task["Restarts"] == "1", task
    assert assemble["JobState"] == "COMPLETED", assemble
    record = json.loads((results / "run.json").read_text())
    owners = [p for p in record["processes"] if p["part"] == f"tiles {shard}/{SHARDS}"]
    assert len(owners) == 2 and owners[0]["job"] == owners[1]["job"] != "", owners
    # Only what was in flight when the node went was matched twice.
    assert 1 <= record["tiles"]["died"] <= 3, record["tiles"]
    return results


def main():
    hsgm, scene = sys.argv[1:]
    if not is_there():
        print("skipped: slurm-wlm and munge are not installed")
        return
    with tempfile.TemporaryDirectory(prefix="hs-", dir="/tmp") as name:
        folder = Path(name)
        subprocess.run([hsgm, "synth", scene, "-o", folder / "scene"], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        (folder / "run.yaml").write_text(CONFIG)
        subprocess.run([hsgm, "--log-level", "warn", "run", folder / "run.yaml"], check=True)
        (folder / "cluster").mkdir()
        cluster = Cluster(folder / "cluster")
        try:
            results = run_chain(cluster, hsgm, folder)
        finally:
            cluster.stop()
        undisturbed = sums(folder / "results")
        assert len(undisturbed) >= 3, undisturbed
        assert sums(results) == undisturbed, (sums(results), undisturbed)
        print(f"{len(undisturbed)} rasters are the same as undisturbed")


if __name__ == "__main__":
    main()
