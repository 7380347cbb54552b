# SPDX-License-Identifier: GPL-3.0-or-later
"""What stage 1 says that it needs, against what it takes; what cannot fit is refused at once: memory_test.py BIN_FOLDER."""
import json
import os
import re
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
MB = 1e6
# squares each way, options of make_panel, of stage1_plate
RUNS = [(1, [], []), (5, ["--rings", "2"], ["--loads-only"]), (10, [], ["--loads-only", "--p", "8"]),
        (5, [], []), (6, ["--space", "product"], ["--p", "8"]), (14, ["--p", "5..6"], ["--loads-only"])]


def panel(n, words):
    scene = Path(f"panel{n}.json")
    scene.write_text(subprocess.run([ROOT / "scripts/make_panel", str(n), str(n), *words], check=True,
                                    capture_output=True, text=True).stdout)
    return scene


def stage1(scene, *words, megabytes=None):
    limit = (lambda: resource.setrlimit(resource.RLIMIT_AS, (int(megabytes * MB),) * 2)) if megabytes else None
    return subprocess.run(["stage1_plate", scene, "-o", "plate.h5", *words], capture_output=True, text=True,
                          preexec_fn=limit)


def check_need(n, of_panel, of_stage1):
    """Within a third either way."""
    result = stage1(panel(n, of_panel), *of_stage1, "--timings", "times.json")
    assert result.returncode == 0, result
    number, unit = re.search(r"needs about ([\d.]+) (MB|GB)", result.stdout).groups()
    need = float(number) * {"MB": MB, "GB": 1e9}[unit]
    took = json.loads(Path("times.json").read_text())["peak_memory_bytes"]
    print(f"panel({n}, {n}) {of_panel} {of_stage1}: said {need / MB:.0f} MB, took {took / MB:.0f} MB")
    assert 0.7 < took / need < 1.5, (n, of_panel, of_stage1, need, took)


def check_refusal():
    scene = panel(10, [])
    Path("plate.h5").unlink(missing_ok=True)
    result = stage1(scene, megabytes=700)
    assert result.returncode == 2, result
    assert re.fullmatch(r"stage1_plate: error: panel10.json: at p = 8 this takes about [\d.]+ GB of memory \(shapes .*\), "
                        r"\d+ MB are available; allowed: a lower p, --loads-only, which needs no fields, or fewer "
                        r"holes\n", result.stderr), result
    assert not Path("plate.h5").exists() and not result.stdout
    result = stage1(scene, "--loads-only", megabytes=700)
    assert result.returncode == 0, result


def main():
    os.environ["PATH"] = f"{Path(sys.argv[1]).resolve()}:{os.environ['PATH']}"
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for run in RUNS:
            check_need(*run)
        check_refusal()
        os.chdir("/")


main()
