# SPDX-License-Identifier: GPL-3.0-or-later
"""Kills: a run that is stopped at any moment by any signal leaves each of its files as it was or whole and new, and the
next run that is not disturbed leaves nothing behind.

The moment is drawn over the whole run, or falls into the write: it then comes some microseconds after the first change
of the names in the folder, which is when a temporary file appears or takes the place of its target.
"""
import os
import signal
import subprocess
import time

from bench import Fall
from tiny_runs import Chain, check_job, left_behind

PER_ROUND, PER_JOB = 60, 12  # kills, and kills of one job before an undisturbed run
LEAST = 200  # kills of which some must have come while a run wrote
CAUGHT = [signal.SIGTERM, signal.SIGINT, signal.SIGHUP, signal.SIGQUIT, signal.SIGXCPU, signal.SIGPIPE]  # of these a run tells
UNCAUGHT = [signal.SIGKILL, signal.SIGKILL, signal.SIGALRM, signal.SIGUSR1, signal.SIGABRT, signal.SIGSEGV]
WORDS = "error: stopped by a signal; files that it had not finished are as they were before\n"


def with_signals_left(environment):
    """An environment in which sanitized programs leave SIGSEGV, by which they are killed here, to the system."""
    return environment | {"ASAN_OPTIONS": environment["ASAN_OPTIONS"] + ":handle_segv=0"}


class Kills:
    def __init__(self, bench):
        self.bench, self.tried, self.caught = bench, 0, 0
        self.chain = Chain(bench, "kills")

    @property
    def what(self):
        return f"kills, of which {self.caught} of runs that wrote, which said so"

    def round(self, random, folder):
        self.chain.copy(folder)
        done = 0
        while done < self.bench.of_round(PER_ROUND):
            self._kill_one_job(random, folder, random.choice(self.chain.jobs))
            done += PER_JOB
            self.tried += PER_JOB
        return done

    def _kill_one_job(self, random, folder, job):
        """Kills one job again and again, and then lets it run to its end."""
        old = {name: f"what was in {name}".encode() for name in job.outputs} if random.random() < 0.7 else {}
        for _ in range(PER_JOB):
            for name, whole in old.items():
                (folder / name).write_bytes(whole)
            what = self._kill(random, folder, job)
            check_job(job, folder, old, what)
            self.chain.check_inputs(folder)
            if "study.h5" in job.outputs:
                continue  # its blocks are kept, and KilledStudies looks at them
            for name in job.outputs.keys() - old.keys():
                (folder / name).unlink(missing_ok=True)
        self.bench.must(*job.words, cwd=folder)
        check_job(job, folder, {}, f"{job.name}: the run after the kills", must_be_new=True)
        extra = sorted({path.name for path in folder.iterdir()} - set(self.chain.inputs) - job.outputs.keys())
        if extra:
            raise Fall(f"{job.name}: the run after the kills leaves {extra}")
        for name in job.outputs:
            (folder / name).unlink()

    def _kill(self, random, folder, job):
        """Starts a job and kills it; says in words what was done."""
        how = [random.choice(CAUGHT + UNCAUGHT)]
        how += [random.choice([signal.SIGTERM, signal.SIGINT, signal.SIGKILL])] if random.random() < 0.2 else []
        ignores = [number for number in CAUGHT if random.random() < 0.05]
        quiet = ["--quiet"] if random.random() < 0.5 else []
        at_write, moment = random.random() < 0.5, random.uniform(0, 1.2) * job.seconds
        late = random.choice([0, random.uniform(0, 3e-4), random.uniform(0, 3e-2)])
        n_changes, before = random.randint(1, 2 * len(job.outputs)), left_behind(folder)
        deaf = {"preexec_fn": lambda: [signal.signal(number, signal.SIG_IGN) for number in ignores]} if ignores else {}
        environment = with_signals_left(self.bench.environment)
        process = self.bench.start(*job.words, *quiet, cwd=folder, env=environment, **deaf)
        writes = at_write and wait_for_changes(process, folder, n_changes, late)
        if not at_write:
            wait_for(process, moment)
        for number in how:
            process.send_signal(number)
        try:
            _, words = process.communicate(timeout=20 * (10 if self.bench.sanitized else 1))
        except subprocess.TimeoutExpired:
            process.kill()
            process.communicate()
            raise Fall(f"{job.name}: goes on after {how} ({' '.join(job.words)})") from None
        what = f"{' '.join(job.words)} and {[number.name for number in how]} at {'the write' if at_write else f'{moment:.4f} s'}"
        self._check_end(process.returncode, words, how, ignores, what)
        if writes and len(how) == 1:
            self._check_caught(process.returncode, words, what)
        if WORDS in words and set(left_behind(folder)) - set(before):
            raise Fall(f"{what}: leaves {left_behind(folder)}, though it says otherwise")
        return what

    @staticmethod
    def _check_end(status, words, how, ignores, what):
        """A run ends by one of the signals that it got, or as one that came to its end; what it says fits that."""
        if status != 0 and -status not in how:
            raise Fall(f"{what}: exit status {status}\n  {words}")
        if status != 0 and -status in ignores:
            raise Fall(f"{what}: ends by a signal that it was to ignore")

    def _check_caught(self, status, words, what):
        """A run that has begun to write, and so catches signals, tells of the one that ends it, but of SIGPIPE."""
        self.caught += -status in CAUGHT
        if -status in CAUGHT and -status != signal.SIGPIPE and WORDS not in words:
            raise Fall(f"{what}: says nothing of it\n  {words}")

    def check_counts(self):
        """Some of the signals came while a run wrote: else nothing was held to what the runs say of them."""
        if self.tried >= LEAST and not self.caught:
            raise Fall(f"of {self.tried} runs that were killed none was stopped while it wrote")


def wait_for(process, seconds):
    """Waits until a moment of the run, or its end."""
    end = time.monotonic() + seconds
    while process.poll() is None and time.monotonic() < end:
        time.sleep(min(0.002, max(0.0, end - time.monotonic())))


def wait_for_changes(process, folder, n, late):
    """Waits for the n-th change of the names in a folder, then `late` seconds, or for the end of the run; says whether
    the change came first."""
    names = names_in(folder)
    while process.poll() is None and n > 0:
        now = names_in(folder)
        n -= now != names
        names = now
        time.sleep(5e-5)
    wait_for(process, late)
    return n <= 0


def names_in(folder):
    """Names in a folder; none if it is gone."""
    try:
        return set(os.listdir(folder))
    except FileNotFoundError:
        return set()
