# SPDX-License-Identifier: GPL-3.0-or-later
"""What stage 1 says that it needs, against what it takes; what cannot fit is refused at once: memory_test.py BIN_FOLDER [sweep].
With the last word large sheets and many increments too."""
import json
import os
import re
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path[:0] = [str(Path(__file__).resolve().parents[1] / "support")]
from scripts import run_script  # noqa: E402

MB = 1e6
# squares each way, options of make_panel, of stage1_plate
RUNS = [(1, [], []), (5, ["--rings", "2"], []), (6, ["--space", "product"], ["--p", "8"])]
LARGE = [(10, [], ["--p", "8"]), (14, ["--p", "5..6"], []), (14, [], ["--threads", "2"]), (20, ["--space", "product"], [])]
OF_STAGE2 = (r"^stage2_extract: error: plate.h5: this takes about (\d+) MB of memory, (\d+) MB are available; allowed: "
             r"a file of a lower p or fewer holes\n$")


def panel(n, words):
    scene = Path(f"panel{n}.json")
    scene.write_text(run_script("measure/make_panel", n, n, *words).stdout)
    return scene


def contact_panel(n, *_):
    """Discs that push but do not pull: pressures of contact beside them."""
    scene = json.loads(panel(n, ["--p", "8..8"]).read_text())
    for hole in scene["holes"]:
        hole["spring"]["compression_only"] = True
    Path("contact.json").write_text(json.dumps(scene))
    return Path("contact.json")


def irregular_panel(n, *_):
    """Squares that all differ, and their elements with them."""
    scene = json.loads(panel(n, []).read_text())
    grid = scene["geometry"]["grid"]
    for axis, step in ("x", 0.01), ("y", 0.017):
        grid[axis] = [i + step * i * i for i in range(n + 1)]
    for hole, (j, i) in zip(scene["holes"], ((j, i) for j in range(n) for i in range(n))):
        hole["center"] = [sum(grid["x"][i:i + 2]) / 2, sum(grid["y"][j:j + 2]) / 2]
    Path("irregular.json").write_text(json.dumps(scene))
    return Path("irregular.json")


def run(*words, megabytes=None):
    limit = (lambda: resource.setrlimit(resource.RLIMIT_AS, (int(megabytes * MB),) * 2)) if megabytes else None
    return subprocess.run(words, capture_output=True, text=True, preexec_fn=limit)


def stage1(scene, *words, megabytes=None):
    return run("stage1_plate", scene, "-o", "plate.h5", *words, megabytes=megabytes)


def check_need(n, of_panel, of_stage1, make=panel):
    """Not less than what the run takes, nor above 1.5 times it."""
    result = stage1(make(n, of_panel), *of_stage1, "--timings", "times.json")
    assert result.returncode == 0, result
    number, unit = re.search(r"needs about ([\d.]+) (MB|GB)", result.stdout).groups()
    need = float(number) * {"MB": MB, "GB": 1e9}[unit]
    took = json.loads(Path("times.json").read_text())["peak_memory_bytes"]
    print(f"panel({n}, {n}) {of_panel} {of_stage1}: said {need / MB:.0f} MB, took {took / MB:.0f} MB")
    assert took <= need + MB / 2 and need <= 1.5 * took, (n, of_panel, of_stage1, need, took)


def check_refusal():
    """Returns the megabytes that the program takes by itself."""
    scene = panel(20, [])
    Path("plate.h5").unlink(missing_ok=True)
    result = stage1(scene, megabytes=400)
    assert result.returncode == 2, result
    assert re.fullmatch(r"stage1_plate: error: panel20.json: at p = 8 this takes about [\d.]+ GB of memory \(shapes .*\), "
                        r"\d+ MB are available; allowed: fewer degrees or a lower one \(--p\), or fewer holes\n", result.stderr), \
        result
    assert not Path("plate.h5").exists() and not result.stdout
    own = 400 - int(re.search(r"(\d+) MB are available", result.stderr)[1]) + 1  # which is rounded
    assert stage1(panel(3, []), megabytes=400).returncode == 0
    return own


def check_end_without_threads():
    """Where memory is too short for the threads of BLAS, whose ending then waits for them, or for HDF5, which then crashes,
    the program says so and ends."""
    scene = panel(6, [])
    for kilobytes in range(90_000, 420_000, 5_000):
        result = subprocess.run(["bash", "-c", f"ulimit -v {kilobytes}; OPENBLAS_NUM_THREADS=2 stage1_plate {scene} -o plate.h5 "
                                 "--accuracy 1e-6"], capture_output=True, text=True, timeout=60)
        refused = result.returncode == 2 and re.search(r"MB are available; allowed: ", result.stderr)
        assert refused or kilobytes > 320_000, (kilobytes, result)


def check_refusals(words, output, told, own):
    """The limit follows what each refusal asks for until the run fits. The last must be no less than what it takes, and
    no more than 1.5 times that.

    @param told What a refusal says, with groups for the first number and the one available.
    """
    Path(output).unlink(missing_ok=True)
    need, refused, limit = 0, 0, own
    while (result := run(*words, "-o", output, megabytes=limit)).returncode == 2:
        assert not Path(output).exists() and not result.stdout, result
        more, available = map(int, re.search(told, result.stderr).groups())
        assert more >= need and more >= available, (need, result)
        need, refused, limit = more, refused + 1, limit + 1.01 * more - available + 1
    assert result.returncode == 0 and refused > 0, result
    assert run(*words, "-o", output, "--timings", "times.json").returncode == 0
    took = json.loads(Path("times.json").read_text())["peak_memory_bytes"]
    print(*words, f": refused {refused} times, at last {need} MB of {available} MB; took {took / MB:.0f} MB")
    assert took <= (need + 0.5) * MB and need * MB <= 1.5 * took, (words, need, took)


