# SPDX-License-Identifier: GPL-3.0-or-later
"""Streams that are closed, full or without a reader, and an environment of junk."""
import os
import signal
import subprocess

from bench import Fall
from spot import name_of

CLOSED = ["<&-", ">&-", "2>&-", "<&- >&-", ">&- 2>&-", "<&- >&- 2>&-", "<&- 2>&-", "2>/dev/full", "</dev/full", "< .",
          "1< joint.json"]
LANGUAGES = ["C", "POSIX", "de_DE.UTF-8", "tr_TR.UTF-8", "xx_YY", "C.UTF-8", "", "/" * 300]
SETTINGS = {
    "LC_ALL": LANGUAGES, "LANG": LANGUAGES, "LC_NUMERIC": LANGUAGES, "TZ": ["junk"], "TERM": ["dumb", ""], "COLUMNS": ["0", "-1"],
    "TMPDIR": ["/nonexistent", "", "/dev/null"], "HOME": ["", "/nonexistent"], "PWD": ["/nonexistent"], "POSIXLY_CORRECT": ["1"],
    "OMP_NUM_THREADS": ["junk", "-1", "0", "1000000", "", "1,2,3"], "OMP_STACKSIZE": ["junk", "1", "64K"],
    "OMP_PROC_BIND": ["true", "junk"], "OMP_DYNAMIC": ["true", "junk"], "OMP_WAIT_POLICY": ["active", "junk"],
    "OPENBLAS_NUM_THREADS": ["junk", "-1", "0", ""], "GSL_RNG_SEED": ["junk"], "GSL_RNG_TYPE": ["junk"],
    "HDF5_USE_FILE_LOCKING": ["TRUE", "FALSE", "BEST_EFFORT", "junk"], "HDF5_DISABLE_VERSION_CHECK": ["0", "1", "2", "junk"],
    "HDF5_PLUGIN_PATH": ["/nonexistent", ""], "HDF5_PLUGIN_PRELOAD": ["::", "junk"], "HDF5_PREFIX": ["/nonexistent"],
    "HDF5_DRIVER": ["core", "family", "split", "multi", "junk", "log", "stdio"], "HDF5_VOL_CONNECTOR": ["native", "junk"],
    "HDF5_DEBUG": ["all", "junk"], "HDF5_NOCLEANUP": ["1"], "MALLOC_ARENA_MAX": ["1"], "MALLOC_PERTURB_": ["85", "170"]}


def closed(spot):
    """Closed streams, or a full one for warnings, change no file: a file that is opened never takes the number of a stream."""
    job, redirection = spot.job(), spot.random.choice(CLOSED)
    old = spot.old(job)
    status, words = spot.redirected(redirection, *job.words)
    what = f"{' '.join(job.words)} {redirection}: {name_of(status)}"
    if status not in (0, 2, 3):
        raise Fall(f"{what}\n  {words}")
    spot.end(job, status, old, what)


def full(spot):
    """A summary that cannot be written is a failure, after which the files are whole all the same; with --quiet there is none."""
    job, quiet = spot.job(), spot.random.random() < 0.3
    old = spot.old(job)
    words = [*job.words, "--quiet"] if quiet else job.words
    redirection = spot.random.choice([">/dev/full", ">/dev/full 2>/dev/full"])
    status, said = spot.redirected(redirection, *words)
    what = f"{' '.join(words)} {redirection}: {name_of(status)}"
    if status not in ((0,) if quiet else (2, 3)):
        raise Fall(f"{what}, though its summary {'was not asked for' if quiet else 'is lost'}\n  {said}")
    if not quiet and "2>" not in redirection and "error: " not in said:
        raise Fall(f"{what} without a line that says why")
    spot.end(job, status, old, what)


def without_reader(spot):
    """A pipe whose reader is gone: the signal SIGPIPE or a line, never a torn file; the files are as they were or new."""
    job = spot.job()
    old = spot.old(job)
    stream = spot.random.choice(["stdout", "stderr"])
    ignored = spot.random.random() < 0.3
    reading, writing = os.pipe()
    os.close(reading)
    streams = {"stdout": subprocess.DEVNULL, "stderr": subprocess.PIPE} | {stream: writing}
    run = subprocess.Popen(job.words, cwd=spot.folder, env=spot.bench.environment, stdin=subprocess.DEVNULL, **streams,
                           preexec_fn=lambda: signal.signal(signal.SIGPIPE, signal.SIG_IGN if ignored else signal.SIG_DFL))
    os.close(writing)
    try:
        run.communicate(timeout=200 if spot.bench.sanitized else 20)
    except subprocess.TimeoutExpired:
        run.kill()
        run.communicate()
        raise Fall(f"hang: {' '.join(job.words)} without a reader of {stream}") from None
    what = f"{' '.join(job.words)} without a reader of {stream}{', SIGPIPE ignored' if ignored else ''}"
    what += f": {name_of(run.returncode)}"
    allowed = {0, 2, 3} if stream == "stderr" else {2, 3}
    if run.returncode not in (allowed if ignored else allowed | {-signal.SIGPIPE}):
        raise Fall(what)
    spot.end(job, run.returncode, old, what)


def environment(spot):
    """Some variables have junk, or all are gone; the files are the same."""
    job = spot.job()
    junk = {}
    for name in spot.random.sample(sorted(SETTINGS), spot.random.choice([1, 1, 2, 4])):
        junk[name] = spot.random.choice(SETTINGS[name])
    bare = spot.random.random() < 0.2
    kernels = {name: value for name, value in spot.bench.environment.items() if name.startswith("OPENBLAS_")}
    everything = (kernels if bare else spot.bench.environment) | junk  # other kernels would give other last digits
    old = spot.old(job)
    program = spot.bench.programs / job.words[0]
    outcome = spot.run(program, *job.words[1:], env=everything)
    what = f"{' '.join(f'{name}={value}' for name, value in junk.items())}{' alone' if bare else ''} {' '.join(job.words)}"
    if outcome.status != 0 and not any(name.startswith("HDF5") for name in junk):
        raise Fall(f"{what}: exit status {outcome.status}\n  {outcome.stderr[-500:]}")
    spot.end(job, outcome.status, old, what)


ATTACKS = [closed, closed, full, without_reader, environment, environment, environment]
