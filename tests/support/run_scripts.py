# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs tests in Python, each in a fork of this process, which has loaded their libraries once.

usage: run_scripts.py BIN_FOLDER JOBS TEST...

TEST is the path of a test without "_test.py", from tests/: "pipeline/cracks"; "pipeline/study=sweep" gives it a further
argument. Tests start in the order given, JOBS at a time; a test that takes more than LONGEST seconds is stopped and has
failed. What a test prints is shown if it fails. Exit status 1 if any has failed.
"""
import os
import runpy
import signal
import sys
import tempfile
import time
import traceback
from pathlib import Path

for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ[variable] = "1"
sys.dont_write_bytecode = True

import h5py  # noqa: E402, F401
import jsonschema  # noqa: E402, F401
import matplotlib  # noqa: E402

matplotlib.use("Agg")
import matplotlib.pyplot  # noqa: E402, F401
import numpy  # noqa: E402, F401
import scipy.optimize  # noqa: E402, F401

TESTS = Path(__file__).resolve().parents[1]
LONGEST = 600  # seconds


class Running:
    """A test in a process group of its own, which prints into a file."""

    def __init__(self, name, programs):
        self.name, self.start, self.output = name, time.monotonic(), tempfile.TemporaryFile("w+", errors="replace")
        sys.stdout.flush()
        self.pid = os.fork()
        if self.pid == 0:
            os.setpgid(0, 0)
            for stream in (1, 2):
                os.dup2(self.output.fileno(), stream)
            os._exit(run(name, programs))

    def is_late(self):
        return time.monotonic() - self.start > LONGEST

    def kill(self):
        """Ends the test and the programs that it has started."""
        os.killpg(self.pid, signal.SIGKILL)

    def report(self, state):
        """Tells how it ended; returns whether it has passed."""
        status = os.waitstatus_to_exitcode(state)
        print(f"{'failed' if status else 'passed'} {self.name} {time.monotonic() - self.start:.1f} s", flush=True)
        if status:
            self.output.seek(0)
            print(self.output.read(), f"{self.name}: exit status {status}", sep="\n", flush=True)
        self.output.close()
        return status == 0


def run(name, programs):
    """Runs a test as `python3 NAME_test.py BIN_FOLDER` does; its exit status."""
    path, *words = name.split("=")
    script = TESTS / f"{path}_test.py"
    sys.argv, sys.path[0] = [str(script), programs, *words], str(script.parent)
    status = 0
    try:
        runpy.run_path(str(script), run_name="__main__")
    except SystemExit as end:
        if isinstance(end.code, str):
            print(end.code, file=sys.stderr)
        status = end.code if isinstance(end.code, int) else int(bool(end.code))
    except BaseException:
        traceback.print_exc()
        status = 1
    sys.stdout.flush()
    sys.stderr.flush()
    return status


def main(programs, jobs, *names):
    programs = str(Path(programs).resolve())
    waiting, running, failed = list(names), {}, []
    while waiting or running:
        while waiting and len(running) < int(jobs):
            test = Running(waiting.pop(0), programs)
            running[test.pid] = test
        pid, state = os.waitpid(-1, os.WNOHANG)
        if pid:
            test = running.pop(pid)
            failed += [] if test.report(state) else [test.name]
            continue
        for test in running.values():
            if test.is_late():
                test.kill()
        time.sleep(0.02)
    print(f"{len(names) - len(failed)} of {len(names)} tests in Python passed" + f"; failed: {', '.join(failed)}" * bool(failed))
    return int(bool(failed))


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