def check_search(scene, accuracy, own):
    """The last refusal of --accuracy is of its largest model: one of one degree holds the matrices of no other."""
    check_refusals(("stage1_plate", scene, "--accuracy", accuracy), "plate.h5",
                   rf"^stage1_plate: error: {scene}: at p = \d this takes about (\d+) MB of memory \(shapes .*\), (\d+) MB are "
                   r"available; allowed: fewer degrees or a lower one \(--p\), or fewer holes\n$", own)


def check_stage2(runs, own):
    """What reading takes is known by the size of the file, what is made of it by its cases and degrees."""
    for n, of_stage1, words in runs:
        assert stage1(panel(n, []), *of_stage1).returncode == 0
        check_refusals(("stage2_extract", "plate.h5", *words), "field.vtu" if "--field" in words else "matrices.h5",
                       OF_STAGE2, own)


def make_joint(n, p, of_stage2, friction, increments):
    """Two sheets of one panel."""
    assert stage1(panel(n, []), "--p", p).returncode == 0
    for sheet in "ab":
        assert run("stage2_extract", "plate.h5", "-o", f"{sheet}.h5", *of_stage2).returncode == 0
    holes = [f"{i},{j}" for i in range(n) for j in range(n)]
    Path("joint.json").write_text(json.dumps({
        "format": "joint", "version": 1, "plates": {"a": "a.h5", "b": "b.h5"},
        "laws": {"bolt": {"type": "linear", "k": 1e6}}, "loads": [{"external": "a:P", "force": 1000}],
        "fasteners": [{"id": hole, "between": [f"a:{hole}", f"b:{hole}"], "law": "bolt", "friction": friction}
                      for hole in holes], "increments": increments}))


def check_stage3(n, p, of_stage2, friction, increments, words, own):
    """The matrices are known by the size of their files, all else before the path is walked."""
    make_joint(n, p, of_stage2, friction, increments)
    parts = rf" \(matrices \d+ MB, solving \d+ MB, results of {increments} increments \d+ MB\)"
    options = [f"no {option}" for option in ("--sensitivities", "--rim-stresses") if option in words]
    other = (options or ["matrices of stage2_extract --loads-only"])[0]
    told = (rf"^stage3_nonlinear: error: joint.json: (?:reading its plates' matrices|this) takes about (\d+) MB of memory"
            rf"(?:{parts})?, (\d+) MB are available; allowed: (?:matrices of fewer holes, or of stage2_extract --loads-only|"
            rf"fewer increments, or {other})\n$")
    check_refusals(("stage3_nonlinear", "joint.json", *words), "result.h5", told, own)


def check_study(n, own):
    """The statistics of many numbers are known before anything is solved."""
    make_joint(n, "2..3", ["--loads-only"], 0, 1)
    Path("study.json").write_text(json.dumps({
        "format": "study", "version": 1, "samples": 200, "seed": 1, "variables": [
            {"name": "k", "at": "/fasteners/*/clearance", "each": True, "distribution": {"type": "uniform", "from": 0, "to": 1e-4}}]}))
    told = (r"^stage3_nonlinear: error: (?:joint.json: reading its plates' matrices|study.json: this) takes about (\d+) MB of memory"
            rf"(?: \(matrices \d+ MB, solving on 1 thread \d+ MB, then statistics of {n * n} numbers \d+ MB\))?, (\d+) MB are available; "
            r"allowed: (?:matrices of fewer holes, or|fewer \"outputs\" or threads, or matrices) of stage2_extract --loads-only\n$")
    check_refusals(("stage3_nonlinear", "joint.json", "--study", "study.json", "--threads", "1"), "study.h5", told, own)


def sweep(own):
    for each in LARGE:
        check_need(*each)
    check_end_without_threads()
    check_search(panel(3, []), "1e-9", own)
    check_stage2([(8, ["--p", "8"], []), (10, ["--p", "2..3"], []), (14, [], ["--loads-only"])], own)
    check_stage3(14, "6..7", [], 0, 20, ["--rim-stresses"], own)
    check_stage3(5, "2..3", [], 0.2, 1000, ["--csv", "result.csv"], own)


def main():
    os.environ["OPENBLAS_NUM_THREADS"] = "1"  # its threads reserve 128 MB each, some time after the program has begun
    os.environ["PATH"] = f"{Path(sys.argv[1]).resolve()}:{os.environ['PATH']}"
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for each in RUNS:
            check_need(*each)
        check_need(3, [], [], contact_panel)
        check_need(5, [], ["--p", "8", "--threads", "2"], irregular_panel)
        check_need(5, [], ["--p", "1..4"], irregular_panel)
        check_need(12, [], ["--p", "4"])
        own = check_refusal()
        check_search(irregular_panel(5), "1e-2", own)
        check_stage2([(8, ["--p", "8"], ["--field", "external:P"]), (8, ["--p", "7..8"], [])], own)
        check_stage3(5, "4..5", [], 0, 10, ["--rim-stresses"], own)
        check_stage3(7, "7..8", [], 0, 2, [], own)
        check_stage3(7, "2..3", ["--loads-only"], 0.2, 300, ["--sensitivities"], own)
        check_study(10, own)
        if sys.argv[2:] == ["sweep"]:
            sweep(own)
        os.chdir("/")


main()
