# SPDX-License-Identifier: GPL-3.0-or-later
"""Where one thing is denied to one run: a folder with the inputs of a chain, and what every such run is held to."""
import os
import signal
import subprocess
from dataclasses import dataclass
from pathlib import Path

from bench import Bench, Fall
from tiny_runs import Chain, check_job, left_behind

NOBODY = 65534  # a user without rights, as whom runs are started whose rights matter
CLOSED = 'exec "$@" '  # of a shell, in front of redirections


class Skipped(Exception):
    """Something could not be denied here, so that nothing was tried; the message says why."""


@dataclass
class Spot:
    """A folder for one run; `chain` has its inputs, `other` those of a sheet whose files have other bytes."""
    bench: Bench
    chain: Chain
    other: Chain
    random: object
    folder: Path

    def job(self, *names):
        """A job at random, of the given names or of all."""
        return self.random.choice([job for job in self.chain.jobs if not names or job.name in names])

    def old(self, job):
        """Puts an earlier file at each output of a job, or at none, and returns their bytes by name."""
        old = {name: f"what was in {name}".encode() for name in job.outputs} if self.random.random() < 0.5 else {}
        for name, whole in old.items():
            (self.folder / name).write_bytes(whole)
        return old

    def run(self, *words, **options):
        return self.bench.run(*words, cwd=self.folder, **options)

    def redirected(self, redirection, *words):
        """Exit status, negative for a signal, of a run whose streams a shell redirects, and what came to stderr."""
        run = subprocess.Popen(["sh", "-c", CLOSED + redirection, "sh", *words], cwd=self.folder, env=self.bench.environment,
                               stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        words_said = self.bench.finish(run, f"{' '.join(words)} {redirection}")
        return run.returncode, words_said.decode(errors="replace")

    def as_nobody(self):
        """Options that start a run as a user without rights, who owns the folder; Skipped where that is impossible."""
        if os.geteuid() != 0:
            return {}
        for path in [self.folder, *self.folder.rglob("*")]:
            os.chown(path, NOBODY, NOBODY, follow_symlinks=False)
        can = subprocess.run([self.bench.programs / "stage1_plate", "--version"], user=NOBODY, group=NOBODY, extra_groups=[],
                             capture_output=True, check=False) if os.access(self.bench.programs, os.X_OK) else None
        if not can or can.returncode != 0:
            raise Skipped("a user without rights may not run the programs")
        return {"user": NOBODY, "group": NOBODY, "extra_groups": []}

    def end(self, job, status, old, what):
        """Holds the files of a run that ended by itself: whole, new if it says so, nothing left behind, inputs as before."""
        check_job(job, self.folder, old, f"{what}: exit status {status}", must_be_new=status == 0)
        self.chain.check_inputs(self.folder)
        if left_behind(self.folder):
            raise Fall(f"{what}: exit status {status} leaves {left_behind(self.folder)}")

    def refused(self, outcome, what, allowed=(2, 3)):
        """A Fall unless a run was refused with one of the allowed statuses, and left nothing behind."""
        if outcome.status not in allowed:
            raise Fall(f"{what}: exit status {outcome.status}, allowed {allowed}\n  {outcome.stderr[-500:]}")
        self.chain.check_inputs(self.folder)
        if left_behind(self.folder):
            raise Fall(f"{what}: leaves {left_behind(self.folder)}")


def with_path(words, option, path):
    """The words of a job with another file for an option, which is added if it is not there."""
    words = list(words)
    for i, word in enumerate(words):
        if word == option:
            words[i + 1] = str(path)
            return words
        if word.startswith(option + "="):
            words[i] = f"{option}={path}"
            return words
    return [*words, option, str(path)]


def name_of(status):
    """An exit status in words."""
    return signal.Signals(-status).name if status is not None and status < 0 else f"exit status {status}"
