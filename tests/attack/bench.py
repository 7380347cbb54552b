# SPDX-License-Identifier: GPL-3.0-or-later
"""Where attacks run the programs: every run is held to what no input and no machine may make it do."""
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
STATUSES = {0, 1, 2, 3, 4}  # docs/programs.md; 1 is an internal error, which is always a fall
LONGEST = 20.0              # seconds that a run on a small scene may take
MOST_MEMORY = 4 << 30       # bytes


class Fall(Exception):
    """A program did what it must not do; the message says what."""


class Choices(random.Random):
    """The choices of one round: random numbers from its seed, which is `seed_of_round`."""

    def __init__(self, seed):
        super().__init__(seed)
        self.seed_of_round = seed


@dataclass
class Outcome:
    """How one run ended: exit status, what it printed, wall-clock seconds, and the most memory that it held in bytes."""
    status: int
    stdout: str
    stderr: str
    seconds: float
    memory: int


class Bench:
    """The programs of one folder, and a scratch folder of which each round gets an empty part.

    `sanitized` programs need more memory and time; then memory is not judged, and the time allowed is ten times as long.
    """

    def __init__(self, programs, scratch):
        self.programs = Path(programs).resolve()
        self.scratch = Path(scratch).resolve()
        self.sanitized = b"__asan_init" in (self.programs / "stage3_nonlinear").read_bytes()
        self.environment = {**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1",
                            "PATH": f"{self.programs}:{os.environ['PATH']}", "PYTHON": sys.executable,
                            "ASAN_OPTIONS": "detect_leaks=0:allocator_may_return_null=1", "UBSAN_OPTIONS": "print_stacktrace=1"}

    def of_round(self, n):
        """Number of things to try in a round: n, of sanitized programs, which are slow, a tenth."""
        return max(1, n // 10) if self.sanitized else n

    def folder(self, name):
        """An empty folder for one round."""
        path = self.scratch / name
        shutil.rmtree(path, ignore_errors=True)
        path.mkdir(parents=True)
        return path

    def start(self, *words, cwd, **options):
        """Starts a program and returns its process, for attacks that do something to it while it runs."""
        options = {"stdin": subprocess.DEVNULL, "stdout": subprocess.DEVNULL, "stderr": subprocess.PIPE, "text": True,
                   "env": self.environment} | options
        return subprocess.Popen([str(word) for word in words], cwd=cwd, **options)

    def run(self, *words, cwd, longest=LONGEST, memory=MOST_MEMORY, limits=(), may_fail=True, judged=True, **options):
        """Runs a program to its end. `limits` are pairs for resource.setrlimit. Raises Fall for a signal, a hang, too much
        memory, a status that docs/programs.md does not have, an internal error, a fault that a sanitizer reports, and a
        failure without one line that says why; where it is not `judged`, only for a hang and a sanitizer's report."""
        longest *= 10 if self.sanitized else 1

        def before():
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
            for which, value in limits:
                resource.setrlimit(which, (value, value))

        start = time.monotonic()
        with open(Path(cwd) / ".stdout", "w+b") as out, open(Path(cwd) / ".stderr", "w+b") as err:
            process = subprocess.Popen([str(word) for word in words], cwd=cwd, preexec_fn=before,
                                       **({"stdin": subprocess.DEVNULL, "stdout": out, "stderr": err,
                                           "env": self.environment} | options))
            status, usage = self._wait(process, start + longest)
            texts = []
            for stream in out, err:
                stream.seek(0)
                texts.append(stream.read().decode(errors="replace"))
        for name in ".stdout", ".stderr":
            (Path(cwd) / name).unlink()
        outcome = Outcome(status, *texts, time.monotonic() - start, usage.ru_maxrss << 10)
        self._judge(" ".join(str(word) for word in words), outcome, longest, memory, may_fail, judged)
        return outcome

    def shell(self, line, cwd, longest=LONGEST):
        """Runs a line of bash, whose status may be any."""
        return self.run("bash", "-c", line, cwd=cwd, longest=longest, judged=False)

    def must(self, *words, cwd, **options):
        """The same for a run that has to succeed."""
        return self.run(*words, cwd=cwd, may_fail=False, **options)

    def finish(self, process, what):
        """Waits for a process that was started and returns what it said on stderr; raises Fall for a hang."""
        try:
            return process.communicate(timeout=LONGEST * (10 if self.sanitized else 1))[1]
        except subprocess.TimeoutExpired:
            process.kill()
            process.communicate()
            raise Fall(f"{what}: hang") from None

    @staticmethod
    def _wait(process, deadline):
        """Exit status, negative for a signal, and resources of a process; SIGKILL when its time is over."""
        pause = 0.0005
        while True:
            pid, state, usage = os.wait4(process.pid, os.WNOHANG)
            if pid:
                process.returncode = os.waitstatus_to_exitcode(state)
                return process.returncode, usage
            if time.monotonic() > deadline:
                process.kill()
                _, _, usage = os.wait4(process.pid, 0)
                process.returncode = -signal.SIGKILL
                return None, usage
            time.sleep(pause)
            pause = min(2 * pause, 0.02)

    def _judge(self, words, outcome, longest, memory, may_fail, judged):
        lines = outcome.stderr.splitlines()
        said = f"\n  {words}\n  " + "\n  ".join(lines[-12:])[-3000:]
        if outcome.status is None:
            raise Fall(f"hang: longer than {longest:g} s{said}")
        if "runtime error:" in outcome.stderr or "Sanitizer" in outcome.stderr:
            raise Fall(f"fault seen by a sanitizer{said}")
        if not judged:
            return
        if outcome.status < 0:
            raise Fall(f"ended by {signal.Signals(-outcome.status).name}{said}")
        if outcome.status not in STATUSES or outcome.status == 1:
            raise Fall(f"exit status {outcome.status}{said}")
        if outcome.memory > memory and not self.sanitized:
            raise Fall(f"memory: {outcome.memory / 2**30:.1f} GiB{said}")
        if outcome.status != 0 and not any(": error: " in line for line in lines):
            raise Fall(f"exit status {outcome.status} without a line that says why{said}")
        if outcome.status != 0 and not may_fail:
            raise Fall(f"exit status {outcome.status} of a run that has to succeed{said}")
