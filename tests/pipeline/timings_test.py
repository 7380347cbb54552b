# SPDX-License-Identifier: GPL-3.0-or-later
"""What a run took, in its summary and in the file of --timings: timings_test.py BIN_FOLDER."""
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
STAGE1, STAGE2, STAGE3 = "stage1_plate", "stage2_extract", "stage3_nonlinear"
PLATE_PHASES, EXTRACT_PHASES, FIELD_PHASES, JOINT_PHASES = (
    ["read", "mesh", "integrate", "solve", "write"], ["read", "extract", "write"], ["read", "integrate", "extract", "write"],
    ["read", "solve", "write"])
# program, input, output, more words, phases, degrees with a number of unknowns
RUNS = [
    (STAGE1, "upper.json", "upper.h5", ["--p", "3..8"], PLATE_PHASES, "345678"),
    (STAGE1, "upper.json", "chosen.h5", ["--accuracy", "1e-3"], ["read", "search", *PLATE_PHASES[1:]], "12345"),
    (STAGE1, "lower.json", "lower.h5", ["--p", "8", "--threads", "2"], PLATE_PHASES, "8"),
    (STAGE2, "upper.h5", "upper.matrices.h5", [], EXTRACT_PHASES, "345678"),
    (STAGE2, "lower.h5", "lower.matrices.h5", [], EXTRACT_PHASES, "8"),
    (STAGE2, "upper.h5", "upper.vtu", ["--field", "external:P=0.01"], FIELD_PHASES, "345678"),
    (STAGE3, "joint.json", "joint.h5", ["--csv", "joint.csv"], JOINT_PHASES, ""),
]


def run(*words, status=0):
    result = subprocess.run(words, capture_output=True, text=True)
    assert result.returncode == status, (words, result)
    return result


def time_line(printed):
    """Total, seconds by phase and megabytes, of the last line."""
    last = re.fullmatch(r"  time (\d+\.\d{3}) s: (.*); peak memory (\d+) MB", printed.splitlines()[-1])
    total, phases, memory = last.groups()
    assert printed.count("  time ") == 1 and printed.endswith(" MB\n"), printed
    seconds = {name: float(time) for name, time in (each.split() for each in phases.split(", "))}
    return float(total), seconds, int(memory)


def check_json(program, path, words, phases, degrees):
    record = json.loads(path.read_text())
    version = run(program, "--version").stdout.split()[1]
    keys = ["program", "version", "threads", "blas_kernels", "seconds", "total", "peak_memory_bytes"] + ["unknowns"] * bool(degrees)
    assert list(record) == keys, record
    assert (record["program"], record["version"]) == (program, version), record
    assert record["threads"] == (2 if "--threads" in words else 1), record
    assert list(record["seconds"]) == phases and min(record["seconds"].values()) >= 0, record
    assert 0 < sum(record["seconds"].values()) <= record["total"], record
    assert list(record.get("unknowns", {})) == list(degrees) and 0 not in record.get("unknowns", {}).values(), record
    return record


def check_run(program, source, output, more, phases, degrees):
    """The line, the file, and that nothing but them is other than without."""
    words, times = [program, source, "-o", output, *more], Path("times.json")
    plain = run(*words)
    total, seconds, memory = time_line(plain.stdout)
    assert list(seconds) == phases and sum(seconds.values()) <= total + 0.0005 * (len(phases) + 1), plain.stdout
    without = Path(output).read_bytes()
    printed = run(*words, "--timings", times).stdout
    assert Path(output).read_bytes() == without, f"{output} depends on --timings"
    assert printed.splitlines()[:-1] == plain.stdout.splitlines()[:-1], printed
    record = check_json(program, times, more, phases, degrees)
    total, seconds, memory = time_line(printed)
    assert abs(record["total"] - total) <= 0.00051, (record, printed)
    assert abs(record["peak_memory_bytes"] / 1e6 - memory) < 5, (record, printed)
    assert all(abs(record["seconds"][name] - time) <= 0.00051 for name, time in seconds.items()), (record, printed)
    times.unlink()
    quiet = run(*words, "--timings", times, "--quiet")
    assert quiet.stdout == "", quiet
    check_json(program, times, more, phases, degrees)
    times.unlink()


def check_refusals(program, source, output, more):
    """Before any work, and nothing is touched."""
    def refused(path, status, message):
        result = run(program, source, "-o", output, *more, "--timings", path, status=status)
        assert result.stderr == f"{program}: error: {message}\n", result
        assert result.stdout == "" and not Path(output).exists(), result

    Path(output).unlink()
    before = Path(source).read_bytes()
    refused(source, 2, f"--timings {source}: is the input file; choose another name")
    assert Path(source).read_bytes() == before
    refused(f"./{output}", 2, f"--timings ./{output}: is the output file; choose another name")
    refused("none/times.json", 3, "none/times.json: cannot be written: No such file or directory")
    refused(".", 3, ".: cannot be written: it is not a regular file")
    run(program, source, "-o", output, *more)  # for those that read it


def check_failures():
    """A run that fails leaves no times, unless what converged is kept."""
    Path("bad.json").write_text('{"format": "plate"}')
    assert run(STAGE1, "bad.json", "-o", "bad.h5", "--timings", "times.json", status=2).stdout == ""
    assert not Path("times.json").exists()
    joint = json.loads(Path("joint.json").read_text())
    joint["laws"]["rivet"] = {"type": "cubic", "delta": [0.01, 0.02, 0.04], "F": [300, 500, 100]}
    joint["fasteners"] = [{**each, "clearance": 0} for each in joint["fasteners"]]
    joint["loads"][0]["force"], joint["increments"] = 1e5, [0.001, 1]
    Path("falls.json").write_text(json.dumps(joint))
    failed = run(STAGE3, "falls.json", "-o", "falls.h5", "--timings", "times.json", status=4)
    assert "falls.h5 holds the 1 increment before" in failed.stderr, failed
    assert list(time_line(failed.stdout)[1]) == JOINT_PHASES, failed
    check_json(STAGE3, Path("times.json"), [], JOINT_PHASES, "")


def check_memory():
    """What starts a program is no part of the program's memory."""
    ballast = bytearray(b"x") * 400_000_000
    run(STAGE3, "joint.json", "-o", "joint.h5", "--timings", "times.json")
    assert json.loads(Path("times.json").read_text())["peak_memory_bytes"] < len(ballast) / 2


def main(folder):
    os.environ["PATH"] = folder + os.pathsep + os.environ["PATH"]
    with tempfile.TemporaryDirectory() as work:
        os.chdir(work)
        for path in (ROOT / "tests/pipeline/scenes/lap_joint").glob("*.json"):
            shutil.copy(path, work)
        for each in RUNS:
            check_run(*each)
        for program, source, output, more, *_ in RUNS:
            check_refusals(program, source, output, more)
        check_failures()
        check_memory()
        os.chdir("/")


if __name__ == "__main__":
    main(*sys.argv[1:])
