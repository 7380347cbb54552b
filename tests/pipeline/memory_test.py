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


def contact_panel(n, *_):
    """Discs that push but do not pull, each with its share of the load."""
    scene = json.loads(panel(n, ["--p", "8..8"]).read_text())
    for hole in scene["holes"]:
        hole["spring"]["compression_only"] = True
    scene["loads"] = [{"external": "P", "force": 100},
                      *({"disc": hole["id"], "force": -100 / n**2} for hole in scene["holes"])]
    Path("contact.json").write_text(json.dumps(scene))
    return Path("contact.json")


def run(*words, megabytes=None):
    limit = (lambda: resource.setrlimit(resource.RLIMIT_AS, (int(megabytes * MB),) * 2)) if megabytes else None
    return subprocess.run(words, capture_output=True, text=True, preexec_fn=limit)


def stage1(scene, *words, megabytes=None):
    return run("stage1_plate", scene, "-o", "plate.h5", *words, megabytes=megabytes)


def check_need(n, of_panel, of_stage1, make=panel):
    """Within a third either way."""
    result = stage1(make(n, of_panel), *of_stage1, "--timings", "times.json")
    assert result.returncode == 0, result
    number, unit = re.search(r"needs about ([\d.]+) (MB|GB)", result.stdout).groups()
    need = float(number) * {"MB": MB, "GB": 1e9}[unit]
    took = json.loads(Path("times.json").read_text())["peak_memory_bytes"]
    print(f"panel({n}, {n}) {of_panel} {of_stage1}: said {need / MB:.0f} MB, took {took / MB:.0f} MB")
    assert 0.7 < took / need < 1.5, (n, of_panel, of_stage1, need, took)


def check_refusal():
    """Returns the megabytes that the program takes by itself."""
    scene = panel(10, [])
    Path("plate.h5").unlink(missing_ok=True)
    result = stage1(scene, megabytes=700)
    assert result.returncode == 2, result
    assert re.fullmatch(r"stage1_plate: error: panel10.json: at p = 8 this takes about [\d.]+ GB of memory \(shapes .*\), "
                        r"\d+ MB are available; allowed: a lower p, --loads-only, which needs no fields, or fewer "
                        r"holes\n", result.stderr), result
    assert not Path("plate.h5").exists() and not result.stdout
    own = 700 - int(re.search(r"(\d+) MB are available", result.stderr)[1])
    result = stage1(scene, "--loads-only", megabytes=700)
    assert result.returncode == 0, result
    return own


def check_search(own):
    """Each degree that --accuracy tries: with 58 MB the fourth fits, which needs 44, and the seventh does not, which needs 71."""
    scene = panel(10, [])
    Path("plate.h5").unlink(missing_ok=True)
    result = stage1(scene, "--accuracy", "1e-2", "--loads-only", megabytes=own + 58)
    assert result.returncode == 0 and "accuracy 0.01: product space, p = " in result.stdout, result
    Path("plate.h5").unlink()
    result = stage1(scene, "--accuracy", "1e-9", "--loads-only", megabytes=own + 58)
    assert result.returncode == 2 and not Path("plate.h5").exists() and not result.stdout, result
    p, need, available = re.fullmatch(r"stage1_plate: error: panel10.json: at p = ([3-7]) this takes about (\d+) MB of memory "
                                      r"\(shapes .*\), (\d+) MB are available; allowed: a lower p.*\n", result.stderr).groups()
    print(f"--accuracy: refused at p = {p}: {need} MB of {available} MB")
    assert int(need) > int(available), result


def check_stage2(own):
    """What stage 2 takes is known from the size of its file."""
    assert stage1(panel(8, []), "--p", "8").returncode == 0
    matrices = "stage2_extract", "plate.h5", "-o", "matrices.h5"
    assert run(*matrices, "--timings", "times.json").returncode == 0
    Path("matrices.h5").unlink()
    took = json.loads(Path("times.json").read_text())["peak_memory_bytes"]
    for words in matrices, ("stage2_extract", "plate.h5", "--field", "external:P", "-o", "matrices.h5"):
        result = run(*words, megabytes=own + 60)
        assert result.returncode == 2 and not Path("matrices.h5").exists(), result
        need, unit = re.fullmatch(r"stage2_extract: error: plate.h5: this takes about ([\d.]+) (MB|GB) of memory, \d+ MB are "
                                  r"available; allowed: a file of a lower p or fewer holes, or of stage1_plate "
                                  r"--loads-only\n", result.stderr).groups()
        assert 0.7 < took / MB / float(need) < 1.5 and unit == "MB", (took, result)
    print(f"stage 2: said {need} MB, took {took / MB:.0f} MB")


def main():
    os.environ["PATH"] = f"{Path(sys.argv[1]).resolve()}:{os.environ['PATH']}"
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for run in RUNS:
            check_need(*run)
        check_need(3, [], [], contact_panel)
        own = check_refusal()
        check_search(own)
        check_stage2(own)
        os.chdir("/")


main()
