# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads what programs say of their progress: progress_test.py BIN_FOLDER [estimates]. With the last word it compares what
stage 1 says is left with what then was, which only a quiet machine answers."""
import os
import pty
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def panel(n):
    scene = Path(f"panel{n}.json")
    scene.write_text(subprocess.run([ROOT / "scripts/measure/make_panel", str(n), str(n)], check=True, capture_output=True,
                                    text=True).stdout)
    return scene


def run(*words):
    """Lines of stderr and when they came, and the end of the run."""
    process = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    lines = [(time.monotonic(), line) for line in process.stderr]
    assert process.wait() == 0, (words, lines)
    return lines, time.monotonic()


def on_terminal(*words):
    """Output that a terminal gets, stdout and stderr."""
    ours, terminal = pty.openpty()
    process = subprocess.Popen(words, stdout=terminal, stderr=terminal)
    os.close(terminal)
    got = b""
    try:
        while piece := os.read(ours, 1024):
            got += piece
    except OSError:  # Linux's way to say that the other side has closed it
        os.close(ours)
    assert process.wait() == 0, (words, got)
    return got.decode()


def check_lines(scene):
    lines, _ = run("stage1_plate", scene, "-o", "plate.h5", "--p", "1..8")
    assert lines, "a run of more than a second"
    for _, line in lines:
        assert re.fullmatch(r"stage1_plate: (mesh|integrate|solve|write)(, \d+ % done, about \d+ s left)?\n", line), line
    assert all(after[0] - before[0] > 2.5 for before, after in zip(lines, lines[1:])), lines
    assert run("stage1_plate", scene, "-o", "plate.h5", "--p", "8..8", "--quiet")[0] == []


def check_bar(scene):
    said = on_terminal("stage1_plate", str(scene), "-o", "plate.h5", "--p", "1..8")
    bars = re.findall(r"\[(#* *)\] solve(?:, (\d+) % done, about \d+ s left)?\x1b\[K\r", said)
    assert bars and all(len(bar) == 20 for bar, _ in bars), said
    shares = [int(share or 0) for _, share in bars]
    assert shares == sorted(shares) and shares[-1] > 50, shares
    assert re.search(r" left\x1b\[K\r\x1b\[Kplate.h5: \d+ elements", said), said
    assert on_terminal("stage1_plate", str(scene), "-o", "plate.h5", "--p", "8", "--quiet") == ""


def check_estimates():
    for n in 3, 10, 20, 32:
        for degrees in "1..8", "5..8", "7..8":
            lines, end = run("stage1_plate", panel(n), "-o", "plate.h5", "--p", degrees)
            for at, line in lines:
                if said := re.search(r"about (\d+) s left", line):
                    left = end - at
                    print(f"{n * n} holes, p = {degrees}: {line.strip()}; it took {left:.1f} s more")
                    assert left / 2 - 0.5 <= float(said[1]) <= 2 * left + 0.5


def main():
    os.environ["PATH"] = f"{Path(sys.argv[1]).resolve()}:{os.environ['PATH']}"
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        if sys.argv[2:] == ["estimates"]:
            check_estimates()
        else:
            assert run("stage1_plate", panel(2), "-o", "plate.h5", "--p", "2")[0] == []
            scene = panel(14)
            check_lines(scene)
            check_bar(scene)
        os.chdir("/")


main()
